"""A command is given only if the arm can still stop from it, clear of all that is near."""

from __future__ import annotations

import numpy as np
import pytest

from iiwa_dnn import (
    AccelerationLimits,
    Capsule,
    CollisionAvoidance,
    Configuration,
    Controller,
    DoubleIndicator,
    HalfSpace,
    JerkLimits,
    Limit,
    Sphere,
    Target,
    load_robot,
)
from iiwa_dnn.control.state import REST
from iiwa_dnn.control.stopping import (
    Motion,
    bend_of,
    least_periods,
    least_way,
    next_velocity,
    velocity_at,
    way_along,
    within_rates,
)
from iiwa_dnn.schemes.scene import second_order
from judge_limits import breaches

ROBOT = load_robot("iiwa7")
ACCELERATION = (AccelerationLimits(),)
JERK = (AccelerationLimits(), JerkLimits(500.0))


def limits_of(jerk: float) -> np.ndarray:
    """Limits of three joints."""
    return np.repeat([-3.0, 3.0, 3.0, 10.0, jerk, 10.0], 3)


def way_to_rest(x: np.ndarray, before: np.ndarray, jerk: float, dt: float) -> np.ndarray:
    """Velocities from before x to rest, each from the two before it, as a controller has them."""
    periods = least_periods(x, before, limits_of(jerk), dt, jerk < np.inf)
    assert np.isfinite(periods)
    cubic = jerk < np.inf
    path = [before, x]
    while periods > 0:
        pairs = zip(path[-1], path[-2], strict=True)
        path.append(np.array([next_velocity(a, b, periods, cubic) for a, b in pairs]))
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
        periods = least_periods(x, before, limits_of(jerk), dt, jerk < np.inf)
        least = float(np.ceil(np.abs(x).max() / (10.0 * dt)))
        if jerk < np.inf:
            pairs = list(zip(x, before, strict=True))
            while not all(within_rates(*pair, least, 10.0 * dt, jerk * dt**2) for pair in pairs):
                least += 1.0
        ratios.append(periods / least)
    assert min(ratios) == 1.0
    assert max(ratios) <= (1.0 if jerk == np.inf else 1.125)


@pytest.mark.parametrize("cubic", [False, True])
def test_the_way_along_a_motion_is_the_sum_of_its_velocities(cubic: bool) -> None:
    random = np.random.default_rng(4)
    for _ in range(300):
        M = float(random.integers(1, 40))
        x, before = random.standard_normal(2)
        b = bend_of(x, before, M) if cubic else 0.0
        motion = Motion(np.array([x]), np.array([b]), M, cubic)
        u = np.arange(M) / M
        velocities = x * (1 - u)
        if cubic:
            velocities = (1 - u) ** 2 * (x * (1 + 2 * u) + b * u)
        found = [velocity_at(x, b, at, cubic) for at in u]
        np.testing.assert_allclose(found, velocities, rtol=0, atol=1e-12)
        ways = np.append(0.0, np.cumsum(velocities)) * 1e-3
        assert least_way(motion, x, b, 1e-3) == pytest.approx(ways.min(), abs=1e-12)
        assert way_along(motion, x, b, M, 1e-3) == pytest.approx(ways[-1], abs=1e-12)


def pressed(
    limits: tuple[Limit, ...], obstacle: HalfSpace | Sphere, steps: int, dt: float
) -> tuple[np.ndarray, float, float]:
    """Press the arm against an obstacle, then ask it back; joint positions and least distances."""
    start = Configuration(ROBOT, ROBOT.start_posture())
    avoidance = CollisionAvoidance([obstacle], distance=0.02, self_collision=False)
    scene = avoidance.scene(ROBOT)
    scheme = DoubleIndicator(orientation="none", extra_limits=(*limits, avoidance))
    controller = Controller(ROBOT, scheme, dt=dt)
    q = start.q
    path = [q]
    for k in range(steps):
        ahead = 2.0 if k < steps // 3 else 0.0
        target = Target(start.position + [ahead, 0.0, 0.0], start.rotation)
        command = controller.step(q, k * dt, target)
        # A braking motion leaves the bounds of a step: the program in the record has them wider.
        assert command.solution.residuals.primal < 1e-8
        q = q + dt * command.dq
        path.append(q)
    found = np.array(path)
    half = 0.5 * (found[1:] + found[:-1])
    distances = [scene.nearest(each, np.zeros(len(each)))[0].min() for each in (found, half)]
    left = np.linalg.norm(Configuration(ROBOT, q).position - start.position)
    return found, min(distances), left


