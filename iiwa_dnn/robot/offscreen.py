"""OpenGL without a display, for MuJoCo to draw with.

On Linux it is the library that the environment variable MUJOCO_GL names, else EGL (a graphics card,
or Mesa's software driver), else OSMesa (always in software). Physics needs none of them.
"""

import ctypes
import importlib
import os
import sys
from typing import Any

from iiwa_dnn.errors import MissingDependencyError

_EGL_PLATFORM_DEVICE = 0x313F
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
        if (wanted := os.environ.get("MUJOCO_GL", "").lower()) not in ("egl", "osmesa"):
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
    libraries = {"egl": egl_works, "osmesa": osmesa_works}
    # PyOpenGL loads one library in a process, and MuJoCo sets the first of these to say which.
    wanted = [os.environ.get(name, "").lower() for name in ("PYOPENGL_PLATFORM", "MUJOCO_GL")]
    for name in [name for name in wanted if name in libraries][:1] or libraries:
        if libraries[name]():
            return name
    raise MissingDependencyError("an OpenGL library for pictures without a display", _OPENGL_REMEDY)


def open_context(width: int, height: int) -> Any:
    """Open an OpenGL context for pictures of this size [pixel], made the current one.

    Raises:
        MissingDependencyError: If MuJoCo or an OpenGL library is not there.
    """
    import_mujoco()
    context = importlib.import_module(f"mujoco.{opengl_library()}").GLContext(width, height)
    context.make_current()
    return context


def egl_works() -> bool:
    """Check that EGL opens a display on some device; a library without a driver does not."""
    if not (_loads("libOpenGL.so.0") or _loads("libGL.so.1")) or not _loads("libEGL.so.1"):
        return False
    egl, pointer, number = ctypes.CDLL("libEGL.so.1"), ctypes.c_void_p, ctypes.c_uint
    egl.eglGetProcAddress.restype = pointer
    query = egl.eglGetProcAddress(b"eglQueryDevicesEXT")
    get_display = egl.eglGetProcAddress(b"eglGetPlatformDisplayEXT")
    if not (query and get_display):
        return False
    devices, count = (pointer * 32)(), ctypes.c_int()
    query = ctypes.CFUNCTYPE(number, ctypes.c_int, pointer, pointer)(query)
    get_display = ctypes.CFUNCTYPE(pointer, number, pointer, pointer)(get_display)
    if not query(len(devices), devices, ctypes.byref(count)):
        return False
    egl.eglInitialize.argtypes = [pointer] * 3
    found = devices[: count.value]
    displays = (get_display(_EGL_PLATFORM_DEVICE, device, None) for device in found)
    # Left open: MuJoCo gets the same display and closes it.
    return any(display and egl.eglInitialize(display, None, None) for display in displays)


def osmesa_works() -> bool:
    """Check that OSMesa is there; it needs neither a device nor a display."""
    return _loads("libOSMesa.so.8") or _loads("libOSMesa.so")


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True
