r"""Splines through the rows of a path: cubic, and with slopes that keep each piece near its rows.

A cubic spline, whose acceleration is continuous, swings far beyond rows of uneven steps or times.
A piece offends if its rows are equal, so that the path should pause there, or if it leaves their
span by more than `ALLOWED` of the smaller neighbouring step: an extremum of a parabola between even
rows leaves it by 1/8. The slopes at both ends of such a piece become those of the shape-preserving
interpolation

    F. N. Fritsch and J. Butland, "A method for constructing local monotone piecewise cubic
    interpolants", SIAM J. Sci. Stat. Comput. 5, 300-304 (1984),

and the spline's equations give the slopes at all other rows, until no piece offends. Velocity is
continuous, and acceleration jumps at the exchanged rows alone. Positions are judged axis by axis:
what stands still along one axis, above a table, does so whatever the others do. A turn has no such
axes: it is judged by its rotation vector's length, and rests at an exchanged row.
"""

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.checks import Array

Mask = NDArray[np.bool_]

ALLOWED = 0.25
"""Excursion of a piece beyond its rows that is allowed, in smaller neighbouring steps."""

_ROUNDING = 1e-9
"""Part of the largest step below which a step or an excursion counts as none."""

_BESIDE = 1e-10
"""Time between the two equal rows at which a turn rests [s]."""

_ROUNDS = 6
"""Rounds before and after a closed path of turns, whose ends are then without effect."""


