"""The optional arrays of a record, one entry after the other."""

from __future__ import annotations

import numpy as np
from numpy.testing import assert_array_equal

from helpers_simulation import paper_robot
from iiwa_dnn.control.answers import Answers
from iiwa_dnn.control.policies import Action, Resolution, stopped
from iiwa_dnn.qp import QP, Solution, Status
from iiwa_dnn.simulation.incidents import Incidents

ROWS = [{"part": "Wall", "row": 1}, {"part": "Ball", "row": 1}, {"part": "Ball", "row": 2}]
SPEED = np.array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0])


def blank() -> Incidents:
    return Incidents(5, paper_robot().with_limits(velocity=SPEED), {"rows": ROWS})


def decided(sides: list[int], rows: list[int], fraction: float = 0.25) -> Resolution:
    """A slowed step of seven joints and a slack; joints 2 and 3 are close to a position limit."""
    lb, ub = -np.append(SPEED, 9.0), np.append(SPEED, 9.0)
    ub[1], lb[2] = 0.5, -0.5
    qp = QP(np.eye(8), np.zeros(8), G=np.ones((3, 8)), h=np.ones(3), lb=lb, ub=ub)
    failed = Solution(np.zeros(19), qp.sizes, Status.NOT_SETTLED, 0, 0.0, 1.0, 1.0, 1.0)
    signs, acting = np.array(sides, np.int8), np.array(rows, np.int8)
    return stopped(qp, failed)._replace(
        action=Action.SLOW, fraction=fraction, sides=signs, rows=acting
    )


def test_a_run_as_planned_has_no_arrays() -> None:
    incidents = blank()
    incidents.clip(0, np.zeros(7, np.int8))
    assert incidents.arrays(5) == {}
    assert incidents.pending is False


def test_a_decision_is_noted_at_its_step_with_the_kind_of_each_bound() -> None:
    incidents = blank()
    incidents.note(2, decided([1, 1, -1, -1, 0, 0, 0, 1], [0, 0, 0]))
    arrays = incidents.arrays(4)
    assert incidents.pending is True
    assert_array_equal(arrays["action"], [0, 0, 2, 0])
    assert_array_equal(arrays["fraction"], [1.0, 1.0, 0.25, 1.0])
    # 2 at a velocity limit, 1 at the tighter bound before a position limit; the slack has no joint.
    assert_array_equal(arrays["blocking"][2], [2, 1, -1, -2, 0, 0, 0])
    assert not np.delete(arrays["blocking"], 2, axis=0).any()
    assert arrays["blocking"].shape == (4, 7)
    assert "blocking_rows" not in arrays
    incidents.note(3, decided([0] * 8, [0, 0, 1]))
    assert_array_equal(incidents.arrays(5)["blocking_rows"][3], [0, 0, 1])
    assert incidents.arrays(5)["blocking_rows"].sum() == 1


def test_clipped_joints_are_noted_at_their_step() -> None:
    incidents = blank()
    incidents.clip(1, np.array([0, 0, 1, 0, 0, 0, 1], np.int8))
    assert_array_equal(incidents.arrays(5)["clipped"].nonzero(), [[1, 1], [2, 6]])
    assert incidents.pending is False


def test_the_status_names_all_that_is_in_the_way() -> None:
    incidents = blank()
    incidents.note(4, decided([1, 1, -1, -1, 0, 0, 0, 0], [0, 1, 1]))
    assert incidents.status(4, 0.04) == (
        "stopped at step 4 (t = 0.04 s): no solution, against joint 1 upper velocity limit, "
        "joint 2 upper position limit, joint 3 lower position limit, joint 4 lower velocity limit, "
        "row 1 of Ball, row 2 of Ball"
    )
    free = blank()
    free.note(0, decided([0] * 8, [0, 0, 0]))
    assert free.status(0, 0.0) == "stopped at step 0 (t = 0 s): no solution"


def test_multipliers_are_those_of_the_first_stage() -> None:
    incidents, sizes = blank(), (7, 3, 0)
    answers = Answers(sizes, 7, Status.SOLVED, np.zeros((4, 18)))
    qp = QP(np.eye(7), np.zeros(7), G=np.ones((3, 7)), h=np.ones(3))
    for k in range(4):
        point = np.concatenate([np.zeros(7), np.full(3, 10.0 + k), np.full(7, 20.0 + k)])
        solution = Solution(point, sizes, Status.SOLVED, 0, 0.0, 0.0, 0.0, 0.0)
        answers.add(qp, solution, np.zeros(12), np.zeros(7))
    incidents.multipliers(slice(1, 3), answers, 2)
    arrays = incidents.arrays(5)
    assert_array_equal(arrays["row_multiplier"][:, 0], [0.0, 10.0, 12.0, 0.0, 0.0])
    assert_array_equal(arrays["bound_multiplier"][:, 6], [0.0, 20.0, 22.0, 0.0, 0.0])
    assert arrays["row_multiplier"].shape == (5, 3)
    assert arrays["bound_multiplier"].shape == (5, 7)
