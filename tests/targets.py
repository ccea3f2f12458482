"""Streams of targets that no arm can simply follow, and a loop that drives an arm towards them."""

import math
import time
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import iiwa_dnn
import iiwa_dnn.control.policies
from iiwa_dnn import Configuration, Robot, Target

FAR = 1.5
"""Distance from the base [m] beyond which none of the arms reaches; `out_of_reach` asks for 2 m."""

Array = NDArray[np.float64]
Pose = tuple[Array, Array]
Stream = Callable[[Robot, np.random.Generator, int, float], Iterator[Pose]]


def jumps(robot: Robot, rng: np.random.Generator, steps: int, dt: float) -> Iterator[Pose]:
    """Poses of random postures, each held for 0.3 to 3 s."""
    left = 0
    pose = _pose(robot, _posture(robot, rng))
    for _ in range(steps):
        if left == 0:
            left = int(rng.uniform(0.3, 3.0) / dt)
            pose = _pose(robot, _posture(robot, rng))
        left -= 1
        yield pose


def teleoperation(robot: Robot, rng: np.random.Generator, steps: int, dt: float) -> Iterator[Pose]:
    """A hand's motion of up to 0.3 m/s, known every 33 ms only."""
    start, turn = _pose(robot, robot.start_posture())
    place = start
    w = rng.uniform(0.5, 4.0, (3, 3))
    phase = rng.uniform(0.0, 2.0 * np.pi, (3, 3))
    period = max(1, round(1.0 / (30.0 * dt)))
    for k in range(steps):
        if k % period == 0:
            place = start + (0.02 * (np.sin(w * dt * k + phase) - np.sin(phase))).sum(axis=1)
        yield place, turn


def sinusoids(robot: Robot, rng: np.random.Generator, steps: int, dt: float) -> Iterator[Pose]:
    """The tip of joints that swing at their velocity limits."""
    q0 = robot.start_posture()
    amplitude = 0.3 * np.minimum(robot.q_upper - q0, q0 - robot.q_lower)
    w = rng.uniform(0.5, 1.2, robot.dof) * robot.dq_max / amplitude
    for k in range(steps):
        yield _pose(robot, q0 + amplitude * np.sin(w * dt * k))


def out_of_reach(robot: Robot, rng: np.random.Generator, steps: int, dt: float) -> Iterator[Pose]:
    """In turn a pose beyond the arm's reach and its start, each held for 1 to 4 s."""
    home = _pose(robot, robot.start_posture())
    left = 0
    away = False
    pose = home
    for _ in range(steps):
        if left == 0:
            left = int(rng.uniform(1.0, 4.0) / dt)
            away = not away
            direction = rng.normal(size=3)
            far = 2.0 * direction / np.linalg.norm(direction)
            pose = (far, home[1]) if away else home
        left -= 1
        yield pose


def singular(robot: Robot, rng: np.random.Generator, steps: int, dt: float) -> Iterator[Pose]:
    """In turn the pose of a stretched arm and its start, approached in 2 s each."""
    q0 = robot.start_posture()
    stretched = np.clip(np.where(np.arange(robot.dof) % 2, 0.02, q0), robot.q_lower, robot.q_upper)
    for k in range(steps):
        share = 0.5 - 0.5 * np.cos(0.5 * np.pi * k * dt)
        yield _pose(robot, q0 + share * (stretched - q0))


def reversals(robot: Robot, rng: np.random.Generator, steps: int, dt: float) -> Iterator[Pose]:
    """A line at 0.4 m/s that turns round within one step."""
    place, turn = _pose(robot, robot.start_posture())
    direction = rng.normal(size=3)
    direction /= np.linalg.norm(direction)
    for k in range(steps):
        yield place + direction * (0.1 - abs((0.4 * k * dt + 0.1) % 0.4 - 0.2)), turn


STREAMS: dict[str, Stream] = {
    "jumps": jumps,
    "teleoperation": teleoperation,
    "sinusoids": sinusoids,
    "out of reach": out_of_reach,
    "singular": singular,
    "reversals": reversals,
}


