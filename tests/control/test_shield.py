"""A shield gives the request where the limits admit it, and a safe command close to it else."""

import copy
import dataclasses
import itertools
import pickle
import threading
import time
from typing import Any

import numpy as np
import pytest
import qpsolvers

import iiwa_dnn as d
from iiwa_dnn.control.shield import ShieldCommand
from judge_limits import breaches

DT = 1e-3
START = np.array([-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0])
PLAIN = d.load_robot("iiwa7")
ROBOT = PLAIN.with_limits(acceleration=10.0)
SMOOTH = PLAIN.with_limits(acceleration=10.0, jerk=500.0)
BALL = d.Sphere([0.36, 0.16, 0.64], 0.05)


def drive(shield, steps, q=START, **requested: Any) -> tuple[np.ndarray, list[ShieldCommand]]:
    """Follow every command from q; return the joint positions (steps + 1, n) and the commands."""
    path = [q]
    commands = []
    for _ in range(steps):
        commands.append(shield.step(path[-1], **requested))
        path.append(path[-1] + shield.dt * commands[-1].dq)
    return np.array(path), commands


def limits_broken(path: np.ndarray, robot: d.Robot) -> list[Any]:
    kinds = (robot.q_lower, robot.q_upper, robot.dq_max, robot.ddq_max, robot.dddq_max)
    return breaches(path, DT, *kinds)


@pytest.mark.parametrize("robot", [PLAIN, ROBOT, SMOOTH])
@pytest.mark.parametrize("obstacles", [None, [BALL]])
def test_an_admissible_request_goes_through_to_the_last_bit(robot, obstacles) -> None:
    """A slow sum of sines from rest breaks no limit, and stays away from all of them."""
    shield = d.Shield(robot, DT, obstacles)
    random = np.random.default_rng(0)
    speed = random.uniform(-0.1, 0.1, 7)
    rate = random.uniform(0.5, 3.0, 7)
    q = START
    for k in range(2000):
        requested = speed * np.sin(rate * k * DT) ** 3
        command = shield.step(q, requested)
        np.testing.assert_array_equal(command.dq, requested)
        assert not command.clipped
        assert command.active_limits == ()
        q = q + DT * command.dq


@pytest.mark.parametrize("robot", [PLAIN, ROBOT, SMOOTH])
def test_a_clipped_command_is_the_nearest_one_by_another_solver(robot: d.Robot) -> None:
    """Where the arm can stop from the program's answer, that is the command, by ProxQP too."""
    shield = d.Shield(robot, DT, [BALL])
    random = np.random.default_rng(1)
    q = START
    compared = 0
    for _ in range(600):
        requested = 2.0 * robot.dq_max * random.standard_normal(7)
        command = shield.step(q, requested)
        if command.ok:
            qp = command.limits
            if robot is not SMOOTH:
                np.testing.assert_array_equal(qp.q, -requested)
            nearest = qpsolvers.solve_problem(
                qp.to_qpsolvers(), "proxqp", eps_abs=1e-11, eps_rel=0.0, max_iter=10_000
            )
            if not nearest.found:  # ProxQP gives a few of them up
                continue
            np.testing.assert_allclose(command.dq, nearest.x, atol=1e-6)
            compared += command.clipped
        q = q + DT * command.dq
    assert compared > 300


@pytest.mark.parametrize(
    ("requested", "swing", "most"),
    [
        (np.array([0.3, -0.2, 0.1, 0.4, -0.3, 0.2, 0.1]), 0.0, 1e-9),
        (np.full(7, 0.5), 0.2, 3.0 * 500.0 * DT**2),
    ],
)
def test_a_request_that_jumps_is_reached_and_not_passed(requested, swing, most) -> None:
    shield = d.Shield(SMOOTH, DT)
    path = [START]
    limits = []
    for k in range(400):
        moving = requested * (1.0 + swing * np.sin(2.0 * k * DT))
        command = shield.step(path[-1], moving)
        assert (np.abs(command.dq) <= np.abs(moving) + most).all()
        limits.append(command.active_limits)
        path.append(path[-1] + DT * command.dq)
    np.testing.assert_array_equal(command.dq, moving)
    assert any("jerk" in name for name in limits[0])
    assert limits_broken(np.array(path), SMOOTH) == []


