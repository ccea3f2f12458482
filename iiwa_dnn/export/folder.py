"""Write folders of exports: the core, tables, recorded steps, a program that compares them."""

import copy
import json
import keyword
import math
import os
import re
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.compiling.sources import c_word
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.paths import by_frame
from iiwa_dnn.control.shield import Shield
from iiwa_dnn.control.shields import Shields
from iiwa_dnn.errors import FileError, InvalidInputError
from iiwa_dnn.export.arm_tables import Tables
from iiwa_dnn.export.core import LAID_OUT, RELEASE, TEMPLATES, core, filled
from iiwa_dnn.export.nodes import Node, braced, constant
from iiwa_dnn.files import prepare_folder, write_csv, write_text
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.references import Lissajous
from iiwa_dnn.robot import Configuration
from iiwa_dnn.robot.kinematics_kernel import model_tables, write_kinematics
from iiwa_dnn.schemes.step import TARGET_SIZE
from iiwa_dnn.step.requests import TWIST, Request

STEPS = 500
"""Steps of the vectors."""

VECTORS = "vectors.csv"
"""File that every export holds: steps of a run."""

RESERVED = ("armstep", "compare", "example", "main")
"""Names of other files of a folder, and of a program's function."""

_POSE = np.repeat([1.0, 0.0], [12, 6])
"""1 for the numbers of a target's pose, 0 for those of its velocities."""


def c99(
    made: Controller | Shield,
    folder: str | os.PathLike[str],
    q0: ArrayLike | None = None,
    overwrite: bool = False,
    name: str | None = None,
) -> Path:
    """Write a controller or a shield as a folder of C99: the core, and the tables of the arm.

    Args:
        made: The controller or shield, which is not changed. A shield takes twists of its
            robot's tip.
        folder: The folder, which is new, empty, or holds an earlier export, whose files are
            overwritten.
        q0: Joint positions [rad], (n,), at which the recorded steps begin, and which are the home
            of a scheme that states none; None: the controller's positions, or the start posture of
            a shield's robot.
        overwrite: Write into a folder that holds other files too.
        name: Name of the tables in C, and of their files; None: that of the robot.

    Returns:
        The folder.

    Raises:
        InvalidInputError: A part of the controller is not compiled or has no translation, the part
            is named; or the name is none.
        FileError: The folder holds other files, or cannot be written.
    """
    export = _Export(made, None, q0, _checked_name(name) if name else None)
    folder = _claimed(folder, VECTORS, overwrite)
    export.write_code(folder)
    for path in _templates("c", f"c_{export.tables.kind}"):
        write_text(folder / path.name, filled(path, export.texts))
    return folder


def tables(
    made: Controller | Shield,
    path: str | os.PathLike[str],
    frame: str | None = None,
    q0: ArrayLike | None = None,
) -> Path:
    """Write the tables of a controller or a shield as JSON, which the package armstep loads.

    Each number has its name, parts are named; a digest, a checksum and the sizes stand beside them,
    and recorded steps, which ``python -m armstep check`` compares. If parts are from outside of the
    package, their C is written beside the file, as ``NAME_own.c``, with a header.

    Args:
        made: The controller or shield, which is not changed.
        path: The file, whose name without its ending names the tables.
        frame: Frame of a shield's twists; None stands for the tip.
        q0: As for `c99`.

    Returns:
        The file.

    Raises:
        InvalidInputError: A part is not compiled, or has no translation, the part is named; or
            the file's name is none for C, and parts from outside of the package need one.
        NotFoundError: There is no such frame.
        FileError: The file cannot be written.
    """
    file = Path(path)
    export = _Export(made, frame, q0, file.stem)
    if own := export.code.get(f"{file.stem}_own.c"):
        _checked_name(file.stem)
        write_text(file.with_name(f"{file.stem}_own.c"), own)
        write_text(file.with_name("armstep.h"), core().header)
    write_text(file, export.tables.json(file.stem, export.vectors[1], export.tolerance))
    return file


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


def _checked_name(name: str) -> str:
    """Return a name that Python and C take; refuse others."""
    if not re.fullmatch("[a-z][a-z0-9_]*", name):
        raise InvalidInputError("name", f"must be small letters, digits and _, not {name!r}", name)
    if keyword.iskeyword(name):
        problem = f"must be no keyword of Python, as {name!r} is: no module can be imported by it"
        raise InvalidInputError("name", problem, name)
    if name in RESERVED:
        raise InvalidInputError("name", f"must be none of {', '.join(RESERVED)}", name)
    if c_word(name) != name:
        raise InvalidInputError("name", f"must be no word of C, as {name!r} is", name)
    return name


