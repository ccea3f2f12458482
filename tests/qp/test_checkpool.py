"""The check behind the loop: order, completeness, and workers that die."""

from __future__ import annotations

import os
import signal
import time
from concurrent.futures import wait
from concurrent.futures.process import BrokenProcessPool
from multiprocessing.connection import wait as ended

import loky
import numpy as np
import pytest
from loky.process_executor import ProcessPoolExecutor

from helpers_qp import known_qp
from iiwa_dnn import DNNSolver
from iiwa_dnn.qp.checkpool import CheckPool, Job
from iiwa_dnn.qp.crosscheck import Agreement, CrossCheck

CHECK = CrossCheck(("osqp",))  # ProxQP does not repeat its last digits


def jobs(count: int, size: int = 20) -> list[Job]:
    """Blocks of programs; answer i of block j is off by about i + 100 j units of 1e-7."""
    made = []
    for number in range(count):
        rng = np.random.default_rng(number)
        qps = [known_qp(rng, 5, 2, 1)[0] for _ in range(size)]
        x = np.stack([DNNSolver().solve(qp).x for qp in qps])
        x[:, 0] += 1e-7 * (100 * number + np.arange(size))
        made.append((np.stack([qp.data for qp in qps]), qps[0].sizes, x))
    return made


def judged(pool: CheckPool, blocks: list[Job]) -> Agreement:
    for block in blocks:
        pool.submit(*block)
    return pool.finish()


def assert_same(one: Agreement, other: Agreement) -> None:
    for left, right in zip(one, other, strict=True):
        np.testing.assert_array_equal(left, right)


def test_workers_change_nothing_and_keep_the_order() -> None:
    blocks = jobs(6)
    alone = judged(CheckPool(CHECK, 120, workers=0), blocks)
    assert_same(judged(CheckPool(CHECK, 120, workers=1), blocks), alone)
    # In order: the gap of program i of block j is the one that was put there.
    expected = 1e-7 * (100 * np.arange(6)[:, None] + np.arange(20)).ravel()
    np.testing.assert_allclose(alone.solution_gap[:, 0], expected, rtol=0, atol=1e-8)


def test_a_fault_of_the_check_itself_is_not_swallowed() -> None:
    programs, sizes, x = jobs(1)[0]
    pool = CheckPool(CHECK, 20, workers=1)
    pool.submit(programs, sizes, x[:, :3])  # answers of a wrong shape
    with pytest.raises(ValueError, match="shapes"):
        pool.finish()


@pytest.mark.long
def test_a_worker_that_dies_in_the_middle_of_a_block() -> None:
    class Dying(CrossCheck):
        """Kills the process that it runs in, unless that is the test's own."""

        home = os.getpid()

        def check_block(self, *job: object) -> Agreement:
            if os.getpid() != self.home:
                os.kill(os.getpid(), signal.SIGKILL)
            return super().check_block(*job)

    blocks = jobs(6)
    pool = CheckPool(Dying(CHECK.solvers), 120, workers=1)
    for block in blocks[:3]:
        pool.submit(*block)
    wait([future for future, _ in pool._waiting.values()], timeout=60.0)
    for block in blocks[3:]:
        pool.submit(*block)
    assert pool.workers == 0  # noticed
    assert_same(pool.finish(), judged(CheckPool(CHECK, 120, workers=0), blocks))


def test_without_processes_to_be_had_the_caller_judges_alone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def refuse(**options: object) -> None:
        raise BrokenProcessPool

    monkeypatch.setattr(loky, "get_reusable_executor", refuse)
    blocks = jobs(2)
    pool = CheckPool(CHECK, 40, workers=1)
    assert_same(judged(pool, blocks), judged(CheckPool(CHECK, 40, workers=0), blocks))


def test_nobody_is_asked_where_there_is_no_reference() -> None:
    pool = CheckPool(CrossCheck(()), 1_000_000)
    assert pool.workers == 0
    verdict = judged(pool, jobs(2))
    assert verdict.solution_gap.shape == (40, 0)


def test_few_programs_start_no_process() -> None:
    assert CheckPool(CHECK, 100).workers == 0
    assert CheckPool(CHECK, 100_000).workers == loky.cpu_count() - 1


def test_an_interrupt_while_workers_start_leaves_none(monkeypatch: pytest.MonkeyPatch) -> None:
    """One that came between their start and that of their manager left them for a minute."""
    loky.get_reusable_executor().shutdown(kill_workers=True)
    manage = ProcessPoolExecutor._start_executor_manager_thread
    workers = []

    def interrupted(executor: ProcessPoolExecutor) -> None:
        workers.extend(executor._processes.values())
        time.sleep(1.0)  # until the worker waits for work
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(0.1)
        manage(executor)

    monkeypatch.setattr(ProcessPoolExecutor, "_start_executor_manager_thread", interrupted)
    job = jobs(1)[0]
    # A background job ignores it.
    previous = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt), CheckPool(CHECK, 20, workers=1) as pool:
            pool.submit(*job)
    finally:
        signal.signal(signal.SIGINT, previous)
    assert workers
    for worker in workers:
        assert ended([worker.sentinel], 20.0)