@pytest.mark.parametrize("robot", [PLAIN, ROBOT, SMOOTH])
def test_positions_are_reached_and_not_passed(robot: d.Robot) -> None:
    """From a single request, as a chunk of a policy brings it."""
    goal = START + np.array([0.4, 0.2, -0.3, -0.5, 0.1, 0.6, -0.2])
    shield = d.Shield(robot, DT, timeout=np.inf)
    first = shield.step(START, position=goal)
    path, commands = drive(shield, 3000, START + DT * first.dq)
    np.testing.assert_allclose(path[-1], goal, atol=1e-9)
    assert np.abs(commands[-1].dq).max() < 1e-13
    beyond = (path - goal) * np.sign(goal - START)
    assert beyond.max() < 1e-9
    assert limits_broken(np.vstack([START, path]), robot) == []


def test_a_twist_moves_its_frame() -> None:
    """Far from singular poses the damping costs less than a hundredth."""
    shield = d.Shield(ROBOT, DT)
    twist = np.array([0.0, 0.0, 0.05, 0.0, 0.0, 0.0])
    for name in (None, ROBOT.frame_names[len(ROBOT.frame_names) // 2]):
        J = d.Configuration(ROBOT, START).frame(name or ROBOT.tip).jacobian
        reachable = J @ np.linalg.pinv(J) @ twist
        shield.reset()
        path, commands = drive(shield, 100, twist=twist, frame=name)
        J = d.Configuration(ROBOT, path[-2]).frame(name or ROBOT.tip).jacobian
        np.testing.assert_allclose(J @ commands[-1].dq, reachable, atol=2e-3)
        if name is None:  # it is fulfilled, and not clipped
            assert commands[-1].active_limits == ()
            np.testing.assert_allclose(J @ commands[-1].dq, twist, atol=1e-3)


def test_an_arm_that_is_pressed_into_a_corner_leaves_it() -> None:
    """After 20 minutes of hostile targets five distances were the least one to the last bit.

    Links lie along others and along a capsule there: the nearest points alone do not say which way
    is free.
    """
    robot = d.load_robot("ur5")
    corner = np.array([-2.10634089, 6.05502721, 2.54782412, -0.90683012, -1.07616272, -0.22138032])
    bar = d.Capsule(
        [0.22438298, -0.12498536, -0.18995659], [0.09009972, -0.2652352, -0.0022584], 0.05
    )
    shield = d.Shield(robot, 5e-3, [bar, d.Sphere([-0.45624664, -0.42911206, 0.21851064], 0.08)])
    assert shield.step(corner).margin.distance < 1e-7
    free = np.random.default_rng(0).uniform(-0.2, 0.2, (2, 6))[1]
    path, _ = drive(shield, 200, corner, position=corner + free)
    assert np.abs(path[-1] - corner).max() > 0.1


def test_a_pinch_of_two_joints_leaves_the_others_free() -> None:
    # Two links asked for retreats of nanometres that contradict each other.
    robot = d.load_robot("panda").with_limits(jerk=np.inf)
    q = np.array([0.5101309, 0.90004666, 2.0541013, -2.8338797, -1.4594971, 0.828962, 0.42747])
    ends = [0.164259087, -0.005569339, 0.305072028], [0.489386502, -0.263747799, -0.012197345]
    shield = d.Shield(robot, 0.0128, [d.Capsule(*ends, 0.05)])
    path, _ = drive(shield, 50, q, dq=np.array([-1.0, -1.0, -1.0, 1.0, 1.0, 1.0, 1.0]))
    assert (np.abs(path[-1] - q)[2:] > 0.5).all()


@pytest.mark.parametrize(
    ("requested", "reason"),
    [
        ({"dq": np.full(7, np.nan)}, "request not finite"),
        ({"position": np.full(7, np.inf)}, "request not finite"),
        ({}, "request timed out"),
    ],
)
def test_without_a_request_the_arm_brakes_and_goes_on_without_a_jump(requested, reason) -> None:
    shield = d.Shield(SMOOTH, DT, timeout=0.05)
    speed = np.full(7, 0.2)
    begun, _ = drive(shield, 300, dq=speed)
    braked, commands = drive(shield, 400, begun[-1], **requested)
    resumed, _ = drive(shield, 300, braked[-1], dq=speed)
    path = np.vstack([begun, braked[1:], resumed[1:]])
    assert limits_broken(path, SMOOTH) == []
    assert commands[-1].active_limits == (reason,)
    assert not commands[-1].dq.any()
    if not requested:  # it counts for `timeout`
        ends = [command.active_limits for command in commands[:51]]
        assert ends[:50] == [()] * 50
        assert ends[50][0] == reason
    np.testing.assert_array_equal(np.diff(path, axis=0)[-1], np.diff(resumed, axis=0)[-1])
    np.testing.assert_allclose((resumed[-1] - resumed[-2]) / DT, speed, atol=1e-12)


@pytest.mark.parametrize("size", [1e6, 1e100, 1e300])
@pytest.mark.parametrize("obstacles", [None, [BALL]])
def test_requests_of_any_size_are_answered(size: float, obstacles: list[d.Sphere] | None) -> None:
    """The arm goes where a request of 900 rad/s leads, and limits are named."""
    paths = []
    for speed in (900.0, size):
        shield = d.Shield(ROBOT, DT, obstacles)
        path, commands = drive(shield, 30, dq=np.full(7, speed))
        assert commands[-1].active_limits
        paths.append(path)
    np.testing.assert_allclose(paths[1], paths[0], atol=1e-6)
    assert np.ptp(paths[1], axis=0).max() > 1e-3
    for requested in ({"position": np.full(7, size)}, {"twist": np.full(6, size)}):
        path, commands = drive(d.Shield(PLAIN, DT, obstacles), 30, **requested)
        assert np.ptp(path, axis=0).max() > 1e-3
        assert breaches(path, DT, PLAIN.q_lower, PLAIN.q_upper, PLAIN.dq_max) == []


def test_a_halt_lasts_until_the_reset() -> None:
    shield = d.Shield(ROBOT, DT)
    path, _ = drive(shield, 100, dq=np.full(7, 0.2))
    shield.halt()
    rest, commands = drive(shield, 100, path[-1], dq=np.full(7, 0.2))
    assert limits_broken(np.vstack([path, rest[1:]]), ROBOT) == []
    assert not commands[-1].dq.any()
    assert commands[-1].active_limits == ("halted",)
    shield.limits = shield.limits
    assert shield.step(rest[-1], np.full(7, 0.2)).active_limits == ("halted",)
    shield.reset()
    assert shield.step(rest[-1]).active_limits == ("no request",)
    assert shield.step(rest[-1], np.full(7, 1e-3)).active_limits == ()


@pytest.mark.parametrize("copied", [copy.copy, lambda each: pickle.loads(pickle.dumps(each))])
def test_a_copy_goes_on_from_the_last_command(copied: Any) -> None:
    robot = d.load_robot("iiwa7").with_limits(acceleration=10.0)
    shield, q = d.Shield(robot), robot.start_posture()
    for k in range(40):
        command = shield.step(q, np.ones(7)) if k < 20 else shield.step(q, twist=np.full(6, 0.1))
        q = q + 1e-3 * command.dq
    twin = copied(shield)
    for _ in range(5):  # neither knows of the other
        assert np.abs(twin.step(q, np.ones(7)).dq - command.dq).max() <= 0.051
    assert np.abs(shield.step(q, np.ones(7)).dq - command.dq).max() <= 0.0101


def test_measured_positions_count_only_where_they_are_far() -> None:
    shield = d.Shield(ROBOT, DT, tracking_error=0.01)
    shield.step(START, np.zeros(7))
    near = shield.step(START + 0.009, np.zeros(7))
    np.testing.assert_array_equal(near.log.q, START)
    far = shield.step(START + 0.011, np.zeros(7))
    np.testing.assert_array_equal(far.log.q, START + 0.011)
    assert far.active_limits == ("resynchronised to measured positions",)


def test_margin_and_stopping_time_are_those_of_closed_forms() -> None:
    """The distance of a resting arm from a ball grows with the ball's way; v / a is the time."""
    at = d.Configuration(ROBOT, START).position
    margins = []
    for away in (0.5, 0.6):
        ball = d.Sphere(at + np.array([0.0, 0.0, away]), 0.05)
        shield = d.Shield(ROBOT, DT, [ball], distance=0.03)
        margins.append(shield.step(START, np.zeros(7)).margin)
    assert margins[0].distance <= margins[1].distance < 0.6
    room = np.minimum(START - ROBOT.q_lower, ROBOT.q_upper - START).min()
    assert margins[0].joint == pytest.approx(room, abs=1e-12)
    shield = d.Shield(ROBOT, DT)
    _, commands = drive(shield, 100, dq=np.full(7, 0.5))
    assert commands[-1].stopping_time == pytest.approx(0.05, abs=DT)
    shield = d.Shield(PLAIN, DT, [])  # without a limit of acceleration, the period of the command
    assert shield.step(START, np.full(7, 0.1)).stopping_time == DT
    assert shield.step(START, np.zeros(7)).stopping_time == 0.0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"dq": np.zeros(6)}, "dq: must have shape"),
        ({"twist": np.zeros(7)}, "twist: must have shape"),
        ({"position": "home"}, "position: must be numbers"),
        ({"dq": np.zeros(7), "twist": np.zeros(6)}, "dq, twist, position: pass exactly one"),
        ({"dq": np.zeros(7), "q": np.full(7, np.nan)}, "q: must be finite"),
        ({"twist": np.zeros(6), "frame": "bogus"}, "no frame 'bogus'"),
    ],
)
def test_wrong_requests_are_refused_and_change_nothing(
    arguments: dict[str, Any], words: str
) -> None:
    shield = d.Shield(ROBOT, DT)
    shield.step(START, np.full(7, 0.01))
    with pytest.raises(d.IiwaDnnError, match=words):
        shield.step(**{"q": START} | arguments)
    shield.step(START)  # the last request counts
    np.testing.assert_array_equal(shield.step(START, np.full(7, 0.02)).dq, np.full(7, 0.02))


