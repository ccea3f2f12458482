"""Robots in MuJoCo's own format, MJCF, rewritten as a URDF.

MuJoCo reads the file, with its defaults, includes and classes; what is left is a tree of bodies.
Each becomes a link, each hinge or slide a joint, so that all that comes after knows one format.
Kept are masses, axes, position limits, the actuators' force limits and the primitive shapes. Meshes
are not, nor is a velocity limit, which MJCF does not know.
"""

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from iiwa_dnn.checks import Array
from iiwa_dnn.errors import FileError
from iiwa_dnn.robot.offscreen import import_mujoco
from iiwa_dnn.robot.urdf import set_origin, words


def as_urdf(path: Path) -> ET.Element:
    """Read an MJCF file with MuJoCo; return the element ``<robot>`` of the same robot.

    Raises:
        MissingDependencyError: MuJoCo is not installed.
        FileError: MuJoCo refuses the file, or a joint is a ball, is free, or is not at 0 in the
            file's own posture.
    """
    mj = import_mujoco()
    try:
        model = mj.MjModel.from_xml_path(str(path))
    except ValueError as error:
        raise FileError(path, f"MuJoCo refuses it: {str(error).partition(chr(10))[0]}") from error
    root = ET.Element("robot", name=path.stem)
    bodies = [model.body(i) for i in range(model.nbody)]
    names = [body.name or f"body_{body.id}" for body in bodies]
    links = [ET.SubElement(root, "link", name=name) for name in names]
    for body, name, link in list(zip(bodies, names, links, strict=True))[1:]:
        _add_inertial(link, _pose(body.ipos, body.iquat), body.mass[0], body.inertia)
        parent = names[body.parentid[0]]
        pose = _pose(body.pos, body.quat)
        for index in range(body.jntadr[0], body.jntadr[0] + body.jntnum[0]):
            joint = model.joint(index)
            between = f"{name}_at_{joint.name or index}"
            anchored = pose * pin.SE3(np.eye(3), joint.pos)
            element = _add_joint(root, joint.name or f"joint_{index}", parent, between, anchored)
            _set_motion(mj, model, path, joint, element)
            # MuJoCo wants all that moves to have mass.
            light = ET.SubElement(root, "link", name=between)
            _add_inertial(light, pin.SE3.Identity(), 1e-6, np.full(3, 1e-9))
            parent = between
            pose = pin.SE3(np.eye(3), -joint.pos)
        _add_joint(root, f"{name}_fixed", parent, name, pose)
    for index in range(model.ngeom):
        geom = model.geom(index)
        if geom.bodyid[0] != 0:
            _add_shape(mj, geom, links[geom.bodyid[0]])
    return root


def _add_joint(root: ET.Element, name: str, parent: str, child: str, pose: pin.SE3) -> ET.Element:
    """Add a fixed joint between two links."""
    joint = ET.SubElement(root, "joint", name=name, type="fixed")
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)
    set_origin(joint, pose)
    return joint


def _set_motion(mj: Any, model: Any, path: Path, joint: Any, element: ET.Element) -> None:
    """Make a fixed joint a hinge or slide with its axis and limits."""
    kinds = {mj.mjtJoint.mjJNT_HINGE.value: "revolute", mj.mjtJoint.mjJNT_SLIDE.value: "prismatic"}
    kind = kinds.get(int(joint.type[0]))
    if kind is None or joint.qpos0[0] != 0.0:
        problem = "is no hinge or slide" if kind is None else f"begins at {joint.qpos0[0]:g}"
        name = element.get("name")
        raise FileError(path, f"joint {name!r} {problem}, which is not supported")
    element.set("type", kind)
    ET.SubElement(element, "axis", xyz=words(joint.axis))
    on_joints = model.actuator_trntype == mj.mjtTrn.mjTRN_JOINT.value
    motors = on_joints & (model.actuator_trnid[:, 0] == joint.id)
    force = np.abs(model.actuator_forcerange[motors]).max(initial=0.0)
    limit = ET.SubElement(element, "limit", effort=words([force]), velocity="0")
    if joint.limited[0]:
        limit.set("lower", words(joint.range[:1]))
        limit.set("upper", words(joint.range[1:]))


def _add_inertial(link: ET.Element, pose: pin.SE3, mass: float, moments: Array) -> None:
    inertial = ET.SubElement(link, "inertial")
    set_origin(inertial, pose)
    ET.SubElement(inertial, "mass", value=words([mass]))
    xx, yy, zz = words(moments).split()
    ET.SubElement(inertial, "inertia", ixx=xx, iyy=yy, izz=zz, ixy="0", ixz="0", iyz="0")


def _add_shape(mj: Any, geom: Any, link: ET.Element) -> None:
    """Add a primitive to its link as a visual and, where it can collide, as a collision shape."""
    radius = words(geom.size[:1])
    length = words(2.0 * geom.size[1:2])
    shapes = {
        mj.mjtGeom.mjGEOM_SPHERE: ("sphere", {"radius": radius}),
        mj.mjtGeom.mjGEOM_CYLINDER: ("cylinder", {"radius": radius, "length": length}),
        mj.mjtGeom.mjGEOM_CAPSULE: ("cylinder", {"radius": radius, "length": length}),
        mj.mjtGeom.mjGEOM_BOX: ("box", {"size": words(2.0 * geom.size)}),
    }
    form = mj.mjtGeom(geom.type[0])
    if form not in shapes:
        return
    for use in ("visual", "collision") if geom.contype[0] else ("visual",):
        element = ET.SubElement(link, use)
        set_origin(element, _pose(geom.pos, geom.quat))
        ET.SubElement(ET.SubElement(element, "geometry"), *shapes[form])
        if use == "visual":
            material = ET.SubElement(element, "material", name=f"geom_{geom.id}")
            ET.SubElement(material, "color", rgba=words(geom.rgba))


def _pose(position: ArrayLike, quaternion: Array) -> pin.SE3:
    """Convert a position [m] and a quaternion, its scalar first, to a pose."""
    return pin.SE3(pin.Quaternion(*quaternion.tolist()).matrix(), np.array(position))
