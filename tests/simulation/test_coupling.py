"""Joints that are coupled, as by a linkage, under targets that no arm can follow."""

import warnings
from typing import Any

import numpy as np
import pytest

import iiwa_dnn as d
from helpers_simulation import driven
from iiwa_dnn.step.policies import ProgramKind
from judge_limits import breaches

START = np.array([0.0, 0.6, 0.0, -1.2, 0.0, 0.6, 0.0])


@pytest.mark.parametrize("policy", ["slow", "relax"])
@pytest.mark.parametrize("limits", [(), ("acceleration",), ("acceleration", "jerk")], ids=len)
def test_a_task_that_yields_does_not_pull_the_linkage_apart(policy: Any, limits: Any) -> None:
    # Where one joint brakes at its limit, harder than the other can, it was apart by 0.5 rad.
    robot = d.load_robot("iiwa7").with_limits(acceleration=5.0, jerk=500.0)
    parts = {"acceleration": d.AccelerationLimits(), "jerk": d.JerkLimits()}
    coupling = d.JointCouplingTask({"iiwa7_joint_4": 1.0, "iiwa7_joint_2": -0.5}, -1.5)
    tasks = [d.PositionTask(), coupling]
    scheme = d.Scheme([d.CyclicMotion()], tasks, [d.JointLimits(), *map(parts.get, limits)])
    controller = d.Controller(robot, scheme, policy=policy)
    rng = np.random.default_rng(3)
    q = START
    for k in range(3000):
        if k % 400 == 0:
            far = d.Configuration(robot, rng.uniform(robot.q_lower, robot.q_upper)).position
        if k == 2700:
            controller.halt()
        q = q + 1e-3 * controller.step(q, 1e-3 * k, d.Target(far)).dq
        assert abs(q[3] - 0.5 * q[1] + 1.5) < 1e-6


DT = 5e-3
PAIRS = {
    "ur5": ("shoulder_lift_joint", "elbow_joint"),
    "panda": ("panda_joint2", "panda_joint4"),
    "iiwa7_dual": ("left_iiwa7_joint_2", "right_iiwa7_joint_2"),
}


def coupled(name: str, off: float, jerk: float = np.inf, **options: Any) -> Any:
    """A controller of an arm whose joints begin off a relation, beside a ball; and its target."""
    robot = d.load_robot(name).with_limits(acceleration=10.0, jerk=jerk)
    start = d.Configuration(robot, robot.start_posture())
    pair = PAIRS[name]
    offset = sum(start.q[robot.joint_names.index(each)] for each in pair) + off
    tasks = [
        d.PositionTask(weight=1.0),
        d.JointCouplingTask(dict.fromkeys(pair, 1.0), offset=offset, gain=5.0),
    ]
    rates = [d.AccelerationLimits(), *[d.JerkLimits()] * (jerk < np.inf)]
    away = start.position * [1.0, 1.0, 0.0] / np.linalg.norm(start.position[:2])
    ball = d.Sphere(start.position + 0.3 * away, 0.1)
    limits = [d.JointLimits(), *rates, d.CollisionAvoidance([ball], distance=0.02)]
    scheme = d.Scheme([d.KineticEnergy()], tasks, limits)
    target = d.Target(start.position + 0.2 * away, start.rotation)
    return d.Controller(robot, scheme, dt=DT, **options), start.q, target


@pytest.mark.parametrize("jerk", [np.inf, 2000.0])
@pytest.mark.parametrize("name", PAIRS)
@pytest.mark.parametrize("off", [1e-6, -0.5])
def test_a_halted_arm_at_rest_does_not_move(name: str, off: float, jerk: float) -> None:
    # It accelerated to 1.46 rad/s, by the rows of the relation that its joints began off.
    controller, q, target = coupled(name, off, jerk)
    controller.halt()
    path, commands = driven(controller, q, 100, target)
    np.testing.assert_array_equal(path, np.tile(q, (101, 1)))
    assert {command.kind for command in commands} == {ProgramKind.STOPPED}


@pytest.mark.parametrize("jerk", [np.inf, 2000.0])
@pytest.mark.parametrize("name", PAIRS)
@pytest.mark.parametrize("off", [1e-5, 0.1, -1.0])
def test_joints_that_begin_off_a_relation_come_to_it(name: str, off: float, jerk: float) -> None:
    controller, q, target = coupled(name, off, jerk)
    path, commands = driven(controller, q, 1000, target)
    robot = controller.robot
    assert breaches(path, DT, *robot.limits) == []
    avoidance = controller.scheme.limits[-1]
    assert avoidance.scene(robot).nearest(path, np.zeros(len(path)))[0].min() > 0.02 - 1e-9
    lacking = [controller.scheme.tasks[1].error(robot, each) for each in path]
    assert lacking[0] == pytest.approx(off)
    assert abs(lacking[-1]) < 1e-6
    said = [words for words in commands[0].active_limits if "off their JointCouplingTask" in words]
    assert said == [f"{' and '.join(PAIRS[name])}: {off:.3g} rad off their JointCouplingTask"]
    assert not any("JointCouplingTask" in words for words in commands[-1].active_limits)


def test_a_start_off_a_relation_is_said_once() -> None:
    controller, q, target = coupled("ur5", 0.25)
    with pytest.warns(
        UserWarning, match=r"shoulder_lift_joint and elbow_joint: 0\.25 rad off their"
    ):
        controller.step(q, 0.0, target)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        controller.step(q, DT, target)


@pytest.mark.parametrize("at", [20, 60])
def test_an_arm_that_is_halted_off_its_relation_slows_down(at: int) -> None:
    controller, q, target = coupled("ur5", -1.0)
    path, commands = driven(controller, q, at, target)
    assert np.abs(commands[-1].dq).max() > 0.1
    controller.halt()
    path, commands = driven(controller, path[-1], 200, target)
    speeds = np.abs([command.dq for command in commands])
    assert (np.diff(speeds, axis=0) <= 1e-15).all()
    assert not speeds[-1].any()


def test_a_halted_arm_outside_its_limits_stays_there() -> None:
    # The bounds that lead back into the range moved it.
    robot = d.load_robot("iiwa7").with_limits(acceleration=5.0)
    scheme = d.DoubleIndicator(orientation="none", extra_limits=(d.AccelerationLimits(),))
    q = START.copy()
    q[1] = robot.q_upper[1] + 0.1
    controller = d.Controller(robot, scheme, dt=DT)
    controller.halt()
    path, _ = driven(controller, q, 50, d.Target(d.Configuration(robot, START).position))
    np.testing.assert_array_equal(path, np.tile(q, (51, 1)))


def test_braking_from_a_velocity_that_others_chose_is_tested() -> None:
    """If the arm can stop, the stopping motion is stored from then on."""
    controller, q, target = coupled("ur5", 0.0)
    controller.step(q, 0.0, target)
    away = np.array([0.3, 0.0, 0.0, 0.0, 0.0, 0.2])
    controller.send(away)
    controller.send(away)
    controller.halt()
    controller.step(q, 0.0, target)
    assert controller._motion.stopping_periods == np.ceil(0.3 / (10.0 * DT)) - 1.0
