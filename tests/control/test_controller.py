"""A controller: its steps are their parts, one after the other, in every loop and mode."""

import copy
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import iiwa_dnn as d
from helpers_kinematics import PAPER_Q0, dh_pose
from helpers_simulation import driven, heart, near_target, paper_robot, paper_start, run

DT = 1e-3
PLANAR = d.robot_from_dh([(0.4, 0.0, 0.0, 0.0)] * 3, lower=-3.0, upper=3.0, velocity=1.0)


def test_a_command_says_in_words_what_it_is() -> None:
    start = paper_start()
    far = d.Target(start.position + [0.5, 0.0, 0.0], start.rotation)
    controller = d.Controller(paper_robot(), d.DoubleIndicator(), policy="stop")
    command = controller.step(PAPER_Q0, 0.0, far)
    assert "stopped, limited by joint 4 lower velocity limit; ok = False>" in repr(command)
    assert repr(command.qp) == "<QP of 7 variables: 0 inequalities, 6 equalities, 14 bounds>"
    controller.policy = "relax"
    relaxed = repr(controller.step(PAPER_Q0, 0.0, far))
    assert "no solution: relaxed, limited by" in relaxed


@pytest.mark.parametrize("gain", [10.2, np.inf])
@pytest.mark.parametrize("compiled", [True, False])
def test_targets_of_two_frames_are_sampled_ahead_too(gain: float, compiled: bool) -> None:
    robot = d.load_robot("iiwa7_dual")
    start = d.Configuration(robot, robot.start_posture())
    left, right = "left_iiwa7_flange", "right_iiwa7_flange"
    still = d.MovingTarget(start.frame(right))  # which has no compiled form
    other: d.Reference = d.Circle().anchored(start.frame(right)) if compiled else still
    references = {right: other, left: d.Heart().anchored(start.frame(left))}
    tasks = [d.PositionTask(frame=right, gain=gain), d.PoseTask(frame=left, gain=gain)]
    scheme = d.Scheme([d.CyclicMotion()], tasks)
    if gain == np.inf:
        references = {name: reference.feed_forward(1e-3) for name, reference in references.items()}
    ahead = d.Controller(robot, scheme, references, dt=1e-3)
    one_by_one = d.Controller(robot, scheme, dt=1e-3)
    q = start.q
    for k in range(20):
        given = {name: reference.at(k * 1e-3) for name, reference in references.items()}
        dq = ahead.step(q, k * 1e-3).dq
        want = one_by_one.step(q, k * 1e-3, given).dq
        np.testing.assert_allclose(dq, want, rtol=0, atol=1e-9)
        q = q + 1e-3 * dq


def test_a_network_that_lags_says_that_it_keeps_bounds_alone() -> None:
    ball = d.Sphere(paper_start().position + [0.2, 0.0, 0.0], 0.05)
    avoidance = d.CollisionAvoidance([ball], self_collision=False)
    scheme = d.DoubleIndicator(home=PAPER_Q0, extra_limits=(avoidance,))
    controller = d.Controller(paper_robot(), scheme, mode="continuous")
    near = near_target(np.array(PAPER_Q0), 0, size=2e-3)
    with pytest.warns(UserWarning, match="the rows of CollisionAvoidance hold where"):
        controller.step(PAPER_Q0, 0.0, near)


def test_a_loop_that_is_most_likely_wrong_is_warned_of() -> None:
    inside = d.CollisionAvoidance([d.Sphere(paper_start().position, 0.1)])
    controller = d.Controller(
        paper_robot(), d.DoubleIndicator(extra_limits=(inside,)), heart(), dt=0.5
    )
    with pytest.warns(UserWarning, match="Sphere 1 and iiwa7_link_7 are -0.1"):
        controller.step(PAPER_Q0, 0.0)
    with pytest.raises(AttributeError, match="no setting 'polcy'"):
        controller.polcy = "stop"  # type: ignore[attr-defined]


@dataclass(frozen=True)
class Dead(d.networks.Network):
    """A network whose rates are no numbers."""

    def state_size(self, qp: d.QP) -> int:
        return qp.q.size + qp.b.size

    def flow(self, qp: d.QP, rate: float | None = None) -> Any:
        return d.networks.Flow(lambda state: np.full(state.size, np.nan))


def test_what_a_network_failed_at_is_not_its_success() -> None:
    # The network of the fallback programs answered, and the run was one without a failure.
    record = run(solver=d.DNNSolver(Dead()), duration=0.01)
    assert "9 steps unsolved in all" in d.failures(record)[0]


