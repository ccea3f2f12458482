r"""Splines through the rows of a path: cubic, near their rows everywhere, and smoothed.

A cubic spline, whose acceleration is continuous, swings far beyond rows of uneven steps or times.
A piece offends if its rows are equal, so that the path should pause there, or if it leaves their
span by more than `ALLOWED` of the smaller neighbouring step: an extremum of a parabola between even
rows leaves it by 1/8. The slopes at both ends of such a piece become those of the shape-preserving
interpolation

    F. N. Fritsch and J. Butland, "A method for constructing local monotone piecewise cubic
    interpolants", SIAM J. Sci. Stat. Comput. 5, 300-304 (1984),

and between such rows the path is the cubic spline of these end slopes, until no piece offends.
Velocity is continuous, and acceleration jumps at the exchanged rows alone. Positions are judged
axis by axis: what stands still along one axis, above a table, does so whatever the others do. A
turn has no such axes: it is judged by its rotation vector's length, and rests at an exchanged row.

Rows that were recorded with noise are smoothed before by splines that stay within it.
"""

from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.checks import Array
from iiwa_dnn.errors import InvalidInputError

Mask = NDArray[np.bool_]
Rows = NDArray[np.intp]

ALLOWED = 0.25
"""Excursion of a piece beyond its rows that is allowed, in smaller neighbouring steps."""

_ROUNDING = 1e-9
"""Part of the largest step below which a step or an excursion counts as none."""

_BESIDE = 1e-10
"""Least time between the two equal rows at which a turn rests [s]."""

_MISSES = 1e-9
"""Distance of a piece's end from its next pose above which scipy's iterations diverged [rad]."""

_ROUNDS = 6
"""Rounds before and after a closed path of turns, whose ends are then without effect."""


_MISSED = 1.2
"""Ratio of the squared distances that FITPACK has left to the noise from which on rows stay."""


class Spline(NamedTuple):
    """A spline's pieces, and the rows at which its acceleration jumps.

    Attributes:
        pieces: Coefficients of x^3, x^2, x, (p, 3, 3), and of a spline of positions 1, (p, 4, 3).
        jumps: Whether the acceleration jumps where a piece begins, (p,).
        excursion: Largest one of the cubic spline beyond the rows of a piece that offends [m, rad];
            inf if the iterations for its turns diverge.
    """

    pieces: Array
    jumps: Mask
    excursion: float


def spline_of_positions(times: Array, moves: Array, closed: bool, limited: bool) -> Spline:
    """Fit a spline to positions (m, 3) [m] at times from 0 (m,) [s], at rest at its ends or closed.

    Args:
        times: The times.
        moves: The positions.
        closed: Whether the path repeats; it ends at rest otherwise.
        limited: Whether to exchange slopes; the cubic spline otherwise.
    """
    from scipy.interpolate import CubicSpline, PchipInterpolator  # 0.3 s for those who use it

    cubic = CubicSpline(times, moves, bc_type="periodic" if closed else "clamped").c
    # One row more on either side: the next one of a closed path, or one at rest.
    around = moves[[-2 if closed else 0, *range(len(times)), 1 if closed else -1]]
    knots = np.cumsum(np.pad(np.diff(times), (2, 1), mode="wrap"))
    preserving = PchipInterpolator(knots, around).c[:, 1:]

    def fit(knots: Array, rows: Rows, axis: int) -> Any:
        if len(rows) == 2:  # most segments of a noisy recording
            return preserving[:, rows[:1]][..., [axis]]
        ends = [(1, preserving[2, row, [axis]]) for row in (rows[0], rows[-1])]
        return CubicSpline(knots, moves[rows][:, [axis]], bc_type=ends).c

    steps = np.abs(np.diff(moves, axis=0))
    return _limited(cubic[..., np.newaxis], fit, steps, times, closed, limited)


