"""Limits of torques: rows and motions to rest beside Pinocchio, closed loops, and refusals."""

import warnings
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

import iiwa_dnn as d
from helpers_export import in_armstep
from helpers_kinematics import Array
from helpers_simulation import rows_of
from iiwa_dnn.results.plots import overview_figure
from iiwa_dnn.schemes import AccelerationLimits, JerkLimits
from iiwa_dnn.schemes.joint_limits import MotionLimits
from iiwa_dnn.schemes.rest import Motion, displacement_after, velocity_at
from iiwa_dnn.schemes.torque import TorqueLimits, _write_bends, _write_paces, keeps_torque
from iiwa_dnn.step.memory import motion_of
from iiwa_dnn.step.stopping import least_periods, write_cubic_coefficients

DT = 2e-3
CENTER = np.array([0.0, 0.0, 0.1])
RANGE = (0.0, 3.0)
PANDA = d.load_robot("panda").with_limits(jerk=np.inf).with_payload(RANGE, CENTER)
EFFORT = np.array(PANDA.model.effortLimit)
SO101 = d.load_robot("so101").with_limits(acceleration=10.0)


def carrying(robot: d.Robot, mass: float, center: Array = CENTER) -> tuple[pin.Model, pin.Data]:
    """Pinocchio's model and data of a robot whose tip carries a point mass."""
    model = robot.model.copy()
    frame = model.frames[robot.tip_id]
    body = pin.Inertia(mass, center, np.zeros((3, 3)))
    model.appendBodyToJoint(frame.parentJoint, body, frame.placement)
    return model, model.createData()


HELD = TorqueLimits(1.0, friction=0.0)
CARRYING = [carrying(PANDA, mass) for mass in (0.0, 3.0, 1.1)]


def load(q: Array, v: Array, x: Array, dt: float = DT, models: list = CARRYING) -> float:
    """The largest part of a torque limit that the command x after v takes at q."""
    torques = [pin.rnea(*own, q, v, (x - v) / dt) for own in models]
    return float((np.abs(torques) / models[0][0].effortLimit).max())


def limited(shield: d.Shield, limit: TorqueLimits) -> d.Shield:
    """The shield with a limit of torques in place of its own."""
    others = [each for each in shield.limits if not isinstance(each, TorqueLimits)]
    shield.limits = (*others, limit)
    return shield


def instant(robot: d.Robot, limit: TorqueLimits, q: Array, last: Array):
    program = d.Scheme(limits=[limit]).program(robot)
    return program.step_at(q, last, last, np.zeros((0, 18)), DT, 0.0, np.zeros(0))


def test_the_rows_are_the_torques_with_the_lightest_and_the_heaviest_payload() -> None:
    random = np.random.default_rng(0)
    robot = PANDA.with_limits(acceleration=1e9)  # no row is idle
    limit = TorqueLimits(0.9, friction=0.5)
    names = limit.row_names(robot)
    assert [names[0], names[-1]] == ["joint 1 torque, with 3 kg", "joint 7 torque, with 0 kg"]
    for q in robot.draw(random, 10):
        last, x = 0.3 * random.standard_normal((2, 7))
        qp = rows_of(limit, d.Configuration(robot, q), dt=DT, dq=last)
        left = (qp.h - qp.G @ x).reshape(2, 7, 2)
        assert_allclose(np.linalg.norm(qp.G, axis=1), 1.0)
        for own, found in zip((CARRYING[1], CARRYING[0]), left, strict=True):
            torque = pin.rnea(*own, q, last, (x - last) / DT)
            there = 0.9 * EFFORT * (1.0 - 1e-6) - 0.5
            bound = np.transpose([there - torque, there + torque])
            inertia = pin.crba(own[0], own[1], q)
            size = np.linalg.norm(inertia, axis=1) / DT
            assert_allclose(found * size[:, np.newaxis], bound, atol=1e-4)


def nearly_held(seed: int, target: float) -> tuple[Array, Array]:
    """A posture of the panda that takes a part of its torques to be held, and one where it began.

    Up to there the straight way from the other, which takes at most 0.9, takes no more.
    """
    random = np.random.default_rng(seed)
    rest = np.zeros(7)
    while True:
        first, last = PANDA.draw(random, 2)
        if load(first, rest, rest) < 0.9 and load(last, rest, rest) > target:
            break
    part = np.linspace(0.0, 1.0, 2001)[:, np.newaxis]
    way = first + part * (last - first)
    beyond = np.argmax([load(q, rest, rest) > target for q in way])
    return way[beyond - 1], first


