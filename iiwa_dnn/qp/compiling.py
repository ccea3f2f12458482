"""Compiling at first use: once, said on the terminal, and not part of a run's wall time."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any, ClassVar

from numba import config, types
from numba.core import cgutils, event
from numba.core.dispatcher import Dispatcher
from numba.extending import intrinsic

NOTICE = "iiwa_dnn: compiling at first use, up to 20 s, once; `make setup` does it ahead"


class Watch(event.Listener):
    """A clock that runs while numba compiles.

    Attributes:
        seconds: Time spent on compiling in this process [s].
        quiet: Whether the terminal is told no more.
    """

    def __init__(self) -> None:
        """Begin to listen."""
        self.seconds = 0.0
        self.quiet = False
        self._depth = 0
        self._began = 0.0
        event.register("numba:compile", self)

    def on_start(self, event: Any) -> None:
        """Note when the outermost function begins."""
        if self._depth == 0:
            self._began = time.perf_counter()
            function = event.data["dispatcher"].py_func
            # The user's own functions may come from a string and have no module.
            own = str(function.__module__).startswith("iiwa_dnn.")
            if own and not self.quiet and sys.stderr.isatty():
                print(NOTICE, file=sys.stderr, flush=True)
                self.quiet = True
        self._depth += 1

    def on_end(self, event: Any) -> None:
        """Add the outermost function's time."""
        self._depth -= 1
        if self._depth == 0:
            self.seconds += time.perf_counter() - self._began


WATCH = Watch()


VECTOR = types.Array(types.float64, 1, "C")
MATRIX = types.Array(types.float64, 2, "C")


_INTERPRETED: bool = config.DISABLE_JIT  # type: ignore[attr-defined]


class Signature:
    """The types with which compiled code enters one of several functions by its address.

    numba optimizes all that a function calls once more with it. A function that is entered by its
    address is compiled once, only where it is used, and it may be a user's own.

    Attributes:
        enter: ``enter(address, *arguments)`` calls the function from compiled code.
    """

    _all: ClassVar[list[Signature]] = []

    def __init__(self, result: Any, *arguments: Any) -> None:
        """Take numba's types of the result (`types.void` for none) and of the arguments."""
        Signature._all.append(self)
        self._result = result
        self._arguments = arguments
        self._addresses: dict[Callable[..., Any], int] = {}
        self.enter: Any = _call_at_address(result, arguments)
        if _INTERPRETED:
            self.enter = self._call

    def address(self, function: Callable[..., Any]) -> int:
        """Return the address of a compiled function, which is compiled if it has not been yet.

        Raises:
            TypeError: The function is not compiled by numba or returns another type.
        """
        if function not in self._addresses:
            self._addresses[function] = id(function) if _INTERPRETED else self._compile(function)
        return self._addresses[function]

    @classmethod
    def entered_by(cls, enter: object) -> Signature | None:
        """Return the signature whose `enter` this is; None if it is no signature's."""
        return next((own for own in cls._all if own.enter is enter), None)

    def function_at(self, address: int) -> Callable[..., Any]:
        """Return the function whose `address` this is."""
        functions = {place: function for function, place in self._addresses.items()}
        return functions[address]

    def _compile(self, function: Any) -> int:
        if not isinstance(function, Dispatcher):
            raise TypeError(f"{function!r} is not compiled by numba")
        function.compile(self._arguments)
        made: Any = function.overloads[self._arguments]
        returned = made.signature.return_type
        if returned != self._result:
            raise TypeError(f"{made.fndesc.qualname} returns {returned}, not {self._result}")
        address: int = made.library.get_pointer_to_function(made.fndesc.llvm_func_name)
        return address

    def _call(self, address: int, *arguments: Any) -> Any:
        """Call the interpreted function that stands at an address, without numba."""
        return self.function_at(address)(*arguments)


def _call_at_address(result: Any, expected: tuple[Any, ...]) -> Any:
    """Make the function that calls a function of these types at an address."""

    @intrinsic
    def enter(typing: Any, address: Any, *arguments: Any) -> Any:
        def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            passed = cgutils.unpack_tuple(builder, values[1])
            pairs = zip(passed, arguments, expected, strict=True)
            cast = [context.cast(builder, *pair) for pair in pairs]
            kind = context.call_conv.get_function_type(result, expected)
            function = builder.inttoptr(values[0], kind.as_pointer())
            status, value = context.call_conv.call_function(
                builder, function, result, expected, cast
            )
            with builder.if_then(status.is_error, likely=False):
                context.call_conv.return_status_propagate(builder, status)
            return value

        return result(types.int64, types.StarArgTuple.from_types(arguments)), code

    return enter


@intrinsic
def _without_owner(typing: Any, array: Any) -> Any:
    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        view = context.make_array(array)(context, builder, values[0])
        view.meminfo = cgutils.get_null_value(view.meminfo.type)
        view.parent = cgutils.get_null_value(view.parent.type)
        return view._getvalue()

    return array(array), code


@intrinsic
def _mention(typing: Any, array: Any) -> Any:
    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        return context.get_dummy_value()

    return types.none(array), code


def _itself(array: Any) -> Any:
    return array


def _nothing(array: Any) -> None: ...


borrowed: Any = _itself if _INTERPRETED else _without_owner
"""Return an array whose views are not counted, to compiled code that its owner outlives.

Counting the references to a view takes longer than a row of seven numbers.
"""

outlived: Any = _nothing if _INTERPRETED else _mention
"""Say that borrowed views of an array end here: numba frees the array after its last mention."""
