"""What is done at a step without a solution: limits hold, and as much of the task as can be had."""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
import qpsolvers
from scipy.optimize import linprog, lsq_linear

from helpers_kinematics import PAPER_Q0
from helpers_simulation import near_target, paper_robot, paper_start
from iiwa_dnn import Controller, Target, load_robot
from iiwa_dnn.control import policies
from iiwa_dnn.control.command import RowLayout, row_views
from iiwa_dnn.control.policies import Action, Resolution
from iiwa_dnn.control.relaxed import (
    BUDGET,
    DAMPING,
    DRIFT,
    FACTOR,
    NEAR,
    VIOLATION,
    Yielding,
    largest_factor,
    least_violation,
    note_blocking,
)
from iiwa_dnn.control.yielding import ATTEMPTS, yield_step
from iiwa_dnn.networks.integrators.base import ANSWER
from iiwa_dnn.networks.integrators.implicit import settle
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Solution, Status
from iiwa_dnn.qp.layout import qp_views
from iiwa_dnn.results.metrics import ACTIONS
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.schemes import DoubleIndicator
from iiwa_dnn.schemes.program import ProgramArrays

WEIGHTS = np.diag([1.0, 1.0, 1.0, 0.1, 0.1, 0.1])


class Found(NamedTuple):
    """What a relaxed program found."""

    fraction: float
    dq: np.ndarray
    sides: np.ndarray
    rows: np.ndarray


def yielding(qp: QP, weights: np.ndarray | None = None, elastic: bool = False) -> Yielding:
    return Yielding(
        np.ones(qp.sizes[2]) if weights is None else weights.copy(),
        np.full(qp.sizes[1], float(elastic)),
        np.zeros(0),
        np.array([1e-9, 60.0, 1e8]),
        np.zeros((0, 2), np.int64),
        1e-3,
        ANSWER.address(settle),
        FACTOR.address(largest_factor),
        VIOLATION.address(least_violation),
    )


def blocking(qp: QP, point: np.ndarray, extra: int) -> tuple[np.ndarray, np.ndarray]:
    n, m, _ = qp.sizes
    found = np.empty(n + m)
    note_blocking(point, n, m, extra, found)
    return found[:n], found[n:]


def largest_fraction(qp: QP) -> Found:
    """The scaling factor by the network, with a velocity that gives it."""
    n, m, p = qp.sizes
    point = np.empty(2 * n + 2 + m + p)
    factor = largest_factor(qp_views(qp.data, n, m, p), yielding(qp), point)
    return Found(factor, point[:n], *blocking(qp, point, 1))


def softened(qp: QP, weights: np.ndarray | None = None) -> Found | None:
    n, m, p = qp.sizes
    point = np.empty(2 * n + m)
    args = (qp_views(qp.data, n, m, p), yielding(qp, weights), np.zeros(n), point)
    return Found(1.0, point[:n], *blocking(qp, point, 0)) if least_violation(*args) else None


def resolve(
    qp: QP,
    policy: policies.Policy,
    weights: np.ndarray | None = None,
    moves: bool = True,
    elastic: bool = False,
) -> Resolution:
    """The decision about a program, as the controller takes it; `moves`: the reference does."""
    n, m, p = qp.sizes
    layout = RowLayout(qp.sizes, n, 1)
    row = np.zeros(layout.width)
    views = row_views(row, n, m, p, n)
    views.program[:] = qp.data
    views.targets[0, 12] = moves
    views.decision[2] = 2.0  # the network was asked, and did not settle
    table = np.array([[n, m, p, n, 0, 0, 0, 0]])
    none = np.zeros((n, 6))
    arrays = ProgramArrays(table, np.zeros(0), none, np.zeros((1, 12)), none, np.eye(n), 1e3)
    past, following = np.zeros((2, 5, n))
    action = {"slow": Action.SLOW, "relax": Action.RELAX}.get(policy, Action.STOP)
    state = np.zeros(3 * n + m + p)
    relaxing = yielding(qp, weights, elastic)
    taken = yield_step(row, arrays, past, following, state, relaxing, int(action), False)
    status = tuple(Status)[int(views.decision[2])]
    figures = views.figures.tolist()
    solution = Solution(views.point, qp.sizes, status, int(figures[0]), 0.0, *figures[2:])
    answered = QP.from_data(views.program, qp.sizes)
    sides = views.blocking[:n].astype(np.int8)
    rows = views.blocking[n:].astype(np.int8)
    return Resolution(Action(taken), answered, solution, float(views.decision[1]), sides, rows)


