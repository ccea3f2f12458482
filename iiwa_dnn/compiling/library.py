"""Load kernels; call kernels and callbacks by their addresses."""

from __future__ import annotations

import ctypes
import math
import os
import re
import threading
from collections.abc import Callable, Iterator
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any, ClassVar, Generic, ParamSpec, TypeVar, cast, get_type_hints

import numpy as np

from iiwa_dnn.compiling.build import build
from iiwa_dnn.compiling.records import Record
from iiwa_dnn.compiling.sources import c_name

Function = TypeVar("Function", bound=Callable[..., Any])
P = ParamSpec("P")
R = TypeVar("R")

INTERPRETED = os.environ.get("IIWA_DNN_INTERPRETED") == "1"
"""Whether kernels run as the Python that they are written in."""

_ROOT = Path(__file__).parents[1]


def _loaded() -> Any:
    """Import the extension module; in a checkout, build it first if its sources have changed."""
    if (_ROOT.parent / "pyproject.toml").is_file():
        build(_ROOT)
    return import_module("iiwa_dnn._kernels")


_LIBRARY = _loaded()
_SOURCES: dict[int, Callable[..., Any]] = {}
_FAILED = ctypes.c_int64.from_address(_LIBRARY.failed)
_CFunction: Any = type(ctypes.pythonapi.Py_IncRef).__mro__[1]
_ERRORS: dict[int, BaseException] = {}
_KEPT: list[Any] = []


def compiled(function: Function) -> Function:
    """Return the compiled form of a kernel of the package; other functions are returned as is."""
    if not function.__module__.startswith("iiwa_dnn.") or INTERPRETED:
        return function
    found = getattr(_LIBRARY, c_name(function.__module__, function.__name__), function)
    _SOURCES[id(found)] = function
    return cast(Function, found)


released = compiled
"""As `compiled`, for a kernel that runs without Python's lock: other threads run meanwhile."""


def source_of(kernel: Any) -> Any:
    """Return the Python function of a compiled kernel; any other object is returned unchanged."""
    return _SOURCES.get(id(kernel), kernel)


def numbered_kernels() -> set[str]:
    """Return the names in C of the parts: of the kernels that can be entered by numbers."""
    return {name for name, number in _LIBRARY.numbers.items() if number}


def raise_failure() -> None:
    """Raise the error of a Python callback in this thread's last call of a kernel, if any."""
    error = _ERRORS.pop(threading.get_ident(), None)
    _FAILED.value = len(_ERRORS)
    if error is not None:
        raise error


