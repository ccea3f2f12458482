"""Joints that are coupled, as by a linkage, under targets that no arm can follow."""

from typing import Any

import pytest

import iiwa_dnn as d
from helpers_simulation import paper_robot, paper_start


@pytest.mark.parametrize("policy", ["slow", "relax"])
@pytest.mark.parametrize("limited", [False, True])
def test_a_task_that_yields_does_not_pull_the_linkage_apart(policy: Any, limited: bool) -> None:
    # With `relax`, or acceleration limits, it was commanded apart by up to 0.45 rad.
    start = paper_start()
    offset = start.q[3] + 0.5 * start.q[1]
    limits = (d.AccelerationLimits(10.0),) if limited else ()
    base = d.DoubleIndicator(orientation="none", extra_limits=limits)
    coupling = d.JointCouplingTask({"iiwa7_joint_4": 1.0, "iiwa7_joint_2": 0.5}, offset)
    scheme = d.Scheme(base.costs, [*base.tasks, coupling], base.limits)
    controller = d.Controller(paper_robot(), scheme, policy=policy)
    q = start.q
    for k in range(1000):
        side = 0.5 if k % 500 < 250 else -0.3
        target = d.Target(start.position + [0.1, side, side], start.rotation)
        q = q + 1e-3 * controller.step(q, 1e-3 * k, target).dq
        assert abs(q[3] + 0.5 * q[1] - offset) < 1e-6
