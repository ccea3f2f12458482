"""Loading of robots by name, from a URDF file or from a Pinocchio model: joints locked, limits."""

import contextlib
import os
import warnings
import xml.etree.ElementTree as ET
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.checks import Array
from iiwa_dnn.errors import (
    FileError,
    InvalidInputError,
    MissingDependencyError,
    NotFoundError,
    warn_caller,
)
from iiwa_dnn.robot.arms import ARMS, robots_folder
from iiwa_dnn.robot.mjcf import read_mjcf
from iiwa_dnn.robot.robot import Robot, frame_id, model_limits
from iiwa_dnn.robot.tools import ToolShapes
from iiwa_dnn.robot.urdf import build_model, number_of, read_urdf

_LARGE = 40.0
"""Position or velocity limit beyond which a file looks as if it were in degrees, or in mm."""


def available_robots() -> tuple[str, ...]:
    """List the names in `ARMS` whose URDF files are installed."""
    with contextlib.suppress(MissingDependencyError):
        return tuple(name for name, arm in ARMS.items() if arm.path.is_file())
    return tuple(name for name, arm in ARMS.items() if (robots_folder() / arm.file).is_file())


def load_robot(
    source: str | os.PathLike[str] | pin.Model,
    tip: str | None = None,
    locked: str | Iterable[str] = (),
    tool: pin.SE3 | ArrayLike | None = None,
    frames: str | Iterable[str] = (),
    tool_shapes: ToolShapes = None,
) -> Robot:
    """Load a robot by its name, from a URDF or an MJCF file or from a Pinocchio model.

    Limits are the source's, but for those of `iiwa_dnn.robot.arms`. A velocity, acceleration or
    jerk limit that is 0 or missing is none.
    Joints that move neither the tip nor one of `frames` are locked; unless the robot is one of a
    known name, a warning says which.

    Args:
        source: A name out of `available_robots`, the path of a URDF or, in ``.xml``, of an MJCF (a
            `Path`, or a string that ends so or has a separator in it), or a Pinocchio model, which
            has no shapes, collisions and physics.
        tip: Frame that follows references. Default: that of the name (`iiwa_dnn.robot.arms`), or
            the link at the end of the chain, for a robot that has only one end.
        locked: Names of joints to freeze, each at its zero position or at the limit nearest to it.
        tool: Pose of a tool in the frame `tip`, whose place it takes (`Robot.with_tool`): an SE3,
            or x, y, z [m], roll, pitch, yaw [rad], (6,).
        frames: Further frames that tasks track, such as a second arm's tip: joints that move one
            of them stay free.
        tool_shapes: Shapes of the tool in the frame `tip`, as `Robot.with_tool` takes them.

    Raises:
        NotFoundError: If there is no such robot, frame or joint; the error lists those that exist.
        FileError: If the file cannot be read, is no URDF or MJCF, or its limits make no sense.
        InvalidInputError: If the robot has several ends and no ``tip`` is given, names are none, or
            a joint that is left free has no axis, more or less than one coordinate, or follows
            another.
        MissingDependencyError: If the arm of that name is in a package that is not installed, or
            the file is an MJCF, and MuJoCo is not.
    """
    path, tips = _find(source)
    root = ET.Element("robot") if path is None else _read(path)
    text = ET.tostring(root, encoding="unicode")  # of the tree that was checked
    built: Any = (source, []) if path is None else build_model(path, root, text)
    full, left_out = built
    # By the name it was asked for: the URDFs call some of these arms otherwise.
    name = str(source) if tips else full.name
    if tip is None:
        tip = _first_tip(full, tips)
    others = tips if len(tips) > 1 else ()
    idle = _idle_joints(full, (tip, *others, *checks.names("frames", frames)))
    chosen = checks.names("locked", locked)
    model, held = _lock(full, dict.fromkeys([*idle, *chosen]))
    arm = ARMS.get(name)
    rates = _of_joints(full, tips or (tip,), arm.rates if arm else ())
    limits, position_dependent_velocity = _limits(path, model, root, rates)
    if arm:
        _state_efforts(model, full, tips, arm.effort)
    robot = Robot(
        name,
        model,
        tip,
        limits,
        position_dependent_velocity,
        tuple(held),
        tuple(held.values()),
        path,
        text,
    )
    expected = {*chosen, *(_idle_joints(full, tips) if tips else ())}
    still = {joint: at for joint, at in held.items() if joint not in expected}
    for message in _load_warnings(robot, still, left_out):
        warnings.warn(message, stacklevel=2)
    return _hold(robot, tool, tool_shapes)


