"""The folder of an exported controller: code, vectors of a run, a test, examples."""

import copy
import json
import os
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.control.command import PLACEMENT
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.shield import Shield
from iiwa_dnn.errors import MissingDependencyError
from iiwa_dnn.export.code import code_of, filled
from iiwa_dnn.export.load import tested
from iiwa_dnn.files import plain, prepare_folder, write_csv, write_text
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.references import Lissajous, Reference
from iiwa_dnn.robot import Configuration

STEPS = 500
"""Steps of the vectors."""

_FILES = (
    "controller.h",
    "controller.c",
    "test_controller.c",
    "Makefile",
    "example.c",
    "example_fri.cpp",
    "README.md",
)


class Vectors(NamedTuple):
    """A run of a controller in closed loop with an arm that follows every command.

    Attributes:
        t: Times [s], (k,).
        q: Joint positions [rad], (k, n).
        targets: Targets of all frames, (k, 18 frames).
        dq: Commands [rad/s], (k, n).
        actions: Actions, (k,).
    """

    t: Vector
    q: Matrix
    targets: Matrix
    dq: Matrix
    actions: Vector

    @property
    def table(self) -> Matrix:
        """All columns, (k, 2 n + 18 frames + 2)."""
        return np.column_stack(list(self))


def c99(
    controller: Controller | Shield,
    folder: str | os.PathLike[str],
    q0: ArrayLike | None = None,
    *,
    verify: bool = True,
) -> Path:
    """Write a controller, or a shield for joint velocities, as a folder of C99.

    Args:
        controller: The controller or shield; it stays as it is.
        folder: The folder; files of an earlier export are overwritten.
        q0: Joint positions where the arm begins [rad], (n,): the home of a scheme without one, and
            the beginning of the vectors; None: where the controller is, or the start posture.
        verify: Whether the C code is compiled, where there is a compiler, and compared with the
            vectors; what comes out is in ``README.md``.

    Returns:
        The folder.

    Raises:
        InvalidInputError: A part of the controller is not compiled or cannot be translated; it is
            named.
        FileError: The folder cannot be written.
    """
    shield = controller if isinstance(controller, Shield) else None
    own = controller.controller() if isinstance(controller, Shield) else controller
    twin, start = _anchored(own, q0)
    texts = code_of(twin, shield)
    texts["shield_declaration"] = ""
    if shield is not None:
        texts["shield_declaration"] = filled("shield.h", {"timeout": shield.settings[1]})
    vectors = run(twin, start.q, STEPS)
    folder = prepare_folder(folder)
    texts |= _texts(twin, start, vectors, texts["has_reference"])
    write_csv(folder / "vectors.csv", _head(twin), vectors.table)
    for name in _FILES:
        write_text(folder / name, filled(name, texts | {"verified": "not yet: `make test`"}))
    with suppress(MissingDependencyError):
        if verify:
            write_text(
                folder / "README.md", filled("README.md", texts | {"verified": tested(folder)})
            )
    return folder


def _anchored(controller: Controller, q0: ArrayLike | None) -> tuple[Controller, Configuration]:
    """Return a copy of a controller at rest in its first posture, and that posture."""
    twin = copy.copy(controller)
    posture: ArrayLike = twin.robot.start_posture() if q0 is None else q0
    if q0 is None and controller.begun:
        posture = controller.positions
    q = checks.finite_array("q0", posture, (twin.robot.dof,))
    start = Configuration(twin.robot, q)
    twin.reset()
    twin.anchor(start)
    return twin, start


def run(controller: Controller, q0: Vector, steps: int) -> Vectors:
    """Run a controller from joint positions q0 (n,) [rad] for a number of steps.

    Without a reference its frames follow a small figure of eight.
    """
    twin = copy.copy(controller)
    dt = twin.dt
    if twin.reference is None:
        start = Configuration(twin.robot, q0)
        figure = Lissajous((0.01, 0.01, 0.0))
        names = twin.program.target_frames
        paths: dict[str, Reference] = {name: figure.anchored(start.frame(name)) for name in names}
        twin.reference = paths
    q = q0.copy()
    rows = []
    for k in range(steps):
        targets = twin.targets(k * dt - twin.delay)
        command = twin.step(q, k * dt)
        rows.append((k * dt, q, targets.ravel(), command.dq, float(command.action)))
        q = q + dt * command.dq
    return Vectors(*(np.array(column) for column in zip(*rows, strict=True)))


def _head(controller: Controller) -> list[str]:
    dof = controller.robot.dof
    numbers = 18 * len(controller.program.target_frames)
    joints = [f"q{i + 1}" for i in range(dof)]
    rates = [f"dq{i + 1}" for i in range(dof)]
    return ["t", *joints, *(f"target{k + 1}" for k in range(numbers)), *rates, "action"]


def _texts(
    controller: Controller, start: Configuration, vectors: Vectors, has_reference: bool
) -> dict[str, Any]:
    """Return the texts of the templates that are about the run and the settings."""
    robot = controller.robot
    tip = controller.program.target_frames[0]
    limits = np.where(robot.dq_max < np.inf, robot.dq_max, 1.0)
    settings = plain(settings_of(controller))
    sample = "        controller_target(&c, k * CONTROLLER_DT, target);\n"
    sample_of_fri = "        controller_target(&controller_, t_, target);\n"
    reference = {"reference": json.dumps(settings["reference"])}
    return {
        "steps": len(vectors.t),
        "velocity_limits": _numbers(limits),
        "tolerance": f"{10.0 * controller.solver.tol:g}",
        "q0": _numbers(start.q),
        "target": _numbers(vectors.targets[0]),
        "tip": PLACEMENT * robot.frame_id(tip) + 9,
        "tip_name": tip,
        "sample": sample * has_reference,
        "fri_sample": sample_of_fri * has_reference,
        "usage": "controller_target(&c, t, target);  /* the reference */\n" * has_reference,
        "target_declaration": filled("target.h", reference) * has_reference,
        "settings": json.dumps(settings, indent=2),
        "what_systems": "linear systems" if controller.mode == "converged" else "sub-steps",
    }


def _numbers(values: Vector) -> str:
    return ", ".join(map(repr, values.tolist()))


def settings_of(controller: Controller) -> dict[str, Any]:
    """Return the settings of a controller, as values that JSON can hold."""
    robot = controller.robot
    reference: Any = controller.reference
    solver = controller.solver
    if isinstance(reference, Reference):
        reference = reference.settings()
    elif reference is not None:
        reference = {name: path.settings() for name, path in reference.items()}
    return {
        "robot": robot.name,
        "tip": robot.tip,
        "locked": robot.locked,
        "q_lower": robot.q_lower,
        "q_upper": robot.q_upper,
        "dq_max": robot.dq_max,
        "dt": controller.dt,
        "mode": controller.mode,
        "policy": controller.policy,
        "tolerance": solver.tol,
        "network": solver.network.settings(),
        "reference": reference,
        "scheme": controller.scheme.settings(),
    }
