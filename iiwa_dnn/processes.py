"""Worker processes that end with the process that started them."""

import os
import threading
import time

_PERIOD = 0.5
"""Polling period of the parent [s]."""


def end_with(parent: int) -> None:
    """End this worker soon after its parent, also if the parent is killed by SIGKILL.

    A worker that waits for work does not notice that nobody is left to send any: other workers, and
    it itself, hold the ends of its pipes open.

    Args:
        parent: Number of the process that started this one.
    """
    threading.Thread(target=_watch, args=(parent,), daemon=True).start()


def _watch(parent: int) -> None:
    """End this process once another one has become its parent."""
    while os.getppid() == parent:
        time.sleep(_PERIOD)
    os._exit(1)
