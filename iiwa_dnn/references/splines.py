r"""Splines through the rows of a path: cubic, near their rows everywhere, and smoothed.

A cubic spline, whose acceleration is continuous, swings far beyond rows of uneven steps or times.
A piece offends if its rows are equal, so that the path should pause there, or if it leaves their
span by more than `ALLOWED` of the smaller neighbouring step: an extremum of a parabola between even
rows leaves it by 1/8. The slopes at both ends of such a piece become those of the shape-preserving
interpolation

    F. N. Fritsch and J. Butland, "A method for constructing local monotone piecewise cubic
    interpolants", SIAM J. Sci. Stat. Comput. 5, 300-304 (1984),

and the others are solved for again, so that the acceleration is continuous at their rows, until no
piece offends. Velocity is continuous everywhere. Positions are judged axis by axis: what stands
still along one axis, above a table, does so whatever the others do. Quaternions have no such axes
and are judged by the length of their steps.

Rows that were recorded with noise are smoothed before by splines that stay within it.
"""

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.checks import Array
from iiwa_dnn.errors import InvalidInputError

Mask = NDArray[np.bool_]

ALLOWED = 0.25
"""Excursion of a piece beyond its rows that is allowed, in smaller neighbouring steps."""

_ROUNDING = 1e-9
"""Part of the largest step below which a step or an excursion counts as none."""

_CLOSED_WITHIN = 1e-9
"""Distance between both ends of a closed path that is rounding [m, rad]."""

_LINE = 0.02
"""Twice the width over the length up to which rows are a line."""

_MISSED = 1.2
"""Ratio of the squared distances that FITPACK has left to the noise from which on rows stay."""


def spline_through(
    times: Array, rows: Array, closed: bool, jointly: bool = False
) -> tuple[Array, Mask]:
    """Fit a spline to rows (m, k) at times (m,) [s], at rest at its ends unless it is closed.

    Args:
        times: Times of the rows [s], increasing, (m,).
        rows: The rows, (m, k); the last one of a closed path is the first one.
        closed: Whether the path repeats.
        jointly: Whether a piece leaves the span of its rows is judged by the lengths of steps and
            excursions (m, k), and not in each column by itself.

    Returns:
        Coefficients of x^3, x^2, x and 1 of the pieces, (m - 1, 4, k), x being the time since the
        piece began; and whether the acceleration jumps at its beginning, (m - 1,).
    """
    from scipy.interpolate import CubicHermiteSpline, PchipInterpolator  # 0.3 s for those who do

    count = len(times) - 1
    if not closed:  # a piece back to the start, at rest at both ends, which is not kept
        times = np.append(times, 2.0 * times[-1] - times[-2])
        rows = np.vstack([rows, rows[:1]])
    lengths = np.diff(times)
    steps = _sizes(np.diff(rows, axis=0), jointly)
    rounding = _ROUNDING * steps[:count].max()
    pauses = (steps <= rounding).all(axis=1)
    steps[count:] = np.inf
    allowed = ALLOWED * np.minimum(np.roll(steps, 1, 0), np.roll(steps, -1, 0)) + rounding
    around = np.cumsum(np.pad(lengths, (2, 1), mode="wrap"))
    preserving = PchipInterpolator(around, rows[[-2, *range(len(rows)), 1]]).c[2, 1:-1]
    at_rest = np.zeros(steps.shape, bool)
    at_rest[count:] = True  # of an open path alone
    at_rest[0] = not closed
    offending = np.tile(pauses[:, np.newaxis], rows.shape[1])
    while True:
        exchanged = offending | np.roll(offending, 1, axis=0)
        known = np.where(at_rest, 0.0, np.where(exchanged, preserving, np.nan))
        slopes = np.stack([_slopes(lengths, *each) for each in zip(rows.T, known.T, strict=True)])
        if not np.isfinite(slopes).all():
            problem = "have no spline: they are too far apart, or their times too uneven"
            raise InvalidInputError("points", problem, rows)
        pieces = CubicHermiteSpline(times, rows, slopes[:, [*range(len(lengths)), 0]].T).c
        found = offending | (_sizes(_excursions(pieces, lengths), jointly) > allowed)
        if np.array_equal(found, offending):
            break
        offending = found
    jumps = exchanged.any(axis=1) & ~(pauses & np.roll(pauses, 1)) & ~at_rest.any(axis=1)
    return pieces[:, :count].swapaxes(0, 1), jumps[:count]


def _sizes(values: Array, jointly: bool) -> Array:
    """Return the absolute values (p, k); jointly, the length of each row in all of its columns."""
    lengths = np.linalg.norm(values, axis=1, keepdims=True) * np.ones(values.shape[1])
    return lengths if jointly else np.abs(values)


