"""Targets of the tip, at one time or at many: its desired pose and motion."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn import checks
from iiwa_dnn.checks import Array, Matrix
from iiwa_dnn.compiling.records import Record, part

_IDENTITY = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


class TargetData(Record):
    """Desired pose and twist of a frame along the world's axes, as compiled code reads them."""

    position: Array = part(3)
    rotation: Matrix = part(3, 3)
    linear_velocity: Array = part(3)
    angular_velocity: Array = part(3)


class Target:
    """A desired pose of the tip and its motion at one time, along the world's axes.

    `Reference.sample` returns the targets of k times in one, whose arrays have the times as their
    first axis: `data` (k, 18), `position` (k, 3) and so on; ``targets[i]`` is that of the i-th.

    Attributes:
        data: All numbers, those of a `TargetData`, (18,). One array, so that a control step hands
            it to compiled code in one piece; do not write into it (it is not protected, as
            `Configuration.arrays` are not).
    """

    __slots__ = ("data",)

    data: NDArray[np.float64]

    def __init__(
        self,
        position: ArrayLike | pin.SE3,
        rotation: ArrayLike = _IDENTITY,
        linear_velocity: ArrayLike = (0.0, 0.0, 0.0),
        angular_velocity: ArrayLike = (0.0, 0.0, 0.0),
    ) -> None:
        """Copy position, rotation and velocities into one array.

        Args:
            position: Desired position [m], (3,), or a pose that stands for position and rotation.
            rotation: Desired orientation, (3, 3); by default the identity. One that was rounded,
                to three digits at least, stands for the nearest rotation.
            linear_velocity: Desired linear velocity [m/s], (3,).
            angular_velocity: Desired angular velocity [rad/s], (3,).

        Raises:
            InvalidInputError: An array is not finite, has a wrong shape or is no rotation; it is
                named.
        """
        if isinstance(position, pin.SE3):
            rotation = position.rotation
            position = position.translation
        checked = checks.finite_array("position", position, (3,))
        turn = checks.rotation("rotation", rotation).ravel()
        linear = checks.finite_array("linear_velocity", linear_velocity, (3,))
        angular = checks.finite_array("angular_velocity", angular_velocity, (3,))
        self.data = np.concatenate([checked, turn, linear, angular])

    @classmethod
    def from_data(cls, data: NDArray[np.float64]) -> Target:
        """Make a target over an existing `data` array, which is neither copied nor checked."""
        target = cls.__new__(cls)
        target.data = data
        return target

    @property
    def position(self) -> NDArray[np.float64]:
        """Desired position [m], (3,), of k targets (k, 3); a read-only view."""
        return checks.read_only(self.data[..., :3])

    @property
    def rotation(self) -> NDArray[np.float64]:
        """Desired orientation, (3, 3), of k targets (k, 3, 3); a read-only view."""
        return checks.read_only(self.data[..., 3:12].reshape(*self.data.shape[:-1], 3, 3))

    @property
    def linear_velocity(self) -> NDArray[np.float64]:
        """Desired linear velocity [m/s], (3,), of k targets (k, 3); a read-only view."""
        return checks.read_only(self.data[..., 12:15])

    @property
    def angular_velocity(self) -> NDArray[np.float64]:
        """Desired angular velocity [rad/s], (3,), of k targets (k, 3); a read-only view."""
        return checks.read_only(self.data[..., 15:])

    def __repr__(self) -> str:
        if self.data.ndim > 1:
            return f"<{len(self.data)} targets>"
        parts = (self.position, pin.log3(self.rotation), *np.split(self.data[12:], 2))
        p, turn, v, rate = (np.round(part, 4).tolist() for part in parts)
        return f"Target(position={p} m, turned by {turn} rad, moving at {v} m/s, {rate} rad/s)"

    def __getitem__(self, i: int) -> Target:
        return Target.from_data(self.data[i])
