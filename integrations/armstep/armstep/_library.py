"""The library in C: its functions, and the structs that it is given. armstep.h describes them."""

from __future__ import annotations

import ctypes
import os
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from armstep.errors import LibraryError

ENVIRONMENT = "ARMSTEP_LIBRARY"
"""Variable that names another build of the library than the package's."""

LAID_OUT = 513
"""Doubles of `struct armstep`: tables that are laid out."""

SAVED = 2
"""Doubles that a saved arm has beside its memory."""

NAMED = ("joint", "frame", "obstacle", "limit")
"""Words that tables have names of."""

LIMITS = ("lower", "upper", "velocity", "acceleration", "jerk")
"""Limits of the joints."""

POINTER, SIZE, REAL, INT = ctypes.c_void_p, ctypes.c_ssize_t, ctypes.c_double, ctypes.c_int


class TablesStruct(ctypes.Structure):
    """`struct armstep_tables`."""

    _fields_ = (
        ("digest", ctypes.c_uint64),
        ("release", INT),
        ("kind", INT),
        ("name", POINTER),
        *((f"{own}{end}", SIZE) for own in NAMED for end in ("_names", "s")),
        ("first_row", SIZE),
        *((own, POINTER) for own in LIMITS),
        *((own, REAL) for own in ("dt", "longest", "delay")),
        *((own, SIZE) for own in ("memory", "scratch")),
        *(
            (f"{own}{end}", SIZE)
            for own in ("number", "integer", "part")
            for end in ("s", "_count")
        ),
        ("own", POINTER),
        ("own_count", SIZE),
    )


class OwnPart(ctypes.Structure):
    """`struct armstep_own`."""

    _fields_ = (("name", ctypes.c_char_p), ("entry", INT), ("function", POINTER))


class Input(ctypes.Structure):
    """`struct armstep_input`."""

    _fields_ = (
        ("q", POINTER),
        ("kind", INT),
        ("request", POINTER),
        ("t", REAL),
        ("dt", REAL),
        ("elapsed", REAL),
    )


class Batch(ctypes.Structure):
    """`struct armstep_batch`."""

    _fields_ = (
        ("memory", POINTER),
        ("stride", SIZE),
        ("input", Input),
        ("given", POINTER),
        ("dq", POINTER),
        ("next_q", POINTER),
        ("clipped", POINTER),
        ("reasons", POINTER),
    )


FUNCTIONS: dict[str, tuple[Any, list[Any]]] = {
    "load": (INT, [POINTER] * 2),
    "part_number": (INT, [POINTER, ctypes.c_char_p]),
    "begin": (None, [POINTER] * 3),
    "rest": (INT, [POINTER] * 4),
    "halt": (INT, [POINTER] * 2),
    "scale_speed": (INT, [*[POINTER] * 2, REAL]),
    "send": (INT, [*[POINTER] * 3, REAL, REAL]),
    "place": (INT, [POINTER] * 3),
    "people": (INT, [*[POINTER] * 3, SIZE, REAL]),
    "body": (INT, [*[POINTER] * 2, SIZE, POINTER, REAL]),
    "follow": (INT, [*[POINTER] * 4, SIZE, INT]),
    "time": (REAL, [POINTER] * 2),
    "followed": (POINTER, [POINTER] * 3),
    "frame": (INT, [POINTER] * 5),
    "separation": (REAL, [POINTER] * 3),
    "torque": (REAL, [POINTER] * 3),
    "steps": (SIZE, [*[POINTER] * 3, SIZE, SIZE]),
    "targets": (INT, [*[POINTER] * 3, REAL, POINTER]),
    "save": (INT, [POINTER] * 3),
    "restore": (INT, [POINTER] * 3),
    "active_limits": (INT, [POINTER] * 3),
    "margin": (INT, [POINTER] * 5),
    "stopping_time": (REAL, [POINTER] * 3),
    "program_of": (INT, [POINTER] * 2),
    "fraction": (REAL, [POINTER] * 2),
    "path_lag": (REAL, [POINTER] * 2),
}
"""Result and arguments of each function, by its name without the prefix."""


def load(kind: Any) -> Any:
    """Load the library.

    Args:
        kind: `ctypes.PyDLL`, or `CDLL` whose calls let other threads run.

    Raises:
        LibraryError: There is none for this machine.
    """
    place = os.environ.get(ENVIRONMENT) or Path(__file__).with_name("_library.bin")
    try:
        library = kind(str(place))
        for name, (result, arguments) in FUNCTIONS.items():
            function = getattr(library, f"armstep_{name}")
            function.restype, function.argtypes = result, arguments
    except (OSError, AttributeError) as error:
        remedy = f"pip install integrations/armstep compiles one, {ENVIRONMENT} names another"
        raise LibraryError(f"no library for this machine: {remedy}: {error}") from None
    return library


# One arm keeps Python's lock: to give it back takes longer than the step beside a busy thread.
ONE = load(ctypes.PyDLL)
MANY = load(ctypes.CDLL)


def address(array: NDArray[Any]) -> int:
    """Return where the numbers of an array are."""
    return int(array.__array_interface__["data"][0])
