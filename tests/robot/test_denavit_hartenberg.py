"""Robots from Denavit-Hartenberg tables, beside the product of the matrices and other sources."""

import numpy as np
import pytest

from helpers_kinematics import Array
from iiwa_dnn import Configuration, robot_from_dh

RNG = np.random.default_rng(5)
TABLE = RNG.uniform(-1.0, 1.0, (6, 4)) * [0.4, np.pi, 0.4, np.pi]
SLIDES = (3, 5)


def printed_product(q: Array, convention: str) -> Array:
    """Poses of the links (6, 4, 4) by the handbooks' matrices, entry by entry."""
    pose, poses = np.eye(4), []
    for i, (a, alpha, d, theta) in enumerate(TABLE):
        theta, d = (theta, d + q[i]) if i + 1 in SLIDES else (theta + q[i], d)
        c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
        standard = [[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d]]
        modified = [[c, -s, 0, a], [s * ca, c * ca, -sa, -d * sa], [s * sa, c * sa, ca, d * ca]]
        rows = standard if convention == "standard" else modified
        pose = pose @ np.vstack([rows, [0, 0, 0, 1]])
        poses.append(pose)
    return np.array(poses)


@pytest.mark.parametrize("convention", ["standard", "modified"])
def test_poses_are_the_product_of_the_printed_matrices(convention: str) -> None:
    robot = robot_from_dh(TABLE, convention=convention, prismatic=SLIDES)
    for q in RNG.uniform(-3.0, 3.0, (20, 6)):
        conf = Configuration(robot, q)
        poses = np.array([conf.frame(f"link_{i}").pose for i in range(1, 7)])
        np.testing.assert_allclose(poses, printed_product(q, convention), atol=1e-14)
        np.testing.assert_array_equal(conf.pose, poses[-1])


def test_limits_and_names() -> None:
    robot = robot_from_dh(TABLE, upper=[1, 2, 3, 4, 5, 6], velocity=0.5, name="six")
    assert (robot.name, robot.tip, robot.dof) == ("six", "link_6", 6)
    assert robot.frame_names[:2] == ("base", "link_1")
    assert robot.joint_names[-1] == "joint_6"
    np.testing.assert_array_equal(robot.limits[:3], [[-np.inf] * 6, [1, 2, 3, 4, 5, 6], [0.5] * 6])
