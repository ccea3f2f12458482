"""The cross-check behind a running loop: blocks of programs, judged here or in other processes."""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from typing import Any

from iiwa_dnn.qp.crosscheck import Agreement, CrossCheck
from iiwa_dnn.qp.layout import Matrix, Sizes

_WORTH_A_PROCESS = 10_000
"""Programs from which on a worker's start, about a second, is repaid."""

_AHEAD = 2
"""Blocks that a worker has before it: one in work, one waiting. More would only take memory."""

_LOST = (BrokenProcessPool, OSError)
"""Errors of workers that died, or of processes that are not to be had."""

Job = tuple[Matrix, Sizes, Matrix]


class CheckPool:
    """Judges blocks of programs while others are still being made.

    A block goes to a worker process that has room for it; where none has, the caller's own process
    judges it at once, as it does the blocks of a worker that died. Used as a context, it ends its
    workers where an exception leaves it.

    Attributes:
        check: The references and the tolerances.
        workers: Processes beside the caller's.
    """

    def __init__(self, check: CrossCheck, programs: int, workers: int | None = None) -> None:
        """Start nothing yet: the first block starts the workers.

        Args:
            check: The references and the tolerances.
            programs: Number of programs that will come in all.
            workers: Processes beside the caller's; None takes the cores that are free, or none
                where so few programs would not repay them.
        """
        import loky

        if workers is None:
            worth = check.asks_solvers and programs >= _WORTH_A_PROCESS
            workers = loky.cpu_count() - 1 if worth else 0
        self.check = check
        self.workers = workers
        self._verdicts: dict[int, Agreement] = {}
        self._waiting: dict[int, tuple[Future[Agreement], Job]] = {}
        self._executor: Any = None
        # Signals interrupt the main thread alone: of workers that another one starts, none is lost.
        self._starter = ThreadPoolExecutor(1)

    def __enter__(self) -> CheckPool:
        return self

    def __exit__(self, kind: type[BaseException] | None, *rest: object) -> None:
        self._starter.shutdown()
        # A worker that is just being started would go on, and complain that nobody is there.
        if kind is not None and self._executor is not None:
            self._executor.shutdown(wait=False, kill_workers=True)

    def submit(self, programs: Matrix, sizes: Sizes, answers: Matrix) -> None:
        """Take the next block: N programs of one shape, and the answers to be judged.

        The arguments are those of `CrossCheck.check_block`.
        """
        job = (programs, sizes, answers)
        number = len(self._verdicts) + len(self._waiting)
        for waiting, (future, _) in list(self._waiting.items()):
            if future.done():
                self._collect(waiting)
        if len(self._waiting) < _AHEAD * self.workers:
            try:
                future = self._starter.submit(self._hand_on, job).result()
                self._waiting[number] = (future, job)
                return
            except (*_LOST, RuntimeError):
                self.workers = 0  # no processes to be had: go on alone
        self._verdicts[number] = self.check.check_block(*job)

    def finish(self) -> Agreement:
        """Wait for every block and return the verdicts in the order of the programs."""
        for number in list(self._waiting):
            self._collect(number)
        parts = [verdict for _, verdict in sorted(self._verdicts.items())]
        return Agreement.joined(parts, len(self.check.solvers))

    def _hand_on(self, job: Job) -> Future[Agreement]:
        """Hand a block to a worker; start the workers first where there are none."""
        import loky

        # Not the standard library's pool: that one runs the caller's script once more in every
        # worker, so a script without a __main__ guard would start itself again.
        self._executor = loky.get_reusable_executor(max_workers=self.workers, timeout=60)
        future: Future[Agreement] = self._executor.submit(self.check.check_block, *job)
        return future

    def _collect(self, number: int) -> None:
        """Collect a worker's verdict; judge the block again if the worker has lost it."""
        future, job = self._waiting.pop(number)
        try:
            self._verdicts[number] = future.result()
        except _LOST:
            self.workers = 0
            self._verdicts[number] = self.check.check_block(*job)
