r"""Means with intervals, paired differences, trends, and verdicts on numbers beside a paper's.

With :math:`\bar x` the mean and s the standard deviation of k independent samples, the interval

.. math::  \bar x \pm t_{k-1,\,(1+c)/2}\, s / \sqrt{k}

holds the true mean with confidence c (Student's t). If two runs share their noise, the
difference is taken run by run before it is averaged: the noise that both share cancels, and the
interval is the narrower for it.

A verdict is ``reproduced`` if every number is within a factor 2 of the paper's. Otherwise it is
``same trend`` if Kendall's tau of the numbers along the row has the sign of the paper's, else
``not reproduced``.

Sources: Student, "The probable error of a mean", Biometrika 6 (1908); M. G. Kendall, "A new measure
of rank correlation", Biometrika 30 (1938).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.stats import kendalltau, t as student

from iiwa_dnn.checks import finite_array
from iiwa_dnn.files import plain

CONFIDENCE = 0.95
FLAT = 0.05
"""A series whose values differ by no more than this fraction of their mean is called constant."""

FACTOR = 2.0
"""Largest factor between a number and the paper's that still counts as reproduced."""

NEGLIGIBLE = 1e-3
"""A relative change below this is none, however narrow its interval; the paper's least is 0.015."""

Trend = Literal["rising", "falling", "constant", "none"]


@dataclass(frozen=True)
class Estimate:
    """A mean and its confidence interval.

    Attributes:
        mean: Mean of the samples.
        half_width: Half the width of the confidence interval around it; 0 of a number without
            chance in it, such as that of a quiet run.
        samples: Number of samples; 1 of such a number.
    """

    mean: float
    half_width: float = 0.0
    samples: int = 1

    @property
    def low(self) -> float:
        """Lower end of the interval."""
        return self.mean - self.half_width

    @property
    def high(self) -> float:
        """Upper end of the interval."""
        return self.mean + self.half_width

    @property
    def sign(self) -> int:
        """1 or -1 where the whole interval is above or below zero, 0 where zero lies in it."""
        return int(self.low > 0.0) - int(self.high < 0.0)

    def to_json(self) -> dict[str, Any]:
        """Return the estimate in JSON types, for a table."""
        return {"mean": self.mean, "low": self.low, "high": self.high, "samples": self.samples}


def estimate(samples: ArrayLike) -> Estimate:
    """Estimate the mean of independent samples (k,), two or more, with its confidence interval.

    Raises:
        InvalidInputError: A sample is not finite.
    """
    values = finite_array("samples", samples, (-1,))
    # Not scipy's ttest_1samp, whose interval is NaN where all samples are equal.
    quantile = float(student.ppf(0.5 * (1.0 + CONFIDENCE), values.size - 1))
    half_width = quantile * float(values.std(ddof=1)) / float(np.sqrt(values.size))
    return Estimate(float(values.mean()), half_width, values.size)


def paired_difference(after: ArrayLike, before: ArrayLike) -> Estimate:
    """Estimate the mean of ``after - before`` over pairs, (k,) both: entry i shares its noise."""
    return estimate(np.subtract(after, before))


def trend(x: ArrayLike, y: ArrayLike) -> Trend:
    """Find the trend of y over x, (k,): the sign of Kendall's tau, or ``none`` if that is zero.

    It is ``constant`` if y spreads over at most ``FLAT`` of its mean.
    """
    if np.ptp(y) <= FLAT * np.abs(np.asarray(y).mean()):
        return "constant"
    tau = kendalltau(x, y).statistic  # NaN of a constant x
    return "rising" if tau > 0.0 else "falling" if tau < 0.0 else "none"


def judge_row(
    x: Sequence[float], paper: Sequence[float | None], ours: Sequence[float | None]
) -> dict[str, Any]:
    """Judge a row of numbers that belong to the increasing parameter x, all of one length.

    The verdict is on the entries that the paper has: of a single one, or over an x that is the
    same everywhere, there is no trend; of none it is ``–``. A number that we lack makes it ``not
    reproduced``.

    Returns:
        In JSON types: ``verdict``; ``ours_over_paper``, entry by entry, None where either is
        missing.
    """
    # A number that is missing, of the paper's or of ours, is NaN here.
    table = np.array([x, paper, ours], dtype=float)
    at, theirs, mine = table[:, ~np.isnan(table[1])]
    level = "not reproduced"
    if at.size == 0:
        level = "–"
    elif all(map(_within_factor, mine / theirs)):
        level = "reproduced"
    elif np.ptp(at) and not np.isnan(mine).any() and trend(at, mine) == trend(at, theirs):
        level = "same trend"
    return {
        "verdict": level,
        "ours_over_paper": plain(table[2] / table[1]),
    }


def judge_change(paper: float, ours: Estimate) -> dict[str, Any]:
    """Judge a relative change beside the paper's, as of the error by the filter: -0.1 is -10 %.

    It is ``reproduced`` if the interval lies on the paper's side of zero and the mean is within a
    factor 2, ``same trend`` if only the former, else ``not reproduced``. Returned as by
    `judge_row`.
    """
    ratio = ours.mean / paper
    level = "not reproduced"
    if abs(ours.mean) >= NEGLIGIBLE and ours.sign == np.sign(paper):
        level = "reproduced" if _within_factor(ratio) else "same trend"
    return {"verdict": level, "ours_over_paper": [ratio]}


def _within_factor(ratio: float) -> bool:
    return 1.0 / FACTOR <= ratio <= FACTOR
