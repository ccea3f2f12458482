"""Ctrl-C and SIGTERM in the middle of a command: no traceback, whole files, the usual exit code."""

from __future__ import annotations

import signal
import sys
import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NoReturn

_MESSAGES = {signal.SIGINT: "interrupted", signal.SIGTERM: "terminated"}

_SOON = 0.05
"""Time until an exception that was swallowed is raised once more [s]."""


@contextmanager
def ended_by_signals() -> Iterator[None]:
    """Let Ctrl-C and SIGTERM end the block, or a function decorated with it, in order.

    Both become an exception, so that half-written files are removed on its way out
    (`iiwa_dnn.files.write_atomically`) and worker processes end.

    Raises:
        SystemExit: A signal came; the code is 130 after Ctrl-C, 143 after SIGTERM.
    """
    received: list[signal.Signals] = []

    def end(number: int, frame: object) -> NoReturn:
        received.append(signal.Signals(number))
        warnings.simplefilter("ignore")  # of work that is given up
        again(number, frame)

    def again(number: int, frame: object) -> NoReturn:
        if received[0] == signal.SIGINT:
            raise KeyboardInterrupt  # libraries clean up at it
        raise SystemExit

    def swallowed(lost: sys.UnraisableHookArgs) -> None:
        # Where LLVM calls back into Python, while it compiles, no exception gets through.
        if received and isinstance(lost.exc_value, KeyboardInterrupt | SystemExit):
            signal.setitimer(signal.ITIMER_REAL, _SOON)
        else:
            hook(lost)

    handlers = {}
    hook = sys.unraisablehook
    # Only the main thread may set handlers.
    if threading.current_thread() is threading.main_thread():
        handlers = {number: signal.signal(number, end) for number in _MESSAGES}
        handlers[signal.SIGALRM] = signal.signal(signal.SIGALRM, again)
        sys.unraisablehook = swallowed
    try:
        yield
    except BaseException:
        if not received:
            raise
        # Any other error on the way out, as of processes that were being started, is dropped.
        print(_MESSAGES[received[0]], file=sys.stderr)
        raise SystemExit(128 + received[0]) from None  # as of a shell
    finally:
        if handlers:
            signal.setitimer(signal.ITIMER_REAL, 0.0)
            sys.unraisablehook = hook
        for number, handler in handlers.items():
            signal.signal(number, handler)
