"""Configurations: Jacobians and inertia against independent computations, and immutability."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
import yourdfpy
from numpy.typing import ArrayLike

from helpers_kinematics import (
    IIWA7_INERTIALS,
    Array,
    dh_pose,
    example_urdf,
    finite_difference,
    pose_jacobian,
)
from iiwa_dnn.errors import InvalidInputError, NotFoundError
from iiwa_dnn.robot import Configuration, Robot, load_robot

OFFSETS = (0.1475, 0.1925, 0.2075, 0.1925, 0.2075, 0.1925, 0.0910)
AXES = ((0, 0, 1), (0, 1, 0), (0, 0, 1), (0, -1, 0), (0, 0, 1), (0, 1, 0), (0, 0, 1))


def panda() -> Robot:
    path = example_urdf("panda_description/urdf/panda.urdf")
    return load_robot(path, "panda_hand_tcp", ("panda_finger_joint1", "panda_finger_joint2"))


@pytest.fixture(scope="module")
def iiwa7() -> Robot:
    return load_robot("iiwa7")


@pytest.fixture
def q() -> Array:
    return np.random.default_rng(11).uniform(-1.5, 1.5, 7)


@pytest.mark.parametrize("load", [lambda: load_robot("iiwa7"), panda], ids=["iiwa7", "panda"])
def test_jacobian_by_finite_differences(load) -> None:
    robot = load()
    data = robot.model.createData()

    def pose(x: Array) -> tuple[Array, Array]:
        conf = Configuration(robot, x, data)
        return conf.position, conf.rotation

    for x in np.random.default_rng(1).uniform(robot.q_lower, robot.q_upper, (50, robot.dof)):
        jacobian = Configuration(robot, x, data).jacobian
        assert jacobian.shape == (6, robot.dof)
        np.testing.assert_allclose(jacobian, pose_jacobian(pose, x), rtol=0, atol=1e-6)


@pytest.mark.parametrize("load", [lambda: load_robot("iiwa7"), panda], ids=["iiwa7", "panda"])
def test_any_frame_by_finite_differences_and_by_a_second_reader(load) -> None:
    robot = load()
    file = yourdfpy.URDF.load(str(robot.path), load_meshes=False)
    q = np.random.default_rng(5).uniform(robot.q_lower, robot.q_upper)
    conf = Configuration(robot, q, robot.model.createData())
    file.update_cfg(dict(zip(robot.joint_names, q, strict=True)))
    for name in robot.frame_names:
        frame = conf.frame(name)
        assert (frame.position.shape, frame.rotation.shape) == ((3,), (3, 3))
        assert frame.jacobian.shape == (6, robot.dof)

        def pose(x: Array, name: str = name) -> tuple[Array, Array]:
            frame = Configuration(robot, x).frame(name)
            return frame.position, frame.rotation

        np.testing.assert_allclose(frame.jacobian, pose_jacobian(pose, q), rtol=0, atol=1e-6)
        if name in file.link_map:
            expected = file.get_transform(name, file.base_link)
            np.testing.assert_allclose(frame.pose, expected, rtol=0, atol=1e-9)
    for name in ("pose", "position", "rotation", "jacobian"):
        array = getattr(conf.frame(robot.tip), name)
        np.testing.assert_array_equal(array, getattr(conf, name))
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0.0


def test_arrays_of_a_single_joint_have_two_axes(iiwa7: Robot) -> None:
    robot = load_robot("iiwa7", locked=iiwa7.joint_names[:-1])
    conf = Configuration(robot, [0.4])
    expected = [[0.0], [0.0], [0.0], [0.0], [0.0], [1.0]]
    for jacobian in (conf.jacobian, conf.frame("iiwa7_link_7").jacobian):
        np.testing.assert_allclose(jacobian, expected, atol=1e-15)
    assert not conf.frame("iiwa7_link_6").jacobian.any()
    assert conf.inertia.shape == (1, 1)


def test_a_frame_stays_valid_and_leaves_the_tip_alone(iiwa7: Robot, q: Array) -> None:
    data = iiwa7.model.createData()
    conf = Configuration(iiwa7, q, data)
    elbow = conf.frame("iiwa7_link_4")
    other = Configuration(iiwa7, q[::-1], data)
    fresh = Configuration(iiwa7, q)
    np.testing.assert_array_equal(conf.pose, fresh.pose)
    np.testing.assert_array_equal(elbow.pose, fresh.frame("iiwa7_link_4").pose)
    assert not np.array_equal(elbow.jacobian, other.frame("iiwa7_link_4").jacobian)
    assert not elbow.jacobian[:, 4:].any()  # joints further out do not move it


def test_an_unknown_frame_names_those_near_to_it(iiwa7: Robot, q: Array) -> None:
    with pytest.raises(NotFoundError, match="no frame 'iiwa7_link4'; did you mean: iiwa7_link_"):
        Configuration(iiwa7, q).frame("iiwa7_link4")


def test_jacobian_of_the_dh_formula(iiwa7: Robot, q: Array) -> None:
    expected = pose_jacobian(dh_pose, q)
    np.testing.assert_allclose(Configuration(iiwa7, q).jacobian, expected, rtol=0, atol=1e-6)


def link_pose(q: Array, i: int) -> tuple[Array, Array]:
    """Pose of the centre of mass of link i, from the table of offsets and axes alone."""
    position, rotation = np.zeros(3), np.eye(3)
    for angle, offset, axis in zip(q[:i], OFFSETS, AXES, strict=False):
        position = position + rotation @ [0.0, 0.0, offset]
        x, y, z = axis
        k = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        rotation = rotation @ (np.eye(3) + np.sin(angle) * k + (1.0 - np.cos(angle)) * k @ k)
    return position + rotation @ IIWA7_INERTIALS[i][1], rotation


def test_inertia_is_the_sum_over_the_links(iiwa7: Robot) -> None:
    # Kinetic energy, link by link: m v'v / 2 + w' I w / 2, with v and w by finite differences.
    for x in np.random.default_rng(2).uniform(iiwa7.q_lower, iiwa7.q_upper, (5, 7)):
        expected = np.zeros((7, 7))
        for i, (mass, _, (ixx, iyy, izz), (ixz, iyz)) in enumerate(IIWA7_INERTIALS):
            tensor = np.array([[ixx, 0, ixz], [0, iyy, iyz], [ixz, iyz, izz]])
            jacobian = pose_jacobian(lambda y, i=i: link_pose(y, i), x)
            spin = link_pose(x, i)[1].T @ jacobian[3:]
            expected += mass * jacobian[:3].T @ jacobian[:3] + spin.T @ tensor @ spin
        inertia = Configuration(iiwa7, x).inertia
        np.testing.assert_allclose(inertia, expected, rtol=0, atol=1e-8)
        np.testing.assert_array_equal(inertia, inertia.T)
        assert np.linalg.eigvalsh(inertia)[0] > 0


def test_inertia_does_not_depend_on_the_first_joint(iiwa7: Robot, q: Array) -> None:
    slope = finite_difference(lambda x: Configuration(iiwa7, x).inertia, q)
    assert np.abs(slope[..., 0]).max() < 1e-8
    assert np.abs(slope[..., 1]).max() > 1e-2


def test_stays_valid_when_q_and_the_scratch_memory_change(iiwa7: Robot, q: Array) -> None:
    data = iiwa7.model.createData()
    given = q.copy()
    conf = Configuration(iiwa7, given, data)
    given[:] = 0.0
    other = Configuration(iiwa7, q[::-1], data)
    fresh = Configuration(iiwa7, q)
    assert other.inertia[0, 0] != fresh.inertia[0, 0]
    for name in ("q", "position", "rotation", "jacobian", "inertia"):
        np.testing.assert_array_equal(getattr(conf, name), getattr(fresh, name))
        assert not np.shares_memory(getattr(conf, name), getattr(other, name))
    Configuration(iiwa7, np.zeros(7), data).inertia.sum()
    np.testing.assert_array_equal(conf.inertia, fresh.inertia)


def test_immutable(iiwa7: Robot, q: Array) -> None:
    conf = Configuration(iiwa7, q)
    for name in ("q", "position", "rotation", "jacobian", "inertia"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(conf, name)[0] = 0.0
        with pytest.raises(AttributeError):
            setattr(conf, name, None)
    with pytest.raises(AttributeError):
        conf.extra = 1


@pytest.mark.parametrize(
    "bad",
    [
        np.zeros(6),
        np.zeros((7, 1)),
        0.0,
        [0, 0, 0, 0, 0, 0, np.nan],
        [np.inf, 0, 0, 0, 0, 0, 0],
        [np.inf, -np.inf, 0, 0, 0, 0, 0],
        ["a"] * 7,
        None,
    ],
)
def test_bad_q(iiwa7: Robot, bad: ArrayLike) -> None:
    with pytest.raises(InvalidInputError) as caught:
        Configuration(iiwa7, bad)
    assert caught.value.argument == "q"


def test_any_finite_q_is_accepted(iiwa7: Robot) -> None:
    assert Configuration(iiwa7, np.full(7, 3.5)).q[0] > iiwa7.q_upper[0]
    assert np.isfinite(Configuration(iiwa7, np.full(7, 1e308)).position).all()  # its sum is inf


def test_repr_and_pickling(iiwa7: Robot, q: Array) -> None:
    conf = Configuration(iiwa7, q, iiwa7.model.createData())
    copy = pickle.loads(pickle.dumps(conf))
    np.testing.assert_array_equal(copy.jacobian, conf.jacobian)
    assert repr(copy) == repr(conf)
    assert repr(conf).startswith(f"<Configuration of iiwa7: q = [{q[0]:.4f}")