@pytest.mark.parametrize(("orientation", "said"), [("so3", 1), ("block", 1), ("none", 0)])
def test_too_few_joints_for_a_pose_are_warned_of_once(orientation: Any, said: int) -> None:
    # The paper's four rows have rank 3: six joints fulfil all seven rows.
    for locked, times in ((("iiwa7_joint_3", "iiwa7_joint_5"), said), (("iiwa7_joint_3",), 0)):
        robot = d.load_robot("iiwa7", locked=locked)
        q0 = robot.start_posture()
        circle = d.Circle(0.01).anchored(d.Configuration(robot, q0))
        controller = d.Controller(
            robot, d.DoubleIndicator(orientation=orientation), circle, dt=1e-2
        )
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            controller.step(q0, 0.0)
            controller.step(q0, 1e-2)
        assert [str(each.message)[:23] for each in caught] == ["5 joints cannot fulfil "] * times


def warnings_of(controller: d.Controller, q: np.ndarray) -> list[str]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        controller.step(q, 0.0)
    return [str(each.message) for each in caught]


def next_motion_state(robot: d.Robot, q: Any, path: d.Reference, *tasks: d.Task) -> list[str]:
    scheme = d.Scheme([d.CyclicMotion()], tasks, [d.JointLimits()])
    loop = d.Controller(robot, scheme, path.anchored(d.Configuration(robot, q)), dt=1e-2)
    return warnings_of(loop, np.asarray(q, float))


def test_rank_counts_not_rows() -> None:
    """A table with two axes, and a planar arm of three joints, follow what is in their plane."""
    quarter = np.pi / 2
    table = d.robot_from_dh(
        [(0.0, quarter, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)], velocity=1.0, prismatic=[1, 2]
    )
    bent = [0.3, 0.8, 0.5]
    for offset, said in (([0.02, -0.03, 0.0], 0), ([0.0, 0.02, 0.03], 1)):
        across = [offset[2], offset[0], offset[1]]  # the plane of y and z
        for found in (
            next_motion_state(table, [0.1, 0.2], d.Line(offset=across), d.PositionTask()),
            next_motion_state(PLANAR, bent, d.Line(offset=offset), d.PositionTask()),
            next_motion_state(PLANAR, bent, d.Line(offset=offset), d.PoseTask()),
        ):
            assert [" joints cannot fulfil the " in each for each in found] == [True] * said


def test_a_start_in_a_singular_posture_is_named() -> None:
    inwards = d.Line(offset=[-0.3, 0.0, 0.0])
    (said,) = next_motion_state(PLANAR, np.zeros(3), inwards, d.PositionTask())
    assert said == (
        "3 joints cannot fulfil the 3 rows of the tasks, whose rank at the start is 1: "
        "a singular posture, or tasks that contradict each other"
    )
    (said,) = next_motion_state(
        PLANAR, np.zeros(3), d.Line(offset=[0.0, 0.1, 0.0]), d.PositionTask()
    )
    assert "beyond the arm's reach" in said  # the way there begins as the joints move


def test_a_command_in_a_singular_posture_says_so() -> None:
    """Straight, no joint moves the tip along the arm; bent, each does."""
    scheme = d.Scheme([d.CyclicMotion()], [d.PositionTask()], [d.JointLimits()])
    for q, reasons in (
        (np.zeros(3), ("a singular posture, or tasks that contradict each other",)),
        (np.array([0.3, 1.0, 0.9]), ()),
    ):
        tip = d.Configuration(PLANAR, q).position
        command = d.Controller(PLANAR, scheme, dt=1e-2).step(q, 0.0, d.Target(tip - [0.01, 0, 0]))
        assert command.active_limits == reasons
        assert command.ok == (not reasons)
    up = d.Target(tip + [0.0, 0.0, 0.1], d.Configuration(PLANAR, q).rotation)
    straight = d.Controller(PLANAR, scheme, dt=1e-2).step(q, 0.0, up)
    assert straight.active_limits == ("a singular posture, or tasks that contradict each other",)
    whole = d.Scheme([d.CyclicMotion()], [d.PoseTask()], [d.JointLimits()])
    raised = d.Controller(PLANAR, whole, dt=1e-2).step(q, 0.0, up)
    assert "a singular posture, or tasks that contradict each other" in raised.active_limits


def test_a_start_in_degrees_is_asked_about() -> None:
    loop = d.Controller(paper_robot(), d.DoubleIndicator(), heart())
    assert warnings_of(loop, np.degrees(PAPER_Q0))[0].endswith("are the positions in degrees?")
    loop = d.Controller(paper_robot(), d.DoubleIndicator(), heart())
    assert "degrees" not in warnings_of(loop, np.array(PAPER_Q0) + [0, 0, 0, 0, 3, 0, 0])[0]


