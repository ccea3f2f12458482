"""Compiling at first use: once, said on the terminal, and not part of a run's wall time."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

from numba import types
from numba.core import cgutils, event
from numba.core.dispatcher import Dispatcher
from numba.core.sigutils import normalize_signature
from numba.extending import intrinsic

NOTICE = "iiwa_dnn: compiling at first use, up to 20 s, once; `iiwa-dnn warm-up` does it ahead"


class Watch(event.Listener):
    """A clock that runs while numba compiles.

    Attributes:
        seconds: Time spent on compiling in this process [s].
        quiet: Whether the terminal is told no more.
    """

    def __init__(self) -> None:
        """Begin to listen."""
        self.seconds, self.quiet = 0.0, False
        self._depth, self._began = 0, 0.0
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


class Apart:
    """A compiled function that compiled code enters by its address.

    numba optimises all that a function calls once more with it. A function that stands apart is
    compiled once, and only where it is used.

    Attributes:
        enter: Calls it from compiled code, given `address` before its own arguments.
    """

    def __init__(self, function: Callable[..., Any], signature: str) -> None:
        """Take a function, and numba's signature: ``"result(arguments)"``, V a flat array."""
        self._function: Any = function
        self._arguments, result = normalize_signature(signature.replace("V", "float64[::1]"))
        self.enter: Any = _entrance(self._arguments, result)
        if not isinstance(function, Dispatcher):  # NUMBA_DISABLE_JIT
            self.enter = lambda address, *arguments: function(*arguments)

    @property
    def address(self) -> int:
        """The address; the function is compiled, or read from disk, where it was not yet."""
        if not isinstance(self._function, Dispatcher):
            return 0
        self._function.compile(self._arguments)
        made: Any = self._function.overloads[self._arguments]
        address: int = made.library.get_pointer_to_function(made.fndesc.llvm_func_name)
        return address


def _entrance(expected: Any, result: Any) -> Any:
    """Make the call that enters a function of these types at an address."""

    @intrinsic
    def enter(typing: Any, address: Any, *arguments: Any) -> Any:
        def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            given = cgutils.unpack_tuple(builder, values[1])
            pairs = zip(given, arguments, expected, strict=True)
            cast = [context.cast(builder, *each) for each in pairs]
            kind = context.call_conv.get_function_type(result, expected)
            place = builder.inttoptr(values[0], kind.as_pointer())
            status, value = context.call_conv.call_function(builder, place, result, expected, cast)
            with builder.if_then(status.is_error, likely=False):
                context.call_conv.return_status_propagate(builder, status)
            return value

        return result(types.int64, types.StarArgTuple.from_types(arguments)), code

    return enter
