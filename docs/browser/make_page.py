"""Make the pages on which an exported controller and shield run in the reader's browser.

    python docs/browser/make_page.py

clang and wasm-ld (on Debian: ``apt-get install clang lld``) compile the C that `iiwa_dnn.export`
writes, and `page.c` or `shield_page.c` beside this file, to WebAssembly. A page needs nothing else:
it holds the code, the scripts beside this file, and what is needed to draw the arm. Both are kept
in the repository, and `make docs` copies them.
"""

import base64
import json
import subprocess
import sys
import tempfile
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

import iiwa_dnn
from iiwa_dnn.files import write_text
from iiwa_dnn.robot.collision import collision_model
from iiwa_dnn.robot.shapes import visual_shapes
from iiwa_dnn.step.requests import Request

HERE = Path(__file__).parent
HEART = ("q", "dq", "target", "begin", "step", "ball")
SHIELD = (
    "q",
    "dq",
    "target",
    "begin",
    "step",
    "request",
    "ball",
    "seen",
    "see",
    "sample",
    "follow",
)
SHIELD += ("count_limits", "limit_name", "stopping_time", "separation", "torque")
"""What a page reaches by its name."""

FLAGS = ("--target=wasm32", "-std=c99", "-Os", "-nostdlib", "-nostdlibinc", "-fno-math-errno")
BALL = (0.52, -0.0625, 0.6875)
RADIUS = 0.08
DISTANCE = 0.02
"""Center, radius and least distance of the ball [m]."""

HAND: dict[str, Any] = {
    "name": "hand",
    "center": (-0.7, 0.3, 0.95),
    "near": (0.45, 0.2, 0.55),
    "radius": 0.06,
    "distance": DISTANCE,
    "speed": 1.6,
    "every": 33,
    "late": 50,
    "latency": 0.084,
}
"""A hand: where it waits and where it goes to, radius and least distance [m], largest speed [m/s];
periods between two frames of a camera and until one arrives, largest age of a frame [s]."""

WEIGHTS = (0.0, 7.0, 14.0)
WEIGHT_CENTER = (0.0, 0.0, 0.07)
"""Masses [kg] and their center in the frame of the flange [m]."""

IRON = 7870.0  # [kg/m^3]
JERK = 500.0  # [rad/s^3]

WORDS = {
    "heart": {
        "TITLE": "An arm within its limits, computed in this browser",
        "OTHER": 'If something else drives your arm: <a href="shield-live.html">a shield.</a>',
        "BUTTON": "Draw the heart",
        "SCRIPT": "heart.js",
    },
    "shield-live": {
        "TITLE": "A shield: the arm keeps its limits, whatever is asked",
        "OTHER": 'The same with a target to reach: <a href="heart.html">a controller.</a>',
        "BUTTON": "Begin again",
        "SCRIPT": "shield.js",
    },
}
"""The pages by their files, and what they say."""


def heart_controller() -> tuple[iiwa_dnn.Controller, np.ndarray]:
    """Return the controller of a heart at 1 ms, and where it begins, (7,) [rad]."""
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(jerk=JERK)
    q0 = np.array(robot.start_posture())
    heart = iiwa_dnn.Heart(scale=7e-3, period=8.0).anchored(iiwa_dnn.Configuration(robot, q0))
    ball = iiwa_dnn.Sphere(BALL, RADIUS)
    limits = (
        iiwa_dnn.AccelerationLimits(),
        iiwa_dnn.JerkLimits(),
        iiwa_dnn.CollisionAvoidance([ball], self_collision=False, distance=DISTANCE),
    )
    scheme = iiwa_dnn.DoubleIndicator(extra_limits=limits)
    return iiwa_dnn.Controller(robot, scheme, heart, dt=1e-3), q0


def shields() -> tuple[dict[str, iiwa_dnn.Shield], np.ndarray]:
    """Return shields of the same arm by the names of their tables, and where it begins, (7,) [rad].

    One is beside the same ball, one beside a person, and each of the others carries a weight.
    """
    controller, q0 = heart_controller()
    robot, dt = controller.robot, controller.dt
    ball = iiwa_dnn.Sphere(BALL, RADIUS)
    made = {
        "beside_ball": iiwa_dnn.Shield(robot, dt, [ball], distance=DISTANCE),
        "beside_person": iiwa_dnn.Shield(
            robot,
            dt,
            [],
            distance=DISTANCE,
            people=1,
            field=3.0,
            people_speed=HAND["speed"],
            latency=HAND["latency"],
        ),
    }
    for mass in WEIGHTS:
        carrying = iiwa_dnn.Shield(robot.with_payload(mass, WEIGHT_CENTER), dt, [])
        carrying.limits += (iiwa_dnn.TorqueLimits(),)
        made[f"carrying_{mass:g}"] = carrying
    return made, q0


def scenes(names: Sequence[str]) -> str:
    """Write the header of several tables, for memory that is large enough for each."""
    lines = [f'#include "{name}.h"' for name in names]
    listed = ", ".join(f"&{name}" for name in names)
    lines.append(f"static const struct armstep_tables *const scenes[] = {{{listed}}};")
    for size in ("JOINTS", "MEMORY", "SCRATCH", "LIMITS"):
        largest = "0"
        for name in names:
            own = f"{name.upper()}_{size}"
            largest = f"({own} > {largest} ? {own} : {largest})"
        lines.append(f"enum {{ SCENES_{size} = {largest} }};")
    return "\n".join(lines) + "\n"