@pytest.mark.parametrize("seed", [3, 5, 6, 8])
def test_an_arm_that_its_motors_just_hold_leaves(seed: int) -> None:
    """Only a longer motion to rest than the stored one lets it gain speed: it crept before."""
    q, first = nearly_held(seed, 0.985)
    shield = limited(d.Shield(d.load_robot("panda").with_payload(RANGE, CENTER), dt=DT), HELD)
    arm = q
    for _ in range(500):
        arm = shield.step(arm, position=first).next_q
    assert np.abs(arm - q).max() > 0.5


def test_what_nearly_takes_all_torque_to_be_held_is_no_rest_of_an_arm_that_moved_before() -> None:
    """One that swings through such a posture drifted from it, by 20 to 45 mrad."""
    q, _ = nearly_held(3, 0.995)
    rest = np.zeros(7)
    program = d.Scheme(limits=[HELD]).program(PANDA)
    motion = Motion(rest, rest, 1.0, DT, False, False, False)
    moved = 1e-6 * np.eye(7)[1]
    for last, before, agrees in ((rest, rest, True), (rest, moved, False), (moved, rest, False)):
        step = program.step_at(q, last, before, np.zeros((0, 18)), DT, 0.0, np.zeros(0))
        assert keeps_torque(step, HELD.constants(PANDA).numbers, motion) == agrees


def test_rows_that_no_command_reaches_are_idle() -> None:
    """By the acceleration limits of the scheme, which may be wider than the robot's."""
    start = d.Configuration(PANDA, PANDA.start_posture())
    target = d.Target(start.position, start.rotation)
    for acceleration, most in ((None, 27), (1e9, 0)):
        limits = [TorqueLimits(), AccelerationLimits(acceleration)]
        qp = d.Scheme(limits=limits).build_qp(start, target, DT)
        idle = np.isinf(qp.h)
        assert (most > 0) <= np.count_nonzero(idle) <= most
        assert not qp.G[idle].any()


@pytest.mark.parametrize("jerk", [np.inf, 500.0])
def test_a_motion_to_rest_that_agrees_keeps_all_torques_and_one_that_is_far_below_agrees(
    jerk: float,
) -> None:
    """Beside the torques of each period, its command's and those at rest, by Pinocchio."""
    random = np.random.default_rng(3)
    cubic = jerk < np.inf
    robot = PANDA.with_limits(jerk=jerk)
    rates = (AccelerationLimits(), JerkLimits())[: 1 + cubic]
    limits = MotionLimits(rates).constants(robot)
    needless = []
    for draw, q in enumerate(robot.draw(random, 60)):
        x = random.uniform(0.05, 1.0) * robot.dq_max * random.uniform(-1.0, 1.0, 7)
        last = x - DT * random.uniform(-3.0, 3.0, 7)
        periods = 2.0 * least_periods(x, last, limits, DT, False)
        if draw % 2 == 0:
            periods = float(round(periods))  # else the last one is cut short
        b = np.zeros(7)
        if cubic:
            write_cubic_coefficients(x, last, periods, False, b)
        motion = Motion(x, b, periods, DT, cubic, False, False)
        at, v = q, last
        largest = 0.0
        for k in range(int(np.ceil(periods)) + 2):
            u = min(k / periods, 1.0)
            after = np.array([velocity_at(x[i], b[i], u, cubic) for i in range(7)])
            largest = max(largest, load(at, v, after))
            at, v = at + DT * after, after
        largest = max(largest, load(at, 0.0 * v, 0.0 * v) / 0.99)  # a hundredth is left
        if largest > 1.0:
            continue
        low, high = 0.5 * largest, 1.0
        for _ in range(25):
            middle = 0.5 * (low + high)
            limit = TorqueLimits(middle, friction=0.0)
            constants = limit.constants(robot).numbers
            if keeps_torque(instant(robot, limit, q, last), constants, motion):
                high = middle
            else:
                low = middle
        assert high >= largest * (1.0 - 1e-8)
        needless.append(high / largest)
    assert len(needless) >= 10
    assert np.max(needless) < 1.0 + 1e-6


