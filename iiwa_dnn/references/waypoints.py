"""A smooth path through points, given in code or in a CSV file."""

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

from iiwa_dnn.checks import finite_array
from iiwa_dnn.errors import FileError, InvalidInputError
from iiwa_dnn.references.base import Array, Reference

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

Ends = Literal["clamped", "natural", "closed"]

_SCIPY_ENDS = {"clamped": "clamped", "natural": "natural", "closed": "periodic"}
_COLUMNS = ["t", "x", "y", "z"]
_CLOSED_WITHIN = 1e-9  # [m]


@njit(cache=True, error_model="numpy")
def _path(times: Array, numbers: Array, out: Array, row: int, column: int) -> None:
    """Add displacement and velocity to targets (k, 18) in `out`; see `Reference.path`."""
    closed, pieces = numbers[0] != 0.0, int(numbers[1])
    knots, end = numbers[2 : 3 + pieces], numbers[2 + pieces]
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


@dataclass(frozen=True, eq=False, repr=False)
class Waypoints(Reference):
    """A cubic spline through points: position, velocity and acceleration are continuous.

    Time counts from the first row and displacement from the first point. Before the start and
    after the end the path rests at its first and last point; a closed path repeats instead.

    Attributes:
        times: Times of the points [s], shape (m,), increasing, m >= 2.
        points: The points [m], shape (m, 3).
        ends: "clamped": at rest at both ends. "natural": without acceleration at both ends, where
            the velocity may then jump. "closed": ends as it begins and repeats; the last point
            must be the first one, and m >= 3.

    Raises:
        InvalidInputError: If a parameter is not as said above.
    """

    name: ClassVar[str] = "waypoints"
    path: ClassVar[Any] = staticmethod(_path)
    times: Array
    points: Array
    ends: Ends = "clamped"

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
        self._set(numbers=np.concatenate([head, spline.x, pieces]))

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
    def from_csv(cls, path: str | os.PathLike[str], ends: Ends = "clamped") -> Waypoints:
        """Read the points from a CSV file with the header ``t,x,y,z``, in [s] and [m].

        Args:
            path: The file. Empty lines in it are skipped.
            ends: As for :class:`Waypoints`.

        Raises:
            FileError: If the file cannot be read or is not as said above, naming the line.
            InvalidInputError: If ``ends`` is not one of its values.
        """
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
        try:
            return cls(rows[:, 0], rows[:, 1:], ends)
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


def _rows(path: Path, file: Iterable[str]) -> Iterator[list[float]]:
    """Read rows of t, x, y, z; each complaint names its line."""
    reader, last = csv.reader(file), -math.inf
    stripped = ([cell.strip() for cell in row] for row in reader)
    filled = ((f"line {reader.line_num}", cells) for cells in stripped if any(cells))
    try:
        line, header = next(filled, ("line 1", []))
        if [cell.lower() for cell in header] != _COLUMNS:
            raise FileError(path, f"{line}: the header must be t,x,y,z")
        for line, cells in filled:
            if len(cells) != len(_COLUMNS):
                raise FileError(path, f"{line}: 4 columns are needed, it has {len(cells)}")
            values = []
            for column, cell in zip(_COLUMNS, cells, strict=True):
                try:
                    values.append(float(cell))
                except ValueError:
                    raise FileError(path, f"{line}: {column} is {cell!r}, not a number") from None
                if not math.isfinite(values[-1]):
                    raise FileError(path, f"{line}: {column} is {cell}, not finite")
            if values[0] <= last:
                raise FileError(path, f"{line}: t does not increase")
            last = values[0]
            yield values
    except csv.Error as error:
        raise FileError(path, f"line {reader.line_num}: {error}") from error
