"""Tests of chunks and streams of poses, by Pinocchio's kinematics and a judge of limits."""

import warnings

import numpy as np
import pinocchio as pin
import pytest

import iiwa_dnn
from judge_limits import breaches

RATE = 15.0  # Hz
TIMES = np.arange(31) / RATE


def make(name="iiwa7", start=None):
    """Return a shield of an arm at rest in a posture, and that posture."""
    robot = iiwa_dnn.load_robot(name).with_limits(acceleration=10.0, jerk=500.0)
    shield = iiwa_dnn.Shield(robot, dt=5e-3)
    q = robot.start_posture() if start is None else np.array(start)
    shield.reset(q)
    return shield, q


def drive(shield, q, seconds):
    """Take steps of an arm that follows, from q on; return its positions, which break no limit."""
    path = [q]
    while len(path) * shield.dt < seconds:
        path.append(path[-1] + shield.dt * shield.step(path[-1]).dq)
    assert breaches(np.array(path), shield.dt, *shield.robot.limits) == []
    return np.array(path)


def tips(shield, path, frame=None):
    """Return the poses of a frame along a path."""
    found = [iiwa_dnn.Configuration(shield.robot, q) for q in path]
    states = found if frame is None else [each.frame(frame) for each in found]
    return [pin.SE3(np.array(each.rotation), np.array(each.position)) for each in states]


def bow(t):
    """Compute a share of a motion there and back, of minimum jerk, from 0.2 to 1.8 s."""
    u = np.clip((t - 0.2) / 0.8, 0.0, 2.0)
    u = np.minimum(u, 2.0 - u)
    return u**3 * (10.0 - 15.0 * u + 6.0 * u * u)


def motion(start, t, way=(0.0, 0.1, 0.05), turn=(0.0, 0.3, 0.2)):
    """Return a pose at a time: `start`, moved and turned along a bow."""
    share = bow(t)
    rotation = pin.exp3(share * np.array(turn)) @ start.rotation
    return pin.SE3(rotation, start.translation + share * np.array(way))


def as_rows(poses):
    """Return poses as positions and quaternions w, x, y, z, (m, 7), of either sign."""
    rows = []
    for k, pose in enumerate(poses):
        x, y, z, w = (-1.0) ** k * pin.Quaternion(pose.rotation).coeffs()
        rows.append([*pose.translation, w, x, y, z])
    return np.array(rows)


@pytest.mark.parametrize("form", ["matrices", "quaternions", "positions"])
@pytest.mark.parametrize("frame", [None, "iiwa7_link_6"])
def test_poses_are_followed(form, frame):
    shield, q = make()
    start = tips(shield, [q], frame)[0]
    poses = [motion(start, t) for t in TIMES]
    given = {
        "matrices": [pose.homogeneous for pose in poses],
        "quaternions": as_rows(poses),
        "positions": [pose.translation for pose in poses],
    }[form]
    assert shield.follow(TIMES, poses=given, frame=frame) == {}
    path = drive(shield, q, 2.0)
    for k, pose in enumerate(tips(shield, path, frame)):
        error = motion(start, k * shield.dt).actInv(pose)
        assert np.linalg.norm(error.translation) < 1e-3
        assert form == "positions" or np.linalg.norm(pin.log3(error.rotation)) < 3e-3


def test_an_arm_of_five_joints_keeps_the_position():
    shield, q = make("so101")
    start = tips(shield, [q])[0]
    poses = [motion(start, t, (0.0, 0.03, 0.02), (0.3, 0.0, 0.0)) for t in TIMES]
    assert shield.follow(TIMES, poses=[pose.homogeneous for pose in poses]) == {}
    path = drive(shield, q, 2.0)
    goals = [motion(start, k * shield.dt, (0.0, 0.03, 0.02)) for k in range(len(path))]
    off = [
        np.linalg.norm(a.translation - b.translation)
        for a, b in zip(tips(shield, path), goals, strict=True)
    ]
    assert max(off) < 1e-3


