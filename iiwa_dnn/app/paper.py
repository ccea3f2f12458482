"""``paper``: the experiments of the paper in one sweep, with tables, figures and a report."""

import os
import platform
import re
import sys
import time
from datetime import datetime, timezone
from functools import partial
from importlib.metadata import version
from pathlib import Path

from iiwa_dnn.app.command_line import run_sweep
from iiwa_dnn.app.words import SweepWords
from iiwa_dnn.files import write_json, write_text
from iiwa_dnn.results.plots import overview_figure, write_figures
from iiwa_dnn.studies.paper_report import error_figure, report, summary
from iiwa_dnn.studies.paper_tables import EXPERIMENTS, figure_runs
from iiwa_dnn.studies.runs import HeartRun, Scope, measure
from iiwa_dnn.studies.sweeps import PACKAGES


def run(words: SweepWords, scope: Scope, name: str | None = None) -> int:
    """Run every experiment, or the one of a name; write tables, figures and report.

    Returns the exit code: 1 if a run ended early.
    """
    began = time.perf_counter()
    names = EXPERIMENTS if name is None else (name,)
    parts = {name: EXPERIMENTS[name].runs(scope) for name in names}
    cells = [run for part in parts.values() for run in part.values()]
    folder, results = run_sweep(words, "paper", measure, cells)
    remaining = iter(results)
    tables = {
        name: EXPERIMENTS[name].tabulate(scope, dict(zip(part, remaining, strict=False)))
        for name, part in parts.items()
    }
    for file, table in tables.items():
        write_json(folder / f"{file}.json", table)
    head = _head(scope, len(cells), time.perf_counter() - began)
    text = report(tables, head, [] if name else _figures(words, scope))
    write_text(folder / "report.md", text)
    if not words.quiet:
        said = [text] if name else summary(tables)
        print(*said, *_caveats(scope), f"written to {folder}", sep="\n\n")
    early = [values["status"] for values in results if values["status"] != "completed"]
    if early:
        print(f"{len(early)} runs ended early, the first: {early[0]}", file=sys.stderr)
    return int(bool(early))


def _figures(words: SweepWords, scope: Scope) -> list[str]:
    """Draw the paper's Fig. 1 and 2; return the names of the PNG files."""
    runs = figure_runs(scope)
    folder, found = run_sweep(words, "paper", HeartRun.run, list(runs.values()))
    records = dict(zip(runs, found, strict=True))
    figures = {
        "fig1": partial(overview_figure, records["noise, filter"]),
        "fig2": partial(error_figure, records),
    }
    return [path.name for path in write_figures(figures, folder) if path.suffix == ".png"]


def _caveats(scope: Scope) -> list[str]:
    """Say of runs that are shorter than the heart what their figures are not."""
    period = HeartRun().reference().period
    if scope.duration >= period:
        return []
    return [
        f"Runs of {scope.duration:g} s: less than the heart's {period:g} s does not close it, so "
        "the drift is another, and no figure is the paper's."
    ]


def _head(scope: Scope, runs: int, wall: float) -> dict[str, str]:
    """Return the date, the machine, the versions and the sizes of the sweep, for its report."""
    versions = {name: version(name) for name in PACKAGES} | {"python": platform.python_version()}
    head = {
        "date": datetime.now(timezone.utc).strftime("%Y-%m-%d %H:%M UTC"),
        "machine": f"{processor()}, {os.cpu_count()} cores, {platform.system()}",
        "versions": ", ".join(f"{name} {number}" for name, number in versions.items()),
        "runs": f"{runs:,} of {scope.duration:g} s at {scope.dt:g} s; {scope.seeds} seeds in "
        f"Table II, {scope.laps} laps at {scope.laps_dt:g} s",
        "wall time": f"{wall:.0f} s; runs that were found finished took none",
    }
    caveats = _caveats(scope)
    return {**head, "caveat": " ".join(caveats)} if caveats else head


def processor() -> str:
    """Return the processor's name, or the machine's type if the system does not give the name."""
    file = Path("/proc/cpuinfo")
    text = file.read_text(encoding="utf-8") if file.exists() else ""
    found = re.search(r"(?m)^model name\s*:\s*(.+)$", text)
    return found[1].strip() if found else platform.processor() or platform.machine()
