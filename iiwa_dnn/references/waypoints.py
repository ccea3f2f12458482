"""A smooth path through points or poses, given in code or in a CSV file."""

from __future__ import annotations

import csv
import math
import os
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from numba import njit
from numpy.typing import ArrayLike

from iiwa_dnn.checks import Array, finite_array, positive, read_only
from iiwa_dnn.errors import FileError, InvalidInputError
from iiwa_dnn.references.base import Reference
from iiwa_dnn.references.rotation_spline import fit_rotations
from iiwa_dnn.references.rotations import jacobian_rate, left_jacobian, turn_target

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

Ends = Literal["clamped", "natural", "closed"]

_SCIPY_ENDS = {"clamped": "clamped", "natural": "natural", "closed": "periodic"}
_COLUMNS = ["t", "x", "y", "z", "qw", "qx", "qy", "qz"]
_CLOSED_WITHIN = 1e-9  # [m], and of a quaternion's components
_UNIT_WITHIN = 1e-3  # error of a quaternion's length that is taken for rounding

SPEED, RATE = 0.05, 0.5
"""Speed [m/s] and angular speed [rad/s] along points of a file without times."""


@njit(cache=True, error_model="numpy")
def _path(times: Array, numbers: Array, out: Array, row: int, column: int) -> None:
    """Add displacement and velocity to targets (k, 18) in `out`; see `Reference.path`."""
    closed, pieces = numbers[0] != 0.0, int(numbers[1])
    knots, end = numbers[2 : 3 + pieces], numbers[2 + pieces]
    turns = 3 + 13 * pieces
    for k in range(times.size):
        t = times[k] % end if closed else min(max(times[k], 0.0), end)
        piece = min(max(np.searchsorted(knots, t, "right") - 1, 0), pieces - 1)
        x = t - knots[piece]
        moves = 1.0 if closed or t == times[k] else 0.0
        for i in range(3):
            at = 3 + pieces + 12 * piece + i
            a, b, c, d = numbers[at], numbers[at + 3], numbers[at + 6], numbers[at + 9]
            out[row + k, column + i] += ((a * x + b) * x + c) * x + d
            out[row + k, column + 12 + i] += moves * ((3.0 * a * x + 2.0 * b) * x + c)
        if turns < numbers.size:
            target, at = out[row + k, column : column + 18], turns + 12 * piece
            start = numbers[at + 9 : at + 12]
            a, b, c = numbers[at : at + 3], numbers[at + 3 : at + 6], numbers[at + 6 : at + 9]
            turn_target(target, start, np.zeros(3))
            rate = moves * ((3.0 * x * a + 2.0 * b) * x + c)
            turn_target(target, ((a * x + b) * x + c) * x, rate)


@njit(cache=True, error_model="numpy")
def _acceleration(times: Array, numbers: Array, out: Array) -> None:
    """Write linear and angular accelerations (k, 6) into `out`; 0 where an open path rests."""
    closed, pieces = numbers[0] != 0.0, int(numbers[1])
    knots, end = numbers[2 : 3 + pieces], numbers[2 + pieces]
    for k in range(times.size):
        t = times[k] % end if closed else times[k]
        if not 0.0 <= t <= end:
            continue
        piece = min(max(np.searchsorted(knots, t, "right") - 1, 0), pieces - 1)
        x, at = t - knots[piece], 3 + pieces + 12 * piece
        out[k, :3] = 6.0 * x * numbers[at : at + 3] + 2.0 * numbers[at + 3 : at + 6]
        at = 3 + 13 * pieces + 12 * piece
        if at < numbers.size:
            a, b, c = numbers[at : at + 3], numbers[at + 3 : at + 6], numbers[at + 6 : at + 9]
            vector, rate = ((a * x + b) * x + c) * x, (3.0 * x * a + 2.0 * b) * x + c
            out[k, 3:] = left_jacobian(vector, 6.0 * x * a + 2.0 * b) + jacobian_rate(vector, rate)


