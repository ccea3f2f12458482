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

from iiwa_dnn.errors import FileError
from iiwa_dnn.robot.offscreen import import_mujoco


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
    names = [model.body(i).name or f"body_{i}" for i in range(model.nbody)]
    for body, name in enumerate(names):
        link = _link(root, name)
        if body == 0:
            continue
        place = _pose(model.body_ipos[body], model.body_iquat[body])
        _inertial(link, place, model.body_mass[body], model.body_inertia[body].tolist())
        parent = names[model.body_parentid[body]]
        place = _pose(model.body_pos[body], model.body_quat[body])
        first = model.body_jntadr[body]
        for joint in range(first, first + model.body_jntnum[body]):
            anchor = model.jnt_pos[joint]
            before = f"{name}_at_{model.joint(joint).name or joint}"
            _joint(root, mj, model, path, joint, parent, before, place * pin.SE3(np.eye(3), anchor))
            # MuJoCo wants all that moves to have mass.
            _inertial(_link(root, before), pin.SE3.Identity(), 1e-6, [1e-9] * 3)
            parent, place = before, pin.SE3(np.eye(3), -anchor)
        _fix(root, f"{name}_fixed", parent, name, place)
    for geom in range(model.ngeom):
        _shape(root, mj, model, geom, names)
    return root


def _link(root: ET.Element, name: str) -> ET.Element:
    return ET.SubElement(root, "link", name=name)


def _fix(root: ET.Element, name: str, parent: str, child: str, place: pin.SE3) -> ET.Element:
    """Add a joint between two links, fixed for the time being."""
    joint = ET.SubElement(root, "joint", name=name, type="fixed")
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)
    _origin(joint, place)
    return joint


def _joint(
    root: ET.Element, mj: Any, model: Any, path: Path, joint: int, parent: str, child: str,
    place: pin.SE3,
) -> None:  # fmt: skip
    """Add a hinge or slide with its limits."""
    name, at = model.joint(joint).name or f"joint_{joint}", model.jnt_qposadr[joint]
    kinds = {mj.mjtJoint.mjJNT_HINGE.value: "revolute", mj.mjtJoint.mjJNT_SLIDE.value: "prismatic"}
    kind = kinds.get(int(model.jnt_type[joint]))
    if kind is None or model.qpos0[at] != 0.0:
        problem = "is no hinge or slide" if kind is None else f"begins at {model.qpos0[at]:g}"
        raise FileError(path, f"joint {name!r} {problem}, which is not supported")
    element = _fix(root, name, parent, child, place)
    element.set("type", kind)
    ET.SubElement(element, "axis", xyz=_words(model.jnt_axis[joint]))
    motors = (model.actuator_trnid[:, 0] == joint) & (
        model.actuator_trntype == mj.mjtTrn.mjTRN_JOINT.value
    )
    force = np.abs(model.actuator_forcerange[motors]).max(initial=0.0)
    limit = ET.SubElement(element, "limit", effort=repr(float(force)), velocity="0")
    if model.jnt_limited[joint]:
        for key, value in zip(("lower", "upper"), model.jnt_range[joint].tolist(), strict=True):
            limit.set(key, repr(value))


def _inertial(link: ET.Element, place: pin.SE3, mass: float, moments: list[float]) -> None:
    inertial = ET.SubElement(link, "inertial")
    _origin(inertial, place)
    ET.SubElement(inertial, "mass", value=repr(float(mass)))
    numbers = dict(zip(("ixx", "iyy", "izz"), map(repr, moments), strict=True))
    ET.SubElement(inertial, "inertia", dict.fromkeys(("ixy", "ixz", "iyz"), "0") | numbers)


def _shape(root: ET.Element, mj: Any, model: Any, geom: int, names: list[str]) -> None:
    """Add a primitive to its link, for the eye, and where it can collide for that too."""
    kinds, size = mj.mjtGeom, model.geom_size[geom]
    tall = {"radius": repr(float(size[0])), "length": repr(2.0 * float(size[1]))}
    shapes = {
        kinds.mjGEOM_SPHERE.value: ("sphere", {"radius": repr(float(size[0]))}),
        kinds.mjGEOM_CYLINDER.value: ("cylinder", tall),
        kinds.mjGEOM_CAPSULE.value: ("cylinder", tall),
        kinds.mjGEOM_BOX.value: ("box", {"size": _words(2.0 * size)}),
    }
    body, form = int(model.geom_bodyid[geom]), int(model.geom_type[geom])
    if body == 0 or form not in shapes:
        return
    kind, numbers = shapes[form]
    link = next(link for link in root.findall("link") if link.get("name") == names[body])
    for use in ("visual", "collision") if model.geom_contype[geom] else ("visual",):
        element = ET.SubElement(link, use)
        _origin(element, _pose(model.geom_pos[geom], model.geom_quat[geom]))
        ET.SubElement(ET.SubElement(element, "geometry"), kind, numbers)
        if use == "visual":
            material = ET.SubElement(element, "material", name=f"geom_{geom}")
            ET.SubElement(material, "color", rgba=_words(model.geom_rgba[geom]))


def _pose(position: ArrayLike, quaternion: Any) -> pin.SE3:
    w, x, y, z = map(float, quaternion)
    return pin.SE3(pin.Quaternion(w, x, y, z).matrix(), np.array(position))


def _origin(element: ET.Element, place: pin.SE3) -> None:
    turn = _words(pin.rpy.matrixToRpy(place.rotation))
    ET.SubElement(element, "origin", xyz=_words(place.translation), rpy=turn)


def _words(numbers: Any) -> str:
    return " ".join(map(repr, np.asarray(numbers, dtype=float).tolist()))
