"""report.md of the paper's experiments: each number beside the paper's, with its verdict.

Works on the tables of `paper_tables`, in JSON types; nothing is computed here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from itertools import product
from typing import TYPE_CHECKING, Any

from iiwa_dnn.results.plots import COLUMN, draw_error, new_figure
from iiwa_dnn.results.record import Record
from iiwa_dnn.results.report import markdown_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Table = Mapping[str, Any]

_ROWS = {
    "max_position_error_m": "MAX E [m]",
    "mse_position_error_m2": "MSE [m²]",
    "joint_drift_rad": "MAX |q(T) − q(0)| [rad]",
    "max_kinetic_index_times_dt": "MAX q̇ᵀGq̇ · Δt",
    "max_orientation_error_rad": "MAX orientation error [rad]",
    "max_kkt_residual": "MAX KKT residual",
}
_MEASURES = {"max_position_error_m": "MAX E", "mse_position_error_m2": "MSE"}
_LIMITS = """\
- The paper gives neither the heart's scale nor its period. The scale here, 3.45 mm, is inferred
  from its kinetic index, read as multiplied by Δt: agreement with that row is by construction
  (erratum 8), and errors compare in magnitude only.
- It gives neither velocity limits nor κ; here the data sheet's and 20 1/s.
- It names no integrator for the network. Here explicit Euler, in as many sub-steps as are computed
  to be stable, the state carried from step to step; `--identify` tries others.
- Its noise amplitude 0.01 has no unit: taken as the standard deviation, in rad/s on the commanded
  velocity or on the network's x, in rad on the measured angle.
- MAX E: its text contradicts the table's trend over ξ (erratum 12), and Table II prints 6.70e-5 m
  for the run that has 5.59e-5 m in Table I, ξ = 0.2 (erratum 7).
- Four cells of its drift row cannot be read; verdicts are on the other three. A network whose steps
  are stable stays far below them (erratum 13), unless a joint limit is active (`--identify`).
- Fewer explicit sub-steps than 8 (block) or 4 (SO(3)) are not stable along the whole heart. Such
  runs are chaotic: their digits depend on the last bit of every sum, and so on the versions and the
  machine.
- A verdict: *reproduced* if all numbers are within a factor 2 of the paper's, else *same trend* if
  Kendall's tau over ξ has the paper's sign, else *not reproduced*. The four cases of Table II have
  no order, and so no trend. A change (filter, noise) is of the same trend if its interval lies on
  the paper's side of zero, and it is 0.1 % at least. See docs/paper.md and docs/errata.md."""


def report(tables: Mapping[str, Table], head: Mapping[str, str], figures: Iterable[str]) -> str:
    """Write the available tables in Markdown.

    Args:
        tables: Tables by their names in `paper_tables.EXPERIMENTS`.
        head: Date, machine, versions and sizes by name.
        figures: Names of PNG files.
    """
    parts = [
        "# The paper's experiments, run again",
        markdown_table(("", "value"), head.items()),
        *summary(tables),
        "## What limits the comparison",
        _LIMITS,
        *(part for name, table in tables.items() for part in _SECTIONS[name](table)),
        *(f"![The paper's {name}]({name})" for name in figures),
    ]
    return "\n\n".join(parts) + "\n"


def summary(tables: Mapping[str, Table]) -> list[str]:
    """Lay out the verdicts: a row for each row of the paper's tables, a column for each variant."""
    found: dict[str, dict[str, str]] = {}
    for name, variant in tables.get("table1", {"variants": {}})["variants"].items():
        for key, judged in variant["verdicts"].items():
            found.setdefault(f"Table I, {_ROWS[key]}", {})[name] = judged["verdict"]
    for name, entries in tables.get("table2", {"modes": {}})["modes"].items():
        for (entry, measures), (key, label) in product(entries.items(), _MEASURES.items()):
            where = f"{label}, noise at {entry}"
            verdict = measures[key]["verdict"]["verdict"]
            found.setdefault(f"Table II, {where}", {})[name] = verdict
            for change, effect in measures[key]["changes"].items():
                verdict = effect["verdict"]
                found.setdefault(f"effect of {change}, on {where}", {})[name] = verdict
    variant_names = list(
        dict.fromkeys(variant_name for verdicts in found.values() for variant_name in verdicts)
    )
    rows = [
        [title, *(verdicts.get(variant_name, "–") for variant_name in variant_names)]
        for title, verdicts in found.items()
    ]
    return ["## Verdicts", markdown_table(("the paper's", *variant_names), rows)] if found else []


