"""A robot in MuJoCo, compiled from the project's own URDF.

MuJoCo reads the URDF by itself (its own parser and its own dynamics, independent of Pinocchio).
Facts that a URDF does not hold are added here: torque motors, joint damping, rotor inertia. Links
do not collide. MuJoCo is imported only when a model is built (extra ``sim``).

It draws by OpenGL without a display. On Linux that is the library which the environment variable
MUJOCO_GL names, by default EGL (a graphics card, or Mesa's software driver). Physics needs none.
"""

import importlib
import os
import sys
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from typing import Any

import coal
import numpy as np
import pinocchio as pin

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError, MissingDependencyError, import_extra
from iiwa_dnn.robot.robot import Robot
from iiwa_dnn.robot.shapes import source_of, tool_shapes

TIP_SITE = "tip"
"""Name of the site at the tip frame."""

VISUAL_GROUP = 1
"""Geometry group of the URDF's <visual> shapes, and of tools."""

_TOOL_COLOR = (0.55, 0.55, 0.58, 1.0)


@dataclass(frozen=True)
class JointDynamics:
    """Damping and rotor inertia of the drives. Both are ESTIMATES: the maker publishes neither.

    Attributes:
        damping: Viscous friction of every joint [N m s/rad]; drives of this class have about 0.5.
        armature: Rotor inertia of every joint, seen through its gear [kg m^2]. 0.1 is a rotor of
            1e-5 kg m^2 behind a gear of 100:1.
    """

    damping: float = 0.5
    armature: float = 0.1


def import_mujoco() -> Any:
    """Import MuJoCo's Python package; raises MissingDependencyError where it is not installed."""
    return import_extra("mujoco", "pip install 'iiwa-dnn[sim]'")


def prepare_renderer() -> None:
    """Make ``mujoco.Renderer`` draw without a display.

    Raises:
        MissingDependencyError: If MuJoCo is not there or, on Linux, an OpenGL library that opens a
            context; it names the Debian package.
    """
    renderer = importlib.import_module(import_mujoco().Renderer.__module__)
    if not sys.platform.startswith("linux"):
        return  # MuJoCo's own choice
    library = os.environ.get("MUJOCO_GL", "").lower() or "egl"
    try:
        context = importlib.import_module(f"mujoco.{library}").GLContext
        context(1, 1).free()
    except Exception as error:  # whatever PyOpenGL meets
        raise MissingDependencyError(
            f"OpenGL by {library}, without a display",
            "on Debian: apt-get install libegl1 libgl1 (or libosmesa6, and MUJOCO_GL=osmesa)",
        ) from error
    renderer.gl_context.GLContext = context


def torque_limits(robot: Robot) -> checks.Array:
    """Return the torque limits of the URDF [N m], (n,); inf where it gives none."""
    return np.where(robot.model.effortLimit > 0.0, robot.model.effortLimit, np.inf)


def build_spec(robot: Robot) -> Any:
    """Make MuJoCo's ``MjSpec`` of a robot: its URDF with a torque motor for each joint.

    Locked joints are welded. The mechanical stops are the URDF's: the robot's own position limits
    are a matter of the controller. Body 0 is the world; every link is a body of its own,
    ``TIP_SITE`` is at the tip, joints and motors stand in Pinocchio's order. Tools have no mass.

    Raises:
        MissingDependencyError: If MuJoCo is not installed.
        InvalidInputError: If the robot has no file, or MuJoCo orders its joints differently.
        ValueError: If MuJoCo refuses the URDF.
    """
    mj = import_mujoco()
    root = ET.fromstring(source_of(robot)[1])
    for link in root.findall("link"):
        frame = robot.model.frames[robot.frame_id(link.get("name", ""))]
        # Shapes out of other files; and inertias of the base, some no body's (TIAGo's antennas).
        needless = link.findall("*/geometry/mesh/../..")
        if frame.parentJoint == 0:
            needless += link.findall("inertial")
        for element in needless:
            link.remove(element)
    extension = ET.SubElement(root, "mujoco")
    # Not fused: links keep their names, and the base can be distinguished from the world.
    ET.SubElement(extension, "compiler", fusestatic="false", discardvisual="false")
    spec = mj.MjSpec.from_string(ET.tostring(root, encoding="unicode"))
    _weld(spec, robot)
    joints = {joint.name: joint for joint in spec.joints}
    if tuple(joints) != robot.joint_names:
        raise InvalidInputError("robot", "MuJoCo and Pinocchio order its joints differently", robot)
    for name, limit in zip(robot.joint_names, torque_limits(robot), strict=True):
        motor = spec.add_actuator(name=name, target=name, trntype=mj.mjtTrn.mjTRN_JOINT)
        if np.isfinite(limit):
            motor.forcerange = [-limit, limit]
    # The site of the tip hangs on the body of the joint that carries Pinocchio's frame.
    frame = robot.model.frames[robot.tip_id]
    carrier = joints[robot.model.names[frame.parentJoint]].parent
    turn = _quaternion(frame.placement)
    carrier.add_site(name=TIP_SITE, pos=frame.placement.translation, quat=turn)
    for tool in tool_shapes(robot):
        _add_tool(mj, joints[robot.model.names[tool.parentJoint]].parent, tool)
    return spec