def test_the_pace_of_a_motion_to_rest_bounds_what_its_curves_do() -> None:
    """Velocities, and sums of them as positions, by differences of dense samples."""
    random = np.random.default_rng(0)
    used = []
    for k in range(200):
        cubic = k % 2 == 1
        periods, period = random.uniform(5.0, 60.0), 2e-3
        x, b = random.standard_normal((2, 1)) * [[1.0], [3.0 * cubic]]
        motion = Motion(x, b, periods, period, cubic, False, False)
        left = random.uniform(0.1, 1.0)
        pace = np.empty((1, 4))
        _write_paces(motion, left, pace)
        ahead = np.linspace((1.0 - left) * periods, periods, 2001)
        v = np.array([velocity_at(x[0], b[0], t / periods, cubic) for t in ahead])
        q = np.array([displacement_after(motion, x[0], b[0], t) for t in ahead])
        gap = period * (ahead[1] - ahead[0])
        of_v = [np.abs(np.diff(v, m)).max() / gap**m for m in range(3)]
        of_q = [np.abs(np.diff(q, m)).max() / gap**m for m in (1, 2)]
        bounds = pace[0, [0, 1, 2, 0, 1]] * (1.0 + 1e-6) + 1e-3
        assert ([*of_v, *of_q] <= bounds).all()
        used.append(of_q[0] / pace[0, 0])
    assert np.median(used) > 0.8


@pytest.mark.parametrize(("name", "armature"), [("panda", 0.0), ("ur5", 0.1), ("panda", 1e5)])
def test_no_torque_bends_more_than_the_bound_along_a_motion_to_rest(
    name: str, armature: float
) -> None:
    """By differences of Pinocchio's; where rotors bear all, the bound is what they bear."""
    random = np.random.default_rng(4)
    robot = d.load_robot(name).with_armature(armature)
    own = TorqueLimits(1.0, friction=0.0).constants(robot)
    model, data = robot.model, robot.model.createData()
    n = robot.dof
    used = []
    for draw, q in enumerate(robot.draw(random, 30)):
        cubic = draw % 3 > 0
        periods = random.uniform(20.0, 200.0)
        x, b = random.standard_normal((2, n)) * [[1.0], [3.0 * cubic]]
        motion = Motion(x, b, periods, DT, cubic, False, False)
        left = random.uniform(1.0, 0.7 * periods)
        paces, bends = np.empty((n, 4)), np.empty(n)
        _write_paces(motion, 1.0 - (left - 1.0) / periods, paces)
        _write_bends(own, paces, bends)

        def torque(t: float, q: Array = q, motion: Motion = motion) -> Array:
            joints = list(zip(motion.first, motion.coefficient, strict=True))
            way = [displacement_after(motion, *joint, t) for joint in joints]
            v, after = (
                np.array(
                    [
                        velocity_at(*joint, (t - k) / motion.periods, motion.cubic)
                        for joint in joints
                    ]
                )
                for k in (1.0, 0.0)
            )
            return np.array(pin.rnea(model, data, q + way, v, (after - v) / DT))

        for t in np.linspace(left + 0.2, periods - 0.2, 25):
            bend = torque(t + 0.2) - 2.0 * torque(t) + torque(t - 0.2)
            found = np.abs(bend) / (0.2 * DT) ** 2
            noise = 1e-12 * (1.0 + armature) / (0.2 * DT) ** 2
            assert (found <= bends * (1.0 + 1e-6) + noise).all()
            used.append((found / (bends + noise)).max())
    assert (max(used) > 0.9) == (armature > 1e3)


@pytest.mark.parametrize(("jerk", "dt"), [(np.inf, 2e-3), (2000.0, 2e-3), (np.inf, 1e-3)])
def test_no_request_takes_a_command_or_a_motion_to_rest_beyond_the_torques(
    jerk: float, dt: float
) -> None:
    """Without the limit the commands take up to three times the torques."""
    random = np.random.default_rng(1)
    robot = PANDA.with_limits(jerk=jerk)
    shield = limited(d.Shield(robot, dt=dt), TorqueLimits(1.0, friction=0.0))
    q, v = robot.start_posture(), np.zeros(7)
    largest, resting, reasons = 0.0, 0.0, set()
    for k in range(1200):
        if k % 75 == 0:
            request = robot.dq_max * random.uniform(-1.2, 1.2, 7)
        command = shield.step(q, request)
        taken = load(q, v, command.dq, dt)
        assert abs(command.margin.torque - (1.0 - taken)) < 1e-9
        largest = max(largest, taken)
        reasons |= set(command.active_limits)
        q, v = command.next_q, command.dq
        if k % 20 == 0:
            motion = motion_of(command.layout.plan, command.state)
            periods = motion.stopping_periods
            assert periods > 0.0
            assert command.stopping_time == periods * dt  # joints alone would take less
            rest = np.array(q)
            x, before = np.array(v), np.array(motion.before)
            b = np.zeros(7)
            if jerk < np.inf:
                write_cubic_coefficients(x, before, periods, False, b)
            last = x
            for i in range(1, int(periods) + 2):
                u = min(i / periods, 1.0)
                after = np.array([velocity_at(x[j], b[j], u, jerk < np.inf) for j in range(7)])
                resting = max(resting, load(rest, last, after, dt))
                rest, last = rest + dt * after, after
    assert 0.99 < largest <= 1.0 + 1e-9
    assert resting <= 1.0 + 1e-9
    assert any("torque, with 3 kg" in reason for reason in reasons)