def _first_tip(model: pin.Model, tips: Sequence[str]) -> str:
    """Return the first tip of a known arm, or the link at the only end of another."""
    return tips[0] if tips else _only_end(model)


def _state_efforts(
    model: pin.Model, full: pin.Model, tips: Sequence[str], efforts: Sequence[float]
) -> None:
    """Write the torque limits [N m] of a known arm's joints before its tips into a model.

    `full` is the model before joints were locked. An arm without tips is another one.
    """
    for joint, (effort,) in _of_joints(full, tips, (efforts,)).items() if tips else ():
        if model.existJointName(joint):
            model.effortLimit[model.joints[model.getJointId(joint)].idx_v] = effort


def _read(path: Path) -> ET.Element:
    """Read a file of a robot as the URDF of it."""
    return read_mjcf(path) if path.suffix == ".xml" else read_urdf(path)


def _hold(robot: Robot, tool: pin.SE3 | ArrayLike | None, shapes: ToolShapes) -> Robot:
    """Return a robot with its tool, if it has one; refuse shapes of none."""
    if tool is not None:
        return robot.with_tool(tool, tool_shapes=shapes)
    if shapes is not None:
        raise InvalidInputError("tool_shapes", "are a tool's: tool= says where its tip is", shapes)
    return robot


def _load_warnings(robot: Robot, still: dict[str, float], left_out: list[str]) -> Iterator[str]:
    """Warn of parts that are left out, a limit in another unit, and joints locked unasked."""
    if left_out:
        more = [f"{len(left_out) - 2} more"] if len(left_out) > 2 else []
        yield f"{robot.path}: left out by Pinocchio: {'; '.join(left_out[:2] + more)}"
    limits = robot.limits[:3]
    large = np.where(np.isfinite(limits), np.abs(limits), 0.0).max(axis=0)
    if large.max() > _LARGE:
        joint = large.argmax()
        units = ("mm", "m and m/s") if joint in robot.slides else ("degrees", "rad and rad/s")
        yield (
            f"joint {robot.joint_names[joint]!r} has a limit of {large.max():.4g}: is it in "
            f"{units[0]}? A URDF counts in {units[1]}"
        )
    if still:
        joints = ", ".join(f"{joint} at {at:g}" for joint, at in still.items())
        yield f"held still, since they do not move {robot.tip}: {joints}"


def _find(source: Any) -> tuple[Path | None, tuple[str, ...]]:
    """Find the file of a robot; return it with the tips of its arms if it is known by name."""
    if isinstance(source, pin.Model):
        return None, ()
    if not isinstance(source, str | os.PathLike):
        raise InvalidInputError("source", "must be a name, a file or a pinocchio.Model", source)
    name = os.fspath(source)
    is_file = isinstance(source, os.PathLike) or name.endswith((".urdf", ".xacro", ".xml"))
    if is_file or os.sep in name:
        return Path(name), ()
    if name not in ARMS:
        raise NotFoundError("robot", name, ARMS)
    return ARMS[name].path, ARMS[name].tips


def _only_end(model: pin.Model) -> str:
    """Name the link at the end of the chain, if there is only one."""
    parents = {frame.parentFrame for frame in model.frames}
    ends = [
        frame.name
        for i, frame in enumerate(model.frames)
        if frame.type == pin.FrameType.BODY and i not in parents
    ]
    if len(ends) != 1:
        raise InvalidInputError("tip", f"is needed: the robot has several ends: {', '.join(ends)}")
    return str(ends[0])


def _idle_joints(model: pin.Model, frames: Iterable[str]) -> list[str]:
    """List the joints that move none of the frames."""
    carriers = [model.frames[frame_id(model, frame)].parentJoint for frame in frames]
    moving = {model.names[joint] for carrier in carriers for joint in model.supports[carrier]}
    return [str(name) for name in model.names if name not in moving]


def _lock(model: pin.Model, locked: Collection[str]) -> tuple[pin.Model, dict[str, float]]:
    """Freeze joints at zero or the limit nearest to it; return model and positions [rad]."""
    # A zero position can lie outside the limits (the panda's joint 4): then the nearest limit.
    posture = np.clip(pin.neutral(model), model.lowerPositionLimit, model.upperPositionLimit)
    joints = {name: i for i, name in enumerate(model.names) if i > 0}
    for name in locked:
        if name not in joints:
            raise NotFoundError("joint", name, joints)
    frozen = [joints[name] for name in locked]
    # Planar and floating joints are at zero.
    held = [float(posture[model.idx_qs[i]]) if model.nqs[i] == 1 else 0.0 for i in frozen]
    reduced = _reduce(model, frozen, posture) if frozen else model
    for joint, *sizes in zip(reduced.names, reduced.nqs, reduced.nvs, strict=True):
        if max(sizes) > 1:
            problem = f"joint {joint!r} has {sizes[0]} coordinates, not 1: lock it"
            raise InvalidInputError("locked", problem, joint)
    return reduced, dict(zip(locked, held, strict=True))


