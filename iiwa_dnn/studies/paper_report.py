"""report.md of the paper's experiments: each number beside the paper's, with its verdict.

Works on the tables that `iiwa_dnn.studies` makes, in JSON types; nothing is computed here, and
every sentence that says how an experiment came out is put together from a table's verdicts.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from iiwa_dnn.files import write_text
from iiwa_dnn.results.report import markdown_table
from iiwa_dnn.studies.paper_findings import MEASURES, change_in_words, findings, short

Table = Mapping[str, Any]

_ROWS = {
    "max_position_error_m": "MAX E [m]",
    "mse_position_error_m2": "MSE [m²]",
    "joint_drift_rad": "MAX |q(T) − q(0)| [rad]",
    "max_kinetic_index": "MAX q̇ᵀGq̇",
    "max_kinetic_index_times_dt": "MAX q̇ᵀGq̇ · Δt",
    "max_orientation_error_rad": "MAX orientation error [rad]",
    "total_variation_rad_s": "total variation of q̇ [rad/s]",
    "max_kkt_residual": "MAX KKT residual",
}
_TABLE2_HEAD = (
    "case", "MAX E [m], paper", "ours", "ours / paper's",
    "MSE [m²], paper", "ours", "ours / paper's",
)  # fmt: skip
_CAPTIONS = {
    "fig1": "The paper's Fig. 1: path, joint angles, joint velocities and position error, with "
    "noise and filter.",
    "fig2": "The paper's Fig. 2: position error in the four cases of Table II, on one scale.",
    "tables": "Error and drift over ξ; what the filter changes, with 95 % intervals; drift over "
    "the number of sub-steps, hollow where a sub-step magnifies errors.",
}
_LIMITS = """\
- The paper gives neither the heart's scale nor its period. The scale here, 3.45 mm, is inferred
  from its kinetic index, read as multiplied by Δt: agreement with that row is by construction.
- It gives neither velocity limits nor κ; here the data sheet's and 20 1/s.
- It names no integrator for the network. Here explicit Euler, in as many sub-steps as are computed
  to be stable, the state carried from step to step; the ablation tries others.
- Its noise amplitude 0.01 has no unit: taken as the standard deviation, in rad/s on the commanded
  velocity or on the network's x, in rad on the measured angle.
- Rows of the ablation that are not stable are chaotic: their digits depend on the last bit of every
  sum, and so on the versions and the machine.
- Four cells of its drift row cannot be read; verdicts are on the other three.
- A verdict: *reproduced* if all numbers are within a factor 2 of the paper's, else *same trend* if
  they go the same way, else *not reproduced*. A change (filter, noise) must also have an interval
  that leaves zero out, and be of 0.1 % at least."""


def write_paper_report(
    folder: str | os.PathLike[str],
    tables: Mapping[str, Table],
    head: Mapping[str, str],
    figures: Iterable[Path] = (),
) -> Path:
    """Write report.md.

    Args:
        folder: Where to; it must exist.
        tables: ``table1``, ``table2`` and ``ablation``.
        head: What, when and on what it was run, by names.
        figures: The figures' files in that folder; the PNG ones are shown.

    Returns:
        The file written.

    Raises:
        FileError: If it cannot be written.
    """
    table1, table2, ablation = (tables[name] for name in ("table1", "table2", "ablation"))
    parts = [
        "# The paper's experiments, run again",
        markdown_table(("what", "value"), list(head.items())),
        "## Verdicts",
        markdown_table(("the paper's", *_variants(table1, table2)), _verdicts(table1, table2)),
        "\n".join(f"- {line}" for line in findings(tables)),
        "## What limits the comparison",
        _LIMITS,
        "## Table I: weights, without noise",
        *_table1(table1),
        "## Drift over laps",
        _laps(table1),
        "## Table II: noise and filter",
        *_table2(table2),
        "## Ablation: what the paper leaves out",
        _ablation(ablation),
    ]
    shown = [path for path in figures if path.suffix == ".png"]
    if shown:
        parts.append("## Figures")
        parts += [f"![{_CAPTIONS.get(path.stem, path.stem)}]({path.name})" for path in shown]
    path = Path(folder) / "report.md"
    write_text(path, "\n\n".join(parts) + "\n")
    return path


def _variants(table1: Table, table2: Table) -> list[str]:
    return list(dict.fromkeys([*table1["variants"], *table2["modes"]]))


def _verdicts(table1: Table, table2: Table) -> list[list[str]]:
    """A line for each row of the paper's tables, a column for each way to run them."""
    names = _variants(table1, table2)
    rows = []
    for key in ("max_position_error_m", "joint_drift_rad", "max_kinetic_index",
                "max_kinetic_index_times_dt"):  # fmt: skip
        cells = [_of(table1["variants"].get(name), "verdicts", key, "verdict") for name in names]
        rows.append([f"Table I, {_ROWS[key]}", *cells])
    entries = next(iter(table2["modes"].values()))
    for entry in entries:
        for key, label in MEASURES.items():
            cells = [
                _of(table2["modes"].get(name), entry, key, "verdict", "verdict") for name in names
            ]
            rows.append([f"Table II, {label}, noise at {entry}", *cells])
            for change in table2["paper_changes"][key]:
                path = (entry, key, "changes", change, "verdict")
                cells = [_of(table2["modes"].get(name), *path) for name in names]
                rows.append([f"effect of {change}, on {label}, noise at {entry}", *cells])
    return rows


