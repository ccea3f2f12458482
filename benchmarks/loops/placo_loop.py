"""PlaCo's loop: a hard frame task, a weak joints task, joint and velocity limits."""

import json
import tempfile
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
import placo
from serve import Loop, Task, serve


def make(task: Task, variant: str) -> Loop:
    """Make the loop."""
    urdf = Path(str(task["urdf"]))
    if "balls" in task:
        folder = tempfile.TemporaryDirectory()
        urdf, pairs = write_scene(task, Path(folder.name))
    robot = placo.RobotWrapper(str(urdf))
    if "balls" in task:
        robot.load_collision_pairs(str(pairs))
    names = [str(name) for name in task["names"]]
    for i, name in enumerate(names):
        robot.set_joint(name, float(task["q0"][i]))
        robot.set_joint_limits(name, float(task["lower"][i]), float(task["upper"][i]))
        robot.set_velocity_limit(name, float(task["velocity"][i]))
    robot.update_kinematics()
    solver = placo.KinematicsSolver(robot)
    solver.mask_fbase(True)
    tip = str(task["tip"])
    frame = solver.add_frame_task(tip, task["poses"][0])
    frame.configure(tip, "hard", 1.0, 1.0)
    joints = solver.add_joints_task()
    joints.set_joints(dict(zip(names, task["q0"].tolist(), strict=True)))
    joints.configure("posture", "soft", 1e-3)
    solver.enable_joint_limits(True)
    solver.enable_velocity_limits(True)
    if "balls" in task:
        avoid = solver.add_avoid_self_collisions_constraint()
        avoid.self_collisions_margin = float(task["distance"])
        avoid.self_collisions_trigger = float(task["distance"]) + 0.2
        avoid.configure("balls", "hard", 1.0)
    solver.dt = float(task["dt"])

    def step(k: int) -> None:
        frame.T_world_frame = task["poses"][k + 1]
        solver.solve(True)
        robot.update_kinematics()

    return step, lambda: robot.state.q[7:]  # after the pose of the floating base


def write_scene(task: Task, folder: Path) -> tuple[Path, Path]:
    """Write a URDF of one cylinder a link, and the pairs of links and balls; returns both files."""
    root = ET.parse(str(task["urdf"])).getroot()
    first = root.find("link").get("name")
    for link in root.findall("link"):
        for shape in link.findall("collision"):
            link.remove(shape)
    links = {link.get("name"): link for link in root.findall("link")}
    capsules = zip(task["links"], task["a"], task["b"], task["radii"], strict=True)
    for name, a, b, radius in capsules:
        length = float(np.linalg.norm(b - a))
        x, y, z = (b - a) / length if length > 1e-6 else (0.0, 0.0, 1.0)
        turn = [np.arctan2(-y, z), np.arcsin(x), 0.0]  # its z axis along the capsule
        size = {"radius": str(radius), "length": str(max(length, 1e-3))}
        add_shape(links[str(name)], 0.5 * (a + b), turn, "cylinder", size)
    for number, (center, radius) in enumerate(zip(task["balls"], task["ball_radii"], strict=True)):
        link = ET.SubElement(root, "link", name=f"ball_{number}")
        add_shape(link, center, [0, 0, 0], "sphere", {"radius": str(radius)})
        joint = ET.SubElement(root, "joint", name=f"ball_joint_{number}", type="fixed")
        ET.SubElement(joint, "parent", link=str(first))
        ET.SubElement(joint, "child", link=f"ball_{number}")
    pairs = [[str(n), f"ball_{k}"] for n in task["links"] for k in range(len(task["balls"]))]
    (folder / "collisions.json").write_text(json.dumps(pairs))
    (folder / "robot.urdf").write_text(ET.tostring(root, encoding="unicode"))
    return folder / "robot.urdf", folder / "collisions.json"


def add_shape(link: Any, xyz: Any, rpy: Any, kind: str, size: dict[str, str]) -> None:
    """Add a collision shape to a link of a URDF."""
    shape = ET.SubElement(link, "collision")
    text = (" ".join(map(str, values)) for values in (xyz, rpy))
    ET.SubElement(shape, "origin", **dict(zip(("xyz", "rpy"), text, strict=True)))
    ET.SubElement(ET.SubElement(shape, "geometry"), kind, **size)


if __name__ == "__main__":
    serve(make)
