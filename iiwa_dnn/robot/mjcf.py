"""MJCF files: read by MuJoCo's own compiler, as the URDF of the same robot.

Bodies become links, and so do sites, of which one is often the tip. Each joint has a link of its
own, since it may be beside its body's origin. MJCF has no velocity limits. (Pinocchio 4.1 has a
reader too; it puts a base without joints at the origin, wherever the file has it.)
"""

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from iiwa_dnn.errors import FileError, import_extra, warn_caller
from iiwa_dnn.files import one_line
from iiwa_dnn.robot.urdf import ENDLESS

_KINDS = {"hinge": "revolute", "slide": "prismatic", "free": "floating"}


def read_mjcf(path: Path) -> ET.Element:
    """Read an MJCF file; return the first element of a URDF of its robot.

    Raises:
        MissingDependencyError: MuJoCo is not installed.
        FileError: MuJoCo refuses the file, or a joint is a ball.
    """
    mj = import_extra("mujoco", "pip install 'iiwa-dnn[sim]'")
    try:
        spec = mj.MjSpec.from_file(str(path))
        model = spec.compile()
    except ValueError as error:
        raise FileError(path, f"no MJCF that MuJoCo can read: {one_line(error)}") from error
    folder = path.absolute().parent / (spec.meshdir or "")
    meshes = {each.name: (str(folder / each.file), each.scale) for each in spec.meshes}
    root = ET.Element("robot", name=spec.modelname, version="1.1")  # it has capsules
    for number in range(model.nbody):
        link = _add_body(mj, model, number, root, path)
        for geom in np.flatnonzero(model.geom_bodyid == number):
            _add_shape(mj, model, int(geom), link, meshes)
    flat = np.isin(model.geom_type, (mj.mjtGeom.mjGEOM_PLANE, mj.mjtGeom.mjGEOM_HFIELD))
    if (flat & ((model.geom_contype | model.geom_conaffinity) > 0)).any():
        warn_caller(f"{path}: a plane or a field of heights is left out: state it as a HalfSpace")
    known = {link.get("name") for link in root.findall("link")}
    for number in np.flatnonzero(model.body_weldid[model.site_bodyid]):  # not those of the base
        site = model.site(number)
        if site.name and site.name not in known:
            parent = _name(model.body(model.site_bodyid[number]))
            pose = _pose(site.pos, site.quat)
            _add_link(root, site.name, parent, "fixed", f"{site.name} fixed", pose)
    return root


def _name(view: Any) -> str:
    """Return the name of a body, joint or site; one without has its number."""
    return str(view.name or f"unnamed_{view.id}")


def _pose(place: ArrayLike, turn: ArrayLike) -> pin.SE3:
    """Return the pose of a place [m], (3,), and a quaternion (4,) in MuJoCo's order."""
    w, x, y, z = np.asarray(turn, dtype=np.float64)
    return pin.SE3(pin.Quaternion(w, x, y, z).normalized(), np.array(place, dtype=np.float64))


def _text(numbers: ArrayLike) -> str:
    return " ".join(repr(float(number)) for number in np.ravel(numbers))


def _origin(parent: ET.Element, pose: pin.SE3) -> None:
    rpy = pin.rpy.matrixToRpy(pose.rotation)
    ET.SubElement(parent, "origin", xyz=_text(pose.translation), rpy=_text(rpy))


def _add_link(
    root: ET.Element, name: str, parent: str, kind: str, joint: str, pose: pin.SE3
) -> ET.Element:
    """Add a link and, after it, the joint that carries it, which is returned."""
    ET.SubElement(root, "link", name=name)
    made = ET.SubElement(root, "joint", name=joint, type=kind)
    ET.SubElement(made, "parent", link=parent)
    ET.SubElement(made, "child", link=name)
    _origin(made, pose)
    return made


