"""``bench``: this package's solver measured beside others."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

from tqdm import tqdm

from benchmarks.settings import BenchSettings
from iiwa_dnn import checks
from iiwa_dnn.app.command_line import list_files, run_command
from iiwa_dnn.app.folders import claim_folder, save_settings


def bench_solvers(arguments: Sequence[str] | None = None, prog: str = "bench_solvers") -> int:
    """Measure all solvers on all streams and write the report.

    Args:
        arguments: Command line without the program's name; None takes the process's own.
        prog: What the command is called in messages.

    Returns:
        The exit code: 0 done, 2 bad input or something is missing.
    """
    return run_command(BenchSettings, prog, _bench, arguments)


def _bench(options: BenchSettings) -> int:
    for name in ("steps", "cold", "batch"):
        checks.integer(f"--{name}", getattr(options, name), 50)
    folder = claim_folder(options)
    # Here, since the peers are in an extra.
    from benchmarks.measurement import (
        CHUNK,
        measure_batch,
        measure_known,
        measure_stream,
    )
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
    save_settings(options, folder)
    if options.verbose:
        list_files(folder)
    return 0
