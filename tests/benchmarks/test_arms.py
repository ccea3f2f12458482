"""Arms of other libraries' examples move here as they do there."""

from __future__ import annotations

import numpy as np
import pink
import pytest
from pink.limits import ConfigurationLimit, VelocityLimit
from pink.tasks import JointVelocityTask

import iiwa_dnn
from benchmarks import arms
from benchmarks.arms import OWN, PEERS, compare, measure_scene
from helpers_bench import loops_in_this_process
from scripts.arm_scenes import scene

DT = 5e-3


@pytest.mark.parametrize("name", ["pink arm_ur5", "mink dual_iiwa"])
def test_the_motion_is_pinks(name: str) -> None:
    with loops_in_this_process() as patch:
        patch.setattr(arms, "PEERS", PEERS[:1])
        rows, _ = measure_scene(name, 300, DT, {})
    found = {row["name"]: row for row in rows}
    all_along, arrived, joints = compare(found[OWN], found[PEERS[0]])
    # On the way, at their velocity limits, the two weigh a missing velocity in other coordinates.
    assert all_along < 2e-3
    assert arrived < 1e-5
    assert joints < 1e-4


def test_joint_velocities_out_of_the_limits_are_pinks() -> None:
    robot, scheme, references, q0 = scene("pink arm_z1_joint_velocity_tracking", DT)
    record = iiwa_dnn.simulate(robot, scheme, references, q0, dt=DT, duration=2.0)
    configuration = pink.Configuration(robot.model, robot.model.createData(), np.array(q0))
    task = JointVelocityTask(cost=1.0)
    limits = [ConfigurationLimit(robot.model), VelocityLimit(robot.model)]
    for k in range(record.steps):
        np.testing.assert_allclose(record.q[k], configuration.q, rtol=0, atol=1e-7)
        # Pink 4.4 moves against its target: its error has the target's sign.
        task.set_target(np.full(robot.dof, -2.0 * np.sin(record.t[k])), DT)
        velocity = pink.solve_ik(
            configuration,
            [task],
            DT,
            solver="daqp",
            limits=limits,
        )
        configuration.integrate_inplace(velocity, DT)
    assert iiwa_dnn.failures(record) == []
    assert (record.q.max(axis=0) > robot.q_upper - 1e-3).any()  # the limits had a say
