"""A judge of joint trajectories: finite differences against limits, and nothing of the package."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

ROUNDING = 8 * np.finfo(float).eps
"""Error of a position of 1 rad that a difference of order k carries on, times (2 / dt)^k."""


class Breach(NamedTuple):
    """A limit that is broken.

    Attributes:
        quantity: ``position``, ``velocity``, ``acceleration`` or ``jerk``.
        step: Number of the sample.
        joint: Number of the joint, from 0.
        excess: Amount beyond the limit, in its unit.
    """

    quantity: str
    step: int
    joint: int
    excess: float


def breaches(
    q: NDArray[np.float64],
    dt: float,
    lower: ArrayLike,
    upper: ArrayLike,
    velocity: ArrayLike = np.inf,
    acceleration: ArrayLike = np.inf,
    jerk: ArrayLike = np.inf,
    at_rest: bool = True,
) -> list[Breach]:
    """Return the worst breach of each limit by more than rounding.

    Args:
        q: Joint positions [rad], (N, n), dt apart.
        dt: Time between two samples [s].
        lower: Lower position limits [rad], one number or (n,).
        upper: Upper position limits [rad], likewise.
        velocity: Velocity limits [rad/s], likewise.
        acceleration: Acceleration limits [rad/s^2], likewise.
        jerk: Jerk limits [rad/s^3], likewise.
        at_rest: Whether the joints stood before the first sample.
    """
    found = []
    size = 1.0 + float(np.abs(q).max())

    def judge(quantity: str, excess: NDArray[np.float64], order: int) -> None:
        excess = excess - size * ROUNDING * (2.0 / dt) ** order
        if excess.size and excess.max() > 0.0:
            step, joint = np.unravel_index(int(excess.argmax()), excess.shape)
            found.append(Breach(quantity, int(step), int(joint), float(excess.max())))

    judge("position", np.maximum(q - upper, lower - q), 0)
    if at_rest:
        q = np.vstack([q[:1], q[:1], q[:1], q])
    limits = (("velocity", velocity), ("acceleration", acceleration), ("jerk", jerk))
    for order, (quantity, limit) in enumerate(limits, start=1):
        judge(quantity, np.abs(np.diff(q, order, axis=0)) / dt**order - limit, order)
    return found