SCHEMES: dict[str, d.Scheme] = {
    "so3": d.DoubleIndicator(home=PAPER_Q0),
    "block": d.DoubleIndicator(home=PAPER_Q0, orientation="block"),
    "position": d.DoubleIndicator(home=PAPER_Q0, orientation="none"),
    "inertia": d.DoubleIndicator(home=PAPER_Q0, kinetic="inertia", weight=0.7),
    "no home": d.DoubleIndicator(),
    "pseudo-inverse": d.PseudoInverse(),
}
STATUS = {"converged": d.Status.SOLVED, "continuous": d.Status.ADVANCED}


class Asked(d.DNNSolver):
    """A solver that the controller has to ask, since it could solve in any way of its own."""


@pytest.mark.parametrize("substeps", [None, 5])
@pytest.mark.parametrize("mode", ["converged", "continuous"])
@pytest.mark.parametrize("scheme", SCHEMES.values(), ids=SCHEMES.keys())
def test_a_compiled_step_is_its_parts_one_after_the_other(scheme, mode, substeps) -> None:
    advance_integrator = d.ExplicitEuler(substeps)
    robot = paper_robot()
    compiled, asked = (
        d.Controller(robot, scheme, mode=mode, dt=1e-4, solver=solver)
        for solver in (
            d.DNNSolver(advance_integrator=advance_integrator),
            Asked(advance_integrator=advance_integrator),
        )
    )
    rng = np.random.default_rng(7)
    for seed in range(20):
        q = np.array(PAPER_Q0) + 1e-3 * rng.standard_normal(7)
        target = near_target(q, seed, size=2e-3)
        one = compiled.step(q, 0.0, target)
        other = asked.step(q, 0.0, target)
        # The compiler may round a product and its sum in one place once, in another twice.
        np.testing.assert_allclose(one.dq, other.dq, rtol=0, atol=1e-11)
        conf = d.Configuration(robot, q)
        np.testing.assert_array_equal(one.qp.data, other.qp.data)
        np.testing.assert_array_equal(one.qp.data, compiled.scheme.build_qp(conf, target).data)
        assert one.solution.status is other.solution.status
        assert one.solution.status is STATUS[mode]
        if mode == "continuous":
            assert one.solution.network_time == pytest.approx(1e-4 / 9e-5)
        np.testing.assert_allclose(one.solution.point, other.solution.point, rtol=0, atol=1e-9)
        residuals = one.solution.residuals
        np.testing.assert_allclose(residuals, other.solution.residuals, rtol=1e-9, atol=1e-11)
        assert one.solution.network_time == pytest.approx(other.solution.network_time)
        np.testing.assert_array_equal(one.log.placement[:9].reshape(3, 3).T, conf.rotation)
        np.testing.assert_array_equal(one.log.placement[9:], conf.position)
        np.testing.assert_array_equal(one.targets[0], target.data)
    np.testing.assert_allclose(compiled.solver.state, asked.solver.state, rtol=0, atol=1e-9)


CHANGED: dict[str, dict[str, Any]] = {
    "scheme": {"scheme": d.DoubleIndicator(home=PAPER_Q0, position_gain=1.0)},
    "robot": {"robot": paper_robot().with_limits(velocity=0.5)},
    "reference": {"reference": d.Circle(radius=0.02).anchored(paper_start())},
    "period": {"dt": 2e-3},  # by which the targets are sampled ahead
    "period of a network that lags": {"mode": "continuous", "dt": 3e-4},
    "mode": {"mode": "continuous"},
    "solver": {"solver": d.DNNSolver(tol=1e-12)},
}


@pytest.mark.parametrize("changed", CHANGED.values(), ids=CHANGED)
def test_what_is_changed_counts_from_the_next_step_on(changed: dict[str, Any]) -> None:
    settings: dict[str, Any] = {
        "robot": paper_robot(),
        "scheme": d.DoubleIndicator(home=PAPER_Q0, sample="end"),
        "reference": heart(),
        "dt": 1e-4,
        "solver": d.DNNSolver(tol=1e-4),
    }
    controller = d.Controller(**settings)
    anew = d.Controller(**settings | changed)
    for k in range(3):
        controller.step(PAPER_Q0, 1e-4 * k)
    for name, value in changed.items():
        setattr(controller, name, value)
    command = controller.step(PAPER_Q0, 3e-4)
    expected = anew.step(PAPER_Q0, 3e-4)
    np.testing.assert_allclose(command.qp.data, expected.qp.data, rtol=0, atol=1e-9)
    assert command.solution.status is expected.solution.status
    if anew.mode == "continuous":
        assert command.solution.network_time == expected.solution.network_time
    else:
        assert command.solution.residuals.largest <= anew.solver.tol


