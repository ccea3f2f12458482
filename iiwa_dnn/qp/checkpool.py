"""The cross-check behind a running loop: blocks of programs, judged here or in other processes.

Every block is judged exactly once, in order of its number, wherever that happens: the blocks of a
worker that dies are judged again here.
"""

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

Job = tuple[Matrix, Sizes, Matrix]


def _free_cores(programs: int) -> int:
    """Count the cores that are worth a process for so many programs."""
    import loky

    return loky.cpu_count() - 1 if programs >= _WORTH_A_PROCESS else 0


class CheckPool:
    """Judges blocks of programs while others are still being made.

    A block goes to a worker process that has room for it; where none has, the caller's own process
    judges it at once. So all cores work, and the number of waiting blocks is bounded. Used as a
    context, it ends its workers where an exception leaves it.

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
        self.check = check
        self.workers = 0
        if check.asks_solvers:
            self.workers = _free_cores(programs) if workers is None else workers
        self._judged: dict[int, Agreement] = {}
        self._waiting: dict[int, tuple[Future[Agreement], Job]] = {}
        self._count = 0
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
        number = self._count
        job = (programs, sizes, answers)
        self._count += 1
        self._collect(only_done=True)
        if len(self._waiting) < _AHEAD * self.workers:
            try:
                future = self._starter.submit(self._hand_on, job).result()
                self._waiting[number] = (future, job)
                return
            except (BrokenProcessPool, RuntimeError, OSError):
                self.workers = 0  # no processes to be had: go on alone
        self._judged[number] = self.check.check_block(*job)

    def _hand_on(self, job: Job) -> Future[Agreement]:
        """Hand a block to a worker; start the workers first where there are none."""
        import loky

        # Not the standard library's pool: that one runs the caller's script once more in every
        # worker, so a script without a __main__ guard would start itself again.
        self._executor = loky.get_reusable_executor(max_workers=self.workers, timeout=60)
        future: Future[Agreement] = self._executor.submit(self.check.check_block, *job)
        return future

    def finish(self) -> Agreement:
        """Wait for every block and return the verdicts in the order of the programs."""
        self._collect(only_done=False)
        parts = [self._judged[number] for number in range(self._count)]
        return Agreement.joined(parts, len(self.check.solvers))

    def _collect(self, only_done: bool) -> None:
        """Collect the verdicts of the workers; judge the blocks again that one has lost."""
        for number, (future, job) in list(self._waiting.items()):
            if only_done and not future.done():
                continue
            del self._waiting[number]
            try:
                verdict = future.result()
            except (BrokenProcessPool, OSError):
                self.workers = 0
                verdict = self.check.check_block(*job)
            self._judged[number] = verdict
