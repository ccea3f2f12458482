"""Paths on which the tool turns: a cone, a path with a tilting tool, a path on a surface."""

import math
from abc import abstractmethod
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
from numba import njit

from iiwa_dnn import checks
from iiwa_dnn.checks import Array, Vector3, direction, positive, vector3
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.references.base import Reference
from iiwa_dnn.references.rotations import cross, left_jacobian, rotated, turn_target
from iiwa_dnn.references.shapes import Circle, Heart

TILT = math.radians(20.0)


@njit(cache=True, error_model="numpy")
def _cone(times: Array, numbers: Array, out: Array, row: int, column: int) -> None:
    """Turn targets (k, 18) in `out`; see `Reference.path`."""
    angle, rate = numbers[0], numbers[1]
    for k in range(times.size):
        target, p = out[row + k, column : column + 18], rate * times[k]
        turn_target(target, -angle * target[3:12:3], np.zeros(3))
        # The tool's x and y axes where its z axis is the cone's; the tilt to the start is about x.
        u, v = target[3:12:3].copy(), target[4:12:3].copy()
        around = angle * (np.cos(p) * u + np.sin(p) * v)
        turn_target(target, around, angle * rate * (np.cos(p) * v - np.sin(p) * u))


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
        self._set(numbers=np.array([self.angle, 2.0 * np.pi / self.period]))


class _OnPath(Reference):
    """A path made of another one, `along`: compiled code of both, called one after the other."""

    along: Reference

    @property
    def compiled(self) -> Any:
        return self._write

    @property
    def period(self) -> float:
        return self.along.period

    @property
    def duration(self) -> float:
        return self.along.duration

    @abstractmethod
    def _write(self, times: Array, numbers: Array, out: Array, row: int, column: int) -> None:
        """Move and turn targets; see `Reference.path`."""


@njit(cache=True, error_model="numpy")
def _tilt(times: Array, numbers: Array, inner: Array, out: Array, row: int, column: int) -> None:
    """Move targets as the path's own targets, `inner`, say, and tilt them about an axis."""
    angle, rate, axis = numbers[0], numbers[1], numbers[2:5]
    for k in range(times.size):
        target, p = out[row + k, column : column + 18], rate * times[k]
        target[:3] += inner[k, :3]
        target[12:15] += inner[k, 12:15]
        turned = inner[k, 3:12].copy().reshape(3, 3) @ target[3:12].copy().reshape(3, 3)
        target[3:12] = turned.ravel()
        target[15:18] = inner[k, 15:18]
        turn_target(target, angle * np.sin(p) * axis, angle * rate * np.cos(p) * axis)


@dataclass(frozen=True, eq=False)
class Tilting(_OnPath):
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
        self._set(numbers=np.array([self.angle, rate, *direction("axis", self.axis)]))

    def _write(self, times: Array, numbers: Array, out: Array, row: int, column: int) -> None:
        _tilt(times, numbers, self.along._targets(times), out, row, column)


@njit(cache=True, error_model="numpy")
def _surface(times: Array, numbers: Array, inner: Array, out: Array, row: int, column: int) -> None:
    """Lay displacements and velocities of `inner` on a surface, after the turn to its normal."""
    curvature, lead, normal = numbers[0], numbers[1], numbers[2:5].copy()
    still = np.zeros(3)
    for k in range(times.size):
        target = out[row + k, column : column + 18]
        tool = -target[5:12:3]
        if lead > 0.0:
            share = min(max(times[k] / lead, 0.0), 1.0)
            # Quintic, at rest and without acceleration at both ends.
            part = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
            rate = 30.0 * share**2 * (1.0 - share) ** 2 / lead
            towards = _least_turn(tool, normal)
            turn_target(target, part * towards, rate * towards)
        else:
            normal = tool
        laid = _least_turn(np.array([0.0, 0.0, 1.0]), normal)
        # Height above the surface counts from the first point's.
        across = cross(normal, rotated(laid, inner[k, :3]))
        angles = curvature * across
        speed = cross(normal, rotated(laid, inner[k, 12:15])) if times[k] >= lead else still
        target[:3] += cross(across, left_jacobian(angles, normal))
        target[12:15] += cross(left_jacobian(angles, speed), rotated(angles, normal))
        turn_target(target, angles, curvature * speed)


@njit(cache=True, error_model="numpy")
def _least_turn(u: Array, v: Array) -> Array:
    """Compute the least rotation vector that takes unit vector u to v, (3,)."""
    axis = cross(u, v)
    sine, cosine = np.sqrt(np.sum(axis * axis)), np.sum(u * v)
    scale = 1.0
    if sine > 1e-12:
        scale = np.arctan2(sine, cosine) / sine
    elif cosine < 0.0:
        other = np.zeros(3)
        other[np.argmin(np.abs(u))] = 1.0
        axis = cross(u, other)
        scale = np.pi / np.sqrt(np.sum(axis * axis))
    out: Array = scale * axis
    return out


@dataclass(frozen=True, eq=False)
class OnSurface(_OnPath):
    """A path laid on a plane or a sphere, the tool normal to it; by default the heart.

    The path's x-y plane becomes the tangent plane at the start, z the outward normal n; with d the
    displacement in that plane and r the radius, the exponential map of the sphere gives::

        displacement = r (exp((n x d) / r) n - n),    turn = exp((n x d) / r)

    and in the limit of a plane d and no turn. The path's height above its x-y plane and its own
    turns are not taken. The tool's z axis points into the surface. A normal that is given is
    reached first: for `lead` seconds the tool turns where it is.

    Attributes:
        along: The path.
        radius: Radius of the sphere [m]; None: a plane.
        normal: Outward normal at the start in the world's frame; None: the tool's -z axis there.
        lead: Time to turn the tool to a normal that is given [s].

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
        curvature = 0.0 if self.radius is None else 1.0 / positive("radius", self.radius)
        self._set(along=self.along.at_rest(), lead=positive("lead", self.lead))
        normal: Array = np.zeros(3)
        if self.normal is not None:
            self._set(normal=vector3("normal", self.normal))
            normal = np.array(direction("normal", self.normal))
        self._set(numbers=np.array([curvature, self._lead, *normal]))

    @property
    def _lead(self) -> float:
        return 0.0 if self.normal is None else self.lead

    @property
    def period(self) -> float:
        """Time after which the path repeats [s]; inf where the tool turns first."""
        return self.along.period if self.normal is None else math.inf

    @property
    def duration(self) -> float:
        """Time to turn the tool and to take the path once [s]."""
        return self._lead + self.along.duration

    def _write(self, times: Array, numbers: Array, out: Array, row: int, column: int) -> None:
        inner = self.along._targets(np.maximum(times - self._lead, 0.0) if self._lead else times)
        _surface(times, numbers, inner, out, row, column)


def _acute(angle: float) -> float:
    """Return an angle between 0 and pi / 2, or raise InvalidInputError."""
    if not 0.0 < positive("angle", angle) < 0.5 * math.pi:
        raise InvalidInputError("angle", f"must be below pi / 2, not {angle}", angle)
    return float(angle)