def _begun(made: Controller | Shield, q0: ArrayLike | None) -> tuple[Any, Vector]:
    """Return a shield, or a copy of a controller that begins; and where it begins, (n,) [rad].

    Raises:
        InvalidInputError: It is neither.
    """
    if isinstance(made, Shield):
        robot = made.robot
        return made, Configuration(robot, robot.start_posture() if q0 is None else q0).q
    controller = checks.instance("made", made, Controller)
    twin = copy.copy(controller)
    start = Configuration(twin.robot, twin.positions if q0 is None else q0)
    twin.reset()
    twin.anchor(start)
    return twin, start.q


class _Export:
    """Texts of an export.

    Attributes:
        tables: Tables of the arm.
        tolerance: Largest difference of a command in units of the velocity limits.
        texts: Texts by their names in the templates.
        code: Texts of the tables' files by their names.
        vectors: Names of the columns of recorded steps, and their rows.
    """

    def __init__(
        self, made: Controller | Shield, frame: str | None, q0: ArrayLike | None, name: str | None
    ) -> None:
        """Take what is exported; None for the name stands for the robot's."""
        twin, q = _begun(made, q0)
        self.tables = Tables(twin, frame)
        own = re.sub(r"\W", "_", twin.robot.name.lower()).strip("_")
        self._name = name or _checked_name(f"{'arm_' * (not own[:1].isalpha())}{own}")
        self.tolerance = 0.0 if isinstance(twin, Shield) else 10.0 * twin.solver.tol
        self.texts = self._common()
        if isinstance(twin, Shield):
            rows = _shield_run(twin, self.tables.frames[0], q, max(q.size, TWIST))
        else:
            rows = run(twin, q, STEPS)
            self.texts |= self._of_controller(twin, rows)
        width = rows.shape[1] - 2 * q.size - 4
        names = ["t", *_names(q=q.size), "kind", "dt", *_names(request=width, dq=q.size), "result"]
        self.vectors = (names, rows)
        self.texts |= {"q0": _numbers(q), "columns": len(names), "request": width}
        guard = (TEMPLATES / "core" / "guard.c").read_text(encoding="utf-8")
        folder = TEMPLATES / "tables"
        ends = {f"{self._name}.{end}": f"tables.{end}" for end in "hc"}
        if self.tables.own.names:
            ends[f"{self._name}_own.c"] = "own.c"
        self.code = {
            file: filled(folder / own, self.texts | {"guard": guard}) for file, own in ends.items()
        }

    def write_code(self, folder: Path) -> None:
        """Write the core, the tables and the recorded steps into a folder."""
        files = {"armstep.h": core().header, "armstep.c": core().code, **self.code}
        for file, text in files.items():
            write_text(folder / file, text)
        write_csv(folder / VECTORS, *self.vectors)

    def _common(self) -> dict[str, Any]:
        """Return the texts that both kinds have."""
        tables = self.tables
        name = self._name
        robot = tables.program.robot
        flat = tables.flat
        words = {
            "joint": robot.joint_names,
            "frame": tables.frames,
            "obstacle": tables.obstacles,
            "limit": tables.limit_names,
        }
        trees = {"numbers": ("double", flat.named), "integers": ("ptrdiff_t", flat.worded)}
        both = {
            word: f"{Node(own).declaration(f'{name}_{word}', kind)} = {Node(own).initializer()}"
            for word, (kind, own) in trees.items()
        }
        arrays = {
            word: braced([*map(constant, own.tolist())], robot.joint_names)
            for word, own in tables.limits.items()
        }
        return {
            **both,
            **arrays,
            **{f"{word}_words": _quoted(own) for word, own in words.items()},
            **{f"{word}_names": ", ".join(own) or "none" for word, own in words.items()},
            **{word: repr(float(value)) for word, value in tables.periods.items()},
            "name": name,
            "NAME": name.upper(),
            "tolerance": f"{self.tolerance:g}" if self.tolerance else "0.0",
            "kind": tables.kind,
            "KIND": tables.kind.upper(),
            "Kind": tables.kind.capitalize(),
            "robot": robot.name,
            "version": version("iiwa-dnn"),
            "release": RELEASE,
            "laid_out": LAID_OUT,
            "kept": tables.kept,
            "watched": len(tables.program.pairs) or "none, not even links",
            "joints": robot.dof,
            "frames": len(tables.frames),
            "obstacles": len(tables.obstacles),
            "limits": len(tables.limit_names),
            "first_row": tables.first_row,
            "memory": tables.memory,
            "scratch": tables.scratch,
            "digest": f"{tables.digest:016x}",
            "number_count": len(flat.numbers),
            "integer_count": len(flat.integers),
            "parts": ", ".join(map(str, flat.parts)),
            "part_count": len(flat.parts),
            **self._own_texts(),
            "steps": STEPS,
        }

    def _own_texts(self) -> dict[str, Any]:
        """Return the texts of parts from outside of the package."""
        own = self.tables.own
        name = f"{self._name}_own"
        count = len(own.names)
        return {
            "own": name if count else "NULL",
            "own_count": count,
            "own_declaration": f"extern const struct armstep_own {name}[];\n" * bool(count),
            "own_code": own.text() if count else "",
            "own_rows": "\n".join(own.rows),
        }

    def _of_controller(self, controller: Controller, rows: Matrix) -> dict[str, Any]:
        """Return the texts of a controller, whose recorded steps are known."""
        n = controller.robot.dof
        resting = rows[0, 3 + n : -1 - n].reshape(-1, TARGET_SIZE) * _POSE
        paths = by_frame(controller.reference, controller.robot.tip)
        names = ", ".join(each.name for each in paths.values())
        return {
            "target": _numbers(resting.ravel()),
            "request_of_step": "NULL" if self.tables.has_reference else "target",
            "references": names if self.tables.has_reference else "none",
        }


