"""Time of a step of `Controller` by what it has to do, beside the stalls of the machine.

    python -m benchmarks.rates [steps of each kind]

The iiwa 7 at 1 ms, after `Controller.warm_up`, every step in closed loop. Joints at 0.02 rad/s are
too slow for the heart. The last line is a loop that only reads the clock, for as long as the
longest kind takes: its longest reading is a stall of the machine, not of a step.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

import iiwa_dnn
from iiwa_dnn import (
    AccelerationLimits,
    CollisionAvoidance,
    DoubleIndicator,
    JerkLimits,
    MovingTarget,
    Reference,
    Robot,
    Scheme,
    Sphere,
    Target,
)
from iiwa_dnn.control.policies import Action, Policy
from iiwa_dnn.results.markdown import markdown_table
from iiwa_dnn.schemes import PoseTask
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.runs import paper_robot
from tests.export_settings import BALLS, DISTANCE, RADII
from tests.targets import STREAMS

DT = 1e-3
STEPS = 20_000
SLOW = 0.02  # velocity limit [rad/s]
EVERY = 33  # steps between two poses of a moving target

Targets = Callable[[int], Target | None]


class Case(NamedTuple):
    """A controller and what it is asked.

    Attributes:
        robot: The robot.
        scheme: The scheme.
        reference: The reference; None where every step gets a target.
        targets: Target of each step; None: the reference's.
        policy: The policy.
        start: Joint positions at the start [rad], (n,).
    """

    robot: Robot
    scheme: Scheme
    reference: Reference | None = None
    targets: Targets = lambda k: None
    policy: Policy = "slow"
    start: tuple[float, ...] = tuple(paper.START)


def stream(robot: Robot, kind: str) -> Targets:
    """Return the targets of a kind of `benchmarks.targets`, in turn."""
    poses = STREAMS[kind](robot, np.random.default_rng(1), 10**9, DT)

    def target(k: int) -> Target:
        position, rotation = next(poses)
        return Target(position, rotation)

    return target


def moved(reference: MovingTarget, heart: Reference) -> Targets:
    """Return a function that moves a reference to the heart's poses at 30 Hz."""

    def target(k: int) -> None:
        if k % EVERY == 0:
            pose = heart.at(k * DT)
            reference.set(pose.position, pose.rotation)

    return target


def scheme(*limits: object) -> Scheme:
    """Return the paper's scheme with further limits."""
    return DoubleIndicator(extra_limits=limits)


def cases() -> dict[str, Case]:
    """Return the kinds of steps."""
    robot = paper_robot()
    slow = robot.with_limits(velocity=SLOW)
    start = iiwa_dnn.Configuration(robot, paper.START)
    heart = iiwa_dnn.Heart().anchored(start)
    acceleration = AccelerationLimits(5.0)
    both = (acceleration, JerkLimits(50.0))
    balls = [Sphere(at, radius) for at, radius in zip(BALLS, RADII, strict=True)]
    avoidance = CollisionAvoidance(balls, distance=DISTANCE)
    own = MovingTarget(start)
    far = Target(start.position + [1e9, 0.0, 0.0], start.rotation)
    above = np.array(paper.START)
    above[3] = robot.q_upper[3] + 0.05
    plain = scheme()
    found = {
        "the heart": Case(robot, plain, heart),
        "a limit active": Case(robot.with_limits(velocity=0.1), plain, heart),
        "a pose task": Case(robot, Scheme(plain.costs, [PoseTask()], plain.limits), heart),
        "`MovingTarget`, set anew at 30 Hz": Case(robot, plain, own, moved(own, heart)),
        "acceleration limits": Case(robot, scheme(acceleration), heart),
        "acceleration and jerk limits": Case(robot, scheme(*both), heart),
        "21 pairs of collisions": Case(robot, scheme(avoidance), heart),
        "start outside a limit": Case(robot, plain, heart, start=tuple(above)),
        "target 1e9 m away": Case(robot, plain, None, lambda k: far),
    }
    policies: tuple[Policy, ...] = ("slow", "relax", "stop")
    for policy in policies:
        found[f"no solution, `{policy}`"] = Case(slow, plain, heart, policy=policy)
    for kind in ("jumps", "out of reach", "singular", "reversals"):
        found[f"{kind}"] = Case(robot, plain, None, stream(robot, kind))
        found[f"{kind}, acceleration and jerk"] = Case(
            robot, scheme(*both), None, stream(robot, kind)
        )
        found[f"{kind}, acceleration and 21 pairs"] = Case(
            robot, scheme(acceleration, avoidance), None, stream(robot, kind)
        )
    return found


def times(case: Case, steps: int) -> tuple[np.ndarray, float]:
    """Return the times of steps [us], (steps,), and the share of them that had to yield."""
    robot, built, reference, targets, policy, start = case
    controller = iiwa_dnn.Controller(robot, built, reference, dt=DT, policy=policy)
    q = np.array(start)
    controller.warm_up(q)
    taken = np.empty(steps)
    yielded = 0
    for k in range(steps):
        target = targets(k)
        began = time.perf_counter_ns()
        command = controller.step(q, k * DT, target)
        taken[k] = time.perf_counter_ns() - began
        q = q + DT * command.dq
        yielded += command.action is not Action.NONE
    return 1e-3 * taken, yielded / steps


def stalls(seconds: float) -> np.ndarray:
    """Return the times between readings of the clock [us], (k,)."""
    taken = []
    until = time.perf_counter_ns() + 1e9 * seconds
    now = 0.0
    while now < until:
        began = time.perf_counter_ns()
        now = time.perf_counter_ns()
        taken.append(now - began)
    return 1e-3 * np.array(taken)


def percentiles(taken: np.ndarray) -> list[str]:
    """Return median, p99, p99.9 and longest of times, in words."""
    return [f"{value:.1f}" for value in np.percentile(taken, [50.0, 99.0, 99.9, 100.0])]


def main(steps: int = STEPS) -> None:
    """Print the table."""
    rows = []
    longest = 0.0
    for name, case in cases().items():
        taken, share = times(case, steps)
        longest = max(longest, 1e-6 * taken.sum())
        rows.append((name, f"{100.0 * share:.1f}", *percentiles(taken)))
    rows.append(("only the clock", "", *percentiles(stalls(longest))))
    head = ("step", "yielding %", "median µs", "p99 µs", "p99.9 µs", "longest µs")
    print(markdown_table(head, rows))


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
