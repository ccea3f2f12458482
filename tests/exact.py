"""Exact solutions of small quadratic programs in whole numbers, to judge proofs by.

Every float is a whole number times a power of two, so a program of floats is one of whole numbers.
The KKT system of an active set is solved by Bareiss's elimination, in which no number is rounded
and no fraction is needed, and its signs are looked at. Nothing here is shared with the package.
"""

from collections import deque
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from iiwa_dnn.qp.program import QP

Face = frozenset[int]
"""Active constraints by their numbers: row j of G is j, the bounds follow, upper ones first."""


class WholeProgram(NamedTuple):
    """A program times a power of two, of Python's whole numbers.

    min 1/2 x^T P x + q^T x with A x = b, C x <= d
    """

    P: Any  # twice its symmetric part, (n, n)
    q: Any  # twice, (n,)
    A: Any  # equality rows and bounds that are equal, (p, n)
    b: Any
    C: Any  # inequality rows, then upper and lower bounds, (m + 2 n, n)
    d: Any  # inf where there is no limit


def whole(qp: QP) -> WholeProgram:
    """Convert a program of finite coefficients."""
    one = max(float(v).as_integer_ratio()[1] for v in qp.data[np.isfinite(qp.data)])

    def number(value: float) -> float:
        return int(Fraction(value) * one) if np.isfinite(value) else value

    numbers = np.vectorize(number, otypes=[object])
    eye = np.eye(qp.q.size)
    equal = qp.lb == qp.ub
    P = numbers(qp.P)
    return WholeProgram(
        P + P.T,
        2 * numbers(qp.q),
        numbers(np.vstack([qp.A, eye[equal]])),
        numbers(np.concatenate([qp.b, qp.ub[equal]])),
        numbers(np.vstack([qp.G, eye, -eye])),
        numbers(np.concatenate([qp.h, qp.ub, -qp.lb])),
    )


def solve(table: Any, determined: int) -> Any:
    """Solve a system [rows | right-hand side] of whole numbers exactly.

    None if rows contradict each other, or one of the first unknowns, so many, can be chosen; of the
    others that can, each is zero. E. H. Bareiss, "Sylvester's identity and multistep
    integer-preserving Gaussian elimination", Mathematics of Computation 22 (1968).
    """
    pivots: list[int] = []
    before = 1
    for k in range(table.shape[1] - 1):
        place = len(pivots)
        rows = place + np.flatnonzero(table[place:, k])
        if rows.size:
            table[[place, rows[0]]] = table[[rows[0], place]]
            top = table[place].copy()
            table = (top[k] * table - np.outer(table[:, k], top)) // before
            table[place] = top
            before = top[k]
            pivots.append(k)
        elif k < determined:
            return None
    if table[len(pivots) :, -1].any():
        return None
    found = np.full(table.shape[1] - 1, Fraction(0))
    found[pivots] = [Fraction(value, before) for value in table[: len(pivots), -1]]
    return found


def at_face(program: WholeProgram, face: Face) -> Any:
    """Solve the KKT system of a face: x and all multipliers, its own last, or None."""
    order = sorted(face)
    rows = np.vstack([program.A, program.C[order]])
    none = np.zeros((len(rows), len(rows)), dtype=int)
    right = np.concatenate([-program.q, program.b, program.d[order]])
    table = np.column_stack([np.block([[program.P, rows.T], [rows, none]]), right])
    return solve(table, program.q.size)


def exact_solution(qp: QP, face: Face, most: int = 400) -> Any:
    """Find the exact solution (n,) of a convex program, beginning at a face of its constraints.

    Faces are left by the constraints that their point violates and by those whose multiplier is
    negative, breadth first; None if no face among so many has a point whose KKT conditions hold.
    """
    program = whole(qp)
    waiting = deque([face, frozenset()])
    seen = set(waiting)
    while waiting and len(seen) <= most:
        face = waiting.popleft()
        found = at_face(program, face)
        moves = [face - {j} for j in sorted(face)]
        if found is not None:
            x = found[: qp.q.size]
            signs = zip(sorted(face), found[len(found) - len(face) :], strict=True)
            negative = frozenset(j for j, multiplier in signs if multiplier < 0)
            violated = set(np.flatnonzero(program.C @ x > program.d).tolist()) - face
            if not negative and not violated:
                return x
            moves = [face - negative | violated] if violated else []
            moves += [face - {j} for j in sorted(negative)]
            moves += [face | {j} for j in sorted(violated)]
            moves += [face - {k} | {j} for j in sorted(violated) for k in sorted(face)]
        for move in moves:
            if move not in seen:
                seen.add(move)
                waiting.append(move)
    return None


def face_of(qp: QP, active: np.ndarray) -> Face:
    """Return the face of an active set as in `iiwa_dnn.qp.proof.Proof`, (n + m,)."""
    n, m, _ = qp.sizes
    rows = [j for j in range(m) if active[n + j]]
    upper = [m + i for i in range(n) if active[i] > 0 and qp.lb[i] < qp.ub[i]]
    lower = [m + n + i for i in range(n) if active[i] < 0]
    return frozenset(rows + upper + lower)


def distance(x: np.ndarray, exact: Any) -> Fraction:
    """Compute the largest distance of the entries of a point (n,) from the exact ones."""
    return max(abs(Fraction(v) - w) for v, w in zip(x, exact, strict=True))


def whole_numbers(rng: np.random.Generator) -> QP:
    """A program of small whole numbers around a point: rows repeat, multipliers vanish."""
    n = int(rng.integers(1, 4))
    m = int(rng.integers(0, 4))
    p = int(rng.integers(0, 2))
    q, x, *rows = rng.integers(-2, 3, (2 + n + m + p, n)).astype(float)
    root, G, A = np.split(np.reshape(rows, (-1, n)), [n, n + m])
    slack, below, above, convex = rng.integers(0, 2, (4, max(n, m)))
    P = root @ root.T + np.eye(n) * convex[0]
    return QP(P, q, G, G @ x + slack[:m], A, A @ x, x - below[:n], x + above[:n])


def small(rng: np.random.Generator) -> QP:
    """A program of 2 or 3 variables with three inequality rows and bounds."""
    n = int(rng.integers(2, 4))
    root, G = np.split(rng.standard_normal((n + 3, n)), [n])
    q, size = rng.standard_normal((2, n))
    h = rng.standard_normal(3) + 1.0
    return QP(root @ root.T, 3.0 * q, G, h, lb=-np.abs(size), ub=np.abs(size))
