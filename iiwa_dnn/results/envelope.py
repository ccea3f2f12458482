"""A long curve in stretches: mean, least and greatest value of each."""

import numpy as np
from numpy.typing import ArrayLike

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


def stretches(acting: ArrayLike, pieces: int = BUCKETS) -> FloatArray:
    """Find the stretches of a run in which something acts, as fractions of the run.

    The run is cut into so many pieces at most, and a piece with a step that acts counts as a whole.

    Args:
        acting: Other than 0 at the steps that act, (N,).
        pieces: Number of pieces, 1 or more.

    Returns:
        First and last fraction of each stretch, (M, 2).
    """
    steps = np.flatnonzero(acting)
    count = max(np.size(acting), 1)
    pieces = min(pieces, count)
    marked = np.zeros(pieces + 2, bool)
    marked[1 + steps * pieces // count] = True
    edges = np.flatnonzero(marked[1:] != marked[:-1]) / pieces
    return edges.reshape(-1, 2)
