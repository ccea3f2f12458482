"""The recorder: optional columns of a record, one outcome after the other."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.testing import assert_array_equal

from helpers_kinematics import PAPER_Q0
from helpers_simulation import heart, paper_robot
from iiwa_dnn.control.command import Command, RowLayout
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.policies import Action, Resolution
from iiwa_dnn.qp import QP, Solution, Status
from iiwa_dnn.results.metrics import compute_metrics
from iiwa_dnn.schemes import DoubleIndicator
from iiwa_dnn.simulation import simulate
from iiwa_dnn.simulation.loop import Outcome
from iiwa_dnn.simulation.recorder import Recorder

ROWS = [{"part": "Wall", "row": 1}, {"part": "Ball", "row": 1}, {"part": "Ball", "row": 2}]
SPEED = np.array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0])
CONTROLLER = Controller(
    paper_robot().with_limits(velocity=SPEED), DoubleIndicator(home=PAPER_Q0), heart()
)


def recorder(steps: int = 5) -> Recorder:
    return Recorder(steps, CONTROLLER, np.array(PAPER_Q0), {"rows": ROWS})


class Decided(Command):
    """A command with a decision about a program of other sizes."""

    decision: Resolution | None = None

    @property
    def resolution(self) -> Resolution | None:
        return self.decision

    @property
    def bounds(self) -> np.ndarray:
        qp = self.qp if self.decision is None else self.decision.qp
        return np.array([qp.lb, qp.ub])


def outcome(resolution: Resolution | None = None, **facts: Any) -> Outcome:
    command = Decided(CONTROLLER.compute(np.array(PAPER_Q0), 0.1).row, CONTROLLER.layout)
    command.decision = resolution
    return Outcome([command], command.dq, command.dq, np.array(PAPER_Q0), **facts)


def decided(sides: list[int], rows: list[int]) -> Resolution:
    """A slowed step of seven joints and a slack; joints 2 and 3 are close to a position limit."""
    lb = -np.append(SPEED, 9.0)
    ub = np.append(SPEED, 9.0)
    lb[2] = -0.5
    ub[1] = 0.5
    qp = QP(np.eye(8), np.zeros(8), G=np.ones((3, 8)), h=np.ones(3), lb=lb, ub=ub)
    failed = Solution(np.zeros(19), qp.sizes, Status.NOT_SETTLED, 0, 0.0, 1.0, 1.0, 1.0)
    signs = np.array(sides, np.int8)
    acting = np.array(rows, np.int8)
    return Resolution(Action.SLOW, qp, failed, 0.25, signs, acting)


def recorded(outcomes: list[Outcome]) -> dict[str, Any]:
    made = recorder(len(outcomes))
    for k, each in enumerate(outcomes):
        made.observe(k, each)
    made.flush()
    return made.finish()


def test_a_run_as_planned_has_no_optional_columns() -> None:
    plain = recorded([outcome(clipped=np.zeros(7, np.int8))])
    for name in ("action", "fraction", "blocking", "blocking_rows", "clipped", "ddq", "torque"):
        assert name not in plain


def test_a_decision_is_noted_at_its_step_with_the_kind_of_each_bound() -> None:
    first = decided([1, 1, -1, -1, 0, 0, 0, 1], [0, 0, 0])
    second = decided([0] * 8, [0, 0, 1])
    slowed = [outcome(resolution=each, action=Action.SLOW) for each in (first, second)]
    arrays = recorded([outcome(), slowed[0], slowed[1]])
    assert_array_equal(arrays["action"], [0, 2, 2])
    assert_array_equal(arrays["fraction"], [1.0, 0.25, 0.25])
    # 2 at a velocity limit, 1 at the tighter bound before a position limit; the slack has no joint.
    assert_array_equal(arrays["blocking"], [[0] * 7, [2, 1, -1, -2, 0, 0, 0], [0] * 7])
    assert_array_equal(arrays["blocking_rows"], [[0, 0, 0], [0, 0, 0], [0, 0, 1]])


def test_the_reason_of_a_stop_names_all_that_is_in_the_way() -> None:
    made = recorder()
    decision = decided([1, 1, -1, -1, 0, 0, 0, 0], [0, 1, 1])
    made.observe(0, outcome(resolution=decision, action=Action.STOP))
    made.observe(1, outcome(resolution=decided([0] * 8, [0, 0, 0]), action=Action.STOP))
    made.flush()
    assert made.stop_reason(0) == (
        ", against joint 1 upper velocity limit, joint 2 upper position limit, joint 3 lower "
        "position limit, joint 4 lower velocity limit, row 1 of Ball, row 2 of Ball"
    )
    assert made.stop_reason(1) == ""


def test_multipliers_and_poses_are_those_of_the_first_stage() -> None:
    at_limit = paper_robot().with_limits(velocity=0.02)
    controller = Controller(at_limit, DoubleIndicator(home=PAPER_Q0), heart())
    times = (0.0, 2.5)
    stages: list[Command] = [controller.compute(np.array(PAPER_Q0), t) for t in times]
    assert stages[1].solution.z_box.any() or stages[1].resolution is not None
    made = Recorder(1, controller, np.array(PAPER_Q0), {"rows": []})
    q = np.array(PAPER_Q0)
    made.observe(0, Outcome(stages, stages[0].dq, stages[0].dq, q))
    made.flush()
    assert "bound_multiplier" not in made.arrays
    assert_array_equal(made.arrays["position_desired"][0], heart().at(0.0).position)
    iterations = sum(stage.solution.iterations for stage in stages)
    assert made.arrays["iterations"][0] == iterations


def test_an_active_limit_has_a_multiplier_and_no_slack() -> None:
    """Multipliers of rounding, and such as decay after the joint has left its bound, do not act."""
    rows = [[1.0, 0.0], [-1.0, 0.0], [1.0, 1.0]]
    qp = QP(np.eye(2), np.zeros(2), rows, [1.0, 0.0, 2.0], lb=[-1.0, -2.0], ub=[1.0, 1.5])
    layout = RowLayout(qp.sizes, 2, 1)
    for x, z, z_box, active_rows, active_bounds in (
        ([1.0, 1.0], [2.0, 3.0, 1e-16], [1e-16, 1e-16], [2.0, 0.0, 0.0], [0.0, 0.0]),
        ([1.0, -2.0], [1e-9, 0.0, 40.0], [0.5, -0.1], [0.0, 0.0, 0.0], [0.5, -0.1]),
        ([0.9, 1.5 - 1e-7], [0.2, 9.0, 0.0], [5.0, 5e-3], [0.0, 0.0, 0.0], [0.0, 5e-3]),
    ):
        point = np.concatenate([x, z, z_box])
        answer = Solution(point, qp.sizes, Status.SOLVED, 0, 0.0, 0.0, 0.0, 0.0)
        row = np.zeros(layout.width)
        layout.view(row, "program")[:] = qp.data
        layout.fill(row, answer)
        assert_array_equal(layout.row_multipliers(row, 1e-9), active_rows)
        assert_array_equal(layout.bound_multipliers(row[np.newaxis], 1e-9), [active_bounds])


def test_too_quick_a_path_in_continuous_mode_names_the_limits_that_the_arm_is_at() -> None:
    path = heart(period=0.4)
    scheme = DoubleIndicator(home=PAPER_Q0)
    options = {"mode": "continuous", "check": None, "dt": 1e-3, "duration": 0.4}
    record = simulate(paper_robot(), scheme, path, PAPER_Q0, **options)
    active = compute_metrics(record)["incidents"]["active_bounds"]
    assert record.q[:, 0].min() < -2.47  # beside its limit of -2.5, and no other joint is
    assert [(bound["joint"], bound["side"], bound["limit"]) for bound in active] == [
        (1, "lower", "position"),
        (1, "lower", "velocity"),
        (1, "upper", "velocity"),
        (4, "lower", "velocity"),
        (4, "upper", "velocity"),
        (7, "upper", "velocity"),
    ]
