"""Mutants of the prover, each caught by a bound below the true error of some program.

Every mutant is the source of the three modules with one place changed, run without numba. The
programs are judged exactly; one without a solution has no bound at all.
"""

from __future__ import annotations

import inspect
from fractions import Fraction
from functools import lru_cache
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
import pytest

from benchmarks import exact
from benchmarks.proofs import small, whole_numbers
from iiwa_dnn import QP
from iiwa_dnn.qp import curvature, dense, enclosure, layout, proof

pytestmark = pytest.mark.long

SOURCES = {module: inspect.getsource(module) for module in (enclosure, curvature, proof)}

MUTANTS = {
    "no rounding at all": ("_ROUNDING = 2.0**-53", "_ROUNDING = 0.0"),
    "half a rounding for each sum": ("(16 + qp.q.size", "0.02 * (0 * qp.q.size"),
    "any contraction": ("LARGEST = 0.5", "LARGEST = 1e9"),
    "last residual left out": (
        "for b in range(places.size):\n            total",
        "for b in range(places.size - 1):\n            total",
    ),
    "error of the unknowns not carried on": ("unit * abs(u[k]) + error[k]", "unit * abs(u[k])"),
    "last equality left out": (
        "for j in range(p):\n        _add_multiple",
        "for j in range(p - 1):\n        _add_multiple",
    ),
    "P as it is": ("both = P[i, k] + P[k, i]", "both = P[i, k] + P[i, k]"),
    "repeats of other limits": ("elif limits[k] != limits[j] or (", "elif (False) or ("),
    "row of zeros against its limit": ("differing += limits[j] != 0.0", "differing += 0"),
    "sign of the bounds' multipliers": (
        "multiplier = -side * value[i]",
        "multiplier = side * value[i]",
    ),
    "upper bounds not looked at": ("if not u[i] + error[i] < qp.ub[i]:", "if qp.ub[i] == -np.inf:"),
    "lower bound of another variable": (
        "u[i] - error[i] > qp.lb[i]",
        "u[i] - error[i] > qp.lb[0] - i",
    ),
    "inactive rows not looked at": (
        "and not value[at] + reach[at] < 0.0",
        "and value[at] > np.inf",
    ),
    "index of the rows": (
        "at = n + p + j\n        if following",
        "at = n + j\n        if following",
    ),
    "negative multipliers of repeats": ("error[at] == 0.0 and u[at] >= 0.0", "error[at] == 0.0"),
    "negative multipliers of rows": ("sign = _sign(u[at], error[at])", "sign = 1"),
    "negative multipliers of bounds": ("sign = _sign(multiplier, reach[i])", "sign = 1"),
    "nothing missing at rows": ("larger(0.0, error[at] - u[at]) * _length(qp.G, j)", "0.0"),
    "nothing missing at bounds": (
        "missing += larger(0.0, reach[i] - multiplier)",
        "missing += 0.0",
    ),
    "crossed bounds": ("if not qp.lb[i] <= qp.ub[i]:", "if qp.lb[i] == np.inf:"),
    "convexity not looked at": ("if not curvature >= 0.0:", "if curvature == 7.0:"),
    "wrong side of Gershgorin": (
        "(S[i, i] - (1.0 + unit) * beside)",
        "(S[i, i] + (1.0 + unit) * beside)",
    ),
    "curvature too large": ("(1.0 - unit) * (shift - loss)", "1e6 * (1.0 - unit) * (shift - loss)"),
    "curvature of another matrix": (
        "value += weight * qp.A[j, i] * qp.A[j, k]",
        "value += weight * (i == k)",
    ),
    "any P is convex": ("if simple == 0.0 or _shown", "if simple != 7.0 or _shown"),
    "distance without the answer's": ("abs(point[i] - u[i]) + error[i]", "error[i]"),
    "distance without the enclosure's": ("abs(point[i] - u[i]) + error[i]", "abs(point[i] - u[i])"),
    "distance of one variable": (
        "for i in range(qp.q.size):\n        largest = larger",
        "for i in range(1):\n        largest = larger",
    ),
}  # fmt: skip
"""Text that is replaced, at its first place in the three modules, and what stands there then."""


class Case(NamedTuple):
    """A program, an answer ``[x | y | z | z_box]`` (size,), and the exact solution if any."""

    qp: QP
    point: np.ndarray
    x: list[Fraction] | None


