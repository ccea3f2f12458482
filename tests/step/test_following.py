"""Tests of chunks and streams of positions that an arm follows, by judges that are not its own."""

import pickle

import numpy as np
import pytest

import iiwa_dnn
from judge_limits import breaches

ARMS = {"so101": (10.0, 200.0, 0.01), "iiwa7": (10.0, 500.0, 5e-3)}
RATE = 30.0  # Hz


def make(name="so101", **options):
    """Return a shield of an arm at rest in its start posture, and that posture."""
    acceleration, jerk, dt = ARMS[name]
    robot = iiwa_dnn.load_robot(name).with_limits(acceleration=acceleration, jerk=jerk)
    made = iiwa_dnn.Shield(robot, dt=dt, **options)
    start = robot.start_posture()
    made.reset(start)
    return made, start


def broken(shield, path):
    """Return what a path from rest breaks of the robot's limits."""
    return breaches(np.array(path), shield.dt, *shield.robot.limits)


def drive(shield, q, steps):
    """Take steps of an arm that follows, from q on; return its positions and the last command."""
    path = [q]
    for _ in range(steps):
        command = shield.step(path[-1])
        path.append(path[-1] + shield.dt * command.dq)
    return np.array(path), command


def moves(start, t, height=0.5, time=0.9):
    """Compute minimum-jerk moves to a posture and back, and a rest, from 0.2 s on, (m, n)."""
    u = np.clip((np.atleast_1d(t) - 0.2) / time, 0.0, 2.0)
    u = np.minimum(u, 2.0 - u)
    way = u**3 * (10.0 - 15.0 * u + 6.0 * u * u)
    return start + height * way[:, np.newaxis] * np.where(np.arange(start.size) % 2, -1.0, 0.6)


def ramp(start, t):
    """Compute positions that reach 0.5 rad/s in 0.4 s, (m, n)."""
    return start + 0.5 * np.where(t < 0.4, t**2 / 0.8, t - 0.2)[:, np.newaxis]


def lag_of(path, dt, motion):
    """Find the lag of a path [s] behind a motion, and the largest distance at that lag [rad]."""
    times = np.arange(len(path)) * dt
    lags = np.arange(0.0, 0.2, 1e-3)
    errors = [np.linalg.norm(path - motion(times - lag)) for lag in lags]
    lag = lags[int(np.argmin(errors))]
    return lag, np.abs(path - motion(times - lag)).max()


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize(("latency", "seam", "most"), [(0.0, 0.0, 1e-3), (0.05, 0.03, 0.01)])
def test_receding_chunks_are_followed_without_lag(name, latency, seam, most):
    shield, start = make(name)
    random = np.random.default_rng(1)
    path = [start]
    sent = 0
    for k in range(int(2.5 / shield.dt)):
        t = k * shield.dt
        seen = sent * 8 / RATE
        if t >= seen + latency * (sent > 0) - 1e-9:
            times = seen + np.arange(16) / RATE
            offset = seam * random.uniform(-1.0, 1.0, start.size) * (sent > 0)
            shield.follow(times, moves(start, times) + offset)
            sent += 1
        path.append(path[-1] + shield.dt * shield.step(path[-1]).dq)
    assert broken(shield, path) == []
    lag, off = lag_of(np.array(path), shield.dt, lambda t: moves(start, t))
    assert lag <= most
    assert off < 1.5e-3 + 1.5 * seam


@pytest.mark.parametrize(("name", "dt"), [("so101", 1.0 / RATE), ("so101", 0.01), ("iiwa7", 1e-3)])
def test_chunks_of_one_motion_have_no_seam(name, dt):
    """Their splines differ: the arm was up to 5 mrad off, at 7 times the motion's jerk."""
    shield = iiwa_dnn.Shield(make(name)[0].robot, dt=dt)
    start = shield.robot.start_posture()
    shield.reset(start)
    path = [start]
    off = []
    for k in range(int(2.0 / dt)):
        if k * dt >= len(off) * 8 / RATE - 1e-9:
            times = (len(off) * 8 + np.arange(16)) / RATE
            shield.follow(times, moves(start, times, 0.3, 0.8))
            off.append(0.0)
        command = shield.step(path[-1])
        path.append(path[-1] + dt * command.dq)
        off[-1] = max(off[-1], command.off)
    assert broken(shield, path) == []
    assert max(off) < 1e-12
    motion = moves(start, np.arange(len(path)) * dt, 0.3, 0.8)
    jerk, own = (np.diff(each, 3, axis=0).std() for each in (np.array(path), motion))
    assert jerk < 1.3 * own
    assert np.abs(path - motion).max() < 1e-3