def program(seed: int, orientation: str = "so3", velocity: float = 0.3, outside: float = 0.0) -> QP:
    """A step of the iiwa whose target is far off; `outside` puts joint 1 below its limit."""
    rng = np.random.default_rng(seed)
    q = np.clip(np.array(PAPER_Q0) + 0.3 * rng.standard_normal(7), -2.4, 2.4)
    if outside:
        q[0] = -2.5 - outside
    robot = paper_robot().with_limits(velocity=velocity)
    scheme = DoubleIndicator(orientation=orientation, home=PAPER_Q0)
    return scheme.build_qp(Configuration(robot, q), near_target(q, seed, 0.3))


def two_joints(b: float, ub: tuple[float, float] = (1.0, 1.0)) -> QP:
    """Both joints push the same way: x1 + 2 x2 = b inside a box from -1."""
    return QP(np.eye(2), np.zeros(2), A=[[1.0, 2.0]], b=[b], lb=[-1.0, -1.0], ub=ub)


def inside(dq: np.ndarray, qp: QP) -> bool:
    return bool(((qp.lb <= dq) & (dq <= qp.ub)).all())


def distance(rows: np.ndarray, rhs: np.ndarray, qp: QP) -> float:
    """Half the squared distance of `rhs` from what the bounds let the rows be."""
    return lsq_linear(rows, rhs, (qp.lb, qp.ub), "trf", tol=1e-15, max_iter=1000).cost


def test_the_largest_fraction_in_closed_form() -> None:
    # At most 1 + 2 = 3 of the 12 that are asked for; both upper bounds are in the way.
    reach = largest_fraction(two_joints(12.0))
    assert reach.fraction == pytest.approx(0.25, abs=1e-9)
    np.testing.assert_allclose(reach.dq, [1.0, 1.0], rtol=0, atol=1e-9)
    assert reach.sides.tolist() == [1, 1]
    reach = largest_fraction(two_joints(-12.0))
    assert reach.fraction == pytest.approx(0.25, abs=1e-9)
    assert reach.sides.tolist() == [-1, -1]
    assert largest_fraction(two_joints(2.5)).fraction == 1.0
    # A row that no joint moves: only nothing is feasible, and no bound is to blame.
    stuck = QP(np.eye(2), np.zeros(2), A=[[0.0, 0.0]], b=[1.0], lb=[-1, -1], ub=[1, 1])
    assert largest_fraction(stuck).fraction == pytest.approx(0.0, abs=1e-9)
    # Joint 1 has to come back, joint 2 cannot make up for it: not even rest is feasible.
    back = QP(np.eye(2), np.zeros(2), A=[[1.0, 0.5]], b=[1.0], lb=[-1, -1], ub=[-0.8, 1])
    assert np.isnan(largest_fraction(back).fraction)


@pytest.mark.parametrize("orientation", ["so3", "block", "none"])
def test_a_little_more_than_the_largest_fraction_is_not_feasible(orientation: str) -> None:
    fractions = []
    for seed in range(10):
        qp = program(seed, orientation)
        reach = largest_fraction(qp)
        fractions.append(reach.fraction)
        np.testing.assert_allclose(qp.A @ reach.dq, reach.fraction * qp.b, rtol=0, atol=1e-9)
        assert inside(reach.dq, qp)
        # Another method: the distance to the nearest attainable velocity, by least squares.
        for share, feasible in ((0.999, True), (1.001, False)):
            gap = distance(qp.A, share * reach.fraction * qp.b, qp)
            assert (gap < 1e-16) == feasible
    assert 0.0 < min(fractions) < max(fractions) < 1.0


