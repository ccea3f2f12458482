"""``paper`` and ``atlas``: many runs in one sweep, with tables, figures and a report."""

import sys
import time
from collections.abc import Sequence
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import Any

import tomli_w

from iiwa_dnn.app.command_line import SETTINGS_FILE, claim_folder
from iiwa_dnn.app.words import SweepWords
from iiwa_dnn.files import write_json, write_text
from iiwa_dnn.results.plots import overview_figure, write_figures
from iiwa_dnn.results.report import made
from iiwa_dnn.studies import atlas as league, atlas_report, paper_report
from iiwa_dnn.studies.paper_tables import EXPERIMENTS, figure_runs
from iiwa_dnn.studies.runs import HeartRun, Scope, measure
from iiwa_dnn.studies.sweeps import PACKAGES, Task, sweep


def run_sweep(
    words: SweepWords, name: str, task: Task, cells: Sequence[Any]
) -> tuple[Path, list[Any]]:
    """Compute the cells of a sweep in a command's folder, but for those that are there.

    Returns the folder and the results; errors as of `claim_folder` and `sweep`.
    """
    settings = {"command": name}
    folder = claim_folder(words.out or Path("runs") / name, settings, words.overwrite)
    write_text(folder / SETTINGS_FILE, tomli_w.dumps(settings))
    how: dict[str, Any] = {"workers": words.workers, "dask": words.dask, "quiet": words.quiet}
    return folder, sweep(task, cells, folder / "cells", **how)


def paper(words: SweepWords, scope: Scope, name: str | None = None) -> int:
    """Run every experiment, or the one of a name; write tables, figures and report.

    Returns the exit code: 1 if a run ended early.
    """
    began = time.perf_counter()
    parts = {key: EXPERIMENTS[key].runs(scope) for key in ([name] if name else EXPERIMENTS)}
    cells = [run for part in parts.values() for run in part.values()]
    folder, results = run_sweep(words, "paper", measure, cells)
    remaining = iter(results)
    tables = {
        key: EXPERIMENTS[key].tabulate(scope, dict(zip(part, remaining, strict=False)))
        for key, part in parts.items()
    }
    for file, table in tables.items():
        write_json(folder / f"{file}.json", table)
    caveats = _caveats(scope)
    head = {
        **made({package: version(package) for package in PACKAGES}),
        "runs": f"{len(cells):,} of {scope.duration:g} s at {scope.dt:g} s; {scope.seeds} seeds",
        "wall time": f"{time.perf_counter() - began:.0f} s but for runs that were found finished",
        **caveats,
    }
    text = paper_report.report(tables, head, [] if name else _figures(words, scope))
    write_text(folder / "report.md", text)
    if not words.quiet:
        said = [text] if name else [*paper_report.summary(tables), *caveats.values()]
        print(*said, f"written to {folder}", sep="\n\n")
    return _early(results)


def _early(results: Sequence[Any]) -> int:
    """Tell of runs that ended early, and return the exit code."""
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
        "fig2": partial(paper_report.error_figure, records),
    }
    return [path.name for path in write_figures(figures, folder) if path.suffix == ".png"]


def _caveats(scope: Scope) -> dict[str, str]:
    """Say of runs that are shorter than the heart that no figure of theirs is the paper's."""
    period = HeartRun().reference().period
    if scope.duration >= period:
        return {}
    text = f"Runs of {scope.duration:g} s: less than the heart's {period:g} s does not close it, so"
    return {"caveat": f"{text} the drift is another, and no figure is the paper's."}


def atlas(words: SweepWords, size: league.Size) -> int:
    """Run the atlas, write tables and report, and return the exit code."""
    began = time.perf_counter()
    trials = league.gain_cells(size)
    gains = league.best_gains(trials, run_sweep(words, "atlas", league.measure, trials)[1])
    cells = league.cells(size, gains)
    folder, results = run_sweep(words, "atlas", league.measure, cells)
    rows = atlas_report.tabulate(cells, results)
    write_json(folder / "atlas.json", rows)
    runs = sum(cell.seeds for cell in cells) + len(trials)
    head = (
        f"{runs} runs of {league.DURATION:g} s in {time.perf_counter() - began:.0f} s; "
        f"{size.seeds} seeds with the first scheme, {size.others} with the others, "
        "on heart, circle and Lissajous figure in turn; errors of each run's second half."
    )
    text = atlas_report.report(folder, size, rows, head)
    write_text(folder / "report.md", text)
    if not words.quiet:
        print(text)
    return 0
