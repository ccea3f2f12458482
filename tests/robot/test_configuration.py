"""Configurations: Jacobians and inertia against independent computations, and immutability."""

import pickle

import numpy as np
import pytest

from helpers_kinematics import IIWA7_INERTIALS, Array, example_urdf, pose_jacobian
from iiwa_dnn.robot import Configuration, Robot, load_robot
from iiwa_dnn.robot.arms import ARMS


@pytest.fixture(scope="module")
def iiwa7() -> Robot:
    return load_robot("iiwa7")


@pytest.fixture
def q() -> Array:
    return np.random.default_rng(11).uniform(-1.5, 1.5, 7)


@pytest.mark.parametrize("name", ["iiwa7", "panda", "tiago"])
def test_the_jacobian_of_any_frame_is_the_derivative_of_its_pose(name: str) -> None:
    if not name.startswith("iiwa7"):
        example_urdf(ARMS[name].file)
    robot = load_robot(name)
    random = np.random.default_rng(5)
    for frame in (*robot.frame_names[::3], robot.tip):
        q = random.uniform(robot.q_lower.clip(-3), robot.q_upper.clip(max=3))

        def pose(x: Array, frame: str = frame) -> tuple[Array, Array]:
            found = Configuration(robot, x).frame(frame)
            return found.position, found.rotation

        found = Configuration(robot, q).frame(frame)
        np.testing.assert_allclose(found.jacobian, pose_jacobian(pose, q), rtol=0, atol=1e-6)
        assert found.jacobian.shape == (6, robot.dof)
        moved = robot.support[robot.frame_id(frame)]
        np.testing.assert_array_equal(moved, np.any(found.jacobian != 0.0, axis=0))
    conf = Configuration(robot, q)
    np.testing.assert_array_equal(conf.pose, found.pose)
    np.testing.assert_array_equal(conf.jacobian, found.jacobian)


def test_the_urdf_has_the_masses_and_inertias_that_are_documented(iiwa7: Robot) -> None:
    # MuJoCo judges what Pinocchio makes of them (test_mujoco_model.py).
    for body, facts in zip(list(iiwa7.model.inertias)[1:], IIWA7_INERTIALS[1:-1], strict=False):
        mass, lever, (ixx, iyy, izz), (ixz, iyz) = facts
        assert body.mass == mass
        np.testing.assert_allclose(body.lever, lever, atol=1e-12)
        np.testing.assert_allclose(
            body.inertia, [[ixx, 0, ixz], [0, iyy, iyz], [ixz, iyz, izz]], rtol=0, atol=1e-9
        )


def test_it_stays_as_it_is(iiwa7: Robot, q: Array) -> None:
    given = q.copy()
    conf = Configuration(iiwa7, given)
    given[:] = 0.0
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(conf)).jacobian, conf.jacobian)
    np.testing.assert_array_equal(conf.q, q)
    np.testing.assert_array_equal(conf.inertia, Configuration(iiwa7, q).inertia)
    for name in ("q", "position", "rotation", "jacobian", "inertia"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(conf, name)[0] = 0.0
        with pytest.raises(AttributeError):
            setattr(conf, name, None)
    with pytest.raises(AttributeError):
        conf.extra = 1


def test_a_name_that_is_none_is_answered_with_those_that_are(iiwa7: Robot, q: Array) -> None:
    conf = Configuration(iiwa7, q)
    with pytest.raises(AttributeError, match=r"no Configuration attribute 'nearest'; .* jacobian"):
        _ = conf.nearest  # type: ignore[attr-defined]
    with pytest.raises(AttributeError, match="did you mean: position"):
        _ = conf.postion  # type: ignore[attr-defined]
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(conf)).q, q)


def test_it_says_what_it_holds(iiwa7: Robot) -> None:
    shown = repr(Configuration(iiwa7, np.zeros(7)))  # stretched upwards: 0.34 + 0.4 + 0.4 + 0.126
    tip = "iiwa7_flange at [0.0, 0.0, 1.266] m"
    assert shown == f"Configuration(iiwa7, q={[0.0] * 7} rad, {tip})"


def test_positions_in_degrees_are_asked_about(iiwa7: Robot) -> None:
    home = iiwa7.start_posture()
    assert iiwa7.outside(np.degrees(home)).endswith("are the positions in degrees?")
    assert iiwa7.outside(home + 3.0).endswith("joint 2 is at 2.453")
    assert iiwa7.outside(home) == ""
