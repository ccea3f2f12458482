"""The commands with a report: options, measurements, report."""

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tyro
from tqdm import tqdm

from iiwa_dnn import checks
from iiwa_dnn.app.command_line import guard
from iiwa_dnn.errors import MissingDependencyError
from iiwa_dnn.files import prepare_folder


@dataclass(frozen=True)
class BenchOptions:
    """Options of every measurement that leaves a folder."""

    out: Path = Path("runs/bench")  # folder of the results
    quiet: bool = False  # print nothing but where the report is


@dataclass(frozen=True)
class BenchSettings(BenchOptions):
    """Measure this package's solver beside DAQP, quadprog, PIQP, ProxQP and OSQP."""

    steps: int = 5000  # number of steps in a stream of programs
    cold: int = 1000  # number of random programs of each size


@dataclass(frozen=True)
class BenchLoopSettings(BenchOptions):
    """Measure the control loop beside its peers', whole runs, start-up and memory."""

    out: Path = Path("runs/bench_loop")  # folder of the results
    steps: int = 10_000  # number of steps beside the peers
    period: float = 1e-3  # control period of these steps [s]
    placo_python: Path | None = None  # Python interpreter of an environment with PlaCo
    mink_python: Path | None = None  # Python interpreter with mink; by default this one
    drake_python: Path | None = None  # Python interpreter of an environment with Drake
    duration: float = 10.0  # length of a whole run [s]
    dt: float = 1e-4  # control period of a whole run [s]
    rounds: int = 3  # number of repetitions of all that is not a step


def _solvers(options: BenchSettings) -> int:
    for name in ("steps", "cold"):
        checks.integer(f"--{name}", getattr(options, name), 50)
    folder = prepare_folder(options.out)
    # Here, since the peers are in an extra.
    from benchmarks.measurement import CHUNK, measure_known, measure_stream
    from benchmarks.peers import PEERS
    from benchmarks.report import environment, save_report, verdict
    from benchmarks.streams import all_streams

    streams = all_streams(options.steps, options.cold)
    rounds = sum(-(-len(stream.programs) // CHUNK) for stream in streams) * len(PEERS)
    measured: list[dict[str, Any]] = []
    # Solvers that fail say so in many ways; here it is counted.
    with warnings.catch_warnings(), tqdm(total=rounds, unit="chunk", disable=options.quiet) as bar:
        warnings.simplefilter("ignore")
        for stream in streams:
            rows = measure_stream(stream, PEERS, bar.update)
            measured.append(
                {"name": stream.name, "about": stream.about, "warm": stream.warm, "rows": rows}
            )
    share = options.cold / 1000
    known = measure_known(int(10_000 * share), int(1000 * share), int(200 * share))
    results = {
        "environment": environment(),
        "streams": measured,
        "known": known,
    }
    written = save_report(results, folder)
    if not options.quiet:
        for entry in measured:
            print(f"{entry['name']:20} {verdict(entry['rows'])}")
    print(written[0])
    return 0


def _loop(options: BenchLoopSettings) -> int:
    checks.integer("--steps", options.steps, 50)
    checks.integer("--rounds", options.rounds, 1)
    checks.positive("--duration", options.duration)
    checks.positive("--dt", options.dt)
    checks.positive("--period", options.period)
    folder = prepare_folder(options.out)
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
            "placo": options.placo_python,
            "mink": options.mink_python,
            "pydrake": options.drake_python,
        }
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
        "profile": profile_step(options.dt, min(options.steps, 2000)),
        "startup": measure_startup(options.rounds),
        "memory": measure_memory(0.2 * options.duration),
    }
    print(save_loop_report(results, folder)[0])
    return 0


def _command(kind: type[Any], run: Callable[[Any], int], name: str) -> Callable[..., int]:
    """Return a command: its words (None: the process's own) and its name in messages to code."""

    def command(arguments: Sequence[str] | None = None, prog: str = f"bench_{name}") -> int:
        return guard(prog, lambda: run(tyro.cli(kind, args=arguments, prog=prog)))

    return command


bench_solvers = _command(BenchSettings, _solvers, "solvers")
bench_loop = _command(BenchLoopSettings, _loop, "loop")
