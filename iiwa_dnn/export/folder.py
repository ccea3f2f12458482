"""Write folders of exports: code, recorded steps, a program that compares them, examples."""

import copy
import json
import keyword
import math
import os
import re
import subprocess
import sys
from collections.abc import Sequence
from enum import IntEnum
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.paths import by_frame
from iiwa_dnn.control.policies import Action, ProgramKind
from iiwa_dnn.control.requests import TWIST, Reason, Request
from iiwa_dnn.control.shield import Shield
from iiwa_dnn.control.shields import Shields
from iiwa_dnn.errors import FileError, InvalidInputError, MissingDependencyError, NotFoundError
from iiwa_dnn.export.code import PARTS, TEMPLATES, controller_code, filled, shield_code
from iiwa_dnn.export.cuda import write_cuda
from iiwa_dnn.files import plain, prepare_folder, write_csv, write_text
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.references import Lissajous
from iiwa_dnn.robot import Configuration
from iiwa_dnn.robot.kinematics_kernel import model_tables, write_kinematics
from iiwa_dnn.schemes.step import TARGET_SIZE

STEPS = 500
"""Steps of the vectors."""

VECTORS = "vectors.csv"
"""File that every export holds: steps of a run."""

PLATFORMS = {
    "linux_x86_64": "x86_64-linux-gnu.2.17",
    "linux_aarch64": "aarch64-linux-gnu.2.17",
    "windows_x86_64": "x86_64-windows-gnu",
    "windows_aarch64": "aarch64-windows-gnu",
    "macos_x86_64": "x86_64-macos.10.13",
    "macos_aarch64": "aarch64-macos.11.0",
}
"""Targets of zig by the machines that a wheel may be for."""

_POSE = np.repeat([1.0, 0.0], [12, 6])
"""1 for the numbers of a target's pose, 0 for those of its velocities."""


def c99(
    made: Controller | Shield,
    folder: str | os.PathLike[str],
    q0: ArrayLike | None = None,
    overwrite: bool = False,
) -> Path:
    """Write a controller or a shield as a folder of C99.

    Args:
        made: The controller or shield, which is not changed. A shield takes twists of its
            robot's tip.
        folder: The folder, which is new, empty, or holds an earlier export, whose files are
            overwritten.
        q0: Joint positions [rad], (n,), at which the recorded steps begin, and which are the home
            of a scheme that states none; None: the controller's positions, or the start posture of
            a shield's robot.
        overwrite: Write into a folder that holds other files too.

    Returns:
        The folder.

    Raises:
        InvalidInputError: A part of the controller is not compiled or has no translation; the
            part is named.
        FileError: The folder holds other files, or cannot be written.
    """
    texts = _texts(made, None, q0)
    folder = _claimed(folder, VECTORS, overwrite)
    write_csv(folder / VECTORS, *texts["vectors"])
    for path in _templates("c", texts["kind"]):
        write_text(folder / path.name, filled(path, texts))
    return folder


def _claimed(folder: str | os.PathLike[str], mark: str, overwrite: bool) -> Path:
    """Make the folder of an export, and return its path.

    Raises:
        FileError: Without `overwrite`, the folder holds files, and none matches the pattern
            `mark`; or it cannot be written.
    """
    folder = Path(folder)
    if not overwrite and any(folder.glob("[!.]*")) and not any(folder.glob(mark)):
        problem = "holds other files than an export: choose another folder, or overwrite=True"
        raise FileError(folder, problem)
    return prepare_folder(folder)


def _templates(*folders: str) -> list[Path]:
    """List the templates in some folders of templates."""
    return [path for folder in folders for path in sorted((TEMPLATES / folder).iterdir())]