def _of(table: Any, *path: str) -> str:
    """What stands at a path in nested tables; a dash where there is none."""
    for key in path:
        if table is None:
            break
        table = table[key]
    return "–" if table is None else str(table)


def _table1(table: Table) -> list[str]:
    head = ("", *(f"ξ = {weight:g}" for weight in table["weights"]))
    rows = [[f"paper: {_ROWS[key]}", *map(short, values)] for key, values in table["paper"].items()]
    parts = ["### The paper's", markdown_table(head, rows)]
    for name, variant in table["variants"].items():
        rows = []
        for key, label in _ROWS.items():
            rows.append([label, *map(short, variant["rows"][key])])
            if key in variant["verdicts"]:
                ratios = variant["verdicts"][key]["ours_over_paper"]
                rows.append(["ours / paper's", *map(short, ratios)])
        parts += [f"### {name}", markdown_table(head, rows)]
    return parts


def _laps(table: Table) -> str:
    laps = max(len(run["lap_drift_rad"]) for run in table["laps"].values())
    head = ("MAX |q − q(0)| [rad] after lap", *(str(lap + 1) for lap in range(laps)))
    rows = [[name, *map(short, run["lap_drift_rad"])] for name, run in table["laps"].items()]
    return markdown_table(head, rows)


def _table2(table: Table) -> list[str]:
    parts = []
    cases, changes = table["cases"], table["paper_changes"]
    for mode, entries in table["modes"].items():
        for entry, measures in entries.items():
            rows = [
                [case]
                + [
                    text
                    for key in MEASURES
                    for text in (
                        short(table["paper"][key][i]),
                        _interval(measures[key]["cases"][i]),
                        short(measures[key]["verdict"]["ours_over_paper"][i]),
                    )
                ]
                for i, case in enumerate(cases)
            ]
            parts += [f"### {mode}; noise at {entry}", markdown_table(_TABLE2_HEAD, rows)]
            rows = [
                [
                    MEASURES[key],
                    change,
                    f"{100.0 * changes[key][change]:+.1f} %",
                    change_in_words(ours),
                ]
                for key in MEASURES
                for change, ours in measures[key]["changes"].items()
            ]
            parts.append(markdown_table(("", "effect of", "paper", "ours [95 %]: verdict"), rows))
            pairs = ", ".join(
                f"{label} {_interval(measures[key]['difference'])}"
                for key, label in MEASURES.items()
            )
            said = f"Filter minus no filter, seed by seed: {pairs}."
            theory = measures["theory_noise_mse_m2"]
            if theory is not None and mode.startswith("converged"):
                quiet, noisy = (
                    measures["mse_position_error_m2"]["cases"][i]["mean"] for i in (0, 2)
                )
                said += (
                    f" MSE that noise adds without filter: {short(noisy - quiet)} m²; from "
                    f"σ²Δt/2δ, {short(theory)} m²."
                )
            parts.append(said)
    return parts


def _ablation(table: Table) -> str:
    columns = {
        "max_position_error_m": "MAX E [m]",
        "max_orientation_error_rad": "orientation error [rad]",
        "joint_drift_rad": "drift [rad]",
        "total_variation_rad_s": "total variation [rad/s]",
        "max_kinetic_index": "MAX q̇ᵀq̇ [rad²/s²]",
        "amplification": "growth of a sub-step",
    }
    head = ("orientation", "noise at", "sub-steps", "stable", *columns.values())
    rows = [
        [
            row["orientation"],
            row["noise_at"],
            str(row["substeps"]),
            "yes" if row["stable"] else "no",
            *(short(row[key]) for key in columns if key != "amplification"),
            "–" if row["amplification"] is None else f"{row['amplification']:.4f}",
        ]
        for row in table["rows"]
    ]
    return markdown_table(head, rows)


def _interval(estimate: Mapping[str, Any]) -> str:
    """A mean with the ends of its interval; an exact value alone."""
    if estimate["samples"] == 1:
        return short(estimate["mean"])
    return f"{estimate['mean']:.4g} [{estimate['low']:.4g}, {estimate['high']:.4g}]"