@pytest.mark.parametrize("limits", [ACCELERATION, JERK], ids=["acceleration", "jerk"])
@pytest.mark.parametrize("kind", ["wall", "ball"])
def test_an_arm_pressed_against_an_obstacle_stays_clear_and_comes_back(
    limits: tuple[Limit, ...], kind: str
) -> None:
    # The wall was entered by 30 mm, and the arm stayed there for good.
    tip = Configuration(ROBOT, ROBOT.start_posture()).position
    wall = HalfSpace([-1, 0, 0], float(-tip[0] - 0.35))
    obstacle = wall if kind == "wall" else Sphere(tip + [0.4, 0.05, 0.0], 0.15)
    path, least, left = pressed(limits, obstacle, 1800, 4e-3)
    assert least >= 0.02 - 1e-9
    assert least < 0.03  # it was near
    assert left < 1e-3
    jerk = 500.0 if len(limits) == 2 else np.inf
    robot = (ROBOT.q_lower, ROBOT.q_upper, ROBOT.dq_max, ROBOT.ddq_max)
    assert breaches(path, 4e-3, *robot, jerk) == []


def test_the_braking_motion_in_hand_is_that_of_the_last_command() -> None:
    """The state notes its periods, the least that the accelerations allow from the command."""
    start = Configuration(ROBOT, ROBOT.start_posture())
    wall = HalfSpace([-1, 0, 0], float(-start.position[0] - 0.35))
    avoidance = CollisionAvoidance([wall], distance=0.02, self_collision=False)
    scheme = DoubleIndicator(orientation="none", extra_limits=(*ACCELERATION, avoidance))
    controller = Controller(ROBOT, scheme, dt=4e-3)
    target = Target(start.position + [2.0, 0.0, 0.0], start.rotation)
    q = start.q
    noted = []
    least = []
    for k in range(100):
        dq = controller.step(q, k * 4e-3, target).dq
        q = q + 4e-3 * dq
        noted.append(controller._state.past[REST, 0])
        least.append(np.ceil(np.abs(dq / (4e-3 * ROBOT.ddq_max)).max() - 1e-9))
    np.testing.assert_array_equal(noted, least)
    assert max(noted) > 10.0


@pytest.mark.parametrize("limits", [ACCELERATION, JERK], ids=["acceleration", "jerk"])
def test_an_arm_that_obstacles_came_upon_goes_away_from_them(limits: tuple[Limit, ...]) -> None:
    # A capsule that had come to a resting arm kept it there for good.
    start = Configuration(ROBOT, ROBOT.start_posture())
    balls = [Sphere(start.position + [x, 0.0, z], 0.1) for x, z in ((0.3, 0.0), (0.28, -0.12))]
    bare = CollisionAvoidance(balls, distance=0.02, self_collision=False)
    scene = bare.scene(ROBOT)
    near = float(scene.nearest(start.q[None], np.zeros(1))[0][0])
    avoidance = CollisionAvoidance(balls, distance=near + 5e-3, self_collision=False)
    scheme = DoubleIndicator(orientation="none", extra_limits=(*limits, avoidance))
    controller = Controller(ROBOT, scheme, dt=4e-3)
    target = Target(start.position - [0.2, 0.0, 0.0], start.rotation)
    q = start.q
    path = [q]
    for k in range(1000):
        q = q + 4e-3 * controller.step(q, 4e-3 * k, target).dq
        path.append(q)
    assert scene.nearest(np.array(path), np.zeros(len(path)))[0].min() >= near - 1e-9
    assert np.linalg.norm(Configuration(ROBOT, q).position - target.position) < 1e-3


@pytest.mark.parametrize("limits", [ACCELERATION, JERK], ids=["acceleration", "jerk"])
def test_an_arm_beside_which_an_obstacle_lies_goes_away_from_it(limits: tuple[Limit, ...]) -> None:
    # A hand along a capsule stayed there: its nearest point went away, others came nearer.
    robot = load_robot("panda").with_limits(acceleration=10.0)
    q = np.array([0.505, -0.875, 0.621, -2.218, 0.223, 1.534, 1.903])
    capsule = Capsule([0.133, 0.415, 0.308], [0.15, 0.235, 0.695], 0.05)
    avoidance = CollisionAvoidance([capsule], distance=0.02, self_collision=False)
    scene = avoidance.scene(robot)
    assert scene.nearest(q[None], np.zeros(1))[0][0] < -5e-3
    home = Configuration(robot, robot.start_posture())
    scheme = DoubleIndicator(orientation="none", extra_limits=(*limits, avoidance))
    controller = Controller(robot, scheme, dt=4e-3)
    target = Target(home.position, home.rotation)
    path = [q]
    for k in range(1500):
        q = q + 4e-3 * controller.step(q, 4e-3 * k, target).dq
        path.append(q)
    distances, _ = scene.nearest(np.array(path), np.zeros(len(path)))
    assert np.diff(distances[distances < 0.02]).min() > -1e-9
    assert np.linalg.norm(Configuration(robot, q).position - home.position) < 1e-3
    jerk = 500.0 if len(limits) == 2 else np.inf
    kinds = (robot.q_lower, robot.q_upper, robot.dq_max, robot.ddq_max, jerk)
    assert breaches(np.array(path), 4e-3, *kinds) == []


