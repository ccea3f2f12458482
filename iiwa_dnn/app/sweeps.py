"""``paper`` and ``atlas``: many runs in one sweep, with tables, figures and a report.

The studies are imported only for these two commands: SciPy's statistics take a second.
"""

import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import Annotated, Any, Literal

from tyro.conf import arg

from iiwa_dnn import checks
from iiwa_dnn.app.command_line import (
    Count,
    Flag,
    Folder,
    Number,
    Quiet,
    check_folder,
    shown,
    write_settings,
)
from iiwa_dnn.files import write_json, write_text
from iiwa_dnn.results.plots import overview_figure, write_figures
from iiwa_dnn.results.report import provenance

Names = Annotated[tuple[str, ...], shown("NAME ...")]


@dataclass(frozen=True)
class SweepWords:
    """Options of a command that carries out many runs and resumes them."""

    out: Folder = None  # folder of the results (runs/ and the command's name)
    overwrite: Flag = False  # write over a folder that holds something else
    workers: Count = None  # number of processes (one for each core)
    quiet: Quiet = False  # print nothing but the reasons of a failure


Sweeping = Annotated[SweepWords, arg(help="")]  # its title says enough
EVERY = SweepWords()


def start_sweep(words: SweepWords, name: str) -> tuple[Path, Callable[..., list[Any]]]:
    """Claim the folder of a command; return it, and a function that computes cells by a task.

    Cells with a stored result are not computed again.
    """
    from iiwa_dnn.studies.sweeps import sweep

    if words.workers is not None:
        checks.integer("workers", words.workers, 1)
    settings = {"command": name}
    folder = words.out or Path("runs") / name
    check_folder(folder, settings, words.overwrite)
    write_settings(folder, settings)
    compute = partial(sweep, workers=words.workers, quiet=words.quiet)
    return folder, partial(compute, folder=folder / "cells")


def paper(
    sweep: Sweeping = EVERY,
    *,
    quick: Flag = False,
    seeds: Count = None,
    duration: Number = None,
    table: Annotated[Literal[1, 2] | None, shown("N")] = None,
    weights: Annotated[tuple[float, ...], shown("X ...")] = (),
    identify: Flag = False,
) -> int:
    """Run every experiment of the paper, each number beside the paper's.

    Args:
        sweep: words of all sweeps
        quick: run 1 s and 5 seeds only, to see that all works
        seeds: number of noises in Table II (100)
        duration: length of each run [s] (10)
        table: table of the paper to run alone, 1 or 2 (everything)
        weights: weights xi in [0, 1] of columns of Table I: 0.1, 0.2, 0.4, 0.5, 0.6, 0.8, 0.9 (all)
        identify: seek in a grid the settings that the paper leaves out, half an hour, in place of
            its experiments
    """
    from iiwa_dnn.studies import identify as grid, paper_report, paper_tables, runs, sweeps

    scope = replace(
        runs.QUICK if quick else runs.FULL,
        **_chosen({"seeds": seeds, "duration": duration, "weights": weights or None}),
    )
    names = [*paper_tables.EXPERIMENTS] if table is None else [f"table{table}"]
    folder, compute = start_sweep(sweep, "paper")
    if identify:
        return _say(sweep, grid.identify(folder, partial(compute, runs.measure), scope))
    tables = {}
    early: list[str] = []
    for name in names:
        experiment = paper_tables.EXPERIMENTS[name]
        planned = experiment.runs(scope)
        results = compute(runs.measure, [*planned.values()])
        tables[name] = experiment.tabulate(scope, dict(zip(planned, results, strict=True)))
        write_json(folder / f"{name}.json", tables[name])
        early += [values["status"] for values in results if values["status"] != "completed"]
    head = {
        **provenance({package: version(package) for package in sweeps.PACKAGES}),
        "runs": f"{scope.duration:g} s each (the paper's: 10 s) at {scope.dt:g} s; the drift of "
        "less than a whole heart does not compare",
        "seeds": str(scope.seeds),
        "ended early": "; ".join(early) or "none",
    }
    text = paper_report.report(
        tables, head, _figures(compute, scope, folder) if table is None else []
    )
    write_text(folder / "report.md", text)
    if not sweep.quiet:
        said = paper_report.summary(tables) if table is None else [text]
        print(*said, f"written to {folder}", sep="\n\n")
    return int(bool(early))


