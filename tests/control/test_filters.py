"""The moving average against numpy's mean over the paper's window."""

import numpy as np
import pytest

from iiwa_dnn.simulation import MovingAverage

SAMPLES = np.random.default_rng(71).normal(size=(100, 7))


@pytest.mark.parametrize("window", [1, 2, 10, 100, 1000])
def test_a_mean_is_that_of_equation_9_or_of_the_samples_that_there_are(window: int) -> None:
    average = MovingAverage(window)
    for k, sample in enumerate(SAMPLES):
        expected = np.mean(SAMPLES[max(0, k + 1 - window) : k + 1], axis=0)
        np.testing.assert_allclose(average(sample), expected, rtol=0, atol=1e-14)


def test_samples_and_means_are_not_shared_with_the_caller() -> None:
    average, sample = MovingAverage(3), np.ones(2)
    first = average(sample)
    sample[:] = 100.0
    second = average(np.full(2, 3.0))
    np.testing.assert_array_equal(first, [1.0, 1.0])
    np.testing.assert_array_equal(second, [2.0, 2.0])
