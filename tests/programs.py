"""Seeded random quadratic programs that are known by construction: solvable, infeasible, unbounded.

Each is built backwards from what it is to have: a KKT point, Farkas multipliers or a direction of
recession. So what a solver says of it can be judged without a second solver.
"""

import numpy as np

from iiwa_dnn.qp.program import QP, Matrix, Vector


def strictly_convex(
    rng: np.random.Generator,
    n: int | None = None,
    largest_condition: float = 1e6,
    spoilt: bool = True,
) -> tuple[QP, Vector]:
    """A strictly convex program of n variables, by default 2 to 30, and its only solution (n,).

    Up to n/2 equalities, up to 2n inequalities, and bounds on some variables or on all. At the
    solution up to n constraints are active, some of them with a zero multiplier. The condition
    number of P is up to the largest, log-uniform. If spoilt, some rows repeat others.
    """
    n = int(rng.integers(2, 31)) if n is None else n
    p = int(rng.integers(0, n // 2 + 1))
    m = int(rng.integers(0, 2 * n + 1))
    P = _positive_definite(rng, n, largest_condition ** rng.uniform())
    x = rng.standard_normal(n)
    A = rng.standard_normal((p, n))
    G = rng.standard_normal((m, n))
    if spoilt:
        _spoil(rng, A)
        _spoil(rng, G)
    # Rows that are active at x; every third of them has no multiplier.
    active = rng.permutation(m)[: int(rng.integers(0, min(m, n) + 1))]
    slack = rng.exponential(size=m) + 1e-3
    z = np.zeros(m)
    slack[active] = 0.0
    z[active] = rng.exponential(size=active.size) * (rng.integers(0, 3, active.size) > 0)
    lb, ub, z_box = _bounds(rng, x, int(rng.integers(0, n + 1)))
    y = rng.standard_normal(p)
    q = -(P @ x + A.T @ y + G.T @ z + z_box)
    return QP(P, q, G, G @ x + slack, A, A @ x, lb, ub), x


def infeasible(rng: np.random.Generator) -> QP:
    """A program whose constraints contradict each other: Farkas multipliers exist.

    Between two and n + 1 equalities, inequalities and bounds take part in the contradiction, by a
    margin between 1e-3 and 10; the others are satisfied by one point. P may be singular.
    """
    n = int(rng.integers(2, 21))
    p = int(rng.integers(0, n // 2 + 1))
    m = int(rng.integers(1, 2 * n + 1))
    A = rng.standard_normal((p, n))
    G = rng.standard_normal((m, n))
    x = rng.standard_normal(n)
    lb, ub, _ = _bounds(rng, x, 0)
    # The contradiction: y^T A + z^T G + z_box = 0, which the last inequality row sees to.
    used = int(rng.integers(0, min(n, p + m - 1) + 1))
    rows = rng.permutation(p + m - 1)[:used]
    weights = np.zeros(p + m)
    weights[rows] = rng.uniform(0.1, 1.0, used)
    y = weights[:p] * rng.choice([-1.0, 1.0], p)
    z = weights[p:]
    taking_part = rng.uniform(size=n) < (0.5 if used else 1.0)
    z_box = np.where(np.isfinite(ub), rng.uniform(0.0, 1.0, n), 0.0)
    flip = np.isfinite(lb) & (np.isinf(ub) | (rng.uniform(size=n) < 0.5))
    z_box = taking_part * np.where(flip, -rng.uniform(0.0, 1.0, n), z_box)
    z[-1] = 1.0
    G[-1] = -(A.T @ y + G[:-1].T @ z[:-1] + z_box)
    b = A @ x
    h = G @ x + rng.exponential(size=m)
    known = b @ y + h[:-1] @ z[:-1]
    known += ub[z_box > 0] @ z_box[z_box > 0] + lb[z_box < 0] @ z_box[z_box < 0]
    h[-1] = -known - 10.0 ** rng.uniform(-3.0, 1.0)
    P = _positive_definite(rng, n, 1e3 ** rng.uniform())
    if rng.uniform() < 0.3:
        factor = rng.standard_normal((int(rng.integers(0, n)), n))
        P = factor.T @ factor
    order = rng.permutation(m)
    return QP(P, rng.standard_normal(n), G[order], h[order], A, b, lb, ub)


def unbounded(rng: np.random.Generator) -> QP:
    """A feasible program whose cost falls for ever along a direction: P is singular along it."""
    n = int(rng.integers(2, 21))
    p = int(rng.integers(0, (n - 1) // 2 + 1))
    m = int(rng.integers(0, 2 * n + 1))
    x = rng.standard_normal(n)
    direction = rng.standard_normal(n)
    direction[rng.uniform(size=n) < 0.3] = 0.0
    if not direction.any():
        direction[0] = 1.0
    along = direction / (direction @ direction)
    factor = rng.standard_normal((int(rng.integers(0, n)), n))
    factor -= np.outer(factor @ direction, along)
    A = rng.standard_normal((p, n))
    G = rng.standard_normal((m, n))
    A -= np.outer(A @ direction, along)
    # A third of the inequalities runs along the direction, the others fall back from it.
    G -= np.outer(G @ direction, along)
    G -= np.outer(rng.exponential(size=m) * (rng.integers(0, 3, m) > 0), direction)
    lb, ub, _ = _bounds(rng, x, 0)
    lb[direction < 0.0] = -np.inf
    ub[direction > 0.0] = np.inf
    q = rng.standard_normal(n)
    q -= (q @ direction + 10.0 ** rng.uniform(-2.0, 1.0)) * along
    return QP(factor.T @ factor, q, G, G @ x + rng.exponential(size=m), A, A @ x, lb, ub)


def degenerate(rng: np.random.Generator, n: int | None = None) -> QP:
    """A feasible program around a vertex of the box: no interior point, multipliers up to 3e4.

    There are n variables, by default 2 to 30.

    The condition of P is up to 1e6, |q| up to 1e2; half of the programs have a doubled equality.
    """
    n = int(rng.integers(2, 31)) if n is None else n
    P = _positive_definite(rng, n, 1e6 ** rng.uniform())
    x = np.sign(rng.standard_normal(n))
    A = rng.standard_normal((int(rng.integers(0, n // 2 + 1)), n))
    if len(A) and rng.uniform() < 0.5:
        A = np.vstack([A, 2.0 * A[:1]])
    G = rng.standard_normal((int(rng.integers(0, 2 * n + 1)), n))
    slack = rng.exponential(size=len(G)) * (rng.uniform(size=len(G)) < 0.5)
    q = rng.standard_normal(n) * 10.0 ** rng.uniform(-1.0, 2.0)
    return QP(P, q, G, G @ x + slack, A, A @ x, -np.ones(n), np.ones(n))


def with_point(
    rng: np.random.Generator, flat: bool = False, room: float = 1.0
) -> tuple[QP, Vector]:
    """A program of 2 to 12 variables and its KKT point [x | y | z | z_box]; if flat, a linear one.

    Up to n constraints are active, with multipliers between 0.1 and 2; the others leave about as
    much room as said.
    """
    n = int(rng.integers(2, 13))
    p = int(rng.integers(0, n // 2 + 1))
    m = int(rng.integers(0, 2 * n + 1))
    P = np.zeros((n, n)) if flat else _positive_definite(rng, n, 1e2 ** rng.uniform())
    x = rng.standard_normal(n)
    rows = rng.standard_normal((p + m, n))
    multipliers = np.zeros(m + n)
    active = rng.permutation(m + n)[: n - p]
    multipliers[active] = rng.uniform(0.1, 2.0, active.size)
    slack = np.where(multipliers > 0.0, 0.0, room * (0.1 + rng.exponential(size=m + n)))
    y = rng.standard_normal(p)
    z, z_box = np.split(multipliers, [m])
    q = -(P @ x + rows.T @ np.concatenate([y, z]) + z_box)
    h = rows[p:] @ x + slack[:m]
    qp = QP(P, q, rows[p:], h, rows[:p], rows[:p] @ x, x - room, x + slack[m:])
    return qp, np.concatenate([x, y, z, z_box])


def badly_scaled(rng: np.random.Generator) -> QP:
    """A solvable program of 5 to 29 variables, its rows times 1e-6 to 1e6."""
    n = int(rng.integers(5, 30))
    P = _positive_definite(rng, n, 1e3)
    x = rng.standard_normal(n)
    G = rng.standard_normal((n, n))
    A = rng.standard_normal((n // 3, n))
    z = rng.exponential(size=n) * (rng.uniform(size=n) < 0.4)
    q = -(P @ x + G.T @ z + A.T @ rng.standard_normal(n // 3))
    h = G @ x + rng.exponential(size=n) * (z == 0.0)
    e, f = (10.0 ** rng.uniform(-6.0, 6.0, size) for size in (n, n // 3))
    return QP(P, q, e[:, None] * G, e * h, f[:, None] * A, f * (A @ x))


def repeated_rows(rng: np.random.Generator, n: int | None = None) -> tuple[QP, Vector]:
    """A program of n variables, by default 7 to 27, and a solution; its cost has half the rank.

    Each row stands there three times, twice times 1e-2 to 1e2; of the active ones a third has no
    multiplier.
    """
    n = int(rng.integers(7, 28)) if n is None else n
    m = int(rng.integers(1, 2 * n + 1))
    factor = rng.standard_normal((n // 2, n))
    x = rng.standard_normal(n)
    lb, ub, z_box = _bounds(rng, x, int(rng.integers(0, n // 3 + 1)))
    G = rng.standard_normal((m, n))
    active = rng.permutation(m)[: int(rng.integers(1, min(m, n) + 1))]
    slack = rng.exponential(size=m) + 1e-3
    slack[active] = 0.0
    z = np.zeros(m)
    z[active] = rng.exponential(size=active.size) * (rng.integers(0, 3, active.size) > 0)
    q = -(factor.T @ (factor @ x) + G.T @ z + z_box)
    units = np.concatenate([np.ones(m), 10.0 ** rng.uniform(-2.0, 2.0, 2 * m)])
    h = np.tile(G @ x + slack, 3)
    return QP(factor.T @ factor, q, units[:, None] * np.tile(G, (3, 1)), units * h, lb=lb, ub=ub), x


def heavy_task(rng: np.random.Generator, n: int | None = None) -> tuple[QP, Vector]:
    """A soft task of weight 2^7 to 2^30 beside a cost of 2^-6 to 1; its solution, bounds or rows.

    There are n variables, by default 2 to 40.

    The numbers have so few digits that none is rounded: the solution is exact.
    """
    n = int(rng.integers(2, 41)) if n is None else n
    x = rng.integers(-32, 33, n) / 16.0
    lb, ub, z_box = _bounds(rng, x, int(rng.integers(0, n // 3 + 1)))
    z_box = np.sign(z_box) * np.ceil(16.0 * np.abs(z_box)) / 16.0
    J = rng.integers(-16, 17, (int(rng.integers(1, min(n, 6) + 1)), n)) / 8.0
    P = 2.0 ** rng.integers(7, 31) * J.T @ J + 2.0 ** rng.integers(-6, 1) * np.eye(n)
    qp = QP(P, -(P @ x + z_box), lb=lb, ub=ub)
    return (rows_for_bounds(qp) if rng.uniform() < 0.5 else qp), x


def rows_for_bounds(qp: QP) -> QP:
    """The same program, its finite bounds as rows of plus and minus one."""
    eye = np.eye(qp.q.size)
    above, below = np.isfinite(qp.ub), np.isfinite(qp.lb)
    G = np.vstack([qp.G, eye[above], -eye[below]])
    return QP(qp.P, qp.q, G, np.concatenate([qp.h, qp.ub[above], -qp.lb[below]]), qp.A, qp.b)


def in_other_units(
    qp: QP, point: Vector, units: Vector, rows: Vector, cost: float
) -> tuple[QP, Vector]:
    """The same program of x / units (n,), its rows [A; G] and its cost times factors; its point."""
    p = qp.b.size
    A = np.outer(rows[:p], units) * qp.A
    G = np.outer(rows[p:], units) * qp.G
    P = cost * np.outer(units, units) * qp.P
    scaled = QP(P, cost * units * qp.q, G, rows[p:] * qp.h, A, rows[:p] * qp.b,
                qp.lb / units, qp.ub / units)  # fmt: skip
    of_point = np.concatenate([1.0 / units, cost / rows, cost * units])
    return scaled, of_point * point


def _positive_definite(rng: np.random.Generator, n: int, condition: float) -> Matrix:
    """A symmetric matrix with this condition number and eigenvalues spread around 1."""
    basis, _ = np.linalg.qr(rng.standard_normal((n, n)))
    exponents = rng.uniform(-0.5, 0.5, n)
    exponents[:2] = -0.5, 0.5
    P = (basis * condition**exponents) @ basis.T
    return 0.5 * (P + P.T)


def _bounds(rng: np.random.Generator, x: Vector, active: int) -> tuple[Vector, Vector, Vector]:
    """Bounds around x, `active` of which hold with a multiplier; a fifth is not there."""
    n = x.size
    lb = x - 1e-3 - rng.exponential(size=n)
    ub = x + 1e-3 + rng.exponential(size=n)
    z_box = np.zeros(n)
    for i in rng.permutation(n)[:active]:
        z_box[i] = rng.exponential() * (2.0 * rng.integers(2) - 1.0)
    ub = np.where(z_box > 0.0, x, ub)
    lb = np.where(z_box < 0.0, x, lb)
    lb[(rng.uniform(size=n) < 0.2) & (z_box >= 0.0)] = -np.inf
    ub[(rng.uniform(size=n) < 0.2) & (z_box <= 0.0)] = np.inf
    return lb, ub, z_box


def _spoil(rng: np.random.Generator, rows: Matrix) -> None:
    """Make some rows, in place, repetitions or combinations of those before them."""
    for i in range(1, rows.shape[0]):
        kind = rng.uniform()
        if kind < 0.2:
            scale = rng.uniform(0.1, 10.0) if kind > 0.1 else 1.0
            rows[i] = scale * rows[int(rng.integers(0, i))]
        elif kind < 0.3:
            rows[i] = rng.uniform(-1.0, 1.0, i) @ rows[:i]
