"""Limit of a frame's speed: its row and its motions to rest beside Pinocchio, and closed loops."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import iiwa_dnn as d
from helpers_kinematics import Array
from helpers_simulation import driven, paper_robot, paper_start, rows_of
from iiwa_dnn.schemes import AccelerationLimits, JerkLimits
from iiwa_dnn.schemes.joint_limits import MotionLimits
from iiwa_dnn.schemes.rest import Motion
from iiwa_dnn.schemes.tip_speed import TipSpeedConstants, keeps_speed, velocity_after
from iiwa_dnn.step.stopping import least_periods, write_cubic_coefficients

DT = 2e-3
PANDA = d.load_robot("panda").with_limits(acceleration=10.0, jerk=500.0)


def velocity(robot: d.Robot, q: Array, dq: Array, frame: str | None = None) -> Array:
    there = d.Configuration(robot, q)
    jacobian = there.frame(frame or robot.tip).jacobian
    return np.asarray(jacobian[:3] @ dq)


@pytest.mark.parametrize("fraction", [0.5, 2.0])
def test_the_row_is_the_speed_along_the_last_velocity(fraction: float) -> None:
    start = paper_start()
    last = np.array([-0.3, 0.2, -0.1, -0.4, 0.3, -0.2, -0.5])
    along = velocity(start.robot, start.q, last)
    speed = np.linalg.norm(along)
    qp = rows_of(d.TipSpeedLimit(fraction * speed, gain=50.0), start, dt=DT, dq=last)
    assert_allclose(qp.G[0], along @ start.jacobian[:3] / speed, atol=1e-12)
    growth = DT * 50.0 * (fraction - 1.0) * speed
    # The change of the posture in a period is taken off: no less than the one there is.
    later = velocity(start.robot, start.q + DT * last, last)
    assert qp.h[0] <= speed + growth - DT * 50.0 * max(np.linalg.norm(later) - speed, 0.0)
    assert qp.h[0] == pytest.approx(speed + growth, abs=2e-4)


@pytest.mark.parametrize("dq", [np.zeros(7), np.eye(7)[6]])
def test_a_tip_at_rest_has_an_idle_row(dq: Array) -> None:
    qp = rows_of(d.TipSpeedLimit(0.1), d.Configuration(paper_robot(), np.zeros(7)), dt=DT, dq=dq)
    assert np.isinf(qp.h).all()


def instant(robot: d.Robot, q: Array, limit: d.TipSpeedLimit):
    """The instant of an arm at rest at q, as kernels read it."""
    program = d.Scheme(limits=[limit]).program(robot)
    none = np.zeros(robot.dof)
    return program.step_at(q, none, none, np.zeros((0, 18)), DT, 0.0, np.zeros(0))


@pytest.mark.parametrize("frame", ["panda_hand", "panda_link5"])
def test_the_velocity_after_a_displacement_is_pinocchios(frame: str) -> None:
    random = np.random.default_rng(2)
    limit = d.TipSpeedLimit(1.0, frame=frame)
    own = TipSpeedConstants.of(limit.constants(PANDA).numbers)
    for q in PANDA.draw(random, 20):
        displacement, dq = random.standard_normal((2, 7))
        found = velocity_after(instant(PANDA, q, limit), own, displacement, dq)
        assert_allclose(found, velocity(PANDA, q + displacement, dq, frame), atol=1e-13)


@pytest.mark.parametrize("jerk", [np.inf, 500.0])
def test_a_motion_to_rest_that_agrees_is_no_quicker_and_one_that_is_slow_agrees(
    jerk: float,
) -> None:
    """Beside the speed at both ends of each period, by Pinocchio."""
    random = np.random.default_rng(5)
    robot = PANDA.with_limits(jerk=jerk)
    rates = (AccelerationLimits(), JerkLimits())[: 1 + (jerk < np.inf)]
    limits = MotionLimits(rates).constants(robot)
    needless = []
    for q in robot.draw(random, 25):
        x = random.uniform(0.1, 0.5) * robot.dq_max * random.uniform(-1.0, 1.0, 7)
        before = x - 5.0 * DT * random.uniform(-1.0, 1.0, 7)
        cubic = jerk < np.inf
        periods = least_periods(x, before, limits, DT, False)
        b = np.zeros(7)
        if cubic:
            write_cubic_coefficients(x, before, periods, False, b)
        motion = Motion(x, b, periods, DT, cubic, False, False)
        u = np.arange(periods)[:, np.newaxis] / periods
        path = (1.0 - u) ** (2 if cubic else 1) * (x * (1.0 + 2.0 * u * cubic) + b * u)
        begun = q + DT * np.vstack([np.zeros(7), np.cumsum(path, axis=0)])
        ends = [*zip(begun[:-1], path, strict=True), *zip(begun[1:], path, strict=True)]
        fastest = max(float(np.linalg.norm(velocity(robot, *each))) for each in ends)
        low, high = 0.5 * fastest, 3.0 * fastest + 0.1
        for _ in range(30):
            middle = 0.5 * (low + high)
            limit = d.TipSpeedLimit(middle)
            step = instant(robot, q, limit)
            if keeps_speed(step, limit.constants(robot).numbers, motion):
                high = middle
            else:
                low = middle
        assert high >= fastest * (1.0 - 1e-9)
        needless.append(high / fastest)
    assert np.median(needless) < 1.02


def fastest(path: Array, robot: d.Robot, dt: float, frame: str | None = None) -> float:
    """The largest speed of a frame along joint positions that are dt apart [m/s]."""
    place = [d.Configuration(robot, q).frame(frame or robot.tip).position for q in path]
    return float(np.linalg.norm(np.diff(place, axis=0), axis=1).max()) / dt


def test_the_tip_is_no_quicker_where_its_target_jumps() -> None:
    # Without its limit it reaches 0.6 m/s.
    extra = (d.AccelerationLimits(10.0), d.JerkLimits(1000.0), d.TipSpeedLimit(0.4))
    scheme = d.DoubleIndicator(position_gain=50.0, orientation_gain=50.0, extra_limits=extra)
    controller = d.Controller(paper_robot(), scheme, dt=DT)
    start = paper_start()

    def jumping(t: float) -> d.Target:
        side = 0.3 if round(t / DT) % 150 < 75 else -0.3
        return d.Target(start.position + [side, 0.0, 0.1], start.rotation)

    path, _ = driven(controller, start.q, 300, jumping)
    assert 0.36 < fastest(path, paper_robot(), DT) <= 0.4


@pytest.mark.parametrize("limit", [0.1, 0.25, 0.5])
@pytest.mark.parametrize("rates", [(np.inf, np.inf), (10.0, np.inf), (10.0, 500.0)])
def test_two_frames_are_no_quicker_whatever_is_requested(
    limit: float, rates: tuple[float, float]
) -> None:
    """Joints that braked for limits of their own made the tip quicker by up to a half."""
    robot = PANDA.with_limits(acceleration=rates[0], jerk=rates[1])
    shield = d.Shield(robot, dt=1e-3)
    shield.limits += (d.TipSpeedLimit(limit), d.TipSpeedLimit(0.6 * limit, frame="panda_link5"))
    random = np.random.default_rng(0)
    path = [robot.start_posture()]
    for k in range(2000):
        if k % 100 == 0:
            request = robot.dq_max * random.choice([-1.0, 1.0, 0.0, 0.5], robot.dof)
        path.append(shield.step(path[-1], request).next_q)
    assert 0.9 * limit < fastest(path, robot, 1e-3) <= limit
    assert fastest(path, robot, 1e-3, "panda_link5") <= 0.6 * limit


def test_a_limit_near_what_the_arm_can_do_is_reached() -> None:
    shield = d.Shield(d.load_robot("panda"), dt=1e-3)
    shield.limits += (d.TipSpeedLimit(2.5),)
    random = np.random.default_rng(0)
    path = [shield.robot.start_posture()]
    for k in range(3000):
        if k % 200 == 0:
            request = shield.robot.dq_max * random.choice([-1.0, 1.0, 0.0, 0.5], 7)
        path.append(shield.step(path[-1], request).next_q)
    assert 2.4 < fastest(path, shield.robot, 1e-3) <= 2.5