def test_commands_stay_what_they_were() -> None:
    controller = d.Controller(paper_robot(), d.DoubleIndicator(), heart(), dt=DT)
    path, commands = driven(controller, PAPER_Q0, 300)
    for k, command in enumerate(commands):
        np.testing.assert_array_equal(path[k] + DT * command.dq, path[k + 1])
        np.testing.assert_array_equal(command.solution.x, command.dq)
        conf = d.Configuration(paper_robot(), path[k])
        qp = controller.scheme.build_qp(conf, heart().at(k * DT))
        np.testing.assert_allclose(command.qp.data, qp.data, rtol=0, atol=1e-9)
        assert command.ok


def test_warm_up_at_a_posture_leaves_nothing_to_be_laid_out() -> None:
    cold, warm = (
        d.Controller(paper_robot(), d.DoubleIndicator(), heart(), dt=DT) for _ in range(2)
    )
    warm.warm_up(PAPER_Q0)
    laid_out = warm.control_layout
    np.testing.assert_array_equal(driven(warm, PAPER_Q0, 30)[0], driven(cold, PAPER_Q0, 30)[0])
    assert warm.control_layout is laid_out
    assert cold.control_layout is not laid_out
    with pytest.raises(d.InvalidInputError, match=r"^q\b"):
        warm.warm_up(PAPER_Q0[:6])


def test_the_reference_is_judged_at_the_time_of_the_first_step() -> None:
    """A run that is taken up later begins where the path is then, wherever it began."""
    half = round(1.0 / DT)  # 7.6 cm from where the path began
    first, again, late = (
        d.Controller(paper_robot(), d.DoubleIndicator(), heart(2.0), dt=DT) for _ in "123"
    )
    q = driven(first, PAPER_Q0, half)[0][-1]
    again.warm_up(q)
    again.step(q, half * DT)  # a warning would be an error
    with pytest.warns(UserWarning, match=r"begins 0\.07\d* m and 0\.000 rad from"):
        late.step(PAPER_Q0, half * DT)
    far = d.Line((2.0, 0.0, 0.0)).anchored(paper_start())
    for path, said in ((d.Circle(), "the reference begins"), (far, "beyond the arm's reach")):
        elsewhere = d.Controller(paper_robot(), d.DoubleIndicator(), path, dt=DT)
        elsewhere.warm_up(PAPER_Q0)
        with pytest.warns(UserWarning, match=said):
            elsewhere.step(PAPER_Q0, 0.0)


@pytest.mark.parametrize("mode", ["converged", "continuous"])
def test_a_loop_that_jitters_says_the_period_of_each_step(mode) -> None:
    random = np.random.default_rng(0)
    scheme = d.DoubleIndicator(home=PAPER_Q0)
    told = d.Controller(paper_robot(), scheme, heart(), dt=DT, mode=mode)
    told.step(PAPER_Q0, 0.0)
    laid_out = told.control_layout
    q = np.array(PAPER_Q0)
    t = 0.0
    for period in DT * random.uniform(0.5, 1.5, 300):
        anew = d.Controller(paper_robot(), scheme, heart(), dt=period, mode=mode)
        anew.solver = copy.deepcopy(told.solver)
        command = told.step(q, t, dt=period)
        expected = anew.step(q, t)
        np.testing.assert_allclose(command.dq, expected.dq, rtol=0, atol=1e-12)
        np.testing.assert_array_equal(command.next_q, q + period * command.dq)
        q = command.next_q
        t += period
    assert told.control_layout is laid_out
    assert np.linalg.norm(dh_pose(q)[0] - heart().at(t).position) < 5e-5


@pytest.mark.parametrize("weight", [5e7, 1e9])
def test_a_soft_task_of_any_weight_is_carried_out(weight: float) -> None:
    """Limits are idle: numpy's solution of the normal equations is the answer."""
    robot = d.load_robot("iiwa7")
    q = robot.start_posture()
    path = d.Heart(period=4.0).anchored(d.Configuration(robot, q))
    costs, tasks = [d.CyclicMotion(weight=1.0, gain=10.2)], [d.PoseTask(weight=weight)]
    controller = d.Controller(robot, d.Scheme(costs, tasks, [d.JointLimits()]), path, dt=1e-3)
    for k in range(400):
        command = controller.step(q, k * 1e-3)
        assert command.solution.found, k
        q = command.next_q
        if k % 50 == 0:
            known = np.linalg.solve(command.qp.P, -command.qp.q)
            np.testing.assert_allclose(command.dq, known, rtol=0.0, atol=1e-6)
