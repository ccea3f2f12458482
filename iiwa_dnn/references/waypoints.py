"""A smooth path through points or poses, given in code or in a CSV file."""

from __future__ import annotations

import csv
import os
import re
import warnings
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, ClassVar, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.checks import (
    Array,
    Checks,
    Matrix,
    finite_array,
    not_negative,
    one_of,
    positive,
    read_only,
)
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.errors import FileError, InvalidInputError
from iiwa_dnn.files import one_line
from iiwa_dnn.references.base import Reference
from iiwa_dnn.references.rotations import column_of, combined, cross, dot, triple
from iiwa_dnn.references.splines import Spline, smoothed, smoothed_turns, spline_through
from iiwa_dnn.references.targets import Target, TargetData

Ends = Literal["clamped", "closed"]

_COLUMNS = ["t", "x", "y", "z", "qw", "qx", "qy", "qz"]

SLOW = 1e-3
"""Speed [m/s, rad/s] of a path below which its times are likely not in seconds."""

_CLOSED_WITHIN = 1e-9
"""Distance between both ends of a closed path that is rounding [m, rad]."""

_UNIT_WITHIN = 0.01
"""Difference of a quaternion's norm from 1 that is forgiven: rounding to few digits."""


class WaypointsConstants(Record):
    """Period [s], inf for an open path, and duration [s], before the pieces one after another."""

    period: float
    duration: float
    pieces: Array = part()


class PoseNumbers(Record):
    """Displacement [m], and scalar and vector part of a quaternion of any length but 0."""

    scalar: float
    move: Array = part(3)
    vector: Array = part(3)


class Piece(Record):
    """Start of a piece [s], and coefficients of its cubics, each of `PoseNumbers`."""

    start: float
    third: Array = part(7)
    second: Array = part(7)
    first: Array = part(7)
    offset: Array = part(7)


@compiled
def _piece(pieces: Matrix, t: float) -> int:
    """Find the piece at a time [s] by bisection."""
    low = 0
    high = len(pieces) - 1
    while low < high:
        middle = (low + high + 1) // 2
        if Piece.of(pieces[middle]).start <= t:
            low = middle
        else:
            high = middle - 1
    return low


@compiled
def turn_by_quaternion(target: TargetData, pose: PoseNumbers, rate: PoseNumbers) -> None:
    """Turn a target at rest by a quaternion with a rate of change, neither of length 1."""
    w = pose.scalar
    u = triple(pose.vector)
    scale = 2.0 / (w * w + dot(u, u))
    for j in range(3):
        column = column_of(target.rotation, j)
        once = cross(u, column)
        turned = combined(1.0, column, scale, combined(w, once, 1.0, cross(u, once)))
        for i in range(3):
            target.rotation[i, j] = turned[i]
    change = triple(rate.vector)
    spin = combined(1.0, cross(u, change), 1.0, combined(w, change, -rate.scalar, u))
    for i in range(3):
        target.angular_velocity[i] += scale * spin[i]


