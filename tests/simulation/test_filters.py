"""The moving average against numpy's mean over the paper's window."""

import numpy as np
import pytest

from iiwa_dnn.simulation import MovingAverage

SAMPLES = np.random.default_rng(71).normal(size=(100, 7))


@pytest.mark.parametrize("window", [1, 2, 10, 100, 1000])
def test_a_mean_is_that_of_equation_9_or_of_the_samples_that_there_are(window: int) -> None:
    average = MovingAverage(window)
    buffer = np.empty(7)
    means = []
    for sample in SAMPLES:
        buffer[:] = sample
        means.append(average(buffer))
    for k, mean in enumerate(means):
        expected = np.mean(SAMPLES[max(0, k + 1 - window) : k + 1], axis=0)
        np.testing.assert_allclose(mean, expected, rtol=0, atol=1e-14)
