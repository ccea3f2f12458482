"""``paper``: every experiment of the paper in one sweep, with tables, figures and a report."""

import os
import platform
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from iiwa_dnn.app.command_line import tell
from iiwa_dnn.app.folders import run_sweep
from iiwa_dnn.app.options import PaperOptions
from iiwa_dnn.files import write_json
from iiwa_dnn.studies import ablation, paper, table1, table2
from iiwa_dnn.studies.paper_plots import save_paper_figures
from iiwa_dnn.studies.paper_report import findings, write_paper_report
from iiwa_dnn.studies.provenance import fingerprint
from iiwa_dnn.studies.runs import FULL, QUICK, HeartRun, Scope, measure

EXPERIMENTS = {"table1": table1, "table2": table2, "ablation": ablation}


def run(options: PaperOptions) -> int:
    """Run every experiment of the paper, write tables, figures and report; return the exit code."""
    began = time.perf_counter()
    asked: dict[str, Any] = {"seeds": options.seeds, "duration": options.duration}
    changes = {name: value for name, value in asked.items() if value is not None}
    scope = replace(QUICK if options.quick else FULL, **changes)
    folder, figures = options.out, figure_runs(scope)
    parts = {name: module.cells(scope) for name, module in EXPERIMENTS.items()}
    cells = [cell.settings() for part in (*parts.values(), figures.values()) for cell in part]
    sweep, results = run_sweep(options, measure, cells, options.dask)
    tables, start = {}, 0
    for name, part in parts.items():
        tables[name] = EXPERIMENTS[name].tabulate(scope, results[start : start + len(part)])
        write_json(folder / f"{name}.json", tables[name])
        start += len(part)
    drawn = []
    if options.plots:
        records = {name: sweep.record(cell.settings()) for name, cell in figures.items()}
        drawn = save_paper_figures(records["noise, filter"], records, tables, folder)
    head = _head(scope, results, time.perf_counter() - began)
    write_paper_report(folder, tables, head, drawn)
    ended_early = [values["status"] for values in results if values["status"] != "completed"]
    shown = head if options.verbose else {}
    lines = [f"{name:<14}{value}" for name, value in shown.items()]
    tell(options, *lines, *findings(tables), f"written to {folder}")
    if ended_early:
        print(f"{len(ended_early)} runs ended early, the first: {ended_early[0]}", file=sys.stderr)
    return 1 if ended_early else 0


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
    period = HeartRun().reference().period
    note = f": less than the heart's {period:g} s does not close it, so the drift is another"
    open_end = note if scope.duration < period else ""
    versions = fingerprint(measure)["versions"] | {"python": platform.python_version()}
    return {
        "date": datetime.now(timezone.utc).strftime("%Y-%m-%d %H:%M UTC"),
        "machine": f"{processor()}, {os.cpu_count()} cores, {platform.system()}",
        "versions": ", ".join(f"{name} {number}" for name, number in versions.items()),
        "runs": f"{runs:,} of {scope.duration:g} s at {scope.dt:g} s; {scope.seeds} seeds in "
        f"Table II, {scope.laps} laps at {scope.laps_dt:g} s{open_end}",
        "wall time": f"{wall:.0f} s, of which runs found finished took none; all runs together "
        f"took {spent:.0f} s, {spent / runs:.2f} s each",
    }


def processor() -> str:
    """Return the processor's name, where the system tells it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()
