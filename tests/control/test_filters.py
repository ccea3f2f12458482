"""The moving average against numpy's mean over the paper's window."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_simulation import run
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.simulation import MovingAverage, gaussian_noise

SAMPLES = np.random.default_rng(71).normal(size=(100, 7))


@pytest.mark.parametrize("window", [2, 3, 10, 99, 100])
def test_a_full_window_is_equation_9(window: int) -> None:
    average = MovingAverage(window)
    means = np.array([average(sample) for sample in SAMPLES])
    for k in range(window - 1, 100):
        direct = np.mean([SAMPLES[k - i] for i in range(window)], axis=0)
        np.testing.assert_allclose(means[k], direct, rtol=0, atol=1e-14)


@pytest.mark.parametrize("window", [2, 10, 1000])
def test_until_the_window_is_full_it_is_the_mean_of_what_there_is(window: int) -> None:
    average = MovingAverage(window)
    for k, sample in enumerate(SAMPLES[: min(window, 100)]):
        expected = SAMPLES[: k + 1].mean(axis=0)
        np.testing.assert_allclose(average(sample), expected, rtol=0, atol=1e-14)


def test_a_window_of_one_changes_nothing() -> None:
    average = MovingAverage(1)
    for sample in SAMPLES:
        np.testing.assert_array_equal(average(sample), sample)


def test_a_constant_stays_and_a_step_is_through_after_the_window() -> None:
    average = MovingAverage(4)
    for _ in range(6):
        np.testing.assert_allclose(average(np.full(2, 0.3)), 0.3, rtol=1e-15)
    steps = [average(np.full(2, 1.1))[0] for _ in range(6)]
    np.testing.assert_allclose(steps, [0.5, 0.7, 0.9, 1.1, 1.1, 1.1], rtol=1e-14)


def test_samples_and_means_are_not_shared_with_the_caller() -> None:
    average, sample = MovingAverage(3), np.ones(2)
    first = average(sample)
    sample[:] = 100.0
    second = average(np.full(2, 3.0))
    np.testing.assert_array_equal(first, [1.0, 1.0])
    np.testing.assert_array_equal(second, [2.0, 2.0])


def test_rounding_does_not_add_up() -> None:
    # A running sum would keep what is lost beside the large sample for ever.
    average = MovingAverage(2)
    average(np.array([1e16]))
    average(np.array([1.0]))
    for _ in range(3):
        mean = average(np.array([1.0]))
    np.testing.assert_array_equal(mean, [1.0])


@pytest.mark.parametrize("window", [0, -1, 2.5, np.nan, np.inf, None, "wide"])
def test_a_bad_window_is_named(window: object) -> None:
    with pytest.raises(InvalidInputError, match=r"^filter_window\b"):
        MovingAverage(window)


def test_in_the_loop_it_averages_the_noisy_velocity() -> None:
    record = run(noise=0.01, filter_window=10, seed=2, duration=0.1)
    noisy = record.dq_solver + gaussian_noise(0.01, 100, 7, seed=2)
    for k in range(100):
        expected = noisy[max(0, k - 9) : k + 1].mean(axis=0)
        np.testing.assert_allclose(record.dq[k], expected, rtol=0, atol=1e-14)


def test_it_smooths_the_velocity_by_the_root_of_its_window() -> None:
    rough = run(noise=0.01, seed=2, duration=0.5)
    smooth = run(noise=0.01, seed=2, duration=0.5, filter_window=10)
    jitter = [np.std((r.dq - r.dq_solver)[20:]) for r in (rough, smooth)]
    assert jitter[0] == pytest.approx(0.01, rel=0.05)
    assert jitter[1] == pytest.approx(0.01 / np.sqrt(10.0), rel=0.15)
