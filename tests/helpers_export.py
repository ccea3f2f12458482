"""Exported controllers, and the programs that compile them."""

import atexit
import importlib
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from iiwa_dnn import Controller, Shield
from iiwa_dnn.export import load, python
from iiwa_dnn.export.core import core

QUICK = ("-std=c99", "-O0")
"""Flags with which compiling takes a third of the time."""

WARNINGS = ("-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror")


def needs(*programs: str) -> Any:
    """Mark of a test that calls programs, which `.ci/run` installs."""
    missing = [name for name in programs if shutil.which(name) is None]
    return pytest.mark.skipif(bool(missing), reason=f"no {', '.join(missing)}")


def compile_quickly(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the package compile what it exports without optimization."""
    monkeypatch.setattr(load, "__defaults__", (QUICK,))


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


def use_armstep(*flags: str) -> Path:
    """Let armstep, and the programs that tests run, use the library of these kernels."""
    made = compiled_core(("-std=c99", "-O1", "-fPIC", "-shared", *flags))
    os.environ["ARMSTEP_LIBRARY"] = str(made)
    return made


def packaged(
    made: Controller | Shield,
    folder: Path,
    name: str,
    q0: Any = None,
    flags: Sequence[str] = (),
    cuda: bool = False,
) -> Any:
    """Export a controller or a shield as a package of Python, compile and import it."""
    project = python(made, folder, name, q0=q0, cuda=cuda)
    package = project / name
    own = ["-std=c99", "-O1", "-shared", "-fPIC", *flags]
    core = compiled_core(tuple(each for each in own if each != "-shared"))
    sources = [each for each in package.glob("*.c") if each.name != "armstep.c"]
    run("gcc", *own, core, *sources, "-o", package / "_library.bin", "-lm")
    for inner in [each for each in sys.modules if each.partition(".")[0] == name]:
        del sys.modules[inner]  # of an earlier export by this name
    sys.path.insert(0, str(project))
    try:
        return importlib.import_module(name)
    finally:
        sys.path.remove(str(project))
