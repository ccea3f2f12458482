"""Exact solutions of small quadratic programs in whole numbers, to judge proofs by.

Every float is a whole number times a power of two, so a program of floats is one of whole numbers.
The KKT system of an active set is solved by Bareiss's elimination, in which no number is rounded
and no fraction is needed, and its signs are looked at. Nothing here is shared with the package.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from iiwa_dnn.qp.program import QP

Rows = list[list[int]]
Face = frozenset[int]
"""Active constraints by their numbers: row j of G is j, the bounds follow, upper ones first."""


class WholeProgram(NamedTuple):
    """A program times a power of two: min 1/2 x^T P x + q^T x with A x = b, C x <= d.

    Attributes:
        P: Twice the symmetric part of P times the power, (n, n).
        q: Twice q times the power, (n,).
        A: Equality rows and bounds that are equal, as many as are independent, (p, n).
        b: Right-hand side, (p,).
        C: Inequality rows, then upper and lower bounds, (m + 2 n, n).
        d: Right-hand side; None where there is no limit.
        one: The power.
    """

    P: Rows
    q: list[int]
    A: Rows
    b: list[int]
    C: Rows
    d: list[int | None]
    one: int


def whole(qp: QP) -> WholeProgram | None:
    """Convert a program of finite coefficients; None if equality rows contradict each other."""
    ratios = [float(v).as_integer_ratio() for v in qp.data[np.isfinite(qp.data)]]
    one = max(below for _, below in ratios)

    def number(value: float) -> int:
        above, below = float(value).as_integer_ratio()
        return above * (one // below)

    def rows(matrix: Iterable[Iterable[float]]) -> Rows:
        return [[number(v) for v in row] for row in matrix]

    n = qp.q.size
    P = rows(qp.P)
    identity = [[one * (i == k) for k in range(n)] for i in range(n)]
    table = [[*row, number(b)] for row, b in zip(rows(qp.A), qp.b, strict=True)]
    table += [[*identity[i], number(qp.ub[i])] for i in np.flatnonzero(qp.lb == qp.ub)]
    kept = independent(table)
    if kept is None:
        return None
    negative = [[-v for v in row] for row in identity]
    limits = [*qp.h, *qp.ub, *(-qp.lb)]
    return WholeProgram(
        [[P[i][k] + P[k][i] for k in range(n)] for i in range(n)],
        [2 * number(v) for v in qp.q],
        [row[:-1] for row in kept],
        [row[-1] for row in kept],
        rows(qp.G) + identity + negative,
        [None if v == np.inf else number(v) for v in limits],
        one,
    )


def independent(table: Rows) -> Rows | None:
    """Return rows [a | b] that are independent; None if a x = b contradict each other."""
    kept: Rows = []
    reduced: list[tuple[int, list[int]]] = []
    for row in table:
        left = row
        for pivot, other in reduced:
            if left[pivot]:
                factor = left[pivot]
                left = [other[pivot] * v - factor * w for v, w in zip(left, other, strict=True)]
        place = next((k for k, value in enumerate(left) if value), None)
        if place == len(row) - 1:
            return None
        if place is not None:
            kept.append(row)
            reduced.append((place, left))
    return kept


def solve(rows: Rows, right: list[int]) -> tuple[list[int], int] | None:
    """Solve a square system of whole numbers exactly: numerators and their denominator.

    None if it is singular. E. H. Bareiss, "Sylvester's identity and multistep integer-preserving
    Gaussian elimination", Mathematics of Computation 22 (1968).
    """
    size = len(rows)
    table = [[*row, value] for row, value in zip(rows, right, strict=True)]
    before = 1
    for k in range(size):
        pivot = next((i for i in range(k, size) if table[i][k]), None)
        if pivot is None:
            return None
        if pivot != k:
            table[k], table[pivot] = table[pivot], table[k]
        top = table[k]
        head = top[k]
        for i in range(size):
            if i == k:
                continue
            row = table[i]
            factor = row[k]
            if factor or head != before:
                table[i] = [
                    (head * v - factor * w) // before for v, w in zip(row, top, strict=True)
                ]
        before = head
    return [row[-1] for row in table], before


def at_face(program: WholeProgram, face: Face) -> tuple[list[Fraction], list[Fraction]] | None:
    """Solve the KKT system of a face: x and the multipliers of its constraints, or None."""
    order = sorted(face)
    n = len(program.q)
    below = program.A + [program.C[j] for j in order]
    limits = program.b + [program.d[j] or 0 for j in order]
    size = n + len(below)
    if len(below) > n:
        return None
    system = [program.P[i] + [row[i] for row in below] for i in range(n)]
    system += [row + [0] * len(below) for row in below]
    found = solve(system, [-v for v in program.q] + limits)
    if found is None:
        return None
    values, scale = found
    exact = [Fraction(value, scale) for value in values]
    assert len(exact) == size
    return exact[:n], exact[n + len(program.A) :]


def exact_solution(qp: QP, face: Face, most: int = 400) -> list[Fraction] | None:
    """Find the exact solution of a convex program, beginning at a face of its constraints.

    Faces are left by the constraints that their point violates and by those whose multiplier is
    negative, breadth first.

    Args:
        qp: The program.
        face: Constraints that are most likely active.
        most: Faces at most.

    Returns:
        x (n,), whose KKT conditions hold exactly; None if no face among so many has such a point.
    """
    program = whole(qp)
    if program is None:
        return None
    waiting = deque([face, frozenset()])
    seen = {face, frozenset()}
    while waiting and len(seen) <= most:
        face = waiting.popleft()
        moves = _moves(program, face)
        if isinstance(moves, tuple):
            return moves[0]
        for move in moves:
            if move not in seen:
                seen.add(move)
                waiting.append(move)
    return None


def _moves(program: WholeProgram, face: Face) -> list[Face] | tuple[list[Fraction]]:
    """List the faces beside one, or return its point if that is the solution."""
    found = at_face(program, face)
    if found is None:
        return [face - {j} for j in sorted(face)]
    x, multipliers = found
    negative = [j for j, value in zip(sorted(face), multipliers, strict=True) if value < 0]
    violated = [j for j in range(len(program.d)) if j not in face and not _holds(program, j, x)]
    if not negative and not violated:
        return (x,)
    moves = [face - {j} for j in negative] + [face | {j} for j in violated]
    if violated:
        moves += [face - {k} | {j} for j in violated for k in sorted(face)]
        moves.insert(0, (face - set(negative)) | set(violated))
    return moves


def _holds(program: WholeProgram, j: int, x: list[Fraction]) -> bool:
    """Test constraint j at a point (n,)."""
    limit = program.d[j]
    if limit is None:
        return True
    return sum((c * v for c, v in zip(program.C[j], x, strict=True) if c), Fraction(0)) <= limit


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
    numbers = rng.integers(-2, 3, (2 * n + m + p + 2, n)).astype(float)
    choices = rng.integers(0, 2, (4, max(n, m)))
    root = numbers[:n]
    A = numbers[n : n + p]
    G = numbers[n + p : n + p + m]
    x = numbers[-1]
    P = root @ root.T + np.eye(n) * choices[3, 0]
    return QP(
        P, numbers[-2], G, G @ x + choices[0, :m], A, A @ x, x - choices[1, :n], x + choices[2, :n]
    )


def small(rng: np.random.Generator) -> QP:
    """A program of 2 or 3 variables with three inequality rows and bounds."""
    n = int(rng.integers(2, 4))
    numbers = rng.standard_normal((n + 6, n))
    root = numbers[:n]
    size = np.abs(numbers[-2])
    return QP(
        root @ root.T,
        3.0 * numbers[-1],
        numbers[n : n + 3],
        numbers[-3:, 0] + 1.0,
        lb=-size,
        ub=size,
    )
