"""The torques of the kernel beside Pinocchio's, with payloads, rotors and gravity of all kinds."""

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

import iiwa_dnn as d
from iiwa_dnn.schemes.dynamics import dynamics_of, write_torques

CENTER = [0.02, -0.05, 0.1]
INERTIA = np.diag([0.01, 0.02, 0.015])


def carrying(robot: d.Robot, mass: float) -> pin.Model:
    """Pinocchio's model of a robot whose tip carries a mass, of 2 kg with INERTIA."""
    model = robot.model.copy()
    frame = model.frames[robot.tip_id]
    body = pin.Inertia(mass, np.array(CENTER), 0.5 * mass * INERTIA)
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
        torque, slope = np.empty((2, robot.dof))
        for gravity in (1.0, 0.0):
            write_torques(own, gravity, q, v, a, torque, slope)
            for mass in (0.0, 1.3):
                model = carrying(robot, mass)
                model.gravity.linear *= gravity
                found = pin.rnea(model, model.createData(), q, v, a)
                assert_allclose(torque + mass * slope, found, atol=1e-12)


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
