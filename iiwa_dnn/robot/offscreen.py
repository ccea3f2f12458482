"""OpenGL without a display, for MuJoCo to draw with.

On Linux it is the library that the environment variable MUJOCO_GL names, else EGL (a graphics card,
or Mesa's software driver), else OSMesa (always in software). Physics needs none of them.
"""

import importlib
import os
import subprocess
import sys
from functools import cache
from typing import Any

from iiwa_dnn.errors import MissingDependencyError

_LIBRARIES = ("egl", "osmesa")
_OPENGL_REMEDY = "on Debian and Ubuntu: apt-get install libosmesa6 (or, for EGL: libegl1 libgl1)"


def import_mujoco() -> Any:
    """Import MuJoCo's Python package.

    Raises:
        MissingDependencyError: If it is not installed, or lacks the OpenGL library that the
            environment variable MUJOCO_GL makes it load.
    """
    try:
        return importlib.import_module("mujoco")
    except ModuleNotFoundError as error:
        package = "the Python package mujoco"
        raise MissingDependencyError(package, "pip install 'iiwa-dnn[sim]'") from error
    except Exception as error:  # whatever PyOpenGL meets where that library is not there
        wanted = os.environ.get("MUJOCO_GL", "").lower()
        if wanted not in _LIBRARIES:
            raise
        library = f"the OpenGL library that MUJOCO_GL={wanted} asks for"
        raise MissingDependencyError(library, _OPENGL_REMEDY) from error


def opengl_library() -> str:
    """Choose the module of MuJoCo that can draw without a display.

    Returns:
        ``"egl"`` or ``"osmesa"``; off Linux ``"gl_context"``, MuJoCo's own choice.

    Raises:
        MissingDependencyError: On Linux, if there is none; it names the Debian package.
    """
    if not sys.platform.startswith("linux"):
        return "gl_context"
    # PyOpenGL loads one library in a process, and MuJoCo sets the first of these to say which.
    wanted = [os.environ.get(name, "").lower() for name in ("PYOPENGL_PLATFORM", "MUJOCO_GL")]
    for library in [name for name in wanted if name in _LIBRARIES][:1] or _LIBRARIES:
        if opens(library):
            return library
    raise MissingDependencyError("an OpenGL library for pictures without a display", _OPENGL_REMEDY)


@cache
def opens(library: str) -> bool:
    """Check, in a process of its own, that MuJoCo opens a context of ``"egl"`` or ``"osmesa"``."""
    code = f"from mujoco.{library} import GLContext; GLContext(1, 1)"
    environment = os.environ | {"MUJOCO_GL": library, "PYOPENGL_PLATFORM": library}
    command = [sys.executable, "-c", code]
    return not subprocess.run(command, env=environment, capture_output=True, check=False).returncode


def prepare_renderer() -> None:
    """Let ``mujoco.Renderer`` draw without a display, whatever MuJoCo chose at its import.

    Raises:
        MissingDependencyError: If MuJoCo or an OpenGL library is not there.
    """
    renderer = importlib.import_module(import_mujoco().Renderer.__module__)
    context = importlib.import_module(f"mujoco.{opengl_library()}").GLContext
    renderer.gl_context.GLContext = context
