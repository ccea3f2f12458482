"""A command is given only if the arm can still stop from it, clear of all that is near."""

from typing import Any

import numpy as np
import pytest

import iiwa_dnn as d
from helpers_simulation import driven, limits_of_joints, own
from iiwa_dnn.schemes import rest
from iiwa_dnn.schemes.joint_limits import MotionConstants
from iiwa_dnn.schemes.scene import Pair, second_order
from iiwa_dnn.step import stopping
from iiwa_dnn.step.policies import ProgramKind
from iiwa_dnn.step.state import MotionState
from judge_limits import breaches

ROBOT = d.load_robot("iiwa7")
ACCELERATION = (d.AccelerationLimits(),)
JERK = (d.AccelerationLimits(), d.JerkLimits(500.0))


def limits_of(jerk: float) -> MotionConstants:
    """Limits of three joints."""
    return limits_of_joints(-3.0, 3.0, 3.0, 10.0, jerk, joints=3)


def way_to_rest(x: np.ndarray, before: np.ndarray, jerk: float, dt: float) -> np.ndarray:
    """Velocities from before x to rest, each from the two before it, as a controller has them."""
    periods = stopping.least_periods(x, before, limits_of(jerk), dt, False)
    assert np.isfinite(periods)
    cubic = jerk < np.inf
    path = [before, x]
    while periods > 0:
        pairs = zip(path[-1], path[-2], strict=True)
        path.append(np.array([stopping.next_velocity(a, b, periods, cubic) for a, b in pairs]))
        periods -= 1
    return np.array(path)


@pytest.mark.parametrize("jerk", [np.inf, 500.0])
@pytest.mark.parametrize("dt", [1e-3, 1e-2])
def test_a_motion_to_rest_keeps_acceleration_and_jerk(jerk: float, dt: float) -> None:
    random = np.random.default_rng(3)
    for k in range(400):
        # Slow ones too: the last step to rest, of one period or two, was above the jerk limit.
        largest = 2.0 if k < 200 else 3.0 * min(10.0, jerk * dt) * dt
        x = random.uniform(-largest, largest, 3)
        before = x - random.uniform(-1.0, 1.0, 3) * min(10.0, jerk * dt) * dt
        path = way_to_rest(x, before, jerk, dt)
        assert not path[-1].any()
        found = np.diff(path, axis=0) / dt
        assert (np.abs(found) <= 10.0 * (1.0 + 1e-8)).all()
        if jerk < np.inf:
            rested = np.vstack([found, np.zeros((2, 3))])
            assert (np.abs(np.diff(rested, axis=0)) / dt <= jerk * (1.0 + 1e-8)).all()


@pytest.mark.parametrize("jerk", [np.inf, 500.0])
def test_the_periods_to_rest_are_the_least_or_an_eighth_more(jerk: float) -> None:
    random = np.random.default_rng(5)
    dt, ratios = 1e-3, []
    for _ in range(200):
        x = 10.0 ** random.uniform(-2.0, 0.0) * random.uniform(-2.0, 2.0, 3)
        before = x - random.uniform(-1.0, 1.0, 3) * min(10.0, 30.0 * jerk * dt) * dt
        limits = limits_of(jerk)
        periods = stopping.least_periods(x, before, limits, dt, False)
        least = float(np.ceil(np.abs(x).max() / (10.0 * dt)))
        if jerk < np.inf:
            pairs = list(zip(x, before, strict=True))
            while not all(
                stopping.within_rates(*pair, least, 10.0 * dt, jerk * dt**2, False)
                for pair in pairs
            ):
                least += 1.0
        ratios.append(periods / least)
    assert min(ratios) == 1.0
    assert max(ratios) <= (1.0 if jerk == np.inf else 1.125)
    assert stopping.next_velocity(1.2, 1.2, 1.2, False) == pytest.approx(0.2)  # a period changed


START = d.Configuration(ROBOT, ROBOT.start_posture())