def _reduce(model: pin.Model, frozen: list[int], posture: Array) -> pin.Model:
    """Build the model with some joints frozen at a posture.

    Names are made unique meanwhile: in a URDF a link and a joint may share one.
    """
    model = model.copy()
    for frame in list(model.frames)[1:]:
        if frame.type != pin.FrameType.JOINT:  # Pinocchio looks frames up by their names alone
            frame.name = f"{frame.type}\n{frame.name}"
    reduced = pin.buildReducedModel(model, frozen, posture)
    for frame in reduced.frames:
        frame.name = frame.name.rpartition("\n")[2]
    return reduced


def _of_joints(
    model: pin.Model, tips: Iterable[str], rows: Sequence[Sequence[float]]
) -> dict[str, tuple[float, ...]]:
    """Return numbers of a known arm, (k, n), by the names of its n joints before a tip.

    An arm of the same name that has more or fewer joints is another one.
    """
    idle = _idle_joints(model, tips)
    joints = [joint for joint in tuple(model.names)[1:] if joint not in idle]
    columns = list(zip(*rows, strict=True))
    return dict(zip(joints, columns, strict=True)) if len(columns) == len(joints) else {}


def _soft_limits(
    path: Path | None, joint: ET.Element, lower: float, upper: float
) -> tuple[float, float]:
    """Return the position limits [rad] within which a joint's ``<safety_controller>`` keeps it.

    They are `lower` and `upper`, or its soft limits where these are inside; a continuous joint has
    none. Two equal soft limits are not given; of others that leave nothing of the range, a warning
    tells.
    """
    controller = joint.find("safety_controller")
    if controller is None or lower == -np.inf:
        return lower, upper
    soft = [float(controller.get(f"soft_{side}_limit", 0.0)) for side in ("lower", "upper")]
    inside = (max(lower, soft[0]), min(upper, soft[1]))
    if inside[0] < inside[1]:
        return inside
    if soft[0] != soft[1]:
        warn_caller(
            f"{path}: the soft limits of joint {joint.get('name')!r}, {soft[0]:g} to {soft[1]:g}, "
            f"leave nothing of {lower:g} to {upper:g}, which hold"
        )
    return lower, upper


def _limits(
    path: Path | None,
    model: pin.Model,
    root: ET.Element,
    rates: Mapping[str, tuple[float, ...]],
) -> tuple[Array, Array]:
    """Return `Robot.limits`, (5, n), and `Robot.position_dependent_velocity`, (2, n).

    Raises:
        InvalidInputError: A joint follows another one, or has no axis.
        FileError: A joint of the file at `path` has no range.
    """
    joints = {joint.get("name"): joint for joint in root.findall("joint")}
    limits = np.full((5, model.nv), np.inf)
    position_dependent_velocity = np.array([[0.0], [np.inf]]) * np.ones(model.nv)
    limits[:3] = model_limits(model)
    jacobian = pin.computeJointJacobians(model, model.createData(), pin.neutral(model))
    twists = jacobian.reshape(6, -1)  # (6,) for a single joint
    for i, name in enumerate(tuple(model.names)[1:]):
        joint = joints.get(name, root)
        mimic = joint.find("mimic")
        if mimic is not None:
            raise InvalidInputError(
                "locked",
                f"joint {name!r} follows {mimic.get('joint')!r}: lock it, or take its <mimic> out "
                "of the file and hold it by a JointCouplingTask",
                name,
            )
        if path is not None and limits[0, i] == limits[1, i] == 0.0:
            raise FileError(
                path, f"gives no range for joint {name!r}: lower and upper are 0 or missing"
            )
        if not twists[:, i].any():
            raise InvalidInputError("source", f"the axis of joint {name!r} is zero", name)
        limits[:2, i] = _soft_limits(path, joint, *limits[:2, i])
        limits[3:, i] = rates.get(name, np.inf)
        further = (
            ("limit", ("acceleration", "jerk"), limits[3:]),
            (
                "position_based_velocity_limits",
                ("velocity_offset", "deceleration_limit"),
                position_dependent_velocity,
            ),
        )
        for tag, keys, rows in further:
            element = joint.find(tag)
            if element is not None:
                given = [number_of(path, joint, element, key) for key in keys]
                rows[:, i] = np.where(given, given, rows[:, i])
    return limits, position_dependent_velocity