def python(
    made: Controller | Shield,
    folder: str | os.PathLike[str],
    name: str,
    frame: str | None = None,
    q0: ArrayLike | None = None,
    platforms: Sequence[str] = (),
    cuda: bool = False,
    overwrite: bool = False,
) -> Path:
    """Write a controller or a shield as a package of Python that needs numpy alone.

    ``pip install folder`` compiles the package on the machine where it runs. With `platforms` it is
    compiled here by zig (``pip install ziglang``), and one wheel serves all of them.

    Args:
        made: The controller or shield, which is not changed.
        folder: The folder of the project, as for `c99`.
        name: Name by which the package is imported.
        frame: Frame of a shield's twists; None stands for the tip.
        q0: As for `c99`.
        platforms: Machines of `PLATFORMS`, or ``"all"``.
        cuda: Write a shield's ``Shields(count, device="cuda")`` too, compiled where it is used.
        overwrite: As for `c99`.

    Returns:
        The folder.

    Raises:
        InvalidInputError: The name is no package's, or a part has no C; the part is named.
        NotFoundError: There is no such frame or platform.
        MissingDependencyError: `platforms` are given, and ziglang is not installed.
        FileError: The folder holds other files, or cannot be written.
    """
    if not re.fullmatch("[a-z][a-z0-9_]*", name):
        raise InvalidInputError("name", f"must be small letters, digits and _, not {name!r}", name)
    if keyword.iskeyword(name):
        problem = f"must be no keyword of Python, as {name!r} is: no module can be imported by it"
        raise InvalidInputError("name", problem, name)
    texts = _texts(made, frame, q0) | {"name": name, "package_version": "0.1.0"}
    kind = texts["kind"]
    if cuda and kind != "shield":
        raise InvalidInputError("cuda", "is for a shield", made)
    texts["extras"] = filled(PARTS / "cuda.toml", {}) * cuda
    package = prepare_folder(_claimed(folder, f"*/{VECTORS}", overwrite) / name)
    write_csv(package / VECTORS, *texts["vectors"])
    sources = [TEMPLATES / kind / f"{kind}{end}" for end in (".c", ".h")]
    for path in (*sources, *_templates("python", f"python_{kind}")):
        is_outer = path.name in ("README.md", "hatch_build.py.in", "pyproject.toml.in")
        place = package.parent if is_outer else package
        write_text(place / path.name.removesuffix(".in"), filled(path, texts))
    if cuda:
        write_cuda(package, texts)
    for platform in PLATFORMS if "all" in platforms else platforms:
        _compile_for(package, kind, platform)
    return package.parent


