"""``python -m benchmarks``, a name and options: measure, and print tables in Markdown.

``loop`` measures steps of every kind, beside PlaCo, Pink and mink; ``solvers`` the network beside
QP solvers; ``export`` controllers in C; ``arrivals`` a shield's beside Ruckig's; ``sns`` saturation
in the null space; ``coworker`` an arm beside a person; ``cuda`` shields of many arms on a GPU;
``figures`` all but that, the heart, the paper's tables, the league of networks and hostile motion:
every figure that the pages quote.
Filters of commands have `benchmarks.hostile`.
"""

import argparse
import sys
from pathlib import Path

from benchmarks.report import machine


def main() -> int:
    """Carry out one of the commands; returns the exit code."""
    parser = argparse.ArgumentParser("python -m benchmarks", description=__doc__)
    commands = ("loop", "solvers", "export", "arrivals", "sns", "coworker", "cuda", "figures")
    parser.add_argument("command", choices=commands)
    parser.add_argument("--steps", type=int, default=10_000, help="number of steps of a kind")
    for library in ("placo", "mink"):
        words = f"Python interpreter of an environment with {library}"
        parser.add_argument(f"--{library}-python", type=Path, dest=library, help=words)
    options = parser.parse_args()
    pythons = {"placo": options.placo, "mink": options.mink}
    print(machine(), flush=True)
    if options.command in ("loop", "figures"):
        from benchmarks import kinds, loop, runs

        loop.report(options.steps, pythons)
        kinds.report(options.steps)
        runs.report()
    if options.command in ("solvers", "figures"):
        from benchmarks import solvers  # the peers are in an extra

        solvers.report(options.steps)
    if options.command in ("export", "figures"):
        from benchmarks import export

        export.report(options.steps)
    if options.command in ("arrivals", "figures"):
        from benchmarks import arrivals

        arrivals.report()
    if options.command in ("sns", "figures"):
        from benchmarks import sns

        sns.report()
    if options.command in ("coworker", "figures"):
        from benchmarks import coworker

        coworker.report()
    if options.command == "cuda":
        from benchmarks import cuda

        cuda.report()
    if options.command == "figures":
        from benchmarks import figures

        return figures.report(options.steps)
    return 0


if __name__ == "__main__":
    sys.exit(main())
