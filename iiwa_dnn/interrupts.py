"""What a script does when it is told to end: no traceback, whole files, the usual exit code."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NoReturn

INTERRUPTED = 130
"""Exit code after Ctrl-C (SIGINT): 128 and the signal's number."""

TERMINATED = 143
"""Exit code after SIGTERM, which ``kill`` sends, and systems that shut down."""


@contextmanager
def ended_by_signals() -> Iterator[None]:
    """Let Ctrl-C and SIGTERM end what is inside, or a function decorated with it, in order.

    Both become an exception, so that half-written files are removed on its way out
    (`iiwa_dnn.files.write_atomically`) and worker processes end.

    Raises:
        SystemExit: A signal came; the code is ``INTERRUPTED`` or ``TERMINATED``.
    """

    def terminate(number: int, frame: object) -> NoReturn:
        print("terminated", file=sys.stderr)
        raise SystemExit(TERMINATED)

    # Python hands signals to the main thread only, and lets no other one ask for them.
    in_charge = threading.current_thread() is threading.main_thread()
    before = signal.signal(signal.SIGTERM, terminate) if in_charge else None
    try:
        yield
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        raise SystemExit(INTERRUPTED) from None
    finally:
        if in_charge:
            signal.signal(signal.SIGTERM, before)