@pytest.mark.parametrize("jerk", [np.inf, 2000.0])
def test_torques_hold_for_a_payload_anywhere_in_a_box(jerk: float) -> None:
    """Whose corners take more than its centre."""
    random = np.random.default_rng(2)
    box = CENTER + np.array([[-0.02, -0.02, -0.05], [0.02, 0.02, 0.05]])
    robot = PANDA.with_limits(jerk=jerk).with_payload((0.0, 2.0), box)
    corners = np.where(np.indices((2, 2, 2)).reshape(3, 8).T, box[1], box[0])
    places = (*corners, *random.uniform(*box, (4, 3)))
    anywhere = [carrying(robot, 2.0, place) for place in places]
    middle = [carrying(robot, 2.0)]
    shield = limited(d.Shield(robot, dt=DT), TorqueLimits(1.0, friction=0.0))
    q, v = robot.start_posture(), np.zeros(7)
    largest, central = 0.0, 0.0
    for k in range(900):
        if k % 75 == 0:
            request = robot.dq_max * random.uniform(-1.2, 1.2, 7)
        command = shield.step(q, request)
        taken = load(q, v, command.dq, models=anywhere)
        assert command.margin.torque <= 1.0 - taken + 1e-9
        largest = max(largest, taken)
        central = max(central, load(q, v, command.dq, models=middle))
        q, v = command.next_q, command.dq
    assert largest <= 1.0 + 1e-9
    assert central < largest - 0.02
    assert np.abs(q - robot.start_posture()).max() > 0.5


def test_the_core_answers_to_the_bit_and_many_arms_as_one(tmp_path: Path) -> None:
    random = np.random.default_rng(5)
    iiwa7 = d.load_robot("iiwa7")
    assert d.Shield(iiwa7).step(iiwa7.start_posture(), np.zeros(7)).margin.torque == np.inf
    shield = limited(d.Shield(PANDA, dt=DT), TorqueLimits())
    arm = in_armstep(shield, tmp_path)
    many = d.Shields(shield, 2)
    q = np.tile(PANDA.start_posture(), (2, 1))
    for k in range(150):
        if k % 50 == 0:
            request = PANDA.dq_max * random.uniform(-1.2, 1.2, 7)
        there = arm.step(q[0], request)
        here = many.step(q, [request, -request])
        assert there.dq.tobytes() == here.dq[0].tobytes()
        assert there.margin == many.margin(0)
        q = here.next_q
    assert there.margin.torque < 1.0
    torque = many.margin().torque
    assert (torque[0], torque[1]) == (many.margin(0).torque, many.margin(1).torque)


def test_a_posture_that_the_motors_cannot_hold_is_refused_and_never_entered() -> None:
    robot = PANDA.with_payload((0.0, 5.0), CENTER)
    models = [carrying(robot, 5.0)]
    far = np.array([0.0, 1.5, 0.0, -0.3, 0.0, 1.8, 0.0])
    shield = limited(d.Shield(robot, dt=DT), TorqueLimits(1.0, friction=0.0))
    heavy = load(far, np.zeros(7), np.zeros(7), models=models)
    problem = f"q: takes {heavy:.3g} of the torque limit of joint 2 to be held"
    for _ in range(2):
        with pytest.raises(d.InvalidInputError, match=problem):
            shield.step(far, np.zeros(7))
    q = PANDA.start_posture()
    v = np.zeros(7)
    for _ in range(1000):
        command = shield.step(q, position=far)
        assert load(q, v, command.dq, models=models) <= 1.0 + 1e-9
        q, v = command.next_q, command.dq
    assert 0.9 < load(q, np.zeros(7), np.zeros(7), models=models) <= 0.99
    for _ in range(2500):
        command = shield.step(q, position=PANDA.start_posture())
        q = command.next_q
    assert np.abs(q - PANDA.start_posture()).max() < 1e-6