def prover(mutant: tuple[str, str] | None) -> Any:
    """Return `prove_point` of the three modules, one place of them changed, without numba."""
    names: dict[str, Any] = {}
    found = 0
    for module, source in SOURCES.items():
        if mutant is not None and not found and mutant[0] in source:
            found = 1
            source = source.replace(*mutant, 1)
        made = ModuleType(module.__name__)
        lines = source.replace("@compiled", "").splitlines()
        kept = [line for line in lines if not line.startswith(("@njit", "from __future__"))]
        exec(compile("\n".join(kept), module.__file__ or "", "exec"), vars(made))
        vars(made).update({name: value for name, value in names.items() if name in vars(made)})
        names |= {name: value for name, value in vars(made).items() if inspect.isfunction(value)}
        names |= {"larger": layout.larger.py_func, "cholesky_factor": dense.cholesky_factor.py_func}
        vars(made).update({name: value for name, value in names.items() if name in vars(made)})
    assert found or mutant is None, "the prover has no such place"
    return names["prove_point"]


def is_refuted(prove_point: Any, case: Case) -> bool:
    """Test whether a prover claims less than the true error."""
    n, m, _ = case.qp.sizes
    active = np.zeros(n + m, dtype=np.int64)
    with np.errstate(all="ignore"):
        bound, _ = prove_point(layout.QPViews(*case.qp.arrays()), case.point, active)
    if not bound < np.inf:
        return False
    return case.x is None or exact.distance(case.point[:n], case.x) > Fraction(float(bound))


@lru_cache
def cases() -> list[Case]:
    """Programs in which each part of the proof matters, and random ones."""
    third = 1.0 / 3.0
    made = [
        (QP([[1.0, 1.0], [1.0, 1.0 + 4e-16]], [1.0, 1.0 + 1e-9]), [0.0, 0.0], {}, True),
        (QP([[3.0, 1.0], [-1.0, 7.0]], [1.0, 1.0]), [-third, -1.0 / 7.0], {}, True),
        (QP(np.eye(1), [0.5], [[1.0], [1.0]], [1.0, 1.0]), [7.0], {"z": [3.5, -5.0]}, True),
        (QP(np.eye(1), [-3.0], [[1.0], [1.0]], [1.0, 0.5]), [1.0], {"z": [2.0, 2.0]}, True),
        (QP(np.eye(1), [0.0], A=[[0.0]], b=[1.0]), [0.0], {}, False),
        (QP(np.eye(1), [-2.0], lb=[1.0], ub=[0.0]), [0.5], {"z_box": [9.0]}, False),
        (QP([[-1.0]], [0.0], lb=[-1.0], ub=[1.0]), [0.0], {}, False),
        (QP([[1.0, 2.0], [2.0, 1.0]], [0.0, 0.0]), [0.0, 0.0], {}, False),
        (QP(-np.eye(2), [0.0, 0.0], A=[[1.0, 1.0]], b=[0.0]), [0.0, 0.0], {}, False),
        (QP(np.eye(2), [1.0, -5.0], lb=[-9.0, -1.0], ub=[9.0, 2.0]), [-1.0, 2.0], {}, True),
        (QP(np.eye(2), [9.0, 5.0], lb=[-9.0, -1.0]), [-9.0, -5.0], {}, True),
        (QP([[1e-3]], [-third], [[1.0]], [third * 1e3]), [300.0], {"z": [1.0]}, True),
        (QP([[3.0, 1e-6], [-1e-6, 7.0]], [1.0, 1.0]),
         np.linalg.solve([[3.0, -1e-6], [1e-6, 7.0]], [-1.0, -1.0]).tolist(), {}, True),
        (QP(np.diag([1.0, -0.1]), [0.0, 0.0], A=[[1.0, 0.0]], b=[0.0], lb=[-1.0, -1.0],
            ub=[1.0, 1.0]), [0.0, 0.0], {}, False),
        # The bound, or the row, is beyond the solution by 1e-10, and its multiplier -1e-16.
        (QP([[1e-6, 2e-6], [2e-6, 5e-6]], [-1.0, -2.0], ub=[1e6 + 1e-10, np.inf]),
         [1e6 + 1e-10, 0.0], {"z_box": [1.0, 0.0]}, True),
        (QP([[1e-6, 1.0], [1.0, 2e6]], [-1.0, -2e6], [[1.0, 0.0]], [1e-9]), [1e-9, 1.0],
         {"z": [1.0]}, True),
        (QP(np.eye(2), [-5.0, 3.0], [[0.0, 1.0]], [1.0], [[1.0, 0.0]], [0.0]), [0.0, 1.0],
         {"z": [1.0]}, True),
        (QP([[1e-6]], [-1.0], ub=[1e6 + 1e-9]), [1e6 + 1e-9], {"z_box": [1.0]}, True),
        (QP(1e-6 * np.eye(1), [-third * 1e-6], ub=[third]), [third], {"z_box": [1.0]}, True),
    ]  # fmt: skip
    found = []
    for qp, x, multipliers, solvable in made:
        n, m, p = qp.sizes
        point = np.zeros(2 * n + m + p)
        point[:n] = x
        point[n + p : n + p + m] = multipliers.get("z", 0.0)
        point[-n:] = multipliers.get("z_box", 0.0)
        solved = exact.exact_solution(qp, frozenset()) if solvable else None
        assert (solved is not None) is solvable
        found.append(Case(qp, point, solved))
    for seed in range(150):
        rng = np.random.default_rng([27, seed])
        found += cases_at_faces(rng, (small, whole_numbers)[seed % 2](rng))
    for seed in range(60):
        found += nearly_dependent(np.random.default_rng([28, seed]))
        found.append(flat_beside_steep(np.random.default_rng([29, seed])))
    return found


