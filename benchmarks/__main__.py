"""``python -m benchmarks`` and a name of `COMMANDS`: measure."""

import sys

from benchmarks.cli import bench_loop, bench_solvers
from benchmarks.collisions import bench_collisions
from benchmarks.exports import bench_export

COMMANDS = {
    "solvers": bench_solvers,
    "loop": bench_loop,
    "collisions": bench_collisions,
    "export": bench_export,
}

if __name__ == "__main__":
    name = sys.argv[1] if len(sys.argv) > 1 else ""
    if name not in COMMANDS:
        sys.exit(f"benchmarks: error: name one of {', '.join(COMMANDS)}")
    sys.exit(COMMANDS[name](sys.argv[2:], prog=f"benchmarks {name}"))
