"""Mutants of the prover are caught by exact solutions."""

from __future__ import annotations

import types
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import exact
from exact import small, whole_numbers
from iiwa_dnn import QP, DNNSolver
from iiwa_dnn.qp import proof

SOURCE = Path(proof.__file__).read_text()
MUTANTS = {
    "no radius": ("return (u, error) if", "return (u, 0.0 * error) if"),
    "no rounding": ("_ROUNDING = 2.0**-53", "_ROUNDING = 0.0"),
    "nothing joins": ("& ~_is_clear(rows, u[:n], error[:n])", "& False"),
    "no sign": ("error[n:] - u[n:])", "-np.inf)"),
}


def wrong_bounds(module: types.ModuleType, count: int) -> int:
    """Count the bounds below the true error; a third of the answers is that of another program."""
    wrong = 0
    for k in range(count):
        rng = np.random.default_rng([31, k])
        qp = (small if k % 2 else whole_numbers)(rng)
        asked = qp
        if k % 3 == 1:  # without the rows, in wider bounds
            asked = QP(qp.P, qp.q, None, None, qp.A, qp.b, qp.lb - 9.0, qp.ub + 9.0)
        elif k % 3 == 2:  # with the first variable held at its upper bound
            lower = np.where(np.arange(qp.q.size) == 0, qp.ub, qp.lb)
            asked = QP(qp.P, qp.q, qp.G, qp.h, qp.A, qp.b, lower, qp.ub)
        answer = DNNSolver().solve(asked)
        z = answer.z if asked.h.size else np.zeros(qp.h.size)
        point = np.concatenate([answer.x, answer.y, z, answer.z_box])
        found = module.prove_point(qp, point)
        if found.bound < np.inf:
            x = exact.exact_solution(qp, exact.face_of(qp, found.active))
            if x is not None:
                wrong += exact.distance(point[: qp.q.size], x) > Fraction(found.bound)
    return wrong


def test_the_prover_itself_is_right() -> None:
    assert wrong_bounds(proof, 600) == 0


@pytest.mark.parametrize("name", MUTANTS)
def test_a_mutant_is_caught(name: str) -> None:
    old, new = MUTANTS[name]
    assert SOURCE.count(old) == 1
    mutant = types.ModuleType("iiwa_dnn.qp.mutant")
    exec(compile(SOURCE.replace(old, new), "mutant", "exec"), mutant.__dict__)
    assert wrong_bounds(mutant, 600) > 0
