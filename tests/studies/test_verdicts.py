"""Verdicts are computed: each level is reached by numbers that deserve it, and by no others."""

from __future__ import annotations

import pytest

from iiwa_dnn.studies.statistics import Estimate
from iiwa_dnn.studies.verdicts import judge_change, judge_row

X = (0.1, 0.2, 0.3)


@pytest.mark.parametrize(
    ("ours", "level"),
    [
        ((1.0, 2.0, 4.0), "reproduced"),
        ((2.0, 1.0, 8.0), "reproduced"),  # on the edges, and in another order
        ((2.1, 4.2, 8.4), "same trend"),
        ((1.0, 2.0, 8.1), "same trend"),
        ((1.0, 0.5, 0.1), "not reproduced"),
        ((3.0, 3.01, 3.02), "not reproduced"),
        ((1.0, None, 4.0), "not reproduced"),
    ],
)
def test_rows(ours: tuple[float | None, ...], level: str) -> None:
    assert judge_row(X, (1.0, 2.0, 4.0), ours)["verdict"] == level


def test_a_row_is_judged_where_the_paper_has_numbers() -> None:
    verdict = judge_row(X, (1.0, None, 3.0), (1.1, 1e9, 3.3))
    assert verdict["verdict"] == "reproduced"
    assert verdict["ours_over_paper"] == pytest.approx([1.1, None, 1.1])
    assert (verdict["our_trend"], verdict["paper_trend"]) == ("rising", "rising")
    assert judge_row(X, (1.0, None, 3.0), (1.1, None, 3.3))["verdict"] == "reproduced"


def test_a_constant_row_wants_a_constant_row() -> None:
    assert judge_row(X, (4.54,) * 3, (454.0, 455.0, 453.0))["verdict"] == "same trend"
    assert judge_row(X, (4.54,) * 3, (454.0, 500.0, 600.0))["verdict"] == "not reproduced"


@pytest.mark.parametrize(
    ("mean", "half_width", "level", "way"),
    [
        (-0.10, 0.01, "reproduced", "lowers"),
        (-0.19, 0.01, "reproduced", "lowers"),
        (-0.30, 0.01, "same trend", "lowers"),
        (-0.04, 0.01, "same trend", "lowers"),
        (-0.10, 0.11, "not reproduced", "no effect shown"),
        (+0.10, 0.01, "not reproduced", "raises"),
        (-0.0005, 0.0, "not reproduced", "no effect shown"),
    ],
)
def test_changes(mean: float, half_width: float, level: str, way: str) -> None:
    verdict = judge_change(-0.10, Estimate(mean, half_width, 100))
    found = (verdict["verdict"], verdict["our_trend"], verdict["paper_trend"])
    assert found == (level, way, "lowers")


def test_a_verdict_in_json() -> None:
    found = judge_row(X, (1.0, 2.0, 4.0), (1.0, 2.0, 2.0))
    assert found == {
        "verdict": "reproduced",
        "ours_over_paper": [1.0, 1.0, 0.5],
        "our_trend": "rising",
        "paper_trend": "rising",
    }
