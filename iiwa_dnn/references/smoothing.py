"""Smoothing of recorded rows by splines that stay within their noise."""

import warnings
from typing import Any

import numpy as np

from iiwa_dnn.checks import Array
from iiwa_dnn.errors import InvalidInputError

_MISSED = 1.2
"""Ratio of what FITPACK has left to the noise from which on a column stays as it is."""


def smoothed(times: Array, rows: Array, noise: float, closed: bool, sign: float = 1.0) -> Array:
    """Smooth rows (m, k) at times from 0 (m,) [s] whose noise has this standard deviation.

    Each column's spline is FITPACK's, with as few knots and as small jumps of the third derivative
    as squared distances of noise^2 a row allow; a row counts by the time that it stands for. The
    spline is periodic: it goes a path with two ends to and fro, which is at rest at both of them,
    and a closed one twice. (`scipy.interpolate.make_splrep` has no periodic splines.)

    Args:
        times: The times.
        rows: The rows.
        noise: The standard deviation.
        closed: Whether the path repeats.
        sign: Sign of the rows in the next round of a closed path: -1.0 for quaternions after an
            odd number of turns.

    Raises:
        InvalidInputError: The first and the last row of a closed path are not equal up to noise.
    """
    from scipy.interpolate import splev, splrep

    if len(times) < 3:
        return rows
    if closed:
        if np.abs(sign * rows[-1] - rows[0]).max() > 6.0 * noise:
            problem = "the last row of a closed path must be the first one, up to the noise"
            raise InvalidInputError("noise", problem, noise)
        first = 0.5 * (rows[0] + sign * rows[-1])
        once = np.vstack([first, rows[1:-1]])
        period = np.vstack([once, sign * once, first])
        again = times + times[-1]
    else:
        period = np.vstack([rows, rows[-2::-1]])
        again = 2.0 * times[-1] - times
    knots = np.unique([times, again])
    steps = np.diff(knots)
    spans = 0.5 * (steps + np.roll(steps, 1))
    weights = np.sqrt(np.append(spans, spans[0]) / spans.mean())
    bound = steps.size * noise**2
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of too few iterations: the outcome is judged below
        fits = [splrep(knots, column, weights, s=bound, per=True) for column in period.T]
    # The mean of both rounds is as symmetric as the rows.
    smooth = np.stack(
        [0.5 * (splev(times, fit) + sign * splev(again, fit)) for fit in fits], axis=1
    )
    given = np.vstack([period[: len(times) - 1], sign * first if closed else rows[-1:]])
    left = np.average((smooth - given) ** 2, axis=0, weights=weights[: len(times)] ** 2)
    smooth = np.where(left <= (_MISSED * noise) ** 2, smooth, given)
    if closed:
        smooth[-1] = sign * smooth[0]
    return smooth


def smoothed_turns(times: Array, turns: Any, noise: float, closed: bool) -> Any:
    """Smooth orientations, a `Rotation` of m, of this standard deviation [rad]; see `smoothed`."""
    from scipy.spatial.transform import Rotation

    rows = turns.as_quat()
    along = np.sum(rows[1:] * rows[:-1], axis=1)
    rows[1:] *= np.cumprod(np.where(along < 0.0, -1.0, 1.0))[:, np.newaxis]
    sign = -1.0 if closed and rows[0] @ rows[-1] < 0.0 else 1.0
    # A quaternion's entries are sines and cosines of half an angle.
    return Rotation.from_quat(smoothed(times, rows, 0.5 * noise, closed, sign))
