"""Joints that are coupled, as by a linkage, under targets that no arm can follow."""

from typing import Any

import numpy as np
import pytest

import iiwa_dnn as d

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
