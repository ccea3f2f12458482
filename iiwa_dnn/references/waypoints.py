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
from iiwa_dnn.references.rotations import triple, turn_target
from iiwa_dnn.references.splines import check_noise, smoothed, spline_through
from iiwa_dnn.references.targets import Target, TargetData

Ends = Literal["clamped", "closed"]

_COLUMNS = ["t", "x", "y", "z", "qw", "qx", "qy", "qz"]

SLOW = 1e-3
"""Speed [m/s, rad/s] of a path below which its times are likely not in seconds."""

_UNIT_WITHIN = 0.01
"""Difference of a quaternion's norm from 1 that is forgiven: rounding to few digits."""


class WaypointsConstants(Record):
    """Period [s], inf for an open path, and duration [s], before the pieces one after another."""

    period: float
    duration: float
    pieces: Array = part("pieces")


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
    """Find the index of the piece that holds a time t [s], by bisection."""
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
def waypoints_path(t: float, constants: Array, target: TargetData) -> None:
    """Move a target, at rest at the path's origin, to time t [s] of `Waypoints`, in place."""
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
    turn_target(target, pose.scalar, triple(pose.vector), rate.scalar, triple(rate.vector))


@dataclass(frozen=True, eq=False, repr=False)
class Waypoints(Reference):
    """A smooth path through points or poses, by cubic splines that stay near their rows.

    Positions follow `scipy.interpolate.CubicSpline`, orientations the direction of the same spline
    through their quaternions: velocity and acceleration are continuous. Where this spline would
    leave the rows, as at a pause, its slopes are exchanged (`iiwa_dnn.references.splines`); the
    acceleration jumps at these rows, and a warning says so. Time counts from the first row, and
    displacement from the first point. Before the start and after the end the path rests at its
    first and last point; a closed path repeats instead.

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
        noise: Standard deviation of the noise in recorded points along each axis [m]. Above 0 the
            path goes through smoothed rows, and a warning says how far these are from the points;
            the first and the last row of a closed path are then equal up to the noise.
        turn_noise: Standard deviation of the noise in the orientations about each axis [rad]; None
            takes the number of `noise`, as for an arm that is a metre long.
        jumps: Indices of the rows at which the acceleration jumps, (k,).

    Raises:
        InvalidInputError: If a parameter is not as said above; or a noise covers the path, of which
            smoothing would leave a point or a line (`iiwa_dnn.references.splines.check_noise`).
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

    def __post_init__(self) -> None:
        super().__post_init__()
        closed = self.ends == "closed"
        times = finite_array("times", self.times, (-1,))
        least = 3 if closed else 2
        if len(times) < least:
            raise InvalidInputError("times", f"at least {least} points are needed", times)
        for row in np.flatnonzero(np.diff(times) <= 0.0) + 1:
            problem = f"row {row} must be above {times[row - 1]:g} s, not at {times[row]:g} s"
            raise InvalidInputError("times", problem, times)
        points = finite_array("points", self.points, (len(times), 3))
        self._set(times=times, points=points)
        check_noise("noise", points, self.noise)
        knots = times - times[0]
        rows = smoothed("points", knots, points, self.noise, closed)
        remarks = _displacement("moved", rows - points, "mm")
        moves, jumps = spline_through(knots, rows - rows[0], closed)
        count = len(moves)
        turns: Array = np.zeros((count, 4, 4))
        turns[:, -1, 0] = 1.0
        if self.quaternions is not None:
            turns, turn_jumps, remark = self._turn(knots, self.quaternions, rows[0])
            jumps = jumps | turn_jumps[:count]
            remarks += remark
        coefficients = np.concatenate([turns[:count, :, :1], moves, turns[:count, :, 1:]], axis=2)
        pieces = np.column_stack([knots[:-1], coefficients.reshape(count, -1)])
        own = WaypointsConstants.make(
            period=self.period, duration=self.duration, pieces=pieces.ravel()
        )
        self._set(constants=own, jumps=np.flatnonzero(jumps))
        if jumped := len(self.jumps):
            first = ", ".join(f"{t:.4g}" for t in times[self.jumps][:5])
            remarks.append(
                f"the acceleration jumps at {jumped} of {len(times)} rows (at {first}"
                f"{', ...' * (jumped > 5)} s): a cubic spline would leave the rows"
                f"{'; noise= smooths a recording' * (jumped > 5)}"
            )
        for message in remarks:
            warnings.warn(message, stacklevel=3)  # of the line that makes the path

    def _turn(
        self, knots: Array, quaternions: Array, start: Array
    ) -> tuple[Array, NDArray[np.bool_], list[str]]:
        """Check the quaternions, fit their spline, and set the pose at the start.

        Args:
            knots: Times since the first row [s], (m,).
            quaternions: Orientations w, x, y, z, (m, 4).
            start: Position at the start [m], (3,).

        Returns:
            Pieces and jumps by `spline_through` of the quaternions relative to the orientation at
            the start, m - 1 pieces or twice as many; and the report of the smoothing, if any.
        """
        from scipy.spatial.transform import Rotation

        given = finite_array("quaternions", quaternions, (len(knots), 4))
        self._set(quaternions=given)
        norms = np.linalg.norm(given, axis=1)
        for row in np.flatnonzero(np.abs(norms - 1.0) > _UNIT_WITHIN):
            problem = f"row {row} must have norm 1, not {norms[row]:.3g}"
            raise InvalidInputError("quaternions", problem, given)
        turns = Rotation.from_quat(given[:, [1, 2, 3, 0]])
        half = (turns[1:] * turns[:-1].inv()).magnitude() > np.pi - 1e-6
        for row in np.flatnonzero(half) + 1:
            problem = f"row {row} is half a turn from the one before"
            raise InvalidInputError("quaternions", problem, given)
        noise = self.noise
        if self.turn_noise is not None:
            noise = self.turn_noise
            check_noise("turn_noise", (turns * turns.mean().inv()).as_rotvec(), noise)
        # A turn by a small angle moves an entry of the matrix by at most that angle.
        rows = turns.as_matrix().reshape(-1, 9)
        rows = smoothed("quaternions", knots, rows, noise, self.ends == "closed")
        smooth = Rotation.from_matrix(rows.reshape(-1, 3, 3)) if noise else turns
        remarks = _displacement("turned", (smooth * turns.inv()).as_rotvec(), "mrad")
        self._set(base=read_only(Target(start, smooth[0].as_matrix()).data))
        relative = (smooth * smooth[0].inv()).as_quat()[:, [3, 0, 1, 2]]
        cosines = (relative[1:] * relative[:-1]).sum(axis=1)  # of half the angles between them
        relative *= np.cumprod(np.append(1.0, np.sign(cosines)))[:, np.newaxis]
        if self.ends == "closed" and relative[-1] @ relative[0] < 0.0:
            # A whole turn: it closes after another round.
            knots = np.append(knots, knots[-1] + knots[1:])
            relative = np.vstack([relative, -relative[1:]])
        return *spline_through(knots, relative, self.ends == "closed", jointly=True), remarks

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
            ends: "clamped" or "closed", as for :class:`Waypoints`.
            stretch: Ratio of the path's times to those of the rows.
            noise: Standard deviation of the noise in the points [m].
            turn_noise: Standard deviation of the noise in the orientations [rad]; None takes the
                number of `noise`.

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


def _displacement(done: str, changes: Array, unit: str) -> list[str]:
    """Report the root mean square and the maximum of the norms of changes, times 1,000.

    Args:
        done: What smoothing has done, a participle.
        changes: The changes of the rows by smoothing [m] or [rad], (m, k).
        unit: Thousandth of their unit.

    Returns:
        One message, or none if no change is above rounding.
    """
    sizes = 1e3 * np.linalg.norm(changes, axis=1)
    if not sizes.max() > 1e-6:  # rounding
        return []
    return [
        f"smoothing has {done} the rows by {np.sqrt(np.mean(sizes**2)):.3g} {unit} (root of the "
        f"mean square) and at most {sizes.max():.3g} {unit}"
    ]


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
