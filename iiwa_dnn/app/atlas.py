"""``atlas``: every network, scheme and disturbance at equal work, with a figure and verdicts."""

import time
from collections.abc import Sequence

from iiwa_dnn import checks
from iiwa_dnn.app.command_line import run_sweep
from iiwa_dnn.app.words import SweepWords
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.files import write_json
from iiwa_dnn.studies import atlas
from iiwa_dnn.studies.atlas_disturbances import DISTURBANCES
from iiwa_dnn.studies.atlas_report import tabulate, write_report
from iiwa_dnn.studies.atlas_schemes import SCHEMES


def run(words: SweepWords, size: atlas.Size) -> int:
    """Run the atlas, write tables, report, cards and figure, and return the exit code."""
    began = time.perf_counter()
    size.check()
    trials = atlas.gain_cells(size)
    gains = atlas.best_gains(trials, run_sweep(words, "atlas", atlas.measure, trials)[1])
    cells = atlas.cells(size, gains)
    sweep, results = run_sweep(words, "atlas", atlas.measure, cells)
    folder = sweep.folder.parent
    rows = tabulate(cells, results)
    write_json(folder / "atlas.json", rows)
    runs = sum(row["seeds"] for row in rows) + len(trials)
    paths = dict.fromkeys(path for row in rows for path in row["paths"][: row["seeds"]])
    turns = " in turn" if len(paths) > 1 else ""
    head = (
        f"{runs} runs of {atlas.DURATION:g} s in {time.perf_counter() - began:.0f} s; "
        f"{size.seeds} seeds with the first scheme, {size.others} with the others and at the other "
        f"budgets, on {', '.join(paths)}{turns}; errors of each run's second half."
    )
    text = write_report(folder, size, rows, head, True)
    if not words.quiet:
        print(text)
    return 0


def size_of(
    whole: bool,
    seeds: int | None,
    others: int | None,
    work: Sequence[float],
    networks: Sequence[str],
    schemes: Sequence[str],
    disturbances: Sequence[str],
) -> atlas.Size:
    """Return the size of the league; of what is not given all, or by default a few."""
    work = [checks.positive("work", budget) for budget in work]
    if not work or work != sorted(set(work)):
        raise InvalidInputError("work", "must rise, and there must be one at least")
    every = tuple(SCHEMES)
    if atlas.NETWORKS.keys().isdisjoint(networks):  # one's own beside all others
        networks = (*atlas.NETWORKS, *networks)
    seeds = (100 if whole else 5) if seeds is None else checks.integer("seeds", seeds, 1)
    others = 3 if others is None else checks.integer("other_seeds", others, 1)
    return atlas.Size(
        networks=networks,
        schemes=schemes or (every if whole else every[:1]),
        disturbances=disturbances or tuple(DISTURBANCES),
        paths=tuple(atlas.PATHS),
        work=work,
        seeds=seeds,
        others=others,
    )