def test_an_arm_just_outside_the_distance_is_in_no_trap() -> None:
    # With acceleration limits an arm 10 um above the distance never moved again.
    start = Configuration(ROBOT, ROBOT.start_posture())
    bare = CollisionAvoidance([Sphere(start.position + [0.3, 0.0, 0.0], 0.1)], distance=0.02,
                              self_collision=False)  # fmt: skip
    near = float(bare.scene(ROBOT).nearest(start.q[None], np.zeros(1))[0][0])
    avoidance = CollisionAvoidance(bare.obstacles, distance=near - 1e-5, self_collision=False)
    scheme = DoubleIndicator(orientation="none", extra_limits=(*ACCELERATION, avoidance))
    controller = Controller(ROBOT, scheme)
    q = start.q
    for k in range(1500):
        target = Target(start.position + [-0.1, 0.0, 0.0], start.rotation)
        q = q + 1e-3 * controller.step(q, 1e-3 * k, target).dq
    assert np.linalg.norm(Configuration(ROBOT, q).position - target.position) < 1e-3


def test_a_ball_that_no_joint_can_evade_is_said_to_be_in_the_way() -> None:
    # Upright, no joint moves the arm away from above: the row was weakened to 0 dq <= 0.
    upright = np.zeros(7)
    conf = Configuration(ROBOT, upright)
    falling = Sphere(conf.position + [0.0, 0.0, 0.4], 0.1, velocity=[0.0, 0.0, -0.1])
    avoidance = CollisionAvoidance([falling], distance=0.02, self_collision=False)
    scene = avoidance.scene(ROBOT)
    controller = Controller(ROBOT, DoubleIndicator(orientation="none", extra_limits=(avoidance,)))
    q = upright
    for k in range(4000):
        command = controller.step(q, 1e-3 * k, Target(conf.position, conf.rotation))
        q = q + 1e-3 * command.dq
        if scene.nearest(q[None], np.array([1e-3 * (k + 1)]))[0][0] < 0.02:
            break
    assert k < 3999
    assert not command.ok


@pytest.mark.parametrize(
    ("moves", "radii", "expected"),
    [
        # What slides after a turn is turned with it; what slides before it is not.
        ([1.0, 1.0], [-1.0, 0.5], 0.05 * 0.1),
        ([1.0, 1.0], [0.5, -1.0], 0.1 * 0.2 + 2.0 * 0.1 * 0.2),
        ([-1.0, -1.0], [0.5, -1.0], 0.1 * 0.2),
        ([-1.0, -1.0], [-1.0, 0.5], 0.05 * 0.1 + 2.0 * 0.2 * 0.1),
    ],
)
def test_joints_that_slide_and_turn_bend_a_way(
    moves: list[float], radii: list[float], expected: float
) -> None:
    travel = np.array([0.2, 0.1])
    found = second_order(np.array([moves]), np.array([radii]), 0, travel)
    assert found == pytest.approx(expected)


def test_a_velocity_that_others_chose_is_shortened_until_it_is_clear() -> None:
    ball = Sphere(Configuration(ROBOT, ROBOT.start_posture()).position + [0.0, 0.2, 0.0], 0.1)
    avoidance = CollisionAvoidance([ball], self_collision=False, distance=0.05)
    scene = avoidance.scene(ROBOT)
    controller = Controller(ROBOT, DoubleIndicator(extra_limits=(avoidance,)), dt=2e-2)
    coming = CollisionAvoidance(
        [Sphere(ball.center, 0.1, velocity=[0.0, -0.5, 0.0])], self_collision=False, distance=0.05
    )
    chased = Controller(ROBOT, DoubleIndicator(extra_limits=(coming,)), dt=2e-2)
    random = np.random.default_rng(0)
    shares = []
    others = []
    for _ in range(400):
        q = ROBOT.start_posture() + random.uniform(-0.3, 0.3, 7)
        dq = ROBOT.dq_max * random.uniform(-1.0, 1.0, 7)
        share = controller.clear_share(q, dq)
        before, after = (
            scene.nearest(at[None], np.zeros(1))[0][0] for at in (q, q + 2e-2 * share * dq)
        )
        assert after >= min(before, 0.05) - 1e-12
        shares.append(share)
        others.append(chased.clear_share(q, dq))
    assert (np.array(others) <= shares).all()
    assert (np.array(others) < shares).any()
    assert 0 < np.sum(np.array(shares) < 1.0) < 300