def test_poses_out_of_reach_are_left_out_and_the_arm_comes_back():
    shield, q = make()
    start = tips(shield, [q])[0]
    poses = [motion(start, t, (1.0, 0.0, 0.4), (0.0, 0.0, 0.0)) for t in TIMES]
    given = [pose.homogeneous for pose in poses]
    seen = shield.preview(TIMES, poses=given)
    left_out = shield.follow(TIMES, poses=given)
    reach = np.linalg.norm([pose.translation - [0.0, 0.0, 0.34] for pose in poses], axis=1)
    first = min(k for k, words in left_out.items() if words.startswith("out of reach"))
    assert seen.sample <= first
    assert np.isnan(seen.off[first])
    assert 0.8 < reach[first] < 0.95  # the links' lengths beyond the shoulder: 0.926 m
    assert left_out.keys().isdisjoint({0, 1, 2, 28, 29, 30})
    path = drive(shield, q, 4.0)
    error = start.actInv(tips(shield, path[-1:])[0])
    assert np.linalg.norm(pin.log6(error)) < 1e-3
    assert shield.follow(shield.time + TIMES[:2], poses=[[9.0, 9.0, 9.0]] * 2).keys() == {0, 1}
    assert shield.preview(shield.time + TIMES[:1], poses=[[9.0, 9.0, 9.0]]).sample == 0


def test_joints_that_turn_fast_beside_a_singular_posture_are_named():
    """The hand turns about an axis that the wrist has lost."""
    shield, q = make(start=[0.0, 0.5, 0.0, -1.2, 0.0, 1e-3, 0.0])
    start = tips(shield, [q])[0]
    turns = np.linspace(0.0, 0.8, TIMES.size)
    poses = [
        pin.SE3(start.rotation @ pin.exp3(np.array([s, 0.0, 0.0])), start.translation)
        for s in turns
    ]
    left_out = shield.follow(0.02 * TIMES, poses=[pose.homogeneous for pose in poses])
    assert any("too fast, as beside a singular posture" in words for words in left_out.values())
    drive(shield, q, 2.0)


def test_a_hand_turns_by_more_than_half_a_turn():
    shield, q = make(start=[0.0, 0.5, 0.0, -1.2, 0.0, 1.0, -2.9])
    start = tips(shield, [q])[0]
    angles = 5.7 * bow(0.2 + 0.4 * TIMES)
    poses = [start * pin.SE3(pin.exp3(np.array([0.0, 0.0, a])), np.zeros(3)) for a in angles]
    assert shield.follow(2.0 * TIMES, poses=as_rows(poses)) == {}
    path = drive(shield, q, 5.0)
    assert (path[-1] - q)[6] > np.pi
    for pose in tips(shield, [*path[::50], path[-1]]):
        off = start.actInv(pose)
        assert np.linalg.norm(off.translation) < 1e-3
        assert np.linalg.norm(off.rotation[:2, 2]) < 3e-3
    np.testing.assert_allclose(off.rotation, pin.exp3(np.array([0.0, 0.0, 5.7])), atol=1e-4)


def test_deltas_of_a_hand_at_10_hz_are_followed_a_sample_late():
    shield, q = make()
    start = tips(shield, [q])[0]
    goal, posture = start, q
    path = [q]
    for k in range(400):
        t = k * shield.dt
        own = {}
        if k % 20 == 0:
            delta = motion(start, t - 0.1).actInv(motion(start, t))
            goal = goal * delta
            found = iiwa_dnn.solve_pose(
                shield.robot, iiwa_dnn.Target(goal), posture, starts=1, tol=1e-6
            )
            posture = found.q
            own = {"position": posture, "time": t, "lead": 1}
        path.append(path[-1] + shield.dt * shield.step(path[-1], **own).dq)
    assert breaches(np.array(path), shield.dt, *shield.robot.limits) == []
    off = [
        np.linalg.norm(pose.translation - motion(start, k * shield.dt - 0.1).translation)
        for k, pose in enumerate(tips(shield, path))
    ]
    assert np.median(off) < 1e-3


