"""The scenes of ``scripts/arm_scenes.py`` beside Pink, mink and PlaCo: the motion and its time.

``python -m benchmarks arms`` prints two tables. All read one URDF, without shapes and with joints
that do not matter fixed, and get the target of the step's end. Levenberg-Marquardt damping, which
the examples of Pink and mink have for the way to the target, is off. Tips are compared at all steps
and where the peer has arrived: from the first step on whose position error is below 0.1 mm, as long
as it stays there.
"""

import tempfile
import warnings
import xml.etree.ElementTree as ET
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

import iiwa_dnn
from benchmarks.collisions import read_arguments
from benchmarks.control import LOOPS, measure_steps
from iiwa_dnn.results.markdown import markdown_table
from iiwa_dnn.robot import urdf
from scripts.arm_scenes import SCENES, scene

OWN = "iiwa_dnn, with q + dt dq"
PEERS = ("Pink, daqp, target one step ahead", "mink, daqp", "PlaCo")
ARRIVED = 1e-4  # [m]


def write_urdf(robot: iiwa_dnn.Robot, folder: Path) -> Path:
    """Write a robot's URDF in one file, without shapes, its locked joints fixed."""
    root = ET.fromstring(str(robot.urdf))
    urdf.weld(root, dict(zip(robot.locked, robot.q_locked, strict=True)))
    for link in root.findall("link"):
        for shape in [*link.findall("visual"), *link.findall("collision")]:
            link.remove(shape)
    path = folder / f"{robot.name}.urdf"
    path.write_text(urdf.text_of(root), encoding="utf-8")
    return path


def measure_scene(
    name: str, steps: int, dt: float, pythons: dict[str, Path | None]
) -> tuple[list[dict[str, Any]], list[str]]:
    """Measure one scene; the rows of `measure_steps` with the tips, (steps, frames, 3), as well."""
    robot, _, references, q0 = scene(name, dt)
    times = np.arange(steps + 1) * dt
    targets = [reference.sample(times) for reference in references.values()]
    poses = np.tile(np.eye(4), (steps + 1, len(targets), 1, 1))
    poses[:, :, :3, :3] = np.stack([each.rotation for each in targets], axis=1)
    poses[:, :, :3, 3] = np.stack([each.position for each in targets], axis=1)
    loops = [loop for loop in LOOPS if loop.name in (OWN, *PEERS)]
    with tempfile.TemporaryDirectory() as folder:
        task = {
            "scene": name,
            "urdf": str(write_urdf(robot, Path(folder))),
            "tip": [*references],
            "names": robot.joint_names,
            "q0": np.array(q0),
            "lower": robot.q_lower,
            "upper": robot.q_upper,
            "velocity": robot.dq_max,
            "poses": poses,
            "soft": True,
        }
        rows, missing = measure_steps(steps, dt, pythons, scene=task, loops=loops)
    for row in rows:
        at = [iiwa_dnn.Configuration(robot, q) for q in row["q"]]
        row["tips"] = np.array([[conf.frame(f).position for f in references] for conf in at])
        row["error"] = np.linalg.norm(row["tips"] - poses[1:, :, :3, 3], axis=2).max(axis=1)
    return rows, missing


def compare(own: dict[str, Any], peer: dict[str, Any]) -> tuple[float, float, float]:
    """Return differences: of tips [m] at all steps and once arrived, of joints [rad] there."""
    apart = np.linalg.norm(own["tips"] - peer["tips"], axis=2).max(axis=1)
    late = np.flatnonzero(peer["error"] > ARRIVED)
    first = late[-1] + 1 if late.size else 0
    arrived = slice(first, None) if first < len(apart) else peer["error"] <= ARRIVED
    joints = np.abs(np.array(own["q"]) - np.array(peer["q"])).max(axis=1)
    if not apart[arrived].size:
        return float(apart.max()), np.nan, np.nan
    return float(apart.max()), float(apart[arrived].max()), float(joints[arrived].max())


def bench_arms(arguments: Sequence[str] | None = None, prog: str = "arms") -> int:
    """Measure the scenes and print the tables; returns 0."""
    steps, pythons = read_arguments(prog, bench_arms.__doc__, 2000, arguments)
    times = []
    motions = []
    missing = set()
    warnings.simplefilter("ignore")
    for name in SCENES:
        if "velocity" in name:  # no frame's target
            continue
        rows, absent = measure_scene(name, steps, 5e-3, pythons)
        missing.update(absent)
        found = {row["name"]: row for row in rows}
        own = found[OWN]
        own_time = own["median_us"]
        cells = [name, f"{own['median_us']:.1f}"]
        for peer in PEERS:
            row = found.get(peer)
            cells.append("" if row is None else f"{row['median_us']:.1f}")
            cells.append("" if row is None else f"{own_time / row['median_us']:.2f}")
            if row is not None:
                apart = [f"{value:.1e}" for value in compare(own, row)]
                motions.append([name, peer.split(",")[0], f"{row['error'][-1]:.1e}", *apart])
        times.append(cells)
    head = ["scene", "iiwa_dnn µs"]
    for peer in PEERS:
        head += [f"{peer.split(',')[0]} µs", "ours of it"]
    print(markdown_table(head, times), end="\n\n")
    head = ["scene", "peer", "its error at the end m", "tips apart m", "arrived m", "joints rad"]
    print(markdown_table(head, motions))
    if missing:
        print(f"not measured: {', '.join(sorted(missing))}")
    return 0
