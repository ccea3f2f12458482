"""The torques of the kernel beside Pinocchio's, with payloads, rotors and gravity of all kinds."""

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose
from numpy.typing import ArrayLike

import iiwa_dnn as d
from iiwa_dnn.schemes.dynamics import dynamics_of, write_torques

CENTER = [0.02, -0.05, 0.1]
INERTIA = np.diag([0.01, 0.02, 0.015])


def carrying(robot: d.Robot, mass: float, center: ArrayLike = CENTER) -> pin.Model:
    """Pinocchio's model of a robot whose tip carries a mass, of 2 kg with INERTIA."""
    model = robot.model.copy()
    frame = model.frames[robot.tip_id]
    body = pin.Inertia(mass, np.array(center), 0.5 * mass * INERTIA)
    model.appendBodyToJoint(frame.parentJoint, body, frame.placement)
    return model


@pytest.mark.parametrize("name", ["panda", "tiago", "iiwa7_dual"])
def test_torques_are_pinocchios_for_any_payload(name: str) -> None:
    robot = d.load_robot(name).with_armature(0.1).with_gravity([3.0, -2.0, 9.0])
    robot = robot.with_payload((0.5, 2.0), CENTER, INERTIA)
    own = dynamics_of(robot)
    random = np.random.default_rng(0)
    for q in robot.draw(random, 20):
        v, a = random.standard_normal((2, robot.dof))
        torque, slope, doubt = np.empty((3, robot.dof))
        for gravity in (1.0, 0.0):
            write_torques(own, gravity, q, v, a, torque, slope, doubt)
            assert not doubt.any()
            for mass in (0.0, 1.3):
                model = carrying(robot, mass)
                model.gravity.linear *= gravity
                found = pin.rnea(model, model.createData(), q, v, a)
                assert_allclose(torque + mass * slope, found, atol=1e-12)


@pytest.mark.parametrize("name", ["panda", "tiago"])
def test_a_payload_anywhere_in_a_box_takes_no_more_than_the_bound(name: str) -> None:
    """And in one of its corners, where all signs agree, at least a part of it."""
    box = np.array([[-0.02, -0.05, 0.05], [0.04, 0.05, 0.15]])
    robot = d.load_robot(name).with_payload((0.5, 2.0), box, INERTIA)
    own = dynamics_of(robot)
    random = np.random.default_rng(0)
    used = []
    for q in robot.draw(random, 10):
        v, a = random.standard_normal((2, robot.dof))
        torque, slope, doubt = np.empty((3, robot.dof))
        write_torques(own, 1.0, q, v, a, torque, slope, doubt)
        corners = np.where(np.indices((2, 2, 2)).reshape(3, 8).T, box[1], box[0])
        found = []
        for center in (*corners, *random.uniform(*box, (20, 3))):
            model = carrying(robot, 2.0, center)
            found.append(pin.rnea(model, model.createData(), q, v, a) - torque - 2.0 * slope)
        apart = np.abs(found).max(axis=0)
        assert (apart <= 2.0 * doubt + 1e-12).all()
        used.append(apart[doubt > 1e-9] / (2.0 * doubt[doubt > 1e-9]))
    assert np.concatenate(used).max() > 0.95
    assert np.median(np.concatenate(used)) > 0.7


def test_a_payload_stays_in_its_frame_where_a_tool_becomes_the_tip() -> None:
    robot = d.load_robot("panda").with_payload(2.0, CENTER, INERTIA)
    tool = robot.with_tool([0.0, 0.1, 0.2, 0.3, 0.0, 0.0], tool_shapes=[])
    assert_allclose(dynamics_of(tool), dynamics_of(robot), atol=1e-15)
    assert robot.payload is not None
    assert robot.payload.settings()["mass"] == [2.0, 2.0]
    assert_allclose(robot.payload.inertia, INERTIA / 2.0)


@pytest.mark.parametrize(
    ("mass", "center", "inertia", "problem"),
    [
        ((2.0, 1.0), CENTER, None, "mass: must be a mass, or the ends"),
        (-1.0, CENTER, None, "mass: must be a mass"),
        ((1.0, 2.0, 3.0), CENTER, None, "mass: must have shape"),
        (1.0, [0.0, 0.1], None, "center: must have shape"),
        (1.0, [[0.1, 0.0, 0.0], [0.0, 0.1, 0.1]], None, "center: must be a point, or the ends"),
        (1.0, CENTER, np.diag([1.0, 1.0, 3.0]), "inertia: is none that a body can have"),
        (1.0, CENTER, np.triu(np.ones((3, 3))), "inertia: is none that a body can have"),
    ],
)
def test_a_payload_that_is_none_is_refused(
    mass: object, center: object, inertia: object, problem: str
) -> None:
    with pytest.raises(d.InvalidInputError, match=problem):
        d.load_robot("panda").with_payload(mass, center, inertia)  # type: ignore[arg-type]


def test_rotor_inertias_and_gravity_are_checked() -> None:
    robot = d.load_robot("panda")
    with pytest.raises(d.InvalidInputError, match="armature: must not be negative"):
        robot.with_armature(-0.1)
    with pytest.raises(d.InvalidInputError, match="gravity: must have shape"):
        robot.with_gravity(9.81)  # type: ignore[arg-type]
