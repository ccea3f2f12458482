"""The cross-check of a run, by worker processes beside the one that makes the programs."""

from __future__ import annotations

import os
import signal
from concurrent.futures import Future
from multiprocessing import resource_tracker

import numpy as np

from iiwa_dnn.processes import end_with
from iiwa_dnn.qp.agreement import Agreement
from iiwa_dnn.qp.crosscheck import PROOF, CrossCheck
from iiwa_dnn.qp.layout import Matrix, Sizes

_WORTH_A_PROCESS = 10_000
"""Number of programs from which on a worker process saves time; its start takes about a second."""

_QUEUED = 2
"""Blocks queued per worker: one in work, one waiting. More would only take memory."""


class CheckPool:
    """Worker processes that check blocks of programs while a run makes others.

    A block goes to the workers as long as they have fewer than two each, in work or waiting; else
    the caller's own process judges it at once.

    Attributes:
        check: The references and the tolerances.
        workers: Processes beside the caller's.
    """

    def __init__(self, check: CrossCheck, programs: int, workers: int | None = None) -> None:
        """Start the workers.

        Args:
            check: The references and the tolerances.
            programs: Number of programs that will come in all.
            workers: Processes beside the caller's; None takes the cores that are free, or none
                where so few programs would not repay them.
        """
        import loky  # with its processes' machinery, which not every run needs

        if workers is None:
            worth = programs >= _WORTH_A_PROCESS and set(check.solvers) - {PROOF}
            workers = loky.cpu_count() - 1 if worth else 0
        self.check = check
        self.workers = workers
        # Not the standard library's pool: that one runs the caller's script once more in every
        # worker, so a script without a __main__ guard would start itself again.
        self._executor = None
        if workers:
            self._executor = loky.get_reusable_executor(
                workers, timeout=60, initializer=end_with, initargs=(os.getpid(),)
            )
            # Ctrl-C in a terminal goes to all processes; the workers leave it to this one. The
            # tracker comes first: its start takes the mask away.
            resource_tracker.ensure_running()
            mask = signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT, signal.SIGTERM))
            self._executor.submit(os.getpid)  # starts them
            signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        nothing = np.empty((0, 0))
        self._verdicts: list[Agreement | Future[Agreement]] = [
            check.check_block(nothing, (0, 0, 0), nothing)
        ]

    def submit(self, programs: Matrix, sizes: Sizes, answers: Matrix) -> None:
        """Take the next block: N programs of one shape, and the answers to be judged.

        The arguments are those of `CrossCheck.check_block`.
        """
        ahead = sum(isinstance(own, Future) and not own.done() for own in self._verdicts)
        if self._executor is not None and ahead < _QUEUED * self.workers:
            future = self._executor.submit(self.check.check_block, programs, sizes, answers)
            self._verdicts.append(future)
        else:
            self._verdicts.append(self.check.check_block(programs, sizes, answers))

    def finish(self) -> Agreement:
        """Wait for every block and return the verdicts in the order of the programs."""
        verdicts = [own.result() if isinstance(own, Future) else own for own in self._verdicts]
        return Agreement(*map(np.concatenate, zip(*verdicts, strict=True)))