def _add_body(mj: Any, model: Any, number: int, root: ET.Element, path: Path) -> ET.Element:
    """Add a body's link, the joints that carry it, and its inertia; return the link."""
    body = model.body(number)
    name = _name(body)
    if number == 0:
        return ET.SubElement(root, "link", name=name)
    parent = _name(model.body(body.parentid[0]))
    pose = _pose(body.pos, body.quat)
    joints = [model.joint(k) for k in np.flatnonzero(model.jnt_bodyid == number)]
    for joint in joints:
        at = pin.SE3(np.eye(3), np.array(joint.pos))
        frame = f"{name} at {_name(joint)}"
        made = _add_link(root, frame, parent, _kind(mj, joint, path), _name(joint), pose * at)
        _add_limits(mj, model, joint, made)
        parent = frame
        pose = at.inverse()
    _add_link(root, name, parent, "fixed", f"{name} fixed", pose)
    link = root[-2]
    if body.mass[0] > 0.0:
        made = ET.SubElement(link, "inertial")
        _origin(made, _pose(body.ipos, body.iquat))
        ET.SubElement(made, "mass", value=_text(body.mass))
        diagonal = dict(zip(("ixx", "iyy", "izz"), map(_text, body.inertia), strict=True))
        ET.SubElement(made, "inertia", diagonal, ixy="0", ixz="0", iyz="0")
    return link


def _kind(mj: Any, joint: Any, path: Path) -> str:
    """Return the type of a joint in a URDF."""
    kind = mj.mjtJoint(joint.type[0]).name.removeprefix("mjJNT_").lower()
    if kind not in _KINDS:
        raise FileError(path, f"joint {_name(joint)!r} is a {kind}")
    return _KINDS[kind]


def _add_limits(mj: Any, model: Any, joint: Any, made: ET.Element) -> None:
    """Add axis, range and torque limit of a joint, and the joint that it follows, if it does."""
    if made.get("type") == "floating":
        return
    ET.SubElement(made, "axis", xyz=_text(joint.axis))
    limit = ET.SubElement(made, "limit", velocity="0", effort=_text(_effort(mj, model, joint)))
    lower, upper = map(_text, joint.range) if joint.limited[0] else ENDLESS
    limit.attrib.update(lower=lower, upper=upper)
    follows = (model.eq_type == mj.mjtEq.mjEQ_JOINT) & (model.eq_obj1id == joint.id)
    for number in np.flatnonzero(follows & (model.eq_obj2id >= 0) & (model.eq_active0 == 1)):
        ET.SubElement(made, "mimic", joint=_name(model.joint(model.eq_obj2id[number])))


def _effort(mj: Any, model: Any, joint: Any) -> float:
    """Return the torque limit of a joint [N m]; 0: none is given."""
    if model.jnt_actfrclimited[joint.id]:
        return float(np.abs(model.jnt_actfrcrange[joint.id]).max())
    drives = (model.actuator_trntype == mj.mjtTrn.mjTRN_JOINT) & (model.actuator_forcelimited == 1)
    for number in np.flatnonzero(drives & (model.actuator_trnid[:, 0] == joint.id)):
        force = np.abs(model.actuator_forcerange[number]).max()
        return float(force * abs(model.actuator_gear[number, 0]))
    return 0.0


def _add_shape(mj: Any, model: Any, number: int, link: Any, meshes: dict[str, Any]) -> None:
    """Add a geom to a link: a shape for collisions if it has contacts, else for the eye."""
    geom = model.geom(number)
    kind = mj.mjtGeom(geom.type[0]).name.removeprefix("mjGEOM_").lower()
    pose = _pose(geom.pos, geom.quat)
    radius, half, _ = size = geom.size
    shapes = {
        "sphere": ("sphere", {"radius": _text(radius)}),
        "capsule": ("capsule", {"radius": _text(radius), "length": _text(2.0 * half)}),
        "cylinder": ("cylinder", {"radius": _text(radius), "length": _text(2.0 * half)}),
        "box": ("box", {"size": _text(2.0 * size)}),
        "ellipsoid": ("box", {"size": _text(2.0 * size)}),  # around it
    }
    if kind == "mesh":
        mesh = int(geom.dataid[0])
        moved = _pose(model.mesh_pos[mesh], model.mesh_quat[mesh])  # to its centre, by MuJoCo
        pose = pose * moved.inverse()
        file, scale = meshes[model.mesh(mesh).name]
        shapes[kind] = ("mesh", {"filename": file, "scale": _text(scale)})
    if kind not in shapes:
        return  # a plane or a field of heights is no part of a robot
    has_contacts = model.geom_contype[number] or model.geom_conaffinity[number]
    made = ET.SubElement(link, "collision" if has_contacts else "visual")
    _origin(made, pose)
    ET.SubElement(ET.SubElement(made, "geometry"), *shapes[kind])