def _slopes(lengths: Array, rows: Array, known: Array) -> Array:
    """Solve for the slopes of a closed cubic spline at its rows.

    Args:
        lengths: Lengths of the pieces [s], (p,).
        rows: The rows, (p + 1,), the last one being the first.
        known: Slopes that are given, (p,), NaN where the acceleration is to be continuous.

    Returns:
        All slopes, (p,).
    """
    from scipy.sparse import csc_array
    from scipy.sparse.linalg import spsolve

    before = np.roll(lengths, 1)
    chords = np.diff(rows) / lengths
    free = np.isnan(known)
    own = np.where(free, 2.0 * (before + lengths), 1.0)
    values = np.concatenate([own, free * lengths, free * before])
    here = np.arange(lengths.size)
    columns = np.concatenate([here, np.roll(here, 1), np.roll(here, -1)])
    curved = 3.0 * (lengths * np.roll(chords, 1) + before * chords)
    matrix = csc_array((values, (np.tile(here, 3), columns)))
    return np.asarray(spsolve(matrix, np.where(free, curved, known)))


@np.errstate(all="ignore")
def _excursions(pieces: Array, lengths: Array) -> Array:
    """Compute by how much cubics (4, p, k) of lengths (p,) leave the span of their ends, (p, k)."""
    a, b, slope = pieces[:3] * lengths[:, np.newaxis] ** np.array([3, 2, 1]).reshape(3, 1, 1)
    # The zeros of the derivative, without cancellation; a monotone cubic has none.
    root = -b - np.copysign(np.sqrt(np.maximum(b * b - 3.0 * a * slope, 0.0)), b)
    x = np.clip(np.nan_to_num([root / (3.0 * a), slope / root]), 0.0, 1.0)
    y = x * (slope + x * (b + x * a))
    end = a + b + slope
    beyond = np.abs(y - np.clip(y, np.minimum(end, 0.0), np.maximum(end, 0.0)))
    return np.asarray(beyond.max(axis=0))


def check_noise(argument: str, rows: Array, noise: float) -> None:
    """Refuse a standard deviation of noise that would smooth rows (m, k) to a point or a line.

    The length and the width of the rows are their largest and their second standard deviation along
    principal axes. Noise from the length on would leave a point, noise above twice the width a
    line. Rows that are all equal pass; of rows with a width below a hundredth of the length, a line
    already, the length alone counts.

    Raises:
        InvalidInputError: The noise is too large. The message has length and width.
    """
    deviations = rows - rows.mean(axis=0)
    length, width = np.linalg.svd(deviations, compute_uv=False)[:2] / np.sqrt(len(rows))
    is_point = noise >= length and np.ptp(rows, axis=0).any()
    if is_point or noise > 2.0 * width > _LINE * length:
        problem = (
            f"{noise:g} would smooth the path to a {'point' if is_point else 'line'}: its rows "
            f"have standard deviations of {length:.2g} and {width:.2g} along and across it"
        )
        raise InvalidInputError(argument, problem, noise)


def smoothed(name: str, times: Array, rows: Array, noise: float, closed: bool) -> Array:
    """Smooth rows (m, k) at times from 0 (m,) [s] whose noise has this standard deviation.

    Each column's spline is FITPACK's, with as few knots and as small jumps of the third derivative
    as squared distances of noise^2 a row allow; a row counts by the time that it stands for. The
    spline is periodic: it goes an open path to and fro, which is at rest at both ends.
    (`scipy.interpolate.make_splrep` has no periodic splines.) Fewer than three rows, or four of a
    closed path, stay as they are.

    Raises:
        InvalidInputError: The first and the last row of a closed path are not equal up to noise.
    """
    if closed and np.abs(rows[-1] - rows[0]).max() > max(_CLOSED_WITHIN, 6.0 * noise):
        problem = "the last row of a closed path must be the first one, up to the noise"
        raise InvalidInputError(name, problem, rows)
    if noise == 0.0 or len(times) < 3:
        return rows
    if not closed:
        there_and_back = np.vstack([rows, rows[-2::-1]])
        again = np.append(times, 2.0 * times[-1] - times[-2::-1])
        both = smoothed(name, again, there_and_back, noise, True)
        return 0.5 * (both[: len(times)] + both[: len(times) - 2 : -1])
    from scipy.interpolate import splev, splrep

    period = rows.copy()
    period[[0, -1]] = 0.5 * (rows[0] + rows[-1])
    steps = np.diff(times)
    spans = steps + np.roll(steps, 1)
    weights = np.sqrt(np.append(spans, spans[0]) / spans.mean())
    bound = steps.size * noise**2
    for column in period.T if steps.size > 2 else ():
        spline, left, *_ = splrep(
            times, column, weights, s=bound, per=True, full_output=True, quiet=True
        )
        if left <= _MISSED * bound:  # FITPACK gives up where the noise is far too small
            column[:] = splev(times, spline)
    period[-1] = period[0]
    return period