def _quoted(words: Sequence[str]) -> str:
    """Write words as strings of C, one after another; NULL for none."""
    return ", ".join(map(json.dumps, words)) or "NULL"


def _names(**counts: int) -> list[str]:
    """Return names of columns: each name with the numbers from 1 to its count."""
    return [f"{name}{i + 1}" for name, count in counts.items() for i in range(count)]


def _shield_run(shield: Shield, frame: str, q: Vector, width: int) -> Matrix:
    """Record steps of a shield with requests of all kinds: new, repeated, missing, not finite.

    The arm moves as commanded, late by the shield's `delay`. Requests have `width` numbers.

    Returns:
        Rows of the time [s], joint positions, kind of the request, stated period [s], the request,
        the command and its reason.
    """
    random = np.random.default_rng(0)
    arms = Shields(shield, frame=frame)
    kinds = [Request.VELOCITY, Request.TWIST, Request.POSITION, Request.NONE]
    late = math.ceil(shield.delay / shield.dt)
    path = [q] * (1 + late)
    rows: list[Vector] = []
    request: Vector = np.zeros(width)
    kind = Request.NONE
    for k in range(STEPS):
        if k % 25 == 0:
            kind = kinds[k // 25 % 4]
            request = random.standard_normal(width)
            if kind == Request.POSITION:
                request[: q.size] = q + 0.2 * request[: q.size]
            request[0] = np.inf if k == 100 else request[0]
        period = 0.5 * shield.dt if k % 10 == 7 and shield.longest_period is None else 0.0
        asked = request[np.newaxis]
        command = arms.step(
            q[np.newaxis],
            asked[:, : q.size] if kind == Request.VELOCITY else None,
            twist=asked[:, :TWIST] if kind == Request.TWIST else None,
            position=asked[:, : q.size] if kind == Request.POSITION else None,
            dt=period or None,
        )
        said = [float(kind), period]
        result = [float(command.reason[0])]
        rows.append(np.concatenate([[k * shield.dt], q, said, request, command.dq[0], result]))
        path.append(command.next_q[0])
        q = path[1 + k] + (0.05 if k == 130 else 0.0)
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
    the exported C. Where periods vary, they are not stated, the shortest and the longest in turn.

    Returns:
        Rows of the time [s], joint positions, a zero, the stated period [s], targets of all frames,
        the command and the action.
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
    t = 0.0
    periods = [0.0] if twin.longest_period is None else [0.0, 0.5 * twin.dt, twin.longest_period]
    rows: list[Vector] = []
    for k in range(steps):
        period = periods[k % len(periods)]
        command = twin.step(q, t, dt=period or None)
        result = [float(command.action)]
        targets = command.targets.ravel()
        rows.append(np.concatenate([[t], q, [0.0, period], targets, command.dq, result]))
        q = command.next_q
        t += period or twin.dt
    return np.array(rows)


def _numbers(values: Vector) -> str:
    """Write numbers one after another, all digits kept."""
    return ", ".join(map(repr, values.tolist()))
