"""Paths on which the tool turns: a cone, a path with a tilting tool, a path on a surface."""

import math
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
from numba import njit

from iiwa_dnn import checks
from iiwa_dnn.checks import Array, Vector3, direction, positive, vector3
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.references.base import Reference
from iiwa_dnn.references.rotations import (
    column_of,
    combined,
    cross,
    dot,
    left_jacobian,
    move_target,
    rotated,
    scaled,
    turn_target,
)
from iiwa_dnn.references.shapes import Circle, Heart

TILT = math.radians(20.0)


@njit(cache=True, error_model="numpy")
def _cone(t: float, constants: Array, target: Array) -> None:
    angle, rate = constants
    p = rate * t
    turn_target(target, scaled(-angle, column_of(target, 0)), (0.0, 0.0, 0.0))
    # The tool's x and y axes where its z axis is the cone's; the tilt to the start is about x.
    u = column_of(target, 0)
    v = column_of(target, 1)
    tilt = combined(angle * np.cos(p), u, angle * np.sin(p), v)
    speed = angle * rate
    turn_target(target, tilt, combined(speed * np.cos(p), v, -speed * np.sin(p), u))


@dataclass(frozen=True, eq=False)
class Cone(Reference):
    """A cone that the tool's z axis sweeps while the tip stands still.

    With u the tool's x axis at the start, (u, v, cone's axis) right-handed and w = 2 pi / period::

        turn(t) = exp(angle (cos(w t) u + sin(w t) v)) exp(-angle u)

    The tool does not spin about its own axis, and starts at its full rate.

    Attributes:
        angle: Angle between the cone's axis and its side, below pi / 2 [rad].
        period: Time to go round once [s].

    Raises:
        InvalidInputError: If a parameter is out of range.
    """

    name: ClassVar[str] = "cone"
    path: ClassVar[Any] = staticmethod(_cone)
    angle: float = TILT
    period: float = 10.0

    def __post_init__(self) -> None:
        self._set(angle=_acute(self.angle), period=positive("period", self.period))
        self._set(constants=np.array([self.angle, 2.0 * np.pi / self.period]))


@njit(cache=True, error_model="numpy")
def _tilt(t: float, constants: Array, target: Array) -> None:
    angle, rate, x, y, z = constants
    p = rate * t
    tilt = angle * np.sin(p)
    speed = angle * rate * np.cos(p)
    turn_target(target, scaled(tilt, (x, y, z)), scaled(speed, (x, y, z)))


@dataclass(frozen=True, eq=False)
class Tilting(Reference):
    """A path on which the tool tilts to and fro about an axis; by default a circle.

    With w = 2 pi turns / period::

        turn(t) = exp(angle sin(w t) axis)

    applied after the turns that the path itself has, if any.

    Attributes:
        along: The path.
        angle: Largest tilt to either side [rad].
        axis: Axis in the world's frame; its length does not matter.
        turns: Whole number of tilts to both sides, in a round on the path.

    Raises:
        InvalidInputError: If a parameter is out of range.
    """

    name: ClassVar[str] = "tilting"
    along: Reference = field(default_factory=Circle)
    angle: float = TILT
    axis: Vector3 = (1.0, 0.0, 0.0)
    turns: int = 1

    def __post_init__(self) -> None:
        checks.instance("along", self.along, Reference)
        rate = 2.0 * np.pi * checks.integer("turns", self.turns, 1) / self.along.duration
        self._set(along=self.along.at_rest(), angle=_acute(self.angle))
        self._set(axis=vector3("axis", self.axis))
        self._set(constants=np.array([self.angle, rate, *direction("axis", self.axis)]))

    @property
    def period(self) -> float:
        """Time after which the path repeats [s]."""
        return self.along.period

    @property
    def duration(self) -> float:
        """Time to take the path once [s]."""
        return self.along.duration

    def move(self, t: float, target: Array) -> None:
        """Take a target to time t [s]; see `Reference.move`."""
        move_target(target, self.along.at(t).data)
        _tilt(t, self.constants, target)