def beside(distance: float, *obstacles: Any) -> d.CollisionAvoidance:
    return d.CollisionAvoidance(obstacles, distance=distance, self_collision=False)


def approached(parts, target, steps, dt=4e-3, q=START.q, robot=ROBOT) -> tuple[np.ndarray, float]:
    """Joint positions of an arm on its way to a target, and what is left at the end [m]."""
    scheme = d.DoubleIndicator(orientation="none", extra_limits=parts)
    path, commands = driven(d.Controller(robot, scheme, dt=dt), q, steps, target)
    # A stopping motion leaves the bounds of a step: the program in the record has them wider.
    assert max(command.solution.residuals.primal for command in commands) < 1e-8
    goal = commands[-1].targets[0, :3]
    left = np.linalg.norm(d.Configuration(robot, path[-1]).position - goal)
    jerk = 500.0 if any(isinstance(part, d.JerkLimits) for part in parts) else np.inf
    kinds = (robot.q_lower, robot.q_upper, robot.dq_max, robot.ddq_max, jerk)
    assert breaches(path, dt, *kinds) == []
    return path, float(left)


def distances(avoidance: d.CollisionAvoidance, path: np.ndarray, robot=ROBOT) -> np.ndarray:
    return avoidance.scene(robot).nearest(path, np.zeros(len(path)))[0]


def tip_at(*away: float) -> d.Target:
    return d.Target(START.position + away, START.rotation)


WALL = d.HalfSpace([-1, 0, 0], float(-START.position[0] - 0.35))
BALL = d.Sphere(START.position + [0.4, 0.05, 0.0], 0.15)
BOTH = pytest.mark.parametrize("limits", [ACCELERATION, JERK], ids=["acceleration", "jerk"])


@BOTH
@pytest.mark.parametrize("obstacle", [WALL, BALL], ids=["wall", "ball"])
def test_an_arm_pressed_against_an_obstacle_stays_clear_and_comes_back(limits, obstacle) -> None:
    # The wall was entered by 30 mm, and the arm stayed there for good.
    avoidance = beside(0.02, obstacle)
    path, left = approached(
        (*limits, avoidance), lambda t: tip_at(2.0 * (t < 600 * 4e-3), 0.0, 0.0), 1800
    )
    between = 0.5 * (path[1:] + path[:-1])
    least = distances(avoidance, np.vstack([path, between])).min()
    assert 0.02 - 1e-9 <= least < 0.03
    assert left < 1e-3


def test_the_braking_motion_in_hand_is_that_of_the_last_command() -> None:
    """The state notes its periods, the least that the accelerations allow from the command."""
    scheme = d.DoubleIndicator(orientation="none", extra_limits=(*ACCELERATION, beside(0.02, WALL)))
    controller = d.Controller(ROBOT, scheme, dt=4e-3)
    q = START.q
    noted = []
    least = []
    for k in range(100):
        dq = controller.step(q, k * 4e-3, tip_at(2.0, 0.0, 0.0)).dq
        q = q + 4e-3 * dq
        noted.append(controller._motion.stopping_periods)
        least.append(np.ceil(np.abs(dq / (4e-3 * ROBOT.ddq_max)).max() - 1e-9))
    np.testing.assert_array_equal(noted, least)
    assert max(noted) > 10.0


@BOTH
def test_an_arm_that_obstacles_came_upon_goes_away_from_them(limits: tuple[d.Limit, ...]) -> None:
    # A capsule that had come to a resting arm kept it there for good.
    balls = [d.Sphere(START.position + [x, 0.0, z], 0.1) for x, z in ((0.3, 0.0), (0.28, -0.12))]
    near = distances(beside(0.02, *balls), START.q[None])[0]
    path, left = approached((*limits, beside(near + 5e-3, *balls)), tip_at(-0.2, 0.0, 0.0), 1000)
    assert distances(beside(0.02, *balls), path).min() >= near - 1e-9
    assert left < 1e-3


