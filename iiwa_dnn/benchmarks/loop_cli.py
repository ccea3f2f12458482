"""The script that measures the control loop beside Pink's: arguments and exit codes."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from tqdm import tqdm

from iiwa_dnn import checks
from iiwa_dnn.cli import Parser
from iiwa_dnn.exceptions import IiwaDnnError, MissingDependencyError
from iiwa_dnn.files import prepare_folder


def bench_loop(arguments: Sequence[str] | None = None) -> int:
    """Measure steps, runs, start-up and memory, and write the report.

    Args:
        arguments: Command line without the program's name; None takes the process's own.

    Returns:
        The exit code: 0 done, 2 bad input or something is missing.
    """
    options = _parser().parse_args(arguments)
    try:
        checks.integer("--steps", options.steps, 50)
        checks.integer("--rounds", options.rounds, 1)
        checks.positive("--duration", options.duration)
        checks.positive("--dt", options.dt)
        _run(options, prepare_folder(options.out))
    except IiwaDnnError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


def _run(options: argparse.Namespace, folder: Path) -> None:
    try:
        from iiwa_dnn.benchmarks.control import measure_runs, measure_steps, profile_step
    except ImportError as error:
        remedy = 'pip install "iiwa-dnn[bench]"'
        raise MissingDependencyError(str(error.name), remedy) from error
    from iiwa_dnn.benchmarks.loop_report import save_loop_report
    from iiwa_dnn.benchmarks.process import measure_memory, measure_startup
    from iiwa_dnn.benchmarks.report import environment

    with tqdm(total=options.steps, unit="step", disable=options.quiet) as bar:
        steps = measure_steps(options.steps, options.dt, bar.update)
    results = {
        "environment": environment(("pin-pink",)),
        "dt": options.dt,
        "steps": steps,
        "runs": measure_runs(options.duration, options.dt, options.rounds),
        "profile": profile_step(options.dt),
        "startup": measure_startup(options.rounds),
        "memory": measure_memory(0.2 * options.duration),
    }
    print(save_loop_report(results, folder)[0])


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="bench_loop.py",
        description="Measure the control loop beside Pink's and write a report.",
    )
    add = parser.add_argument
    add("--steps", type=int, default=20_000, metavar="N", help="steps beside Pink (%(default)s)")
    add("--duration", type=float, default=10.0, metavar="S", help="of a whole run (%(default)s)")
    add("--dt", type=float, default=1e-4, metavar="S", help="control period (%(default)s)")
    add("--rounds", type=int, default=3, metavar="N", help="repetitions (%(default)s)")
    add("--out", type=Path, default=Path("runs/bench_loop"), metavar="DIR", help="(%(default)s)")
    add("--quiet", action="store_true", help="no progress bar")
    return parser
