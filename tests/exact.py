"""Exact solutions of small quadratic programs in whole numbers, to judge proofs by.

Every float is a whole number times a power of two, so a program of floats is one of whole numbers.
The KKT system of an active set is solved by Bareiss's elimination, in which no number is rounded
and no fraction is needed, and its signs are looked at. Nothing here is shared with the package.
"""

from __future__ import annotations

from collections import deque
from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn.qp.program import QP

Rows = list[list[int]]
Face = frozenset[int]
"""Active constraints by their numbers: row j of G is j, the bounds follow, upper ones first."""


class WholeProgram(NamedTuple):
    """A program times a power of two: min 1/2 x^T P x + q^T x with A x = b, C x <= d."""

    P: Rows  # twice its symmetric part, (n, n)
    q: list[int]  # twice, (n,)
    Ab: Rows  # equality rows and bounds that are equal, [A | b], (p, n + 1)
    C: Rows  # inequality rows, then upper and lower bounds, (m + 2 n, n)
    d: list[int | None]  # None where there is no limit


def whole(qp: QP) -> WholeProgram:
    """Convert a program of finite coefficients."""
    one = max(float(v).as_integer_ratio()[1] for v in qp.data[np.isfinite(qp.data)])

    def numbers(matrix: ArrayLike) -> Rows:
        return [[int(Fraction(v) * one) for v in row] for row in np.atleast_2d(matrix).tolist()]

    eye = np.eye(qp.q.size)
    equal = qp.lb == qp.ub
    limits = np.concatenate([qp.h, qp.ub, -qp.lb])
    P = numbers(qp.P)
    return WholeProgram(
        [[v + P[k][i] for k, v in enumerate(row)] for i, row in enumerate(P)],
        [2 * v for v in numbers(qp.q)[0]],
        numbers(np.column_stack([np.vstack([qp.A, eye[equal]]), [*qp.b, *qp.ub[equal]]])),
        numbers(np.vstack([qp.G, eye, -eye])),
        [None if v == np.inf else numbers(v)[0][0] for v in limits],
    )


def solve(table: Rows, determined: int) -> list[Fraction] | None:
    """Solve a system [rows | right-hand side] exactly.

    None if rows contradict each other, or one of the first unknowns, so many, can be chosen; of the
    others that can, each is zero. E. H. Bareiss, "Sylvester's identity and multistep
    integer-preserving Gaussian elimination", Mathematics of Computation 22 (1968).
    """
    pivots: list[int] = []
    before = 1
    for k in range(len(table[0]) - 1):
        place = len(pivots)
        pivot = next((i for i in range(place, len(table)) if table[i][k]), None)
        if pivot is None:
            if k < determined:
                return None
            continue
        table[place], table[pivot] = table[pivot], table[place]
        pivots.append(k)
        top = table[place]
        head = top[k]
        for i, row in enumerate(table):
            factor = row[k]
            if i != place and (factor or head != before):
                table[i] = [
                    (head * v - factor * w) // before for v, w in zip(row, top, strict=True)
                ]
        before = head
    if any(row[-1] for row in table[len(pivots) :]):
        return None
    found = [Fraction(0)] * (len(table[0]) - 1)
    for k, row in zip(pivots, table, strict=False):
        found[k] = Fraction(row[-1], before)
    return found


def at_face(program: WholeProgram, face: Face) -> tuple[list[Fraction], list[Fraction]] | None:
    """Solve the KKT system of a face: x and the multipliers of its constraints, or None."""
    n = len(program.q)
    below = program.Ab + [[*program.C[j], program.d[j] or 0] for j in sorted(face)]
    none = [0] * len(below)
    table = [[*program.P[i], *(row[i] for row in below), -program.q[i]] for i in range(n)] + [
        [*row[:-1], *none, row[-1]] for row in below
    ]
    found = solve(table, n)
    return None if found is None else (found[:n], found[n + len(program.Ab) :])


def exact_solution(qp: QP, face: Face, most: int = 400) -> list[Fraction] | None:
    """Find the exact solution of a convex program, beginning at a face of its constraints.

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
            x, multipliers = found
            signs = zip(sorted(face), multipliers, strict=True)
            negative = frozenset(j for j, value in signs if value < 0)
            violated = [j for j in range(len(program.d)) if j not in face and breaks(program, j, x)]
            if not negative and not violated:
                return x
            moves = [face - negative | set(violated)] if violated else []
            moves += [face - {j} for j in sorted(negative)] + [face | {j} for j in violated]
            moves += [face - {k} | {j} for j in violated for k in sorted(face)]
        for move in moves:
            if move not in seen:
                seen.add(move)
                waiting.append(move)
    return None


def breaks(program: WholeProgram, j: int, x: list[Fraction]) -> bool:
    """Test whether a point (n,) breaks constraint j."""
    limit = program.d[j]
    reached = sum((c * v for c, v in zip(program.C[j], x, strict=True) if c), Fraction(0))
    return limit is not None and reached > limit


def face_of(qp: QP, active: np.ndarray) -> Face:
    """Return the face of an active set as in `iiwa_dnn.qp.proof.Proof`, (n + m,)."""
    n, m, _ = qp.sizes
    rows = [j for j in range(m) if active[n + j]]
    upper = [m + i for i in range(n) if active[i] > 0 and qp.lb[i] < qp.ub[i]]
    lower = [m + n + i for i in range(n) if active[i] < 0]
    return frozenset(rows + upper + lower)


def distance(x: np.ndarray, exact: list[Fraction]) -> Fraction:
    """Compute the largest distance of the entries of a point (n,) from the exact ones."""
    return max(abs(Fraction(float(v)) - w) for v, w in zip(x, exact, strict=True))


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