def cases_at_faces(rng: np.random.Generator, qp: QP) -> list[Case]:
    """Answers that claim a face each: its point, and multipliers of its rows and bounds alone."""
    n, m, p = qp.sizes
    program = exact.whole(qp)
    if program is None or np.linalg.matrix_rank(qp.P) < n:
        return []  # several solutions, or none
    solved = exact.exact_solution(qp, frozenset())
    if solved is None:
        return []
    found = []
    limited = [j for j, limit in enumerate(program.d) if limit is not None]
    for _ in range(4):
        face = frozenset(rng.permutation(limited)[: int(rng.integers(0, n + 1))].tolist())
        at_face = exact.at_face(program, face)
        if at_face is None:
            continue
        point = np.zeros(2 * n + m + p)
        point[:n] = [float(value) for value in at_face[0]]
        for j in face:
            place = n + p + j if j < m + n else p + j
            point[place] = 1.0 if j < m + n else -1.0
        found.append(Case(qp, point, solved))
    return found


def flat_beside_steep(rng: np.random.Generator) -> Case:
    """A bound beyond the solution by 2e-7, whose multiplier is less than the others' rounding."""
    far = 1e6 * rng.uniform(1.0, 2.0)
    P = np.array([[2.6e-7, 5e-4, 0.0], [5e-4, 1.0, 1.0], [0.0, 1.0, 1e3]])
    q = np.array([0.0, -far - rng.uniform(), 0.0])
    free = np.linalg.solve(P[:2, :2], -q[:2] - P[:2, 2] * far)
    ub = [free[0] + 2e-7, np.inf, far]
    qp = QP(P, q, lb=[-np.inf, -np.inf, far], ub=ub)
    x = [ub[0], free[1], far]
    solved = exact.exact_solution(qp, frozenset())
    assert solved is not None
    return Case(qp, np.array([*x, 1.0, 0.0, 0.0]), solved)


def nearly_dependent(rng: np.random.Generator) -> list[Case]:
    """Equality rows that differ by some roundings, and an answer by least squares."""
    row = rng.standard_normal(3)
    other = row + 1e-15 * rng.standard_normal(3)
    qp = QP(np.eye(3), rng.standard_normal(3), A=[row, other], b=[1.0, 1.0 + 1e-15 * rng.normal()])
    solved = exact.exact_solution(qp, frozenset())
    if solved is None:
        return []
    exactly = np.array([float(value) for value in solved])
    nearest = np.linalg.pinv(qp.A) @ qp.b
    found = []
    for near in (exactly, nearest, 0.0 * row, 1e3 * row, -1e3 * row):
        found.append(Case(qp, np.concatenate([near, np.zeros(5)]), solved))
    # The same within bounds that the solution may not keep.
    ub = nearest + 1e-3
    solved = exact.exact_solution(QP(qp.P, qp.q, A=qp.A, b=qp.b, ub=ub), frozenset())
    bounded = QP(qp.P, qp.q, A=qp.A, b=qp.b, ub=ub)
    for near in (exactly, nearest):
        found.append(Case(bounded, np.concatenate([near, np.zeros(5)]), solved))
    return found


def test_the_prover_itself_is_not_refuted() -> None:
    assert len(cases()) > 100
    prove_point = prover(None)
    assert [k for k, case in enumerate(cases()) if is_refuted(prove_point, case)] == []


@pytest.mark.parametrize("name", MUTANTS)
def test_a_mutant_is_caught(name: str) -> None:
    prove_point = prover(MUTANTS[name])
    assert any(is_refuted(prove_point, case) for case in cases())
