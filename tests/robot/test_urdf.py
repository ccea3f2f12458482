"""robots/iiwa7/iiwa7.urdf against facts typed in here a second time and other implementations."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest
import yourdfpy

from helpers_kinematics import IIWA7_INERTIALS, PAPER_Q0, Array, dh_pose, rotation_angle
from iiwa_dnn.robot import Configuration, Robot, load_robot
from iiwa_dnn.robot.loading import package_robots

JOINTS = [f"iiwa7_joint_{i}" for i in range(1, 8)]
LINKS = [f"iiwa7_link_{i}" for i in range(8)]

# Capsules in base axes at q = 0: end points and radius.
CAPSULES = {
    1: ((0, 0, 0.195), (0, -0.041, 0.342), 0.080),
    2: ((0, 0.041, 0.339), (0, 0, 0.4835), 0.080),
    3: ((0, 0, 0.560), (0, 0.0395, 0.740), 0.080),
    4: ((0, -0.041, 0.739), (0, 0, 0.8835), 0.080),
    5: ((0, 0, 0.9435), (0, -0.041, 1.128), 0.072),
    6: ((0, 0, 1.125), (0, -0.0017, 1.161), 0.080),
}


@pytest.fixture(scope="module")
def robot() -> Robot:
    return load_robot("iiwa7")


@pytest.fixture(scope="module")
def urdf(robot: Robot) -> yourdfpy.URDF:
    return yourdfpy.URDF.load(str(robot.path), load_meshes=False)


@pytest.fixture(scope="module")
def poses(robot: Robot) -> Array:
    return np.random.default_rng(7).uniform(robot.q_lower, robot.q_upper, (300, 7))


def largest_gap(
    robot: Robot, poses: Array, position: Array, rotation: Array
) -> tuple[float, float]:
    """Largest distance [m] and angle [rad] between the robot's poses and others."""
    confs = [Configuration(robot, q) for q in poses]
    distances = np.linalg.norm([c.position for c in confs] - position, axis=-1)
    angles = rotation_angle([c.rotation for c in confs], rotation)
    return float(distances.max()), float(angles.max())


def test_forward_kinematics_equal_the_dh_formula(robot: Robot, poses: Array) -> None:
    distance, angle = largest_gap(robot, poses, *dh_pose(poses))
    assert distance < 1e-12
    assert angle < 1e-12


def test_check_pose(robot: Robot) -> None:
    conf = Configuration(robot, PAPER_Q0)
    rotation = [
        [0.685264, 0.717982, 0.122129],
        [0.702680, -0.695883, 0.148283],
        [0.191452, -0.015795, -0.981375],
    ]
    np.testing.assert_allclose(conf.position, [0.373145, 0.388717, 0.301206], rtol=0, atol=5.1e-7)
    np.testing.assert_allclose(conf.rotation, rotation, rtol=0, atol=5.1e-7)
    assert np.degrees(np.arccos(-conf.rotation[2, 2])) == pytest.approx(11.08, abs=0.005)


def test_upright_at_zero(robot: Robot) -> None:
    conf = Configuration(robot, np.zeros(7))
    np.testing.assert_allclose(conf.position, [0, 0, 1.266], rtol=0, atol=1e-15)
    np.testing.assert_array_equal(conf.rotation, np.eye(3))


def test_swapping_the_sign_of_joint_4_is_caught(robot: Robot, poses: Array, tmp_path: Path) -> None:
    # The slip to guard against: alternating alphas, with which the paper's start pose points up.
    up = dh_pose(PAPER_Q0, alpha=(-1, 1, -1, 1, -1, 1, 0))[1]
    assert up[2, 2] > 0.0 > Configuration(robot, PAPER_Q0).rotation[2, 2]

    text = Path(str(robot.path)).read_text(encoding="utf-8")
    assert text.count('<axis xyz="0 -1 0"/>') == 1
    swapped_file = tmp_path / "swapped.urdf"
    swapped_file.write_text(text.replace('"0 -1 0"', '"0 1 0"'), encoding="utf-8")
    distance, angle = largest_gap(load_robot(swapped_file), poses, *dh_pose(poses))
    assert distance > 0.5
    assert angle > 1.0


