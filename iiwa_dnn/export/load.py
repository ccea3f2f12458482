"""An exported controller, compiled and loaded: C's step in Python."""

from __future__ import annotations

import ctypes
import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.errors import FileError, MissingDependencyError
from iiwa_dnn.files import one_line
from iiwa_dnn.qp import Vector

FLAGS = ("-std=c99", "-O2")
"""Flags of the compiler, unless others are given."""


class ExportedCommand(NamedTuple):
    """Decision of one step.

    Attributes:
        dq: Joint velocity [rad/s], (n,).
        action: 0 if the command does all that the tasks ask; else the code of the action.
    """

    dq: Vector
    action: int


class ExportedController:
    """A controller in C, with memory of its own.

    Attributes:
        dof: Number of joints, n.
        frames: Number of tracked frames.
        dt: Control period [s].
        size: Bytes of the controller's memory.
        systems: Largest number of linear systems of a step.
        has_reference: Whether the controller has a reference of its own.
    """

    def __init__(self, library: ctypes.CDLL, header: str) -> None:
        """Take a compiled controller and its header, and begin at rest."""
        macros = dict(re.findall(r"#define CONTROLLER_(\w+) (\S+)", header))
        self.dof = int(macros["DOF"])
        self.frames = int(macros["FRAMES"])
        self.dt = float(macros["DT"])
        self.size = int(macros["SIZE"])
        self.systems = int(macros["SYSTEMS"])
        self.has_reference = "controller_target" in header
        self._library = library
        self._memory = (ctypes.c_double * (self.size // 8))()
        self.reset()

    def reset(self) -> None:
        """Begin at rest."""
        self._library.controller_init(self._memory)

    def step(self, q: ArrayLike, target: ArrayLike) -> ExportedCommand:
        """Compute the command for joint positions.

        Args:
            q: Measured joint positions [rad], (n,).
            target: `Target.data` of each tracked frame, (18 frames,) or (frames, 18).

        Raises:
            InvalidInputError: `q` or `target` has a wrong shape or is not finite.
        """
        joints = checks.finite_array("q", q, (self.dof,))
        wanted = checks.finite_array("target", np.ravel(target), (18 * self.frames,))
        dq = np.empty(self.dof)
        step = self._library.controller_step
        action = step(self._memory, _pointer(joints), _pointer(wanted), _pointer(dq))
        return ExportedCommand(dq, int(action))

    def shield_step(self, q: ArrayLike, wish: ArrayLike | None = None) -> ExportedCommand:
        """Compute the command of a shield for a joint velocity wished for [rad/s], (n,), or none.

        Raises:
            InvalidInputError: `q` or the wish has a wrong shape, or `q` is not finite.
        """
        joints = checks.finite_array("q", q, (self.dof,))
        asked = None if wish is None else _pointer(checks.array("wish", wish, (self.dof,)))
        dq = np.empty(self.dof)
        action = self._library.shield_step(self._memory, _pointer(joints), asked, _pointer(dq))
        return ExportedCommand(dq, int(action))

    def shield_halt(self) -> None:
        """Brake from now on, whatever is wished for."""
        self._library.shield_halt(self._memory)

    def target(self, t: float) -> Vector:
        """Compute the targets of the controller's reference at a time [s], (18 frames,)."""
        target = np.empty(18 * self.frames)
        sample = self._library.controller_target
        sample(self._memory, ctypes.c_double(checks.finite("t", t)), _pointer(target))
        return target


def load(
    folder: str | os.PathLike[str], flags: Sequence[str] = FLAGS, compiler: str | None = None
) -> ExportedController:
    """Compile an exported controller and return it.

    Args:
        folder: Folder that `c99` wrote.
        flags: Flags of the compiler.
        compiler: Its command; None: that of the environment's ``CC``, or else ``cc``, ``gcc`` or
            ``clang``.

    Raises:
        FileError: The folder holds no controller, or it does not compile.
        MissingDependencyError: There is no C compiler.
    """
    folder = Path(folder)
    try:
        header = (folder / "controller.h").read_text(encoding="utf-8")
    except OSError as error:
        raise FileError(folder / "controller.h", one_line(error)) from error
    with tempfile.TemporaryDirectory() as place:
        library = Path(place) / "controller.so"
        _compile(folder, library, (*flags, "-shared", "-fPIC"), ["controller.c"], compiler)
        # The system keeps the file as long as it is loaded.
        return ExportedController(ctypes.CDLL(str(library)), header)


def tested(folder: Path) -> str:
    """Compile and run the test of an exported controller; return what it prints.

    Raises:
        FileError: The test does not compile.
        MissingDependencyError: There is no C compiler.
    """
    with tempfile.TemporaryDirectory() as place:
        program = Path(place) / "test_controller"
        _compile(folder, program, FLAGS, ["test_controller.c", "controller.c"])
        words = [str(program), str(folder / "vectors.csv")]
        said = subprocess.run(words, capture_output=True, text=True, check=False).stdout
        return f"{said.strip()} ({' '.join(FLAGS)})"


def _compile(
    folder: Path,
    output: Path,
    flags: Sequence[str],
    names: Sequence[str],
    compiler: str | None = None,
) -> None:
    """Compile files of a folder; raises what `load` does."""
    sources = [str(folder / name) for name in names]
    words = [find_compiler(compiler), *flags, "-o", str(output), *sources, "-lm"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode:
        raise FileError(sources[-1], f"does not compile: {done.stderr.strip()[:500]}")


def find_compiler(name: str | None = None) -> str:
    """Return the path of a C compiler.

    Raises:
        MissingDependencyError: There is none.
    """
    names = [name] if name else [*filter(None, [os.environ.get("CC")]), "cc", "gcc", "clang"]
    for each in names:
        found = shutil.which(each)
        if found:
            return found
    problem = f"a C compiler ({', '.join(names)})"
    raise MissingDependencyError(problem, "on Debian and Ubuntu: apt-get install gcc")


def _pointer(array: Vector) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)
