"""``python -m benchmarks`` and a name of `COMMANDS`: measure."""

import sys

from benchmarks.arms import bench_arms
from benchmarks.arrivals import bench_arrivals
from benchmarks.cli import bench_loop, bench_solvers, bench_targets
from benchmarks.collisions import bench_collisions
from benchmarks.exports import bench_export
from benchmarks.poses import bench_poses
from benchmarks.proofs import bench_proof
from benchmarks.sizes import bench_sizes

COMMANDS = {
    "solvers": bench_solvers,
    "loop": bench_loop,
    "targets": bench_targets,
    "collisions": bench_collisions,
    "arms": bench_arms,
    "arrivals": bench_arrivals,
    "export": bench_export,
    "poses": bench_poses,
    "proof": bench_proof,
    "sizes": bench_sizes,
}

if __name__ == "__main__":
    name = sys.argv[1] if len(sys.argv) > 1 else ""
    if name not in COMMANDS:
        sys.exit(f"benchmarks: error: name one of {', '.join(COMMANDS)}")
    sys.exit(COMMANDS[name](sys.argv[2:], prog=f"benchmarks {name}"))
