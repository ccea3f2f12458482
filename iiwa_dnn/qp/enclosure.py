r"""Rigorous bounds on the solution of the linear system of an active set; compiled.

For a set of active rows and bounds, the variables at bounds are known, and the others u and the
multipliers of the rows solve K u = r. With an approximate inverse R and a guess :math:`\tilde u`,

.. math::

    u - \tilde u = R (r - K \tilde u) + (I - R K)(u - \tilde u) .

Where the row sums :math:`\alpha_i` of :math:`|I - R K|` are below one, K and R are regular, and
with :math:`\rho \ge |r - K \tilde u|`, :math:`\alpha = \max_i \alpha_i` and
:math:`\beta = |R| \rho`

.. math::

    |u_i - \tilde u_i| \le \beta_i + \alpha_i \, \max_k \beta_k / (1 - \alpha) .

Rounding is counted by the standard model, for which it makes no difference in which order a sum
is taken and whether a product and a sum are rounded once or twice (docs/proof.md).

Sources: R. Krawczyk, "Newton-Algorithmen zur Bestimmung von Nullstellen mit Fehlerschranken",
Computing 4 (1969); S. M. Rump, "Verification methods: rigorous results using floating-point
arithmetic", Acta Numerica 19 (2010).
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from iiwa_dnn.qp.dense import SUMS
from iiwa_dnn.qp.layout import ONE, Matrix, QPViews, Vector, compiled, larger

IntVector = NDArray[np.int64]

TINY = 1e-290
"""Bound on what underflow takes from a sum: 2^-1075 for each product, 2^-1022 if it is flushed."""

_ROUNDING = 2.0**-53
LARGEST = 0.5
"""Contraction up to which an enclosure is taken."""


@compiled
def unit_of(qp: QPViews) -> float:
    """Bound the relative rounding of all sums of an enclosure, (k + 16) 2^-53 for k terms.

    No sum has more than n + p + m terms: rows that repeat others are no unknowns, but their
    multipliers count.
    """
    return _ROUNDING * (16 + qp.q.size + qp.b.size + qp.h.size)


@compiled
def symmetric_part(P: Matrix, S: Matrix) -> None:
    """Write the symmetric part of P (n, n) into S (n, n), each entry rounded once.

    An entry that is too small to be halved becomes NaN, and nothing is proven.
    """
    for i in range(P.shape[0]):
        for k in range(P.shape[0]):
            both = P[i, k] + P[k, i]
            half = 0.5 * both
            S[i, k] = half if half + half == both else np.nan


@compiled
def evaluate(
    qp: QPViews, S: Matrix, u: Vector, spread: Vector, value: Vector, reach: Vector
) -> None:
    """Compute the gradient and the values of all rows at a point, with bounds on their errors.

    Args:
        qp: The program.
        S: Symmetric part of P, (n, n).
        u: The point [x | y | z], (n + p + m,).
        spread: Error of each entry of u, and `unit_of` times its absolute value, likewise.
        value: ``[S x + q + A^T y + G^T z | A x - b | G x - h]``, (n + p + m,), overwritten.
        reach: Bounds on the distance of `value` from the exact one at the exact point, likewise.
    """
    n = qp.q.size
    p = qp.b.size
    unit = unit_of(qp)
    for i in range(n):
        value[i] = qp.q[i]
        reach[i] = unit * abs(qp.q[i]) + TINY
    for k in range(n):
        _add_multiple(S, k, u[k], spread[k], value, reach)
    for j in range(p):
        _add_multiple(qp.A, j, u[n + j], spread[n + j], value, reach)
        value[n + j], reach[n + j] = _row_value(qp.A, j, qp.b[j], u, spread)
        reach[n + j] += unit * abs(qp.b[j])
    for j in range(qp.h.size):
        at = n + p + j
        if u[at] != 0.0 or spread[at] != 0.0:
            _add_multiple(qp.G, j, u[at], spread[at], value, reach)
        value[at], reach[at] = _row_value(qp.G, j, qp.h[j], u, spread)
        reach[at] += unit * abs(qp.h[j])
    for k in range(reach.size):
        reach[k] *= 1.0 + unit


@compiled
def _add_multiple(
    rows: Matrix, j: int, factor: float, spread: float, value: Vector, reach: Vector
) -> None:
    """Add a multiple of row j of a matrix (k, n) to the value, and its error to the reach, (n,)."""
    row = np.uint64(j)
    for i in range(np.uint64(rows.shape[1])):
        value[i] += factor * rows[row, i]
        reach[i] += spread * abs(rows[row, i])


@compiled
def _row_value(
    rows: Matrix, j: int, limit: float, u: Vector, spread: Vector
) -> tuple[float, float]:
    """Compute row j of a matrix (k, n) times u, minus its limit, and the error without the limit's.

    u and `spread` begin with the n variables, (size,).
    """
    row = np.uint64(j)
    value = -limit
    reach = TINY
    for i in range(np.uint64(rows.shape[1])):
        value += rows[row, i] * u[i]
        reach += abs(rows[row, i]) * spread[i]
    return value, reach


@compiled
def enclose(qp: QPViews, S: Matrix, active: IntVector, u: Vector, error: Vector) -> bool:
    """Solve the linear system of an active set and bound the error of every unknown.

    Args:
        qp: The program.
        S: Symmetric part of P, (n, n).
        active: The active set as in `Proof`, (n + m,).
        u: A guess ``[x | y | z]`` of size n + p + m with the active bounds in it, improved.
        error: Bounds on the distance of u from the exact solution, (n + p + m,), overwritten.

    Returns:
        False if it is not shown that the system has exactly one solution.
    """
    places = np.empty(2 * qp.q.size, np.int64)
    count, variables = _unknowns(qp, active, places)
    if count > places.size:
        return False
    K = np.empty((2 * qp.q.size, 2 * qp.q.size))
    R = np.empty((2 * qp.q.size, 2 * qp.q.size))
    alpha = np.empty(2 * qp.q.size)
    unit = unit_of(qp)
    _write_system(qp, S, places, count, K)
    largest = np.inf
    if _invert(K, R, count, variables, 0.0):
        largest = _contraction(K, R, count, variables, unit, alpha)
    if not largest < LARGEST and _invert(K, R, count, variables, _balance(K, count, variables)):
        largest = _contraction(K, R, count, variables, unit, alpha)
    if not largest < LARGEST:
        return False
    residual = np.empty(2 * qp.q.size)
    _weigh(qp, S, u, error, places[:count], residual)
    for a in range(count):
        step = 0.0
        for b in range(count):
            step += R[a, b] * error[places[b]]
        residual[a] = step
    for a in range(count):
        u[places[a]] -= residual[a]
    _weigh(qp, S, u, error, places[:count], residual)
    return _bound_error(R, alpha, largest, unit, residual, places[:count], error)


@compiled
def _unknowns(qp: QPViews, active: IntVector, places: IntVector) -> tuple[int, int]:
    """List the places of the unknowns in ``[x | y | z]``, (2 n,).

    A row 0 x = 0 holds everywhere, and one that repeats an active row wherever that does: they
    have no unknown. More than 2 n unknowns are not listed, for the rows are then dependent.

    Args:
        qp: The program.
        active: The active set as in `Proof`, (n + m,).
        places: The places, (2 n,), overwritten.

    Returns:
        The number of unknowns, and how many of them are variables: those come first.
    """
    n = qp.q.size
    p = qp.b.size
    count = 0
    variables = 0
    for i in range(n):
        if active[i] == 0:
            places[count] = i
            count += 1
    variables = count
    for j in range(p):
        if not _holds_anyway(qp.A, qp.b, j, active, p):
            count = _add_place(places, count, n + j)
    for j in range(qp.h.size):
        if active[n + j] != 0 and not _holds_anyway(qp.G, qp.h, j, active[n:], 0):
            count = _add_place(places, count, n + p + j)
    return count, variables


@compiled
def _add_place(places: IntVector, count: int, place: int) -> int:
    """Add a place to a list (size,) if there is room; return how many there are to be."""
    if count < places.size:
        places[count] = place
    return count + 1


@compiled
def _holds_anyway(rows: Matrix, limits: Vector, j: int, active: IntVector, equalities: int) -> bool:
    """Test whether row j is 0 x = 0 or repeats an active row before it, number by number.

    Args:
        rows: The rows, (k, n).
        limits: Their right-hand sides, (k,).
        j: Number of the row.
        active: For each row whether it is active, (k,).
        equalities: Number of rows that are active whatever `active` says.
    """
    for k in range(j + 1):
        # Row j itself stands for a row of zeros.
        differing = 0
        if k == j:
            differing += limits[j] != 0.0
        elif limits[k] != limits[j] or (k >= equalities and active[k] == 0):
            differing += 1
        for i in range(rows.shape[1]):
            if differing > 0:
                break
            differing += rows[j, i] != (rows[k, i] if k < j else 0.0)
        if differing == 0:
            return True
    return False


@compiled
def _write_system(qp: QPViews, S: Matrix, places: IntVector, count: int, K: Matrix) -> None:
    """Write the symmetric matrix of the system into the first rows and columns of K (2 n, 2 n)."""
    n = qp.q.size
    p = qp.b.size
    for a in range(count):
        row = places[a]
        for b in range(a + 1):
            K[a, b] = 0.0
            if row < n:
                K[a, b] = S[row, places[b]]
            elif places[b] < n:
                K[a, b] = qp.A[row - n, places[b]] if row < n + p else qp.G[row - n - p, places[b]]
            K[b, a] = K[a, b]


@compiled
def _balance(K: Matrix, count: int, variables: int) -> float:
    """Compute the weight that makes the rows' squares as large as the cost in K (size, size)."""
    cost = 0.0
    rows = 0.0
    for a in range(count):
        if a < variables:
            cost += K[a, a]
        for b in range(variables):
            if a >= variables:
                rows += K[a, b] * K[a, b]
    return cost / rows if cost > 0.0 and rows > 0.0 else 1.0


