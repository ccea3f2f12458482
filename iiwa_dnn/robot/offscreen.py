"""OpenGL without a display, for MuJoCo to draw with.

On Linux it is the library that the environment variable MUJOCO_GL names, by default EGL (a graphics
card, or Mesa's software driver). Physics needs none.
"""

import importlib
import os
import sys
from typing import Any

from iiwa_dnn.errors import MissingDependencyError

_REMEDY = (
    "on Debian and Ubuntu: apt-get install libegl1 libgl1 (or libosmesa6, and MUJOCO_GL=osmesa)"
)


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
        raise MissingDependencyError("the OpenGL library of MUJOCO_GL", _REMEDY) from error


def opengl_library() -> str:
    """Return the module of MuJoCo that draws without a display.

    Returns:
        ``"egl"``, or what MUJOCO_GL names; off Linux ``"gl_context"``, MuJoCo's own choice.

    Raises:
        MissingDependencyError: On Linux, if it opens no context; it names the Debian package.
    """
    import_mujoco()
    if not sys.platform.startswith("linux"):
        return "gl_context"
    library = os.environ.get("MUJOCO_GL", "").lower() or "egl"
    try:
        importlib.import_module(f"mujoco.{library}").GLContext(1, 1).free()
    except Exception as error:  # whatever PyOpenGL meets
        raise MissingDependencyError(f"OpenGL by {library}, without a display", _REMEDY) from error
    return library


def prepare_renderer() -> None:
    """Let ``mujoco.Renderer`` draw without a display, whatever MuJoCo chose at its import.

    Raises:
        MissingDependencyError: If MuJoCo or an OpenGL library is not there.
    """
    renderer = importlib.import_module(import_mujoco().Renderer.__module__)
    context = importlib.import_module(f"mujoco.{opengl_library()}").GLContext
    renderer.gl_context.GLContext = context
