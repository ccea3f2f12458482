"""The report on the control loop: Markdown, JSON and a plot, out of what was measured."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from benchmarks.report import table
from iiwa_dnn.files import write_json, write_text
from iiwa_dnn.results.plots import DOUBLE_COLUMN, new_figure, write_figures

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LIMITS = """\
- One machine, with whatever else runs on it. All steps are taken in one process, in turns of 50, so
  that noise falls on all alike; differences of a few per cent mean nothing.
- A step is what a caller of the classes waits for: kinematics, program, solver, integration. The
  targets are computed before. Inside `simulate` a step is shorter still.
- Pink's step includes what Pink makes of its tasks and limits. Its tasks are a frame task at full
  gain and a weak posture task; its frame task is a cost, not a constraint, and it has no term that
  brings the posture back. It is the wider library: several tasks, barriers, floating bases.
- The tracking error depends on when a target is meant to be reached. Pink's examples set that of
  the step's beginning, so the tip comes one period late; given that of its end, it is not late,
  and what is left comes of the posture task and of the linearisation. Here the desired velocity is
  fed forward.
- The check runs in worker processes on the other cores, and so profits from them; ProxQP alone
  runs in one process.
"""


def save_loop_report(results: Mapping[str, Any], folder: Path) -> list[Path]:
    """Write ``report.md``, ``results.json`` and ``steps.png``/``.pdf``.

    Args:
        results: ``environment``, ``dt``, ``steps``, ``runs``, ``profile``, ``startup`` and
            ``memory``.
        folder: Where to; it exists.

    Returns:
        What was written.
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
    ours, daqp = rows[0], rows[2]
    lines = [
        "# The control loop",
        "",
        f"{where['date']}, {where['cpu']}, {where['cores']} cores, Python {where['python']}, "
        f"{versions}. Control period {results['dt']:g} s.",
        "",
        "## One step, beside Pink",
        "",
        "![Median and tail of a step's time](steps.png)",
        "",
        *table(
            ("step", "median µs", "p99 µs", "p99.9 µs", "largest position error m"),
            [
                (
                    row["name"], f"{row['median_us']:.1f}", f"{row['p99_us']:.1f}",
                    f"{row['p999_us']:.1f}", f"{row['max_position_error_m']:.2e}",
                )
                for row in rows
            ],
        ),
        "",
        f"A step takes {ours['median_us'] / daqp['median_us']:.3f} of Pink's with DAQP, with "
        f"{ours['max_position_error_m'] / daqp['max_position_error_m']:.3f} of its error.",
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
        axes.plot([row[key] for row in rows], places, marker, label=label)
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.xaxis.set_major_formatter(ScalarFormatter())
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_xlabel("time of a step [µs]")
    axes.set_yticks(places, [row["name"] for row in rows])
    axes.invert_yaxis()
    axes.legend(fontsize="x-small")
    return figure


def _factor(value: float | None) -> str:
    return "" if value is None else f"{value:.1f}"
