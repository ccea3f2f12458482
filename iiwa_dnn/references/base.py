"""References: a path, an origin to start from, and targets along it."""

from __future__ import annotations

import copy
from abc import ABC, abstractmethod
from dataclasses import fields, is_dataclass
from typing import Any, ClassVar, NamedTuple, Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn.checks import Array, finite, finite_array, offers, positive, read_only
from iiwa_dnn.references.rotations import move_target, set_mean_twist
from iiwa_dnn.references.targets import Target, Targets

Self = TypeVar("Self", bound="Reference")  # typing.Self needs Python 3.11

AT_REST = read_only(np.concatenate([np.zeros(3), np.eye(3).ravel(), np.zeros(6)]))
"""Target at position 0 with orientation identity, at rest, `Target.data` (18,)."""


class Pose(Protocol):
    """A pose to anchor a reference at; an ``iiwa_dnn.Configuration`` is one."""

    @property
    def position(self) -> NDArray[np.float64]:
        """Position [m], shape (3,)."""

    @property
    def rotation(self) -> NDArray[np.float64]:
        """Orientation, shape (3, 3)."""


class Motion(NamedTuple):
    """Displacement, turn and velocities of a path at one time, along the world's axes.

    Attributes:
        displacement: From the path's origin [m], shape (3,), zero at t = 0.
        velocity: Exact time derivative of the displacement [m/s], shape (3,).
        turn: Rotation since t = 0, applied to the orientation there from the left, shape (3, 3).
        angular_velocity: Exact angular velocity of the turn [rad/s], shape (3,).
    """

    displacement: Array
    velocity: Array
    turn: Array = read_only(np.eye(3))
    angular_velocity: Array = read_only(np.zeros(3))


