"""A joint that follows another, as by a linkage, held to it by a coupling task."""

from __future__ import annotations

from typing import Any

import numpy as np
import pinocchio as pin
import pytest

from iiwa_dnn import (
    AccelerationLimits,
    Circle,
    Configuration,
    Controller,
    CyclicMotion,
    JointCouplingTask,
    JointLimits,
    KineticEnergy,
    Limit,
    PositionTask,
    Robot,
    Scheme,
    Target,
    compute_metrics,
    failures,
    load_robot,
    simulate,
)

SECOND, FOURTH = "iiwa7_joint_2", "iiwa7_joint_4"
MIMIC = f'<mimic joint="{SECOND}" multiplier="-0.5" offset="0.1"/>'
COUPLING = JointCouplingTask({FOURTH: 1.0, SECOND: 0.5}, 0.1)
COSTS = [KineticEnergy(weight=0.2), CyclicMotion(weight=0.8)]


def coupled() -> tuple[Robot, list[Limit]]:
    return load_robot("iiwa7"), [JointLimits()]


def posture(robot: Robot) -> np.ndarray:
    """Return the arm's start with the fourth joint where the second puts it."""
    q = robot.start_posture()
    q[3] = -0.5 * q[1] + 0.1
    return q


def test_the_coupling_holds_over_a_run_and_pinocchios_own_mimic_is_where_the_tip_is() -> None:
    robot, limits = coupled()
    q0 = posture(robot)
    circle = Circle(radius=0.02, period=2.0).anchored(Configuration(robot, q0))
    scheme = Scheme(COSTS, [PositionTask(), COUPLING], limits)
    record = simulate(robot, scheme, circle, q0, dt=1e-3, duration=2.0)
    assert failures(record) == []
    assert compute_metrics(record)["max_position_error_m"] < 1e-4
    assert np.ptp(record.q[:, 1]) > 1e-3
    np.testing.assert_allclose(record.q[:, 3], -0.5 * record.q[:, 1] + 0.1, rtol=0, atol=1e-9)
    # Pinocchio's own: six coordinates, the seventh joint follows.
    head = f'<joint name="{FOURTH}" type="revolute">'
    other = pin.buildModelFromXML(robot.urdf.replace(head, head + MIMIC), mimic=True)
    assert other.nq == 6
    data, tip = other.createData(), other.getFrameId(robot.tip)
    for k in (0, 700, 2000):
        pin.framesForwardKinematics(other, data, np.delete(record.q[k], 3))
        np.testing.assert_allclose(data.oMf[tip].translation, record.position[k], rtol=0, atol=1e-8)


@pytest.mark.parametrize("policy", ["slow", "relax"])
@pytest.mark.parametrize("limited", [False, True])
def test_a_task_that_yields_does_not_pull_the_linkage_apart(policy: Any, limited: bool) -> None:
    # With `relax`, or acceleration limits, it was commanded apart by up to 0.45 rad.
    robot, limits = coupled()
    limits += [AccelerationLimits(10.0)] * limited
    start = Configuration(robot, posture(robot))
    scheme = Scheme(COSTS, [PositionTask(), COUPLING], limits)
    controller = Controller(robot, scheme, policy=policy)
    q = start.q
    apart = []
    for k in range(1000):
        side = 0.5 if k % 500 < 250 else -0.3
        target = Target(start.position + [0.1, side, side], start.rotation)
        command = controller.step(q, 1e-3 * k, target)
        q = q + 1e-3 * command.dq
        apart.append(abs(q[3] + 0.5 * q[1] - 0.1))
    assert max(apart) < 1e-6
