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
from iiwa_dnn.export.core import LAID_OUT
from iiwa_dnn.qp import Vector

FLAGS = ("-std=c99", "-O2")
"""Flags of the compiler, unless others are given."""

CORE = "armstep.h"
"""Header of the core."""


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

    def __init__(self, library: Any, name: str, header: str, dt: float) -> None:
        """Take the loaded library, name and header of its tables, and its period; begin at rest.

        Raises:
            FileError: The library refuses the tables.
        """
        known = {word: int(n) for word, n in re.findall(r"_([A-Z]+) = (\d+)", header)}
        self.dof = known["JOINTS"]
        self.frames = known["FRAMES"]
        self.dt = dt
        self.size = 8 * known["MEMORY"]
        self._library = library
        self._arm = (ctypes.c_double * (LAID_OUT + 1))()
        self._memory = (ctypes.c_double * known["MEMORY"])()
        self._scratch = (ctypes.c_double * known["SCRATCH"])()
        status = library.armstep_load(self._arm, ctypes.byref(ctypes.c_char.in_dll(library, name)))
        if status:
            raise FileError(f"{name}.c", f"the tables do not load: status {status}")
        self.reset()

    def reset(self) -> None:
        """Forget the last commands and begin at rest."""
        self._library.armstep_begin(self._arm, self._memory, self._scratch)

    def step(self, q: ArrayLike, target: ArrayLike) -> ExportedCommand:
        """Compute the command for joint positions.

        Args:
            q: Measured joint positions [rad], (n,).
            target: `Target.data` of each tracked frame, (18 frames,) or (frames, 18).

        Raises:
            InvalidInputError: `q` or `target` has a wrong shape or is not finite.
        """
        wanted = checks.finite_array("target", np.ravel(target), (18 * self.frames,))
        joints = checks.finite_array("q", q, (self.dof,))
        dq = np.empty(self.dof)
        given = _Input(joints.ctypes.data, 0, wanted.ctypes.data, 0.0, 0.0, 0.0)
        place = (self._arm, self._memory, self._scratch)
        return ExportedCommand(
            dq, self._library.armstep_step(*place, ctypes.byref(given), dq.ctypes)
        )

    def target(self, t: float) -> Vector:
        """Compute the targets of the controller's reference at a time [s], (18 frames,)."""
        target = np.empty(18 * self.frames)
        place = (self._arm, self._memory, self._scratch)
        self._library.armstep_targets(*place, ctypes.c_double(t), target.ctypes)
        return target


class _Input(ctypes.Structure):
    _fields_ = (
        ("q", ctypes.c_void_p),
        ("kind", ctypes.c_int),
        ("request", ctypes.c_void_p),
        ("t", ctypes.c_double),
        ("dt", ctypes.c_double),
        ("elapsed", ctypes.c_double),
    )


def load(folder: str | os.PathLike[str], flags: Sequence[str] = FLAGS) -> ExportedController:
    """Compile the controller in a folder, by ``CC`` or another C compiler, and load it.

    Raises:
        FileError: The folder holds no controller, or one that does not compile, or there is no
            compiler.
    """
    place = Path(folder)
    headers = [own for own in place.glob("*.h") if own.with_suffix(".c").is_file()]
    tables = next((own for own in headers if own.name != CORE), None)
    if tables is None:
        raise FileError(place, "holds no tables beside a header")
    sources = [place / "armstep.c", *sorted(place.glob(f"{tables.stem}*.c"))]
    with tempfile.TemporaryDirectory() as build:
        library = Path(build) / "controller.so"
        try:
            run_compiler([*flags, "-shared", "-fPIC"], sources, library)
        except (LookupError, RuntimeError) as error:
            raise FileError(sources[-1], str(error)) from error
        header = tables.read_text(encoding="utf-8")
        period = re.search(r"\.dt = (\S+),\n    \.longest", sources[1].read_text(encoding="utf-8"))
        # The system keeps the file as long as it is loaded.
        return ExportedController(
            ctypes.CDLL(str(library)), tables.stem, header, float(period[1] if period else "nan")
        )