def test_a_gap_between_chunks_fades_gently():
    """It took all of its share of the jerk limit: 9 to 12 times the jerk of an FR3's motions."""
    robot = iiwa_dnn.load_robot("fr3")
    shield = iiwa_dnn.Shield(robot, dt=1e-3)
    start = robot.start_posture()
    shield.reset(start)
    shield.follow([0.0, 1.0], [start, start])
    path, _ = drive(shield, start, 10)
    shield.follow([0.01, 1.0], [start + 0.03, start + 0.03])
    more, command = drive(shield, path[-1], 500)
    assert broken(shield, more) == []
    assert command.off < 1e-9
    assert (np.abs(np.diff(more, 3, axis=0)) / 1e-9).max() < 0.02 * robot.dddq_max.min()


def test_joints_that_positions_leave_behind_name_the_limit():
    """A position is a rest, and nothing said why a stream of them was followed 0.2 s late."""
    robot = make()[0].robot
    shield = iiwa_dnn.Shield(robot, dt=1.0 / RATE)
    q = start = robot.start_posture()
    shield.reset(q)
    found = []
    for k in range(60):
        goal = start + 0.6 * np.sin(3.8 * k / RATE) * np.eye(start.size)[0]
        command = shield.step(q, position=goal)
        q = q + shield.dt * command.dq
        behind = abs(goal - q)[0] > 0.5 * abs(command.dq[0]) * shield.dt
        found.append((behind, command.active_limits))
    assert {words for behind, words in found if behind and words} == {
        ("joint 1 upper acceleration limit",),
        ("joint 1 lower acceleration limit",),
    }
    assert sum(behind and not words for behind, words in found) <= 6  # where it turns round
    shield.reset(start)
    q = start
    for _ in range(20):  # a position alone is no stream
        command = shield.step(q, position=start + 0.6)
        q = q + shield.dt * command.dq
        assert command.active_limits == ()


def test_chunk_ends_at_its_last_sample_without_passing_it():
    shield, start = make()
    times = np.arange(0.0, 0.8, 1.0 / RATE)
    points = ramp(start, times)
    shield.follow(times, points)
    path, command = drive(shield, start, 250)
    assert broken(shield, path) == []
    assert (path - points[-1]).max() < 1e-9
    assert command.off < 1e-12
    assert command.late < 1e-9


def test_rest_of_a_chunk_that_is_sent_again_does_not_pass_its_end():
    """Its clock brakes for the end: begun anew at full rate, the end was passed by 8 to 69 mrad."""
    shield, start = make("iiwa7")
    start = np.clip(start, shield.robot.q_lower + 0.6, shield.robot.q_upper - 0.9)
    shield.reset(start)
    times = np.arange(24) / RATE
    u = np.minimum(times / 0.5, 1.0)
    way = np.where(u < 1.0, 0.5 * u**4 * (2.5 - 3.0 * u + u * u), times - 0.25)  # to 1 rad/s
    points = start + way[:, np.newaxis]
    shield.follow(times, points)
    path, _ = drive(shield, start, round(times[-2] / shield.dt) + 1)
    shield.follow(times[-1:], points[-1:])
    path, _ = drive(shield, path[-1], 400)
    assert (path - points[-1]).max() < 1e-9
    assert np.abs(path[-1] - points[-1]).max() < 1e-9


def test_quick_path_is_kept_later():
    shield, start = make()
    times = np.linspace(0.0, 0.5, 12)
    way = 0.5 * (1.0 - np.cos(np.pi * times / 0.5))
    points = start + 0.8 * way[:, np.newaxis]
    shield.follow(times, points, keep="path")
    path, command = drive(shield, start, 400)
    assert broken(shield, path) == []
    assert np.ptp(path - start, axis=1).max() < 2e-3  # all joints move alike
    assert command.off < 1e-9


def test_jumps_in_time_and_place_come_to_rest_within_the_limits():
    """A chunk of one sample, one whose time is to come, and one that begins elsewhere."""
    shield, start = make()
    shield.follow([0.0], [start + 0.3])
    path, _ = drive(shield, start, 200)
    np.testing.assert_allclose(path[-1], start + 0.3, atol=1e-9)
    shield.follow([2.5, 3.0], [start, start - 0.2])
    more, _ = drive(shield, path[-1], 350)
    np.testing.assert_allclose(more[-1], start - 0.2, atol=1e-9)
    assert broken(shield, [*path, *more[1:]]) == []