@compiled
def _invert(K: Matrix, R: Matrix, count: int, variables: int, weight: float) -> bool:
    """Write an approximate inverse of the first rows and columns of K (size, size) into R.

    K is [[S, C^T], [C, 0]]. Symmetric sweeps without pivots need a definite S: they are made with
    S + weight C^T C in its place, which changes the last block of the inverse alone.

    Args:
        K: The matrix, (size, size).
        R: Its inverse, (size, size), overwritten.
        count: How many rows and columns there are.
        variables: How many of them are those of S.
        weight: Weight of C^T C.

    Returns:
        False if a pivot is zero or no number.
    """
    column = np.empty(K.shape[0])
    for a in range(count):
        for b in range(a + 1):
            R[a, b] = K[a, b]
            if weight > 0.0 and a < variables:
                for c in range(variables, count):
                    R[a, b] += weight * K[c, a] * K[c, b]
    for k in range(count):
        if not abs(R[k, k]) > 0.0:
            return False
        _sweep(R, k, count, column)
    for a in range(count):
        for b in range(a):
            R[a, b] = -R[a, b]
            R[b, a] = R[a, b]
        R[a, a] = -R[a, a]
        if a >= variables:
            R[a, a] += weight
    return True


@compiled
def _sweep(R: Matrix, k: int, count: int, column: Vector) -> None:
    """Sweep the lower half of R (size, size) over pivot k; `column` (size,) is scratch."""
    size = np.uint64(count)
    pivot = np.uint64(k)
    scale = 1.0 / R[pivot, pivot]
    for b in range(pivot):
        column[b] = R[pivot, b]
    for a in range(pivot, size):
        column[a] = R[a, pivot]
    for a in range(size):
        factor = scale * column[a]
        for b in range(a + ONE):
            R[a, b] -= factor * column[b]
    for b in range(pivot):
        R[pivot, b] = scale * column[b]
    for a in range(pivot, size):
        R[a, pivot] = scale * column[a]
    R[pivot, pivot] = -scale