@pytest.mark.parametrize("seed", range(4))
def test_an_arm_at_the_boundary_of_what_its_motors_hold_comes_back(seed: int) -> None:
    """Where only a millionth of a torque is left, an arm would stay for ever."""
    robot = PANDA.with_payload((0.0, 5.0), CENTER)
    models = [carrying(robot, 5.0)]
    rest = np.zeros(7)
    far = next(
        q
        for q in robot.draw(np.random.default_rng(seed), 4000)
        if load(q, rest, rest, models=models) > 1.1
    )
    shield = limited(d.Shield(robot, dt=DT), TorqueLimits(1.0, friction=0.0))
    q = robot.start_posture()
    path = [q]
    for k in range(1500):
        q = shield.step(q, position=far).next_q
        path += [q] * (k % 20 == 0)
    for _ in range(300):
        q = shield.step(q, np.zeros(7)).next_q
    held = load(q, rest, rest, models=models)
    for goal in path[::-1]:
        for _ in range(500):
            q = shield.step(q, position=goal).next_q
            if np.abs(q - goal).max() < 0.05:
                break
    assert held <= 0.99 + 1e-9
    assert np.abs(q - path[0]).max() < 0.1


@pytest.mark.parametrize(
    ("robot", "limit", "problem"),
    [
        (PANDA, lambda: TorqueLimits(1.1), "fraction: must be at most 1"),
        (PANDA, lambda: TorqueLimits(friction=-1.0), "friction"),
        (PANDA, lambda: TorqueLimits(friction=12.0), "'panda_joint5': TorqueLimits leaves nothing"),
        (d.load_robot("ur5"), TorqueLimits, "limits: of torques need limits of all accelerations"),
        (SO101, TorqueLimits, "effort: so101: its file gives each joint 10 N m"),
    ],
)
def test_limits_that_do_not_fit_are_refused(robot: d.Robot, limit, problem: str) -> None:
    with pytest.raises(d.InvalidInputError, match=problem):
        d.Shield(robot).limits += (limit(),)


def test_the_makers_efforts_count_where_a_file_has_wrong_ones() -> None:
    ur3 = d.load_robot("ur3").with_limits(acceleration=10.0)
    assert_allclose(TorqueLimits(1.0).largest(ur3), [56, 56, 28, 12, 12, 12])
    locked = d.load_robot("ur3", locked="elbow_joint")
    assert_allclose(locked.model.effortLimit, [56, 56, 12, 12, 12])
    assert ur3.path is not None
    root = ET.parse(ur3.path).getroot()
    file = d.load_robot(ur3.path, tip="tool0")
    efforts = [float(each.attrib["effort"]) for each in root.iterfind("joint/limit")]
    assert_allclose(file.model.effortLimit, efforts)
    with pytest.raises(d.InvalidInputError, match="ur3: its file gives the torques of a ur10"):
        TorqueLimits().largest(file)
    assert_allclose(TorqueLimits(1.0, effort=20.0).largest(file), 20.0)
    assert_allclose(TorqueLimits(1.0, effort=3.0).largest(SO101), 3.0)


def test_friction_and_rotors_are_those_that_are_published() -> None:
    """Friction exceeds the curves of Gaz and others at every velocity, by no more than 0.01 N m."""
    size = np.array([0.54615, 0.87224, 0.64068, 1.2794, 0.83904, 0.30301, 0.56489])
    shift = np.array([0.039533, 0.025882, -0.04607, 0.036194, 0.026226, -0.021047, 0.0035526])
    slope = np.array([5.1181, 9.0657, 10.136, 5.5903, 8.3469, 17.133, 10.336])
    dq = np.linspace(-1.0, 1.0, 501)[:, np.newaxis] * PANDA.dq_max
    curves = size / (1.0 + np.exp(-slope * (dq + shift))) - size / (1.0 + np.exp(-slope * shift))
    spare = PANDA.friction - np.abs(curves).max(axis=0)
    assert (spare >= 0.0).all()
    assert (spare < 0.011).all()
    assert_allclose(TorqueLimits(1.0).largest(PANDA), EFFORT - PANDA.friction)
    assert not d.load_robot("fr3").friction.any()
    for name in ("fr3", "panda"):
        armature = d.load_robot(name).with_armature().model.armature
        assert_allclose(armature[[0, 2, 6]], [0.605721456, 0.462474144, 0.205544064])
    with pytest.raises(d.InvalidInputError, match="armature: none is published of iiwa7"):
        d.load_robot("iiwa7").with_armature()


