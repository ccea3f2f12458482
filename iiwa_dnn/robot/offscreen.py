"""OpenGL without a display, for MuJoCo to draw with.

On Linux it is the library that the environment variable MUJOCO_GL names, by default EGL (a graphics
card, or Mesa's software driver). Physics needs none.
"""

import importlib
import os
import sys
from typing import Any

from iiwa_dnn.errors import MissingDependencyError, import_extra


def import_mujoco() -> Any:
    """Import MuJoCo's Python package; raises MissingDependencyError where it is not installed."""
    return import_extra("mujoco", "pip install 'iiwa-dnn[sim]'")


def prepare_renderer() -> None:
    """Let ``mujoco.Renderer`` draw without a display, whatever MuJoCo chose at its import.

    Raises:
        MissingDependencyError: If MuJoCo is not there or, on Linux, an OpenGL library that opens a
            context; it names the Debian package.
    """
    renderer = importlib.import_module(import_mujoco().Renderer.__module__)
    if not sys.platform.startswith("linux"):
        return  # MuJoCo's own choice
    library = os.environ.get("MUJOCO_GL", "").lower() or "egl"
    try:
        context = importlib.import_module(f"mujoco.{library}").GLContext
        context(1, 1).free()
    except Exception as error:  # whatever PyOpenGL meets
        raise MissingDependencyError(
            f"OpenGL by {library}, without a display",
            "on Debian: apt-get install libegl1 libgl1 (or libosmesa6, and MUJOCO_GL=osmesa)",
        ) from error
    renderer.gl_context.GLContext = context