@njit(cache=True, error_model="numpy", fastmath=SUMS)
def _contraction(
    K: Matrix, R: Matrix, count: int, variables: int, unit: float, alpha: Vector
) -> float:
    """Bound the row sums of abs(I - R K), (size,), of symmetric matrices; return the largest.

    K and R are (size, size); K is zero beyond the variables in the rows that are none's.
    """
    size = np.uint64(count)
    sums = np.empty(K.shape[0])
    for k in range(size):
        total = 0.0
        for b in range(size):
            total += abs(K[k, b])
        sums[k] = total
    largest = 0.0
    for a in range(size):
        weight = 1.0
        for k in range(size):
            weight += abs(R[a, k]) * sums[k]
        total = unit * weight + TINY
        for b in range(size):
            defect = 1.0 if a == b else 0.0
            for k in range(size if b < variables else np.uint64(variables)):
                defect -= R[a, k] * K[b, k]
            total += abs(defect)
        alpha[a] = (1.0 + unit) * total
        largest = larger(largest, alpha[a])
    return largest


@compiled
def _weigh(
    qp: QPViews, S: Matrix, u: Vector, value: Vector, places: IntVector, residual: Vector
) -> None:
    """Write the residuals at u into `value`, (n + p + m,), and bounds on them into `residual`.

    The bounds (2 n,) are those of the unknowns at `places` (count,) alone.
    """
    unit = unit_of(qp)
    spread = np.empty(u.size)
    reach = np.empty(u.size)
    for k in range(u.size):
        spread[k] = unit * abs(u[k])
    evaluate(qp, S, u, spread, value, reach)
    for a in range(places.size):
        residual[a] = abs(value[places[a]]) + reach[places[a]]


@compiled
def _bound_error(
    R: Matrix,
    alpha: Vector,
    largest: float,
    unit: float,
    residual: Vector,
    places: IntVector,
    error: Vector,
) -> bool:
    """Write the bounds on the error of each unknown, zero for what is known, (n + p + m,).

    R is (2 n, 2 n), `alpha` and `residual` are (2 n,), `places` is (count,).

    Returns:
        False if a bound is not finite.
    """
    for k in range(error.size):
        error[k] = 0.0
    worst = 0.0
    for a in range(places.size):
        total = 0.0
        for b in range(places.size):
            total += abs(R[a, b]) * residual[b]
        error[places[a]] = (1.0 + unit) * (total + TINY)
        worst = larger(worst, error[places[a]])
    for a in range(places.size):
        more = alpha[a] * worst / (1.0 - largest)
        error[places[a]] = (1.0 + unit) * (error[places[a]] + more)
    return worst < np.inf
