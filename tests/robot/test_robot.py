"""Loading robots, their limits, and what is said when it fails."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from helpers_kinematics import finite_difference
from iiwa_dnn.errors import FileError, InvalidInputError, NotFoundError
from iiwa_dnn.robot import Configuration, Robot, available_robots, load_robot
from iiwa_dnn.robot.collision import make_collision_model
from iiwa_dnn.robot.mujoco_model import compile_model
from iiwa_dnn.robot.shapes import visual_meshes

LIMIT = '<limit lower="-1" upper="2" effort="3" velocity="4"/>'


def one_joint(limit: str = LIMIT, kind: str = "revolute", origin: str = "0 0 1") -> str:
    return (
        f'<robot name="one"><link name="a"/><link name="b"/><joint name="j" type="{kind}">'
        f'<parent link="a"/><child link="b"/><origin xyz="{origin}"/><axis xyz="0 1 0"/>{limit}'
        "</joint></robot>"
    )


@pytest.fixture(scope="module")
def robot() -> Robot:
    return load_robot("iiwa7")


@pytest.fixture
def written(tmp_path: Path):
    def write(content: str | bytes) -> Path:
        path = tmp_path / "some.urdf"
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return write


def test_by_name(robot: Robot) -> None:
    assert "iiwa7" in available_robots()
    assert (robot.name, robot.tip, robot.dof) == ("iiwa7", "iiwa7_flange", 7)
    assert robot.model.frames[robot.tip_id].name == "iiwa7_flange"
    assert robot.joint_names == tuple(f"iiwa7_joint_{i}" for i in range(1, 8))
    assert repr(robot) == "<Robot iiwa7: 7 joints, tip iiwa7_flange>"


@pytest.mark.parametrize("kind", [Path, str])
def test_by_path(written, kind: type) -> None:
    robot = load_robot(kind(written(one_joint())))
    assert (robot.name, robot.tip, robot.dof) == ("one", "b", 1)
    assert [robot.q_lower, robot.q_upper, robot.dq_max] == [-1, 2, 4]


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        ("", "not XML"),
        (b"\x00\xff\xfe", "not XML"),
        ("<robot>" + "<a>" * 100_000 + "</a>" * 100_000 + "</robot>", "not XML"),
        ("<sdf/>", "first element is <sdf>"),
        ('<robot name="x"><link name="a"/></robot>', "no joints"),
        (one_joint().replace('child link="b"', 'child link="c"'), "Pinocchio can read"),
        (one_joint(""), "Pinocchio can read"),
        (one_joint(origin="nan 0 0"), "Pinocchio can read"),
        (one_joint(LIMIT.replace("-1", "nan")), "Pinocchio can read"),
        (one_joint(LIMIT.replace('velocity="4"', 'velocity="-4"')), "min_velocity"),
    ],
)
def test_bad_files(written, content: str | bytes, reason: str) -> None:
    path = written(content)
    with pytest.raises(FileError, match=reason) as caught:
        load_robot(path)
    assert caught.value.path == str(path)
    assert "\n" not in str(caught.value)
    with pytest.raises(FileError, match="No such file"):
        load_robot(path.with_name("none.urdf"))


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (one_joint("", "fixed"), "tip: no joint moves frame"),
        (one_joint(LIMIT.replace("-1", "2")), "joint 'j': lower limit 2 is not below 2"),
    ],
)
def test_robots_that_cannot_move(written, content: str, reason: str) -> None:
    with pytest.raises(InvalidInputError, match=reason):
        load_robot(written(content))


@pytest.mark.parametrize("kind", ["floating", "planar"])
def test_joints_of_other_kinds_are_named(written, kind: str) -> None:
    with pytest.raises(InvalidInputError, match=r"'j' has \d coordinates, \d directions: lock it"):
        load_robot(written(one_joint("", kind)))


@pytest.mark.parametrize(("limit", "velocity"), [("", np.inf), (LIMIT, 4.0)])
def test_continuous_joints_have_no_position_limits(written, limit: str, velocity: float) -> None:
    robot = load_robot(written(one_joint(limit, "continuous")))
    np.testing.assert_array_equal(robot.limits[:3, 0], [-np.inf, np.inf, velocity])
    turned = Configuration(robot, [100.0]).rotation  # about y, past many full turns
    np.testing.assert_allclose(turned[0], [np.cos(100.0), 0.0, np.sin(100.0)], atol=1e-12)


def test_limits_that_are_not_given(written) -> None:
    robot = load_robot(written(one_joint('<limit effort="1" velocity="0"/>')))
    assert [robot.q_lower, robot.q_upper, robot.dq_max] == [-np.inf, np.inf, np.inf]


def test_tips(robot: Robot) -> None:
    with pytest.warns(UserWarning, match="iiwa7_joint_6 at 0, iiwa7_joint_7 at 0"):
        other = load_robot("iiwa7", tip="iiwa7_link_5")
    assert other.model.frames[other.tip_id].name == other.tip == "iiwa7_link_5"
    with pytest.raises(NotFoundError, match="no frame 'flange'") as caught:
        load_robot("iiwa7", tip="flange")
    assert "iiwa7_flange" in caught.value.available
    with pytest.raises(InvalidInputError, match="no joint moves frame 'iiwa7_link_0'"):
        load_robot("iiwa7", tip="iiwa7_link_0")


def test_frames_by_name(robot: Robot) -> None:
    assert set(robot.joint_names) < set(robot.frame_names)
    for name in robot.frame_names:
        assert robot.model.frames[robot.frame_id(name)].name == name
    assert robot.frame_id(robot.tip) == robot.tip_id
    for name in ("universe", "iiwa7_link4"):
        with pytest.raises(NotFoundError, match=f"no frame '{name}'") as caught:
            robot.frame_id(name)
        assert caught.value.available == robot.frame_names


def test_a_link_comes_before_a_joint_of_its_name(written) -> None:
    text = one_joint().replace('name="b"', 'name="j"').replace('link="b"', 'link="j"')
    robot = load_robot(written(text))
    assert robot.frame_names == ("a", "j")
    assert str(robot.model.frames[robot.frame_id("j")].type) == "BODY"


def test_locked_joints_stay_at_zero(robot: Robot) -> None:
    locked = load_robot("iiwa7", locked=["iiwa7_joint_3", "iiwa7_joint_7"])
    assert (locked.dof, locked.tip) == (5, "iiwa7_flange")
    assert "locked: iiwa7_joint_3, iiwa7_joint_7" in repr(locked)
    np.testing.assert_array_equal(locked.q_upper, np.delete(robot.q_upper, [2, 6]))
    q = np.random.default_rng(3).uniform(-1, 1, 7) * [1, 1, 0, 1, 1, 1, 0]
    whole, part = Configuration(robot, q), Configuration(locked, np.delete(q, [2, 6]))
    np.testing.assert_allclose(part.position, whole.position, rtol=0, atol=1e-14)
    np.testing.assert_allclose(part.jacobian, np.delete(whole.jacobian, [2, 6], 1), atol=1e-14)


@pytest.mark.parametrize("as_se3", [True, False])
def test_a_tool_takes_the_tips_place(robot: Robot, as_se3: bool) -> None:
    numbers = [0.1, -0.02, 0.3, 0.4, -0.5, 0.6]
    place = pin.SE3(pin.rpy.rpyToMatrix(np.array(numbers[3:])), np.array(numbers[:3]))
    held = load_robot("iiwa7", tool=place if as_se3 else numbers)
    assert (held.tip, held.dof) == ("tool", 7)
    q = robot.start_posture()
    expected = Configuration(robot, q).pose @ place.homogeneous
    for again in (held, pickle.loads(pickle.dumps(held))):
        conf = Configuration(again, q)
        np.testing.assert_allclose(conf.pose, expected, atol=1e-15)
        np.testing.assert_array_equal(conf.frame(robot.tip).pose, Configuration(robot, q).pose)
    derivative = finite_difference(lambda x: Configuration(held, x).position, q)
    np.testing.assert_allclose(conf.jacobian[:3], derivative, atol=1e-8)
    longer = held.with_tool([0, 0, 0.1, 0, 0, 0], "pen")
    np.testing.assert_allclose(
        Configuration(longer, q).position, conf.position + 0.1 * conf.rotation[:, 2], atol=1e-15
    )
    with pytest.raises(InvalidInputError, match="a frame 'tool' already"):
        longer.with_tool(place)


def test_with_limits(robot: Robot) -> None:
    velocity = np.arange(1.0, 8.0)
    other = robot.with_limits(lower=-2.5, upper=[np.inf] * 7, velocity=velocity)
    velocity[:] = 0.0  # a copy was taken
    np.testing.assert_array_equal(other.q_lower, np.full(7, -2.5))
    np.testing.assert_array_equal(other.q_upper, np.full(7, np.inf))
    np.testing.assert_array_equal(other.dq_max, np.arange(1.0, 8.0))
    assert (other.name, other.tip, other.tip_id) == (robot.name, robot.tip, robot.tip_id)
    assert robot.q_upper[0] == np.radians(170)
    np.testing.assert_array_equal(robot.with_limits(velocity=2).q_lower, robot.q_lower)
    for side in (-1.0, 1.0):  # the iiwa's limits are symmetric
        assert robot.outside(side * (robot.q_upper + 5e-10)) == ""
        assert "joint 1 is at" in robot.outside(side * (robot.q_upper + 1e-6))


BODY = """<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>
</inertial> <visual><geometry><sphere radius="0.1"/></geometry></visual>
<collision><geometry><cylinder radius="0.1" length="0.4"/></geometry></collision>"""


def test_a_robot_does_not_need_its_file_any_more(written) -> None:
    path = written(one_joint().replace('<link name="b"/>', f'<link name="b">{BODY}</link>'))
    robot = load_robot(path)
    path.unlink()
    for left in (robot, pickle.loads(pickle.dumps(robot))):
        (capsule,) = make_collision_model(left, samples=1).capsules
        assert capsule.link == "b"
        assert visual_meshes(left) == ()
        assert compile_model(left, 1e-3).nq == 1
