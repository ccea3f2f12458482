"""Intervals, paired differences, trends and verdicts, on numbers whose answer is known."""

import numpy as np
import pytest
from scipy.stats import ttest_rel

from iiwa_dnn.studies.statistics import (
    Estimate,
    judge_change,
    judge_row,
    paired_difference,
    trend,
)


def test_a_paired_difference_sees_what_the_shared_noise_hides() -> None:
    rng = np.random.default_rng(1)
    shared = rng.normal(0.0, 1.0, 50)
    before = shared + rng.normal(0.0, 0.01, 50)
    after = shared - 0.05 + rng.normal(0.0, 0.01, 50)
    paired = paired_difference(after, before)
    assert paired.sign == -1
    assert paired.low < -0.05 < paired.high
    # An independent word on it: scipy's paired t-test and its interval.
    other = ttest_rel(after, before).confidence_interval(0.95)
    np.testing.assert_allclose([paired.low, paired.high], other, rtol=1e-12)


def test_a_trend_is_the_sign_of_the_pairs_in_order_minus_those_out_of_order() -> None:
    rng = np.random.default_rng(2)
    first, second = np.triu_indices(6, 1)
    seen = set()
    for _ in range(200):
        x, y = np.sort(rng.normal(size=6)), rng.integers(0, 4, 6)  # with ties
        order = int(np.sign(y[second] - y[first]).sum())
        expected = ("falling", "none", "rising")[np.sign(order) + 1]
        if np.ptp(y):
            assert trend(x, y) == expected
            seen.add(expected)
    assert seen == {"falling", "none", "rising"}
    assert trend(range(3), (1.00, 1.01, 1.04)) == "constant"
    # The rows of the paper's Table I.
    assert trend(range(7), (7.25, 5.59, 6.50, 4.06, 7.88, 4.24, 1.75)) == "falling"


X = (0.1, 0.2, 0.3)


@pytest.mark.parametrize(
    ("ours", "level"),
    [
        ((1.0, 2.0, 4.0), "reproduced"),
        ((2.0, 1.0, 8.0), "reproduced"),  # on the edges, and in another order
        ((2.1, 4.2, 8.4), "same trend"),
        ((1.0, 0.5, 0.1), "not reproduced"),
        ((3.0, 3.01, 3.02), "not reproduced"),
        ((1.0, None, 4.0), "not reproduced"),
    ],
)
def test_verdicts_on_rows(ours: tuple[float | None, ...], level: str) -> None:
    assert judge_row(X, (1.0, 2.0, 4.0), ours)["verdict"] == level


def test_a_row_is_judged_where_the_paper_has_numbers() -> None:
    verdict = judge_row(X, (1.0, None, 3.0), (1.1, 1e9, 3.3))
    assert verdict["verdict"] == "reproduced"
    assert verdict["ours_over_paper"] == pytest.approx([1.1, None, 1.1])
    assert judge_row(X, (1.0, None, 3.0), (1.1, None, 3.3))["verdict"] == "reproduced"
    # A single number has no trend, and without one of the paper's there is nothing to judge.
    assert judge_row([0.1], [1.0], [1.9])["verdict"] == "reproduced"
    assert judge_row([0.1], [1.0], [3.0])["verdict"] == "not reproduced"
    assert judge_row([0.1], [None], [3.0])["verdict"] == "–"
    # The cases of Table II have no order, by which noise alone would make a trend.
    assert judge_row([0] * 3, [1.0, 2.0, 4.0], [3.0, 6.0, 9.0])["verdict"] == "not reproduced"
    # A constant row wants a constant row.
    assert judge_row(X, (4.54,) * 3, (454.0, 455.0, 453.0))["verdict"] == "same trend"
    assert judge_row(X, (4.54,) * 3, (454.0, 500.0, 600.0))["verdict"] == "not reproduced"


@pytest.mark.parametrize(
    ("mean", "half_width", "level"),
    [
        (-0.10, 0.01, "reproduced"),
        (-0.30, 0.01, "same trend"),
        (-0.04, 0.01, "same trend"),
        (-0.10, 0.11, "not reproduced"),
        (+0.10, 0.01, "not reproduced"),
        (-0.0005, 0.0, "not reproduced"),
    ],
)
def test_verdicts_on_changes(mean: float, half_width: float, level: str) -> None:
    assert judge_change(-0.10, Estimate(mean, half_width, 100))["verdict"] == level
