"""The paper's figures 1 and 2 out of records, and one that sums up its tables.

The tables are those of `table1`, `table2` and `ablation`, in JSON types; nothing is computed here.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from iiwa_dnn.results.metrics import position_error
from iiwa_dnn.results.plots import (
    DOUBLE_COLUMN,
    draw_error,
    legend_above,
    new_figure,
    overview_figure,
    write_figures,
)
from iiwa_dnn.results.record import Record

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PANELS = ("no noise, no filter", "noise, no filter", "no noise, filter", "noise, filter")
"""The paper's Fig. 2 (a)-(d); its text and Table II go through them in another order."""

FAR = 100.0
"""A change by more than this [%] is named at the edge and not drawn to scale."""

_STYLES = (("o", "-", "0.0"), ("s", "--", "0.5"))  # marker, line and color of two curves

Table = Mapping[str, Any]


def save_paper_figures(
    fig1: Record,
    fig2: Mapping[str, Record],
    tables: Mapping[str, Table],
    folder: str | os.PathLike[str],
) -> list[Path]:
    """Draw ``fig1``, ``fig2`` (of runs by `PANELS`) and ``tables`` as `write_figures` does."""
    figures = {
        "fig1": partial(overview_figure, fig1),
        "fig2": partial(error_figure, fig2),
        "tables": partial(tables_figure, tables),
    }
    return write_figures(figures, folder)


def error_figure(records: Mapping[str, Record]) -> Figure:
    """Draw the position error of the four cases on one scale: the paper's Fig. 2 (a)-(d)."""
    figure = new_figure(DOUBLE_COLUMN, 5.0)
    largest = max(float(np.linalg.norm(position_error(r), axis=1).max()) for r in records.values())
    for axes, letter, case in zip(figure.subplots(2, 2).flat, "abcd", PANELS, strict=True):
        draw_error(axes, records[case], largest)
        axes.set_xlabel(f"{axes.get_xlabel()}\n({letter}) {case}")
    return figure


def tables_figure(tables: Mapping[str, Table]) -> Figure:
    """Draw error and drift over the weight, the filter's effect, and the drift over sub-steps."""
    figure = new_figure(DOUBLE_COLUMN, 5.4)
    panels = figure.subplots(2, 2).ravel()
    _draw_row(panels[0], tables["table1"], "max_position_error_m", "Largest position error [m]")
    _draw_row(panels[1], tables["table1"], "joint_drift_rad", "Joint drift [rad]")
    _draw_filter(panels[2], tables["table2"])
    _draw_substeps(panels[3], tables["ablation"])
    for axes, letter, columns in zip(panels, "abcd", (3, 3, 2, 3), strict=True):
        axes.set_xlabel(f"{axes.get_xlabel()}\n({letter})")
        legend_above(axes, columns)
    return figure


def _draw_row(axes: Axes, table: Table, key: str, label: str) -> None:
    """Draw one row of Table I over the weight, the paper's and those with G = I."""
    ours = [name for name in table["variants"] if "inertia" not in name]
    rows = [("paper", table["paper"][key], "x", ":", "0.0")]
    rows += [
        (name, table["variants"][name]["rows"][key], *style)
        for name, style in zip(ours, _STYLES, strict=False)
    ]
    for name, values, marker, line, color in rows:
        known = [pair for pair in zip(table["weights"], values, strict=True) if pair[1] is not None]
        _draw_points(axes, known, marker=marker, linestyle=line, color=color, label=name)
    axes.set_yscale("log")
    axes.set_xlabel("Weight ξ")
    axes.set_ylabel(label)


def _draw_points(axes: Axes, points: Sequence[tuple[Any, Any]], **style: Any) -> None:
    axes.plot([x for x, _ in points], [y for _, y in points], **style)


def _draw_filter(axes: Axes, table: Table) -> None:
    """Draw the filter's effect under noise, in per cent, with its interval; and the paper's."""
    measures = (("max_position_error_m", "MAX E", -0.14), ("mse_position_error_m2", "MSE", 0.14))
    names = [(mode, entry) for mode, entries in table["modes"].items() for entry in entries]
    for (key, label, offset), (marker, _, color) in zip(measures, _STYLES, strict=True):
        for row, (mode, entry) in enumerate(names):
            change = table["modes"][mode][entry][key]["changes"]["filter, with noise"]
            at = row + offset
            mean = 100.0 * change["mean"]
            if mean > FAR:  # one far off would hide the others
                edge = axes.get_yaxis_transform()
                text = axes.text(0.98, at, f"× {1.0 + change['mean']:.3g} →", transform=edge)
                text.set(ha="right", va="center", fontsize=7, color=color)
                continue
            interval = [[mean - 100.0 * change["low"]], [100.0 * change["high"] - mean]]
            axes.errorbar([mean], [at], xerr=interval, fmt=marker, color=color, capsize=2)
        paper = 100.0 * table["paper_changes"][key]["filter, with noise"]
        axes.axvline(paper, color=color, linestyle=":", label=f"{label}, paper")
        axes.plot([], [], linestyle="", marker=marker, color=color, label=label)
    axes.axvline(0.0, color="0.0", linewidth=0.6)
    # By their first words, to leave room for the data.
    axes.set_yticks(range(len(names)), [f"{mode.split(',')[0]},\n{entry}" for mode, entry in names])
    axes.set_ylim(len(names) - 0.5, -0.5)
    axes.set_xlabel("Change by the filter [%]")
    low, high = axes.get_xlim()
    axes.set_xlim(low, high + 0.25 * (high - low))  # room beside the zero line for those far off


def _draw_substeps(axes: Axes, table: Table) -> None:
    """Draw the drift without noise over the sub-steps; hollow where a sub-step is unstable."""
    names = list(dict.fromkeys(str(row["substeps"]) for row in table["rows"]))
    for orientation, (marker, line, color) in zip(("block", "so3"), _STYLES, strict=True):
        points = [
            ((names.index(str(row["substeps"])), row["joint_drift_rad"]), row["stable"])
            for row in table["rows"]
            if row["orientation"] == orientation and row["noise_at"] == "none"
        ]
        known = [point for point, _ in points if point[1] is not None]
        _draw_points(axes, known, linestyle=line, color=color, label="")
        for stable, face in ((True, color), (False, "1.0")):
            part = [point for point, is_stable in points if is_stable is stable]
            label = f"{orientation}, {'stable' if stable else 'unstable'}"
            style = {"marker": marker, "color": color, "markerfacecolor": face, "label": label}
            _draw_points(axes, part, linestyle="", **style)
    axes.axhline(table["paper"]["joint_drift_rad"], color="0.0", linestyle=":", label="paper")
    axes.set_yscale("log")
    axes.set_xticks(range(len(names)), names)
    axes.set_xlabel("Sub-steps in a control step")
    axes.set_ylabel("Joint drift [rad]")
