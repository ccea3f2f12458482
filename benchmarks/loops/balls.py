"""The scene of the collision benchmark for peers: a URDF of one cylinder a link, and the pairs."""

import json
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np


def write_scene(task: Any, folder: Path) -> tuple[Path, Path]:
    """Write the URDF and the pairs, ``[[link, ball], ...]``; returns both files."""
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
