"""Joints that are coupled, as by a linkage, under targets that no arm can follow."""

from typing import Any

import numpy as np
import pytest

import iiwa_dnn as d
from helpers_simulation import paper_robot, paper_start

ACCELERATION = d.AccelerationLimits(10.0)


@pytest.mark.parametrize("policy", ["slow", "relax"])
@pytest.mark.parametrize(
    "limits", [(), (ACCELERATION,), (ACCELERATION, d.JerkLimits(500.0))], ids=len
)
def test_a_task_that_yields_does_not_pull_the_linkage_apart(policy: Any, limits: Any) -> None:
    # With `relax`, or where one joint brakes at its limit, it was apart by up to 0.47 rad.
    start = paper_start()
    offset = start.q[1] - 0.5 * start.q[3]
    base = d.DoubleIndicator(orientation="none", extra_limits=limits)
    coupling = d.JointCouplingTask({"iiwa7_joint_2": 1.0, "iiwa7_joint_4": -0.5}, offset)
    scheme = d.Scheme(base.costs, [*base.tasks, coupling], base.limits)
    controller = d.Controller(paper_robot(), scheme, policy=policy)
    rng = np.random.default_rng(3)
    q = start.q
    for k in range(1500):
        if k % 300 == 0:
            way = rng.choice([0.05, 0.3, 1.0]) * rng.standard_normal(3)
        q = q + 1e-3 * controller.step(q, 1e-3 * k, d.Target(start.position + way)).dq
        assert abs(q[1] - 0.5 * q[3] - offset) < 1e-6
