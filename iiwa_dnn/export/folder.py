"""The folder of an exported controller: code, vectors of a run, a test, examples."""

import copy
import json
import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.paths import by_frame
from iiwa_dnn.control.shield import Shield
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.export.code import code_of, filled
from iiwa_dnn.files import plain, prepare_folder, write_csv, write_text
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.references import Lissajous
from iiwa_dnn.robot import Configuration
from iiwa_dnn.schemes.step import TARGET_SIZE

STEPS = 500
"""Steps of the vectors."""

_POSE = np.repeat([1.0, 0.0], [12, 6])
"""1 for the numbers of a target's pose, 0 for those of its velocities."""

_FILES = (
    "controller.h",
    "controller.c",
    "test_controller.c",
    "Makefile",
    "example.c",
    "example_fri.cpp",
    "README.md",
)

_TARGETS = {
    "call": "controller_step",
    "input": "target",
    "numbers": "18 * CONTROLLER_FRAMES",
    "input_words": "`target` has 18 numbers for each tracked frame:\nposition [m], rotation row "
    "by row, linear velocity [m/s], angular velocity [rad/s], along the axes\nof the robot's base.",
}
_REQUESTS = {
    "call": "shield_step",
    "input": "request",
    "numbers": "CONTROLLER_DOF",
    "target": "0.0",
    "sample": "        request[0] = 0.1; /* where requests come from */\n",
    "input_words": "`request` is the joint velocity to come near\n[rad/s], NULL for no new one.",
}
"""What a step takes beside joint positions: the texts about a controller, and about a shield."""


def c99(
    controller: Controller | Shield,
    folder: str | os.PathLike[str],
    q0: ArrayLike | None = None,
) -> Path:
    """Write a controller, or a shield for joint velocities, as a folder of C99.

    Args:
        controller: The controller or shield; it stays as it is.
        folder: The folder; files of an earlier export are overwritten.
        q0: Joint positions where the arm begins [rad], (n,): the home of a scheme without one, and
            the beginning of the vectors; None: where the controller is, or the start posture.

    Returns:
        The folder.

    Raises:
        InvalidInputError: A part of the controller is not compiled or cannot be translated; it is
            named.
        FileError: The folder cannot be written.
    """
    shield = controller if isinstance(controller, Shield) else None
    if controller.longest_period is not None or (shield and shield.delay > 0.0):
        raise InvalidInputError("controller", "with longest_period or delay has no C", controller)
    own = controller.controller() if isinstance(controller, Shield) else controller
    twin = copy.copy(own)
    start = Configuration(twin.robot, own.positions if q0 is None else q0)
    twin.reset()
    twin.anchor(start)
    texts = code_of(twin, shield)
    rows = run(twin, start.q, STEPS)
    folder = prepare_folder(folder)
    texts |= _texts(twin, start, rows[0], texts["has_reference"])
    texts |= _TARGETS if shield is None else _REQUESTS
    counts = {"q": texts["dof"], "target": 18 * texts["frames"], "dq": texts["dof"]}
    names = [f"{name}{i + 1}" for name, count in counts.items() for i in range(count)]
    write_csv(folder / "vectors.csv", ["t", *names, "action"], rows)
    for name in _FILES:
        write_text(folder / name, filled(name, texts))
    return folder


def run(controller: Controller, q0: Vector, steps: int) -> Matrix:
    """Run a controller from joint positions q0 (n,) [rad], with an arm that follows every command.

    Without a reference its frames follow a small figure of eight.

    Returns:
        Rows of the time [s], joint positions, targets of all frames, the command and the action.
    """
    twin = copy.copy(controller)
    if twin.reference is None:
        start = Configuration(twin.robot, q0)
        twin.reference = {
            name: Lissajous((0.01, 0.01, 0.0), begin=0.0).anchored(start.frame(name))
            for name in twin.program.target_frames
        }
    q = q0.copy()
    rows = []
    for k in range(steps):
        t = k * twin.dt
        targets = twin.targets(t - twin.path_lag)
        command = twin.step(q, t)
        rows.append(np.concatenate([[t], q, targets.ravel(), command.dq, [float(command.action)]]))
        q = q + twin.dt * command.dq
    return np.array(rows)


def _texts(
    controller: Controller, start: Configuration, first: Vector, has_reference: bool
) -> dict[str, Any]:
    """Return the texts that are about the settings and a run, whose first row is given."""
    robot = controller.robot
    paths = by_frame(controller.reference, controller.program.target_frames[0])
    resting = first[1 + robot.dof : -1 - robot.dof].reshape(-1, TARGET_SIZE) * _POSE
    settings = {
        "q_lower": robot.q_lower,
        "q_upper": robot.q_upper,
        "dq_max": robot.dq_max,
        "mode": controller.mode,
        "policy": controller.policy,
        "tolerance": controller.solver.tol,
        "network": controller.solver.network.settings(),
        "reference": {name: path.settings() for name, path in paths.items()},
        "scheme": controller.scheme.settings(),
    }
    return {
        "steps": STEPS,
        "velocity_limits": _numbers(np.where(robot.dq_max < np.inf, robot.dq_max, 1.0)),
        "tolerance": f"{10.0 * controller.solver.tol:g}",
        "q0": _numbers(start.q),
        "target": _numbers(resting.ravel()),
        "sample": "        controller_target(&c, k * CONTROLLER_DT, target);\n" * has_reference,
        "fri_sample": "        controller_target(&controller_, t_, target);\n" * has_reference,
        "usage": "controller_target(&c, t, target);  /* the reference */\n" * has_reference,
        "target_declaration": filled("target.h", {}) * has_reference,
        "settings": json.dumps(plain(settings), indent=2),
    }


def _numbers(values: Vector) -> str:
    return ", ".join(map(repr, values.tolist()))
