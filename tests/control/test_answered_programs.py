"""The check can fail at every step that yields: a command other than the answer disagrees."""

import numpy as np
import pytest

import iiwa_dnn as d
from helpers_simulation import driven
from iiwa_dnn.control.command import LogLayout, lay_out_log
from iiwa_dnn.schemes.program import ProgramSizes
from iiwa_dnn.step.log import log_of
from iiwa_dnn.step.policies import Policy, ProgramKind

STEPS = 120
SPEED = 0.15


def limits_of(name: str, tip: np.ndarray) -> tuple[d.Limit, ...]:
    ball = d.Sphere((tip + [0.06, 0.03, 0.0]).tolist(), 0.03)
    return {
        "plain": (),
        "acceleration": (d.AccelerationLimits(5.0),),
        "jerk": (d.AccelerationLimits(5.0), d.JerkLimits(500.0)),
        "obstacle": (d.CollisionAvoidance([ball], distance=0.01),),
        "braking": (d.AccelerationLimits(5.0), d.CollisionAvoidance([ball], distance=0.01)),
    }[name]


def yielding_steps(arm: str, limits: str, policy: Policy) -> tuple[LogLayout, np.ndarray]:
    """Rows of the steps that yield, of an arm on a circle that is too quick for it, near a ball."""
    robot = d.load_robot(arm)
    q = robot.start_posture()
    start = d.Configuration(robot, q)
    scheme = d.DoubleIndicator(extra_limits=limits_of(limits, start.position))
    slow = robot.with_limits(velocity=np.minimum(robot.dq_max, SPEED))
    circle = d.Circle(0.06, 1.5, begin=0.0).anchored(start)
    controller = d.Controller(slow, scheme, circle, policy=policy)
    taken = np.array([command.data for command in driven(controller, q, STEPS)[1]])
    layout = controller.control_layout.log_layout
    kinds = log_of(taken, layout.sizes).kind
    taken = taken[(kinds > ProgramKind.NOMINAL) & (kinds < ProgramKind.STOPPED)]
    assert len(taken) > 20
    return layout, taken


CASES = [
    ("iiwa7", "plain", "slow"),
    ("iiwa7", "jerk", "relax"),
    ("iiwa7", "braking", "slow"),
    ("panda", "acceleration", "slow"),
    ("ur5", "obstacle", "relax"),
    ("xarm7", "jerk", "slow"),
    ("kinova", "plain", "relax"),
]


@pytest.mark.parametrize(("arm", "limits", "policy"), CASES)
def test_solvers_and_the_proof_agree_with_an_answer_and_with_no_other(arm, limits, policy) -> None:
    layout, rows = yielding_steps(arm, limits, policy)
    logs = log_of(rows, layout.sizes)
    programs = np.ascontiguousarray(logs.program)
    points = np.ascontiguousarray(logs.point)
    free = logs.kind < ProgramKind.RATE_LIMITED
    joints = layout.sizes.joints
    np.testing.assert_allclose(logs.dq[free], points[free, :joints], rtol=0, atol=1e-9)
    others = points.copy()
    random = np.random.default_rng(1)
    others[:, :joints] = random.uniform(-SPEED, SPEED, (len(others), joints))
    for name in ("proxqp", "osqp", "proof"):
        check = d.CrossCheck((name,))
        agreement = check.check_block(programs, layout.qp_sizes, points)
        assert (agreement.reference_residual <= check.reference_tolerance).all()
        assert (agreement.largest <= check.tolerance).all()
        agreement = check.check_block(programs, layout.qp_sizes, others)
        assert not (agreement.solution_gap <= check.tolerance).any()


@pytest.mark.parametrize(("limits", "policy"), [("jerk", "slow"), ("braking", "relax")])
def test_a_command_that_is_rate_limited_is_within_its_bounds(limits: str, policy: Policy) -> None:
    layout, rows = yielding_steps("iiwa7", limits, policy)
    held = log_of(rows, layout.sizes).kind == ProgramKind.RATE_LIMITED
    assert held.sum() > 20
    assert layout.excess(rows).max() <= 1e-9


def test_the_excess_of_an_answer_counts_its_rows() -> None:
    qp = d.QP(np.eye(2), np.zeros(2), G=[[1.0, 1.0]], h=[0.5], lb=[-1.0] * 2, ub=[1.0] * 2)
    layout = lay_out_log(ProgramSizes(*qp.sizes, 2, 0, 0), None)
    row = np.zeros((1, layout.width))
    log = log_of(row, layout.sizes)
    log.program[:] = qp.data
    log.lower[:] = -1.0
    log.upper[:] = 1.0
    log.point[:] = [0.5, 1.0, 0.0, 2.0, 3.0]  # x, z and z_box
    for kind in ProgramKind:
        log.kind = kind
        counts = kind < ProgramKind.RATE_LIMITED
        np.testing.assert_allclose(layout.excess(row), 1.0 if counts else 0.0)
