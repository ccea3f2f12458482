"""Loading robots, their limits, and what is said when it fails."""

import pickle
import warnings

import numpy as np
import pinocchio as pin
import pytest

import iiwa_dnn as d
from helpers_kinematics import example_urdf, finite_difference
from iiwa_dnn.errors import InvalidInputError, NotFoundError
from iiwa_dnn.robot import Configuration, Robot, available_robots, load_robot
from iiwa_dnn.robot.collision import make_collision_model
from iiwa_dnn.robot.mujoco_model import JointDynamics, compile_model
from iiwa_dnn.robot.shapes import visual_meshes

LIMIT = '<limit lower="-1" upper="2" effort="3" velocity="4"/>'
FINGERS = ("panda_finger_joint1", "panda_finger_joint2")


def one_joint(limit: str = LIMIT, kind: str = "revolute") -> str:
    return (
        f'<robot name="one"><link name="a"/><link name="b"/><joint name="j" type="{kind}">'
        f'<parent link="a"/><child link="b"/><origin xyz="0 0 1"/><axis xyz="0 1 0"/>{limit}'
        "</joint></robot>"
    )


@pytest.fixture(scope="module")
def robot() -> Robot:
    return load_robot("iiwa7")


def test_by_name_and_by_path(robot: Robot, written) -> None:
    assert "iiwa7" in available_robots()
    assert robot.joint_names == tuple(f"iiwa7_joint_{i}" for i in range(1, 8))
    assert repr(robot) == "<Robot iiwa7: 7 joints, tip iiwa7_flange>"
    locked = load_robot("iiwa7", locked=["iiwa7_joint_3", "iiwa7_joint_7"], frames="iiwa7_link_2")
    assert "locked: iiwa7_joint_3, iiwa7_joint_7" in repr(locked)
    for path in (written(one_joint()), str(written(one_joint()))):
        robot = load_robot(path)
        assert (robot.name, robot.tip, robot.dof) == ("one", "b", 1)
        assert [robot.q_lower, robot.q_upper, robot.dq_max] == [-1, 2, 4]


def test_the_reach_bounds_the_tips_distance(robot: Robot) -> None:
    tips = [Configuration(robot, q).position for q in robot.draw(np.random.default_rng(1), 999)]
    assert 0.95 * robot.reach < np.linalg.norm(tips, axis=1).max() <= robot.reach
    slide = d.robot_from_dh([[0, 0, 0.5, 0]], prismatic=[1], lower=-0.1, upper=0.3)
    assert slide.reach == pytest.approx(0.8)


@pytest.mark.parametrize(
    ("limit", "velocity"), [("", np.inf), (LIMIT, 4.0), (LIMIT.replace("4", "0"), np.inf)]
)
def test_continuous_joints_have_no_position_limits(written, limit: str, velocity: float) -> None:
    robot = load_robot(written(one_joint(limit, "continuous")))
    np.testing.assert_array_equal(robot.limits[:3, 0], [-np.inf, np.inf, velocity])
    turned = Configuration(robot, [100.0]).rotation  # about y, past many full turns
    np.testing.assert_allclose(turned[0], [np.cos(100.0), 0.0, np.sin(100.0)], atol=1e-12)


def test_frames_by_name(robot: Robot, written) -> None:
    assert set(robot.joint_names) < set(robot.frame_names)
    for name in robot.frame_names:
        assert robot.model.frames[robot.frame_id(name)].name == name
    assert robot.frame_id(robot.tip) == robot.tip_id
    for name in ("universe", "iiwa7_link4"):
        with pytest.raises(NotFoundError, match=f"no frame '{name}'") as caught:
            robot.frame_id(name)
        assert caught.value.available == robot.frame_names
    # A link comes before a joint of its name.
    text = one_joint().replace('name="b"', 'name="j"').replace('link="b"', 'link="j"')
    robot = load_robot(written(text))
    assert robot.frame_names == ("a", "j")
    assert str(robot.model.frames[robot.frame_id("j")].type) == "BODY"


def test_a_joint_that_does_not_move_the_tip_is_held_still_and_it_is_said() -> None:
    path = load_robot("iiwa7_dual").path
    left, right = "left_iiwa7_flange", "right_iiwa7_flange"
    with pytest.raises(InvalidInputError, match=f"several ends: {left}, {right}"):
        load_robot(path)
    with pytest.warns(
        UserWarning, match=f"^held still, since they do not move {left}: right_"
    ) as said:
        robot = load_robot(path, tip=left)
    assert (robot.dof, len(robot.locked)) == (7, 7)
    held = ", ".join(f"{joint} at 0" for joint in robot.locked)
    assert str(said[0].message).endswith(f": {held}")
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # what was asked for is not said
        assert load_robot(path, tip=left, locked=robot.locked).dof == 7
        assert load_robot(path, tip=left, frames=[right]).dof == 14
    with pytest.raises(NotFoundError, match="no frame 'rihgt'"):
        load_robot(path, tip=left, frames=["rihgt"])


def test_the_fingers_of_a_panda_are_held_still_unless_one_is_the_tip() -> None:
    path = example_urdf("panda_description/urdf/panda.urdf")
    with pytest.warns(UserWarning, match="panda_hand_tcp: panda_finger_joint1 at 0, panda_finger"):
        robot = load_robot(path, tip="panda_hand_tcp")
    assert (robot.name, robot.dof, robot.locked) == ("panda", 7, FINGERS)
    first, second = FINGERS
    with pytest.raises(InvalidInputError, match=f"{second!r} follows {first!r}: lock it"):
        load_robot(path, tip="panda_rightfinger")


@pytest.mark.parametrize("unlimited", [True, False])
def test_a_pinocchio_model_is_a_robot_too(robot: Robot, unlimited: bool) -> None:
    model = robot.model.copy()
    expected = robot.limits.copy()
    if unlimited:
        model.upperPositionLimit[2] = np.finfo(float).max  # Pinocchio's own way to say none
        expected[1, 2] = np.inf
    found = load_robot(model)
    assert (found.name, found.tip, found.path) == ("iiwa7", "iiwa7_flange", None)
    np.testing.assert_array_equal(found.limits, expected)
    q = robot.start_posture()
    np.testing.assert_array_equal(Configuration(found, q).pose, Configuration(robot, q).pose)
    with pytest.warns(UserWarning, match="do not move iiwa7_link_5: iiwa7_joint_6 at 0"):
        assert load_robot(model, tip="iiwa7_link_5").dof == 5
    assert visual_meshes(found) == ()


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
    ahead = conf.position + 0.1 * conf.rotation[:, 2]
    np.testing.assert_allclose(Configuration(longer, q).position, ahead, atol=1e-15)
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
        assert compile_model(left, 1e-3, JointDynamics()).nq == 1
