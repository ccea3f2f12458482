"""The report on the control loop: Markdown, JSON and a plot, out of what was measured."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from benchmarks.report import made_on, tabulate
from iiwa_dnn.files import write_json, write_text
from iiwa_dnn.results.markdown import markdown_table
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


_STEPS = {
    "step": "{name}",
    "median µs": "{median_us:.1f}",
    "p99 µs": "{p99_us:.1f}",
    "p99.9 µs": "{p999_us:.1f}",
    "of PlaCo's": "{of_placo:.2f}",
    "largest position error m": "{max_position_error_m:.2e}",
}
_RUNS = {
    "unchecked": "unchecked",
    "checked": "every step checked by ProxQP",
    "proxqp": "ProxQP alone on the same programs",
    "proxqp_with_problem": "the same, making its problems",
}


def markdown(results: Mapping[str, Any]) -> str:
    """The report's text."""
    runs = results["runs"]
    memory = results["memory"]
    own = results["own_part"]
    medians = {row["name"]: row["median_us"] for row in results["steps"]}
    placo = medians.get("PlaCo")
    steps = [{**row, "of_placo": placo and row["median_us"] / placo} for row in results["steps"]]
    unchecked = 1e6 * runs["wall_s"]["unchecked"] / runs["steps"]
    timed = [
        {"what": name, "wall": runs["wall_s"][key], "factor": runs["realtime_factor"].get(key)}
        for key, name in _RUNS.items()
    ]
    parts = [
        "# The control loop",
        f"{made_on(results['environment'])} Control period {results['dt']:g} s.",
        "## One step, beside its peers",
        "![Median and tail of a step's time](steps.png)",
        tabulate(_STEPS, steps),
        *(f"Not measured, since no Python has it: {name}." for name in results["missing"]),
        f"## A run of {runs['steps']} steps",
        tabulate(
            {
                "what": "{what}",
                "wall time s": "{wall:.2f}",
                "times as quick as the robot": "{factor:.1f}",
            },
            timed,
        ),
        f"The checked run takes {runs['checked_over_proxqp_with_problem']:.2f} of the time of "
        f"ProxQP alone in one process with making its problems, {runs['checked_over_proxqp']:.2f} "
        "of its solving.",
        f"A step of the unchecked run takes {unchecked:.2f} µs, "
        f"{f'{unchecked / placo:.2f}' if placo else '?'} of PlaCo's median step.",
        f"The checked run of `scripts/own_parts.py` takes {own['own_part']:.2f} s, "
        f"{own['ratio']:.2f} times the run of the built-in parts, {own['built_in']:.2f} s.",
        "## Where a step's time goes",
        markdown_table(
            ("part, called on its own from Python", "µs"),
            ([name, f"{value:.2f}"] for name, value in results["profile"]),
        ),
        "## A new process",
        tabulate(
            {
                "`import iiwa_dnn` s": "{import_s:.2f}",
                "process start to first step s": "{first_step_s:.2f}",
            },
            [results["startup"]],
        ),
        "## Memory of a run and of one ten times as long",
        markdown_table(
            ("run", "largest memory MB", "record MB"),
            (
                [name, *(f"{memory[key][i] / 1e6:.1f}" for key in ("peak_bytes", "record_bytes"))]
                for i, name in enumerate(("one", "ten times as long"))
            ),
        ),
        f"The memory grows by {memory['growth_over_record']:.2f} times what the record grows by.",
        "## Limits of the comparison",
        LIMITS,
    ]
    return "\n\n".join(parts)


def steps_figure(rows: list[dict[str, Any]]) -> Figure:
    """Median, p99 and p99.9 of each, on a logarithmic scale."""
    from matplotlib.ticker import LogLocator, NullFormatter, ScalarFormatter

    figure = new_figure(DOUBLE_COLUMN, 2.6)
    axes = figure.add_subplot()
    places = range(len(rows))
    for key, label, marker in (
        ("median_us", "median", "o"),
        ("p99_us", "p99", "s"),
        ("p999_us", "p99.9", "^"),
    ):
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
