"""Base of the references: a path of a frame, targets along it, and a soft start."""

from __future__ import annotations

import copy
import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, field, fields, is_dataclass
from functools import cached_property
from typing import Any, ClassVar, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn.checks import (
    Array,
    Checked,
    Checks,
    finite,
    finite_array,
    not_negative,
    offers,
    positive,
    read_only,
)
from iiwa_dnn.compiling.library import compiled, entry
from iiwa_dnn.files import plain
from iiwa_dnn.references.rotations import set_mean_twist
from iiwa_dnn.references.targets import Target, TargetData
from iiwa_dnn.robot import FrameState

Self = TypeVar("Self", bound="Reference")  # typing.Self needs Python 3.11


@entry
def enter_path(address: int, t: float, constants: Array, target: TargetData) -> None:
    """Move `target`, which is at the path's origin, to time t [s] by the function at `address`.

    The path's constants are (c,).
    """


AT_REST = read_only(Target(np.zeros(3)).data)
"""Target at position 0 with orientation identity, at rest, `Target.data` (18,)."""


Pose = FrameState | Target
"""A pose to anchor a reference at: a `Configuration`, a frame of it, or a target."""


class Reference(Checked, ABC):
    """Base of the paths of a frame, with positions and orientations as functions of time.

    A subclass is a frozen dataclass of the path's parameters with a compiled function, `path`, or
    with a method `move` in Python. Both get a target at the path's origin, at rest, and move the
    target in place to time t: they add the displacement to the position, turn the rotation about
    the world's axes and set the twist. Until :meth:`anchored` is called, the origin is at position
    0 with orientation identity.

    Attributes:
        path: Kernel or other function ``path(t, constants, target)``, on a `TargetData`.
        base: Target at the origin, at rest, `Target.data` (18,), read-only.
    """

    path: ClassVar[Any]
    base: Array = AT_REST

    @cached_property
    def constants(self) -> Array:
        """Numbers that `path` reads, (c,); none by default."""
        return np.zeros(0)

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
        """Return a copy of the path that starts at a pose.

        Displacements keep their directions in the world's frame, and turns their axes; a `Cone`
        turns about the tool's axes at the pose.

        Args:
            pose: The pose, for example an ``iiwa_dnn.Configuration``.

        Raises:
            InvalidInputError: If the pose is not finite, has wrong shapes or is no rotation.
        """
        offers("pose", pose, "position", "rotation")
        clone = copy.copy(self)
        clone._set(base=read_only(Target(pose.position, pose.rotation).data))
        return clone

    def move(self, t: float, target: TargetData) -> None:
        """Move a target in place from the path's origin, at rest, to time t [s].

        Args:
            t: Time [s].
            target: A target at the origin, such as a copy of :attr:`base`.
        """
        enter_path(enter_path.address(self.path), t, self.constants, target)

    def at(self, t: float) -> Target:
        """Compute the target at time t [s].

        Raises:
            InvalidInputError: If ``t`` is not a finite number.
        """
        return self.sample([finite("t", t)])[0]

    def sample(self, times: ArrayLike) -> Target:
        """Compute the targets at times (k,) [s], as one `Target` of arrays (k, ...).

        Raises:
            InvalidInputError: If ``times`` is not a list of finite numbers.
        """
        checked = finite_array("times", times, (-1,))
        targets = np.tile(self.base, (checked.size, 1))
        for t, target in zip(checked.tolist(), targets, strict=True):
            self.move(t, TargetData.of(target))
        return Target.from_data(targets)

    def feed_forward(self, dt: float) -> Reference:
        """Return the path with the mean twist over the coming period of dt [s] in its targets."""
        return FeedForward(self, positive("dt", dt))

    def settings(self) -> dict[str, Any]:
        """Return the name and the parameters of the path, without its anchor, in JSON types."""
        own: Any = self
        names = [part.name for part in fields(own) if part.init] if is_dataclass(own) else []
        values = {name: getattr(self, name) for name in names}
        return {"name": self.name} | {
            name: value.settings() if isinstance(value, Reference) else plain(value)
            for name, value in values.items()
        }


@compiled
def soft_clock(t: float, begin: float) -> tuple[float, float]:
    """Compute a path's clock [s] and the clock's rate [1] at time t [s], by `SoftStart`."""
    if begin == 0.0:
        return t, 1.0
    if t >= begin:
        return t - 0.5 * begin, 1.0
    if t <= 0.0:
        return 0.0, 0.0
    u = t / begin
    return t * u * u * (1.0 - 0.5 * u), u * u * (3.0 - 2.0 * u)


@dataclass(frozen=True, eq=False)
class SoftStart(Reference):
    r"""A path that begins at rest by a change of its clock.

    Until t = begin the path's own time s rises with u = t / begin as

    .. math::

        s = begin\,(u^3 - u^4 / 2), \qquad \dot s = u^2 (3 - 2 u),

    then as t - begin / 2; before t = 0 the path rests. Velocity and acceleration are continuous,
    and the clock's acceleration is at most 1.5 / begin. The curve stays the same, and the path is
    back at its start later by half of `begin`.

    Attributes:
        begin: Length of the soft start [s]; 0 begins at full speed.
    """

    _checks: ClassVar[Checks] = {"begin": not_negative}
    begin: float = field(default=1.0, kw_only=True)

    @property
    def _round(self) -> float:
        """Time of a round at full speed [s]."""
        return self.period

    @property
    def duration(self) -> float:
        """Time until the path is back at its start, at full speed [s]."""
        lost = 0.5 * self.begin
        return lost + self._round * max(1, math.ceil(lost / self._round))


class FeedForward(Reference):
    """A path whose targets have the mean twist over the coming control period."""

    def __init__(self, reference: Reference, dt: float) -> None:
        """Wrap a path; the control period is dt [s]."""
        self.reference = reference
        self.dt = dt
        self.base = reference.base

    @property
    def period(self) -> float:
        """Time after which the path repeats [s]."""
        return self.reference.period

    def move(self, t: float, target: TargetData) -> None:
        """Move a target to time t [s], as `Reference.move` does."""
        then = target.copy()
        self.reference.move(t, target)
        self.reference.move(t + self.dt, then)
        set_mean_twist(target, then, self.dt)

    def settings(self) -> dict[str, Any]:
        """Return the settings of the path that is wrapped."""
        return self.reference.settings()