@dataclass(frozen=True, eq=False, repr=False)
class Waypoints(Reference):
    """A smooth path through points or poses: velocity and acceleration are continuous.

    Positions follow a cubic spline, orientations the rotation spline of
    `iiwa_dnn.references.rotation_spline`. Time counts from the first row and displacement from the
    first point. Before the start and after the end the path rests at its first and last point; a
    closed path repeats instead.

    A path of points keeps the orientation of the pose that it is anchored at. A path of poses is
    in the robot's base frame as it is; anchored, it is moved to begin at that position, and its
    turns, about the base frame's axes, begin from that orientation.

    Attributes:
        times: Times of the points [s], shape (m,), increasing, m >= 2.
        points: The points [m], shape (m, 3).
        ends: "clamped": at rest at both ends. "natural": without acceleration at both ends, where
            the velocity may then jump. "closed": ends as it begins and repeats; the last point
            must be the first one, and m >= 3.
        quaternions: Orientations w, x, y, z of the poses, shape (m, 4), or None. Either sign will
            do; neighbours are less than half a turn apart.

    Raises:
        InvalidInputError: If a parameter is not as said above.
    """

    name: ClassVar[str] = "waypoints"
    path: ClassVar[Any] = staticmethod(_path)
    times: Array
    points: Array
    ends: Ends = "clamped"
    quaternions: Array | None = None

    def __post_init__(self) -> None:
        times = finite_array("times", self.times, (-1,))
        points = finite_array("points", self.points, (len(times), 3))
        if self.ends not in _SCIPY_ENDS:
            raise InvalidInputError("ends", f"must be one of {', '.join(_SCIPY_ENDS)}", self.ends)
        least = 3 if self.ends == "closed" else 2
        if len(times) < least:
            raise InvalidInputError("times", f"at least {least} points are needed", times)
        if not (times[1:] > times[:-1]).all():
            raise InvalidInputError("times", "must increase from point to point", times)
        self._set(times=times, points=points)
        spline = self._fit()
        head = [float(self.ends == "closed"), len(spline.x) - 1]
        # Of each piece the coefficients of every power, of each power x, y and z.
        pieces = spline.c.transpose(1, 0, 2).ravel()
        turns = np.zeros(0) if self.quaternions is None else self._fit_turns(self.quaternions)
        self._set(numbers=np.concatenate([head, spline.x, pieces, turns.ravel()]))

    def _fit_turns(self, quaternions: Array) -> Array:
        """Check the quaternions, begin at the first pose, and fit the rotation spline."""
        from scipy.spatial.transform import Rotation

        quaternions = finite_array("quaternions", quaternions, (len(self.times), 4))
        norms = np.linalg.norm(quaternions, axis=1, keepdims=True)
        worst = int(np.abs(norms - 1.0).argmax())
        if abs(norms[worst, 0] - 1.0) > _UNIT_WITHIN:
            problem = f"must have length 1; pose {worst + 1} has {norms[worst, 0]:.6g}"
            raise InvalidInputError("quaternions", problem, quaternions)
        unit = quaternions / norms
        if self.ends == "closed" and abs(unit[0] @ unit[-1]) < 1.0 - _CLOSED_WITHIN:
            problem = "the last one of a closed path must be the first one"
            raise InvalidInputError("quaternions", problem, quaternions)
        rotation = Rotation.from_quat(unit[0, [1, 2, 3, 0]]).as_matrix()
        base = np.concatenate([self.points[0], rotation.ravel(), np.zeros(6)])
        self._set(quaternions=quaternions, _base=read_only(base))
        return fit_rotations(self.times, unit, self.ends)

    def acceleration(self, t: ArrayLike) -> Array:
        """Compute the exact accelerations, linear [m/s^2] and angular [rad/s^2].

        Args:
            t: Times [s], shape (...,).

        Returns:
            Accelerations along the world's axes, shape (..., 6).
        """
        times = np.asarray(t, dtype=np.float64)
        out = np.zeros((times.size, 6))
        _acceleration(np.ascontiguousarray(times.ravel()), self.numbers, out)
        return out.reshape(*times.shape, 6)

    def _fit(self) -> CubicSpline:
        from scipy.interpolate import CubicSpline  # its 0.3 s are for those who use it

        with np.errstate(over="ignore"):  # the result is looked at below
            times, displacements = self.times - self.times[0], self.points - self.points[0]
        if self.ends == "closed":
            if np.abs(displacements[-1]).max() > _CLOSED_WITHIN:
                problem = "the last one of a closed path must be the first one"
                raise InvalidInputError("points", problem, self.points)
            displacements[-1] = 0.0  # scipy asks for the very same numbers
        with np.errstate(all="ignore"), suppress(ValueError, np.linalg.LinAlgError):
            spline = CubicSpline(times, displacements, bc_type=_SCIPY_ENDS[self.ends])
            if np.isfinite(spline.c).all():
                return spline
        problem = "no spline fits: too close together, or the points too far apart"
        raise InvalidInputError("times", problem, self.times)

    @classmethod
    def from_csv(
        cls,
        path: str | os.PathLike[str],
        ends: Ends = "clamped",
        speed: float = SPEED,
        rate: float = RATE,
    ) -> Waypoints:
        """Read points or poses from a CSV file in [s] and [m].

        The header is ``t,x,y,z``, ``t,x,y,z,qw,qx,qy,qz`` or ``x,y,z,qw,qx,qy,qz``. Without ``t``
        every stretch takes the time of its length at `speed`, or of its turn at `rate` if that is
        more.

        Args:
            path: The file. Empty lines in it are skipped.
            ends: As for :class:`Waypoints`.
            speed: Mean speed on each stretch of a file without times [m/s].
            rate: Mean angular speed on each stretch of a file without times [rad/s].

        Raises:
            FileError: If the file cannot be read or is not as said above, naming the line.
            InvalidInputError: If ``ends`` is not one of its values, or a speed is not above zero,
                or given for a file with times.
        """
        positive("speed", speed)
        positive("rate", rate)
        path = Path(path)
        try:
            with path.open(encoding="utf-8-sig", newline="") as file:
                rows = np.array(list(_rows(path, file)))
        except OSError as error:
            if isinstance(error, FileError):
                raise
            raise FileError(path, error.strerror or str(error)) from error
        except UnicodeDecodeError as error:
            raise FileError(path, "not UTF-8 text") from error
        except ValueError as error:  # a NUL in the path
            raise FileError(path, str(error)) from error
        if len(rows) < 2:
            raise FileError(path, f"at least 2 rows are needed, it has {len(rows)}")
        times, points = rows[:, 0], rows[:, 1:4]
        quaternions = rows[:, 4:] if rows.shape[1] > 4 else None
        untimed = quaternions is not None and np.isnan(times[0])
        for name, value, usual in (("speed", speed, SPEED), ("rate", rate, RATE)):
            if value != usual and not untimed:
                raise InvalidInputError(name, f"is for a file without times, not {path}", value)
        if quaternions is not None and untimed:
            times = _times_at(points, quaternions, speed, rate)
        try:
            return cls(times, points, ends, quaternions)
        except InvalidInputError as error:
            if error.argument == "ends":
                raise
            raise FileError(path, str(error)) from error

    def __repr__(self) -> str:
        return f"Waypoints({len(self.times)} points, {self.duration:g} s, ends={self.ends!r})"

    @property
    def period(self) -> float:
        """Time after which a closed path repeats [s]; inf for an open one."""
        return self.duration if self.ends == "closed" else math.inf

    @property
    def duration(self) -> float:
        """Time from the first point to the last [s]."""
        return float(self.times[-1] - self.times[0])


