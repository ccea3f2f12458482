"""The check behind a run: blocks of programs, judged by processes and by the caller."""

import time

import loky
import numpy as np
import pytest

import iiwa_dnn as d
from helpers_qp import known_qp
from iiwa_dnn.qp.agreement import Agreement
from iiwa_dnn.qp.check_pool import CheckPool
from iiwa_dnn.qp.crosscheck import CrossCheck

OSQP = CrossCheck(("osqp",))  # ProxQP does not repeat its last digits


def jobs(count: int, size: int = 20) -> list[tuple]:
    """Blocks of programs; answer i of block j is off by about i + 100 j units of 1e-7."""
    made = []
    for number in range(count):
        rng = np.random.default_rng(number)
        qps = [known_qp(rng, 5, 2, 1)[0] for _ in range(size)]
        x = np.stack([d.DNNSolver().solve(qp).x for qp in qps])
        x[:, 0] += 1e-7 * (100 * number + np.arange(size))
        made.append((np.stack([qp.data for qp in qps]), qps[0].sizes, x))
    return made


def judged(blocks: list[tuple], workers: int) -> Agreement:
    pool = CheckPool(OSQP, 1_000_000, workers)
    for block in blocks:
        pool.submit(*block)
        time.sleep(0.01 * workers)
    return pool.finish()


def test_workers_change_nothing_and_keep_the_order() -> None:
    blocks = jobs(6)
    alone = judged(blocks, 0)
    for left, right in zip(judged(blocks, 1), alone, strict=True):
        np.testing.assert_array_equal(left, right)
    # In order: the gap of program i of block j is the one that was put there.
    expected = 1e-7 * (100 * np.arange(6)[:, None] + np.arange(20)).ravel()
    np.testing.assert_allclose(alone.solution_gap[:, 0], expected, rtol=0, atol=1e-8)


def test_a_fault_of_the_check_itself_is_not_swallowed() -> None:
    programs, sizes, x = jobs(1)[0]
    with pytest.raises(ValueError, match="shape"):
        judged([(programs, sizes, np.hstack([x, x, x, x]))], 1)  # answers of a wrong shape


def test_processes_are_started_where_solvers_are_asked_often() -> None:
    assert CheckPool(OSQP, 100).workers == 0
    assert CheckPool(OSQP, 100_000).workers == loky.cpu_count() - 1
    nobody = CheckPool(CrossCheck(()), 1_000_000)
    assert nobody.workers == 0
    nobody.submit(*jobs(1)[0])
    assert nobody.finish().solution_gap.shape == (20, 0)
