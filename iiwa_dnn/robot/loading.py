"""Loading of robots, by name or from a URDF file: the file read, joints locked, limits checked."""

import contextlib
import os
import xml.etree.ElementTree as ET
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from iiwa_dnn.checks import Array
from iiwa_dnn.errors import FileError, InvalidInputError, MissingDependencyError, NotFoundError
from iiwa_dnn.robot import urdf
from iiwa_dnn.robot.arms import ARMS, RATES, Arm
from iiwa_dnn.robot.robot import Mimic, Robot

_Joints = dict[str, ET.Element]


def available_robots() -> tuple[str, ...]:
    """List the robots that `load_robot` knows by name: the package's own, then installed `ARMS`."""
    with contextlib.suppress(MissingDependencyError):
        return (*package_robots(), *(name for name, arm in ARMS.items() if arm.path.is_file()))
    return package_robots()


def package_robots() -> tuple[str, ...]:
    """List the robots that come with the package."""
    files = robots_folder().glob("*/*.urdf")
    return tuple(sorted(file.stem for file in files if file.parent.name == file.stem))


def load_robot(
    name_or_path: str | os.PathLike[str],
    tip: str | None = None,
    locked: str | Iterable[str] = (),
    verify: bool = False,
    tool: pin.SE3 | ArrayLike | None = None,
    mobile: bool = False,
) -> Robot:
    """Load a robot by its name or from a file: URDF, xacro or MuJoCo's MJCF.

    Limits are the URDF's. A joint whose ``<limit>`` gives neither ``lower`` nor ``upper`` has no
    position limit, and a ``velocity`` of 0 stands for "not given": no velocity limit.

    Args:
        name_or_path: A name out of `available_robots`, or the path of a file: a `Path`, or a string
            that ends in ``.urdf``, ``.xacro`` or ``.xml`` or has a separator in it.
        tip: Frame that follows references. Default: that of the name (`iiwa_dnn.robot.arms`), or
            the link at the end of the chain, for a robot that has only one end.
        locked: Names of joints to freeze, each at its zero position or at the limit nearest to it;
            an arm of `iiwa_dnn.robot.arms.ARMS` has all joints frozen that do not move its tip.
        verify: Let a second reader judge joints, limits and link poses (`verification`); of the
            extra ``verify``.
        tool: Pose of a tool in the frame `tip`, whose place it takes (`Robot.with_tool`): an SE3,
            or x, y, z [m], roll, pitch, yaw [rad], (6,).
        mobile: Put the robot on a base that moves in the plane: joints ``base_x``, ``base_y`` [m]
            and ``base_yaw`` [rad] without position limits, at 1 m/s and 1 rad/s at most.

    Raises:
        NotFoundError: If there is no such robot, frame or joint; the error lists those that exist.
        FileError: If the file cannot be read, is not a URDF, its limits make no sense, or the
            second reader disagrees.
        InvalidInputError: If the robot has several ends and no ``tip`` is given, or a joint that is
            left free has more or less than one coordinate, or follows a joint that is locked.
        MissingDependencyError: If the arm of that name, or the second reader, is in a package that
            is not installed.
    """
    path, arm = _find(name_or_path)
    mobile = mobile or (arm is not None and arm.mobile)
    root = urdf.read(path, mobile)
    full = urdf.build_model(path, root)
    frozen = _frozen_joints(full, arm, locked)
    # Not the locked model: Pinocchio's reduction loses which frame a locked joint hangs on.
    if tip is None:
        tip = _default_tip(root, full) if arm is None else arm.tip
    model, q_locked = _lock(full, frozen)
    joints = {joint.get("name", ""): joint for joint in root.findall("joint")}
    lower, upper, velocity = _limits(path, model, joints)
    # By the name it was asked for: the URDFs call some of these arms otherwise.
    name = model.name if arm is None else str(name_or_path)
    robot = Robot(
        name,
        model,
        tip,
        lower,
        upper,
        velocity,
        frozen,
        path,
        q_locked,
        mobile=mobile,
        urdf=urdf.text_of(root),
    )
    if name in RATES and np.size(RATES[name][0]) in (1, robot.dof):
        robot = robot.with_limits(acceleration=RATES[name][0], jerk=RATES[name][1])
    robot = replace(robot, mimics=_mimics(robot, joints), ramps=_ramps(model, joints))
    if verify:
        from iiwa_dnn.robot.verification import verify_robot  # of an extra

        verify_robot(robot)
    return robot if tool is None else robot.with_tool(tool)


def robots_folder() -> Path:
    """Find the robots' folder: beside the rooms in an installed wheel, above in the repository."""
    here = Path(__file__).resolve().parents[1]
    inside = here / "robots"
    return inside if inside.is_dir() else here.parent / "robots"


def _find(name_or_path: str | os.PathLike[str]) -> tuple[Path, Arm | None]:
    """Find the URDF file of a robot, and the further facts if it is one of `ARMS`."""
    if not isinstance(name_or_path, str | os.PathLike):
        raise InvalidInputError("name_or_path", "must be a robot's name or a path", name_or_path)
    name = os.fspath(name_or_path)
    is_file = isinstance(name_or_path, os.PathLike) or name.endswith((".urdf", ".xacro", ".xml"))
    if is_file or "/" in name or os.sep in name:
        return Path(name), None
    if name in ARMS:
        return ARMS[name].path, ARMS[name]
    available = package_robots()
    if name not in available:
        raise NotFoundError("robot", name, (*available, *ARMS))
    return robots_folder() / name / f"{name}.urdf", None


