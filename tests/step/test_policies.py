"""Steps without a solution: which program is answered, and that limits hold in it."""

from typing import Any

import numpy as np
import pytest
import qpsolvers
from scipy.optimize import linprog

import iiwa_dnn as d
from helpers_kinematics import PAPER_Q0
from helpers_simulation import fixed, near_target, paper_robot, paper_start, run
from iiwa_dnn.naming import ACTIONS
from iiwa_dnn.networks.integrators.base import SolveStats
from iiwa_dnn.step import fallback
from iiwa_dnn.step.policies import Action, Policy, ProgramKind

WEIGHTS = np.diag([1.0, 1.0, 1.0, 0.5, 0.5, 0.5])
"""Weights of a pose's rows where they yield: a metre counts twice as much as a radian."""


def decide(qp: d.QP, policy: Policy, moves: bool = True) -> d.Command:
    """The command of a step with this program; `moves`: the reference does."""
    n = qp.sizes[0]
    robot = d.robot_from_dh([[0.3, 0.0, 0.0, 0.0]] * n, lower=-3.0, upper=3.0, velocity=1.0)
    twist = [0.01 * moves, 0.0, 0.0]
    target = d.Target([0.3, 0.0, 0.0], np.eye(3), twist)
    return d.Controller(robot, fixed(qp), policy=policy).step(np.zeros(n), 0.0, target)


def posed(seed: int, velocity: float = 0.3) -> tuple[d.Controller, np.ndarray, d.Target]:
    """An iiwa whose target is far off, its posture, and the target."""
    rng = np.random.default_rng(seed)
    q = np.clip(np.array(PAPER_Q0) + 0.3 * rng.standard_normal(7), -2.4, 2.4)
    robot = paper_robot().with_limits(velocity=velocity)
    scheme = d.DoubleIndicator(home=PAPER_Q0, orientation=("so3", "block", "none")[seed % 3])
    return d.Controller(robot, scheme), q, near_target(q, seed, 0.3)


def own_program(controller: d.Controller, q: np.ndarray, target: d.Target) -> d.QP:
    return controller.scheme.build_qp(d.Configuration(controller.robot, q), target)


