"""``atlas``: every network, scheme and disturbance at equal work, with a figure and verdicts."""

import time

from iiwa_dnn import checks
from iiwa_dnn.app.command_line import print_lines
from iiwa_dnn.app.folders import run_sweep
from iiwa_dnn.app.options import AtlasOptions
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.files import write_json
from iiwa_dnn.studies import atlas
from iiwa_dnn.studies.atlas_disturbances import DISTURBANCES
from iiwa_dnn.studies.atlas_report import tabulate, write_report
from iiwa_dnn.studies.atlas_schemes import SCHEMES


def run(options: AtlasOptions) -> int:
    """Run the atlas, write tables, report, cards and figure, and return the exit code."""
    began = time.perf_counter()
    size = _size(options)
    size.check()
    trials = atlas.gain_cells(size)
    gains = atlas.best_gains(trials, run_sweep(options, atlas.measure, trials)[1])
    cells = atlas.cells(size, gains)
    rows = tabulate(cells, run_sweep(options, atlas.measure, cells)[1])
    write_json(options.out / "atlas.json", rows)
    runs = sum(row["seeds"] for row in rows) + len(trials)
    paths = dict.fromkeys(path for row in rows for path in row["paths"][: row["seeds"]])
    turns = " in turn" if len(paths) > 1 else ""
    head = (
        f"{runs} runs of {atlas.DURATION:g} s in {time.perf_counter() - began:.0f} s; "
        f"{size.seeds} seeds with the first scheme, {size.others} with the others and at the other "
        f"budgets, on {', '.join(paths)}{turns}; errors of each run's second half."
    )
    print_lines(options, write_report(options.out, size, rows, head, options.plots))
    return 0


def _size(options: AtlasOptions) -> atlas.Size:
    """Return the size of the league that the options describe."""
    seeds = (100 if options.whole else 5) if options.seeds is None else options.seeds
    others = 3 if options.other_seeds is None else options.other_seeds
    work = [checks.positive("work", budget) for budget in options.work]
    if not work or work != sorted(set(work)):
        raise InvalidInputError("work", "must rise, and there must be one at least")
    every = tuple(SCHEMES)
    networks = options.networks
    if atlas.NETWORKS.keys().isdisjoint(networks):  # one's own beside all others
        networks = (*atlas.NETWORKS, *networks)
    return atlas.Size(
        networks=networks,
        schemes=options.schemes or (every if options.whole else every[:1]),
        disturbances=options.disturbances or tuple(DISTURBANCES),
        paths=options.references or tuple(atlas.PATHS),
        work=work,
        seeds=checks.integer("seeds", seeds, 1),
        others=checks.integer("other_seeds", others, 1),
    )