@BOTH
def test_an_arm_beside_which_an_obstacle_lies_goes_away_from_it(limits) -> None:
    # A hand along a capsule stayed there: its nearest point went away, others came nearer.
    robot = d.load_robot("panda").with_limits(acceleration=10.0)
    q = np.array([0.505, -0.875, 0.621, -2.218, 0.223, 1.534, 1.903])
    avoidance = beside(0.02, d.Capsule([0.133, 0.415, 0.308], [0.15, 0.235, 0.695], 0.05))
    home = d.Configuration(robot, robot.start_posture())
    target = d.Target(home.position, home.rotation)
    path, left = approached((*limits, avoidance), target, 1500, q=q, robot=robot)
    found = distances(avoidance, path, robot)
    assert found[0] < -5e-3
    assert found.min() > found[0] - 1e-6  # and, once beyond, no nearer than it has to be
    assert found[np.argmax(found > 0.02) :].min() > 0.02 - 1e-9
    assert left < 1e-3


def test_an_arm_just_outside_the_distance_is_in_no_trap() -> None:
    # With acceleration limits an arm 10 um above the distance never moved again.
    ball = d.Sphere(START.position + [0.3, 0.0, 0.0], 0.1)
    near = distances(beside(0.02, ball), START.q[None])[0]
    _, left = approached(
        (*ACCELERATION, beside(near - 1e-5, ball)), tip_at(-0.1, 0.0, 0.0), 1500, 1e-3
    )
    assert left < 1e-3


@BOTH
@pytest.mark.parametrize("speed", [0.05, 0.3])
def test_a_resting_arm_gives_way_to_a_ball(limits, speed: float) -> None:
    # With a jerk limit no retreat was proven to go away all along: the ball ran into the arm.
    ball = d.Sphere(START.position + [0.3, 0.1, 0.05], 0.05, velocity=[-speed, 0.0, 0.0])
    avoidance = beside(0.02, ball)
    path, _ = approached((*limits, avoidance), tip_at(0.0, 0.0, 0.0), int(150 / speed))
    times = 4e-3 * np.arange(len(path))
    assert avoidance.scene(ROBOT).nearest(path, times)[0].min() > 0.019
    assert np.abs(path - START.q).max() > 0.05


def test_an_arm_that_braked_in_continuous_mode_goes_on() -> None:
    scheme = d.DoubleIndicator(orientation="none", extra_limits=(beside(0.02, WALL),))
    controller = d.Controller(ROBOT, scheme, dt=1e-3, mode="continuous")
    _, commands = driven(controller, START.q, 1500, lambda t: tip_at(0.5 * (t < 1.0), 0.0, 0.0))
    braked = [bool(command.action) for command in commands]
    assert any(braked)
    assert not all(braked[braked.index(True) :])


def test_a_ball_that_no_joint_can_evade_is_said_to_be_limiting() -> None:
    # Upright, no joint moves the arm away from above: the row was weakened to 0 dq <= 0.
    q = np.zeros(7)
    conf = d.Configuration(ROBOT, q)
    falling = d.Sphere(conf.position + [0.0, 0.0, 0.4], 0.1, velocity=[0.0, 0.0, -0.1])
    avoidance = beside(0.02, falling)
    controller = d.Controller(
        ROBOT, d.DoubleIndicator(orientation="none", extra_limits=(avoidance,))
    )
    for k in range(4000):
        command = controller.step(q, 1e-3 * k, d.Target(conf.position, conf.rotation))
        q = q + 1e-3 * command.dq
        if avoidance.scene(ROBOT).nearest(q[None], np.array([1e-3 * (k + 1)]))[0][0] < 0.02:
            break
    assert k < 3999
    assert not command.ok


