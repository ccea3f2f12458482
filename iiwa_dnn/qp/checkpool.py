"""The cross-check behind a running loop: blocks of programs, judged here or in other processes."""

from __future__ import annotations

from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from typing import Any, NamedTuple

from iiwa_dnn.qp.crosscheck import Agreement, CrossCheck
from iiwa_dnn.qp.layout import Matrix, Sizes

_WORTH_A_PROCESS = 10_000
"""Programs from which on a worker's start, about a second, is repaid."""

_AHEAD = 2
"""Blocks that a worker has before it: one in work, one waiting. More would only take memory."""


class _HandedOn(NamedTuple):
    """A block that a worker has, and its verdict to come."""

    verdict: Future[Agreement]
    job: tuple[Matrix, Sizes, Matrix]


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
        import loky  # with its processes' machinery, which not every run needs

        if workers is None:
            worth = check.asks_solvers and programs >= _WORTH_A_PROCESS
            workers = loky.cpu_count() - 1 if worth else 0
        self.check = check
        self.workers = workers
        self._parts: list[Agreement | _HandedOn] = []

    def __enter__(self) -> CheckPool:
        return self

    def __exit__(self, kind: type[BaseException] | None, *rest: object) -> None:
        if kind is not None and self.workers:
            self._executor().shutdown(wait=False, kill_workers=True)

    def submit(self, programs: Matrix, sizes: Sizes, answers: Matrix) -> None:
        """Take the next block: N programs of one shape, and the answers to be judged.

        The arguments are those of `CrossCheck.check_block`.
        """
        job = (programs, sizes, answers)
        self._parts = [self._judged(part) if _is_done(part) else part for part in self._parts]
        ahead = sum(not _is_done(part) for part in self._parts)
        if ahead < _AHEAD * self.workers:
            try:
                future = self._executor().submit(self.check.check_block, *job)
                self._parts.append(_HandedOn(future, job))
                return
            except (BrokenProcessPool, OSError):
                self.workers = 0  # no processes to be had: go on alone
        self._parts.append(self.check.check_block(*job))

    def finish(self) -> Agreement:
        """Wait for every block and return the verdicts in the order of the programs."""
        verdicts = [self._judged(part) for part in self._parts]
        return Agreement.joined(verdicts, len(self.check.solvers))

    def _executor(self) -> Any:
        """Return the worker processes, which are started where there are none."""
        import loky

        # Not the standard library's pool: that one runs the caller's script once more in every
        # worker, so a script without a __main__ guard would start itself again.
        return loky.get_reusable_executor(max_workers=self.workers, timeout=60)

    def _judged(self, part: Agreement | _HandedOn) -> Agreement:
        """Return a block's verdict; judge the block again if the worker has lost it."""
        if isinstance(part, Agreement):
            return part
        try:
            return part.verdict.result()
        except (BrokenProcessPool, OSError):
            self.workers = 0
            return self.check.check_block(*part.job)


def _is_done(part: Agreement | _HandedOn) -> bool:
    return isinstance(part, Agreement) or part.verdict.done()
