r"""Filters of the joint velocity.

The moving average is the paper's anti-noise mechanism, equation (9):

.. math::

    w_{\text{filtered}}(t) = \frac1N \sum_{i=0}^{N-1} w_{\text{noisy}}(t - i\,\Delta t)
"""

from collections import deque

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.qp import Vector


class MovingAverage:
    """Mean of the last samples; before the window is full, of those that there are.

    Attributes:
        window: Number of samples N; 1 passes every sample unchanged.
    """

    def __init__(self, window: int) -> None:
        """Start empty.

        Raises:
            InvalidInputError: `window` is below 1.
        """
        self.window = checks.integer("filter_window", window, 1)
        self._samples = deque[Vector](maxlen=self.window)

    def __call__(self, sample: Vector) -> Vector:
        """Take one sample (n,) [rad/s] and return the mean of the window (n,)."""
        self._samples.append(sample.copy())
        # A running sum would be quicker and would drift by its rounding.
        mean: Vector = np.sum(self._samples, axis=0) / len(self._samples)
        return mean
