"""``bench-loop``: the control loop measured beside its peers', its start-up and its memory."""

from __future__ import annotations

from collections.abc import Sequence

from tqdm import tqdm

from benchmarks.settings import BenchLoopSettings
from iiwa_dnn import checks
from iiwa_dnn.app.command_line import list_files, run_command
from iiwa_dnn.app.folders import claim_folder, save_settings
from iiwa_dnn.errors import MissingDependencyError


def bench_loop(arguments: Sequence[str] | None = None, prog: str = "bench_loop") -> int:
    """Measure steps, runs, start-up and memory, and write the report.

    Args:
        arguments: Command line without the program's name; None takes the process's own.
        prog: What the command is called in messages.

    Returns:
        The exit code: 0 done, 2 bad input or something is missing.
    """
    return run_command(BenchLoopSettings, prog, _bench, arguments)


def _bench(options: BenchLoopSettings) -> int:
    checks.integer("--steps", options.steps, 50)
    checks.integer("--rounds", options.rounds, 1)
    checks.positive("--duration", options.duration)
    checks.positive("--dt", options.dt)
    checks.positive("--period", options.period)
    folder = claim_folder(options)
    try:
        from benchmarks.control import measure_own_part, measure_runs, measure_steps, profile_step
    except ImportError as error:
        remedy = 'pip install "iiwa-dnn[bench]"'
        raise MissingDependencyError(str(error.name), remedy) from error
    from benchmarks.loop_report import save_loop_report
    from benchmarks.process import measure_memory, measure_startup
    from benchmarks.report import environment

    with tqdm(total=options.steps, unit="step", disable=options.quiet) as bar:
        pythons = {
            "placo": options.placo_python, "mink": options.mink_python,
            "pydrake": options.drake_python,
        }  # fmt: skip
        steps, missing = measure_steps(options.steps, options.period, pythons, bar.update)
    results = {
        "environment": environment(("pin-pink",)),
        "dt": options.period,
        "steps": steps,
        "missing": missing,
        "own_part": measure_own_part(
            options.steps * options.period, options.period, options.rounds
        ),
        "runs": measure_runs(options.duration, options.dt, options.rounds),
        "profile": profile_step(options.dt),
        "startup": measure_startup(options.rounds),
        "memory": measure_memory(0.2 * options.duration),
    }
    print(save_loop_report(results, folder)[0])
    save_settings(options, folder)
    if options.verbose:
        list_files(folder)
    return 0
