"""Targets of the tip, at one time or at many: its desired pose and motion."""

from operator import index
from typing import SupportsIndex, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn import checks
from iiwa_dnn.checks import finite_array, read_only

Self = TypeVar("Self", bound="_Data")  # typing.Self needs Python 3.11


class _Data:
    """Numbers of targets, (..., 18), and read-only views of their parts."""

    __slots__ = ("data",)

    data: NDArray[np.float64]

    @classmethod
    def from_data(cls: type[Self], data: NDArray[np.float64]) -> Self:
        """Make targets over an existing `data` array, which is neither copied nor checked."""
        targets = cls.__new__(cls)
        targets.data = data
        return targets

    @property
    def position(self) -> NDArray[np.float64]:
        return read_only(self.data[..., :3])

    @property
    def rotation(self) -> NDArray[np.float64]:
        return read_only(self.data[..., 3:12].reshape(*self.data.shape[:-1], 3, 3))

    @property
    def linear_velocity(self) -> NDArray[np.float64]:
        return read_only(self.data[..., 12:15])

    @property
    def angular_velocity(self) -> NDArray[np.float64]:
        return read_only(self.data[..., 15:])


class Target(_Data):
    """A desired pose of the tip and its motion at one time, along the world's axes.

    Attributes:
        data: All numbers, [position | rotation row by row | linear | angular velocity], (18,). One
            array, so that a control step hands it to compiled code in one piece; do not write
            into it (it is not protected, as `Configuration.arrays` are not).
        position: Desired position [m], shape (3,), a read-only view like the next three.
        rotation: Desired orientation, shape (3, 3).
        linear_velocity: Desired linear velocity [m/s], shape (3,).
        angular_velocity: Desired angular velocity [rad/s], shape (3,).
    """

    __slots__ = ()

    def __init__(
        self,
        position: ArrayLike,
        rotation: ArrayLike,
        linear_velocity: ArrayLike = (0.0, 0.0, 0.0),
        angular_velocity: ArrayLike = (0.0, 0.0, 0.0),
    ) -> None:
        """Copy the four arrays into one.

        Raises:
            InvalidInputError: An array is not finite, has a wrong shape or is no rotation; it is
                named.
        """
        checked = finite_array("position", position, (3,))
        turn = checks.rotation("rotation", rotation).ravel()
        linear = finite_array("linear_velocity", linear_velocity, (3,))
        angular = finite_array("angular_velocity", angular_velocity, (3,))
        self.data = np.concatenate([checked, turn, linear, angular])

    def __repr__(self) -> str:
        position = np.array2string(self.position, precision=4, separator=", ")
        return f"<Target at {position} m>"


class Targets(_Data):
    """Targets at k times: the arrays of `Target`, (k, 18), (k, 3) and so on, one time a row.

    ``targets[i]`` is the i-th :class:`Target`, a view of them.
    """

    __slots__ = ()

    def __len__(self) -> int:
        return len(self.data)

    def __getitem__(self, i: SupportsIndex) -> Target:
        return Target.from_data(self.data[index(i)])
