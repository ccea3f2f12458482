"""Ctrl-C and SIGTERM in the middle of a command: no traceback, whole files, the usual exit code."""

import signal
import sys
import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NoReturn

_MESSAGES = {signal.SIGINT: "interrupted", signal.SIGTERM: "terminated"}


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
        if number == signal.SIGINT:
            raise KeyboardInterrupt  # libraries clean up at it
        raise SystemExit

    handlers = {}
    # Only the main thread may set handlers.
    if threading.current_thread() is threading.main_thread():
        handlers = {number: signal.signal(number, end) for number in _MESSAGES}
    try:
        yield
    except BaseException:
        if not received:
            raise
        # Any other error on the way out, as of processes that were being started, is dropped.
        print(_MESSAGES[received[0]], file=sys.stderr)
        raise SystemExit(128 + received[0]) from None  # as of a shell
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
