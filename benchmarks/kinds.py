"""Time of a step of `Controller` by what it has to do.

The iiwa 7 at 1 ms, after `Controller.warm_up`, every step in closed loop. Joints at 0.02 rad/s are
too slow for the heart.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

import iiwa_dnn
from benchmarks.loop import BALLS, DISTANCE, DT, RADII
from benchmarks.report import show
from hostile import streams
from iiwa_dnn import AccelerationLimits, MovingTarget, Reference, Robot, Scheme, Sphere, Target
from iiwa_dnn.schemes import PoseTask
from iiwa_dnn.step.policies import Action, Policy
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.runs import paper_robot

SLOW = 0.02  # velocity limit [rad/s]
EVERY = 33  # steps between two poses of a moving target

Targets = Callable[[int], Target | None]


class Case(NamedTuple):
    """A controller and what it is asked: targets of its reference, or others by the step."""

    robot: Robot
    scheme: Scheme
    reference: Reference | None = None
    targets: Targets = lambda k: None
    policy: Policy = "slow"


def stream(robot: Robot, kind: str) -> Targets:
    """Return the targets of a kind of `tests.hostile`, in turn."""
    target = streams(robot, np.random.default_rng(1))[kind]
    return lambda k: target(k * DT)


def moved(reference: MovingTarget, heart: Reference) -> Targets:
    """Return a function that moves a reference to the heart's poses at 30 Hz."""

    def target(k: int) -> None:
        if k % EVERY == 0:
            pose = heart.at(k * DT)
            reference.set(pose.position, pose.rotation)

    return target


def scheme(*limits: object) -> Scheme:
    """Return the paper's scheme with further limits."""
    return iiwa_dnn.DoubleIndicator(extra_limits=limits)


def cases() -> dict[str, Case]:
    """Return the kinds of steps."""
    robot = paper_robot()
    slow = robot.with_limits(velocity=SLOW)
    start = iiwa_dnn.Configuration(robot, paper.START)
    heart = iiwa_dnn.Heart().anchored(start)
    acceleration = AccelerationLimits(5.0)
    both = (acceleration, iiwa_dnn.JerkLimits(50.0))
    balls = [Sphere(at, radius) for at, radius in zip(BALLS, RADII, strict=True)]
    avoidance = iiwa_dnn.CollisionAvoidance(balls, distance=DISTANCE)
    own = MovingTarget(start)
    plain = scheme()
    found = {
        "the heart": Case(robot, plain, heart),
        "a limit active": Case(robot.with_limits(velocity=0.1), plain, heart),
        "a pose task": Case(robot, Scheme(plain.costs, [PoseTask()], plain.limits), heart),
        "`MovingTarget`, set anew at 30 Hz": Case(robot, plain, own, moved(own, heart)),
        "acceleration limits": Case(robot, scheme(acceleration), heart),
        "acceleration and jerk limits": Case(robot, scheme(*both), heart),
        "21 pairs of collisions": Case(robot, scheme(avoidance), heart),
    }
    policies: tuple[Policy, ...] = ("slow", "relax", "stop")
    for policy in policies:
        found[f"no solution, `{policy}`"] = Case(slow, plain, heart, policy=policy)
    for kind in ("jumps", "out of reach", "singular", "reversals"):
        found[kind] = Case(robot, plain, None, stream(robot, kind))
        found[f"{kind}, acceleration and jerk"] = Case(
            robot, scheme(*both), None, stream(robot, kind)
        )
        found[f"{kind}, acceleration and 21 pairs"] = Case(
            robot, scheme(acceleration, avoidance), None, stream(robot, kind)
        )
    return found


_COLUMNS = {
    "step": "{name}",
    "yielding %": "{yielding:.1f}",
    "most linear solves": "{linear_solves}",
    "median µs": "{median:.1f}",
    "p99 µs": "{p99:.1f}",
    "p99.9 µs": "{p999:.1f}",
    "longest µs": "{longest:.1f}",
}


def measure(case: Case, steps: int) -> dict[str, Any]:
    """Take steps; return percentiles of their times [us], linear solves, and how many yielded."""
    robot, built, reference, targets, policy = case
    controller = iiwa_dnn.Controller(robot, built, reference, dt=DT, policy=policy)
    q = np.array(paper.START)
    controller.warm_up(q)
    taken = np.empty(steps)
    yielded = 0
    linear_solves = 0
    for k in range(steps):
        target = targets(k)
        began = time.perf_counter_ns()
        command = controller.step(q, k * DT, target)
        taken[k] = time.perf_counter_ns() - began
        q = q + DT * command.dq
        yielded += command.action is not Action.NONE
        linear_solves = max(linear_solves, command.solution.iterations)
    times = 1e-3 * np.percentile(taken, [50.0, 99.0, 99.9, 100.0])
    found = dict(zip(("median", "p99", "p999", "longest"), times, strict=True))
    return {"yielding": 100.0 * yielded / steps, "linear_solves": linear_solves, **found}


def report(steps: int) -> None:
    """Print the table."""
    rows = ({"name": name} | measure(case, steps) for name, case in cases().items())
    show(f"A step of every kind, {steps} of each", _COLUMNS, rows)