@pytest.mark.parametrize("joints", [20, 40])
def test_an_arm_of_many_joints_has_a_shield(joints: int) -> None:
    """A target has 18 numbers: the velocities of more joints go into several."""
    robot = d.robot_from_dh([(0.1, 0.0, 0.0, 0.0)] * joints, lower=-2.0, upper=2.0, velocity=1.0)
    shield = d.Shield(robot)
    requested = np.linspace(-0.5, 0.5, joints)
    np.testing.assert_array_equal(shield.step(np.zeros(joints), requested).dq, requested)
    path, _ = drive(shield, 400, np.zeros(joints), position=0.1 * requested)
    np.testing.assert_allclose(shield.step(path[-1]).next_q, 0.1 * requested, atol=1e-9)


def test_a_request_is_cut_by_the_joints_own_limit_and_the_cut_is_a_reason() -> None:
    """A slide in millimetres was cut at 1,000 without a word; positions swung 1814, 228, 1722."""
    slide = d.robot_from_dh([(0, 0, 0, 0)], lower=0.0, upper=1e5, velocity=2000.0, prismatic=[1])
    slide = slide.with_limits(acceleration=18000.0, jerk=190000.0)
    shield = d.Shield(slide)
    path, commands = drive(shield, 1000, np.array([100.0]), dq=np.array([2000.0]))
    assert commands[-1].dq == 2000.0
    assert commands[-1].active_limits == ()
    path, commands = drive(d.Shield(slide), 1000, np.array([100.0]), position=np.array([1000.0]))
    speeds = np.diff(path[:, 0]) / DT
    top = int(speeds.argmax())
    assert np.flatnonzero(np.abs(path[:, 0] - 1000.0) < 1e-3)[0] <= 660
    assert (np.diff(speeds[: top + 1]) >= -0.2).all()
    assert (np.diff(speeds[top:]) <= 0.2).all()
    far = d.Shield(PLAIN).step(START, np.full(7, 1e3))
    assert far.active_limits[0] == "request cut"
    assert d.Shield(PLAIN).step(START, twist=np.full(6, 1e4)).active_limits[0] == "request cut"
    assert "request cut" not in d.Shield(PLAIN).step(START, np.full(7, 50.0)).active_limits


