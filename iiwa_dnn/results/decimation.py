"""Fewer points for a figure: what of 100,000 samples is worth drawing in a column of 700 pixels."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from iiwa_dnn.results.record import FloatArray, IntArray

BUCKETS = 700  # one for each pixel across a column at 200 dots an inch


def decimate(values: FloatArray, buckets: int = BUCKETS) -> IntArray:
    """Choose the samples to draw: each bucket's extremes, so that no spike is lost.

    Args:
        values: One curve (M,), or the coordinates of one path (M, c).
        buckets: How many stretches to cut the samples into.

    Returns:
        Indices of the first and last sample and of each bucket's least and greatest sample in
        each coordinate, increasing; all indices if there are few samples.
    """
    values = values if values.ndim == 2 else values[:, None]
    samples, coordinates = values.shape
    if samples <= 2 * buckets * coordinates:
        return np.arange(samples)
    edges = np.linspace(0, samples, buckets + 1).astype(int)
    chosen = [0, samples - 1]
    for start, stop in pairwise(edges):
        part = values[start:stop]
        # argmin and argmax would both return the NaN, if there is one.
        chosen += (start + np.where(np.isnan(part), np.inf, part).argmin(axis=0)).tolist()
        chosen += (start + np.where(np.isnan(part), -np.inf, part).argmax(axis=0)).tolist()
    return np.unique(chosen)


def envelope(
    t: FloatArray, curve: FloatArray, buckets: int = BUCKETS
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Cut a curve into stretches of equal length and sum up each.

    Args:
        t: Times [s], (M,).
        curve: Values, (M,).
        buckets: How many stretches at most.

    Returns:
        Mean time, and mean, least and greatest value of each stretch, (min(M, buckets),) each.
    """
    if len(curve) <= buckets:
        return t, curve, curve, curve
    starts = np.linspace(0, len(curve), buckets, endpoint=False).astype(int)
    counts = np.diff(starts, append=len(curve))
    times, mean = (np.add.reduceat(values, starts) / counts for values in (t, curve))
    return times, mean, np.minimum.reduceat(curve, starts), np.maximum.reduceat(curve, starts)
