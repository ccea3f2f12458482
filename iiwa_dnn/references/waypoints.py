"""A smooth path through points or poses, given in code or in a CSV file."""

from __future__ import annotations

import csv
import math
import os
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from numba import njit
from numpy.typing import ArrayLike

from iiwa_dnn.checks import Array, Vector3, finite_array, one_of, positive, read_only
from iiwa_dnn.errors import FileError, InvalidInputError
from iiwa_dnn.files import one_line
from iiwa_dnn.references.base import Reference
from iiwa_dnn.references.rotation_spline import fit_rotations
from iiwa_dnn.references.rotations import (
    added,
    combined,
    jacobian_rate,
    left_jacobian,
    scaled,
    turn_target,
)

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

Ends = Literal["clamped", "natural", "closed"]

_SCIPY_ENDS = {"clamped": "clamped", "natural": "natural", "closed": "periodic"}
_COLUMNS = ["t", "x", "y", "z", "qw", "qx", "qy", "qz"]
_HEADERS = (_COLUMNS[:4], _COLUMNS, _COLUMNS[1:])
_CLOSED_WITHIN = 1e-9  # [m], and of a quaternion's components
_NOT_CLOSED = "the last one of a closed path must be the first one"
_UNIT_WITHIN = 1e-3  # error of a quaternion's length that is taken for rounding

SPEED, RATE = 0.05, 0.5
"""Speed [m/s] and angular speed [rad/s] along points of a file without times."""


# Constants: 1 if closed, else 0; number of pieces p; knots [s], (p + 1,); of each piece the
# displacement's coefficients of x^3, x^2, x and 1, and those of `fit_rotations`, (p, 8, 3).


@njit(cache=True, error_model="numpy")
def _piece(t: float, constants: Array) -> tuple[int, float, float]:
    """Find the piece at a time, the time since it began, and 0.0 if the path is at rest, or 1.0."""
    closed = constants[0] != 0.0
    pieces = int(constants[1])
    end = constants[2 + pieces]
    inside = t % end if closed else min(max(t, 0.0), end)
    low = 0
    high = pieces - 1
    while low < high:
        middle = (low + high + 1) // 2
        if constants[2 + middle] <= inside:
            low = middle
        else:
            high = middle - 1
    moves = 1.0 if closed or inside == t else 0.0
    return low, inside - constants[2 + low], moves


@njit(cache=True, error_model="numpy")
def _triple(constants: Array, at: int) -> Vector3:
    return constants[at], constants[at + 1], constants[at + 2]


@njit(cache=True, error_model="numpy")
def _cubic(constants: Array, at: int, x: float) -> Vector3:
    """Compute a x^3 + b x^2 + c x of coefficients (3, 3)."""
    first = combined(x, _triple(constants, at), 1.0, _triple(constants, at + 3))
    return scaled(x, combined(x, first, 1.0, _triple(constants, at + 6)))


@njit(cache=True, error_model="numpy")
def _slope(constants: Array, at: int, x: float) -> Vector3:
    """Compute the derivative of `_cubic` by x."""
    first = combined(3.0 * x, _triple(constants, at), 2.0, _triple(constants, at + 3))
    return combined(x, first, 1.0, _triple(constants, at + 6))


@njit(cache=True, error_model="numpy")
def _path(t: float, constants: Array, target: Array) -> None:
    piece, x, moves = _piece(t, constants)
    at = 3 + int(constants[1]) + 24 * piece
    moved = added(_cubic(constants, at, x), _triple(constants, at + 9))
    velocity = _slope(constants, at, x)
    for i in range(3):
        target[i] += moved[i]
        target[12 + i] += moves * velocity[i]
    turn_target(target, _triple(constants, at + 21), (0.0, 0.0, 0.0))
    rate = scaled(moves, _slope(constants, at + 12, x))
    turn_target(target, _cubic(constants, at + 12, x), rate)


