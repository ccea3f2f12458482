"""Ctrl-C and SIGTERM in the middle of a command: no traceback, whole files, the usual exit code."""

import signal
import sys
import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NoReturn

_CODES = {signal.SIGINT: 130, signal.SIGTERM: 143}  # as of a shell: 128 and the signal's number
_WORDS = {signal.SIGINT: "interrupted", signal.SIGTERM: "terminated"}


@contextmanager
def ended_by_signals() -> Iterator[None]:
    """Let Ctrl-C and SIGTERM end the block, or a function decorated with it, in order.

    Both become an exception, so that half-written files are removed on its way out
    (`iiwa_dnn.files.write_atomically`) and worker processes end.

    Raises:
        SystemExit: A signal came; the code is 130 after Ctrl-C, 143 after SIGTERM.
    """
    told: list[signal.Signals] = []

    def end(number: int, frame: object) -> NoReturn:
        told.append(signal.Signals(number))
        warnings.simplefilter("ignore")  # that work is given up is no news
        if number == signal.SIGINT:
            raise KeyboardInterrupt  # as always: some parts clean up at it
        raise SystemExit(_CODES[told[-1]])

    # Python hands signals to the main thread only, and lets no other one ask for them.
    in_charge = threading.current_thread() is threading.main_thread()
    before = {number: signal.signal(number, end) for number in _CODES} if in_charge else {}
    try:
        yield
    except BaseException:
        if not told:
            raise
        # Anything else that went wrong on the way out, as in processes that were being started.
        print(_WORDS[told[0]], file=sys.stderr)
        raise SystemExit(_CODES[told[0]]) from None
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