def test_next_q_is_where_the_command_leads() -> None:
    command = d.Shield(ROBOT, DT).step(START, np.full(7, 0.3))
    np.testing.assert_array_equal(command.next_q, START + DT * command.dq)


def test_a_limit_that_is_added_holds() -> None:
    """The speed of the tip is that of finite differences of Pinocchio's placements."""
    shield = d.Shield(SMOOTH, DT)
    shield.limits += (d.TipSpeedLimit(0.2),)
    path, commands = drive(shield, 300, dq=np.full(7, 1.0))
    tips = np.array([d.Configuration(SMOOTH, q).position for q in path])
    speeds = np.linalg.norm(np.diff(tips, axis=0), axis=1) / DT
    assert 0.19 < speeds.max() < 0.2 + 1e-4
    assert "TipSpeedLimit" in commands[-1].active_limits[0]


def test_limits_are_refused_while_the_arm_moves_and_hold_from_rest_on() -> None:
    """It began anew at rest: commands jumped by the whole velocity, beyond the acceleration."""
    shield = d.Shield(SMOOTH, DT)
    path, _ = drive(shield, 100, dq=np.full(7, 0.2))
    before = shield.limits
    with pytest.raises(d.InvalidInputError, match="limits: are set at rest: halt the arm first"):
        shield.limits += (d.TipSpeedLimit(0.2),)
    assert shield.limits is before
    shield.halt()
    rest, _ = drive(shield, 100, path[-1])
    assert limits_broken(np.vstack([path, rest[1:]]), SMOOTH) == []
    shield.limits += (d.TipSpeedLimit(0.2),)
    assert shield.step(rest[-1], np.full(7, 0.2)).active_limits == ("halted",)


