"""A scheme laid out for the control loop: its parts are told the step as it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.testing import assert_array_equal

from helpers_kinematics import PAPER_Q0, Array
from helpers_simulation import near_target, paper_robot
from iiwa_dnn import Controller, CyclicMotion, Scheme, Step, Target, Task

ELBOW = "iiwa7_link_4"


@dataclass(frozen=True)
class Wished(Task):
    """Asks for the target's linear velocity along x, and keeps what it was told."""

    frame: str | None = None
    rows: int = 1

    def equations(self, step: Step) -> tuple[Array, Array]:
        target = step.target(self.frame)
        told.append((step.t, step.q.copy(), target.data.copy()))
        return step.frame(self.frame).jacobian[:1], target.linear_velocity[:1]


told: list[tuple[float, Array, Array]] = []


def test_a_part_of_ones_own_gets_time_posture_and_the_target_of_its_frame() -> None:
    told.clear()
    robot, q = paper_robot(), np.array(PAPER_Q0) + 0.05
    scheme = Scheme([CyclicMotion(home=PAPER_Q0)], [Wished(), Wished(ELBOW)])
    controller = Controller(robot, scheme)
    targets: dict[str, Target] = {
        robot.tip: near_target(q, seed=1, size=1e-3),
        ELBOW: near_target(q, seed=2, size=1e-3),
    }
    command = controller.step(q, 0.75, targets)
    assert len(told) >= 2
    for (t, posture, data), name in zip(told[-2:], (robot.tip, ELBOW), strict=True):
        assert t == 0.75
        assert_array_equal(posture, q)
        assert_array_equal(data, targets[name].data)
    expected = [targets[name].linear_velocity[0] for name in (robot.tip, ELBOW)]
    assert_array_equal(command.qp.b, expected)