class Entry(Generic[P, R]):
    """Decorator of a prototype: calls functions with the prototype's types by their addresses.

    A function may be a kernel of the package; a function of C with the flat arguments that
    CONTRIBUTING.md describes (given as an address, by `numba.cfunc` or by ctypes); or any Python
    function, which is called back. The address of a kernel is its number among the parts, that of
    another function its function pointer, negative.

    Attributes:
        functions: The Python function, or the object that was given, of each address.
        prototypes: The prototype of each address.
    """

    functions: ClassVar[dict[int, Any]] = {}
    prototypes: ClassVar[dict[int, Any]] = {}

    def __init__(self, prototype: Callable[P, R]) -> None:
        """Take the prototype, a function without a body whose annotations state the types."""
        self.prototype = prototype
        self._name = c_name(prototype.__module__, prototype.__name__)
        self._types = _LIBRARY.codes[self._name][1:]
        self._addresses: dict[int, tuple[int, Any]] = {}

    def __call__(self, *arguments: P.args, **keywords: P.kwargs) -> R:
        """Call the function whose address is the first argument, with the other arguments."""
        address, *own = arguments
        if INTERPRETED and address > 0:  # type: ignore[operator]
            return cast(R, self.functions[address](*own))  # type: ignore[index]
        return cast(R, getattr(_LIBRARY, self._name)(*arguments))

    def address(self, function: Any) -> int:
        """Return the address of a function.

        Raises:
            TypeError: `function` is a kernel of other types, or no function.
        """
        if id(function) not in self._addresses:
            self._addresses[id(function)] = (self._address(function), function)
        return self._addresses[id(function)][0]

    def _address(self, function: Any) -> int:
        """Make the address of a function that `address` meets for the first time."""
        source = source_of(function)
        found = getattr(function, "address", function)
        if source is not function:
            name = c_name(source.__module__, source.__name__)
            if _LIBRARY.codes[name] != self._types:
                types = _LIBRARY.codes[name]
                raise TypeError(f"{name} is a kernel of the types {types}, not {self._types}")
            address = int(_LIBRARY.numbers[name])
        elif isinstance(found, int) and found > 0:
            address = -found
        elif not callable(function):
            raise TypeError(f"{function!r} is no function")
        elif INTERPRETED and not isinstance(function, _CFunction):
            address = id(function)
        else:
            own = function if isinstance(function, _CFunction) else self._callback(function)
            _KEPT.append(own)
            address = -cast(int, ctypes.cast(own, ctypes.c_void_p).value)
        Entry.functions[address] = source
        Entry.prototypes[address] = self.prototype
        return address

    def _callback(self, function: Callable[..., Any]) -> Any:
        """Make a C function that calls a Python one and keeps its error for `raise_failure`."""
        letters, _, result = re.sub(r"\{\w+\}", "v", self._types).partition(":")
        kinds = [kind for letter in letters for kind in _FLAT.get(letter, [])]
        is_tuple = result[0] == "("
        returned: Any = {"d": ctypes.c_double, "b": ctypes.c_bool}.get(result)
        kinds += [ctypes.POINTER(ctypes.c_double)] * is_tuple
        hints = [*get_type_hints(self.prototype).values()][1:-1]

        def enter(*flat: Any) -> float:
            try:
                values = iter(flat)
                codes = iter(letters)
                answer = function(*[_rebuilt(hint, codes, values) for hint in hints])
                for i, number in enumerate(answer if is_tuple else ()):
                    flat[-1][i] = number
                return returned(answer).value if returned else 0.0
            except BaseException as error:
                _ERRORS[threading.get_ident()] = error
                _FAILED.value = len(_ERRORS)
                return 0.0

        return ctypes.CFUNCTYPE(returned, *kinds)(enter)


entry = Entry
"""`Entry`, as kernels write it: ``@entry``."""


_FLAT: dict[str, list[Any]] = {
    "i": [ctypes.c_int64],
    "d": [ctypes.c_double],
    "b": [ctypes.c_bool],
    **{letter: [ctypes.c_void_p, ctypes.c_int64] for letter in "vV"},
    **{letter: [ctypes.c_void_p, ctypes.c_int64, ctypes.c_int64] for letter in "mM"},
}


def _rebuilt(hint: Any, codes: Iterator[str], values: Iterator[Any]) -> Any:
    """Make a Python argument from the next flat arguments of a C call.

    Args:
        hint: Type of the argument; the members of a named tuple are no named tuples.
        codes: Letters of the types of the arguments, consumed.
        values: Flat arguments, consumed.
    """
    if hasattr(hint, "_fields"):
        return hint(*[_rebuilt(own, codes, values) for own in _hints(hint)])
    code = next(code for code in codes if code in _FLAT)
    first = next(values)
    if code in "idb":
        return first
    shape = [next(values) for _ in _FLAT[code][1:]]
    kind = ctypes.c_double if code in "vm" else ctypes.c_int64
    memory: Any = (kind * math.prod(shape)).from_address(first)
    array = np.ctypeslib.as_array(memory).reshape(shape)
    return hint.of(array) if isinstance(hint, type) and issubclass(hint, Record) else array


@cache
def _hints(own: type) -> list[Any]:
    """Return the types of the members of a named tuple, in their order."""
    return [*get_type_hints(own).values()]
