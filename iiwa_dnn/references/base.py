"""The base of all references: a path, a place to start from, and targets along it."""

from __future__ import annotations

import copy
from abc import ABC, abstractmethod
from dataclasses import fields
from typing import Any, ClassVar, Protocol, TypeVar

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn.checks import Array, finite, finite_array, offers, positive, read_only
from iiwa_dnn.references.rotations import rotation_log
from iiwa_dnn.references.targets import Target, Targets

Self = TypeVar("Self", bound="Reference")  # typing.Self needs Python 3.11


class Pose(Protocol):
    """A pose to anchor a reference at; an ``iiwa_dnn.Configuration`` is one."""

    @property
    def position(self) -> NDArray[np.float64]:
        """Position [m], shape (3,)."""

    @property
    def rotation(self) -> NDArray[np.float64]:
        """Orientation, shape (3, 3)."""


_AT_REST = read_only(np.concatenate([np.zeros(3), np.eye(3).ravel(), np.zeros(6)]))


class Reference(ABC):
    """A path for a frame: positions, and the turns of its orientation if it has any.

    A subclass is a frozen dataclass of the path's parameters and gives `displacement` and
    `velocity`, and `turn` and `angular_velocity` where the frame turns; or, as the package's own
    paths do, a compiled form, `path`. Until :meth:`anchored` the origin is at position 0 with
    orientation identity.

    Attributes:
        name: Name of the path in settings and on the command line.
        path: Compiled form of the path, where it has one: it adds displacement and velocity at
            times (k,), with the path's `numbers`, to targets (k, 18) from a row and column on, and
            turns them.
        numbers: Constants of the compiled form, (c,).
        origin: Position of displacement 0 [m], shape (3,), read-only.
        orientation: Orientation that the turns begin from, shape (3, 3), read-only.
    """

    name: ClassVar[str]
    path: ClassVar[Any] = None
    numbers: Array = read_only(np.zeros(0))
    _base: Array = _AT_REST  # the target at the origin, at rest

    def __init_subclass__(cls) -> None:
        pair = (cls.turn is Reference.turn, cls.angular_velocity is Reference.angular_velocity)
        if pair[0] != pair[1]:
            raise TypeError(f"{cls.__name__} needs both turn and angular_velocity, or neither")

    @property
    def origin(self) -> Array:  # noqa: D102 - described in the class
        return read_only(self._base[:3])

    @property
    def orientation(self) -> Array:  # noqa: D102
        return read_only(self._base[3:12].reshape(3, 3))

    def at_rest(self: Self) -> Self:
        """Return a copy that begins at position 0 with orientation identity."""
        clone = copy.copy(self)
        clone._set(_base=_AT_REST)
        return clone

    def _set(self, **values: Any) -> None:
        """Set checked parameters of a frozen dataclass."""
        for name, value in values.items():
            object.__setattr__(self, name, value)

    def displacement(self, t: ArrayLike) -> NDArray[np.float64]:
        """Compute the displacement from the path's origin along the world's axes, zero at t = 0.

        Args:
            t: Times [s], shape (...,).

        Returns:
            Displacements [m], shape (..., 3).
        """
        return self._along(t)[..., :3]

    def velocity(self, t: ArrayLike) -> NDArray[np.float64]:
        """Compute the exact time derivative of :meth:`displacement`.

        Args:
            t: Times [s], shape (...,).

        Returns:
            Velocities [m/s], shape (..., 3).
        """
        return self._along(t)[..., 12:15]

    def turn(self, t: ArrayLike) -> NDArray[np.float64]:
        """Compute the rotation since t = 0, to be applied to the orientation there from the left.

        Args:
            t: Times [s], shape (...,).

        Returns:
            Rotation matrices, shape (..., 3, 3).
        """
        return self._along(t)[..., 3:12].reshape(*np.shape(t), 3, 3)

    def angular_velocity(self, t: ArrayLike) -> NDArray[np.float64]:
        """Compute the exact angular velocity of :meth:`turn`, along the world's axes.

        Args:
            t: Times [s], shape (...,).

        Returns:
            Angular velocities [rad/s], shape (..., 3).
        """
        return self._along(t)[..., 15:]

    @property
    def compiled(self) -> Any:
        """`path`, unless a subclass overrides what computes the targets; else None."""
        cls = type(self)
        same = (getattr(cls, name) is getattr(Reference, name) for name in _COMPUTING)
        return cls.path if all(same) else None

    @property
    def base(self) -> NDArray[np.float64]:
        """The target at the path's origin, at rest: `Target.data`, (18,)."""
        return self._base

    def _along(self, t: ArrayLike) -> NDArray[np.float64]:
        """Compute displacements, turns and velocities, in the places of targets, (..., 18)."""
        path, cls = self.compiled or type(self).path, type(self)
        methods = (cls.displacement, cls.velocity)
        if path is None and not {Reference.displacement, Reference.velocity}.isdisjoint(methods):
            raise TypeError(f"{cls.__name__} overrides neither displacement and velocity nor path")
        times = np.asarray(t, dtype=np.float64)
        moved = np.tile(_AT_REST, (times.size, 1))
        if path is not None:
            path(np.ascontiguousarray(times.ravel()), self.numbers, moved, 0, 0)
        return moved.reshape(*times.shape, _AT_REST.size)

    @property
    @abstractmethod
    def period(self) -> float:
        """Time after which the path repeats [s]; inf for one that does not."""

    @property
    def duration(self) -> float:
        """Time that the path takes once [s]."""
        return self.period

    def anchored(self: Self, pose: Pose) -> Self:
        """Return a copy that starts at a pose: displacements and turns stay about the same axes.

        Args:
            pose: The pose, for example an ``iiwa_dnn.Configuration``.

        Raises:
            InvalidInputError: If the pose is not finite or has wrong shapes.
        """
        clone, pose = copy.copy(self), offers("pose", pose, "position", "rotation")
        position = finite_array("position", pose.position, (3,))
        rotation = finite_array("rotation", pose.rotation, (3, 3))
        base = np.concatenate([position, rotation.ravel(), np.zeros(6)])
        clone._set(_base=read_only(base))
        return clone

    def ahead(self, dt: float) -> Reference:
        """Return the path with the mean twist over the next dt [s] in place of the targets' own."""
        return Ahead(self, positive("dt", dt))

    def at(self, t: float) -> Target:
        """Compute the target at time t [s].

        Raises:
            InvalidInputError: If ``t`` is not a finite number.
        """
        finite("t", t)
        return Target.from_data(self._targets(np.array([t], dtype=np.float64))[0])

    def sample(self, times: ArrayLike) -> Targets:
        """Compute the targets at times (k,) [s], in read-only arrays.

        Raises:
            InvalidInputError: If ``times`` is not a list of finite numbers.
        """
        return Targets.from_data(self._targets(finite_array("times", times, (-1,)).copy()))

    def accelerations(self, t: float) -> NDArray[np.float64]:
        """Compute the acceleration, linear [m/s^2] and angular [rad/s^2], at a time [s], (6,).

        By a difference of the exact twists to the fourth order, forward at t = 0, where many a path
        begins.
        """
        h = 1e-3
        nodes, weights = ((-2, -1, 1, 2), (1, -8, 8, -1)) if t >= 2 * h else (_AHEAD, _FORWARD)
        twists = self._targets(t + h * np.array(nodes, dtype=np.float64))[:, 12:]
        return np.array(weights) @ twists / (12.0 * h)

    def _targets(self, times: NDArray[np.float64]) -> NDArray[np.float64]:
        """Compute `Target.data` at times (k,), one a row."""
        targets = np.empty((times.size, _AT_REST.size))
        targets[:] = self._base
        if self.compiled is not None:
            self.compiled(times, self.numbers, targets, 0, 0)
        else:
            targets[:, :3] += self.displacement(times)
            targets[:, 12:15] = self.velocity(times)
            turned = self.turn(times) @ self.orientation
            targets[:, 3:12] = turned.reshape(-1, 9)
            targets[:, 15:] = self.angular_velocity(times)
        return targets

    def settings(self) -> dict[str, Any]:
        """Return name and parameters, in JSON types, to make the path again, not anchored."""
        parts = fields(self) if "__dataclass_fields__" in dir(self) else ()  # type: ignore[arg-type]
        values = {part.name: getattr(self, part.name) for part in parts if part.init}
        return {"name": self.name} | {name: _plain(value) for name, value in values.items()}


