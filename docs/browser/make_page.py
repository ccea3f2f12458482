"""Make the page on which the exported heart runs in the reader's browser.

    python docs/browser/make_page.py

clang and wasm-ld (on Debian: ``apt-get install clang lld``) compile the C that `iiwa_dnn.export`
writes, and `page.c` beside this file, to WebAssembly. The page needs nothing else: it holds the
code, and what is needed to draw the arm. It is kept in the repository, and `make docs` copies it.
"""

import base64
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

import iiwa_dnn
from iiwa_dnn.files import write_text

HERE = Path(__file__).parent
PAGE = HERE.parent / "heart.html"
EXPORTED = ("q", "dq", "target", "begin", "step")
FLAGS = ("--target=wasm32", "-std=c99", "-Os", "-nostdlib", "-nostdlibinc", "-fno-math-errno")


def heart_controller() -> tuple[iiwa_dnn.Controller, np.ndarray]:
    """Return the controller of the heart at 1 ms, and where it begins, (7,) [rad]."""
    robot = iiwa_dnn.load_robot("iiwa7")
    q0 = np.array(robot.start_posture())
    heart = iiwa_dnn.Heart().anchored(iiwa_dnn.Configuration(robot, q0))
    return iiwa_dnn.Controller(robot, iiwa_dnn.DoubleIndicator(), heart, dt=1e-3), q0


def compiled(controller: iiwa_dnn.Controller, q0: np.ndarray) -> bytes:
    """Export a controller and compile it for a browser."""
    with tempfile.TemporaryDirectory() as place:
        folder = iiwa_dnn.export.c99(controller, place, q0)
        result = folder / "controller.wasm"
        sources = (folder / "controller.c", HERE / "page.c")
        linked = (
            "no-entry",
            "strip-all",
            "allow-undefined",
            *(f"export={name}" for name in EXPORTED),
        )
        command = ["clang", *FLAGS, f"-I{HERE}", f"-I{folder}", *map(str, sources)]
        command += [f"-Wl,--{option}" for option in linked]
        subprocess.run([*command, "-o", str(result)], check=True)
        return result.read_bytes()


def drawn(controller: iiwa_dnn.Controller, q0: np.ndarray) -> dict[str, Any]:
    """Return what the page draws: the arm's joints and limits, the path."""
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
        "limits": robot.dq_max.tolist(),
        "dt": controller.dt,
        "path": [path.at(t).position.round(5).tolist() for t in times],
    }


def main() -> int:
    """Write the page."""
    controller, q0 = heart_controller()
    code = compiled(controller, q0)
    text = (HERE / "heart.in.html").read_text()
    text = text.replace("@SIZE@", f"{len(code) / 1e3:.0f}")
    text = text.replace("@MODEL@", json.dumps(drawn(controller, q0)))
    text = text.replace("@WASM@", base64.b64encode(code).decode())
    write_text(PAGE, text)
    print(f"{PAGE.name}: {len(code)} bytes of code, {PAGE.stat().st_size} in all")
    return 0


if __name__ == "__main__":
    sys.exit(main())
