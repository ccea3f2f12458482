"""Exported controllers, and functions translated and compiled on their own."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from iiwa_dnn.checks import Array
from iiwa_dnn.export import load
from iiwa_dnn.export.translator import Translator
from iiwa_dnn.export.values import DOUBLE, Array as Pointer, Value

QUICK = ("-std=c99", "-O0")
"""Flags with which compiling takes a third of the time."""

WARNINGS = ("-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror")
HEAD = "#include <math.h>\n#include <stdbool.h>\n\n"


def needs(*programs: str) -> Any:
    """Mark of a test that calls programs, which `.ci/run` installs."""
    missing = [name for name in programs if shutil.which(name) is None]
    return pytest.mark.skipif(bool(missing), reason=f"no {', '.join(missing)}")


def compile_quickly(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the package compile what it exports without optimization, and run its test once."""
    monkeypatch.setattr(sys.modules["iiwa_dnn.export.load"], "FLAGS", (*QUICK, "-DROUNDS=1"))
    monkeypatch.setattr(load, "__defaults__", (QUICK, None))


def run(*words: str | Path, cwd: Path | None = None) -> str:
    """Run a program and return what it prints."""
    done = subprocess.run([*map(str, words)], capture_output=True, text=True, cwd=cwd)
    assert done.returncode == 0, f"{words[0]}: {done.stdout}{done.stderr}"
    return done.stdout


def compiled_text(text: str, folder: Path) -> ctypes.CDLL:
    """Compile C without optimization, any warning an error but for functions that are not used."""
    source = folder / "text.c"
    source.write_text(HEAD + text, encoding="utf-8")
    library = folder / "text.so"
    flags = (*WARNINGS, "-Wno-unused-function", "-O0", "-shared", "-fPIC")
    run("gcc", *flags, "-o", library, source, "-lm")
    return ctypes.CDLL(str(library))


def translated(function: Callable[..., None], *shapes: tuple[int, ...]) -> str:
    """Translate a function of arrays of doubles; the whole text, with ``entry`` to call it."""
    translator = Translator()
    arguments = [Value(Pointer(DOUBLE, shape), f"a{i}") for i, shape in enumerate(shapes)]
    made = translator.function(function, arguments)
    assert made is not None
    names = [argument.text for argument in arguments]
    head = ", ".join(f"double *{name}" for name in names)
    call = f"void entry({head});\nvoid entry({head})\n{{\n    {made.name}({', '.join(names)});\n}}"
    return f"{translator.text()}\n\n{call}\n"


def call(library: ctypes.CDLL, name: str, *arrays: Array) -> None:
    """Call a function of pointers to doubles."""
    pointer = ctypes.POINTER(ctypes.c_double)
    getattr(library, name)(*(array.ctypes.data_as(pointer) for array in arrays))


def both(function: Callable[..., None], folder: Path, *arrays: Array) -> tuple[list[Array], ...]:
    """Call a function in Python and in C; return the arrays after both calls."""
    library = compiled_text(translated(function, *(array.shape for array in arrays)), folder)
    ours = [array.copy() for array in arrays]
    theirs = [np.ascontiguousarray(array.copy()) for array in arrays]
    function(*ours)
    call(library, "entry", *theirs)
    return ours, theirs
