"""Verdicts on the paper's numbers, computed from ours: one rule for all of them.

``reproduced``: every number of ours is within a factor 2 of the paper's. Otherwise ``same trend``:
ours goes the same way as the paper's along the row. Otherwise ``not reproduced``.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.studies.statistics import Estimate, trend, trend_words

FACTOR = 2.0
"""Largest factor between a number and the paper's that still counts as reproduced."""

NEGLIGIBLE = 1e-3
"""A relative change below this is none, however narrow its interval; the paper's least is 0.015."""

Level = Literal["reproduced", "same trend", "not reproduced"]


@dataclass(frozen=True)
class Verdict:
    """A verdict on one row of the paper's numbers.

    Attributes:
        level: The verdict.
        ratios: Ours over the paper's, entry by entry; None where either is missing.
        ours: Direction of ours, and the steps against it.
        paper: Direction of the paper's, likewise.
    """

    level: Level
    ratios: tuple[float | None, ...]
    ours: str
    paper: str

    def to_json(self) -> dict[str, Any]:
        """Return the verdict in JSON types, for a table."""
        return {
            "verdict": self.level,
            "ours_over_paper": list(self.ratios),
            "our_trend": self.ours,
            "paper_trend": self.paper,
        }


def judge_row(
    x: Sequence[float], paper: Sequence[float | None], ours: Sequence[float | None]
) -> Verdict:
    """Judge a row of numbers that belong to the increasing parameter x.

    The verdict is on the entries that the paper has, two at least; a number that we lack makes it
    ``not reproduced``.

    Raises:
        InvalidInputError: The lengths differ, or the paper has fewer than two numbers.
    """
    if not len(x) == len(paper) == len(ours):
        raise InvalidInputError("ours", f"has {len(ours)} entries for {len(x)}", ours)
    # A number that is missing, of the paper's or of ours, is NaN here.
    table = np.array([x, paper, ours], dtype=float)
    ratios = tuple(None if np.isnan(ratio) else ratio for ratio in (table[2] / table[1]).tolist())
    at, theirs, mine = table[:, ~np.isnan(table[1])]
    paper_trend = trend_words(at, theirs)
    if np.isnan(mine).any():
        return Verdict("not reproduced", ratios, "unknown", paper_trend)
    our_trend = trend_words(at, mine)
    same = trend(at, mine) == trend(at, theirs)
    level: Level = "same trend" if same else "not reproduced"
    if all(map(_within_factor, mine / theirs)):
        level = "reproduced"
    return Verdict(level, ratios, our_trend, paper_trend)


def judge_change(paper: float, ours: Estimate) -> Verdict:
    """Judge a relative change, such as that of the error by the filter; -0.1 is a tenth less.

    It is ``reproduced`` if the interval lies on the paper's side of zero and the mean is within a
    factor 2, ``same trend`` if only the former, else ``not reproduced``.
    """
    ratio = ours.mean / paper if paper else None
    mine = _direction(ours)
    theirs = _direction(Estimate.exact(paper))
    level: Level = "not reproduced"
    if mine == theirs and theirs != "no effect shown":
        level = "reproduced" if _within_factor(ratio) else "same trend"
    return Verdict(level, (ratio,), mine, theirs)


def _within_factor(ratio: float | None) -> bool:
    return ratio is not None and 1.0 / FACTOR <= ratio <= FACTOR


def _direction(change: Estimate) -> str:
    """Name the direction of a relative change, as far as its interval tells."""
    if change.sign == 0 or abs(change.mean) < NEGLIGIBLE:
        return "no effect shown"
    return "raises" if change.sign > 0 else "lowers"