class Drive(NamedTuple):
    """A driven stream.

    Attributes:
        q: Joint positions [rad], (N+1, n).
        actions: `Action` of each step, (N,).
        us: Time of each step [us], (N,).
        error: Distance of the tip from the raw target [m], (N,).
        filtered: Distance of the tip from the filtered target [m], (N,).
        within: Whether the target is within the arm's reach, (N,).
        room: Least distance of a program's bounds [rad/s]; negative: one is infeasible by them.
    """

    q: Array
    actions: NDArray[np.int8]
    us: Array
    error: Array
    filtered: Array
    within: NDArray[np.bool_]
    room: float


def drive(
    robot: Robot,
    scheme: iiwa_dnn.Scheme,
    poses: Iterator[Pose],
    steps: int,
    dt: float,
    q0: Array,
    filtered: bool,
    policy: iiwa_dnn.control.policies.Policy = "slow",
) -> Drive:
    """Drive an arm towards a stream of poses, with or without the filter of `MovingTarget`."""
    start = Configuration(robot, q0)
    hand = iiwa_dnn.MovingTarget(start)
    controller = iiwa_dnn.Controller(
        robot, scheme, hand if filtered else None, dt=dt, policy=policy
    )
    controller.warm_up(q0)
    hand = iiwa_dnn.MovingTarget(start)
    if filtered:
        controller.reference = hand
    q = np.empty((steps + 1, robot.dof))
    q[0] = q0
    actions = np.zeros(steps, np.int8)
    us = np.empty(steps)
    error = np.empty(steps)
    behind = np.empty(steps)
    room = np.inf
    within = np.empty(steps, bool)
    last = None
    target = None
    for k, (place, turn) in zip(range(steps), poses, strict=False):
        if place is not last:  # many are held for a while
            last = place
            if filtered:
                hand.set(place, turn)
            else:
                target = Target.from_data(np.concatenate([place, turn.ravel(), np.zeros(6)]))
        began = time.perf_counter_ns()
        command = controller.step(q[k], k * dt, target)
        us[k] = 1e-3 * (time.perf_counter_ns() - began)
        q[k + 1] = q[k] + dt * command.dq
        actions[k] = command.action
        tip = command.placement[9:]
        qp = command.qp
        room = min(room, float((qp.ub - qp.lb).min()))
        error[k] = math.dist(tip, place)
        behind[k] = math.dist(tip, command.targets[0, :3])
        within[k] = math.hypot(*place) < FAR
    return Drive(q, actions, us, error, behind, within, room)


def longest_freeze(driven: Drive, dt: float) -> tuple[float, int]:
    """Longest time [s] in which the arm stands though a target within reach is 1 mm away or more.

    Returns:
        The time, and the step at which it ends.
    """
    still = np.abs(np.diff(driven.q, axis=0)).max(axis=1) < 1e-4 * dt
    frozen = np.concatenate([[0], still & driven.within & (driven.filtered > 1e-3), [0]])
    edges = np.flatnonzero(np.diff(frozen)).reshape(-1, 2)
    if not edges.size:
        return 0.0, 0
    longest = edges[np.diff(edges).argmax()]
    return dt * float(longest[1] - longest[0]), int(longest[1])


def scheme(jerk: float | None, acceleration: float | None = None) -> iiwa_dnn.Scheme:
    """Return the paper's scheme with limits: the robot's accelerations and a jerk [rad/s^3]."""
    limits = [iiwa_dnn.AccelerationLimits(acceleration)]
    if jerk is not None:
        limits.append(iiwa_dnn.JerkLimits(jerk))
    return iiwa_dnn.DoubleIndicator(extra_limits=tuple(limits))


def _posture(robot: Robot, rng: np.random.Generator) -> Array:
    lower = np.maximum(robot.q_lower, -3.0)
    upper = np.minimum(robot.q_upper, 3.0)
    return rng.uniform(0.9 * lower + 0.1 * upper, 0.1 * lower + 0.9 * upper)


def _pose(robot: Robot, q: Array) -> Pose:
    conf = Configuration(robot, q)
    return conf.position.copy(), conf.rotation.copy()