def linear_factor(qp: d.QP) -> float:
    """The largest fraction of b within the limits, by scipy's linear program."""
    n, m, p = qp.sizes
    found = linprog(
        np.append(np.zeros(n), -1.0),
        A_ub=np.column_stack([qp.G, np.zeros(m)]) if m else None,
        b_ub=qp.h if m else None,
        A_eq=np.column_stack([qp.A, -qp.b]),
        b_eq=np.zeros(p),
        bounds=[*zip(qp.lb, qp.ub, strict=True), (0.0, 1.0)],
        options={"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10},
    )
    return float(found.x[-1]) if found.status == 0 else -1.0


def two_joints(b: float, **others: Any) -> d.QP:
    """Both joints push the same way: x1 + 2 x2 = b inside a box of one."""
    return d.QP(
        np.eye(2), np.zeros(2), A=[[1.0, 2.0]], b=[b], lb=-np.ones(2), ub=np.ones(2), **others
    )


def test_the_scaling_factor_and_the_bounds_limiting_are_those_of_the_linear_program() -> None:
    """Limiting are the bounds that help when they are widened."""
    checked = 0
    blamed = 0
    for seed in range(80):
        controller, q, target = posed(seed, velocity=0.05 + 0.01 * (seed % 60))
        own = own_program(controller, q, target)
        command = controller.step(q, 0.0, target)
        factor = linear_factor(own)
        if command.kind is not ProgramKind.SCALED:
            assert command.kind is (ProgramKind.NOMINAL if factor == 1.0 else ProgramKind.RELAXED)
            races = np.abs(own.A @ command.dq).max() < 0.05 * np.abs(command.dq).max()
            assert factor == 1.0 or 0.999 * factor < 0.1 or races
            continue
        checked += 1
        assert command.fraction == pytest.approx(0.999 * factor, abs=1e-7)
        np.testing.assert_allclose(command.qp.b, command.fraction * own.b, rtol=1e-12)
        for i in range(7):
            wider = d.QP.from_data(own.data.copy(), own.sizes)
            wider.lb[i] -= 1e-3
            wider.ub[i] += 1e-3
            gain = linear_factor(wider) - factor
            assert (gain > 1e-8) == (command.log.limiting[i] != 0)
            blamed += int(command.log.limiting[i] != 0)
    assert checked > 20
    assert blamed > 10


@pytest.mark.parametrize("policy", ["slow", "relax"])
def test_the_relaxed_program_is_the_pages(policy: Policy) -> None:
    for seed in (0, 3, 6, 9):  # so3: the weights are those of a pose
        controller, q, target = posed(seed)
        controller.policy = policy
        own = own_program(controller, q, target)
        still = d.Target(target.position, target.rotation)  # where the reference rests, both soften
        own.b[:] = own_program(controller, q, still).b
        command = controller.step(q, 0.0, still)
        assert (command.action, command.kind) == (Action.RELAX, ProgramKind.RELAXED)
        own.b[:] *= min(1.0, 10.0 / np.abs(own.b).max())  # no arm is quicker
        rows = WEIGHTS @ own.A
        drift = -0.02 * own.q / max(1.0, np.abs(own.q).max())
        cost = rows.T @ rows + 0.05**2 * np.eye(7) + 1e-4 * own.P
        linear = -rows.T @ WEIGHTS @ own.b - 0.05**2 * drift
        np.testing.assert_allclose(command.qp.P, cost, rtol=1e-12, atol=1e-15)
        np.testing.assert_allclose(command.qp.q, linear, rtol=1e-9, atol=1e-12)
        for name in ("G", "h", "lb", "ub"):
            np.testing.assert_array_equal(getattr(command.qp, name), getattr(own, name))
        assert not command.qp.A.any()
        assert not command.qp.b.any()
        problem = d.QP(cost, linear, lb=own.lb, ub=own.ub).to_qpsolvers()
        found = qpsolvers.solve_problem(problem, solver="daqp")
        np.testing.assert_allclose(command.dq, found.x, rtol=0, atol=1e-7)


@pytest.mark.parametrize("policy", ["slow", "relax"])
def test_a_joint_outside_its_limits_comes_back_whatever_the_task_says(policy: Policy) -> None:
    for seed in range(6):
        controller, q, target = posed(seed)
        controller.policy = policy
        q[0] = -2.6
        with pytest.warns(UserWarning, match="start posture"):
            command = controller.step(q, 0.0, target)
        assert command.bounds[:, 0].tolist() == [0.3, 0.3]  # as fast as it may
        assert command.dq[0] == 0.3
        assert command.kind is not ProgramKind.STOPPED


@pytest.mark.parametrize("policy", ["slow", "relax"])
@pytest.mark.parametrize("h", [1.0, 1e-3, 0.0, -0.5, -2.0, -5.0])
def test_a_wall_is_kept_and_a_row_that_asks_for_motion_gets_what_the_joints_can(policy, h) -> None:
    """Both joints together retreat by 2 at most, and the task pushes the other way."""
    command = decide(two_joints(12.0, G=[[1.0, 1.0]], h=[h]), policy)
    assert command.action in (Action.SLOW, Action.RELAX)
    assert command.kind is ProgramKind.RELAXED or h > 0.0
    given = h if h >= -2.0 else -2.0 * 0.999
    assert command.qp.h[0] == pytest.approx(given, abs=1e-8)
    assert command.dq.sum() <= given + 1e-8
    assert (np.abs(command.dq) <= 1.0).all()
    assert command.log.limiting[-1] == 1


@pytest.mark.parametrize("policy", ["slow", "relax", "stop"])
def test_limits_that_contradict_each_other_stop_the_arm(policy: Policy) -> None:
    qp = two_joints(0.5, G=[[1.0, 1.0]], h=[0.5])
    qp.lb[:] = 0.5  # both joints have to come back, and the wall leaves a margin for half of it
    command = decide(qp, policy)
    assert (command.action, command.kind) == (Action.STOP, ProgramKind.STOPPED)
    assert not command.dq.any()
    np.testing.assert_array_equal(command.qp.data, qp.data)  # its nominal program is handed out
    assert command.log.limiting[-1] == 1


@pytest.mark.parametrize(("row", "kind"), [(0.2, ProgramKind.SCALED), (0.04, ProgramKind.RELAXED)])
def test_slow_relaxes_where_the_joints_race_for_next_to_nothing(row, kind) -> None:
    qp = d.QP(np.eye(1), np.zeros(1), A=[[row]], b=[1.5 * row], lb=[-1.0], ub=[1.0])
    command = decide(qp, "slow")
    assert (command.action, command.kind) == (Action.SLOW, kind)
    if kind is ProgramKind.RELAXED:
        damped = 1.5 * row * row / (row * row + 0.05**2 + 1e-4)
        assert command.dq[0] == pytest.approx(damped, rel=1e-9)
        assert command.fraction == pytest.approx(row * damped / (1.5 * row), rel=1e-9)


def test_the_clock_never_rests() -> None:
    """A thousandth of b is left: the damped task is followed, and the clock goes on by a tenth."""
    qp = d.QP(np.eye(2), [0.0, -9.0], A=[[1e-3, 0.0]], b=[5.0], lb=[-1.0] * 2, ub=[1.0] * 2)
    command = decide(qp, "slow")
    assert (command.action, command.fraction) == (Action.SLOW, 0.1)
    # And towards the posture that the cost prefers; the cost itself counts 1e-4.
    expected = [5e-3 / (1e-6 + 0.05**2 + 1e-4), 0.05**2 * 0.02 / (0.05**2 + 1e-4)]
    np.testing.assert_allclose(command.dq, np.minimum(expected, 1.0), rtol=1e-5)


@pytest.mark.parametrize("policy", ["slow", "relax"])
def test_a_target_that_is_out_of_all_proportion_is_gone_towards(policy: Policy) -> None:
    for far in (1e3, 1e6, 1e9):
        start = paper_start()
        target = d.Target(start.position + [far, 0.0, 0.0], start.rotation, [0.01, 0.0, 0.0])
        command = d.Controller(paper_robot(), d.DoubleIndicator(), policy=policy).step(
            PAPER_Q0, 0.0, target
        )
        assert command.action in (Action.SLOW, Action.RELAX)
        assert (start.jacobian[0] @ command.dq) > 0.1


def test_the_codes_in_a_record_stay_what_they_are() -> None:
    codes = {action.name.lower(): int(action) for action in Action}
    assert codes == {"none": 0, "slow": 2, "relax": 3, "stop": 4, "euler": 5}
    assert {code: name for name, code in codes.items() if code} == ACTIONS
    kinds = {kind.name: int(kind) for kind in ProgramKind}
    assert kinds == {"NOMINAL": 0, "SCALED": 1, "RELAXED": 2, "RATE_LIMITED": 3, "STOPPED": 4}


def test_the_linear_solves_of_a_step_have_a_bound() -> None:
    """Both tries at a program without a solution, the second with what the first has left."""
    qp = two_joints(0.5, G=[[1.0, 1.0]], h=[0.5])
    qp.lb[:] = 0.5
    stats = SolveStats.zeros()
    stats.iterations = fallback.FALLBACK_BUDGET - 70.0
    state = np.ones(3 * 2 + qp.h.size + qp.b.size)
    point = np.empty(2 * 2 + qp.h.size + qp.b.size)
    assert not fallback.solve_warm(qp.views, 1e-9, state, point, stats)
    assert 0.0 <= fallback.FALLBACK_BUDGET - stats.iterations < 10.0
    scheme = d.DoubleIndicator(extra_limits=(d.AccelerationLimits(),))
    record = run(scheme, duration=0.01)
    assert record.settings["most_linear_solves"] == 300.0  # docs/robustness.md
