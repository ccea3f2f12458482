"""The report on the control loop: Markdown, JSON and a plot, out of what was measured."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from benchmarks.report import table
from iiwa_dnn.files import write_json, write_text
from iiwa_dnn.results.plots import DOUBLE_COLUMN, legend_above, new_figure, write_figures

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LIMITS = """\
- One machine, with whatever else runs on it. Each loop is a process in the Python of its library;
  they take turns of 250 steps, so that noise falls on all alike; differences of a few per cent mean
  nothing.
- A step is the call that a robot's loop waits for: kinematics, program and solver, in
  `Controller.step` the reference too; for the peers, whose targets are computed before, the
  integration too. Inside `simulate` a step is shorter still.
- PlaCo has a hard frame task, as this package; Pink and mink weigh a frame task against a weak
  posture task in one cost; Drake tracks the direction of the tip's velocity. None has a term that
  brings the posture back. They are the wider libraries: several tasks, barriers, floating bases.
- The tracking error depends on when a target is meant to be reached. Pink's examples set that of
  the step's beginning, so the tip comes one period late; the other peers get that of its end. Here
  the desired velocity is fed forward. All postures are judged by the same kinematics.
- The check runs in worker processes on the other cores, and so profits from them; ProxQP alone
  runs in one process.
"""


def save_loop_report(results: Mapping[str, Any], folder: Path) -> list[Path]:
    """Write ``report.md``, ``results.json`` and ``steps.png``/``.pdf``.

    Args:
        results: ``environment``, ``dt``, ``steps``, ``missing``, ``own_part``, ``runs``,
            ``profile``, ``startup`` and ``memory``.
        folder: Where to; it exists.

    Returns:
        The files written.
    """
    write_json(folder / "results.json", results)
    write_text(folder / "report.md", markdown(results))
    figures = write_figures({"steps": lambda: steps_figure(results["steps"])}, folder)
    return [folder / "report.md", folder / "results.json", *figures]


def markdown(results: Mapping[str, Any]) -> str:
    """The report's text."""
    where, runs, memory = results["environment"], results["runs"], results["memory"]
    versions = ", ".join(f"{name} {number}" for name, number in where["versions"].items())
    rows = results["steps"]
    placo = next((row["median_us"] for row in rows if row["name"] == "PlaCo"), None)
    unchecked = 1e6 * runs["wall_s"]["unchecked"] / runs["steps"]
    own = results["own_part"]
    lines = [
        "# The control loop",
        "",
        f"{where['date']}, {where['cpu']}, {where['cores']} cores, Python {where['python']}, "
        f"{versions}. Control period {results['dt']:g} s.",
        "",
        "## One step, beside its peers",
        "",
        "![Median and tail of a step's time](steps.png)",
        "",
        *table(
            ("step", "median µs", "p99 µs", "p99.9 µs", "of PlaCo's", "largest position error m"),
            [
                (
                    row["name"], f"{row['median_us']:.1f}", f"{row['p99_us']:.1f}",
                    f"{row['p999_us']:.1f}", _ratio(row["median_us"], placo),
                    f"{row['max_position_error_m']:.2e}",
                )
                for row in rows
            ],
        ),
        "",
        *(f"Not measured, since no Python has it: {name}." for name in results["missing"]),
        "",
        f"## A run of {runs['steps']} steps",
        "",
        *table(
            ("what", "wall time s", "times as quick as the robot"),
            [
                (name, f"{runs['wall_s'][key]:.2f}", _factor(runs["realtime_factor"].get(key)))
                for name, key in (
                    ("unchecked", "unchecked"),
                    ("every step checked by ProxQP", "checked"),
                    ("ProxQP alone on the same programs", "proxqp"),
                    ("the same, making its problems", "proxqp_with_problem"),
                )
            ],
        ),
        "",
        f"The checked run takes {runs['checked_over_proxqp_with_problem']:.2f} of the time of "
        f"ProxQP alone in one process with making its problems, {runs['checked_over_proxqp']:.2f} "
        "of its solving.",
        "",
        f"A step of the unchecked run takes {unchecked:.2f} µs, {_ratio(unchecked, placo) or '?'} "
        "of PlaCo's median step.",
        "",
        f"The checked run of `scripts/own_parts.py` takes {own['own_part']:.2f} s, "
        f"{own['ratio']:.2f} times the run of the built-in parts, {own['built_in']:.2f} s.",
        "",
        "## Where a step's time goes",
        "",
        *table(
            ("part, called on its own from Python", "µs"),
            [(name, f"{value:.2f}") for name, value in results["profile"]],
        ),
        "",
        "## A new process",
        "",
        *table(
            ("what", "s"),
            [
                ("`import iiwa_dnn`", f"{results['startup']['import_s']:.2f}"),
                (
                    "process start to first step, compiled code found",
                    f"{results['startup']['first_step_warm_s']:.2f}",
                ),
                (
                    "process start to first step, everything compiled",
                    f"{results['startup']['first_step_cold_s']:.1f}",
                ),
            ],
        ),
        "",
        "## Memory of a run and of one ten times as long",
        "",
        *table(
            ("run", "largest memory MB", "record MB"),
            [
                (name, f"{peak / 1e6:.1f}", f"{record / 1e6:.1f}")
                for name, peak, record in zip(
                    ("one", "ten times as long"), memory["peak_bytes"], memory["record_bytes"],
                    strict=True,
                )
            ],
        ),
        "",
        f"The memory grows by {memory['growth_over_record']:.2f} times what the record grows by.",
        "",
        "## Limits of the comparison",
        "",
        LIMITS,
    ]  # fmt: skip
    return "\n".join(lines)


def steps_figure(rows: list[dict[str, Any]]) -> Figure:
    """Median, p99 and p99.9 of each, on a logarithmic scale."""
    from matplotlib.ticker import LogLocator, NullFormatter, ScalarFormatter

    figure = new_figure(DOUBLE_COLUMN, 2.6)
    axes = figure.add_subplot()
    places = range(len(rows))
    for key, label, marker in (
        ("median_us", "median", "o"), ("p99_us", "p99", "s"), ("p999_us", "p99.9", "^"),
    ):  # fmt: skip
        axes.plot([row[key] for row in rows], places, marker, linestyle="", label=label)
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.xaxis.set_major_formatter(ScalarFormatter())
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_xlabel("Time of a step [µs]")
    axes.set_yticks(places, [row["name"] for row in rows])
    axes.invert_yaxis()
    legend_above(axes, columns=3)
    return figure


def _factor(value: float | None) -> str:
    return "" if value is None else f"{value:.1f}"


def _ratio(value: float, placo: float | None) -> str:
    return "" if placo is None else f"{value / placo:.2f}"
