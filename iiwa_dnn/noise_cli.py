"""The script that compares the means against noise: arguments, one sweep, a table, a report."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from iiwa_dnn.cli import Parser
from iiwa_dnn.exceptions import IiwaDnnError, InvalidInputError
from iiwa_dnn.experiments import noise_study
from iiwa_dnn.files import prepare_folder, write_json, write_text
from iiwa_dnn.interrupts import ended_by_signals
from iiwa_dnn.report import markdown_table
from iiwa_dnn.sweeps import Sweep


@ended_by_signals()
def study_noise(arguments: Sequence[str] | None = None) -> int:
    """Run every pair of disturbance and countermeasure; the script ``noise_study.py``.

    Args:
        arguments: Command line without the program's name; None takes the process's own.

    Returns:
        0: all runs were completed. 1: one was not. 2: bad input, one line on standard error.
    """
    parser = _parser()
    options = parser.parse_args(arguments)
    try:
        if options.seeds < 2:
            raise InvalidInputError("seeds", f"must be at least 2, not {options.seeds}")
        if not noise_study.SETTLED_AFTER < options.duration < 1e3:
            least = noise_study.SETTLED_AFTER
            problem = f"must be above {least:g} and below 1000 s, not {options.duration:g}"
            raise InvalidInputError("duration", problem)
        folder = prepare_folder(options.out)
        cells = noise_study.cells(options.seeds, options.duration)
        sweep = Sweep(noise_study.measure, folder / "cells")
        results = sweep.run(cells, workers=options.workers, quiet=options.quiet)
        rows = noise_study.tabulate(options.seeds, options.duration, results)
        write_json(folder / "noise.json", rows)
        text = _report(rows, options.seeds, options.duration)
        write_text(folder / "report.md", text)
    except IiwaDnnError as error:
        print(f"{parser.prog}: error: {error}", file=sys.stderr)
        return 2
    if not options.quiet:
        print(text, end="")
    return 0 if all(row["completed"] for row in rows) else 1


def _parser() -> Parser:
    parser = Parser(
        prog="noise_study",
        description="Compare what helps against noise and other disturbances of the joint "
        "velocity: error against smoothness of the command. A run that was cut short goes on "
        "where it was.",
        epilog="Exit code 0: all runs completed; 1: one was not; 2: bad input.",
    )
    add = parser.add_argument
    add("--seeds", type=int, default=100, metavar="N", help="noises (%(default)s)")
    add("--duration", type=float, default=2.0, metavar="S", help="of each run (%(default)s)")
    add("--workers", type=int, metavar="N", help="processes (one for each core)")
    add("--out", type=Path, default=Path("runs/noise"), metavar="DIR", help="(%(default)s)")
    add("--quiet", action="store_true", help="no progress bar and no table")
    return parser


def _report(rows: Sequence[Mapping[str, Any]], seeds: int, duration: float) -> str:
    """The table, one part for each disturbance."""
    parts = [
        "# Means against noise",
        f"{duration:g} s of the heart at 1e-4 s, {seeds} seeds where there is chance. Errors and "
        f"roughness from {noise_study.SETTLED_AFTER:g} s on; the gain is "
        f"{noise_study.GAIN:g} 1/s in place of 10.2 1/s. Roughness: total variation of the "
        "network's answer, and of the velocity that moved the robot, a second and joint.",
    ]
    for kind in noise_study.DISTURBANCES:
        cells = [_cells(row) for row in rows if row["disturbance"] == kind]
        head = (
            "countermeasure", "MSE [m²]", "MSE without / with", "max error [m]", "last error [m]",
            "command [rad/s²]", "motion [rad/s²]",
        )  # fmt: skip
        parts += [f"## {kind}", markdown_table(head, cells)]
    return "\n\n".join(parts) + "\n"


def _cells(row: Mapping[str, Any]) -> list[str]:
    mse = f"{row['mse_m2']:.3g}"
    if row["mse"] is not None:
        mse += f" [{row['mse']['low']:.3g}, {row['mse']['high']:.3g}]"
    measures = [f"{row[name]:.3g}" for name in noise_study.MEASURES[1:]]
    return [row["countermeasure"], mse, f"{row['mse_ratio']:.3g}", *measures]
