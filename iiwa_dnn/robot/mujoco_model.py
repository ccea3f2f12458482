"""A robot in MuJoCo, compiled from the project's own URDF.

MuJoCo reads the URDF by itself (its own parser and its own dynamics: an implementation independent
of Pinocchio). Facts that a URDF does not hold are added here: torque actuators with the data
sheet's limits, joint damping, rotor inertia, and the pairs of links that can collide.

MuJoCo is imported only when a model is built; it comes with the extra ``sim``.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.robot import urdf
from iiwa_dnn.robot.offscreen import import_mujoco
from iiwa_dnn.robot.robot import Robot

if TYPE_CHECKING:
    import mujoco

TIP_SITE = "tip"
"""Name of the MuJoCo site at the robot's tip frame."""

VISUAL_GROUP, COLLISION_GROUP = 1, 0
"""Geometry groups in which MuJoCo's URDF reader puts <visual> and <collision> shapes."""

# Links whose collision shapes can really meet (the others are neighbours, or stay apart by design
# although the capsules around them overlap). Robots that are not named here collide with nothing.
_COLLISION_PAIRS: dict[str, tuple[tuple[str, str], ...]] = {
    "iiwa7": (
        ("iiwa7_link_0", "iiwa7_link_5"),
        ("iiwa7_link_0", "iiwa7_link_6"),
        ("iiwa7_link_0", "iiwa7_link_7"),
    ),
}


@dataclass(frozen=True)
class JointDynamics:
    """Damping and rotor inertia of the drives. Both are ESTIMATES: the maker publishes neither.

    Attributes:
        damping: Viscous friction of every joint [N m s/rad]. 0.5 is the size of what is identified
            on geared drives of this class; at the heart's 0.2 rad/s it is 0.1 N m.
        armature: Rotor inertia of every joint, seen through its gear [kg m^2]. 0.1 is a rotor of
            1e-5 kg m^2 behind a gear of 100:1.
    """

    damping: float = 0.5
    armature: float = 0.1

    def __post_init__(self) -> None:
        """Check the numbers; raises InvalidInputError naming the one that is wrong."""
        checks.not_negative("damping", self.damping)
        checks.not_negative("armature", self.armature)


def torque_limits(robot: Robot) -> NDArray[np.float64]:
    """Return the torque limits of the URDF [N m], (n,); inf where it gives none."""
    effort = np.array(robot.model.effortLimit, dtype=np.float64)
    return np.where(effort > 0.0, effort, np.inf)


def build_spec(robot: Robot) -> mujoco.MjSpec:
    """Describe a robot to MuJoCo: its URDF, a torque motor on each joint, its collision pairs.

    Args:
        robot: The robot, from a URDF file; its locked joints are welded. Its own position limits
            are a matter of the controller; the mechanical stops here are the URDF's.

    Returns:
        A specification that can still be added to, ready to be compiled. Body 0 is the world;
        every link is a body of its own, ``TIP_SITE`` is at the tip, joints and motors stand in the
        order of Pinocchio's.

    Raises:
        MissingDependencyError: If MuJoCo is not installed.
        InvalidInputError: If the robot has no file, or MuJoCo refuses the URDF.
        FileError: If the file cannot be read any more.
    """
    mj = import_mujoco()
    if robot.path is None:
        raise InvalidInputError("robot", "must come from a URDF file", robot)
    root = urdf.read(robot.path)
    urdf.weld(root, dict(zip(robot.locked, robot.q_locked, strict=True)))
    urdf.drop_meshes(root)
    extension = ET.SubElement(root, "mujoco")
    # Not fused: links keep their names, and the base can be told from the world.
    ET.SubElement(extension, "compiler", fusestatic="false", discardvisual="false")
    try:
        spec = mj.MjSpec.from_string(urdf.text_of(root))
    except ValueError as error:
        raise InvalidInputError("robot", f"MuJoCo refuses its URDF: {error}", robot) from error
    joints = {joint.name: joint for joint in spec.joints}
    if tuple(joints) != robot.joint_names:
        raise InvalidInputError("robot", "MuJoCo and Pinocchio order its joints differently", robot)
    for name, limit in zip(robot.joint_names, torque_limits(robot), strict=True):
        motor = spec.add_actuator(name=name, target=name, trntype=mj.mjtTrn.mjTRN_JOINT)
        if np.isfinite(limit):
            motor.ctrllimited, motor.ctrlrange = True, [-limit, limit]
            motor.forcelimited, motor.forcerange = True, [-limit, limit]
    # The site of the tip hangs on the body of the joint that carries Pinocchio's frame.
    frame = robot.model.frames[robot.tip_id]
    x, y, z, w = pin.Quaternion(frame.placement.rotation).coeffs()
    carrier = joints[robot.model.names[frame.parentJoint]].parent
    carrier.add_site(name=TIP_SITE, pos=frame.placement.translation, quat=[w, x, y, z])
    allowed = {frozenset(pair) for pair in _COLLISION_PAIRS.get(robot.name, ())}
    bodies = [body.name for body in spec.bodies[1:]]
    for first, second in combinations(bodies, 2):
        if frozenset((first, second)) not in allowed:
            spec.add_exclude(bodyname1=first, bodyname2=second)
    return spec


def compile_model(
    robot: Robot,
    timestep: float,
    dynamics: JointDynamics | None = None,
    friction: NDArray[np.float64] | None = None,
    mass_factors: NDArray[np.float64] | None = None,
) -> mujoco.MjModel:
    """Compile a robot for simulation.

    Args:
        robot: The robot, see `build_spec`.
        timestep: Physics step [s].
        dynamics: Damping and rotor inertia of the drives; None takes the estimates.
        friction: Coulomb friction of the joints [N m], (n,); None for none.
        mass_factors: Factors on the masses and inertias of the moving links, (n,), in the order of
            the joints that carry them; None for one.

    Returns:
        The model, integrated by MuJoCo's implicit method for the damping.

    Raises:
        MissingDependencyError, InvalidInputError, FileError: As `build_spec` does.
    """
    mj = import_mujoco()
    dynamics = JointDynamics() if dynamics is None else dynamics
    spec = build_spec(robot)
    spec.option.timestep = timestep
    spec.option.integrator = mj.mjtIntegrator.mjINT_IMPLICITFAST
    try:
        model = spec.compile()
    except ValueError as error:  # a moving link without mass, for example
        raise InvalidInputError("robot", f"MuJoCo refuses its URDF: {error}", robot) from error
    # On the model, not the joints of the specification: there, MuJoCo's type of it has changed.
    model.dof_damping[:] = dynamics.damping
    model.dof_armature[:] = dynamics.armature
    if friction is not None:
        model.dof_frictionloss[:] = friction
    if mass_factors is not None:
        for body in range(1, model.nbody):
            carrier = model.body_weldid[body]  # the body itself, where it has a joint
            if carrier:
                factor = mass_factors[model.body_dofadr[carrier]]
                model.body_mass[body] *= factor
                model.body_inertia[body] *= factor
    mj.mj_setConst(model, mj.MjData(model))  # it derives more from masses and inertias
    return model
