"""A long curve in stretches: mean, least and greatest value of each."""

import numpy as np

from iiwa_dnn.results.record import FloatArray

BUCKETS = 700
"""Stretches that a curve is cut into: one for each pixel across a column at 200 dots an inch."""


def envelope(
    t: FloatArray, curve: FloatArray, buckets: int = BUCKETS
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Sum up a curve (M,) over times [s] (M,) in stretches of equal length; no spike is lost.

    Returns:
        Mean time, and mean, least and greatest value of each stretch, (min(M, buckets),) each.
    """
    if len(curve) <= buckets:
        return t, curve, curve, curve
    starts = np.linspace(0, len(curve), buckets, endpoint=False).astype(int)
    counts = np.diff(starts, append=len(curve))
    times, mean = (np.add.reduceat(values, starts) / counts for values in (t, curve))
    return times, mean, np.minimum.reduceat(curve, starts), np.maximum.reduceat(curve, starts)