@njit(cache=True, error_model="numpy")
def _lay(t: float, constants: Array, inner: Array, target: Array) -> None:
    """Lay the displacement of `inner` (18,) on a surface, after the turn to its normal."""
    curvature, lead, n_x, n_y, n_z = constants
    normal = scaled(-1.0, column_of(target, 2))
    if lead > 0.0:
        tool = normal
        normal = (n_x, n_y, n_z)
        # Quintic, at rest and without acceleration at both ends.
        x = min(max(t / lead, 0.0), 1.0)
        fraction = x**3 * (10.0 - 15.0 * x + 6.0 * x**2)
        rate = 30.0 * x**2 * (1.0 - x) ** 2 / lead
        turn = _least_turn(tool, normal)
        turn_target(target, scaled(fraction, turn), scaled(rate, turn))
    # Height above the surface counts from the first point's.
    flat = _least_turn((0.0, 0.0, 1.0), normal)
    across = cross(normal, rotated(flat, (inner[0], inner[1], inner[2])))
    speed = (0.0, 0.0, 0.0)
    if t >= lead:
        speed = cross(normal, rotated(flat, (inner[12], inner[13], inner[14])))
    angles = scaled(curvature, across)
    moved = cross(across, left_jacobian(angles, normal))
    velocity = cross(left_jacobian(angles, speed), rotated(angles, normal))
    for i in range(3):
        target[i] += moved[i]
        target[12 + i] += velocity[i]
    turn_target(target, angles, scaled(curvature, speed))


@njit(cache=True, error_model="numpy")
def _least_turn(u: Vector3, v: Vector3) -> Vector3:
    """Compute the least rotation vector that takes unit vector u to v."""
    axis = cross(u, v)
    sine = np.sqrt(dot(axis, axis))
    cosine = dot(u, v)
    if sine > 1e-12:
        return scaled(np.arctan2(sine, cosine) / sine, axis)
    if cosine >= 0.0:
        return axis
    # Opposite vectors: half a turn about an axis across them.
    other = (1.0, 0.0, 0.0) if abs(u[0]) < 0.9 else (0.0, 1.0, 0.0)
    axis = cross(u, other)
    return scaled(np.pi / np.sqrt(dot(axis, axis)), axis)


@dataclass(frozen=True, eq=False)
class OnSurface(Reference):
    """A path laid on a plane or a sphere, the tool normal to it; by default the heart.

    The path's x-y plane becomes the tangent plane at the start, z the outward normal n; with d the
    displacement in that plane and r the radius, the exponential map of the sphere gives::

        displacement = r (exp((n x d) / r) n - n),    turn = exp((n x d) / r)

    and in the limit of a plane d and no turn. The path's height above its x-y plane and its own
    turns are not taken. The tool's z axis points into the surface. If there is a `normal`, the tool
    first turns to it on the spot, for `lead` seconds.

    Attributes:
        along: The path.
        radius: Radius of the sphere [m]; None: a plane.
        normal: Outward normal at the start in the world's frame; None: the tool's -z axis there.
        lead: Time to turn the tool to `normal` [s].

    Raises:
        InvalidInputError: If a parameter is out of range.
    """

    name: ClassVar[str] = "on-surface"
    along: Reference = field(default_factory=Heart)
    radius: float | None = None
    normal: Vector3 | None = None
    lead: float = 2.0

    def __post_init__(self) -> None:
        checks.instance("along", self.along, Reference)
        self._set(along=self.along.at_rest(), lead=positive("lead", self.lead))
        curvature = 0.0 if self.radius is None else 1.0 / positive("radius", self.radius)
        lead = 0.0
        normal: Vector3 = (0.0, 0.0, 0.0)
        if self.normal is not None:
            self._set(normal=vector3("normal", self.normal))
            lead = self.lead
            normal = direction("normal", self.normal)
        self._set(constants=np.array([curvature, lead, *normal]))

    @property
    def period(self) -> float:
        """Time after which the path repeats [s]; inf where the tool turns first."""
        return self.along.period if self.normal is None else math.inf

    @property
    def duration(self) -> float:
        """Time to turn the tool and to take the path once [s]."""
        return self.along.duration + (0.0 if self.normal is None else self.lead)

    def move(self, t: float, target: Array) -> None:
        """Take a target to time t [s]; see `Reference.move`."""
        inner = self.along.at(t if self.normal is None else max(t - self.lead, 0.0))
        _lay(t, self.constants, inner.data, target)


def _acute(angle: float) -> float:
    """Return an angle between 0 and pi / 2, or raise InvalidInputError."""
    if not 0.0 < positive("angle", angle) < 0.5 * math.pi:
        raise InvalidInputError("angle", f"must be below pi / 2, not {angle}", angle)
    return float(angle)
