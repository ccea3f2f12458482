"""Arms by name: the chain, its gripper, a second reader's poses, and the heart drawn with it."""

import dataclasses
import io
import xml.etree.ElementTree as ET
from importlib import metadata
from itertools import product

import numpy as np
import pinocchio as pin
import pytest
import yourdfpy

import iiwa_dnn as d
from helpers_kinematics import PAPER_Q0, Array, example_urdf
from iiwa_dnn.control.shield import DISTANCE
from iiwa_dnn.robot.arms import ARMS, robots_folder
from iiwa_dnn.robot.collision import collision_file
from iiwa_dnn.robot.shapes import visual_meshes

OWN = ("fr3", "iiwa7", "iiwa7_dual")


@pytest.fixture(autouse=True)
def installed() -> None:
    example_urdf("panda_description/urdf/panda.urdf")


def is_inside(robot: d.Robot, q: Array) -> bool:
    return bool((q > robot.q_lower).all() and (q < robot.q_upper).all())


@pytest.mark.parametrize("name", ARMS)
def test_every_arm_starts_inside_its_limits_and_not_singular(name: str) -> None:
    robot = d.load_robot(name)
    np.testing.assert_array_equal(robot.start_posture(), ARMS[name].start)
    other = dataclasses.replace(robot, name="some")
    locked = d.load_robot(name, locked=robot.joint_names[0])
    free = 0.05 if name == "so101" else 0.1  # small, and its start is chosen by positions
    for start, least in ((robot, free), (other, free), (locked, 0.01)):
        q = start.start_posture()
        assert is_inside(start, q)
        assert np.linalg.svd(d.Configuration(start, q).jacobian, compute_uv=False)[-1] >= least


@pytest.mark.parametrize("name", ARMS)
def test_every_arm_starts_at_the_default_distance_from_itself(name: str) -> None:
    robot = d.load_robot(name)
    avoidance = d.CollisionAvoidance()
    near, _ = avoidance.scene(robot).nearest(robot.start_posture()[np.newaxis], np.zeros(1))
    assert near[0] > avoidance.distance == DISTANCE


def test_the_iiwa_starts_where_the_paper_does_or_as_near_as_its_limits_let_it() -> None:
    robot = d.load_robot("iiwa7")
    np.testing.assert_array_equal(robot.start_posture(), PAPER_Q0)
    tight = robot.with_limits(lower=-2.0, upper=2.0)
    expected = [-1.8, *PAPER_Q0[1:]]  # the first joint's -2.357 is outside
    np.testing.assert_allclose(tight.start_posture(), expected, rtol=0, atol=1e-15)


@pytest.mark.parametrize(
    ("lower", "upper"),
    [(-np.inf, np.inf), (1.0, np.inf), (-np.inf, -1.0), ([-1, -np.inf, 4], [np.inf, 2, 5])],
)
def test_a_start_where_limits_are_on_one_side_or_on_none(lower: object, upper: object) -> None:
    robot = d.robot_from_dh(np.full((3, 4), 0.3), lower=lower, upper=upper)
    assert is_inside(robot, robot.start_posture())
    assert np.abs(robot.start_posture()).max() < 3.0 * np.pi


@pytest.mark.parametrize(
    ("name", "orientation"),
    # The five joints of the SO-101 have no pose to choose.
    [
        *product(sorted({*ARMS} - {"so101", *OWN}), ["so3"]),
        *product(["ur5", "panda", "so101"], ["none"]),
    ],
)
def test_the_heart_with_any_redundancy(name: str, orientation: str) -> None:
    robot = d.load_robot(name)
    q0 = robot.start_posture()
    reference = d.Heart().anchored(d.Configuration(robot, q0))
    scheme = d.DoubleIndicator(orientation=orientation)
    record = d.simulate(robot, scheme, reference, q0, dt=2e-2)
    assert d.failures(record) == []
    metrics = d.compute_metrics(record)
    assert metrics["crosscheck"]["steps_checked"] == 500
    # Euler's error is of first order: two hundred times that of 1e-4 s, which is 3.4e-7 m.
    assert metrics["max_position_error_m"] < 1e-4
    assert (metrics["max_orientation_error_rad"] < 1e-3) == (orientation == "so3")


def test_without_the_package_one_line_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    assert d.available_robots() == tuple(ARMS)

    def missing(name: str) -> None:
        raise metadata.PackageNotFoundError(name)

    monkeypatch.setattr(metadata, "distribution", missing)
    with pytest.raises(d.MissingDependencyError, match=r"pip install 'iiwa-dnn\[robots\]'"):
        d.load_robot("panda")
    assert d.available_robots() == OWN
    # A file of one's own may have the name of such an arm.
    own = dataclasses.replace(d.load_robot("iiwa7"), name="panda")
    assert collision_file(own).name == "iiwa7.collisions.toml"