@dataclass(frozen=True, eq=False, repr=False)
class Waypoints(Reference):
    """A smooth path through points or poses: velocity and acceleration are continuous.

    Positions follow a cubic spline, orientations the rotation spline of
    `iiwa_dnn.references.rotation_spline`. Time counts from the first row and displacement from the
    first point. Before the start and after the end the path rests at its first and last point; a
    closed path repeats instead.

    A path of points is relative: `anchored` moves its first point to a pose, whose orientation it
    keeps. A path of poses is absolute, in the robot's base frame; `anchored` moves it all the same,
    and its turns, about the base frame's axes, then begin from the orientation of that pose.

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
        one_of("ends", self.ends, tuple(_SCIPY_ENDS))
        least = 3 if self.ends == "closed" else 2
        if len(times) < least:
            raise InvalidInputError("times", f"at least {least} points are needed", times)
        if not (times[1:] > times[:-1]).all():
            raise InvalidInputError("times", "must increase from point to point", times)
        self._set(times=times, points=points)
        spline = self._fit()
        moves = spline.c.transpose(1, 0, 2)
        turns = np.zeros_like(moves)
        if self.quaternions is not None:
            turns = self._fit_turns(self.quaternions)
        pieces = np.concatenate([moves, turns], axis=1)
        head = [float(self.ends == "closed"), float(len(pieces))]
        self._set(constants=np.concatenate([head, spline.x, pieces.ravel()]))

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
            raise InvalidInputError("quaternions", _NOT_CLOSED, quaternions)
        rotation = Rotation.from_quat(unit[0, [1, 2, 3, 0]]).as_matrix()
        base = np.concatenate([self.points[0], rotation.ravel(), np.zeros(6)])
        self._set(quaternions=quaternions, base=read_only(base))
        return fit_rotations(self.times, unit, self.ends)

    def acceleration(self, t: ArrayLike) -> Array:
        """Compute the exact accelerations, linear [m/s^2] and angular [rad/s^2].

        Args:
            t: Times [s], shape (...,).

        Returns:
            Accelerations along the world's axes, shape (..., 6).
        """
        pieces = self.constants[2 + len(self.times) :].reshape(-1, 2, 4, 3)
        found = []
        for time in np.ravel(t).tolist():
            piece, x, moves = _piece(time, self.constants)
            a, b, c, _ = pieces[piece].swapaxes(0, 1)
            second = moves * (6.0 * x * a + 2.0 * b)
            vector = tuple((((a * x + b) * x + c) * x)[1])
            rate = tuple(moves * ((3.0 * a * x + 2.0 * b) * x + c)[1])
            angular = added(left_jacobian(vector, tuple(second[1])), jacobian_rate(vector, rate))
            found.append([*second[0], *angular])
        return np.reshape(found, (*np.shape(t), 6))

    def _fit(self) -> CubicSpline:
        from scipy.interpolate import CubicSpline  # its 0.3 s are for those who use it

        with np.errstate(over="ignore"):  # the result is looked at below
            times = self.times - self.times[0]
            displacements = self.points - self.points[0]
        if self.ends == "closed":
            if np.abs(displacements[-1]).max() > _CLOSED_WITHIN:
                raise InvalidInputError("points", _NOT_CLOSED, self.points)
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
        stretch: float = 1.0,
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
            stretch: Ratio of the path's times to those in a file with times.

        Raises:
            FileError: If the file cannot be read or is not as said above, naming the line.
            InvalidInputError: If ``ends`` is not one of its values, or a speed or the ratio is not
                above zero, or given for the other kind of file.
        """
        positive("speed", speed)
        positive("rate", rate)
        positive("stretch", stretch)
        path = Path(path)
        columns, table = _read(path)
        if columns[0] == "t":
            times = stretch * table[:, 0]
            if speed != SPEED:
                raise InvalidInputError("speed", f"is for a file without times, not {path}", speed)
            if rate != RATE:
                raise InvalidInputError("rate", f"is for a file without times, not {path}", rate)
        else:
            times = _times_at(table, speed, rate)
            if stretch != 1.0:
                problem = f"is for a file with times, not {path}, which takes a speed"
                raise InvalidInputError("stretch", problem, stretch)
        points = table[:, -7:-4] if "qw" in columns else table[:, 1:]
        quaternions = table[:, -4:] if "qw" in columns else None
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


def _times_at(poses: Array, speed: float, rate: float) -> Array:
    """Compute the times (m,) [s] of poses (m, 7) passed at a speed and an angular speed."""
    steps = np.diff(poses, axis=0)
    lengths = np.linalg.norm(steps[:, :3], axis=1)
    # A quarter of the angle by its chord, accurate near zero, to the nearer of the two signs.
    chord = np.linalg.norm(steps[:, 3:], axis=1)
    other = np.linalg.norm(poses[1:, 3:] + poses[:-1, 3:], axis=1)
    angles = 4.0 * np.arcsin(np.minimum(0.5 * np.minimum(chord, other), 1.0))
    return np.concatenate([[0.0], np.cumsum(np.maximum(lengths / speed, angles / rate))])


def _read(path: Path) -> tuple[list[str], Array]:
    """Read a file of points or poses: the names of its columns, and its rows."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            reader = csv.reader(file)
            lines = [(reader.line_num, row) for row in reader if any(map(str.strip, row))]
    except UnicodeDecodeError as error:
        raise FileError(path, "not UTF-8 text") from error
    except (OSError, ValueError, csv.Error) as error:  # a NUL in the path is a ValueError
        raise FileError(path, one_line(error)) from error
    (first, header), *filled = lines or [(1, [])]
    columns = [cell.strip().lower() for cell in header]
    if columns not in _HEADERS:
        problem = "the header must be t,x,y,z or t,x,y,z,qw,qx,qy,qz, the latter also without t"
        raise FileError(path, f"line {first}: {problem}")
    rows: list[list[float]] = []
    for number, cells in filled:
        row = [_number(cell) for cell in cells]
        problem = _problem(columns, cells, row, rows)
        if problem:
            raise FileError(path, f"line {number}: {problem}")
        rows.append(row)
    if len(rows) < 2:
        raise FileError(path, f"at least 2 rows are needed, it has {len(rows)}")
    return columns, np.array(rows)


def _number(cell: str) -> float:
    """Return the number in a cell; NaN if there is none."""
    try:
        return float(cell)
    except ValueError:
        return math.nan


def _problem(
    columns: list[str], cells: list[str], row: list[float], before: list[list[float]]
) -> str:
    """Describe the fault of a row after those before it; "" if it has none."""
    if len(cells) != len(columns):
        return f"{len(columns)} columns are needed, it has {len(cells)}"
    for column, cell, value in zip(columns, cells, row, strict=True):
        if not math.isfinite(value):
            return f"{column} is {cell!r}, not a finite number"
    if columns[0] == "t" and before and row[0] <= before[-1][0]:
        return "t does not increase"
    return ""
