"""Verdicts on the paper's numbers, computed from ours: one rule for all of them.

``reproduced``: every number of ours is within a factor 2 of the paper's. Otherwise ``same trend``:
ours goes the same way as the paper's along the row. Otherwise ``not reproduced``.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from iiwa_dnn.files import plain
from iiwa_dnn.studies.statistics import Estimate, trend, trend_words

FACTOR = 2.0
"""Largest factor between a number and the paper's that still counts as reproduced."""

NEGLIGIBLE = 1e-3
"""A relative change below this is none, however narrow its interval; the paper's least is 0.015."""


def judge_row(
    x: Sequence[float], paper: Sequence[float | None], ours: Sequence[float | None]
) -> dict[str, Any]:
    """Judge a row of numbers that belong to the increasing parameter x, all of one length.

    The verdict is on the entries that the paper has, two at least; a number that we lack makes it
    ``not reproduced``.

    Returns:
        In JSON types: ``verdict``; ``ours_over_paper``, entry by entry, None where either is
        missing; ``our_trend`` and ``paper_trend``, with the steps against them.
    """
    # A number that is missing, of the paper's or of ours, is NaN here.
    table = np.array([x, paper, ours], dtype=float)
    at, theirs, mine = table[:, ~np.isnan(table[1])]
    level = "not reproduced"
    our_trend = "unknown"
    if not np.isnan(mine).any():
        our_trend = trend_words(at, mine)
        if all(map(_within_factor, mine / theirs)):
            level = "reproduced"
        elif trend(at, mine) == trend(at, theirs):
            level = "same trend"
    return {
        "verdict": level,
        "ours_over_paper": plain(table[2] / table[1]),
        "our_trend": our_trend,
        "paper_trend": trend_words(at, theirs),
    }


def judge_change(paper: float, ours: Estimate) -> dict[str, Any]:
    """Judge a relative change, such as that of the error by the filter; -0.1 is a tenth less.

    It is ``reproduced`` if the interval lies on the paper's side of zero and the mean is within a
    factor 2, ``same trend`` if only the former, else ``not reproduced``. Returned as by
    `judge_row`.
    """
    ratio = ours.mean / paper
    mine = _direction(ours)
    theirs = _direction(Estimate.exact(paper))
    level = "not reproduced"
    if mine == theirs and theirs != "no effect shown":
        level = "reproduced" if _within_factor(ratio) else "same trend"
    return {
        "verdict": level,
        "ours_over_paper": [ratio],
        "our_trend": mine,
        "paper_trend": theirs,
    }


def _within_factor(ratio: float) -> bool:
    return 1.0 / FACTOR <= ratio <= FACTOR


def _direction(change: Estimate) -> str:
    """Name the direction of a relative change, as far as its interval tells."""
    if change.sign == 0 or abs(change.mean) < NEGLIGIBLE:
        return "no effect shown"
    return "raises" if change.sign > 0 else "lowers"
