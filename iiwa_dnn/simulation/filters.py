r"""Filters of joint velocities.

The moving average is the paper's anti-noise mechanism, equation (9):

.. math::

    w_{\text{filtered}}(t) = \frac1N \sum_{i=0}^{N-1} w_{\text{noisy}}(t - i\,\Delta t)
"""

from collections import deque

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.qp import Vector


class MovingAverage:
    """Moving average over the last N samples; over all samples while there are fewer than N.

    Attributes:
        window: Number of samples N; 1 passes every sample unchanged.
    """

    def __init__(self, window: int) -> None:
        """Create a filter without samples.

        Raises:
            InvalidInputError: `window` is below 1.
        """
        self.window = checks.integer("filter_window", window, 1)
        self._samples = deque[Vector](maxlen=self.window)

    def __call__(self, sample: Vector) -> Vector:
        """Add a sample (n,) [rad/s]; return the mean of the window [rad/s], (n,), a new array."""
        self._samples.append(sample.copy())
        # A running sum would be quicker and would drift by its rounding.
        mean: Vector = np.sum(self._samples, axis=0) / len(self._samples)
        return mean
