"""report.md of the paper's experiments: each number beside the paper's, with its verdict.

Works on the tables of `table1`, `table2` and `ablation`, in JSON types; nothing is computed here,
and every sentence about an experiment's outcome is put together from a table's verdicts.
"""

import os
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from iiwa_dnn.results.markdown import bullets, markdown_table, number, save_markdown, show_figures

Table = Mapping[str, Any]

MEASURES = {"max_position_error_m": "MAX E", "mse_position_error_m2": "MSE"}
"""The paper's names of the two measures of its Table II."""

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
_JUDGED = (
    "max_position_error_m",
    "joint_drift_rad",
    "max_kinetic_index",
    "max_kinetic_index_times_dt",
)
_OURS = ("ours", "ours / paper's")
_TABLE2_HEAD = ("case", "MAX E [m], paper", *_OURS, "MSE [m²], paper", *_OURS)
_ABLATION = {
    "max_position_error_m": "MAX E [m]",
    "max_orientation_error_rad": "orientation error [rad]",
    "joint_drift_rad": "drift [rad]",
    "total_variation_rad_s": "total variation [rad/s]",
    "max_kinetic_index": "MAX q̇ᵀq̇ [rad²/s²]",
}
_CHANGES = {"lowers": "lowered", "raises": "raised", "no effect shown": "no effect shown"}
_FILTER = "filter, with noise"

short = partial(number, form=".3g", unknown="–")

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

_TRUST = """\
How far to trust the paper's (docs/paper.md, docs/errata.md):

- All: the scale and the period of its heart are not printed, so errors compare in magnitude only.
- MAX E: its text contradicts the table's trend over ξ (erratum 12), and Table II prints 6.70e-5 m
  for the run that has 5.59e-5 m here, ξ = 0.2 (erratum 7).
- Drift: four of seven cells cannot be read; a network whose steps are stable stays far below the
  others (erratum 13).
- q̇ᵀGq̇ · Δt: no evidence, for the heart's scale was inferred from this row (erratum 8)."""


def write_paper_report(
    folder: str | os.PathLike[str],
    tables: Mapping[str, Table],
    head: Mapping[str, str],
    figures: Iterable[Path] = (),
) -> Path:
    """Write report.md into a folder that exists, and return the file.

    It begins with `head` (date, machine, versions by names) and shows the PNG files of `figures`;
    the tables are ``table1``, ``table2`` and ``ablation``. Raises FileError if it cannot.
    """
    table1 = tables["table1"]
    table2 = tables["table2"]
    names = list(dict.fromkeys([*table1["variants"], *table2["modes"]]))
    parts = [
        "# The paper's experiments, run again",
        markdown_table(("what", "value"), list(head.items())),
        "## Verdicts",
        markdown_table(("the paper's", *names), _verdicts(table1, table2, names)),
        bullets(findings(tables)),
        "## What limits the comparison",
        _LIMITS,
        "## Table I: weights, without noise",
        *_table1(table1),
        "## Drift over laps",
        _laps(table1),
        "## Table II: noise and filter",
        *_table2(table2),
        "## Ablation: what the paper leaves out",
        _ablation(tables["ablation"]),
        *show_figures(figures, _CAPTIONS),
    ]
    return save_markdown(folder, parts)


def column_report(table: Table) -> str:
    """Put the runs of one weight beside that column of the paper's Table I, and how to take it."""
    head = (f"ξ = {table['weight']:g}", "paper", *table["variants"])
    rows = []
    for key in _JUDGED:
        printed = table["paper"][key]
        row = [_ROWS[key], short(printed)]
        for values in table["variants"].values():
            ours = values[key]
            known = printed is not None and ours is not None
            row.append(short(ours) + (f" ({short(ours / printed)} times)" if known else ""))
        rows.append(row)
    return f"{markdown_table(head, rows)}\n\n{_TRUST}"


def findings(tables: Mapping[str, Table]) -> list[str]:
    """Put the outcome in sentences made from the tables' numbers and verdicts."""
    table1, table2, ablation = (tables[name] for name in ("table1", "table2", "ablation"))
    lines = []
    for name, variant in table1["variants"].items():
        said = []
        for key, label in (("max_position_error_m", "MAX E"), ("joint_drift_rad", "drift")):
            verdict = variant["verdicts"][key]
            known = [ratio for ratio in verdict["ours_over_paper"] if ratio is not None]
            ratios = f"{short(min(known))} to {short(max(known))}" if known else "–"
            trends = f"over ξ {verdict['our_trend']} (paper: {verdict['paper_trend']})"
            said.append(f"{label} {trends}, {ratios} times the paper's")
        lines.append(f"Table I, {name}: {'; '.join(said)}.")
    for mode, entries in table2["modes"].items():
        for entry, measures in entries.items():
            said = [
                f"{label} {_change(measures[key]['changes'][_FILTER])}"
                for key, label in MEASURES.items()
            ]
            lines.append(f"Filter under noise at {entry}, {mode}: {', '.join(said)}.")
    closest = ablation["closest_to_the_papers_drift"]
    stable = ablation["closest_stable"]
    growth = closest["amplification"]
    grows = f"a sub-step multiplies errors by {growth or 0.0:.2f}"
    return [
        *lines,
        _claim(table2),
        f"Closest to the paper's drift of {short(ablation['paper']['joint_drift_rad'])} rad: "
        f"{_choice(closest)}, {short(closest['joint_drift_rad'])} rad; this choice is "
        f"{'stable' if closest['stable'] else 'not stable'}: "
        f"{'implicit steps damp' if growth is None else grows}, MAX E "
        f"{short(closest['max_position_error_m'])} m. The closest stable one: {_choice(stable)}, "
        f"{short(stable['joint_drift_rad'])} rad.",
    ]