_AHEAD, _FORWARD = (0, 1, 2, 3, 4), (-25, 48, -36, 16, -3)

_COMPUTING = ("displacement", "velocity", "turn", "angular_velocity", "_targets")


class Ahead(Reference):
    """A path whose targets have the mean twist over the coming period in place of their own."""

    name: ClassVar[str] = "ahead"
    _seen: Reference
    _dt: float

    def __init__(self, along: Reference, dt: float) -> None:
        """Look at a path one period of dt [s] ahead."""
        self._set(_seen=along, _dt=dt, numbers=along.numbers, _base=along.base)

    @property
    def compiled(self) -> Any:
        """The compiled form, where the path has one."""
        return None if self._seen.compiled is None else self._write

    @property
    def period(self) -> float:
        """Time after which the path repeats [s]."""
        return self._seen.period

    def _write(self, times: Array, numbers: Array, out: Array, row: int, column: int) -> None:
        pairs = np.stack([times, times + self._dt], axis=1).ravel()
        _aim(self._seen._targets(pairs), self._dt, out, row, column)

    def _targets(self, times: Array) -> Array:
        out = np.empty((times.size, 18))
        self._write(times, self.numbers, out, 0, 0)
        return out


@njit(cache=True, error_model="numpy")
def _aim(pairs: Array, dt: float, out: Array, row: int, column: int) -> None:
    """Write the first of each two targets (2 k, 18), its twist the mean one between them."""
    relative = np.empty((3, 3))
    for k in range(pairs.shape[0] // 2):
        now, then = pairs[2 * k], pairs[2 * k + 1]
        target = out[row + k, column : column + 18]
        target[:12] = now[:12]
        for i in range(3):
            target[12 + i] = (then[i] - now[i]) / dt
            for j in range(3):
                a, b = 3 + 3 * i, 3 + 3 * j
                value = then[a] * now[b] + then[a + 1] * now[b + 1] + then[a + 2] * now[b + 2]
                relative[i, j] = value
        rotation_log(relative, target[15:18])
        target[15:18] /= dt


def _plain(value: Any) -> Any:
    """Return a parameter in JSON types."""
    if isinstance(value, Reference):
        return value.settings()
    return np.asarray(value).tolist() if isinstance(value, np.ndarray | tuple) else value