def spline_of_turns(times: Array, turns: Any, closed: bool, limited: bool) -> Spline:
    """Fit a spline to turns, a `Rotation` of m; the other arguments as of `spline_of_positions`.

    Returns:
        The spline of each piece's rotation vector, about the axes of the piece's first pose.
    """

    def fit(knots: Array, rows: Rows, axis: int = 0) -> Array:
        # At rest by rows that are given twice.
        beside = max(_BESIDE, 4.0 * np.spacing(knots[-1]))
        twice = np.array([knots[0] - beside, *knots, knots[-1] + beside])
        return _turning(twice, turns[np.pad(rows, 1, mode="edge")])[:, 1:-1]

    count = len(times) - 1
    if closed:
        rows = np.arange(-_ROUNDS * count, (_ROUNDS + 1) * count + 1)
        rounds = _turning(rows // count * times[-1] + times[rows % count], turns[rows % count])
        cubic = rounds[:, _ROUNDS * count :][:, :count]
    else:
        cubic = fit(times, np.arange(count + 1))
    steps = (turns[:-1].inv() * turns[1:]).magnitude()[:, np.newaxis]
    return _limited(cubic[:, :, np.newaxis], fit, steps, times, closed, limited)


def _limited(
    cubic: Array,
    fit: Callable[[Array, Rows, int], Array],
    steps: Array,
    times: Array,
    closed: bool,
    limited: bool,
) -> Spline:
    """Replace slopes at the ends of pieces that overshoot, until none does.

    Args:
        cubic: Pieces of the cubic spline along k axes, (3 or 4, p, k, 3 / k).
        fit: Fits those of one axis, (3 or 4, r, 3 / k), between rows with exchanged slopes, whose
            times and numbers are (r + 1,).
        steps: Distances between the rows along each axis, or angles, (p, k).
        times: Times of the rows (p + 1,) [s].
        closed: Whether the path repeats.
        limited: Whether pieces may offend at all.
    """
    beside = np.pad(steps, ((1, 1), (0, 0)), mode="wrap" if closed else "reflect")
    allowed = ALLOWED * np.minimum(beside[:-2], beside[2:]) + _ROUNDING * steps.max()
    pauses = steps.max(axis=1, keepdims=True) <= _ROUNDING * steps.max()
    offending = np.zeros(steps.shape, bool)
    excursion = 0.0
    while True:
        around = np.pad(offending, ((1, 1), (0, 0)), mode="wrap" if closed else "constant")
        exchanged = around[:-1] | around[1:]
        pieces = cubic.copy()
        for axis in np.flatnonzero(exchanged.any(axis=0)):
            for knots, rows in _segments(times, exchanged[:, axis], closed):
                pieces[:, rows[:-1] % len(steps), axis] = fit(knots, rows, axis)
        excursions = _excursions(pieces, np.diff(times))
        found = offending | (limited & ((excursions > allowed) | pauses))
        if np.array_equal(found, offending):
            break
        excursion = excursion or float(excursions.max(initial=0.0, where=found))
        offending = found
    if not np.isfinite(pieces).all():
        problem = "scipy finds no spline through rows of times as uneven as these"
        raise InvalidInputError("times", problem, times)
    jumps = exchanged[:-1].any(axis=1) & ~(pauses & np.roll(pauses, 1))[:, 0]  # none in a pause
    jumps[0] &= closed
    return Spline(pieces.swapaxes(0, 1).reshape(len(steps), -1, 3), jumps, excursion)


def _segments(times: Array, exchanged: Mask, closed: bool) -> Iterator[tuple[Array, Rows]]:
    """Yield times and numbers of the rows from each exchanged one to the next, or to an open end.

    A closed path is gone round once from its first exchanged row.
    """
    ends = exchanged.copy()
    ends[[0, -1]] |= not closed
    numbers = np.r_[: len(times), 1 : len(times)]
    knots = np.append(times, times[-1] + times[1:])
    found = np.flatnonzero(ends[numbers])[: np.count_nonzero(ends[1:]) + 1]
    for first, last in pairwise(found):
        yield knots[first : last + 1], numbers[first : last + 1]


@np.errstate(all="ignore")
def _excursions(pieces: Array, lengths: Array) -> Array:
    """Compute the overshoot of cubics (3 or 4, p, k, 3 / k) beyond their ends, (p, k)."""
    powers = np.array([3, 2, 1]).reshape(3, 1, 1, 1)
    a, b, slope = pieces[:3] * lengths[:, np.newaxis, np.newaxis] ** powers
    # The zeros of the derivative, without cancellation; a monotone cubic has none.
    root = -b - np.copysign(np.sqrt(np.maximum(b * b - 3.0 * a * slope, 0.0)), b)
    x = np.clip(np.nan_to_num([root / (3.0 * a), slope / root]), 0.0, 1.0)
    y = x * (slope + x * (b + x * a))
    end = a + b + slope
    beyond = np.abs(y - np.clip(y, np.minimum(end, 0.0), np.maximum(end, 0.0))).max(axis=0)
    return np.asarray(np.nan_to_num(np.linalg.norm(beyond, axis=-1), nan=np.inf))


@np.errstate(all="ignore")
def _turning(knots: Array, turns: Any) -> Array:
    """Fit scipy's spline of turns; NaN where its iterations diverge.

    Diverged pieces may be finite, and so large that rounding leads them past their next pose.

    Returns:
        Coefficients of x^3, x^2, x, (3, p, 3), about the axes of each piece's first pose.
    """
    from scipy.spatial.transform import RotationSpline

    try:
        pieces = np.array(RotationSpline(knots, turns).interpolator.c[:3])
    except ValueError:
        return np.full((3, len(knots) - 1, 3), np.nan)
    lengths = np.diff(knots)[:, np.newaxis]
    ends = lengths * (pieces[2] + lengths * (pieces[1] + lengths * pieces[0]))
    misses = np.abs(ends - (turns[:-1].inv() * turns[1:]).as_rotvec()).max(axis=1)
    pieces[:, ~(misses <= _MISSES)] = np.nan
    return pieces


def smoothed(times: Array, rows: Array, noise: float, closed: bool) -> Array:
    """Smooth rows (m, k) at times from 0 (m,) [s] whose noise has this standard deviation.

    Each column's spline is FITPACK's, with as few knots and as small jumps of the third derivative
    as squared distances of noise^2 a row allow; a row counts by the time that it stands for. The
    spline is periodic: it goes an open path to and fro, which is at rest at both ends.
    (`scipy.interpolate.make_splrep` has no periodic splines.)

    Raises:
        InvalidInputError: The first and the last row of a closed path are not equal up to noise.
    """
    if noise == 0.0 or len(times) < 4 - (not closed):
        return rows
    if not closed:
        there_and_back = np.vstack([rows, rows[-2::-1]])
        again = np.append(times, 2.0 * times[-1] - times[-2::-1])
        both = smoothed(again, there_and_back, noise, True)
        return 0.5 * (both[: len(times)] + both[: len(times) - 2 : -1])
    if np.abs(rows[-1] - rows[0]).max() > 6.0 * noise:
        problem = "the last row of a closed path must be the first one, up to the noise"
        raise InvalidInputError("noise", problem, noise)
    from scipy.interpolate import splev, splrep

    period = rows.copy()
    period[[0, -1]] = 0.5 * (rows[0] + rows[-1])
    steps = np.diff(times)
    spans = steps + np.roll(steps, 1)
    weights = np.sqrt(np.append(spans, spans[0]) / spans.mean())
    bound = steps.size * noise**2
    for column in period.T:
        spline, left, *_ = splrep(
            times, column, weights, s=bound, per=True, full_output=True, quiet=True
        )
        if left <= _MISSED * bound:  # FITPACK gives up where the noise is far too small
            column[:] = splev(times, spline)
    period[-1] = period[0]
    return period


def smoothed_turns(times: Array, turns: Any, noise: float, closed: bool) -> Any:
    """Smooth orientations, a `Rotation` of m, of this standard deviation [rad]; see `smoothed`."""
    from scipy.spatial.transform import Rotation

    # A turn by a small angle moves an entry of the matrix by at most that angle.
    rows = smoothed(times, turns.as_matrix().reshape(-1, 9), noise, closed)
    return Rotation.from_matrix(rows.reshape(-1, 3, 3))
