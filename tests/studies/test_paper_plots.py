"""The paper's figures: all panels there, on one scale, the published numbers beside ours."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_paper import made_up_tables
from helpers_records import heart_record
from iiwa_dnn.results.record import Record
from iiwa_dnn.studies.paper_plots import PANELS, error_figure, tables_figure


@pytest.fixture(scope="module")
def records() -> dict[str, Record]:
    sizes = (2e-7, 8e-7, 3e-7, 1.2e-6)
    return {
        case: heart_record(2000, error=size, seed=i)
        for i, (case, size) in enumerate(zip(PANELS, sizes, strict=True))
    }


def test_the_four_cases_share_one_scale_and_unit(records: dict[str, Record]) -> None:
    figure = error_figure(records)
    panels = figure.axes
    assert len(panels) == 4
    assert {axes.get_ylim() for axes in panels} == {panels[0].get_ylim()}
    assert {axes.get_ylabel() for axes in panels} == {"Position error [µm]"}
    assert [axes.get_xlabel().split("\n")[1] for axes in panels] == [
        f"({letter}) {case}" for letter, case in zip("abcd", PANELS, strict=True)
    ]
    # The curve that is drawn is the case's own: its norm, which is the last line.
    for axes, case in zip(panels, PANELS, strict=True):
        error = np.linalg.norm(records[case].position - records[case].position_desired, axis=1)
        drawn = axes.lines[-1].get_ydata()
        assert float(np.max(drawn)) * 1e-6 == pytest.approx(error.max(), rel=0.05)


def test_panels_go_as_in_the_paper() -> None:
    assert PANELS == (
        "no noise, no filter", "noise, no filter", "no noise, filter", "noise, filter",
    )  # fmt: skip


def test_the_tables_figure_shows_the_papers_numbers_beside_ours() -> None:
    figure = tables_figure(made_up_tables())
    error, drift, change, substeps = figure.axes
    paper = next(line for line in error.lines if line.get_label() == "paper")
    np.testing.assert_array_equal(paper.get_ydata(), [7.25e-5, 5.59e-5, 6.5e-5, 4.06e-5, 7.88e-5,
                                                      4.24e-5, 1.75e-5])  # fmt: skip
    paper = next(line for line in drift.lines if line.get_label() == "paper")
    np.testing.assert_array_equal(paper.get_xdata(), [0.2, 0.4, 0.6])
    assert len(change.get_yticks()) == 6
    labels = substeps.get_legend_handles_labels()[1]
    assert labels == [
        "block, stable", "block, unstable", "so3, stable", "so3, unstable", "paper",
    ]  # fmt: skip


def test_a_change_far_off_is_named_at_the_edge() -> None:
    tables = made_up_tables()
    change = tables["table2"]["modes"]["converged, SO(3)"]["network"]["max_position_error_m"]
    change["changes"]["filter, with noise"] |= {"mean": 9.0, "low": 8.9, "high": 9.1}
    axes = tables_figure(tables).axes[2]
    assert "× 10 →" in [text.get_text() for text in axes.texts]
    assert max(axes.get_xlim()) < 100.0
