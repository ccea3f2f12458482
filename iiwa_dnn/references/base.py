"""What every reference is: a path, a place to start from, and targets along it."""

from __future__ import annotations

import copy
from abc import ABC, abstractmethod
from dataclasses import fields
from typing import Any, ClassVar, Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn.checks import finite_array
from iiwa_dnn.references.targets import Target, Targets

Self = TypeVar("Self", bound="Reference")  # typing.Self needs Python 3.11


class Pose(Protocol):
    """What :meth:`Reference.anchored` needs; an ``iiwa_dnn.Configuration`` is one."""

    @property
    def position(self) -> NDArray[np.float64]:
        """Position [m], shape (3,)."""

    @property
    def rotation(self) -> NDArray[np.float64]:
        """Orientation, shape (3, 3)."""


def _read_only(array: NDArray[np.float64]) -> NDArray[np.float64]:
    array.setflags(write=False)
    return array


_AT_REST = _read_only(np.zeros(3))


class Reference(ABC):
    """A path for the tip, with a fixed orientation.

    A subclass says how far the path is from its own origin and how fast it runs; where the origin
    lies, :meth:`anchored` says: until then at position 0 with orientation identity. References are
    immutable, and a subclass is a frozen dataclass of the path's parameters.

    Attributes:
        name: What the path is called in settings and on the command line.
        origin: Position that displacement 0 stands for [m], shape (3,), read-only.
        orientation: Orientation at all times, shape (3, 3), read-only.
    """

    name: ClassVar[str]
    origin: NDArray[np.float64] = _read_only(np.zeros(3))
    orientation: NDArray[np.float64] = _read_only(np.eye(3))

    @abstractmethod
    def displacement(self, t: ArrayLike) -> NDArray[np.float64]:
        """Displacement from the path's origin along the world's axes, zero at t = 0.

        Args:
            t: Times [s], shape (...,).

        Returns:
            Displacements [m], shape (..., 3).
        """

    @abstractmethod
    def velocity(self, t: ArrayLike) -> NDArray[np.float64]:
        """Time derivative of :meth:`displacement`, exact.

        Args:
            t: Times [s], shape (...,).

        Returns:
            Velocities [m/s], shape (..., 3).
        """

    @property
    @abstractmethod
    def period(self) -> float:
        """Time after which the path repeats [s]; inf for one that does not."""

    @property
    def duration(self) -> float:
        """Time that the path takes once [s]."""
        return self.period

    def anchored(self: Self, pose: Pose) -> Self:
        """The same path, starting at a pose and keeping its orientation.

        The path is moved, not turned: displacements stay along the world's axes.

        Args:
            pose: The pose, for example an ``iiwa_dnn.Configuration``.

        Returns:
            A new reference; this one is unchanged.

        Raises:
            InvalidInputError: If the pose is not finite or has wrong shapes.
        """
        clone = copy.copy(self)
        object.__setattr__(clone, "origin", finite_array("position", pose.position, (3,)))
        object.__setattr__(clone, "orientation", finite_array("rotation", pose.rotation, (3, 3)))
        return clone

    def at(self, t: float) -> Target:
        """The target at one time. For many times, :meth:`sample` is far faster.

        Args:
            t: Time [s].

        Returns:
            The target.

        Raises:
            InvalidInputError: If ``t`` is not a finite number.
        """
        now = finite_array("t", t, ())
        return Target(
            position=self.origin + self.displacement(now),
            rotation=self.orientation,
            linear_velocity=self.velocity(now),
        )

    def sample(self, times: ArrayLike) -> Targets:
        """The targets at many times.

        Args:
            times: Times [s], shape (k,).

        Returns:
            The targets, in read-only arrays.

        Raises:
            InvalidInputError: If ``times`` is not a list of finite numbers.
        """
        t = finite_array("times", times, (-1,))
        return Targets(
            position=self.origin + self.displacement(t),
            rotation=self.orientation,
            linear_velocity=self.velocity(t),
            angular_velocity=_AT_REST,
        )

    def settings(self) -> dict[str, Any]:
        """Name and parameters of the path, in values that JSON knows; not where it is anchored.

        Returns:
            A dictionary from which the path can be made again.
        """
        parameters = [f.name for f in fields(self) if f.init]  # type: ignore[arg-type]
        values = {name: getattr(self, name) for name in parameters}
        return {"name": self.name} | {
            name: np.asarray(value).tolist() if isinstance(value, np.ndarray | tuple) else value
            for name, value in values.items()
        }


def phase(t: ArrayLike, period: float) -> NDArray[np.float64]:
    """Phase of a periodic path, 2 pi t / period [rad], with an axis for x, y, z to broadcast along.

    Args:
        t: Times [s], shape (...,).
        period: The period [s].

    Returns:
        The phase [rad], shape (..., 1).
    """
    return (2.0 * np.pi / period) * np.asarray(t, dtype=np.float64)[..., np.newaxis]