@pytest.mark.parametrize(
    ("support", "radii", "expected"),
    [
        # What slides after a turn is turned with it; what slides before it is not.
        ([1.0, 1.0], [-1.0, 0.5], 0.05 * 0.1),
        ([1.0, 1.0], [0.5, -1.0], 0.1 * 0.2 + 2.0 * 0.1 * 0.2),
        ([-1.0, -1.0], [0.5, -1.0], 0.1 * 0.2),
        ([-1.0, -1.0], [-1.0, 0.5], 0.05 * 0.1 + 2.0 * 0.2 * 0.1),
    ],
)
def test_joints_that_slide_and_turn_curve_a_path(support, radii, expected) -> None:
    travel = np.array([0.2, 0.1])
    pair = Pair.make(second=0, first=0, unmoved_end=0, allowance=0.0, support=support, radii=radii)
    assert second_order(pair, travel) == pytest.approx(expected)


def test_a_velocity_that_others_chose_is_tested_for_distances() -> None:
    ball = START.position + [0.0, 0.2, 0.0], 0.1
    still, coming = (
        beside(0.05, d.Sphere(*ball, velocity=[0.0, speed, 0.0])) for speed in (0.0, -0.5)
    )
    controller, chased = (
        d.Controller(ROBOT, d.DoubleIndicator(extra_limits=(each,)), dt=2e-2)
        for each in (still, coming)
    )
    random = np.random.default_rng(0)
    clear = np.zeros(2)
    for _ in range(400):
        q = START.q + random.uniform(-0.3, 0.3, 7)
        dq = ROBOT.dq_max * random.uniform(-1.0, 1.0, 7)
        found = controller.is_clear(q, dq), chased.is_clear(q, dq)
        before, after = distances(still, np.array([q, q + 2e-2 * dq]))
        assert after >= min(before, 0.05) - 1e-12 or not found[0]
        assert found[0] >= found[1]
        clear += found
    assert 400 > clear[0] > clear[1] > 100


def test_a_limit_of_ones_own_has_a_word_on_the_motion_to_rest() -> None:
    """It has no rows: nothing but its refusals keeps the first joint within 0.3 rad."""

    class Fence(d.Limit):
        kernel = staticmethod(lambda *arrays: None)

        @staticmethod
        def rest_kernel(step: Any, constants: Any, motion: Any) -> bool:
            x, b = motion[0][0], motion[1][0]
            displacement = rest.end_displacement(rest.Motion(*motion), -x, -b)
            return bool(step.q[0] - displacement <= START.q[0] + 0.3)

    shield = d.Shield(ROBOT.with_limits(jerk=500.0), 4e-3)
    request = 0.5 * np.eye(7)[0]
    q = START.q
    for _ in range(400):
        q = shield.step(q, request).next_q
    assert q[0] - START.q[0] == pytest.approx(0.8, rel=0.05)
    shield = d.Shield(ROBOT.with_limits(jerk=500.0), 4e-3)
    shield.limits += (Fence(),)
    path = [START.q]
    for _ in range(400):
        path.append(shield.step(path[-1], request).next_q)
    assert 0.29 < np.max(path, axis=0)[0] - START.q[0] <= 0.3
    kinds = (ROBOT.q_lower, ROBOT.q_upper, ROBOT.dq_max, ROBOT.ddq_max, 500.0)
    assert breaches(np.array(path), 4e-3, *kinds) == []


def test_a_limit_says_how_long_it_holds() -> None:
    class Rows(d.Limit):
        kernel = staticmethod(lambda *arrays: None)

    quick = own(d.Limit, bounds=(-np.ones(7), np.ones(7)))
    assert Rows().title == "Rows (this step only)"
    titles = [each.title for each in (*JERK, beside(0.1, BALL), d.JointLimits(), quick)]
    assert titles[:2] == ["AccelerationLimits", "JerkLimits"]
    assert titles[2:] == ["CollisionAvoidance", "JointLimits", "Own (as at this step)"]