def _times_at(points: Array, quaternions: Array, speed: float, rate: float) -> Array:
    """Compute the times (m,) [s] of poses that are passed at a speed and an angular speed."""
    # A quarter of the angle by its chord, accurate near zero, to the nearer of the two signs.
    chords = (np.linalg.norm(quaternions[1:] - s * quaternions[:-1], axis=1) for s in (1.0, -1.0))
    angles = 4.0 * np.arcsin(np.minimum(0.5 * np.minimum(*chords), 1.0))
    took = np.maximum(np.linalg.norm(np.diff(points, axis=0), axis=1) / speed, angles / rate)
    return np.concatenate([[0.0], np.cumsum(took)])


def _rows(path: Path, file: Iterable[str]) -> Iterator[list[float]]:
    """Read rows of t, x, y, z and a quaternion, if there is one; each complaint names its line.

    Without the column t its place holds NaN.
    """
    reader, last = csv.reader(file), -math.inf
    stripped = ([cell.strip() for cell in row] for row in reader)
    filled = ((f"line {reader.line_num}", cells) for cells in stripped if any(cells))
    try:
        line, header = next(filled, ("line 1", []))
        columns = [cell.lower() for cell in header]
        timed = columns[:1] == ["t"]
        if columns not in (_COLUMNS[:4], _COLUMNS, _COLUMNS[1:]):
            problem = "the header must be t,x,y,z or t,x,y,z,qw,qx,qy,qz, the latter also without t"
            raise FileError(path, f"{line}: {problem}")
        for line, cells in filled:
            if len(cells) != len(columns):
                raise FileError(
                    path, f"{line}: {len(columns)} columns are needed, it has {len(cells)}"
                )
            values = []
            for column, cell in zip(columns, cells, strict=True):
                try:
                    values.append(float(cell))
                except ValueError:
                    raise FileError(path, f"{line}: {column} is {cell!r}, not a number") from None
                if not math.isfinite(values[-1]):
                    raise FileError(path, f"{line}: {column} is {cell}, not finite")
            if timed and values[0] <= last:
                raise FileError(path, f"{line}: t does not increase")
            last = values[0]
            yield values if timed else [math.nan, *values]
    except csv.Error as error:
        raise FileError(path, f"line {reader.line_num}: {error}") from error
