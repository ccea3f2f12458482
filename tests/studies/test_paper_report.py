"""The report says what the tables say: numbers, verdicts, and sentences made from them."""

from __future__ import annotations

from typing import Any

import pytest

from helpers_paper import made_up_tables
from iiwa_dnn.studies.paper_report import findings, write_paper_report


@pytest.fixture(scope="module")
def tables() -> dict[str, dict[str, Any]]:
    return made_up_tables()


@pytest.fixture(scope="module")
def report(tables: dict[str, Any], tmp_path_factory: pytest.TempPathFactory) -> str:
    folder = tmp_path_factory.mktemp("report")
    figures = [folder / name for name in ("fig1.png", "fig1.pdf", "tables.png")]
    path = write_paper_report(folder, tables, {"date": "today", "machine": "a|b"}, figures)
    assert path == folder / "report.md"
    return path.read_text(encoding="utf-8")


def rows(report: str, start: str) -> list[list[str]]:
    """The cells of every line that starts with this first cell."""
    lines = [line for line in report.splitlines() if line.startswith(f"| {start}")]
    return [[cell.strip() for cell in line.strip("|").split(" | ")] for line in lines]


def test_the_head_says_when_and_on_what(report: str) -> None:
    assert "| date | today |" in report
    assert "| machine | a\\|b |" in report


def test_verdicts_stand_in_one_table(report: str) -> None:
    (found,) = rows(report, "Table I, MAX E")
    assert found[1:] == ["reproduced"] * 4
    (found,) = rows(report, "Table I, MAX q̇ᵀGq̇ |")
    assert found[1:] == ["same trend"] * 4
    (found,) = rows(report, "effect of filter, with noise, on MSE, noise at velocity")
    assert found[1:] == ["same trend", "same trend", "–", "–"]
    (found,) = rows(report, "effect of filter, with noise, on MSE, noise at network")
    assert found[1:3] == ["not reproduced"] * 2


def test_numbers_stand_beside_the_papers(report: str) -> None:
    assert rows(report, "paper: MAX E")[0][1:] == [
        "7.25e-05", "5.59e-05", "6.5e-05", "4.06e-05", "7.88e-05", "4.24e-05", "1.75e-05",
    ]  # fmt: skip
    drift = rows(report, "paper: MAX \\|q(T) − q(0)\\|")[0]
    assert drift[1:4] == ["–", "0.0174", "0.0388"]
    ratios = rows(report, "ours / paper's")[0]
    assert ratios[1:] == ["1"] * 7
    case = rows(report, "no noise, filter")[0]
    assert case[1:] == ["6.47e-05", "1.4e-05", "0.216", "1.97e-10", "1.96e-10", "0.995"]


def test_every_combination_of_the_ablation_has_a_line(report: str) -> None:
    assert len(rows(report, "block | ")) == len(rows(report, "so3 | ")) == 28
    assert rows(report, "block | none | 2 |")[0][3] == "no"
    assert rows(report, "so3 | none | implicit |")[0][3] == "yes"


def test_only_pictures_are_shown(report: str) -> None:
    assert "](fig1.png)" in report
    assert "](tables.png)" in report
    assert ".pdf" not in report


def test_findings_are_made_from_the_numbers(tables: dict[str, Any]) -> None:
    said = "\n".join(findings(tables))
    assert "drift over ξ rising (paper: rising), 1 to 1 times the paper's" in said
    told = "MAX E over ξ falling but at 2 of 6 steps (paper: falling but at 2 of 6 steps)"
    assert f"Table I, continuous, block: {told}" in said
    # Both modes and both measures: lowered at velocity, raised at network, neither at measurement.
    assert (
        "in 12 comparisons over 40 seeds: lowered in 4, raised in 4, no effect shown in 4" in said
    )
    assert (
        "2 explicit sub-steps, block, noise at none, 0.017 rad; this choice is not stable" in said
    )
    assert "a sub-step multiplies errors by 3.00" in said


def test_a_stable_choice_is_called_so(tables: dict[str, Any]) -> None:
    stable = tables["ablation"]["closest_stable"]
    changed = tables | {"ablation": tables["ablation"] | {"closest_to_the_papers_drift": stable}}
    assert "this choice is stable" in findings(changed)[-1]
