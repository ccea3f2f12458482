"""The check can fail at every step that yields: a command other than the answer disagrees."""

from __future__ import annotations

import dataclasses
from typing import NamedTuple

import numpy as np
import pytest

import iiwa_dnn
from iiwa_dnn import AccelerationLimits, CollisionAvoidance, CrossCheck, JerkLimits, Limit
from iiwa_dnn.control.command import RowLayout
from iiwa_dnn.control.policies import Policy, ProgramKind
from iiwa_dnn.qp.layout import Sizes

STEPS = 120
SPEED = 0.15


class Steps(NamedTuple):
    """Yielding steps of one run: kinds (k,), programs, points, commands and their bounds."""

    kinds: np.ndarray
    programs: np.ndarray
    points: np.ndarray
    commands: np.ndarray
    bounds: np.ndarray
    sizes: Sizes
    excess: np.ndarray


def limits_of(name: str, tip: np.ndarray) -> tuple[Limit, ...]:
    ball = iiwa_dnn.Sphere((tip + [0.06, 0.03, 0.0]).tolist(), 0.03)
    return {
        "plain": (),
        "acceleration": (AccelerationLimits(5.0),),
        "jerk": (AccelerationLimits(5.0), JerkLimits(500.0)),
        "obstacle": (CollisionAvoidance([ball], distance=0.01),),
        "braking": (AccelerationLimits(5.0), CollisionAvoidance([ball], distance=0.01)),
    }[name]


def yielding_steps(arm: str, limits: str, policy: Policy, dt: float = 1e-3) -> Steps:
    """An arm on a circle that is too quick for it, near a ball."""
    robot = iiwa_dnn.load_robot(arm)
    q = robot.start_posture()
    start = iiwa_dnn.Configuration(robot, q)
    scheme = iiwa_dnn.DoubleIndicator(extra_limits=limits_of(limits, start.position))
    slow = robot.with_limits(velocity=np.minimum(robot.dq_max, SPEED))
    circle = iiwa_dnn.Circle(0.06, 1.5).anchored(start)
    controller = iiwa_dnn.Controller(slow, scheme, circle, dt=dt, policy=policy)
    rows = []
    for k in range(STEPS):
        command = controller.step(q, k * dt)
        q = q + dt * command.dq
        rows.append(command.row)
    layout = controller.layout
    taken = np.array(rows)
    kinds = layout.view(taken, "decision")[:, 3]
    taken = taken[(kinds > ProgramKind.OWN) & (kinds < ProgramKind.STOPPED)]
    return Steps(
        layout.view(taken, "decision")[:, 3],
        np.ascontiguousarray(layout.view(taken, "program")),
        np.ascontiguousarray(layout.view(taken, "point")),
        layout.view(taken, "dq"),
        layout.view(taken, "bounds").reshape(len(taken), 2, -1),
        layout.sizes,
        layout.excess(taken),
    )


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
def test_solvers_and_the_proof_agree_with_an_answer_and_with_no_other(
    arm: str, limits: str, policy: Policy
) -> None:
    steps = yielding_steps(arm, limits, policy)
    dof = steps.commands.shape[1]
    assert len(steps.kinds) > 20
    free = steps.kinds < ProgramKind.HELD
    np.testing.assert_allclose(steps.commands[free], steps.points[free, :dof], rtol=0, atol=1e-9)
    others = steps.points.copy()
    random = np.random.default_rng(1)
    others[:, :dof] = random.uniform(-SPEED, SPEED, (len(others), dof))
    for name in ("proxqp", "osqp", "proof"):
        check = CrossCheck((name,))
        agreement = check.check_block(steps.programs, steps.sizes, steps.points)
        assert (agreement.reference_residual <= check.reference_tolerance).all()
        assert (agreement.solution_gap <= check.tolerance).all()
        agreement = check.check_block(steps.programs, steps.sizes, others)
        assert not (agreement.solution_gap <= check.tolerance).any()


@pytest.mark.parametrize(("limits", "policy"), [("jerk", "slow"), ("braking", "relax")])
def test_a_command_that_is_held_back_is_within_its_bounds_and_another_is_not(
    limits: str, policy: Policy
) -> None:
    steps = yielding_steps("iiwa7", limits, policy)
    held = steps.kinds == ProgramKind.HELD
    assert held.sum() > 20
    assert steps.excess.max() <= 1e-9
    random = np.random.default_rng(2)
    others = random.uniform(-SPEED, SPEED, (1000, 7))
    bounds = steps.bounds[held][random.integers(held.sum(), size=1000)]
    outside = np.maximum(bounds[:, 0] - others, others - bounds[:, 1]).max(axis=1) > 1e-9
    assert outside.sum() >= 999


@pytest.mark.parametrize("policy", ["slow", "relax"])
def test_a_record_says_of_each_step_what_was_checked(policy: Policy) -> None:
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(velocity=SPEED)
    q = robot.start_posture()
    start = iiwa_dnn.Configuration(robot, q)
    scheme = iiwa_dnn.DoubleIndicator(extra_limits=limits_of("jerk", start.position))
    circle = iiwa_dnn.Circle(0.06, 1.5).anchored(start)
    record = iiwa_dnn.simulate(robot, scheme, circle, q, dt=1e-3, duration=0.3, policy=policy)
    check = iiwa_dnn.compute_metrics(record)["crosscheck"]
    assert sum(check["kinds"].values()) == 300
    assert check["kinds"]["held"] > 10
    assert check["kinds"]["scaled" if policy == "slow" else "softened"] > 10
    assert check["disagreements"] == check["reference_failures"] == 0
    assert check["judged_by"] == {"proxqp": 300}
    assert record.kind is not None
    # A command that leaves its bounds is a disagreement, whatever the reference says of the answer.
    excess = np.zeros(300)
    excess[np.flatnonzero(record.kind == ProgramKind.HELD)[0]] = 1e-6
    spoilt = dataclasses.replace(record, excess=excess)
    broken = iiwa_dnn.compute_metrics(spoilt)["crosscheck"]
    assert broken["disagreements"] == 1


def test_the_excess_of_an_answer_counts_its_rows_and_a_multiplier_needs_its_bound() -> None:
    qp = iiwa_dnn.QP(np.eye(2), np.zeros(2), G=[[1.0, 1.0]], h=[0.5], lb=[-1.0] * 2, ub=[1.0] * 2)
    layout = RowLayout(qp.sizes, 2, 0)
    row = np.zeros((1, layout.width))
    layout.view(row, "program")[:] = qp.data
    layout.view(row, "bounds")[:] = [-1.0, -1.0, 1.0, 1.0]
    layout.view(row, "point")[:] = [0.5, 1.0, 0.0, 2.0, 3.0]  # x, z and z_box
    for kind in ProgramKind:
        layout.view(row, "decision")[:, 3] = kind
        counts = kind < ProgramKind.HELD
        np.testing.assert_allclose(layout.excess(row), 1.0 if counts else 0.0)
    np.testing.assert_array_equal(layout.multipliers(row, 1e-9)[0], [[0.0, 3.0]])