class Reference(ABC):
    """A path for a frame: positions, and the turns of its orientation if it has any.

    A subclass is a frozen dataclass of the path's parameters. It gives `motion` in numpy, or, as
    the package's own paths do, a compiled function, `path`. Until :meth:`anchored` the origin is
    at position 0 with orientation identity.

    An older form of `motion` is read too: the methods `displacement` and `velocity` in pairs, and
    `turn` and `angular_velocity`, overridden.

    Attributes:
        name: Name of the path in settings and on the command line.
        path: Compiled function ``path(t, constants, target)``, if there is one. It takes the
            target at the origin, at rest, `Target.data` (18,), to time t [s] in place: adds the
            displacement, turns the rotation, sets the twist.
        compiled: `path`; None if a subclass overrides what it computes.
        constants: Constants of `path`, shape (c,).
        base: Target at the origin, at rest, `Target.data` (18,), read-only.
        origin: Position of displacement 0 [m], shape (3,), read-only.
        orientation: Orientation that the turns begin from, shape (3, 3), read-only.
    """

    name: ClassVar[str]
    path: ClassVar[Any] = None
    compiled: ClassVar[Any] = None
    constants: Array = read_only(np.zeros(0))
    base: Array = AT_REST
    _overridden: ClassVar[tuple[str, ...]] = ()

    def __init_subclass__(cls) -> None:
        readers = Motion._fields
        cls._overridden = tuple(x for x in readers if getattr(cls, x) is not getattr(Reference, x))
        for pair in (readers[:2], readers[2:]):
            if len(set(pair) & set(cls._overridden)) == 1:
                raise TypeError(f"{cls.__name__} needs both {' and '.join(pair)}, or neither")
        plain = cls.motion is not Reference.motion
        if plain and cls._overridden:
            raise TypeError(f"{cls.__name__} has {cls._overridden[0]} beside motion: give one form")
        if cls.path is not None and not plain and not cls._overridden:
            cls.compiled = staticmethod(cls.path)
        else:
            cls.compiled = None

    def _set(self, **values: Any) -> None:
        """Set checked parameters of a frozen dataclass."""
        for name, value in values.items():
            object.__setattr__(self, name, value)

    @property
    def origin(self) -> Array:  # noqa: D102 - described in the class
        return read_only(self.base[:3])

    @property
    def orientation(self) -> Array:  # noqa: D102
        return read_only(self.base[3:12].reshape(3, 3))

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
        offers("pose", pose, "position", "rotation")
        position = finite_array("position", pose.position, (3,))
        rotation = finite_array("rotation", pose.rotation, (3, 3))
        return self._based(np.concatenate([position, rotation.ravel(), np.zeros(6)]))

    def at_rest(self: Self) -> Self:
        """Return a copy that begins at position 0 with orientation identity."""
        return self._based(AT_REST)

    def _based(self: Self, base: Array) -> Self:
        clone = copy.copy(self)
        clone._set(base=read_only(base))
        return clone

    def motion(self, t: float) -> Motion:
        """Compute displacement, velocity, turn and angular velocity at time t [s].

        Raises:
            TypeError: If the class gives neither `motion` nor `path`.
        """
        target = AT_REST.copy()
        if self.path is not None:
            self.path(t, self.constants, target)
        elif "displacement" not in self._overridden:
            raise TypeError(f"{type(self).__name__} gives neither motion nor path")
        motion = Motion(target[:3], target[12:15], target[3:12].reshape(3, 3), target[15:])
        return motion._replace(**{name: getattr(self, name)(t) for name in self._overridden})

    def move(self, t: float, target: Array) -> None:
        """Take a target at the path's origin, at rest, to time t [s] in place.

        Args:
            t: Time [s].
            target: The target, `Target.data` (18,); a copy of :attr:`base`, for example.
        """
        if self.compiled is not None:
            self.compiled(t, self.constants, target)
            return
        motion = self.motion(t)
        turn = np.ravel(motion.turn)
        twist = (motion.velocity, motion.angular_velocity)
        move_target(target, np.concatenate([motion.displacement, turn, *twist]))

    def at(self, t: float) -> Target:
        """Compute the target at time t [s].

        Raises:
            InvalidInputError: If ``t`` is not a finite number.
        """
        target = self.base.copy()
        self.move(finite("t", t), target)
        return Target.from_data(target)

    def sample(self, times: ArrayLike) -> Targets:
        """Compute the targets at times (k,) [s], in read-only arrays.

        Raises:
            InvalidInputError: If ``times`` is not a list of finite numbers.
        """
        checked = finite_array("times", times, (-1,))
        targets = np.tile(self.base, (checked.size, 1))
        for t, target in zip(checked.tolist(), targets, strict=True):
            self.move(t, target)
        return Targets.from_data(targets)

    def ahead(self, dt: float) -> Reference:
        """Return the path with the mean twist over the next dt [s] in place of the targets' own."""
        return Ahead(self, positive("dt", dt))

    def accelerations(self, t: float) -> NDArray[np.float64]:
        """Compute the acceleration, linear [m/s^2] and angular [rad/s^2], at a time [s], (6,).

        By a difference of the exact twists to the fourth order, forward at t = 0, where many a path
        begins.
        """
        h = 1e-3
        nodes, weights = _CENTRAL if t >= 2 * h else _FORWARD
        return weights @ self.sample(t + h * nodes).data[:, 12:] / (12.0 * h)

    def displacement(self, t: ArrayLike) -> NDArray[np.float64]:
        """Compute the displacement from the path's origin along the world's axes, zero at t = 0.

        Args:
            t: Times [s], shape (...,).

        Returns:
            Displacements [m], shape (..., 3).
        """
        return self._read(t)[..., :3]

    def velocity(self, t: ArrayLike) -> NDArray[np.float64]:
        """Compute the exact time derivative of :meth:`displacement`.

        Args:
            t: Times [s], shape (...,).

        Returns:
            Velocities [m/s], shape (..., 3).
        """
        return self._read(t)[..., 12:15]

    def turn(self, t: ArrayLike) -> NDArray[np.float64]:
        """Compute the rotation since t = 0, to be applied to the orientation there from the left.

        Args:
            t: Times [s], shape (...,).

        Returns:
            Rotation matrices, shape (..., 3, 3).
        """
        return self._read(t)[..., 3:12].reshape(*np.shape(t), 3, 3)

    def angular_velocity(self, t: ArrayLike) -> NDArray[np.float64]:
        """Compute the exact angular velocity of :meth:`turn`, along the world's axes.

        Args:
            t: Times [s], shape (...,).

        Returns:
            Angular velocities [rad/s], shape (..., 3).
        """
        return self._read(t)[..., 15:]

    def _read(self, t: ArrayLike) -> NDArray[np.float64]:
        """Compute displacements, turns and velocities in the columns of targets, (..., 18)."""
        times = np.asarray(t, dtype=np.float64)
        targets = np.tile(AT_REST, (times.size, 1))
        # An overridden reader may call the one that it overrides: that one reads the path.
        plain = self.path is None or type(self).motion is not Reference.motion
        for time, target in zip(times.ravel().tolist(), targets, strict=True):
            if plain:
                self.move(time, target)
            else:
                self.path(time, self.constants, target)
        return targets.reshape(*times.shape, AT_REST.size)

    def settings(self) -> dict[str, Any]:
        """Return name and parameters, in JSON types, to make the path again, not anchored."""
        own: Any = self
        names = [part.name for part in fields(own) if part.init] if is_dataclass(own) else []
        return {"name": self.name} | {name: _plain(getattr(self, name)) for name in names}


_CENTRAL = (np.array([-2.0, -1.0, 1.0, 2.0]), np.array([1.0, -8.0, 8.0, -1.0]))
_FORWARD = (np.arange(5.0), np.array([-25.0, 48.0, -36.0, 16.0, -3.0]))
"""Nodes and weights of the differences, in steps and twelfths of a step."""


class Ahead(Reference):
    """A path whose targets have the mean twist over the coming period in place of their own."""

    name: ClassVar[str] = "ahead"

    def __init__(self, along: Reference, dt: float) -> None:
        """Look at a path one period of dt [s] ahead."""
        self._along = along
        self._dt = dt
        self.base = along.base

    @property
    def period(self) -> float:
        """Time after which the path repeats [s]."""
        return self._along.period

    def move(self, t: float, target: Array) -> None:
        """Take a target to time t [s]; see `Reference.move`."""
        then = target.copy()
        self._along.move(t, target)
        self._along.move(t + self._dt, then)
        set_mean_twist(target, then, self._dt)


def _plain(value: Any) -> Any:
    """Return a parameter in JSON types."""
    if isinstance(value, Reference):
        return value.settings()
    return np.asarray(value).tolist() if isinstance(value, np.ndarray | tuple) else value
