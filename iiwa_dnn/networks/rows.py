"""All rows of a program, [A; G; I; -I], with one multiplier each, compiled."""

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp.dense import add_row, row_dot
from iiwa_dnn.qp.layout import QPViews, Vector


@compiled
def rows_times(qp: QPViews, x: Vector, values: Vector) -> None:
    """Write [A; G; I; -I] x into `values`, of size p + m + 2n."""
    n = qp.q.size
    p = qp.b.size
    first = p + qp.h.size
    for j in range(p):
        values[j] = row_dot(qp.A, j, x)
    for j in range(qp.h.size):
        values[p + j] = row_dot(qp.G, j, x)
    for i in range(n):
        values[first + i] = x[i]
        values[first + n + i] = -x[i]


@compiled
def add_transposed(qp: QPViews, factor: float, s: Vector, out: Vector) -> None:
    """Add factor (A^T y + G^T z + u - l) of a state s to the first n entries of `out` (size,)."""
    n = qp.q.size
    p = qp.b.size
    at_z = n + p
    at_u = at_z + qp.h.size
    for i in range(n):
        out[i] += factor * (s[at_u + i] - s[at_u + n + i])
    for j in range(p):
        add_row(out, factor * s[n + j], qp.A, j)
    for j in range(qp.h.size):
        if s[at_z + j] != 0.0:
            add_row(out, factor * s[at_z + j], qp.G, j)


@compiled
def write_slacks(qp: QPViews, x: Vector, slacks: Vector) -> None:
    """Write A x - b, G x - h, x - ub and lb - x into `slacks` (p + m + 2n)."""
    n = qp.q.size
    p = qp.b.size
    first = p + qp.h.size
    rows_times(qp, x, slacks)
    for j in range(p):
        slacks[j] -= qp.b[j]
    for j in range(qp.h.size):
        slacks[p + j] -= qp.h[j]
    for i in range(n):
        slacks[first + i] -= qp.ub[i]
        slacks[first + n + i] += qp.lb[i]