def test_wrong_chunks_change_nothing():
    shield, q = make()
    with pytest.raises(iiwa_dnn.InvalidInputError, match=r"must rise: 0.1 s comes after 0.2 s"):
        shield.follow([0.0, 0.2, 0.1], np.tile(q, (3, 1)))
    with pytest.raises(iiwa_dnn.InvalidInputError, match="must be 1 to 64"):
        shield.follow(np.arange(65.0), np.tile(q, (65, 1)))
    other = 1.7e9 + np.arange(3.0)  # a clock that counts from 1970; a preview never ended
    for chunk in (shield.follow, shield.preview):
        with pytest.raises(iiwa_dnn.InvalidInputError, match="s ahead: state now= for another"):
            chunk(other, np.tile(q, (3, 1)))
    shield.follow(other, np.tile(q, (3, 1)), now=1.7e9)
    many = iiwa_dnn.Shields(shield, 2)
    with pytest.raises(iiwa_dnn.InvalidInputError, match="s ahead"):
        many.follow(other, np.tile(q, (2, 3, 1)))
    shield, q = make()
    with pytest.raises(iiwa_dnn.InvalidInputError, match="positions"):
        shield.follow([0.0, 1.0], np.zeros((2, 1)))
    with pytest.raises(iiwa_dnn.InvalidInputError, match="keep"):
        shield.follow([0.0], [q], keep="neither")
    with pytest.raises(iiwa_dnn.InvalidInputError, match="belong to a position"):
        shield.step(q, q, lead=1)
    with pytest.raises(iiwa_dnn.InvalidInputError, match="lead"):
        shield.step(q, position=q, lead=3)
    assert "no request" in shield.step(q).reasons


def test_stale_chunks_are_named_and_others_go_on():
    shield, start = make()
    shield.follow([0.0, 1.0], [start, start + 0.3])
    path, _ = drive(shield, start, 50)
    shield.follow([-1.0, 0.4], [start, start])
    command = shield.step(path[-1])
    assert command.reasons == ("samples stale",)
    path, command = drive(shield, path[-1] + shield.dt * command.dq, 100)
    assert command.reasons == ()
    np.testing.assert_allclose(path[-1], start + 0.3, atol=1e-9)


@pytest.mark.parametrize("value", [np.nan, np.inf, 1e300])
def test_numbers_that_are_none_brake_until_the_next_chunk(value):
    shield, start = make()
    times = np.arange(0.0, 0.8, 1.0 / RATE)
    shield.follow(times, ramp(start, times))
    path, _ = drive(shield, start, 60)
    shield.follow([0.6, 1.0], [start, start + value])
    more, command = drive(shield, path[-1], 60)
    assert command.reasons == ("request not finite",)
    assert not command.dq.any()
    shield.follow([1.25], [start])
    last, command = drive(shield, more[-1], 150)
    assert command.reasons == ()
    np.testing.assert_allclose(last[-1], start, atol=1e-9)
    assert broken(shield, [*path, *more[1:], *last[1:]]) == []


def test_other_requests_halts_and_resets_end_a_chunk():
    shield, start = make()
    for end in (lambda q: shield.step(q, np.zeros(q.size)), lambda q: shield.halt()):
        shield.reset(start)
        shield.follow([0.0, 1.0], [start, start + 0.3])
        path, _ = drive(shield, start, 50)
        end(path[-1])
        path, command = drive(shield, path[-1], 60)
        assert not command.dq.any()
        assert command.late == command.off == 0.0
    assert command.reasons == ("halted",)


def test_stream_with_a_lead_is_a_sample_late_and_one_that_falls_silent_brakes():
    shield, start = make()
    for lead in (0, 1, 2):
        shield.reset(start)
        path = [start]
        for k in range(250):
            t = k * shield.dt
            own = {} if k % 4 else {"position": moves(start, t)[0], "time": t, "lead": lead}
            path.append(path[-1] + shield.dt * shield.step(path[-1], **own).dq)
        assert broken(shield, path) == []
        late = (2 - lead) * 4 * shield.dt
        times = np.arange(len(path)) * shield.dt - late
        assert np.abs(np.array(path) - moves(start, times)).max() < 0.011
    _, command = drive(shield, path[-1], 30)
    assert command.reasons == ("request timed out",)
    assert not command.dq.any()


