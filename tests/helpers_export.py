"""Exported controllers, and the programs that compile them."""

import importlib
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from iiwa_dnn import Controller, Shield
from iiwa_dnn.export import load, python

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
    (source,) = package.glob("*.c")
    own = ["-std=c99", "-O1", "-ffp-contract=off", "-shared", "-fPIC", *flags]
    run("gcc", *own, source, "-o", package / "_library.bin", "-lm")
    for inner in [each for each in sys.modules if each.partition(".")[0] == name]:
        del sys.modules[inner]  # of an earlier export by this name
    sys.path.insert(0, str(project))
    try:
        return importlib.import_module(name)
    finally:
        sys.path.remove(str(project))
