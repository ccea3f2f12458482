"""The heart among balls, 21 pairs, beside Pink's barriers, mink's limit and PlaCo's constraint.

``python -m benchmarks collisions`` prints the table. All keep the same capsules (PlaCo: cylinders,
since it reads them from a URDF) from the same balls, with the same gain and distance.
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np

import iiwa_dnn
from benchmarks.control import LOOPS, measure_steps
from iiwa_dnn.robot.collision import collision_model
from iiwa_dnn.studies.runs import paper_robot
from tests.export_settings import BALLS, DISTANCE, RADII

_NAMES = ("iiwa_dnn, with q + dt dq", "PlaCo", "Pink, daqp", "mink, daqp")


def read_arguments(
    prog: str, about: str | None, steps: int, words: Sequence[str] | None
) -> tuple[int, dict[str, Path | None]]:
    """Return the number of steps, by default `steps`, and the peers' Python interpreters."""
    parser = argparse.ArgumentParser(prog, description=about)
    parser.add_argument("--steps", type=int, default=steps, help="number of steps of each scene")
    for name, key in (("PlaCo", "placo"), ("mink", "mink")):
        help_text = f"Python interpreter with {name}"
        parser.add_argument(f"--{key}-python", type=Path, dest=key, help=help_text)
    options = vars(parser.parse_args(words))
    return options.pop("steps"), options


def bench_collisions(arguments: Sequence[str] | None = None, prog: str = "collisions") -> int:
    """Measure and print a table; returns 0."""
    count, pythons = read_arguments(prog, bench_collisions.__doc__, 10_000, arguments)
    robot = paper_robot()
    moving = [c for c in collision_model(robot).capsules if not c.link.endswith("_0")]
    scene = {
        "links": [c.link for c in moving],
        "a": [c.a for c in moving],
        "b": [c.b for c in moving],
        "radii": [c.radius for c in moving],
        "balls": BALLS,
        "ball_radii": RADII,
        "distance": DISTANCE,
    }
    loops = [loop for loop in LOOPS if loop.name in _NAMES]
    rows, missing = measure_steps(count, 1e-3, pythons, scene=scene, loops=loops)
    balls = list(map(iiwa_dnn.Sphere, BALLS, RADII))
    judge = iiwa_dnn.CollisionAvoidance(balls, self_collision=False).scene(robot)
    print(f"{len(judge.pairs)} pairs, {count} steps of 1 ms, distance {DISTANCE} m")
    print("| loop | median [us] | p99 [us] | error [m] | least distance [m] | variation [rad] |")
    print("| --- | --- | --- | --- | --- | --- |")
    for row in rows:
        q = np.array(row["q"])
        near = judge.nearest(q, np.zeros(len(q)))[0].min()
        varied = np.abs(np.diff(q, n=2, axis=0)).sum()
        print(
            f"| {row['name']} | {row['median_us']:.1f} | {row['p99_us']:.1f} | "
            f"{row['max_position_error_m']:.2g} | {near:.6f} | {varied:.3g} |"
        )
    if missing:
        print(f"not measured: {', '.join(missing)}")
    return 0