def _claim(table: Table) -> str:
    """Judge the claim that the filter helps by all comparisons of Table II together."""
    found = [
        measures[key]["changes"][_FILTER]
        for entries in table["modes"].values()
        for measures in entries.values()
        for key in MEASURES
    ]
    counts = {trend: sum(change["our_trend"] == trend for change in found) for trend in _CHANGES}
    said = ", ".join(f"{word} in {counts[trend]}" for trend, word in _CHANGES.items())
    best = 100.0 * max(-min(change["mean"] for change in found), 0.0)
    papers = [changes[_FILTER] for changes in table["paper_changes"].values()]
    return (
        f"The paper's claim that the filter lowers the error under noise, in {len(found)} "
        f"comparisons over {table['scope']['seeds']} seeds: {said}; the most it took off a mean is "
        f"{best:.2f} %, against {-100.0 * min(papers):.1f} % in the paper."
    )


def _change(change: Mapping[str, Any]) -> str:
    """Put a relative change in words and per cent."""
    mean, low, high = (change[key] for key in ("mean", "low", "high"))
    if mean > 1.0:  # a percentage of thousands says less than a factor
        size = f"× {1.0 + mean:.3g}"
    else:
        size = f"{100.0 * mean:+.2f} %"
        if change["samples"] > 1:
            size += f" [{100.0 * low:+.2f}, {100.0 * high:+.2f}]"
    return f"{_CHANGES[change['our_trend']]}, {size}: {change['verdict']}"


def _choice(row: Mapping[str, Any]) -> str:
    steps = "implicit" if row["substeps"] == "implicit" else f"{row['substeps']} explicit sub-steps"
    return f"{steps}, {row['orientation']}, noise at {row['noise_at']}"


def _verdicts(table1: Table, table2: Table, names: Sequence[str]) -> list[list[str]]:
    """Lay out a line for each row of the paper's tables, a column for each way to run them."""
    found: defaultdict[str, dict[str, str]] = defaultdict(dict)
    for name, variant in table1["variants"].items():
        for key in _JUDGED:
            found[f"Table I, {_ROWS[key]}"][name] = variant["verdicts"][key]["verdict"]
    for name, entries in table2["modes"].items():
        for entry, measures in entries.items():
            for key, label in MEASURES.items():
                where = f"{label}, noise at {entry}"
                found[f"Table II, {where}"][name] = measures[key]["verdict"]["verdict"]
                for change, effect in measures[key]["changes"].items():
                    found[f"effect of {change}, on {where}"][name] = effect["verdict"]
    return [
        [title, *(verdicts.get(name, "–") for name in names)] for title, verdicts in found.items()
    ]


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
    for mode, entries in table["modes"].items():
        for entry, measures in entries.items():
            rows = [[case] for case in table["cases"]]
            effects = []
            pairs = []
            for key, label in MEASURES.items():
                ours = measures[key]
                ratios = ours["verdict"]["ours_over_paper"]
                columns = zip(table["paper"][key], ours["cases"], ratios, strict=True)
                for row, (paper, case, ratio) in zip(rows, columns, strict=True):
                    row += [short(paper), _interval(case), short(ratio)]
                for change, effect in ours["changes"].items():
                    paper = f"{100.0 * table['paper_changes'][key][change]:+.1f} %"
                    effects.append([label, change, paper, _change(effect)])
                pairs.append(f"{label} {_interval(ours['difference'])}")
            said = f"Filter minus no filter, seed by seed: {', '.join(pairs)}."
            theory = measures["theory_noise_mse_m2"]
            if theory is not None and mode.startswith("converged"):
                quiet, _, noisy, _ = measures["mse_position_error_m2"]["cases"]
                added = short(noisy["mean"] - quiet["mean"])
                said += f" MSE that noise adds without filter: {added} m²; "
                said += f"from σ²Δt/2δ, {short(theory)} m²."
            parts += [
                f"### {mode}; noise at {entry}",
                markdown_table(_TABLE2_HEAD, rows),
                markdown_table(("", "effect of", "paper", "ours [95 %]: verdict"), effects),
                said,
            ]
    return parts


def _ablation(table: Table) -> str:
    named = ("orientation", "noise at", "sub-steps", "stable")
    rows = []
    for row in table["rows"]:
        stable = "yes" if row["stable"] else "no"
        choice = [row["orientation"], row["noise_at"], str(row["substeps"]), stable]
        growth = number(row["amplification"], ".4f", "–")
        rows.append([*choice, *(short(row[key]) for key in _ABLATION), growth])
    return markdown_table((*named, *_ABLATION.values(), "growth of a sub-step"), rows)


def _interval(estimate: Mapping[str, Any]) -> str:
    """Show a mean with the ends of its interval; an exact value alone."""
    if estimate["samples"] == 1:
        return short(estimate["mean"])
    return f"{estimate['mean']:.4g} [{estimate['low']:.4g}, {estimate['high']:.4g}]"
