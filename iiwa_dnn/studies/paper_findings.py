"""What the tables of the paper's experiments say, in sentences made from numbers and verdicts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

Table = Mapping[str, Any]

MEASURES = {"max_position_error_m": "MAX E", "mse_position_error_m2": "MSE"}
"""The paper's names of the two measures of its Table II."""

_WAYS = {"lowers": "lowered", "raises": "raised", "no effect shown": "no effect shown"}


def findings(tables: Mapping[str, Table]) -> list[str]:
    """What the tables say, in sentences made from their numbers and verdicts."""
    table1, table2, ablation = (tables[name] for name in ("table1", "table2", "ablation"))
    lines = []
    for name, variant in table1["variants"].items():
        verdicts = variant["verdicts"]
        said = [
            f"{label} {verdicts[key]['our_trend']} with ξ (paper: {verdicts[key]['paper_trend']}), "
            f"{_range(verdicts[key]['ours_over_paper'])} times the paper's"
            for key, label in (("max_position_error_m", "MAX E"), ("joint_drift_rad", "drift"))
        ]
        lines.append(f"Table I, {name}: {'; '.join(said)}.")
    for mode, entries in table2["modes"].items():
        for entry, measures in entries.items():
            said = [
                f"{MEASURES[key]} {change_in_words(measures[key]['changes']['filter, with noise'])}"
                for key in MEASURES
            ]
            lines.append(f"Filter under noise at {entry}, {mode}: {', '.join(said)}.")
    lines.append(_claim(table2))
    closest, stable = ablation["closest_to_the_papers_drift"], ablation["closest_stable"]
    lines.append(
        f"Closest to the paper's drift of {short(ablation['paper']['joint_drift_rad'])} rad: "
        f"{_choice(closest)}, {short(closest['joint_drift_rad'])} rad; this choice is "
        f"{'stable' if closest['stable'] else 'not stable'}: {_growth(closest)}, MAX E "
        f"{short(closest['max_position_error_m'])} m. The closest stable one: {_choice(stable)}, "
        f"{short(stable['joint_drift_rad'])} rad."
    )
    return lines


def _claim(table: Table) -> str:
    """What the comparisons of Table II say, together, of the claim that the filter helps."""
    found = [
        entries[entry][key]["changes"]["filter, with noise"]
        for entries in table["modes"].values()
        for entry in entries
        for key in MEASURES
    ]
    counts = {way: sum(change["our_trend"] == way for change in found) for way in _WAYS}
    said = ", ".join(f"{word} in {counts[way]}" for way, word in _WAYS.items())
    best = 100.0 * max(-min(change["mean"] for change in found), 0.0)
    papers = [changes["filter, with noise"] for changes in table["paper_changes"].values()]
    return (
        f"The paper's claim that the filter lowers the error under noise, in {len(found)} "
        f"comparisons over {table['scope']['seeds']} seeds: {said}; the most it took off a mean is "
        f"{best:.2f} %, against {-100.0 * min(papers):.1f} % in the paper."
    )


def change_in_words(change: Mapping[str, Any]) -> str:
    """A relative change in words and per cent."""
    word = _WAYS[change["our_trend"]]
    mean, low, high = (change[key] for key in ("mean", "low", "high"))
    if mean > 1.0:  # a percentage of thousands says less than a factor
        size = f"× {1.0 + mean:.3g}"
    else:
        size = f"{100.0 * mean:+.2f} %"
        if change["samples"] > 1:
            size += f" [{100.0 * low:+.2f}, {100.0 * high:+.2f}]"
    return f"{word}, {size}: {change['verdict']}"


def _range(ratios: Sequence[float | None]) -> str:
    """The least and the greatest ratio that there is."""
    known = [ratio for ratio in ratios if ratio is not None]
    return f"{short(min(known))} to {short(max(known))}" if known else "–"


def _choice(row: Mapping[str, Any]) -> str:
    how = "implicit" if row["substeps"] == "implicit" else f"{row['substeps']} explicit sub-steps"
    return f"{how}, {row['orientation']}, noise at {row['noise_at']}"


def _growth(row: Mapping[str, Any]) -> str:
    growth = row["amplification"]
    return (
        "implicit steps damp" if growth is None else f"a sub-step multiplies errors by {growth:.2f}"
    )


def short(value: float | None) -> str:
    """A number in three digits; a dash where there is none."""
    return "–" if value is None else f"{value:.3g}"
