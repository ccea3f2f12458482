"""Paths without turns: heart, circle, line, Lissajous figure; and a pose that is held.

The compiled function above each class is its `Reference.path`.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from iiwa_dnn.checks import Array, Checks, Vector3, direction, positive, vector3
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.compiling.trigonometry import sin, sin_cos
from iiwa_dnn.references.base import Reference, SoftStart, soft_clock
from iiwa_dnn.references.targets import TargetData


class HeartConstants(Record):
    """Scale [m] and angular rate [rad/s] of a heart."""

    scale: float
    rate: float


@compiled
def heart_path(t: float, constants: Array, target: TargetData) -> None:
    """Move a target, at rest at the path's origin, to time t [s] of `Heart`, in place."""
    own = HeartConstants.of(constants)
    p = own.rate * t
    s1, c1 = sin_cos(p)
    s2, c2 = sin_cos(2.0 * p)
    s3, c3 = sin_cos(3.0 * p)
    s4, c4 = sin_cos(4.0 * p)
    y = 13.0 * c1 - 5.0 * c2 - 2.0 * c3 - c4 - 5.0
    slope = -13.0 * s1 + 10.0 * s2 + 6.0 * s3 + 4.0 * s4
    target.position[0] += own.scale * 16.0 * s1 * s1 * s1
    target.position[1] += own.scale * y
    target.linear_velocity[0] += own.rate * own.scale * 48.0 * s1 * s1 * c1
    target.linear_velocity[1] += own.rate * own.scale * slope


@dataclass(frozen=True, eq=False)
class Heart(Reference):
    """The heart of the paper's section V-A, in a horizontal plane.

    With w = 2 pi / period and a = scale::

        x(t) = x(0) + 16 a sin^3(w t)
        y(t) = y(0) + a (13 cos(w t) - 5 cos(2 w t) - 2 cos(3 w t) - cos(4 w t)) - 5 a
        z(t) = z(0)

    It starts in the notch, at rest, with its point towards -y. The paper gives neither a nor w.
    Its run takes 10 s, hence the default period. The default scale is an inference: with it, the
    largest squared joint speed times the step of 1e-4 s is the 4.54e-6 of the paper's Table I, and
    the heart is 32 a = 0.110 m wide.

    Attributes:
        scale: The factor a [m].
        period: Time to go round once [s].

    Raises:
        InvalidInputError: If a parameter is not a finite number above zero.
    """

    path: ClassVar[Any] = staticmethod(heart_path)
    _checks: ClassVar[Checks] = {"scale": positive, "period": positive}
    scale: float = 3.45e-3
    period: float = 10.0

    @cached_property
    def constants(self) -> Array:
        """`HeartConstants`."""
        return HeartConstants.make(scale=self.scale, rate=2.0 * np.pi / self.period)


class LissajousConstants(Record):
    """Constants of a path that is a sine and a cosine on each axis.

    Attributes:
        begin: Length of the soft start [s].
        rates: Angular rates [rad/s].
        sines: Amplitudes of the sines [m].
        cosines: Amplitudes of the cosines [m].
    """

    begin: float
    rates: Array = part(3)
    sines: Array = part(3)
    cosines: Array = part(3)


@compiled
def lissajous_path(t: float, constants: Array, target: TargetData) -> None:
    """Move a target, at rest at the origin, to time t [s] of a `Lissajous`, `Circle` or `Line`."""
    own = LissajousConstants.of(constants)
    inner, pace = soft_clock(t, own.begin)
    for i in range(3):
        p = own.rates[i] * inner
        # -2 sin^2(p/2) is cos(p) - 1 without the cancellation near the start.
        half = sin(0.5 * p)
        sine, cosine = sin_cos(p)
        target.position[i] += own.sines[i] * sine - 2.0 * own.cosines[i] * half * half
        change = own.sines[i] * cosine - own.cosines[i] * sine
        target.linear_velocity[i] += own.rates[i] * pace * change