class Spline(NamedTuple):
    """A spline's pieces, and the rows at which its acceleration jumps.

    Attributes:
        pieces: Coefficients of x^3, x^2, x, (p, 3, 3), and of a spline of positions 1, (p, 4, 3).
        jumps: Whether the acceleration jumps where a piece begins, (p,).
        excursion: Largest one of the cubic spline beyond the rows of a piece that offends [m, rad].
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
    from scipy.interpolate import CubicHermiteSpline, CubicSpline  # 0.3 s for those who use it

    cubic = CubicSpline(times, moves, bc_type="periodic" if closed else "clamped")

    def fit(exchanged: Mask) -> Any:
        if not exchanged.any():
            return cubic.c
        return CubicHermiteSpline(times, moves, _slopes(cubic, moves, exchanged, closed)).c

    return _limit(fit, np.abs(np.diff(moves, axis=0)), np.diff(times), closed, limited)


def spline_of_turns(times: Array, turns: Any, closed: bool, limited: bool) -> Spline:
    """Fit a spline to turns, a `Rotation` of m; the other arguments as of `spline_of_positions`.

    Returns:
        The spline of each piece's rotation vector, about the axes of the piece's first pose.
    """
    steps = (turns[:-1].inv() * turns[1:]).magnitude()[:, np.newaxis]
    fit = partial(_turning, times, turns, closed)
    return _limit(fit, steps, np.diff(times), closed, limited)


def _limit(
    fit: Callable[[Mask], Any], steps: Array, lengths: Array, closed: bool, limited: bool
) -> Spline:
    """Exchange slopes at the ends of pieces that offend, until none does.

    Args:
        fit: Fits the pieces (3 or 4, p, 3), with other slopes at some rows (p + 1, k).
        steps: Distances between the rows (p, k), along each axis, k = 3, or the angles, k = 1.
        lengths: Times between the rows (p,) [s].
        closed: Whether the path repeats.
        limited: Whether pieces may offend at all.
    """
    count, axes = steps.shape
    pauses = steps.max(axis=1, keepdims=True) <= _ROUNDING * steps.max()
    neighbours = np.stack([np.roll(steps, 1, axis=0), np.roll(steps, -1, axis=0)])
    if not closed:
        neighbours[[0, 1], [0, -1]] = np.inf
    allowed = ALLOWED * neighbours.min(axis=0) + _ROUNDING * steps.max()
    exchanged = np.zeros((count + 1, axes), bool)
    excursion = 0.0
    while True:
        pieces = fit(exchanged)
        excursions = np.nan_to_num(_excursions(pieces, lengths), nan=np.inf)
        if axes == 1:
            excursions = np.linalg.norm(excursions, axis=1, keepdims=True)
        offending = limited & ((excursions > allowed) | pauses)
        excursion = excursion or float(excursions.max(initial=0.0, where=offending))
        around = np.pad(offending, ((1, 1), (0, 0)), mode="wrap" if closed else "constant")
        rows = exchanged | around[:-1] | around[1:]
        if np.array_equal(rows, exchanged):
            break
        exchanged = rows
    if not np.isfinite(pieces).all():
        raise ValueError("scipy finds no spline through rows of times as uneven as these")
    jumps = exchanged[:-1].any(axis=1) & ~(pauses & np.roll(pauses, 1))[:, 0]  # none in a pause
    jumps[0] &= closed
    return Spline(pieces.swapaxes(0, 1), jumps, excursion)


@np.errstate(all="ignore")
def _excursions(pieces: Array, lengths: Array) -> Array:
    """Compute how far cubics (3 or 4, p, 3) leave the span of their ends, (p, 3)."""
    a, b, slope = pieces[:3]
    last = np.broadcast_to(lengths[:, np.newaxis], a.shape)
    # The zeros of the derivative, without cancellation; a monotone cubic has none.
    root = -b - np.copysign(np.sqrt(np.maximum(b * b - 3.0 * a * slope, 0.0)), b)
    extrema = np.nan_to_num([root / (3.0 * a), slope / root])
    x = np.stack([*np.clip(extrema, 0.0, last), last])
    y = x * (slope + x * (b + x * a))
    above = y.max(axis=0) - np.maximum(y[2], 0.0)
    below = np.minimum(y[2], 0.0) - y.min(axis=0)
    return np.asarray(np.maximum(above, below))


def _slopes(cubic: Any, moves: Array, exchanged: Mask, closed: bool) -> Array:
    """Compute the slopes (m, 3) of a spline with shape-preserving ones at the exchanged rows."""
    from scipy.interpolate import PchipInterpolator
    from scipy.sparse import csc_array
    from scipy.sparse.linalg import spsolve

    # One piece more on either side: the next one of a closed path, or one at rest.
    lengths = np.pad(np.diff(cubic.x), 1, mode="wrap")
    steps = np.pad(np.diff(moves, axis=0), ((1, 1), (0, 0)), mode="wrap" if closed else "constant")
    sums = np.cumsum(np.pad(steps, ((1, 0), (0, 0))), axis=0)
    preserving = PchipInterpolator(np.cumsum(np.pad(lengths, (1, 0))), sums).c[2, 1:]
    count = len(moves) - closed
    before = lengths[:count]
    after = lengths[1 : count + 1]
    rates = steps / lengths[:, np.newaxis]
    wanted = 3.0 * (after * rates[:count].T + before * rates[1 : count + 1].T)
    fixed = exchanged.copy()
    fixed[[0, -1]] |= not closed
    rows = np.arange(count)
    columns = np.concatenate([np.roll(rows, 1), rows, np.roll(rows, -1)])
    slopes = np.vstack([cubic.c[2], closed * cubic.c[2, :1]])
    for axis in np.flatnonzero(exchanged.any(axis=0)):
        given = fixed[:count, axis]
        bands = np.where(given, [[0.0], [1.0], [0.0]], [after, 2.0 * (before + after), before])
        matrix = csc_array((bands.ravel(), (np.tile(rows, 3), columns)), shape=(count, count))
        solved = spsolve(matrix, np.where(given, preserving[:count, axis], wanted[axis]))
        free = np.resize(solved, len(moves))  # a closed path ends as it begins
        slopes[:, axis] = np.where(fixed[:, axis], preserving[:, axis], free)
    return slopes


def _turning(times: Array, turns: Any, closed: bool, exchanged: Mask) -> Array:
    """Fit scipy's spline of turns, at rest at its ends or closed, and at exchanged rows (m, 1).

    Returns:
        Coefficients of x^3, x^2, x, (3, p, 3), about the axes of each piece's first pose.
    """
    from scipy.spatial.transform import RotationSpline

    resting = exchanged[:-1, 0].copy()
    resting[0] |= not closed
    pieces = len(resting)
    rounds = np.arange(-_ROUNDS, _ROUNDS + 1)[:, np.newaxis] if closed else np.zeros((1, 1))
    knots = np.append(rounds * times[-1] + times[:-1], (rounds[-1] + 1) * times[-1])
    rows = np.append(np.tile(np.arange(pieces), len(rounds)), 0 if closed else pieces)
    if not closed:
        knots = np.append(knots, knots[-1] + _BESIDE)
        rows = np.append(rows, pieces)
    at_rest = np.flatnonzero(np.tile(resting, len(rounds)))  # rows that are given twice
    knots = np.insert(knots, at_rest, knots[at_rest] - _BESIDE)
    own = np.insert(np.ones(len(rows), bool), at_rest, False)[:-1]
    try:
        with np.errstate(all="ignore"):
            spline = RotationSpline(knots, turns[np.insert(rows, at_rest, rows[at_rest])])
    except ValueError:  # its iterations diverge
        return np.full((3, pieces, 3), np.nan)
    first = _ROUNDS * pieces if closed else 0
    return np.asarray(spline.interpolator.c[:3, own][:, first : first + pieces])