def compiled(
    exported: Mapping[str, iiwa_dnn.Controller | iiwa_dnn.Shield],
    q0: np.ndarray,
    page: str,
    names: Sequence[str],
) -> bytes:
    """Export controllers or shields by name and compile them with their page for a browser."""
    with tempfile.TemporaryDirectory() as place:
        for name, each in exported.items():
            folder = iiwa_dnn.export.c99(each, place, q0, name=name)
        tables = [folder / f"{name}.c" for name in exported]
        (folder / "scenes.h").write_text(scenes(list(exported)))
        result = folder / "page.wasm"
        sources = (folder / "armstep.c", *tables, HERE / page, HERE / "memory.c")
        linked = (
            "no-entry",
            "strip-all",
            "allow-undefined",
            *(f"export={name}" for name in names),
        )
        command = ["clang", *FLAGS, f"-I{HERE}", f"-I{folder}", *map(str, sources)]
        command += [f"-Wl,--{option}" for option in linked]
        subprocess.run([*command, "-o", str(result)], check=True)
        return result.read_bytes()


def drawn(controller: iiwa_dnn.Controller, q0: np.ndarray) -> dict[str, Any]:
    """Return what a page draws: the arm's joints and limits, the path."""
    robot = controller.robot
    model = robot.model
    data = model.createData()
    pin.forwardKinematics(model, data, np.ones(robot.dof))
    joints = []
    for placement, moved in zip(list(model.jointPlacements)[1:], list(data.liMi)[1:], strict=True):
        joints.append(
            {
                "rotation": placement.rotation.ravel().tolist(),
                "translation": placement.translation.tolist(),
                "axis": pin.log3(placement.rotation.T @ moved.rotation).tolist(),
            }
        )
    path = controller.reference
    assert isinstance(path, iiwa_dnn.Reference)
    times = np.linspace(0.0, path.duration, 200)
    return {
        "joints": joints,
        "tip": model.frames[robot.frame_id(robot.tip)].placement.translation.tolist(),
        "start": q0.tolist(),
        "lower": robot.q_lower.tolist(),
        "upper": robot.q_upper.tolist(),
        "limits": robot.dq_max.tolist(),
        "acceleration": robot.ddq_max.tolist(),
        "jerk": robot.dddq_max.tolist(),
        "dt": controller.dt,
        "path": [path.at(t).position.round(5).tolist() for t in times],
        "ball": {"name": "ball", "center": BALL, "radius": RADIUS, "distance": DISTANCE},
        "shapes": shapes(robot),
        "capsules": capsules(robot),
    }


def shapes(robot: iiwa_dnn.Robot) -> list[dict[str, Any]]:
    """List what the arm is drawn with: cylinders, capsules and balls along an axis of a joint."""
    listed = []
    for each in visual_shapes(robot).geometryObjects:
        body = each.geometry
        half = float(getattr(body, "halfLength", 0.0))
        axis = half * each.placement.rotation[:, 2]
        ends = (each.placement.translation - axis, each.placement.translation + axis)
        listed.append(
            {
                "joint": each.parentJoint,
                "round": type(body).__name__ != "Cylinder",
                "radius": float(body.radius),
                "ends": [end.round(6).tolist() for end in ends],
                "color": each.meshColor[:3].round(3).tolist(),
            }
        )
    return listed


def capsules(robot: iiwa_dnn.Robot) -> list[dict[str, Any]]:
    """List the capsules that the limits know, in the frames of their joints."""
    listed = []
    for link, each in collision_model(robot).capsules:
        frame = robot.model.frames[robot.frame_id(link)]
        ends = [frame.placement.act(np.array(end)).round(6).tolist() for end in (each.a, each.b)]
        listed.append(
            {"joint": frame.parentJoint, "link": link, "ends": ends, "radius": each.radius}
        )
    return listed


def write_page(name: str, code: bytes, model: dict[str, Any]) -> None:
    """Write a page by its name, with its code and what it draws."""
    scripts = ("arm.js", WORDS[name]["SCRIPT"], "drawing.js", "page.js")
    words = {
        "SCRIPTS": "\n".join((HERE / script).read_text() for script in scripts),
        **WORDS[name],
        "NEAR": f"{1e3 * DISTANCE:g}",
        "SIZE": f"{len(code) / 1e3:.0f}",
        "MODEL": json.dumps(model),
        "DEFLATED": base64.b64encode(zlib.compress(code, 9)).decode(),
    }
    text = (HERE / "page.in.html").read_text()
    for word, value in words.items():
        text = text.replace(f"@{word}@", value)
    path = HERE.parent / f"{name}.html"
    write_text(path, text)
    print(f"{path.name}: {len(code)} bytes of code, {path.stat().st_size} in all")


def main() -> int:
    """Write both pages."""
    controller, q0 = heart_controller()
    model = drawn(controller, q0)
    write_page("heart", compiled({"arm": controller}, q0, "page.c", HEART), model)
    told = {
        "path": [],
        "hand": HAND,
        "kinds": {kind.name: kind.value for kind in Request},
        "weights": WEIGHTS,
        "weight_center": WEIGHT_CENTER,
        "weight_radius": round((0.75 / np.pi / IRON) ** (1 / 3), 5),  # of 1 kg
    }
    write_page("shield-live", compiled(shields()[0], q0, "shield_page.c", SHIELD), model | told)
    return 0


if __name__ == "__main__":
    sys.exit(main())
