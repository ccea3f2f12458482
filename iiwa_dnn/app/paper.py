"""``paper``: every experiment of the paper in one sweep, with tables, figures and a report."""

from __future__ import annotations

import os
import platform
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from iiwa_dnn.app.command_line import list_files, run_command, save_settings
from iiwa_dnn.app.settings import PaperSettings
from iiwa_dnn.files import prepare_folder, write_json
from iiwa_dnn.studies import ablation, paper, table1, table2
from iiwa_dnn.studies.paper_plots import save_paper_figures
from iiwa_dnn.studies.paper_report import findings, write_paper_report
from iiwa_dnn.studies.provenance import fingerprint
from iiwa_dnn.studies.runs import FULL, QUICK, HeartRun, Scope, measure
from iiwa_dnn.studies.sweeps import Sweep

EXPERIMENTS = {"table1": table1, "table2": table2, "ablation": ablation}


def reproduce_paper(arguments: Sequence[str] | None = None, prog: str = "reproduce_paper") -> int:
    """Run every experiment of the paper and write what came out; the script of the same name.

    Args:
        arguments: Command line without the program's name; None takes the process's own.
        prog: What the command is called in messages.

    Returns:
        0: all runs were completed. 1: one was not. 2: bad input, one line on standard error.
    """
    return run_command(PaperSettings, prog, _paper, arguments)


def _paper(settings: PaperSettings) -> int:
    began = time.perf_counter()
    scope = _scope(settings)
    folder = prepare_folder(settings.out)
    figures = figure_runs(scope)
    parts = {name: module.cells(scope) for name, module in EXPERIMENTS.items()}
    runs = [run for part in (*parts.values(), figures.values()) for run in part]
    sweep = Sweep(measure, folder / "cells")
    results = sweep.run(
        [run.settings() for run in runs],
        workers=settings.workers,
        dask=settings.dask,
        quiet=settings.quiet,
    )
    tables = _tables(scope, parts, results)
    for name, table in tables.items():
        write_json(folder / f"{name}.json", table)
    drawn = []
    if settings.plots:
        records = {name: sweep.record(run.settings()) for name, run in figures.items()}
        drawn = save_paper_figures(records["noise, filter"], records, tables, folder)
    head = _head(scope, len(runs), results, time.perf_counter() - began)
    write_paper_report(folder, tables, head, drawn)
    save_settings(settings, folder)
    ended_early = [values["status"] for values in results if values["status"] != "completed"]
    if not settings.quiet:
        if settings.verbose:
            print("\n".join(f"{name:<14}{value}" for name, value in head.items()))
        print("\n".join(findings(tables)))
        print(f"written to {folder}")
        if settings.verbose:
            list_files(folder)
    if ended_early:
        print(f"{len(ended_early)} runs ended early, the first: {ended_early[0]}", file=sys.stderr)
    return 1 if ended_early else 0


def figure_runs(scope: Scope) -> dict[str, HeartRun]:
    """The runs of Fig. 2 by their panels, kept as records; the last is that of Fig. 1 too."""
    base = HeartRun(dt=scope.dt, duration=scope.duration, keep_record=True)
    noisy = replace(base, noise=paper.NOISE)
    return {
        "no noise, no filter": base,
        "noise, no filter": noisy,
        "no noise, filter": replace(base, filter_window=paper.WINDOW),
        "noise, filter": replace(noisy, filter_window=paper.WINDOW),
    }


def _tables(
    scope: Scope, parts: Mapping[str, list[HeartRun]], results: Sequence[Mapping[str, Any]]
) -> dict[str, dict[str, Any]]:
    """Each experiment's table out of its share of the results."""
    tables, start = {}, 0
    for name, runs in parts.items():
        tables[name] = EXPERIMENTS[name].tabulate(scope, results[start : start + len(runs)])
        start += len(runs)
    return tables


def _scope(options: PaperSettings) -> Scope:
    """What the options ask for: --quick, and what is given beside it."""
    given = {name: getattr(options, name) for name in ("seeds", "duration")}
    changes = {name: value for name, value in given.items() if value is not None}
    return replace(QUICK if options.quick else FULL, **changes)


def _head(
    scope: Scope, runs: int, results: Sequence[Mapping[str, Any]], wall: float
) -> dict[str, str]:
    """What, when and on what it was run."""
    spent = sum(values["wall_time_s"] for values in results)
    period = HeartRun().reference().period
    note = f": less than the heart's {period:g} s does not close it, so the drift is another"
    open_end = note if scope.duration < period else ""
    versions = fingerprint(measure)["versions"] | {"python": platform.python_version()}
    return {
        "date": datetime.now(timezone.utc).strftime("%Y-%m-%d %H:%M UTC"),
        "machine": f"{_processor()}, {os.cpu_count()} cores, {platform.system()}",
        "versions": ", ".join(f"{name} {number}" for name, number in versions.items()),
        "runs": f"{runs:,} of {scope.duration:g} s at {scope.dt:g} s; {scope.seeds} seeds in "
        f"Table II, {scope.laps} laps at {scope.laps_dt:g} s{open_end}",
        "wall time": f"{wall:.0f} s, of which runs found finished took none; all runs together "
        f"took {spent:.0f} s, {spent / runs:.2f} s each",
    }


def _processor() -> str:
    """The processor's name, where the system tells it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()