def _default_tip(root: ET.Element, model: pin.Model) -> str:
    """Name the tip of the file, else the link at the end of the chain, if there is only one."""
    if "tip" in root.attrib:
        return root.attrib["tip"]
    parents = {frame.parentFrame for frame in model.frames}
    frames = enumerate(model.frames)
    ends = [f.name for i, f in frames if f.type == pin.FrameType.BODY and i not in parents]
    if len(ends) != 1:
        raise InvalidInputError("tip", f"is needed: the robot has several ends: {', '.join(ends)}")
    return str(ends[0])


def _frozen_joints(
    model: pin.Model, arm: Arm | None, locked: str | Iterable[str]
) -> tuple[str, ...]:
    """List the joints to freeze, each once: those that do not move an arm's tip, then `locked`."""
    if not isinstance(locked, Iterable):
        raise InvalidInputError("locked", f"must be names of joints, not {locked!r}", locked)
    chosen = [locked] if isinstance(locked, str) else list(locked)
    for name in chosen:
        if name not in tuple(model.names)[1:]:
            raise NotFoundError("joint", name, tuple(model.names)[1:])
    if arm is None:
        return tuple(dict.fromkeys(chosen))
    tip = model.frames[model.getFrameId(arm.tip, pin.FrameType.BODY)]
    moving = set(model.supports[tip.parentJoint])
    idle = [name for i, name in enumerate(model.names) if i not in moving]
    return tuple(dict.fromkeys([*idle, *chosen]))


def _lock(model: pin.Model, locked: tuple[str, ...]) -> tuple[pin.Model, tuple[float, ...]]:
    """Freeze joints at zero or the limit nearest to it; return model and frozen positions [rad]."""
    if len(locked) == model.njoints - 1:
        raise InvalidInputError("locked", "no joint is left to move", locked)
    # A zero position can lie outside the limits (the panda's joint 4): then the nearest limit.
    posture = np.clip(pin.neutral(model), model.lowerPositionLimit, model.upperPositionLimit)
    frozen = [model.getJointId(name) for name in locked]
    # Planar and floating joints are at zero.
    q_locked = [float(posture[model.idx_qs[i]]) if model.nqs[i] == 1 else 0.0 for i in frozen]
    reduced = pin.buildReducedModel(model, frozen, posture) if locked else model
    return reduced, tuple(q_locked)


def _mimics(robot: Robot, joints: _Joints) -> tuple[Mimic, ...]:
    """Find the joints that move the tip and follow another; that one must be free as well."""
    found = []
    model = robot.model
    for index in list(model.supports[model.frames[robot.tip_id].parentJoint])[1:]:
        name = model.names[index]
        mimic = joints[name].find("mimic")
        if mimic is None:
            continue
        leader = mimic.get("joint", "")
        if leader not in robot.joint_names:
            problem = f"joint {name!r} follows {leader!r} (<mimic>), which is locked: lock it too"
            raise InvalidInputError("locked", problem, name)
        multiplier = float(mimic.get("multiplier", 1.0))
        found.append(Mimic(name, leader, multiplier, float(mimic.get("offset", 0.0))))
    return tuple(found)


def _ramps(model: pin.Model, joints: _Joints) -> Array:
    """Read Franka's element of velocity limits that shrink towards position limits, (2, n)."""
    ramps = np.zeros((2, model.nv))
    ramps[1] = np.inf
    for i, name in enumerate(tuple(model.names)[1:]):
        ramp = joints[name].find("position_based_velocity_limits")
        if ramp is not None:
            names = ("velocity_offset", "deceleration_limit")
            ramps[:, i] = [float(ramp.get(each, "nan")) for each in names]
    return ramps


def _limits(path: Path, model: pin.Model, joints: _Joints) -> tuple[Array, Array, Array]:
    """Read lower, upper and velocity limits, each (n,); infinite where the URDF gives none."""
    lower = model.lowerPositionLimit.copy()
    upper = model.upperPositionLimit.copy()
    velocity = model.velocityLimit.copy()
    for i, name in enumerate(tuple(model.names)[1:]):
        if model.nqs[i + 1] != 1 or model.nvs[i + 1] != 1:  # q and its velocity differ in kind
            kind = joints[name].get("type")
            problem = f"joint {name!r} is {kind}; only joints with one coordinate are supported"
            raise InvalidInputError("locked", f"{problem}: lock it", name)
        limit = joints[name].find("limit")
        if limit is None or not {"lower", "upper"} & set(limit.keys()):
            lower[i] = -np.inf
            upper[i] = np.inf
        if not lower[i] < upper[i]:
            raise FileError(path, f"joint {name!r}: lower limit {lower[i]} is not below {upper[i]}")
        if not velocity[i] >= 0.0:
            raise FileError(path, f"joint {name!r}: velocity limit {velocity[i]} is negative")
    velocity[velocity == 0.0] = np.inf
    return lower, upper, velocity