@dataclass(frozen=True, eq=False)
class Circle(SoftStart):
    """A circle at constant speed after a soft start, counter-clockwise about its normal.

    With w = 2 pi / period, (u, v, normal) right-handed and orthonormal, and the clock s of
    `SoftStart`::

        displacement(t) = radius ((cos(w s) - 1) u + sin(w s) v)

    u is the part of the world's x axis in the circle's plane, or of its y axis if x is nearly the
    normal.

    Attributes:
        radius: Radius [m].
        period: Time to go round once [s].
        normal: Direction of the circle's axis, of any length but 0; kept at length 1.
        begin: Length of the soft start [s], see `SoftStart`.

    Raises:
        InvalidInputError: If a parameter is not finite, radius or period is not above zero, or the
            normal is zero.
    """

    path: ClassVar[Any] = staticmethod(lissajous_path)
    _checks: ClassVar[Checks] = {"radius": positive, "period": positive, "normal": direction}
    radius: float = 0.05
    period: float = 10.0
    normal: Vector3 = (0.0, 0.0, 1.0)

    @cached_property
    def constants(self) -> Array:
        """`LissajousConstants`."""
        normal = np.array(self.normal)
        first = np.eye(3)[0 if abs(normal[0]) < 0.9 else 1]
        u = first - (first @ normal) * normal
        u *= self.radius / np.linalg.norm(u)
        return LissajousConstants.make(
            begin=self.begin,
            rates=np.full(3, 2.0 * np.pi / self.period),
            sines=np.cross(normal, u),
            cosines=u,
        )


@dataclass(frozen=True, eq=False)
class Line(Reference):
    """A straight line to a point and back, at rest at both ends.

    With w = 2 pi / period::

        displacement(t) = offset (1 - cos(w t)) / 2

    Attributes:
        offset: From the start to the far end [m], shape (3,).
        period: Time to go there and back [s].

    Raises:
        InvalidInputError: If a parameter is not finite or the period is not above zero.
    """

    path: ClassVar[Any] = staticmethod(lissajous_path)
    _checks: ClassVar[Checks] = {"offset": vector3, "period": positive}
    offset: Vector3 = (0.1, 0.0, 0.0)
    period: float = 10.0

    @cached_property
    def constants(self) -> Array:
        """`LissajousConstants`."""
        return LissajousConstants.make(
            begin=0.0,
            rates=np.full(3, 2.0 * np.pi / self.period),
            sines=np.zeros(3),
            cosines=-0.5 * np.array(self.offset),
        )


@dataclass(frozen=True, eq=False)
class Lissajous(SoftStart):
    """A Lissajous figure: on each axis a sine, closed if all turns are whole numbers.

    With w = 2 pi / period and the clock s of `SoftStart`, on each axis i::

        displacement_i(t) = amplitude_i (sin(turns_i w s + phase_i) - sin(phase_i))

    The default is a figure of eight in the horizontal plane.

    Attributes:
        amplitudes: Amplitudes on x, y, z [m], shape (3,).
        turns: Numbers of turns per period on x, y, z, shape (3,).
        phases: Phases at t = 0 on x, y, z [rad], shape (3,).
        period: Time to go round once [s].
        begin: Length of the soft start [s], see `SoftStart`.

    Raises:
        InvalidInputError: If a parameter is not finite or the period is not above zero.
    """

    path: ClassVar[Any] = staticmethod(lissajous_path)
    _checks: ClassVar[Checks] = {
        "amplitudes": vector3,
        "turns": vector3,
        "phases": vector3,
        "period": positive,
    }
    amplitudes: Vector3 = (0.05, 0.05, 0.0)
    turns: Vector3 = (1.0, 2.0, 1.0)
    phases: Vector3 = (0.0, 0.0, 0.0)
    period: float = 10.0

    @cached_property
    def constants(self) -> Array:
        """`LissajousConstants`."""
        amplitudes = np.array(self.amplitudes)
        return LissajousConstants.make(
            begin=self.begin,
            rates=2.0 * np.pi / self.period * np.array(self.turns),
            sines=amplitudes * np.cos(self.phases),
            cosines=amplitudes * np.sin(self.phases),
        )


@compiled
def fixed_path(t: float, constants: Array, target: TargetData) -> None:
    """Leave the target at its origin, at rest."""


@dataclass(frozen=True, eq=False)
class FixedPose(Reference):
    """A pose to go to and to hold: ``FixedPose().anchored(pose)``.

    Attributes:
        period: Length of a run without a duration [s], above 0.
    """

    path: ClassVar[Any] = staticmethod(fixed_path)
    _checks: ClassVar[Checks] = {"period": positive}
    period: float = 10.0
