"""Time of a step of `Controller` by what it has to do: targets that move, and no solution.

    python -m benchmarks.rates

The iiwa 7 at 1 ms, the first steps left out. Joints at 0.02 rad/s are too slow for the heart.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np

import iiwa_dnn
from iiwa_dnn import AccelerationLimits, DoubleIndicator, JerkLimits, MovingTarget, Reference, Robot
from iiwa_dnn.results.markdown import markdown_table
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.runs import paper_robot

DT = 1e-3
STEPS = 4000
FIRST = 200
SLOW = 0.02  # velocity limit [rad/s]
EVERY = 33  # steps between two poses of a moving target
_ACCELERATION = (AccelerationLimits(5.0),)
_BOTH = (*_ACCELERATION, JerkLimits(50.0))


def times(robot: Robot, reference: Reference, limits: tuple[Any, ...], policy: Any) -> np.ndarray:
    """Times of steps [us], (STEPS - FIRST,); a `MovingTarget` gets the heart's poses."""
    scheme = DoubleIndicator(extra_limits=limits)
    controller = iiwa_dnn.Controller(robot, scheme, reference, dt=DT, policy=policy)
    controller.warm_up()
    q = np.array(paper.START)
    heart = iiwa_dnn.Heart().anchored(iiwa_dnn.Configuration(robot, q))
    taken = []
    for k in range(STEPS):
        if isinstance(reference, MovingTarget) and k % EVERY == 0:
            target = heart.at(k * DT)
            reference.set(target.position, target.rotation)
        began = time.perf_counter_ns()
        command = controller.step(q, k * DT)
        taken.append((time.perf_counter_ns() - began) / 1e3)
        q = q + DT * command.dq
    return np.array(taken[FIRST:])


def main() -> None:
    """Print the table."""
    robot = paper_robot()
    slow = robot.with_limits(velocity=SLOW)
    start = iiwa_dnn.Configuration(robot, paper.START)
    heart = iiwa_dnn.Heart().anchored(start)
    smooth = MovingTarget(start, acceleration=1.0, jerk=10.0)
    cases: dict[str, tuple[Robot, Reference, tuple[Any, ...], str]] = {
        "a path by formula": (robot, heart, (), "slow"),
        "the same, with acceleration limits": (robot, heart, _ACCELERATION, "slow"),
        "`MovingTarget`, set anew at 30 Hz": (robot, MovingTarget(start), (), "slow"),
        "`MovingTarget` with acceleration and jerk": (robot, smooth, (), "slow"),
        "no solution, `slow`": (slow, heart, (), "slow"),
        "no solution, `relax`": (slow, heart, (), "relax"),
        "no solution, `stop`": (slow, heart, (), "stop"),
        "no solution, `slow`, acceleration limits": (slow, heart, _ACCELERATION, "slow"),
        "no solution, `slow`, acceleration and jerk": (slow, heart, _BOTH, "slow"),
    }
    rows = []
    for name, case in cases.items():
        taken = times(*case)
        rows.append((name, f"{np.median(taken):.1f}", f"{np.percentile(taken, 99):.1f}"))
    print(markdown_table(("step", "median µs", "p99 µs"), rows))


if __name__ == "__main__":
    main()