def test_equal_samples_at_a_turning_point_are_no_stop():
    """The arm left the stream there: 49 mrad off."""
    shield, start = make()
    dt = shield.dt
    rate = 2.0 * np.pi * 0.6
    path = [start]
    for k in range(500):
        t = k * dt
        own = {}
        if k % 10 == 0:  # two samples beside each peak are equal to the last bit
            share = round(0.55 * np.sin(rate * (t - 2.0)) * min(t / 2.0, 1.0), 6)
            own = {"position": start + share, "lead": 1}
        path.append(path[-1] + dt * shield.step(path[-1], **own).dq)
    assert broken(shield, path) == []
    times = np.arange(250, 501) * dt - 0.1
    goal = 0.55 * np.sin(rate * (times - 2.0))
    assert np.abs(np.array(path)[250:, 0] - start[0] - goal).max() < 0.01


@pytest.mark.parametrize("dt", [0.01, 1.0 / RATE])
def test_a_joint_that_begins_late_catches_up_with_a_motion_near_the_limits(dt):
    """It stayed 90 to 125 ms behind at 30 Hz, as its law counts on less jerk than there is."""
    robot = make()[0].robot
    shield = iiwa_dnn.Shield(robot, dt=dt)
    start = robot.start_posture()
    shield.reset(start)
    rate = 2.0 * np.pi * 0.6

    def motion(t):  # that begins at 2.3 rad/s and takes 8.7 rad/s^2 of 10
        return start + 2.3 / rate * np.sin(rate * np.maximum(t, 0.0))[:, np.newaxis]

    path = [start]
    for k in range(int(6.0 / dt)):
        own = {}
        if k % round(1.0 / RATE / dt) == 0:
            own = {"position": motion(np.array([k * dt]))[0], "lead": 1}
        path.append(path[-1] + dt * shield.step(path[-1], **own).dq)
    assert broken(shield, path) == []
    sampling = dt * round(1.0 / RATE / dt)
    late = np.arange(len(path)) * dt
    off = np.abs(np.array(path) - motion(late - sampling)).max(axis=1)
    assert off[late > 4.0].max() < 0.02


