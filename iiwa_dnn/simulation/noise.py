"""Disturbances of the joint velocity."""

from __future__ import annotations

import math

import numpy as np

from iiwa_dnn.exceptions import InvalidInputError
from iiwa_dnn.qp import Matrix


def gaussian_noise(sigma: float, steps: int, joints: int, seed: int) -> Matrix:
    """White Gaussian noise, drawn anew at every control step (section IV of the paper).

    Args:
        sigma: Standard deviation [rad/s]; the paper's amplitude is 0.01.
        steps: Number of control steps.
        joints: Number of joints.
        seed: The same seed gives the same noise.

    Returns:
        Noise [rad/s] of shape (steps, joints).

    Raises:
        InvalidInputError: `sigma` is negative or not finite, or `seed` is negative.
    """
    if not (math.isfinite(sigma) and sigma >= 0):
        raise InvalidInputError("noise", f"must be at least 0 rad/s, not {sigma}", sigma)
    if seed < 0:
        raise InvalidInputError("seed", f"must be at least 0, not {seed}", seed)
    if sigma == 0.0:
        return np.zeros((steps, joints))
    return sigma * np.random.default_rng(seed).standard_normal((steps, joints))