def test_a_collision_avoidance_states_distance_and_pairs() -> None:
    avoidance = d.CollisionAvoidance([BALL], distance=0.03)
    made = d.Shield(ROBOT, DT, avoidance)
    path, commands = drive(made, 300, dq=np.ones(7))
    same, _ = drive(d.Shield(ROBOT, DT, [BALL], distance=0.03), 300, dq=np.ones(7))
    np.testing.assert_array_equal(path, same)
    assert min(command.margin.distance for command in commands) < 1e-3
    alone = dataclasses.replace(avoidance, self_collision=False)
    scene = alone.scene(ROBOT)
    order = np.argsort(distances := scene.distances(START[np.newaxis], np.zeros(1))[0])
    free = dataclasses.replace(alone, may_touch=[scene.pairs[order[0]]])
    found = d.Shield(ROBOT, DT, free).step(START).margin.distance
    assert found == pytest.approx(distances[order[1]] - 0.03, abs=1e-9)


def test_a_warm_shield_takes_its_first_steps_as_any_other() -> None:
    shield = d.Shield(SMOOTH, DT, [BALL])
    shield.warm_up(START, [SMOOTH.tip])
    times = []
    for k in range(40):
        begun = time.perf_counter()
        shield.step(START, **({"dq": np.zeros(7)} if k % 2 else {"twist": np.zeros(6)}))
        times.append(time.perf_counter() - begun)
    assert max(times[:2]) < 20.0 * np.median(times)
    cold = d.Shield(SMOOTH, DT, [BALL])
    np.testing.assert_array_equal(
        cold.step(START, np.full(7, 9.0)).dq, shield.step(START, np.full(7, 9.0)).dq
    )