@compiled
def waypoints_path(t: float, constants: Array, target: TargetData) -> None:
    """Move a target along `Waypoints`."""
    own = WaypointsConstants.of(constants)
    pieces = own.pieces.reshape(own.pieces.size // Piece.width(), Piece.width())
    repeats = own.period < np.inf
    inside = t % own.period if repeats else min(max(t, 0.0), own.duration)
    moves = 1.0 if repeats or inside == t else 0.0
    piece = Piece.of(pieces[_piece(pieces, inside)])
    x = inside - piece.start
    values = np.empty(PoseNumbers.width())
    rates = np.empty(PoseNumbers.width())
    for i in range(values.size):
        inner = x * piece.third[i] + piece.second[i]
        values[i] = x * (x * inner + piece.first[i]) + piece.offset[i]
        inner = 3.0 * x * piece.third[i] + 2.0 * piece.second[i]
        rates[i] = moves * (x * inner + piece.first[i])
    pose = PoseNumbers.of(values)
    rate = PoseNumbers.of(rates)
    for i in range(3):
        target.position[i] += pose.move[i]
        target.linear_velocity[i] += rate.move[i]
    turn_by_quaternion(target, pose, rate)


@dataclass(frozen=True, eq=False, repr=False)
class Waypoints(Reference):
    """A smooth path through points or poses, by cubic splines that stay near their rows.

    Positions follow `scipy.interpolate.CubicSpline`, orientations the direction of the same spline
    through their quaternions: velocity and acceleration are continuous. Where they would leave the
    rows, as about a pause, they have other slopes (`iiwa_dnn.references.splines`); the acceleration
    jumps at these rows, and a warning says so. Time counts from the first row and displacement from
    the first point. Before the start and after the end the path rests at its first and last point;
    a closed path repeats instead.

    A path of points is relative: `anchored` moves its first point to a pose, whose orientation it
    keeps. A path of poses is absolute, in the robot's base frame; `anchored` moves it all the same,
    and its turns, about the base frame's axes, then begin from the orientation of that pose.

    Attributes:
        times: Times of the points [s], shape (m,), increasing, m >= 2.
        points: The points [m], shape (m, 3).
        ends: "clamped": at rest at both ends. "closed": ends as it begins and repeats; the last
            point must be the first one, and m >= 3.
        quaternions: Orientations w, x, y, z of the poses, of norm 1, shape (m, 4), or None. Either
            sign will do; neighbours are less than half a turn apart.
        noise: Standard deviation of recorded points along each axis [m]. Above 0 the path goes
            through smoothed rows, and a warning says what that has moved; the first and the last
            row of a closed path are then equal up to noise.
        turn_noise: The same of the orientations [rad]; by default as many as `noise` has metres,
            as of an arm a metre long.
        jumps: Numbers of the rows at which the acceleration jumps, from 0, shape (k,).
        moved: Distances that smoothing has moved the points by [m], shape (m,).
        turned: Angles that smoothing has turned the orientations by [rad], shape (m,).

    Raises:
        InvalidInputError: If a parameter is not as said above.
    """

    path: ClassVar[Any] = staticmethod(waypoints_path)
    _checks: ClassVar[Checks] = {
        "ends": partial(one_of, choices=get_args(Ends)),
        "noise": not_negative,
        "turn_noise": not_negative,
    }
    times: Array
    points: Array
    ends: Ends = "clamped"
    quaternions: Array | None = None
    noise: float = 0.0
    turn_noise: float | None = None
    jumps: NDArray[np.intp] = field(init=False)
    moved: Array = field(init=False)
    turned: Array = field(init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        self._check_rows()
        knots = self.times - self.times[0]
        closed = self.ends == "closed"
        points = smoothed(knots, self.points, self.noise, closed)
        if closed and np.abs(points[-1] - points[0]).max() > _CLOSED_WITHIN:
            problem = "the last one of a closed path must be the first one"
            raise InvalidInputError("points", problem, self.points)
        moves = spline_through(knots, points - points[0], closed)
        turns = np.zeros((*moves.pieces.shape[:2], 4))
        turns[:, -1, 0] = 1.0
        jumps = moves.jumps
        if self.quaternions is not None:
            poses = self._poses(knots, self.quaternions)
            self._set(base=read_only(Target(points[0], poses[0].as_matrix()).data))
            turns, jumping = _turns(
                knots, (poses * poses[0].inv()).as_quat()[:, [3, 0, 1, 2]], closed
            )
            jumps = jumps | jumping
        coefficients = np.concatenate([turns[..., :1], moves.pieces, turns[..., 1:]], axis=2)
        pieces = np.column_stack([knots[:-1], coefficients.reshape(len(turns), -1)])
        own = WaypointsConstants.make(
            period=self.period, duration=self.duration, pieces=pieces.ravel()
        )
        self._set(
            constants=own.numbers,
            jumps=np.flatnonzero(jumps),
            moved=read_only(np.linalg.norm(points - self.points, axis=1)),
        )
        for remark in self._remarks():
            warnings.warn(remark, stacklevel=3)  # of the line that makes the path

    def _check_rows(self) -> None:
        """Check all parameters but the quaternions; raises InvalidInputError."""
        times = finite_array("times", self.times, (-1,))
        self._set(times=times, points=finite_array("points", self.points, (len(times), 3)))
        least = 3 if self.ends == "closed" else 2
        if len(times) < least:
            raise InvalidInputError("times", f"at least {least} points are needed", times)
        for row in np.flatnonzero(times[1:] <= times[:-1]) + 1:
            problem = f"row {row} must be above {times[row - 1]:g} s, not at {times[row]:g} s"
            raise InvalidInputError("times", problem, times)
        turn_noise = self.noise if self.turn_noise is None else self.turn_noise
        self._set(turn_noise=turn_noise, turned=read_only(np.zeros(len(times))))

    def _poses(self, knots: Array, quaternions: Array) -> Any:
        """Check the quaternions, and return the orientations, smoothed if there is noise."""
        from scipy.spatial.transform import Rotation

        quaternions = finite_array("quaternions", quaternions, (len(knots), 4))
        norms = np.linalg.norm(quaternions, axis=1)
        for row in np.flatnonzero(np.abs(norms - 1.0) > _UNIT_WITHIN):
            problem = f"row {row} must have norm 1, not {norms[row]:.3g}"
            raise InvalidInputError("quaternions", problem, quaternions)
        self._set(quaternions=quaternions)
        turns = Rotation.from_quat(quaternions[:, [1, 2, 3, 0]])
        half = (turns[1:] * turns[:-1].inv()).magnitude() > np.pi - 1e-6
        for row in np.flatnonzero(half) + 1:
            problem = f"row {row} is half a turn from the one before"
            raise InvalidInputError("quaternions", problem, quaternions)
        if self.turn_noise:
            given = turns
            turns = smoothed_turns(knots, given, self.turn_noise, self.ends == "closed")
            self._set(turned=read_only((turns * given.inv()).magnitude()))
        if self.ends == "closed" and (turns[-1] * turns[0].inv()).magnitude() > _CLOSED_WITHIN:
            problem = "the last one of a closed path must be the first one"
            raise InvalidInputError("quaternions", problem, quaternions)
        return turns

    def _remarks(self) -> Iterator[str]:
        """Report the displacement by smoothing, and rows where the acceleration jumps."""
        for done, moved, unit in (("moved", self.moved, "mm"), ("turned", self.turned, "mrad")):
            if moved.any():
                yield (
                    f"smoothing has {done} the rows by {1e3 * np.sqrt(np.mean(moved**2)):.3g} "
                    f"{unit} (root of the mean square) and at most {1e3 * moved.max():.3g} {unit}"
                )
        if count := len(self.jumps):
            first = ", ".join(f"{t:.4g}" for t in self.times[self.jumps][:5])
            yield (
                f"the acceleration jumps at {count} of {len(self.times)} rows (at {first}"
                f"{', ...' * (count > 5)} s): a cubic spline would leave the rows"
                f"{'; noise= smooths a recording' * (count > 5)}"
            )

    @classmethod
    def from_csv(
        cls,
        path: str | os.PathLike[str],
        ends: Ends = "clamped",
        stretch: float = 1.0,
        noise: float = 0.0,
        turn_noise: float | None = None,
    ) -> Waypoints:
        """Read points or poses from a CSV file in [s] and [m].

        The header names the columns ``t,x,y,z``, and of poses ``qw,qx,qy,qz``, in any order, with
        commas or semicolons between them. Lines before it, empty ones and what follows a ``#`` are
        skipped. Warnings name columns that are not read, and ask for the unit of times in which
        nothing moves.

        Args:
            path: The file.
            ends: As for :class:`Waypoints`, as the last two.
            stretch: Ratio of the path's times to those of the rows.
            noise: Standard deviation of the points [m].
            turn_noise: Standard deviation of the orientations [rad].

        Raises:
            FileError: If the file cannot be read or is not as said above, naming the line.
            InvalidInputError: If the ratio is not above zero.
        """
        positive("stretch", stretch)
        with warnings.catch_warnings(record=True) as remarks:
            warnings.simplefilter("always")
            try:
                table, unread = _read(path)
                poses = (table[:, 2:5], ends, table[:, 5:] if table.shape[1] > 5 else None)
                made = cls(stretch * table[:, 1], *poses, noise, turn_noise)
            except (ValueError, csv.Error) as error:
                reason = re.sub(
                    r"row (\d+)", lambda row: f"line {table[int(row[1]), 0]:.0f}", one_line(error)
                )
                raise FileError(path, reason) from error
        said = [str(remark.message) for remark in remarks]
        if unread:
            said.append(f"columns that are not read: {', '.join(unread)}")
        twists = made.sample(np.linspace(0.0, made.duration, 4 * len(made.times))).data[:, 12:]
        if 0.0 < np.abs(twists).max() < SLOW:
            said.append(f"no speed is above {SLOW:g} m/s or rad/s: are the times in seconds?")
        for message in said:
            warnings.warn(f"{path}: {message}", stacklevel=2)
        return made

    @property
    def period(self) -> float:
        """Time after which a closed path repeats [s]; inf for an open one."""
        return self.duration if self.ends == "closed" else np.inf

    @property
    def duration(self) -> float:
        """Time from the first point to the last [s]."""
        return float(self.times[-1] - self.times[0])


def _turns(knots: Array, quaternions: Array, closed: bool) -> Spline:
    """Fit a spline to quaternions w, x, y, z (m, 4) of any sign, neighbours with acute angles."""
    products = (quaternions[1:] * quaternions[:-1]).sum(axis=1)
    rows = quaternions * np.cumprod(np.append(1.0, np.sign(products)))[:, np.newaxis]
    times = knots
    if closed and rows[-1] @ rows[0] < 0.0:  # a whole turn: it closes after another round
        times = np.append(knots, knots[-1] + knots[1:])
        rows = np.vstack([rows, -rows[1:]])
    spline = spline_through(times, rows, closed, jointly=True)
    return Spline(spline.pieces[: len(knots) - 1], spline.jumps[: len(knots) - 1])


def _read(path: str | os.PathLike[str]) -> tuple[Array, list[str]]:
    """Read a file of points or poses, each with its time.

    Returns:
        Rows of line number, time, point and, of poses, quaternion, (m, 5) or (m, 9); and the names
        of the columns that are not read.
    """
    try:
        lines = Path(path).read_text(encoding="utf-8-sig").splitlines()
    except (OSError, TypeError, ValueError) as error:  # ValueError: no UTF-8, a NUL in the path
        raise FileError(path, one_line(error)) from error
    numbered = enumerate(lines, 1)
    names, delimiter = _header(numbered)
    wanted = _COLUMNS if "qw" in names else _COLUMNS[:4]
    table = []
    for number, line in numbered:
        cells = _cells(line.partition("#")[0], delimiter)
        if any(cells):
            try:
                row = dict(zip(names, cells, strict=True))
                values = finite_array("row", [row[name] for name in wanted], (-1,))
            except ValueError as error:
                problem = f"{len(wanted)} finite numbers are needed, not {line!r}"
                raise FileError(path, f"line {number}: {problem}") from error
            table.append([number, *values])
    unread = [name for name in names if name and name not in wanted]
    return np.array(table).reshape(-1, 1 + len(wanted)), unread


def _header(lines: Iterator[tuple[int, str]]) -> tuple[list[str], str]:
    """Read the header; return the names of the columns and their separator."""
    for _, line in lines:
        header = line.lstrip("# ").partition("#")[0]
        delimiter = ";" if ";" in header else ","
        names = [name.lower() for name in _cells(header, delimiter)]
        known = sorted(name for name in names if name in _COLUMNS)
        if known in (sorted(_COLUMNS[:4]), sorted(_COLUMNS)):
            return names, delimiter
    raise ValueError("a header must name t, x, y, z, or t, x, y, z, qw, qx, qy, qz, once each")


def _cells(line: str, delimiter: str) -> list[str]:
    """Split a line of a CSV file."""
    rows = csv.reader([line], delimiter=delimiter, skipinitialspace=True)
    return [cell.strip() for cell in next(rows, [])]
