"""Paths on which the tool turns: a cone, and a path with a tilting tool."""

import math
from dataclasses import dataclass, field, replace
from enum import IntEnum
from functools import cached_property, partial
from typing import Any, ClassVar

import numpy as np

from iiwa_dnn.checks import Array, Checks, Vector3, direction, integer, positive
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.compiling.trigonometry import sin_cos
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.references.base import Reference, SoftStart, soft_clock
from iiwa_dnn.references.rotations import column_of, combined, triple, turn_about, turn_target
from iiwa_dnn.references.shapes import Circle, fixed_path, heart_path, lissajous_path
from iiwa_dnn.references.targets import TargetData
from iiwa_dnn.references.waypoints import waypoints_path

TILT = math.radians(20.0)


class ConeConstants(Record):
    """Soft start [s], angle [rad] and angular rate [rad/s] of a cone."""

    begin: float
    angle: float
    rate: float


@compiled
def cone_path(t: float, constants: Array, target: TargetData) -> None:
    """Turn a target, at rest at the path's origin, to time t [s] of `Cone`, in place."""
    own = ConeConstants.of(constants)
    inner, pace = soft_clock(t, own.begin)
    rate = own.rate * pace
    p = own.rate * inner
    turn_about(target, column_of(target.rotation, 0), -own.angle, 0.0)
    # The tool's x and y axes where its z axis is the cone's; the tilt to the start is about x.
    u = column_of(target.rotation, 0)
    v = column_of(target.rotation, 1)
    sine, cosine = sin_cos(p)
    half, w = sin_cos(0.5 * own.angle)
    tilt = combined(half * cosine, u, half * sine, v)
    turn_target(target, w, tilt, 0.0, combined(half * rate * cosine, v, -half * rate * sine, u))


@dataclass(frozen=True, eq=False)
class Cone(SoftStart):
    """A cone that the tool's z axis sweeps while the tip stands still.

    With u the tool's x axis at the start, (u, v, cone's axis) right-handed, w = 2 pi / period and
    the clock s of `SoftStart`::

        turn(t) = exp(angle (cos(w s) u + sin(w s) v)) exp(-angle u)

    The tool does not spin about its own axis.

    Attributes:
        angle: Angle between the cone's axis and its side [rad].
        period: Time to go round once [s].
        begin: Length of the soft start [s], see `SoftStart`.

    Raises:
        InvalidInputError: If a parameter is out of range.
    """

    path: ClassVar[Any] = staticmethod(cone_path)
    _checks: ClassVar[Checks] = {"angle": positive, "period": positive}
    angle: float = TILT
    period: float = 10.0

    @cached_property
    def constants(self) -> Array:
        """`ConeConstants`."""
        rate = 2.0 * np.pi / self.period
        return ConeConstants.make(begin=self.begin, angle=self.angle, rate=rate)


class Along(IntEnum):
    """Functions of the paths that a tool can tilt along."""

    FIXED = 0
    HEART = 1
    LISSAJOUS = 2
    WAYPOINTS = 3


_ALONG = (fixed_path, heart_path, lissajous_path, waypoints_path)
"""The functions, in the order of `Along`."""


def _compiled_path(argument: str, value: Any) -> Reference:
    """Return a path that a tool can tilt along; refuse any other value."""
    if not isinstance(value, Reference) or value.compiled not in _ALONG:
        problem = "must be one of FixedPose, Heart, Circle, Line, Lissajous, Waypoints"
        raise InvalidInputError(argument, problem, value)
    return value


class TiltingConstants(Record):
    """Path (`Along`), soft start [s], and angle [rad], rate [rad/s] and axis of the tilt."""

    along: float
    begin: float
    angle: float
    rate: float
    axis: Array = part(3)


@compiled
def tilting_path(t: float, constants: Array, target: TargetData) -> None:
    """Move a target, at rest at the path's origin, to time t [s] of `Tilting`, in place.

    The constants are `TiltingConstants`, then those of the path along which the tool tilts.
    """
    own = TiltingConstants.of(constants[: TiltingConstants.width()])
    along = constants[TiltingConstants.width() :]
    kind = int(own.along)
    inner, pace = soft_clock(t, own.begin)
    if kind == Along.HEART:
        heart_path(inner, along, target)
    elif kind == Along.LISSAJOUS:
        lissajous_path(inner, along, target)
    elif kind == Along.WAYPOINTS:
        waypoints_path(inner, along, target)
    for i in range(3):
        target.linear_velocity[i] *= pace
        target.angular_velocity[i] *= pace
    sine, cosine = sin_cos(own.rate * inner)
    rate = own.angle * own.rate * pace * cosine
    turn_about(target, triple(own.axis), own.angle * sine, rate)


@dataclass(frozen=True, eq=False)
class Tilting(SoftStart):
    """A path on which the tool tilts to and fro about an axis; by default a circle.

    With w = 2 pi turns / period and the clock s of `SoftStart`, which is the path's too::

        turn(t) = exp(angle sin(w s) axis)

    applied after the turns that the path itself has, if any.

    Attributes:
        along: The path: a `FixedPose`, `Heart`, `Circle`, `Line`, `Lissajous` or `Waypoints`.
        angle: Largest tilt to either side [rad].
        axis: Axis in the world's frame, of any length but 0; kept at length 1.
        turns: Whole number of tilts to both sides, in a round on the path.
        begin: Length of the soft start of path and tilt [s], in place of the path's own.

    Raises:
        InvalidInputError: If a parameter is out of range.
    """

    path: ClassVar[Any] = staticmethod(tilting_path)
    _checks: ClassVar[Checks] = {
        "along": _compiled_path,
        "angle": positive,
        "axis": direction,
        "turns": partial(integer, least=1),
    }
    along: Reference = field(default_factory=Circle)
    angle: float = TILT
    axis: Vector3 = (1.0, 0.0, 0.0)
    turns: int = 1

    @cached_property
    def constants(self) -> Array:
        """`TiltingConstants`, and then those of the path."""
        # One clock for both.
        along = replace(self.along, begin=0.0) if isinstance(self.along, SoftStart) else self.along
        own = TiltingConstants.make(
            along=_ALONG.index(self.along.compiled),
            begin=self.begin,
            angle=self.angle,
            rate=2.0 * np.pi * self.turns / self._round,
            axis=self.axis,
        )
        return np.append(own.numbers, along.constants)

    @property
    def _round(self) -> float:
        """Time that the path takes once, without a soft start [s]."""
        return min(self.along.period, self.along.duration)

    @property
    def period(self) -> float:
        """Time after which the path repeats [s]."""
        return self.along.period