def test_an_arm_pressed_into_a_corner_is_answered_within_few_linear_solves() -> None:
    """Where bounds and rows leave nothing, they are widened to the stored motion: 265 before."""
    pytest.importorskip("coal")
    import hostile

    robot = d.load_robot("panda").with_limits(acceleration=10.0, jerk=np.inf)
    ball = d.Sphere([0.5, 0.2, 0.5], 0.08)
    wall = d.Box([0.5, -0.35, 0.2], [0.2, 0.1, 0.4])
    post = d.Capsule([0.3, 0.45, 0.0], [0.3, 0.45, 0.7], 0.04)
    avoidance = d.CollisionAvoidance([ball, wall, post], distance=0.02)
    case = hostile.Case(robot, avoidance, 2e-3, 900, False, "none", "slow")
    shield = d.Shield(robot, case.dt, avoidance.obstacles)
    q = case.start.q
    solves = []
    limited = 0
    for _, request in zip(range(900), hostile.requests(case, 8), strict=False):
        command = shield.step(q, **request)
        q = command.next_q
        solves.append(command.solution.iterations)
        limited += command.kind is ProgramKind.RATE_LIMITED
    assert limited > 100
    assert max(solves) < 60


def test_a_stored_motion_counts_the_periods_of_its_step() -> None:
    """It is verified in the longest periods, four of the stated ones each."""
    robot = ROBOT.with_limits(acceleration=10.0, jerk=np.inf)
    shield = d.Shield(robot, 1e-3, [d.Sphere([0.0, 0.0, 3.0], 0.1)], longest_period=4e-3)
    q = START.q
    for _ in range(50):
        command = shield.step(q, np.full(7, 0.3), dt=1e-3)
        q = command.next_q
    motion = shield.layout(ROBOT.tip).step.program.arrays.sizes
    state = MotionState.of(np.array(command.state.motion), motion.joints, motion.pairs)
    assert command.dq == pytest.approx(0.3)
    assert state.stopping_periods == 4.0 * np.ceil(0.3 / (10.0 * 4e-3))


def test_an_arm_that_is_halted_carries_the_stored_motion_out() -> None:
    scheme = d.DoubleIndicator(extra_limits=(*ACCELERATION, beside(0.02, WALL)))
    controller = d.Controller(ROBOT, scheme, dt=4e-3)
    path, commands = driven(controller, START.q, 40, tip_at(0.0, 0.2, 0.0))
    begun = commands[-1].dq
    periods = int(controller._motion.stopping_periods)
    assert periods > 5
    controller.halt()
    _, commands = driven(controller, path[-1], periods + 1, tip_at(0.0, 0.2, 0.0))
    left = 1.0 - np.minimum(np.arange(1, periods + 2) / periods, 1.0)
    found = [command.dq for command in commands]
    np.testing.assert_allclose(found, left[:, np.newaxis] * begun, atol=1e-12)


def test_a_joint_does_not_pass_its_limit_in_the_longest_period_whatever_its_gain() -> None:
    limits = (d.JointLimits(gain=1000.0),)
    scheme = d.Scheme([d.KineticEnergy()], [d.PositionTask()], limits)
    robot = ROBOT.with_limits(lower=START.q - 0.05, upper=START.q + 0.05)
    controller = d.Controller(robot, scheme, dt=1e-3, longest_period=1e-2, policy="relax")
    q = START.q
    for k in range(60):
        command = controller.step(q, 1e-2 * k, tip_at(0.3, 0.3, 0.0))
        q = q + 1e-2 * command.dq
        assert robot.outside(q) == ""
    assert np.abs(q - START.q).max() > 0.049


def test_a_policy_that_acted_is_asked_first_at_the_next_step() -> None:
    scheme = d.DoubleIndicator(orientation="none", extra_limits=ACCELERATION)
    controller = d.Controller(ROBOT, scheme, dt=4e-3)
    _, commands = driven(controller, START.q, 3, tip_at(0.0, 0.05, 0.0))
    assert [command.kind.name for command in commands] == ["RATE_LIMITED"] * 3
    assert controller._motion.yields
    # The nominal program of such a step is not solved: its network's state stays.
    before = controller.solver.state_for(controller.program.sizes).copy()
    controller.step(commands[-1].next_q, 0.0, tip_at(0.0, 0.05, 0.0))
    np.testing.assert_array_equal(controller.solver.state_for(controller.program.sizes), before)
