"""``noise``: the means against noise compared; one sweep, a table, a report."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from iiwa_dnn.app.command_line import list_files, run_command, save_settings
from iiwa_dnn.app.settings import NoiseSettings
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.files import prepare_folder, write_json, write_text
from iiwa_dnn.results.report import markdown_table
from iiwa_dnn.studies import noise_study
from iiwa_dnn.studies.sweeps import Sweep


def study_noise(arguments: Sequence[str] | None = None, prog: str = "noise_study") -> int:
    """Run every pair of disturbance and countermeasure; the script ``noise_study.py``.

    Args:
        arguments: Command line without the program's name; None takes the process's own.
        prog: What the command is called in messages.

    Returns:
        0: all runs were completed. 1: one was not. 2: bad input, one line on standard error.
    """
    return run_command(NoiseSettings, prog, _study, arguments)


def _study(settings: NoiseSettings) -> int:
    seeds, duration = settings.seeds, settings.duration
    if seeds < 2:
        raise InvalidInputError("seeds", f"must be at least 2, not {seeds}")
    if not noise_study.SETTLED_AFTER < duration < 1e3:
        least = noise_study.SETTLED_AFTER
        problem = f"must be above {least:g} and below 1000 s, not {duration:g}"
        raise InvalidInputError("duration", problem)
    folder = prepare_folder(settings.out)
    sweep = Sweep(noise_study.measure, folder / "cells")
    cells = noise_study.cells(seeds, duration)
    results = sweep.run(cells, workers=settings.workers, quiet=settings.quiet)
    rows = noise_study.tabulate(seeds, duration, results)
    write_json(folder / "noise.json", rows)
    text = _report(rows, seeds, duration)
    write_text(folder / "report.md", text)
    save_settings(settings, folder)
    if not settings.quiet:
        print(text, end="")
        if settings.verbose:
            list_files(folder)
    return 0 if all(row["completed"] for row in rows) else 1


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
