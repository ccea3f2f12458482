"""A target that is set from outside: by a person's hand, a camera, another program."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn.checks import finite_array, not_negative
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.references.base import Pose, Reference


class MovingTarget(Reference):
    """A pose that may jump, approached at a limited speed.

    The target moves to the pose given by `set` in a straight line and about a fixed axis, as time
    goes on in `at`: a controller never sees a jump, and a policy's slowed clock slows the target.

    Attributes:
        speed: Largest linear speed of the target [m/s].
        rate: Largest angular speed of the target [rad/s].
    """

    name: ClassVar[str] = "moving target"

    def __init__(self, pose: Pose, speed: float = 0.25, rate: float = 1.0) -> None:
        """Begin at rest at a pose, for example an ``iiwa_dnn.Configuration``.

        Raises:
            InvalidInputError: The pose is not finite, or a speed is not a number above zero.
        """
        self.speed, self.rate = not_negative("speed", speed), not_negative("rate", rate)
        self._time: float | None = None
        self._velocity: NDArray[np.float64] = np.zeros(6)
        self._wanted = pose.position.copy(), pose.rotation.copy()
        self.set(pose.position, pose.rotation)
        self._now = self._wanted

    def set(self, position: ArrayLike, rotation: ArrayLike | None = None) -> None:
        """Set the desired pose of the frame.

        Args:
            position: Position [m], (3,).
            rotation: Orientation, (3, 3); None keeps the last one.

        Raises:
            InvalidInputError: An array is not finite, has a wrong shape or is no rotation; the
                target stays as it was.
        """
        place = finite_array("position", position, (3,))
        turn = self._wanted[1] if rotation is None else finite_array("rotation", rotation, (3, 3))
        if np.abs(turn @ turn.T - np.eye(3)).max() > 1e-6 or np.linalg.det(turn) < 0.0:
            raise InvalidInputError("rotation", "is not a rotation matrix", rotation)
        self._wanted = place, turn

    @property
    def period(self) -> float:
        """Infinite: it does not repeat."""
        return math.inf

    def _targets(self, times: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.stack([self._move_to(t) for t in times.tolist()])

    def _move_to(self, t: float) -> NDArray[np.float64]:
        """Let the target move until time t; returns its data (18,)."""
        elapsed = 0.0 if self._time is None else t - self._time
        if elapsed > 0.0:
            (position, rotation), (place, turn) = self._now, self._wanted
            shift, axis = place - position, np.asarray(pin.log3(turn @ rotation.T))
            shift = shift * _share(float(np.linalg.norm(shift)), self.speed * elapsed)
            axis = axis * _share(float(np.linalg.norm(axis)), self.rate * elapsed)
            self._velocity = np.concatenate([shift, axis]) / elapsed
            self._now = position + shift, pin.exp3(axis) @ rotation
        if self._time is None or elapsed > 0.0:
            self._time = t
        position, rotation = self._now
        return np.concatenate([position, rotation.ravel(), self._velocity])

    def settings(self) -> dict[str, Any]:
        """Return name and speeds, in values that JSON knows."""
        return {"name": self.name, "speed": self.speed, "rate": self.rate}


def _share(size: float, most: float) -> float:
    """Return the share of a way that may be gone."""
    return 1.0 if size <= most else most / size
