"""The script that measures this package's solver beside others: arguments and exit codes."""

from __future__ import annotations

import argparse
import sys
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tqdm import tqdm

from iiwa_dnn import checks
from iiwa_dnn.cli import Parser
from iiwa_dnn.exceptions import IiwaDnnError
from iiwa_dnn.files import prepare_folder


def bench_solvers(arguments: Sequence[str] | None = None) -> int:
    """Measure all solvers on all streams and write the report.

    Args:
        arguments: Command line without the program's name; None takes the process's own.

    Returns:
        The exit code: 0 done, 2 bad input or something is missing.
    """
    options = _parser().parse_args(arguments)
    try:
        for name in ("steps", "cold", "batch"):
            checks.integer(f"--{name}", getattr(options, name), 50)
        folder = prepare_folder(options.out)
        _run(options, folder)
    except IiwaDnnError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


def _run(options: argparse.Namespace, folder: Path) -> None:
    # Here, since the peers are in an extra.
    from iiwa_dnn.benchmarks.measurement import (
        CHUNK,
        measure_batch,
        measure_known,
        measure_stream,
    )
    from iiwa_dnn.benchmarks.peers import PEERS
    from iiwa_dnn.benchmarks.report import environment, save_report, verdict
    from iiwa_dnn.benchmarks.streams import all_streams

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
    batch = measure_batch(streams[0].programs, options.batch)
    about = (
        f"{options.batch} programs of the heart, limits idle, from a cold start, over all cores."
    )
    share = options.cold / 1000
    known = measure_known(int(10_000 * share), int(1000 * share), int(200 * share))
    results = {
        "environment": environment(),
        "streams": measured,
        "batch": {"about": about, "rows": batch},
        "known": known,
    }
    written = save_report(results, folder)
    if not options.quiet:
        for entry in measured:
            print(f"{entry['name']:20} {verdict(entry['rows'])}")
    print(written[0])


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="bench_solvers.py",
        description="Measure this package's solver beside others and write a report.",
    )
    add = parser.add_argument
    add("--steps", type=int, default=5000, metavar="N", help="steps of a stream (%(default)s)")
    add(
        "--cold", type=int, default=1000, metavar="N",
        help="random programs of each size; the programs known by construction go with it "
        "(%(default)s)",
    )  # fmt: skip
    add("--batch", type=int, default=100_000, metavar="N", help="size of the batch (%(default)s)")
    add("--out", type=Path, default=Path("runs/bench"), metavar="DIR", help="(%(default)s)")
    add("--quiet", action="store_true", help="no progress bar, no summary")
    return parser
