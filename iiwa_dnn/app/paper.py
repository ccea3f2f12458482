"""``paper``: every experiment of the paper in one sweep, with tables, figures and a report."""

import os
import platform
import re
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import datetime, timezone
from itertools import chain
from pathlib import Path
from typing import Any

from iiwa_dnn.app.command_line import run_sweep
from iiwa_dnn.app.words import SweepWords
from iiwa_dnn.files import write_json, write_text
from iiwa_dnn.studies import ablation, paper, table1, table2
from iiwa_dnn.studies.paper_plots import save_paper_figures
from iiwa_dnn.studies.paper_report import column_report, findings, write_paper_report
from iiwa_dnn.studies.runs import HeartRun, Scope, measure
from iiwa_dnn.studies.sweeps import fingerprint

EXPERIMENTS = {"table1": table1, "table2": table2, "ablation": ablation}


def run(words: SweepWords, scope: Scope, weight: float | None = None) -> int:
    """Run every experiment of the paper, or one column of Table I; return the exit code."""
    return _run_all(words, scope) if weight is None else _run_column(words, scope, weight)


def _run_all(words: SweepWords, scope: Scope) -> int:
    """Run every experiment of the paper, write tables, figures and report; return the exit code."""
    began = time.perf_counter()
    figures = figure_runs(scope)
    parts = {name: module.cells(scope) for name, module in EXPERIMENTS.items()}
    runs = [*chain(*(part.values() for part in parts.values())), *figures.values()]
    sweep, results = run_sweep(words, "paper", measure, [run.settings() for run in runs])
    remaining = iter(results)
    tables = {
        name: EXPERIMENTS[name].tabulate(scope, dict(zip(part, remaining, strict=False)))
        for name, part in parts.items()
    }
    folder = sweep.folder.parent
    for name, table in tables.items():
        write_json(folder / f"{name}.json", table)
    records = {name: sweep.record(cell.settings()) for name, cell in figures.items()}
    drawn = save_paper_figures(records["noise, filter"], records, tables, folder)
    head = _head(scope, results, time.perf_counter() - began)
    write_paper_report(folder, tables, head, drawn)
    if not words.quiet:
        print(*findings(tables), *_caveats(scope), f"written to {folder}", sep="\n")
    return _exit_code(results)


def _run_column(words: SweepWords, scope: Scope, weight: float) -> int:
    """Run one column of Table I, write and print it; return the exit code."""
    runs = table1.column_cells(scope, weight)
    sweep, results = run_sweep(words, "paper", measure, [run.settings() for run in runs.values()])
    table = table1.tabulate_column(scope, weight, dict(zip(runs, results, strict=True)))
    lines = [column_report(table), *_caveats(scope)]
    file = sweep.folder.with_name(f"table1_{weight:g}.md")
    write_text(file, "\n\n".join(lines) + "\n")
    if not words.quiet:
        print(*lines, f"written to {file}", sep="\n")
    return _exit_code(results)


def _exit_code(results: Sequence[Mapping[str, Any]]) -> int:
    """Return 1 and say so if a run ended early, else 0."""
    ended_early = [values["status"] for values in results if values["status"] != "completed"]
    if not ended_early:
        return 0
    print(f"{len(ended_early)} runs ended early, the first: {ended_early[0]}", file=sys.stderr)
    return 1


def _caveats(scope: Scope) -> list[str]:
    """Say of runs that are shorter than the heart what their figures are not."""
    period = HeartRun().reference().period
    if scope.duration >= period:
        return []
    return [
        f"Runs of {scope.duration:g} s: less than the heart's {period:g} s does not close it, so "
        "the drift is another, and no figure is the paper's."
    ]


def figure_runs(scope: Scope) -> dict[str, HeartRun]:
    """Return the runs of Fig. 2, kept as records, by their panels; the last is Fig. 1's too."""
    base = HeartRun(dt=scope.dt, duration=scope.duration, keep_record=True)
    noisy = replace(base, noise=paper.NOISE)
    return {
        "no noise, no filter": base,
        "noise, no filter": noisy,
        "no noise, filter": replace(base, filter_window=paper.WINDOW),
        "noise, filter": replace(noisy, filter_window=paper.WINDOW),
    }


def _head(scope: Scope, results: Sequence[Mapping[str, Any]], wall: float) -> dict[str, str]:
    """Return the date, the machine, the versions and the sizes of the sweep, for its report."""
    runs = len(results)
    spent = sum(values["wall_time_s"] for values in results)
    versions = fingerprint(measure)["versions"] | {"python": platform.python_version()}
    head = {
        "date": datetime.now(timezone.utc).strftime("%Y-%m-%d %H:%M UTC"),
        "machine": f"{processor()}, {os.cpu_count()} cores, {platform.system()}",
        "versions": ", ".join(f"{name} {number}" for name, number in versions.items()),
        "runs": f"{runs:,} of {scope.duration:g} s at {scope.dt:g} s; {scope.seeds} seeds in "
        f"Table II, {scope.laps} laps at {scope.laps_dt:g} s",
        "wall time": f"{wall:.0f} s, of which runs found finished took none; all runs together "
        f"took {spent:.0f} s, {spent / runs:.2f} s each",
    }
    caveats = _caveats(scope)
    return {**head, "caveat": " ".join(caveats)} if caveats else head


def processor() -> str:
    """Return the processor's name, or the machine's type if the system does not give the name."""
    file = Path("/proc/cpuinfo")
    text = file.read_text(encoding="utf-8") if file.exists() else ""
    found = re.search(r"(?m)^model name\s*:\s*(.+)$", text)
    return found[1].strip() if found else platform.processor() or platform.machine()
