"""Compile and load an exported controller, to call its C from Python."""

from __future__ import annotations

import ctypes
import os
import re
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.compiling.build import run_compiler
from iiwa_dnn.errors import FileError
from iiwa_dnn.qp import Vector

FLAGS = ("-std=c99", "-O2")
"""Flags of the compiler, unless others are given."""


class ExportedCommand(NamedTuple):
    """Command of one step.

    Attributes:
        dq: Joint velocity [rad/s], (n,).
        action: 0 if the command fulfils the tasks; else the code of the action that was taken.
    """

    dq: Vector
    action: int


class ExportedController:
    """Controller in C, and the memory of its state.

    Attributes:
        dof: Number of joints, n.
        frames: Number of tracked frames.
        dt: Control period [s].
        size: Bytes of the controller's memory.
    """

    def __init__(self, library: Any, header: str) -> None:
        """Take the loaded library of a controller and the text of its header; begin at rest."""
        macros = dict(re.findall(r"#define CONTROLLER_(\w+) (\S+)", header))
        self.dof = int(macros["DOF"])
        self.frames = int(macros["FRAMES"])
        self.dt = float(macros["DT"])
        self.size = int(macros["SIZE"])
        self._library = library
        self._memory = (ctypes.c_double * (self.size // 8))()
        self.reset()

    def reset(self) -> None:
        """Forget the last commands and begin at rest."""
        self._library.controller_init(self._memory)

    def step(self, q: ArrayLike, target: ArrayLike) -> ExportedCommand:
        """Compute the command for joint positions.

        Args:
            q: Measured joint positions [rad], (n,).
            target: `Target.data` of each tracked frame, (18 frames,) or (frames, 18).

        Raises:
            InvalidInputError: `q` or `target` has a wrong shape or is not finite.
        """
        wanted = checks.finite_array("target", np.ravel(target), (18 * self.frames,))
        return self._command(self._library.controller_step, q, wanted)

    def target(self, t: float) -> Vector:
        """Compute the targets of the controller's reference at a time [s], (18 frames,)."""
        target = np.empty(18 * self.frames)
        self._library.controller_target(self._memory, ctypes.c_double(t), target.ctypes)
        return target

    def _command(self, step: Any, q: ArrayLike, asked: Vector | None) -> ExportedCommand:
        """Call a C function `step` with joint positions and targets, or without targets."""
        joints = checks.finite_array("q", q, (self.dof,))
        dq = np.empty(self.dof)
        given = None if asked is None else asked.ctypes
        return ExportedCommand(dq, step(self._memory, joints.ctypes, given, dq.ctypes))


def load(folder: str | os.PathLike[str], flags: Sequence[str] = FLAGS) -> ExportedController:
    """Compile the controller in a folder, by ``CC`` or another C compiler, and load it.

    Raises:
        FileError: The folder holds no controller, or one that does not compile, or there is no
            compiler.
    """
    source = Path(folder) / "controller.c"
    with tempfile.TemporaryDirectory() as build:
        library = Path(build) / "controller.so"
        try:
            run_compiler([*flags, "-shared", "-fPIC"], [source], library)
        except (LookupError, RuntimeError) as error:
            raise FileError(source, str(error)) from error
        header = source.with_suffix(".h").read_text(encoding="utf-8")
        # The system keeps the file as long as it is loaded.
        return ExportedController(ctypes.CDLL(str(library)), header)
