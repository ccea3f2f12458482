"""A judge of joint trajectories: finite differences against limits, and nothing of the package."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

ROUNDING = 8 * np.finfo(float).eps
"""Error of a position of 1 rad that a difference of order k carries on, times (2 / dt)^k."""


class Breach(NamedTuple):
    """A limit that is broken."""

    quantity: str  # position, velocity, acceleration or jerk
    step: int
    joint: int
    excess: float  # in the limit's unit


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
    """Return the worst breach of each limit, one number or (n,), by more than rounding.

    Joint positions q are (N, n) [rad], dt [s] apart; `at_rest` if the joints stood before.
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