def test_limits_are_the_data_sheets(robot: Robot) -> None:
    position = np.radians([170, 120, 170, 120, 170, 120, 175])
    np.testing.assert_array_equal(robot.q_upper, position)
    np.testing.assert_array_equal(robot.q_lower, -position)
    np.testing.assert_array_equal(robot.dq_max, np.radians([98, 98, 100, 130, 140, 180, 180]))
    np.testing.assert_array_equal(robot.model.effortLimit, [176, 176, 110, 110, 110, 40, 40])


@pytest.mark.parametrize("i", range(8))
def test_inertias_are_the_estimates_and_possible(urdf: yourdfpy.URDF, i: int) -> None:
    mass, com, (ixx, iyy, izz), (ixz, iyz) = IIWA7_INERTIALS[i]
    inertial = urdf.link_map[LINKS[i]].inertial
    assert inertial.mass == mass
    np.testing.assert_array_equal(inertial.origin[:3, 3], com)
    np.testing.assert_array_equal(inertial.origin[:3, :3], np.eye(3))
    tensor = np.array([[ixx, 0, ixz], [0, iyy, iyz], [ixz, iyz, izz]])
    np.testing.assert_array_equal(inertial.inertia, tensor)
    # Positive definite, and no principal moment above the sum of the others (then some part of the
    # link would have negative mass).
    moments = np.linalg.eigvalsh(inertial.inertia)
    assert moments[0] > 0
    assert moments[2] < moments[0] + moments[1]


def test_total_mass(robot: Robot) -> None:
    total = sum(inertia.mass for inertia in robot.model.inertias)
    assert total == pytest.approx(23.9, abs=1e-3)  # the base included


@pytest.mark.parametrize("i", CAPSULES)
def test_capsule(urdf: yourdfpy.URDF, i: int) -> None:
    urdf.update_cfg(np.zeros(7))
    base = urdf.get_transform(LINKS[i], "iiwa7_link_0")
    start, end, radius = CAPSULES[i]
    cylinders, centres = [], []
    for collision in urdf.link_map[LINKS[i]].collisions:
        transform = base @ collision.origin
        if collision.geometry.cylinder:
            half = np.array([0, 0, collision.geometry.cylinder.length / 2, 0])
            cylinders.append([transform[:3, 3] + s * (transform @ half)[:3] for s in (-1, 1)])
            assert collision.geometry.cylinder.radius == radius
        else:
            assert collision.geometry.sphere.radius == radius
            centres.append(transform[:3, 3])
    np.testing.assert_allclose(cylinders, [[start, end]], rtol=0, atol=1e-8)
    np.testing.assert_allclose(centres, [start, end], rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("i", "radius", "low", "high"), [(0, 0.104, 0, 0.1575), (7, 0.052, 1.2205, 1.266)]
)
def test_end_cylinders(urdf: yourdfpy.URDF, i: int, radius: float, low: float, high: float) -> None:
    urdf.update_cfg(np.zeros(7))
    (collision,) = urdf.link_map[LINKS[i]].collisions
    centre = (urdf.get_transform(LINKS[i], "iiwa7_link_0") @ collision.origin)[:3, 3]
    cylinder = collision.geometry.cylinder
    assert cylinder.radius == radius
    assert centre[2] - cylinder.length / 2 == pytest.approx(low, abs=1e-12)
    assert centre[2] + cylinder.length / 2 == pytest.approx(high, abs=1e-12)


def test_robots_of_the_package_need_no_file_of_another_package() -> None:
    for name in package_robots():
        root = ET.fromstring(load_robot(name).urdf)
        assert root.get("name") == name
        assert root.findall(".//visual")
        assert root.findall(".//collision")
        assert not root.findall(".//mesh")