def test_two_frames_are_followed_at_once():
    """Both hands of two arms, and of one arm the tip's pose and where its elbow is."""
    robot = iiwa_dnn.load_robot("iiwa7_dual").with_limits(acceleration=10.0, jerk=500.0)
    shield = iiwa_dnn.Shield(robot, dt=5e-3)
    q = robot.start_posture()
    shield.reset(q)
    frames = ("left_iiwa7_link_7", "right_iiwa7_link_7")
    starts = {frame: tips(shield, [q], frame)[0] for frame in frames}
    ways = {frames[0]: (0.02, 0.03, 0.0), frames[1]: (0.02, -0.03, 0.03)}
    poses = {
        frame: [motion(starts[frame], t, ways[frame], (0.1, 0.0, 0.0)).homogeneous for t in TIMES]
        for frame in frames
    }
    assert shield.follow(TIMES, poses=poses) == {}
    path = drive(shield, q, 2.0)
    for frame in frames:
        for k, pose in enumerate(tips(shield, path, frame)):
            goal = motion(starts[frame], k * shield.dt, ways[frame], (0.1, 0.0, 0.0))
            assert np.linalg.norm(pin.log6(goal.actInv(pose))) < 3e-3
    shield, q = make()
    start = tips(shield, [q])[0]
    elbow = tips(shield, [q], "iiwa7_link_4")[0].translation
    given = {
        "iiwa7_link_4": [pin.exp3(np.array([0.0, 0.0, 0.05 * bow(t)])) @ elbow for t in TIMES],
        shield.robot.tip: [start.translation for t in TIMES],
    }
    assert shield.follow(TIMES, poses=given) == {}
    path = drive(shield, q, 1.0)
    moved = tips(shield, path[-1:], "iiwa7_link_4")[0].translation
    there = pin.exp3(np.array([0.0, 0.0, 0.05 * bow(1.0)])) @ elbow
    np.testing.assert_allclose(moved, there, atol=1e-3)
    np.testing.assert_allclose(tips(shield, path[-1:])[0].translation, start.translation, atol=1e-3)
    with pytest.raises(iiwa_dnn.InvalidInputError, match="frame: is stated by poses"):
        shield.follow(TIMES, poses=given, frame="iiwa7_link_4")
    with pytest.raises(iiwa_dnn.NotFoundError):
        shield.follow(TIMES, poses={"nothing": given["iiwa7_link_4"]})


def test_poses_that_are_none():
    shield, q = make()
    start = tips(shield, [q])[0]
    with pytest.raises(iiwa_dnn.InvalidInputError, match="pass exactly one"):
        shield.follow([0.0], [q], poses=[start.homogeneous])
    with pytest.raises(iiwa_dnn.InvalidInputError, match="poses: must have shape"):
        shield.follow([0.0], poses=[[1.0, 2.0]])
    with pytest.raises(iiwa_dnn.InvalidInputError, match="quaternions w, x, y, z of norm 1"):
        shield.follow([0.0], poses=[[0.5, 0.0, 0.5, 1.0, 1.0, 0.0, 0.0]])
    with pytest.raises(iiwa_dnn.InvalidInputError, match="need a step, or a reset"):
        iiwa_dnn.Shield(shield.robot).follow([0.0], poses=[start.homogeneous])
    assert shield.follow([0.0], poses=[np.full(3, np.nan)]) == {}
    assert shield.step(q).reasons == ("request not finite",)


def test_a_chunk_in_degrees_is_warned_of_once():
    shield, q = make()
    chunk = np.degrees(q + np.linspace(0.0, 0.3, 4)[:, np.newaxis])
    with pytest.warns(UserWarning, match="are the positions in degrees"):
        shield.follow([0.0, 0.1, 0.2, 0.3], chunk)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        shield.follow([0.0, 0.1, 0.2, 0.3], chunk)


def test_a_delay_does_not_change_what_is_commanded():
    """The arm is where the samples are `delay` later."""
    paths = []
    for late in (0, 8):
        robot = make()[0].robot
        shield = iiwa_dnn.Shield(robot, dt=5e-3, delay=late * 5e-3)
        q = robot.start_posture()
        commanded = [q] * (1 + late)
        shield.reset(q)
        shield.follow(TIMES, [q + 0.3 * bow(t) for t in TIMES])
        for _ in range(400):
            command = shield.step(commanded[-1 - late])
            commanded.append(commanded[-1] + shield.dt * command.dq)
        paths.append(np.array(commanded[late:]))
    np.testing.assert_allclose(*paths, atol=1e-9)