def test_the_iiwa_7_has_the_limits_of_its_data_sheet() -> None:
    robot = d.load_robot("iiwa7")
    position = np.radians([170, 120, 170, 120, 170, 120, 175])
    np.testing.assert_array_equal(robot.q_upper, position)
    np.testing.assert_array_equal(robot.q_lower, -position)
    np.testing.assert_array_equal(robot.dq_max, np.radians([98, 98, 100, 130, 140, 180, 180]))
    np.testing.assert_array_equal(robot.model.effortLimit, [176, 176, 110, 110, 110, 40, 40])


def test_robots_of_the_package_need_no_file_of_another_package() -> None:
    assert {path.stem for path in robots_folder().glob("*/*.urdf")} == set(OWN)
    for name in OWN:
        root = ET.fromstring(d.load_robot(name).urdf)
        assert root.get("name") == name
        assert root.findall(".//visual")
        assert root.findall(".//collision")
        assert not root.findall(".//mesh")
        assert visual_meshes(d.load_robot(name)) == ()


def reader_of(robot: d.Robot) -> yourdfpy.URDF:
    """Read a robot's text a second time; joints that follow others are given their positions."""
    text = io.BytesIO(robot.urdf.encode())
    file = yourdfpy.URDF.load(text, build_scene_graph=False, load_meshes=False).robot
    for joint in file.joints:
        joint.mimic = None
    for link in file.links:
        link.visuals = []
    return yourdfpy.URDF(file, load_meshes=False)


CASES = [
    *[(name, ()) for name in ARMS],
    ("panda", ("panda_link8", "panda_joint3", "panda_joint4")),  # which is not held at zero
    ("kinova", (None, "j2s6s200_joint_1", "j2s6s200_joint_4")),  # continuous
]


@pytest.mark.parametrize(("name", "words"), CASES)
def test_joints_limits_and_poses_of_all_links(name: str, words: tuple[str, ...]) -> None:
    tip, *locked = words or (None,)
    robot = d.load_robot(name, tip=tip, locked=locked)
    reader = reader_of(robot)
    movable = {joint.name for joint in reader.robot.joints if joint.type != "fixed"}
    assert movable == {*robot.joint_names, *robot.locked}
    assert set(locked) <= set(robot.locked)
    assert (robot.name, robot.tip) == (name, tip or ARMS[name].tips[0])
    whole = d.load_robot(name)
    known = dict(zip(whole.joint_names, whole.limits.T, strict=True))
    for i, joint in enumerate(robot.joint_names):
        np.testing.assert_array_equal(robot.limits[:, i], known[joint])
        limit = reader.joint_map[joint].limit or yourdfpy.Limit()
        lower = -np.inf if limit.lower == -1e308 else limit.lower
        upper = np.inf if limit.upper == 1e308 else limit.upper
        if (soft := reader.joint_map[joint].safety_controller) is not None:
            lower = max(lower, soft.soft_lower_limit)
            upper = min(upper, soft.soft_upper_limit)
        assert (robot.q_lower[i], robot.q_upper[i]) == (lower, upper)
        assert robot.dq_max[i] == (limit.velocity or np.inf)
        effort = limit.effort or 0.0
        if name in ("ur3", "ur10"):  # what the maker states, not the file
            effort = ARMS[name].effort[i]
        assert robot.model.effortLimit[i] == effort
    data = robot.model.createData()
    names = (*robot.joint_names, *robot.locked)
    for q in np.random.default_rng(0).uniform(-np.pi, np.pi, (5, robot.dof)):
        pin.framesForwardKinematics(robot.model, data, q)
        reader.update_cfg(dict(zip(names, (*q, *robot.q_locked), strict=True)))
        for link in reader.link_map:
            ours = data.oMf[robot.frame_id(link)].homogeneous
            theirs = reader.get_transform(link, reader.base_link)
            np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-9, err_msg=link)
    # What is held still unasked does not move the tip.
    reader.update_cfg(dict.fromkeys(set(robot.locked) - set(locked), 0.5))
    pose = data.oMf[robot.tip_id].homogeneous
    np.testing.assert_allclose(reader.get_transform(robot.tip, reader.base_link), pose, atol=1e-9)


@pytest.mark.parametrize("name", ["ur5", "xarm7"])
def test_meshes_are_where_yourdfpy_has_them(name: str) -> None:
    robot = d.load_robot(name)
    q = np.linspace(-1.0, 1.0, robot.dof)
    folder = str(robot.path.parents[3])
    other = yourdfpy.URDF.load(
        str(robot.path),
        filename_handler=lambda fname: fname.replace("package://example-robot-data", folder),
    )
    other.update_cfg(dict(zip(robot.joint_names, q, strict=True)))
    data = robot.model.createData()
    pin.forwardKinematics(robot.model, data, q)
    found = []
    for part, corners, _ in visual_meshes(robot):
        place = data.oMi[part.parentJoint]
        found += [*(corners @ place.rotation.T + place.translation)]
    bounds = [np.min(found, axis=0), np.max(found, axis=0)]
    np.testing.assert_allclose(bounds, other.scene.bounds, atol=1e-5)