def _say(sweep: Sweeping, text: str) -> int:
    """Print a text unless a sweep is quiet; return the exit code of one that went well."""
    print("" if sweep.quiet else text, end="")
    return 0


def _figures(compute: Callable[..., list[Any]], scope: Any, folder: Path) -> list[str]:
    """Draw the paper's Fig. 1 and 2; return the names of the PNG files."""
    from iiwa_dnn.studies import paper_report, paper_tables, runs

    panels = paper_tables.figure_runs(scope)
    records = dict(zip(panels, compute(runs.HeartRun.run, list(panels.values())), strict=True))
    figures = {
        "fig1": partial(overview_figure, records["noise, filter"]),
        "fig2": partial(paper_report.error_figure, records),
    }
    return [path.name for path in write_figures(figures, folder) if path.suffix == ".png"]


def atlas(
    sweep: Sweeping = EVERY,
    *,
    whole: Flag = False,
    seeds: Count = None,
    networks: Names = (),
    arm: Annotated[str | None, shown("NAME")] = None,
    schemes: Names = (),
    disturbances: Names = (),
    work: Annotated[float, shown("X")] = 1e4,
) -> int:
    """Compare the networks of the field, and yours, at equal work.

    A network of one's own is named as module:NAME or file.py:NAME. Exit code 1: a network that was
    named has lost runs; the report names the reason.

    Args:
        sweep: words of all sweeps
        whole: run 100 seeds and all schemes: hours in place of minutes
        seeds: number of noises, two or more (5, whole: 100)
        networks: networks (every one; beside your own too)
        arm: arm: iiwa7, fr3 or "iiwa7 at a bound" (iiwa7)
        schemes: schemes, all but the first undisturbed (the first; whole: every one)
        disturbances: disturbances beside the undisturbed runs (every one)
        work: work a control period [operations] (1e4)
    """
    from iiwa_dnn.studies import atlas as league, atlas_report

    alone = league.NETWORKS.keys().isdisjoint(networks)  # one's own beside all others
    given = {
        "networks": (*league.NETWORKS, *networks) if alone else networks,
        "arm": arm,
        "schemes": schemes or (tuple(league.SCHEMES) if whole else None),
        "disturbances": disturbances or None,
        "work": work,
        "seeds": 100 if whole and seeds is None else seeds,
    }
    size = league.Size(**_chosen(given))
    folder, compute = start_sweep(sweep, "atlas")
    trials = league.gain_cells(size)
    cells = league.cells(size, league.best_gains(trials, compute(league.measure, trials)))
    rows = atlas_report.tabulate(cells, compute(league.measure, cells))
    write_json(folder / "atlas.json", rows)
    head = (
        f"{sum(cell.seeds for cell in cells) + len(trials)} runs of {league.DURATION:g} s; "
        f"{size.seeds} seeds on heart, circle and Lissajous figure in turn, at most 3 "
        "undisturbed; errors of each run's second half."
    )
    text = atlas_report.report(folder, size, rows, head)
    write_text(folder / "report.md", text)
    lost = [row["failures"][0] for row in rows if row["lost"] and row["network"] in networks]
    if not sweep.quiet:
        print(text)
    elif lost:
        print(*dict.fromkeys(lost), sep="\n", file=sys.stderr)
    return int(bool(lost))


def _chosen(words: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options that were given, those that are not None."""
    return {name: value for name, value in words.items() if value is not None}
