"""Targets: where the tip should be, and how it should move, at one time or at many."""

from __future__ import annotations

from operator import index
from typing import SupportsIndex

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn.checks import finite_array, read_only

_SIZE = 18


class Target:
    """Where the tip should be at one time, and how it should move; all along the world's axes.

    Attributes:
        data: All numbers, [position | rotation row by row | linear | angular velocity], (18,). One
            array, so that a control step hands it to compiled code in one piece; do not write
            into it (it is not protected, as `Configuration.arrays` are not).
        position: Desired position [m], shape (3,), a read-only view like the next three.
        rotation: Desired orientation, shape (3, 3).
        linear_velocity: Desired linear velocity [m/s], shape (3,).
        angular_velocity: Desired angular velocity [rad/s], shape (3,).
    """

    __slots__ = ("data",)

    def __init__(
        self,
        position: ArrayLike,
        rotation: ArrayLike,
        linear_velocity: ArrayLike = (0.0, 0.0, 0.0),
        angular_velocity: ArrayLike = (0.0, 0.0, 0.0),
    ) -> None:
        """Copy the four arrays into one.

        Raises:
            InvalidInputError: An array is not finite or has a wrong shape; it is named.
        """
        self.data: NDArray[np.float64] = np.concatenate(
            [
                finite_array("position", position, (3,)),
                finite_array("rotation", rotation, (3, 3)).ravel(),
                finite_array("linear_velocity", linear_velocity, (3,)),
                finite_array("angular_velocity", angular_velocity, (3,)),
            ]
        )

    @classmethod
    def from_data(cls, data: NDArray[np.float64]) -> Target:
        """A target over an existing `data` array, which is neither copied nor checked."""
        target = cls.__new__(cls)
        target.data = data
        return target

    @property
    def position(self) -> NDArray[np.float64]:  # noqa: D102 - described in the class
        return read_only(self.data[:3])

    @property
    def rotation(self) -> NDArray[np.float64]:  # noqa: D102
        return read_only(self.data[3:12].reshape(3, 3))

    @property
    def linear_velocity(self) -> NDArray[np.float64]:  # noqa: D102
        return read_only(self.data[12:15])

    @property
    def angular_velocity(self) -> NDArray[np.float64]:  # noqa: D102
        return read_only(self.data[15:])

    def __repr__(self) -> str:
        position = np.array2string(self.position, precision=4, separator=", ")
        return f"<Target at {position} m>"


class Targets:
    """Targets at k times; ``targets[i]`` is the i-th :class:`Target`, a view of this array.

    Attributes:
        data: One target a row, (k, 18); do not write into it.
        position: Desired positions [m], shape (k, 3), a read-only view like the next three.
        rotation: Desired orientations, shape (k, 3, 3).
        linear_velocity: Desired linear velocities [m/s], shape (k, 3).
        angular_velocity: Desired angular velocities [rad/s], shape (k, 3).
    """

    __slots__ = ("data",)

    def __init__(
        self,
        position: NDArray[np.float64],
        rotation: NDArray[np.float64],
        linear_velocity: NDArray[np.float64],
        angular_velocity: NDArray[np.float64],
    ) -> None:
        """Copy the four arrays into one; `rotation` and `angular_velocity` may be for all times."""
        count = len(position)
        data = np.empty((count, _SIZE))
        data[:, :3] = position
        data[:, 3:12] = rotation.reshape(-1, 9)
        data[:, 12:15] = linear_velocity
        data[:, 15:] = angular_velocity
        self.data: NDArray[np.float64] = data

    @classmethod
    def from_data(cls, data: NDArray[np.float64]) -> Targets:
        """Return targets over an existing `data` array (k, 18), neither copied nor checked."""
        targets = cls.__new__(cls)
        targets.data = data
        return targets

    @property
    def position(self) -> NDArray[np.float64]:  # noqa: D102 - described in the class
        return read_only(self.data[:, :3])

    @property
    def rotation(self) -> NDArray[np.float64]:  # noqa: D102
        return read_only(self.data[:, 3:12].reshape(-1, 3, 3))

    @property
    def linear_velocity(self) -> NDArray[np.float64]:  # noqa: D102
        return read_only(self.data[:, 12:15])

    @property
    def angular_velocity(self) -> NDArray[np.float64]:  # noqa: D102
        return read_only(self.data[:, 15:])

    def __len__(self) -> int:
        return len(self.data)

    def __getitem__(self, i: SupportsIndex) -> Target:
        return Target.from_data(self.data[index(i)])