def _table1(table: Table) -> list[str]:
    """Lay out Table I: the paper's rows, then each variant's."""
    head = ("", *(f"ξ = {weight:g}" for weight in table["weights"]))
    rows = [[_ROWS[key], *map(short, values)] for key, values in table["paper"].items()]
    parts = ["## Table I: weights, without noise", "### The paper's", markdown_table(head, rows)]
    for name, variant in table["variants"].items():
        rows = []
        for key, label in _ROWS.items():
            rows.append([label, *map(short, variant["rows"][key])])
            if key in variant["verdicts"]:
                ratios = variant["verdicts"][key]["ours_over_paper"]
                rows.append(["ours / paper's", *map(short, ratios)])
        parts += [f"### {name}", markdown_table(head, rows)]
    return parts


def _laps(table: Table) -> list[str]:
    """Lay out the drift after each lap."""
    laps = range(1, 1 + max(map(len, table.values())))
    head = ("MAX |q − q(0)| [rad] after lap", *map(str, laps))
    rows = [[name, *map(short, drifts)] for name, drifts in table.items()]
    return ["## Drift over laps", markdown_table(head, rows)]


def _table2(table: Table) -> list[str]:
    """Lay out Table II for each mode and entry of the noise."""
    ours = ("ours", "ours / paper's")
    head = ("case", "MAX E [m], paper", *ours, "MSE [m²], paper", *ours)
    parts = ["## Table II: noise and filter"]
    for mode, entries in table["modes"].items():
        for entry, measures in entries.items():
            rows = [[case] for case in table["cases"]]
            effects = []
            for key, label in _MEASURES.items():
                ratios = measures[key]["verdict"]["ours_over_paper"]
                columns = zip(table["paper"][key], measures[key]["cases"], ratios, strict=True)
                for row, (paper, case, ratio) in zip(rows, columns, strict=True):
                    row += [short(paper), _interval(case), short(ratio)]
                for change, effect in measures[key]["changes"].items():
                    paper = f"{100.0 * table['paper_changes'][key][change]:+.1f} %"
                    effects.append([label, change, paper, _change(effect)])
            parts += [
                f"### {mode}; noise at {entry}",
                markdown_table(head, rows),
                markdown_table(("", "effect of", "paper", "ours [95 %]: verdict"), effects),
            ]
    return parts


_SECTIONS: dict[str, Callable[[Table], list[str]]] = {
    "table1": _table1,
    "laps": _laps,
    "table2": _table2,
}


def _change(change: Mapping[str, Any]) -> str:
    """Format a relative change in per cent, with its interval, and its verdict."""
    mean, low, high = (100.0 * change[key] for key in ("mean", "low", "high"))
    interval = f" [{low:+.2f}, {high:+.2f}]" if change["samples"] > 1 else ""
    return f"{mean:+.2f} %{interval}: {change['verdict']}"


def _interval(estimate: Mapping[str, Any]) -> str:
    """Format a mean with the ends of its interval; an exact value alone."""
    if estimate["samples"] == 1:
        return short(estimate["mean"])
    return f"{estimate['mean']:.4g} [{estimate['low']:.4g}, {estimate['high']:.4g}]"


def short(value: float | None) -> str:
    """Format a number by three digits, or one that is missing."""
    return "–" if value is None else f"{value:.3g}"


def error_figure(records: Mapping[str, Record]) -> Figure:
    """Draw the position error of the four cases on one scale: the paper's Fig. 2 (a)-(d)."""
    figure = new_figure(2 * COLUMN, 5.0)
    panels = zip(figure.subplots(2, 2, sharey=True).flat, "abcd", records.items(), strict=True)
    for axes, letter, (case, record) in panels:
        draw_error(axes, record)
        axes.set_xlabel(f"{axes.get_xlabel()}\n({letter}) {case}")
    return figure