def test_threads_may_share_a_shield() -> None:
    """Each command keeps the acceleration from the one before it, whoever asked for it."""
    shield = d.Shield(ROBOT, DT, tracking_error=np.pi)
    shield.step(START, np.zeros(7))
    found: list[d.control.shield.ShieldCommand] = []

    def ask(sign: float) -> None:
        for k in range(300):
            request = {"dq": np.full(7, sign)} if k % 2 else {"twist": np.full(6, sign)}
            found.append(shield.step(START, **request))

    threads = [threading.Thread(target=ask, args=(sign,)) for sign in (-1.0, 1.0, 0.3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    found.sort(key=lambda command: command.state.time)
    assert len({command.state.time for command in found}) == 900
    for before, after in itertools.pairwise(found):
        np.testing.assert_array_equal(after.log.last, before.dq)
        assert np.abs(after.dq - before.dq).max() <= 10.0 * DT + 1e-12


@pytest.mark.parametrize("dt", [2e-3, 5e-3])
def test_positions_are_reached_to_the_nanometre(dt: float) -> None:
    """With a jerk limit a joint came to rest up to 6e-5 rad short of where it was to go."""
    random = np.random.default_rng(0)
    shield = d.Shield(SMOOTH, dt, timeout=np.inf)
    q = START
    for k in range(6):
        far = random.uniform(SMOOTH.q_lower + 0.2, SMOOTH.q_upper - 0.2) - START
        goal = START + (far if k % 2 else far * 10.0 ** random.uniform(-6, -1))
        sides = np.sign(goal - q)
        path, commands = drive(shield, int(4.0 / dt), q, position=goal)
        q = path[-1]
        np.testing.assert_allclose(q, goal, atol=1e-12)
        assert commands[-1].active_limits == ()
        assert ((path - goal) * sides).max() < 1e-12


def least_time(x: float, goal: float, upper: float, limits: tuple[float, ...]) -> float:
    """Time from rest to rest in the phase plane, with velocity limits of v and of the position."""
    v, a, offset, steepness = limits
    at = np.linspace(x, goal, 20_001)
    square = np.minimum(v, np.sqrt(2.0 * steepness * (upper - at)) - offset) ** 2
    square = np.minimum(square, 2.0 * a * (at - x))
    square[-1] = 0.0
    step = at[1] - at[0]
    for i in range(at.size - 2, -1, -1):
        square[i] = min(square[i], square[i + 1] + 2.0 * a * step)
    speed = np.sqrt(square)
    return float((2.0 * step / (speed[1:] + speed[:-1])).sum())


@pytest.mark.parametrize("short", [1e-3, 2e-2])
@pytest.mark.parametrize("joint", [1, 3, 5, 6])
def test_joints_of_an_fr3_arrive_below_their_velocity_limits(joint: int, short: float) -> None:
    """Five of seven rested 32 to 49 mrad from their limits, where 6 to 11 were enough."""
    robot = d.load_robot("fr3")
    offset, steepness = robot.position_dependent_velocity[:, joint]
    start = np.array(robot.start_posture())
    goal = start.copy()
    goal[joint] = robot.q_upper[joint] - offset**2 / (2.0 * steepness) - short
    shield = d.Shield(robot, 1e-3, timeout=np.inf)
    path, commands = drive(shield, 2600, start, position=goal)
    np.testing.assert_allclose(path[-1], goal, atol=1e-9)
    assert commands[-1].active_limits == ()
    q = path[:, joint]
    room = np.sqrt(2.0 * steepness * (robot.q_upper[joint] - q[1:])) - offset
    assert (np.diff(q) / 1e-3 <= room + 1e-9).all()
    arrived = int(np.flatnonzero(goal[joint] - q < 1e-4)[0]) * 1e-3
    limits = (robot.dq_max[joint], robot.ddq_max[joint], offset, steepness)
    best = least_time(start[joint], goal[joint] - 1e-4, robot.q_upper[joint], limits)
    assert 1.0 <= arrived / best < 1.05


def test_what_a_velocity_limit_does_not_let_an_fr3_reach_is_named() -> None:
    robot = d.load_robot("fr3")
    offset, steepness = robot.position_dependent_velocity[:, 0]
    goal = np.array(robot.start_posture())
    goal[0] = robot.q_upper[0] - 1e-3
    path, commands = drive(d.Shield(robot, 1e-3), 2500, robot.start_posture(), position=goal)
    left = robot.q_upper[0] - offset**2 / (2.0 * steepness) - path[-1, 0]
    assert 0.0 <= left < 1e-4
    assert commands[-1].active_limits == ("joint 1 upper position-dependent velocity limit",)


@pytest.mark.parametrize("name", ["iiwa7", "panda", "ur5"])
def test_a_twist_beyond_the_reach_is_said_and_does_not_slide(name: str) -> None:
    """At the edge of the reach the tip moved 7 to 35 cm sideways in 10 s, and nothing was said."""
    robot = d.load_robot(name)
    q = np.array(robot.start_posture())
    away = d.Configuration(robot, q).position - [0.0, 0.0, 0.3]
    away /= np.linalg.norm(away)
    path, commands = drive(d.Shield(robot, 5e-3), 2400, q, twist=[*(0.2 * away), 0.0, 0.0, 0.0])
    tip = np.array([d.Configuration(robot, q).position for q in path[400::50]])
    sideways = (tip - tip[0]) - np.outer((tip - tip[0]) @ away, away)
    assert np.linalg.norm(sideways, axis=1).max() < 0.01
    assert all(command.clipped for command in commands[400::50])
    assert commands[-1].active_limits[0] == "singular posture"


@pytest.mark.parametrize("delay", [0.0, 0.02])
def test_a_command_that_was_sent_counts_as_that_of_a_step(delay: float) -> None:
    """Somebody else sends the commands of a twin's steps; from then on both answer the same."""
    made = d.Shield(SMOOTH, DT, [BALL], delay=delay)
    twin = d.Shield(SMOOTH, DT, [BALL], delay=delay)
    q = made.step(START, np.full(7, 5.0)).next_q
    np.testing.assert_array_equal(twin.step(START, np.full(7, 5.0)).next_q, q)
    for k in range(60):
        command = twin.step(q, np.full(7, (-1.0) ** (k // 20)))
        if k < 30:
            made.send(command.dq)
        else:
            other = made.step(q, np.full(7, (-1.0) ** (k // 20)))
            np.testing.assert_array_equal(other.dq, command.dq)
        q = q + DT * command.dq


def test_a_sent_command_that_is_none_is_refused_and_changes_nothing() -> None:
    shield = d.Shield(SMOOTH, DT)
    q = shield.step(START, np.full(7, 0.1)).next_q
    twin = copy.deepcopy(shield)
    for wrong in (np.zeros(6), np.full(7, np.nan)):
        with pytest.raises(d.InvalidInputError, match="dq"):
            shield.send(wrong)
    np.testing.assert_array_equal(shield.step(q).dq, twin.step(q).dq)


def test_a_shield_that_is_reset_repeats_its_motion_to_the_last_bit() -> None:
    """The networks began from the states that an earlier motion had left."""
    shield = d.Shield(SMOOTH, DT, [BALL])
    runs = []
    for _ in range(2):
        shield.reset()
        random = np.random.default_rng(0)
        q = START
        for k in range(300):
            if k % 30 == 0:
                kind = ("twist", "dq", "position")[k // 30 % 3]
                request = {kind: random.standard_normal(6 if kind == "twist" else 7)}
            q = shield.step(q, **request).next_q
        runs.append(q)
    np.testing.assert_array_equal(runs[1], runs[0])


def test_a_command_that_was_handed_out_never_changes() -> None:
    shield = d.Shield(SMOOTH, DT, [BALL])
    q = START
    kept = []
    for k in range(60):
        command = shield.step(q, np.full(7, 5.0 * (-1) ** (k // 20)))
        own = (command.clipped, command.active_limits, command.margin, command.stopping_time)
        kept.append((command, own, command.qp.data.copy()))
        q = command.next_q
    shield.halt()
    shield.step(q)
    shield.reset()
    for command, own, data in kept:
        found = (command.clipped, command.active_limits, command.margin, command.stopping_time)
        assert found == own
        np.testing.assert_array_equal(command.qp.data, data)


def test_a_joint_without_rate_limits_is_not_behind_because_of_any() -> None:
    robot = d.load_robot("ur10").with_limits(acceleration=np.inf, jerk=np.inf)
    shield = d.Shield(robot, 4e-3, [])
    random = np.random.default_rng(0)
    q = robot.start_posture()
    named = set()
    for k in range(300):
        if k % 100 == 0:
            goal = random.uniform(np.maximum(robot.q_lower, -3.0), np.minimum(robot.q_upper, 3.0))
        command = shield.step(q, position=goal)
        named |= {*command.active_limits}
        q = command.next_q
    assert any("velocity" in name for name in named)
    assert not any("acceleration" in name or "jerk" in name for name in named)