def _compile_for(package: Path, kind: str, platform: str) -> None:
    """Compile the library of a package for a platform, by zig."""
    if platform not in PLATFORMS:
        raise NotFoundError("platform", platform, PLATFORMS)
    if not find_spec("ziglang"):
        raise MissingDependencyError("ziglang", "pip install ziglang")
    flags = ("-std=c99", "-O2", "-ffp-contract=off", "-fno-math-errno", "-shared", "-fPIC", "-s")
    output = package / f"_library_{platform}.bin"
    words = [sys.executable, "-m", "ziglang", "cc", "-target", PLATFORMS[platform], *flags]
    done = subprocess.run(
        [*words, str(package / f"{kind}.c"), "-o", str(output), "-lm"],
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode:
        raise FileError(output, done.stderr[:500])
    for other in package.glob(f"_library_{platform}.*"):  # what a linker leaves beside it
        if other != output:
            other.unlink()


def _texts(made: Controller | Shield, frame: str | None, q0: ArrayLike | None) -> dict[str, Any]:
    """Return the texts of a controller or a shield for the templates, and recorded steps."""
    if isinstance(made, Shield):
        texts = _shield_texts(made, frame, q0)
    else:
        texts = _controller_texts(checks.instance("made", made, Controller), q0)
    robot = made.robot
    words = ("lower", "upper", "velocity", "acceleration", "jerk")
    own = (*robot.limits[:2], robot.dq_max, robot.ddq_max, robot.dddq_max)
    limits = {word: values.tolist() for word, values in zip(words, own, strict=True)}
    return texts | {
        "Kind": texts["kind"].capitalize(),
        "call": filled(PARTS / f"{texts['kind']}_call.c", texts),
        "steps": STEPS,
        "columns": len(texts["vectors"][0]),
        "velocity_limits": _numbers(np.where(robot.dq_max < np.inf, robot.dq_max, 1.0)),
        "joints": repr(tuple(robot.joint_names)),
        "joint_limits": re.sub(r"\binf\b", "np.inf", repr(limits)),
    }


def _names(**counts: int) -> list[str]:
    """Return names of columns: each name with the numbers from 1 to its count."""
    return [f"{name}{i + 1}" for name, count in counts.items() for i in range(count)]


def _shield_texts(shield: Shield, frame: str | None, q0: ArrayLike | None) -> dict[str, Any]:
    """Return the texts of a shield, and recorded steps with requests of all kinds.

    Raises:
        NotFoundError: There is no such frame.
    """
    robot = shield.robot
    tip = frame or robot.tip
    texts = shield_code(shield, tip)
    start = Configuration(robot, robot.start_posture() if q0 is None else q0).q
    width = max(robot.dof, TWIST)
    n = robot.dof
    names = _names(q=n, kind=1, dt=1, request=width, dq=n, reason=1)
    return texts | {
        "tolerance": "0.0",
        "q0": _numbers(start),
        "longest_or_none": repr(shield.longest_period),
        "reason_members": _members(Reason),
        "vectors": (names, _shield_run(shield, tip, start, width)),
    }


def _members(kind: type[IntEnum]) -> str:
    """Write the members of an enumeration in Python."""
    return "\n".join(f"    {each.name} = {each.value}" for each in kind)


def _shield_run(shield: Shield, frame: str, q: Vector, width: int) -> Matrix:
    """Record steps of a shield with requests of all kinds: new, repeated, missing, not finite.

    The arm moves as commanded, late by the shield's `delay`. Requests have `width` numbers.

    Returns:
        Rows of the joint positions, kind of the request, stated period [s], the request, the
        command and its reason.
    """
    random = np.random.default_rng(0)
    arms = Shields(shield, frame=frame)
    kinds = [Request.VELOCITY, Request.TWIST, Request.POSITION, Request.NONE]
    late = math.ceil(shield.delay / shield.dt)
    path = [q] * (1 + late)
    rows = []
    request: Vector = np.zeros(width)
    kind = Request.NONE
    for k in range(STEPS):
        if k % 25 == 0:
            kind = kinds[k // 25 % 4]
            request = random.standard_normal(width)
            if kind == Request.POSITION:
                request[: q.size] = q + 0.2 * request[: q.size]
            request[0] = np.inf if k == 200 else request[0]
        period = 0.5 * shield.dt if k % 10 == 7 and shield.longest_period is None else 0.0
        asked = request[np.newaxis]
        command = arms.step(
            q[np.newaxis],
            asked[:, : q.size] if kind == Request.VELOCITY else None,
            twist=asked[:, :TWIST] if kind == Request.TWIST else None,
            position=asked[:, : q.size] if kind == Request.POSITION else None,
            dt=period or None,
        )
        own = [q, [float(kind), period], request, command.dq[0], [float(command.reason[0])]]
        rows.append(np.concatenate(own))
        path.append(command.next_q[0])
        q = path[1 + k] + (0.05 if k == 300 else 0.0)
    return np.array(rows)


def take_exported_kinematics(controller: Controller) -> None:
    """Replace Pinocchio in a controller by the kinematics kernel that is exported."""
    own = controller.program.kinematics
    needs_inertia = controller.program.needs_inertia
    tables = model_tables(controller.robot, own.frame_ids, needs_inertia)
    own.update = lambda q: write_kinematics(  # type: ignore[method-assign]
        tables, np.ascontiguousarray(q), own.jacobian, own.placements, own.inertia
    )


def run(controller: Controller, q0: Vector, steps: int) -> Matrix:
    """Record steps of a controller, from joint positions q0 (n,) [rad]; the arm moves as commanded.

    A controller without a reference follows a small figure of eight. The kinematics are those of
    the exported C.

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
    take_exported_kinematics(twin)
    q = q0.copy()
    rows = []
    for k in range(steps):
        t = k * twin.dt
        targets = twin.targets(t - twin.path_lag)
        command = twin.step(q, t)
        rows.append(np.concatenate([[t], q, targets.ravel(), command.dq, [float(command.action)]]))
        q = q + twin.dt * command.dq
    return np.array(rows)


def _controller_texts(controller: Controller, q0: ArrayLike | None) -> dict[str, Any]:
    """Return the texts of a controller, and recorded steps.

    Raises:
        InvalidInputError: A part of the controller has no C; the part is named.
    """
    if controller.longest_period is not None:
        raise InvalidInputError("controller", "with longest_period has no C", controller)
    twin = copy.copy(controller)
    robot = twin.robot
    start = Configuration(robot, twin.positions if q0 is None else q0)
    twin.reset()
    twin.anchor(start)
    texts = controller_code(twin)
    rows = run(twin, start.q, STEPS)
    frames = twin.program.target_frames
    sampled = texts["has_reference"]
    paths = by_frame(twin.reference, frames[0])
    n = robot.dof
    resting = rows[0, 1 + n : -1 - n].reshape(-1, TARGET_SIZE) * _POSE
    settings = {
        "q_lower": robot.q_lower,
        "q_upper": robot.q_upper,
        "dq_max": robot.dq_max,
        "mode": twin.mode,
        "policy": twin.policy,
        "tolerance": twin.solver.tol,
        "network": twin.solver.network.settings(),
        "reference": {name: path.settings() for name, path in paths.items()},
        "scheme": twin.scheme.settings(),
    }
    return texts | {
        "vectors": (["t", *_names(q=n, target=18 * len(frames), dq=n), "action"], rows),
        "tolerance": f"{10.0 * twin.solver.tol:g}",
        "q0": _numbers(start.q),
        "target": _numbers(resting.ravel()),
        "sample": "        controller_target(&c, k * CONTROLLER_DT, target);\n" * sampled,
        "fri_sample": "        controller_target(&controller_, t_, target);\n" * sampled,
        "usage": "controller_target(&c, t, target);  /* the reference */\n" * sampled,
        "settings": json.dumps(plain(settings), indent=2),
        "frame_tuple": repr(tuple(frames)),
        "action_members": _members(Action),
        "program_members": _members(ProgramKind),
    }


def _numbers(values: Vector) -> str:
    """Write numbers one after another, all digits kept."""
    return ", ".join(map(repr, values.tolist()))
