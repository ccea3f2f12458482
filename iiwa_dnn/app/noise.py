"""``noise``: a sweep over disturbances and countermeasures, with a table and a report."""

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

from iiwa_dnn import checks
from iiwa_dnn.app.command_line import print_lines
from iiwa_dnn.app.folders import run_sweep
from iiwa_dnn.app.options import NoiseOptions
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.files import write_json
from iiwa_dnn.results.markdown import markdown_table, save_markdown
from iiwa_dnn.results.plots import write_figures
from iiwa_dnn.studies import noise_study

_HEAD = (
    "countermeasure",
    "MSE [m²]",
    "MSE without / with",
    "max error [m]",
    "last error [m]",
    "command [rad/s²]",
    "motion [rad/s²]",
)


def run(options: NoiseOptions) -> int:
    """Run every disturbance with every countermeasure, and return the exit code."""
    seeds = checks.integer("seeds", options.seeds, 2)
    duration = options.duration
    least = noise_study.SETTLED_AFTER
    if not least < duration < 1e3:
        problem = f"must be above {least:g} and below 1000 s, not {duration:g}"
        raise InvalidInputError("duration", problem)
    cells = noise_study.cells(seeds, duration)
    _, results = run_sweep(options, noise_study.measure, cells)
    rows = noise_study.tabulate(cells, results)
    write_json(options.out / "noise.json", rows)
    write_figures({"noise": partial(noise_study.noise_figure, rows)}, options.out)
    text = _report(rows, seeds, duration)
    save_markdown(options.out, [text])
    print_lines(options, text)
    return 0 if all(row["completed"] for row in rows) else 1


def _report(rows: Sequence[Mapping[str, Any]], seeds: int, duration: float) -> str:
    """Return the report: one table for each disturbance."""
    parts = [
        "# Means against noise",
        f"{duration:g} s of the heart at 1e-4 s, {seeds} seeds where there is chance. Errors and "
        f"roughness from {noise_study.SETTLED_AFTER:g} s on; the gain is "
        f"{noise_study.GAIN:g} 1/s in place of 10.2 1/s. Roughness: total variation of the "
        "network's answer, and of the velocity that moved the robot, a second and joint.",
    ]
    parts += ["![Error and roughness of every countermeasure](noise.png)"]
    for kind in noise_study.DISTURBANCES:
        cells = [_cells(row) for row in rows if row["disturbance"] == kind]
        parts += [f"## {kind}", markdown_table(_HEAD, cells)]
    return "\n\n".join(parts)


def _cells(row: Mapping[str, Any]) -> list[str]:
    mse = f"{row['mse_m2']:.3g}"
    if row["mse"] is not None:
        mse += f" [{row['mse']['low']:.3g}, {row['mse']['high']:.3g}]"
    measures = [f"{row[name]:.3g}" for name in noise_study.MEASURES[1:]]
    return [row["countermeasure"], mse, f"{row['mse_ratio']:.3g}", *measures]
