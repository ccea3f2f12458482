"""What moves the robot: the velocity that a step applies."""

from __future__ import annotations

import numpy as np
from numba import njit

TOLERANCE = 1e-12
"""A command beyond its bound by no more [rad/s] is clipped and not counted: that is rounding."""


@njit(cache=True, error_model="numpy")
def move(q, dq, dq_solver, k, velocity, answer, dt):
    """Write `velocity` and the solver's `answer` (n,) into rows k, and where it leads into q.

    Rounded as numpy would: no product is contracted with its sum.
    """
    for i in range(velocity.size):
        dq_solver[k, i] = answer[i]
        dq[k, i] = velocity[i]
        q[k + 1, i] = q[k, i] + dt * velocity[i]


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def window_mean(samples, count, sample):
    """Put the sample (n,) that comes after `count` others into the ring `samples` (window, n).

    Returns:
        The mean of the window, (n,), or of the samples that there are.
    """
    window, n = samples.shape
    samples[count % window] = sample
    filled = min(count + 1, window)
    mean = np.zeros(n)
    # A running sum would be quicker and would drift by its rounding.
    for k in range(filled):
        for i in range(n):
            mean[i] += samples[k, i]
    for i in range(n):
        mean[i] /= filled
    return mean


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def clip_command(q, limits, gain, dq, clipped):
    """Clip joint velocities in place to the bounds at joint positions q.

    The bounds are those of `iiwa_dnn.kernels.velocity_bounds`. A velocity that is no number
    becomes the bound nearest to rest.

    Args:
        q: Where the joints truly are [rad], (n,).
        limits: Rows of `Robot.limits`, (3, n).
        gain: The scheme's limit gain [1/s].
        dq: Joint velocities [rad/s], (n,); overwritten.
        clipped: Becomes 1 for every joint that was clipped and is left alone for others, (n,).

    Returns:
        How many joints were clipped.
    """
    count = 0
    for i in range(q.size):
        fastest = limits[2, i]
        lower = min(max(gain * (limits[0, i] - q[i]), -fastest), fastest)
        upper = min(max(gain * (limits[1, i] - q[i]), -fastest), fastest)
        asked = dq[i]
        if asked != asked:
            dq[i] = min(max(0.0, lower), upper)
        elif asked < lower:
            dq[i] = lower
        elif asked > upper:
            dq[i] = upper
        else:
            continue
        if not abs(asked - dq[i]) <= TOLERANCE:
            clipped[i] = 1
            count += 1
    return count