@pytest.mark.parametrize("walls", [0, 3])
def test_the_scaling_factor_is_the_linear_programs(walls: int) -> None:
    for seed in range(40):
        qp = program(seed, ("so3", "block", "none")[seed % 3], velocity=0.05 + 0.01 * seed)
        if walls:
            wall = np.random.default_rng(seed).standard_normal((walls, 7))
            qp = QP(qp.P, qp.q, wall, np.full(walls, 0.02), qp.A, qp.b, qp.lb, qp.ub)
        size = np.abs(qp.b).max()
        found = linprog(
            np.append(np.zeros(7), -1.0),
            A_ub=np.column_stack([qp.G, np.zeros(walls)]) if walls else None,
            b_ub=qp.h if walls else None,
            A_eq=np.column_stack([qp.A, -qp.b / size]),
            b_eq=np.zeros(qp.b.size),
            bounds=[*zip(qp.lb, qp.ub, strict=True), (0.0, size)],
            options={"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10},
        )
        assert found.status == 0
        assert largest_fraction(qp).fraction * size == pytest.approx(found.x[7], abs=1e-8)


def test_a_scaled_program_that_stagnates_above_the_tolerance_has_a_factor() -> None:
    """Rounding in the orientation's rows, of 1e-8 rad, asks for more than a tolerance there."""
    robot = load_robot("ur5").with_limits(velocity=0.5)
    conf = Configuration(robot, [0.003, -1.19878341, 1.59714915, -1.96836812, -1.56999761, 0.003])
    qp = DoubleIndicator().build_qp(conf, Target(conf.position, conf.rotation), dt=2e-3)
    qp.b[:] = [8.7244e-02, 3.97457676e-01, 8.7537e-02, -1.1985085e-08, -1.2000648e-08, -3.56e-11]
    found = linprog(
        np.append(np.zeros(6), -1.0),
        A_eq=np.column_stack([qp.A, -qp.b]),
        b_eq=np.zeros(6),
        bounds=[*zip(qp.lb, qp.ub, strict=True), (0.0, 1.0)],
    )
    assert largest_fraction(qp).fraction == pytest.approx(found.x[6], abs=1e-6)


@pytest.mark.parametrize("outside", [0.0, 0.002])
def test_the_least_violation_is_a_quadratic_programs_solution(outside: float) -> None:
    in_the_way = 0
    for seed in range(10):
        base = program(seed, outside=outside)
        free = softened(base, WEIGHTS.diagonal())
        assert free is not None
        for h in (np.inf, -0.05):  # the wall stands where the arm would go without it
            wall = np.random.default_rng(seed).standard_normal((3, 7))
            bound = wall @ free.dq + h
            qp = QP(base.P, base.q, wall, bound, base.A, base.b, base.lb, base.ub)
            found = softened(qp, WEIGHTS.diagonal())
            assert found is not None
            assert inside(found.dq, qp)
            rows, rhs = WEIGHTS @ qp.A, WEIGHTS @ qp.b
            sigma = np.linalg.svd(rows, compute_uv=False)[-1]
            damping = DAMPING**2 * max(0.0, 1.0 - (sigma / NEAR) ** 2)
            drift = -DRIFT * qp.q / max(np.linalg.norm(qp.q), 1.0)
            if damping == 0.0:
                continue
            cost = rows.T @ rows + damping * np.eye(7) + 1e-4 * qp.P
            linear = -rows.T @ rhs - damping * drift
            problem = QP(cost, linear, G=wall, h=bound, lb=qp.lb, ub=qp.ub).to_qpsolvers()
            other = qpsolvers.solve_problem(problem, solver="daqp")
            np.testing.assert_allclose(found.dq, other.x, rtol=0, atol=1e-6)
            in_the_way += int(found.rows.sum())
    assert in_the_way > 5


@pytest.mark.parametrize(("asked", "is_damped"), [(0.03, False), (0.05, True)])
def test_what_is_no_quicker_than_damping_allows_is_not_damped(
    asked: float, is_damped: bool
) -> None:
    """The second joint moves the tip by 0.03 m/rad; the bound is |b| / (2 * 0.05)."""
    sigma = 0.03
    rows = np.diag([1.0, sigma])
    b = np.array([0.1, asked])
    qp = QP(np.eye(2), np.zeros(2), A=rows, b=b, lb=[-9.0, -9.0], ub=[9.0, 9.0])
    exact = asked / sigma
    assert (np.hypot(0.1, exact) > np.linalg.norm(b) / (2.0 * DAMPING)) == is_damped
    found = softened(qp)
    assert found is not None
    damping = DAMPING**2 * (1.0 - (sigma / NEAR) ** 2)
    damped = sigma * asked / (sigma**2 + damping + 1e-4)
    assert found.dq[1] == pytest.approx(damped if is_damped else exact, rel=1e-6)


@pytest.mark.parametrize("sigma", [0.04, 0.2])
def test_all_of_a_task_is_wanted_where_a_bound_leaves_room_for_it(sigma: float) -> None:
    """Joint 2 is at its bound, joint 3 can do the rest: neither damping nor the cost bends it."""
    rows = np.array([[sigma, 0.0, 0.0], [0.0, 1.0, 1.0]])
    box = np.array([3.0, 0.1, 3.0])
    qp = QP(np.eye(3), np.zeros(3), A=rows, b=[0.0, 0.3], lb=-box, ub=box)
    found = softened(qp)
    assert found is not None
    np.testing.assert_allclose(found.dq, [0.0, 0.1, 0.2], rtol=0, atol=1e-8)


def test_the_bounds_in_the_way_are_those_that_help_when_widened() -> None:
    blamed = 0
    for seed in range(10):
        qp = program(seed)
        sides = largest_fraction(qp).sides
        for i in range(7):
            wider = QP.from_data(qp.data.copy(), qp.sizes)
            wider.lb[i] -= 1e-3
            wider.ub[i] += 1e-3
            gain = largest_fraction(wider).fraction - largest_fraction(qp).fraction
            assert (gain > 1e-8) == (sides[i] != 0)
            blamed += int(sides[i] != 0)
    assert blamed > 10


@pytest.mark.parametrize("orientation", ["so3", "block", "none"])
@pytest.mark.parametrize("policy", ["slow", "relax"])
def test_policies_that_go_on_keep_the_rows_and_the_bounds(
    policy: policies.Policy, orientation: str
) -> None:
    for seed in range(10):
        qp = program(seed, orientation)
        weights = WEIGHTS.diagonal()[: qp.b.size] if orientation != "block" else None
        answer = resolve(qp, policy, weights)
        assert answer.action is (Action.SLOW if policy == "slow" else Action.RELAX)
        assert inside(answer.solution.x, qp)
        assert answer.solution.status is Status.SOLVED
        # The same program but for b, and its best point by qpsolvers' own residuals.
        np.testing.assert_array_equal(answer.qp.P, qp.P)
        np.testing.assert_array_equal(answer.qp.lb, qp.lb)
        np.testing.assert_array_equal(answer.qp.ub, qp.ub)
        np.testing.assert_array_equal(answer.qp.A, qp.A)
        problem = answer.qp.to_qpsolvers()
        assert answer.solution.to_qpsolvers(problem).is_optimal(1e-8)
        if policy == "slow" and answer.fraction != 0.1:
            np.testing.assert_allclose(
                qp.A @ answer.solution.x, answer.fraction * qp.b, rtol=0, atol=1e-8
            )
        if policy == "relax":
            assert answer.fraction == 1.0
            found = softened(qp, weights)
            assert found is not None
            np.testing.assert_array_equal(answer.solution.x, found.dq)


def test_a_joint_outside_its_limits_comes_back_whatever_the_task_says() -> None:
    for seed in range(10):
        qp = program(seed, outside=0.1)
        assert qp.lb[0] == qp.ub[0] == 0.3  # as fast as it may
        answer = resolve(qp, "slow")
        assert answer.solution.x[0] == 0.3
        assert inside(answer.solution.x, qp)
        assert answer.action in (Action.SLOW, Action.RELAX)


def test_a_reference_at_rest_is_gone_to_directly() -> None:
    qp = program(1)
    assert resolve(qp, "slow", moves=True).action is Action.SLOW
    direct = resolve(qp, "slow", moves=False)
    assert (direct.action, direct.fraction) == (Action.RELAX, 1.0)
    np.testing.assert_array_equal(direct.solution.x, resolve(qp, "relax").solution.x)


def test_stop_is_no_velocity_and_names_the_bounds() -> None:
    answer = resolve(two_joints(12.0), "stop")
    assert (answer.action, answer.fraction) == (Action.STOP, 0.0)
    assert not answer.solution.x.any()
    assert not answer.solution.found
    assert answer.sides.tolist() == [1, 1]


@pytest.mark.parametrize("policy", ["slow", "relax"])
def test_a_program_that_has_a_solution_gets_it_at_a_second_attempt(
    policy: policies.Policy,
) -> None:
    qp = program(3, velocity=100.0)
    answer = resolve(qp, policy)
    assert answer.action is Action.FALLBACK
    assert answer.fraction == 1.0
    assert answer.solution.iterations > 0
    np.testing.assert_array_equal(answer.qp.data, qp.data)
    assert answer.solution.residuals.largest <= 1e-9
    other = qpsolvers.solve_problem(qp.to_qpsolvers(), solver="proxqp")
    np.testing.assert_allclose(answer.solution.x, other.x, rtol=0, atol=1e-6)
    stationarity = qp.P @ answer.solution.x + qp.q + qp.A.T @ answer.solution.y
    np.testing.assert_allclose(stationarity + answer.solution.z_box, 0.0, atol=1e-8)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_program_that_is_no_number_stops(bad: float) -> None:
    qp = two_joints(1.0)
    qp.b[0] = bad
    answer = resolve(qp, "slow")
    assert answer.action is Action.STOP
    assert not answer.solution.x.any()


def walled(b: float, h: float) -> QP:
    """Both joints push the same way, x1 + 2 x2 = b, and a wall: x1 + x2 <= h."""
    return QP(
        np.eye(2), np.zeros(2), G=[[1.0, 1.0]], h=[h], A=[[1.0, 2.0]], b=[b],
        lb=[-1.0, -1.0], ub=[1.0, 1.0],
    )  # fmt: skip


def test_the_largest_fraction_ends_at_an_inequality_row() -> None:
    # x1 + x2 <= 0.5 lets x = (-0.5, 1) give 1.5 of the 6 that are asked for.
    reach = largest_fraction(walled(6.0, 0.5))
    assert reach.fraction == pytest.approx(0.25, abs=1e-9)
    np.testing.assert_allclose(reach.dq, [-0.5, 1.0], rtol=0, atol=1e-9)
    assert reach.rows.tolist() == [1]
    assert reach.sides.tolist() == [0, 1]
    assert largest_fraction(walled(1.0, 0.5)).fraction == 1.0
    # A wall that pushes back: not even rest is feasible.
    assert np.isnan(largest_fraction(walled(6.0, -0.5)).fraction) or (
        largest_fraction(walled(6.0, -0.5)).fraction < 0.25
    )


@pytest.mark.parametrize("policy", ["slow", "relax"])
@pytest.mark.parametrize("h", [1.0, 1e-3, 0.0, -0.3])
def test_no_policy_goes_through_a_wall(policy: policies.Policy, h: float) -> None:
    # Relax returned SOLVED at 0.126 m/s through a wall of 0.001 m/s, slow raised ValueError.
    for seed in range(5):
        base = program(seed)
        rng = np.random.default_rng(seed)
        wall = rng.standard_normal((2, 7))
        wall /= np.linalg.norm(wall, axis=1)[:, np.newaxis]
        qp = QP(base.P, base.q, wall, np.full(2, h), base.A, base.b, base.lb, base.ub)
        if DNNSolver().solve(qp).found:
            continue
        answer = resolve(qp, policy)
        assert answer.action in (Action.SLOW, Action.RELAX)
        assert inside(answer.solution.x, qp)
        assert (wall @ answer.solution.x <= h + 1e-8).all()
        np.testing.assert_array_equal(answer.qp.G, qp.G)
        np.testing.assert_array_equal(answer.qp.h, qp.h)


@pytest.mark.parametrize("policy", ["slow", "relax", "stop"])
def test_limits_that_contradict_each_other_stop_the_arm(policy: policies.Policy) -> None:
    qp = QP(
        np.eye(2), np.zeros(2), G=[[1.0, 1.0], [-1.0, -1.0]], h=[-1.0, -1.0], A=[[1.0, 2.0]],
        b=[0.5], lb=[-1.0, -1.0], ub=[1.0, 1.0],
    )  # fmt: skip
    answer = resolve(qp, policy)
    assert answer.action is Action.STOP
    assert not answer.solution.x.any()
    assert answer.rows.tolist() == [1, 1]


@pytest.mark.parametrize(
    ("row", "b", "lowest", "fraction", "dq"),
    [
        # Full speed gives 0.01 of b, and the brake takes four fifths.
        (0.01, 1.0, -1.0, 0.002, 0.2),
        (0.06, 1.0, -1.0, 0.06, 1.0),  # no singular pose
        (0.01, 1.0, 0.5, 0.01, 1.0),  # a joint that may not rest is not braked
    ],
)
def test_slow_brakes_where_the_joints_race_for_next_to_nothing(
    row: float, b: float, lowest: float, fraction: float, dq: float
) -> None:
    qp = QP(np.eye(1), np.zeros(1), A=[[row]], b=[b], lb=[lowest], ub=[1.0])
    answer = resolve(qp, "slow")
    assert answer.action is Action.SLOW
    assert answer.fraction == pytest.approx(fraction, rel=1e-6)
    np.testing.assert_allclose(answer.solution.x, [dq], rtol=0, atol=1e-7)
    assert answer.solution.status is Status.SOLVED
    np.testing.assert_allclose(answer.qp.b, [row * dq], rtol=0, atol=1e-9)
    assert answer.sides.tolist() == [1]


def test_slow_does_not_rest_in_a_singular_pose() -> None:
    # Less than a thousandth of b is left: the clock creeps on, and the damped task is followed.
    qp = QP(np.eye(2), [0.0, -9.0], A=[[1e-3, 0.0]], b=[5.0], lb=[-1.0] * 2, ub=[1.0] * 2)
    answer = resolve(qp, "slow")
    assert (answer.action, answer.fraction) == (Action.SLOW, 0.1)
    damping = DAMPING**2 * (1.0 - (1e-3 / NEAR) ** 2)
    # And towards the posture that the cost wishes for; the cost itself counts 1e-4.
    expected = [5e-3 / (1e-6 + damping + 1e-4), damping * 0.02 / (damping + 1e-4)]
    np.testing.assert_allclose(answer.solution.x, np.minimum(expected, 1.0), rtol=1e-5)
    np.testing.assert_array_equal(answer.qp.b, qp.A @ answer.solution.x)


def test_a_scaled_program_that_does_not_settle_is_relaxed() -> None:
    """Two rows that differ by 1e-4: the linear program has the factor 0.62, and none is found."""
    qp = QP(
        np.eye(2), [0.7, -0.9], A=[[0.3, 0.8], [0.3, 0.8001]], b=[0.830876, 0.831037],
        lb=[-1.0] * 2, ub=[1.0] * 2,
    )  # fmt: skip
    assert np.isnan(largest_fraction(qp).fraction)
    answer = resolve(qp, "slow")
    assert (answer.action, answer.fraction) == (Action.SLOW, 0.1)
    assert inside(answer.solution.x, qp)
    relaxed = resolve(qp, "relax")
    np.testing.assert_array_equal(answer.solution.x, relaxed.solution.x)


def test_the_page_says_how_many_systems_a_step_takes() -> None:
    page = (Path(__file__).parents[2] / "docs" / "robustness.md").read_text(encoding="utf-8")
    said = re.search(r"at most (\d+) further solves of at most (\d+) linear systems", page)
    assert said is not None
    assert [int(number) for number in said.groups()] == [ATTEMPTS - 1, BUDGET]


def test_an_elastic_row_that_asks_for_too_much_is_followed_as_far_as_the_joints_can() -> None:
    qp = QP(
        np.eye(2), np.zeros(2), G=[[1.0, 1.0]], h=[-3.0], A=[[1.0, 2.0]], b=[0.5],
        lb=[-1.0, -1.0], ub=[1.0, 1.0],
    )  # fmt: skip
    for policy in ("slow", "relax"):
        assert resolve(qp, policy).action is Action.STOP
        answer = resolve(qp, policy, elastic=True)
        assert answer.action in (Action.SLOW, Action.RELAX)
        assert qp.G @ answer.solution.x <= -0.9 * 2.0 + 1e-9
        assert answer.rows.tolist() == [1]
        assert answer.qp.h[0] == qp.G @ answer.solution.x  # and the program says what was given


def test_a_decided_velocity_is_the_best_point_of_its_program() -> None:
    qp = walled(6.0, 0.5)
    answer = resolve(qp, "relax")
    residuals = answer.qp.residuals(answer.solution.x, None, None, None)
    assert residuals.largest < 1e-12
    assert answer.solution.residuals == residuals
    assert answer.fraction == 1.0
    assert answer.rows.tolist() == [1]
    np.testing.assert_allclose(answer.solution.x, [-0.5, 1.0], rtol=0, atol=0.05)
    for part in (answer.solution.y, answer.solution.z, answer.solution.z_box):
        assert not part.any()


def test_the_share_of_a_wide_task_is_as_exact_as_of_a_small_one() -> None:
    # Whatever b is in units of the arm's reach, the linear program is scaled by it.
    for size in (3e-6, 3.0, 3e6):
        assert largest_fraction(two_joints(4.0 * size)).fraction == pytest.approx(
            min(3.0 / (4.0 * size), 1.0), rel=1e-7
        )
    nothing = QP(np.eye(1), np.zeros(1), A=[[1.0]], b=[0.0], lb=[-1.0], ub=[1.0])
    assert largest_fraction(nothing).fraction == 1.0
    free = QP(np.eye(2), np.zeros(2), lb=[-1.0, -1.0], ub=[1.0, 1.0])
    assert largest_fraction(free).fraction == 1.0


@pytest.mark.parametrize("policy", ["slow", "relax"])
def test_a_target_that_is_out_of_all_proportion_is_gone_towards(policy: policies.Policy) -> None:
    # At 1e9 m rounding was above the tolerance, and the arm stopped.
    for far in (1e3, 1e6, 1e9):
        start = paper_start()
        target = Target(start.position + [far, 0.0, 0.0], start.rotation, [0.01, 0.0, 0.0])
        command = Controller(paper_robot(), DoubleIndicator(), policy=policy).step(
            PAPER_Q0, 0.0, target
        )
        assert command.action in (Action.SLOW, Action.RELAX)
        assert (start.jacobian[0] @ command.dq) > 0.1


def test_the_codes_in_a_record_stay_what_they_are() -> None:
    codes = {action.name.lower(): int(action) for action in Action}
    assert codes == {"none": 0, "fallback": 1, "slow": 2, "relax": 3, "stop": 4, "euler": 5}
    assert {code: name for name, code in codes.items() if code} == ACTIONS


@pytest.mark.parametrize("policy", ["slow", "relax", "stop"])
@pytest.mark.parametrize("acceleration", [None, 10.0])
def test_the_residuals_of_a_decided_answer_are_its_own(
    policy: policies.Policy, acceleration: float | None
) -> None:
    robot = paper_robot().with_limits(velocity=0.3, acceleration=acceleration)
    controller = Controller(robot, DoubleIndicator(home=PAPER_Q0), policy=policy)
    for k in range(3):
        command = controller.step(PAPER_Q0, 1e-3 * k, near_target(PAPER_Q0, 3, 0.3))
        assert command.action in (Action.SLOW, Action.RELAX, Action.STOP)
        found = command.solution
        own = command.qp.residuals(found.x, found.y, found.z, found.z_box)
        np.testing.assert_allclose(found.residuals, own, rtol=0, atol=1e-12)