@pytest.mark.parametrize("share", [1.0, 1.3, 2.0])
def test_a_stream_that_is_too_quick_is_followed_better_than_its_positions_alone(share):
    """Its samples were taken as jumps, whose offsets fade slowly: 180 ms behind, not 60."""
    shield, start = make()
    dt = shield.dt
    time = np.sqrt(10.0 / np.sqrt(3.0) * 0.5 / (10.0 * share))  # peaks take `share` of 10 rad/s^2

    def motion(t):
        u = np.interp(np.maximum(t, 0.0) / time % 4.0, np.arange(5), [0.0, 1.0, 1.0, 2.0, 2.0])
        return moves(start, 0.2 + u * time, time=time)  # rests between

    found = []
    for lead in ({}, {"lead": 1}):
        shield.reset(start)
        path = [start]
        for k in range(600):
            new = k % 3 == 0 or not lead
            own = {"position": motion(3 * (k // 3) * dt)[0], **lead} if new else {}
            path.append(path[-1] + dt * shield.step(path[-1], **own).dq)
        assert broken(shield, path) == []
        path = np.array(path)
        found.append(
            (lag_of(path, dt, motion)[0], np.abs(path - motion(np.arange(601) * dt)).max())
        )
    (lag, off), (following, passed) = found
    assert following < lag - 0.02
    assert passed < off


@pytest.mark.parametrize(
    ("stamp", "arrival", "most"),
    [
        (lambda t: 1.8e9 + t, lambda t: t, 0.012),  # seconds since 1970: they were not finite
        (lambda t: t * (1.0 - 3e-3), lambda t: t, 0.02),  # a slow clock: 0.9 rad at last
        (lambda t: t, lambda t: t + 0.03 * (t > 2.0), 0.04),  # 0.4 rad
        (lambda t: t + 1.0 * (t > 2.0), lambda t: t, 0.03),  # 1.1 rad
    ],
    ids=["day", "drift", "later", "jump"],
)
def test_a_stream_is_followed_by_clocks_that_drift_and_jump(stamp, arrival, most):
    shield, start = make()
    dt = shield.dt

    def motion(t):
        t = np.maximum(np.atleast_1d(t), 0.0)
        swing = 0.27 * np.sin(3.77 * t) * np.minimum(t / 1.5, 1.0)
        return start + swing[:, np.newaxis]

    path = [start]
    k = 0
    for i in range(1200):
        own = {}
        if i * dt >= arrival(k / RATE) - 1e-9:
            own = {"position": motion(k / RATE)[0], "time": stamp(k / RATE), "lead": 1}
            k += 1
        command = shield.step(path[-1], **own)
        assert "request not finite" not in command.reasons
        path.append(path[-1] + dt * command.dq)
    assert broken(shield, path) == []
    times = np.arange(len(path)) * dt
    off = np.abs(np.array(path) - motion(times - 1.0 / RATE)).max(axis=1)
    assert off[(times > 1.0) & (abs(times - 2.4) > 0.5)].max() < most


def test_stream_that_stops_dead_comes_back_and_a_rest_is_not_passed():
    """What a lead costs: docs/policies.md."""
    shield, start = make()
    for own, least, most in (
        ({}, -1e-9, 1e-9),
        ({"lead": 1}, 0.02, 0.08),
        ({"lead": 2}, 0.03, 0.12),
    ):
        shield.reset(start)
        path = [start]
        for k in range(300):
            goal = start + min(max(k * shield.dt, 0.0), 0.5)
            path.append(path[-1] + shield.dt * shield.step(path[-1], position=goal, **own).dq)
        assert broken(shield, path) == []
        assert least <= (np.array(path) - start - 0.5).max() <= most
        np.testing.assert_allclose(path[-1], start + 0.5, atol=1e-6)


def test_preview_is_what_comes_and_changes_nothing():
    shield, start = make()
    shield.step(start, np.zeros(start.size))
    kept = pickle.dumps(shield)
    times = shield.time + np.arange(50) / 60.0
    for quick, keep in ((0.5, "time"), (2.5, "time"), (2.5, "path")):
        points = moves(start, quick * (times - times[0]))
        found = shield.preview(times, points, keep)
        assert pickle.dumps(shield) == kept
        other = pickle.loads(kept)
        other.follow(times, points, keep)
        path = [start]
        clock = [other.time]
        while other.time < 4.0:
            command = other.step(path[-1])
            path.append(path[-1] + other.dt * command.dq)
            clock.append(min(other.time, times[-1]) - command.late)
        at = np.array([np.interp(times, clock, joint) for joint in np.transpose(path)]).T
        off = np.abs(at - points).max(axis=1)
        np.testing.assert_allclose(found.off[:-1], off[:-1], atol=3e-4)  # the arm ends later
        assert (found.sample is None) == (off.max() < 1e-3) == (quick == 0.5 or keep == "path")
        assert (found.late > 0.4) == (quick == 2.5)


def test_preview_names_what_is_in_the_way():
    shield, start = make()
    shield.step(start, np.zeros(start.size))
    times = shield.time + np.array([0.0, 1.0, 2.0])
    beyond = np.array([start, start, start])
    beyond[1:, 0] = shield.robot.q_upper[0] + 0.1
    found = shield.preview(times, beyond)
    assert found.sample == 1
    assert "joint 1 upper position limit" in found.active_limits
    assert found.off[2] == pytest.approx(0.1, abs=1e-3)
    assert shield.preview([-1.0], [start])[:2] == (0, ("samples stale",))
    assert shield.preview(times, np.full((3, start.size), np.nan))[:2] == (
        0,
        ("request not finite",),
    )


@pytest.mark.parametrize("seed", range(6))
def test_hostile_chunks_beside_a_ball_break_no_promise(seed):
    pytest.importorskip("coal")
    from judge_distances import Judge

    random = np.random.default_rng(seed)
    name = ("so101", "iiwa7")[seed % 2]
    robot = make(name)[0].robot
    q = robot.start_posture()
    tip = iiwa_dnn.Configuration(robot, q).position
    ball = iiwa_dnn.Sphere(tip + [0.06, 0.08, 0.12 + 0.06 * (seed % 2)], 0.03)
    avoidance = iiwa_dnn.CollisionAvoidance([ball], distance=0.02)
    shield, _ = make(name, obstacles=avoidance)
    path = [q]
    for k in range(600):
        own = {}
        draw = random.random()
        if draw < 0.05:
            times = shield.time + random.choice([-1.0, 0.0, 0.3]) + np.cumsum(random.random(8)) / 9
            points = q + random.choice([0.1, 1.0, 4.0]) * random.uniform(-1.0, 1.0, (8, q.size))
            points[random.integers(8)] *= np.nan if random.random() < 0.1 else 1.0
            shield.follow(times, points, keep=("time", "path")[k % 2])
        elif draw < 0.2:
            goal = q + random.choice([0.1, 4.0]) * random.uniform(-1.0, 1.0, q.size)
            own = {"position": goal, "lead": int(random.integers(3))}
        q = q + shield.dt * shield.step(q, **own).dq
        path.append(q)
    assert broken(shield, path) == []
    judged = Judge(robot, avoidance).verdict(np.array(path), shield.dt)
    assert judged.broken == 0
    assert np.ptp(path, axis=0).max() > 0.3
