"""References: a path, an origin to start from, and targets along it."""

from __future__ import annotations

import copy
from abc import ABC, abstractmethod
from dataclasses import fields, is_dataclass
from typing import Any, ClassVar, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn.checks import Array, finite, finite_array, offers, positive, read_only
from iiwa_dnn.compiling.library import entry
from iiwa_dnn.files import plain
from iiwa_dnn.references.rotations import set_mean_twist
from iiwa_dnn.references.targets import Target
from iiwa_dnn.robot import FrameState

Self = TypeVar("Self", bound="Reference")  # typing.Self needs Python 3.11


@entry
def enter_path(address: int, t: float, constants: Array, target: Array) -> None:
    """Enter a path's function at an address; it moves the target (18,) at time t [s]."""


AT_REST = read_only(np.concatenate([np.zeros(3), np.eye(3).ravel(), np.zeros(6)]))
"""Target at position 0 with orientation identity, at rest, `Target.data` (18,)."""


Pose = FrameState | Target
"""A pose to anchor a reference at: a `Configuration`, a frame of it, or a target."""


class Reference(ABC):
    """A path for a frame: positions, and the turns of its orientation if it has any.

    A subclass is a frozen dataclass of the path's parameters with a compiled function, `path`, or
    with a method `move` in Python. Either takes a target in place from the path's origin, at rest,
    to time t: adds the displacement, turns the rotation about the world's axes, sets the twist.
    Until :meth:`anchored` the origin is at position 0 with orientation identity.

    Attributes:
        path: Kernel or other function ``path(t, constants, target)``, on `Target.data` (18,).
        constants: Constants of `path`, shape (c,).
        base: Target at the origin, at rest, `Target.data` (18,), read-only.
    """

    path: ClassVar[Any]
    constants: Array = read_only(np.zeros(0))
    base: Array = AT_REST

    def _set(self, **values: Any) -> None:
        """Set checked parameters of a frozen dataclass."""
        for name, value in values.items():
            object.__setattr__(self, name, value)

    @property
    def name(self) -> str:
        """Name of the path in settings and on the command line: its class's, in small letters."""
        return type(self).__name__.lower()

    @property
    def compiled(self) -> Any:
        """The function `path`; None if a method `move` takes its place."""
        return self.path if type(self).move is Reference.move else None

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
            InvalidInputError: If the pose is not finite, has wrong shapes or is no rotation.
        """
        offers("pose", pose, "position", "rotation")
        clone = copy.copy(self)
        clone._set(base=read_only(Target(pose.position, pose.rotation).data))
        return clone

    def move(self, t: float, target: Array) -> None:
        """Take a target at the path's origin, at rest, to time t [s] in place.

        Args:
            t: Time [s].
            target: The target, `Target.data` (18,); a copy of :attr:`base`, for example.
        """
        enter_path(enter_path.address(self.path), t, self.constants, target)

    def at(self, t: float) -> Target:
        """Compute the target at time t [s].

        Raises:
            InvalidInputError: If ``t`` is not a finite number.
        """
        target = self.base.copy()
        self.move(finite("t", t), target)
        return Target.from_data(target)

    def sample(self, times: ArrayLike) -> Target:
        """Compute the targets at times (k,) [s], as one `Target` of arrays (k, ...).

        Raises:
            InvalidInputError: If ``times`` is not a list of finite numbers.
        """
        checked = finite_array("times", times, (-1,))
        targets = np.tile(self.base, (checked.size, 1))
        for t, target in zip(checked.tolist(), targets, strict=True):
            self.move(t, target)
        return Target.from_data(targets)

    def ahead(self, dt: float) -> Reference:
        """Return the path with the mean twist over the next dt [s] in place of the targets' own."""
        return Ahead(self, positive("dt", dt))

    def settings(self) -> dict[str, Any]:
        """Return name and parameters, in JSON types, to make the path again, not anchored."""
        own: Any = self
        names = [part.name for part in fields(own) if part.init] if is_dataclass(own) else []
        values = {name: getattr(self, name) for name in names}
        return {"name": self.name} | {
            name: value.settings() if isinstance(value, Reference) else plain(value)
            for name, value in values.items()
        }


class Ahead(Reference):
    """A path whose targets have the mean twist over the coming period in place of their own."""

    def __init__(self, along: Reference, dt: float) -> None:
        """Look at a path one period of dt [s] ahead."""
        self.along = along
        self.dt = dt
        self.base = along.base

    @property
    def period(self) -> float:
        """Time after which the path repeats [s]."""
        return self.along.period

    def move(self, t: float, target: Array) -> None:
        """Take a target to time t [s]; see `Reference.move`."""
        then = target.copy()
        self.along.move(t, target)
        self.along.move(t + self.dt, then)
        set_mean_twist(target, then, self.dt)

    def settings(self) -> dict[str, Any]:
        """Return those of the path that is seen ahead."""
        return self.along.settings()
