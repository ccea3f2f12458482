"""``atlas``: every network, scheme and disturbance at equal compute, with a figure and verdicts."""

from iiwa_dnn import checks
from iiwa_dnn.app.command_line import print_lines
from iiwa_dnn.app.folders import run_sweep
from iiwa_dnn.app.options import AtlasOptions
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.files import write_json
from iiwa_dnn.studies import atlas
from iiwa_dnn.studies.atlas_report import tabulate, write_report
from iiwa_dnn.studies.atlas_schemes import SCHEMES


def run(options: AtlasOptions) -> int:
    """Run the atlas, write table, report and figure, and return the exit code."""
    for name in ("seeds", "other_seeds"):
        checks.integer(name, getattr(options, name), 1)
    budgets = [checks.integer("evaluations", count, 1) for count in options.evaluations]
    if not budgets or budgets != sorted(set(budgets)):
        raise InvalidInputError("evaluations", "must rise, and there must be one at least")
    names = options.schemes or tuple(SCHEMES), options.networks
    cells = atlas.cells(options.seeds, options.other_seeds, budgets, *names)
    rows = tabulate(cells, run_sweep(options, atlas.measure, cells)[1])
    write_json(options.out / "atlas.json", rows)
    head = (
        f"{options.seeds} seeds with the first scheme, {options.other_seeds} with the others and "
        f"at the other budgets; half a heart in {atlas.DURATION:g} s, errors of its second half."
    )
    print_lines(options, write_report(options.out, rows, head, options.plots))
    return 0