def test_a_record_tells_what_its_velocities_take_of_the_torques() -> None:
    start = d.Configuration(PANDA, PANDA.start_posture())
    heart = d.Heart(scale=9e-3, period=1.5).anchored(start)
    scheme = d.DoubleIndicator(extra_limits=(AccelerationLimits(), TorqueLimits(0.9, friction=0.0)))
    record = d.simulate(PANDA, scheme, heart, start.q, dt=DT, duration=1.5)
    before = np.vstack([np.zeros(7), record.dq[:-1]])
    for k in range(0, record.steps, 50):
        own = [
            pin.rnea(*each, record.q[k], before[k], (record.dq[k] - before[k]) / DT)
            for each in CARRYING[:2]
        ]
        assert_allclose(record.demand[k], np.abs(own).max(axis=0), atol=1e-9)
    metrics = d.compute_metrics(record)
    most = (record.demand / (0.9 * EFFORT)).max()
    assert 0.9 < metrics["demand"]["max_fraction"] == most < 1.0
    label = overview_figure(record).axes[-1].get_ylabel()
    assert label == "Torque for the commands [% of limit]"
    heavy = replace(record, demand=1.2 * record.demand)
    joint = metrics["demand"]["joint"]
    for own in (record, heavy):
        said = [each for each in d.failures(own) if each.startswith(f"{joint} needs ")]
        assert len(said) == (own is heavy)


def test_an_arm_with_a_payload_keeps_its_makers_torques_and_others_say_that_they_do_not() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        shield = d.Shield(PANDA, obstacles=[])
        assert shield.limits[-1] == TorqueLimits()
        assert shield.step(PANDA.start_posture(), np.zeros(7)).margin.torque < 0.95
    file = d.load_robot(d.load_robot("ur3").path, tip="tool0").with_limits(acceleration=10.0)
    for robot, own in (
        (PANDA, {"longest_period": 2e-3}),
        (d.load_robot("ur5").with_payload(RANGE), {}),  # of no accelerations
        (d.load_robot("xarm7").with_limits(acceleration=10.0).with_payload(RANGE), {}),
        (file.with_payload(RANGE), {}),
    ):
        shield = d.Shield(robot, **own)
        with pytest.warns(UserWarning, match="carries 0 to 3 kg, and no TorqueLimits are among"):
            shield.step(robot.start_posture(), np.zeros(robot.dof))


def test_a_joint_without_a_torque_limit_is_refused_by_its_name() -> None:
    model = PANDA.model.copy()
    model.effortLimit = np.where(np.arange(7) == 3, 0.0, EFFORT)
    object.__setattr__(robot := PANDA.with_limits(), "model", model)
    with pytest.raises(d.InvalidInputError, match="joint 'panda_joint4': TorqueLimits needs"):
        d.Shield(robot).limits += (TorqueLimits(),)


def test_periods_that_vary_are_refused() -> None:
    with pytest.raises(d.InvalidInputError, match="longest_period: is no part of what"):
        d.Shield(PANDA, longest_period=2e-3).limits += (TorqueLimits(),)


def test_an_arm_that_moves_over_a_hump_of_what_it_holds_rests_beyond_it() -> None:
    """There it could be held no more than at all, and never left its place."""
    robot = PANDA.with_limits(jerk=7500.0)
    model, data = carrying(robot, 3.0)
    start = [1.86995381, -0.29832204, 1.91108217, -3.0419164, -0.78200353, 0.27893524, 0.88434042]
    one = [2.67355824, -1.40955936, -0.29453047, -2.14548331, 2.85344097, 0.31601296, 0.15991203]
    other = [
        -0.55101643,
        -0.96935502,
        -0.82847592,
        -2.28051707,
        -2.20263406,
        1.13373704,
        2.86772985,
    ]
    shield = d.Shield(robot)
    q = np.array(start)
    for k in range(3000):
        q = shield.step(q, position=one if k < 333 else other).next_q
    limit = 0.95 * robot.model.effortLimit - robot.friction
    held = np.abs(pin.rnea(model, data, q, np.zeros(7), np.zeros(7))) / limit
    assert 0.5 < held.max() <= 0.99
