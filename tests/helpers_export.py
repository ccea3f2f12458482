"""Exported controllers, and the programs that compile them."""

import importlib.util
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from iiwa_dnn import Shield
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


def packaged(shield: Shield, folder: Path, name: str, q0: Any = None) -> Any:
    """Export a shield as a package of Python, compile and import it."""
    project = python(shield, folder, name, q0=q0)
    package = project / name
    flags = ["-std=c99", "-O1", "-ffp-contract=off", "-shared", "-fPIC"]
    run("gcc", *flags, package / "shield.c", "-o", package / "_shield.bin", "-lm")
    spec = importlib.util.spec_from_file_location(name, package / "__init__.py")
    assert spec
    assert spec.loader
    module = sys.modules[name] = importlib.util.module_from_spec(spec)  # pickles find it there
    spec.loader.exec_module(module)
    return module
