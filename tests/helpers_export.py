"""Exported controllers, and the programs that compile them."""

import atexit
import importlib
import os
import shutil
import subprocess
import sys
import tempfile
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from iiwa_dnn import Controller, Shield
from iiwa_dnn.export import tables
from iiwa_dnn.export.core import core

ARMSTEP = str(Path(__file__).parents[1] / "integrations" / "armstep")
"""Where the Python of armstep is."""

QUICK = ("-std=c99", "-O0")
"""Flags with which compiling takes a third of the time."""

WARNINGS = ("-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror")


def needs(*programs: str) -> Any:
    """Mark of a test that calls programs, which `.ci/run` installs."""
    missing = [name for name in programs if shutil.which(name) is None]
    return pytest.mark.skipif(bool(missing), reason=f"no {', '.join(missing)}")


def run(*words: str | Path, cwd: Path | None = None) -> str:
    """Run a program and return what it prints."""
    done = subprocess.run([*map(str, words)], capture_output=True, text=True, cwd=cwd)
    assert done.returncode == 0, f"{words[0]}: {done.stdout}{done.stderr}"
    return done.stdout


@cache
def compiled_core(flags: tuple[str, ...]) -> Path:
    """Compile the core, once in a process for the same flags; return the file."""
    folder = Path(tempfile.mkdtemp())
    atexit.register(shutil.rmtree, folder)
    (folder / "armstep.h").write_text(core().header, encoding="utf-8")
    (folder / "armstep.c").write_text(core().code, encoding="utf-8")
    made = folder / f"armstep.{'so' if '-shared' in flags else 'o'}"
    kind = [] if "-shared" in flags else ["-c"]
    run("gcc", *flags, *kind, folder / "armstep.c", "-o", made)
    return made


def use_armstep() -> Any:
    """Import armstep with the library of these kernels, which programs of tests use too."""
    if "ARMSTEP_LIBRARY" not in os.environ:
        made = compiled_core(("-std=c99", "-O1", "-fPIC", "-shared"))
        os.environ["ARMSTEP_LIBRARY"] = str(made)
    if ARMSTEP not in sys.path:
        sys.path.append(ARMSTEP)  # of a script: pytest has it
    return importlib.import_module("armstep")


def in_armstep(made: Controller | Shield, folder: Path, q0: Any = None) -> Any:
    """Export the tables of a controller or a shield, and let armstep load them."""
    armstep = use_armstep()
    path = tables(made, folder / "arm.json", q0=q0)
    own = folder / "arm_own.so"
    if (source := own.with_suffix(".c")).exists():
        run("gcc", *WARNINGS, *QUICK, "-shared", "-fPIC", source, "-o", own)
    kind = armstep.Shield if isinstance(made, Shield) else armstep.Controller
    return kind(path, own=own)