def _add_tool(mj: Any, body: Any, tool: pin.GeometryObject) -> None:
    """Add a shape of a tool to the body that carries it, without mass or contacts."""
    shape = tool.geometry
    if isinstance(shape, coal.Box):
        kind = mj.mjtGeom.mjGEOM_BOX
        size = shape.halfSide
    else:
        round_kinds = (mj.mjtGeom.mjGEOM_SPHERE, mj.mjtGeom.mjGEOM_CAPSULE)
        kind = round_kinds[shape.halfLength > 0.0]
        size = np.array([shape.radius, shape.halfLength, 0.0])
    body.add_geom(
        name=tool.name,
        type=kind,
        size=size,
        pos=tool.placement.translation,
        quat=_quaternion(tool.placement),
        rgba=_TOOL_COLOR,
        group=VISUAL_GROUP,
        mass=0.0,
        contype=0,
        conaffinity=0,
    )


def _weld(spec: Any, robot: Robot) -> None:
    """Replace the locked joints of a robot, mimic joints among them, by fixed bodies."""
    for coupling in spec.equalities:
        spec.delete(coupling)
    for joint in spec.joints:
        if joint.name in robot.locked:
            body = joint.parent
            # In Pinocchio's model both links have become frames of one joint.
            ends = [robot.frame_id(each.name) for each in (body.parent, body)]
            before, after = (robot.model.frames[end].placement for end in ends)
            pose = before.actInv(after)
            body.pos = pose.translation
            body.quat = _quaternion(pose)
            spec.delete(joint)


def _quaternion(pose: pin.SE3) -> Any:
    """Return a pose's quaternion in MuJoCo's order."""
    return pin.Quaternion(pose.rotation).coeffs()[[3, 0, 1, 2]]


def compile_model(
    robot: Robot,
    timestep: float,
    dynamics: JointDynamics,
    friction: float | checks.Array = 0.0,
    mass_factors: float | checks.Array = 1.0,
) -> Any:
    """Compile MuJoCo's ``MjModel`` of a robot (`build_spec`) with an implicit method for damping.

    Contacts are off. A step lasts `timestep` [s]. Joints have the damping and the rotor inertia of
    `dynamics`, and Coulomb friction (n,) [N m]; masses and inertias of the links that each joint
    carries are multiplied by `mass_factors` (n,).

    Raises:
        MissingDependencyError: If MuJoCo is not installed.
        InvalidInputError: If the robot has no file, or MuJoCo refuses the URDF.
    """
    mj = import_mujoco()
    try:
        spec = build_spec(robot)
        spec.option.timestep = timestep
        spec.option.integrator = mj.mjtIntegrator.mjINT_IMPLICITFAST
        spec.option.disableflags = mj.mjtDisableBit.mjDSBL_CONTACT
        model = spec.compile()
    except ValueError as error:
        raise InvalidInputError("robot", f"MuJoCo refuses its URDF: {error}", robot) from error
    # On the model, not the joints of the specification: there, MuJoCo's type of it has changed.
    model.dof_damping[:] = dynamics.damping
    model.dof_armature[:] = dynamics.armature
    model.dof_frictionloss[:] = friction
    carried = np.flatnonzero(model.body_weldid)  # by the world: the base
    factors = mass_factors * np.ones(model.nv)
    factors = factors[model.body_dofadr[model.body_weldid[carried]]]
    model.body_mass[carried] *= factors
    model.body_inertia[carried] *= factors[:, None]
    mj.mj_setConst(model, mj.MjData(model))  # it derives more from masses and inertias
    return model
