"""Make the pages on which an exported controller and shield run in the reader's browser.

    python docs/browser/make_page.py

clang and wasm-ld (on Debian: ``apt-get install clang lld``) compile the C that `iiwa_dnn.export`
writes, and `page.c` or `shield_page.c` beside this file, to WebAssembly. A page needs nothing else:
it holds the code, and what is needed to draw the arm. Both are kept in the repository, and
`make docs` copies them.
"""

import base64
import json
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

import iiwa_dnn
from iiwa_dnn.files import write_text
from iiwa_dnn.robot.collision import collision_model
from iiwa_dnn.robot.shapes import visual_shapes

HERE = Path(__file__).parent
TABLE = "arm_numbers"
"""Numbers of the C among which the ball's center lies; the page writes there as a hand moves it."""

HEART = ("q", "dq", "target", "begin", "step", TABLE)
SHIELD = ("q", "dq", "target", "begin", "step", "twist", "ball")
SHIELD += ("count_limits", "limit_name", "stopping_time")
"""What a page reaches by its name."""

FLAGS = ("--target=wasm32", "-std=c99", "-Os", "-nostdlib", "-nostdlibinc", "-fno-math-errno")
BALL = (0.52, -0.0625, 0.6875)
RADIUS = 0.08
DISTANCE = 0.02
"""Center, radius and least distance of the ball [m]."""

JERK = 500.0  # [rad/s^3]

WORDS = {
    "heart": {
        "TITLE": "An arm within its limits, computed in this browser",
        "HANDS": "Drag the red target or the blue ball.",
        "OTHER": 'If something else drives your arm: <a href="shield-live.html">a shield.</a>',
        "BUTTON": "Draw the heart",
        "NOTE": "Out of reach the arm comes as near as it can.",
    },
    "shield-live": {
        "TITLE": "A shield: whatever is requested, the arm keeps its limits",
        "HANDS": "Drag the red handle, which pulls at the tip of the arm, or the blue ball.",
        "OTHER": 'The same with a target to reach: <a href="heart.html">a controller.</a>',
        "BUTTON": "Let the handle roam",
        "NOTE": "The handle requests a velocity of the tip, 6/s times its distance.",
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


def pulled_shield() -> tuple[iiwa_dnn.Shield, np.ndarray]:
    """Return the shield of the same arm beside the same ball, and where it begins, (7,) [rad]."""
    controller, q0 = heart_controller()
    ball = iiwa_dnn.Sphere(BALL, RADIUS)
    return iiwa_dnn.Shield(controller.robot, 1e-3, obstacles=[ball], distance=DISTANCE), q0


def opened(code: str) -> str:
    """Let the page write into the table of constants of exported C.

    Raises:
        ValueError: The C has no such table.
    """
    end = code.index(f"}} {TABLE} = {{")
    start = code.rindex("static const struct {", 0, end)
    return code[:start] + code[start:].removeprefix("static const ")


def compiled(
    exported: iiwa_dnn.Controller | iiwa_dnn.Shield, q0: np.ndarray, page: str, names: Sequence[str]
) -> bytes:
    """Export a controller or a shield and compile it with its page for a browser."""
    with tempfile.TemporaryDirectory() as place:
        folder = iiwa_dnn.export.c99(exported, place, q0, name="arm")
        result = folder / "page.wasm"
        source = folder / "arm.c"
        if TABLE in names:
            source.write_text(opened(source.read_text()))
        sources = (folder / "armstep.c", source, HERE / page, HERE / "memory.c")
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
        "ball": {"center": BALL, "radius": RADIUS, "distance": DISTANCE},
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
        listed.append({"joint": frame.parentJoint, "ends": ends, "radius": each.radius})
    return listed


def write_page(name: str, code: bytes, model: dict[str, Any]) -> None:
    """Write a page by its name, with its code and what it draws."""
    words = {
        **WORDS[name],
        "TABLE": TABLE,
        "NEAR": f"{1e3 * DISTANCE:g}",
        "SIZE": f"{len(code) / 1e3:.0f}",
        "SHIELD": "true" if name == "shield-live" else "false",
        "MODEL": json.dumps(model),
        "WASM": base64.b64encode(code).decode(),
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
    write_page("heart", compiled(controller, q0, "page.c", HEART), model)
    code = compiled(pulled_shield()[0], q0, "shield_page.c", SHIELD)
    write_page("shield-live", code, {**model, "path": []})
    return 0


if __name__ == "__main__":
    sys.exit(main())
