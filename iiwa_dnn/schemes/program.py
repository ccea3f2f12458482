"""Program of a control step: the kernel that assembles it from the kernels of its parts.

A table, which `iiwa_dnn.schemes.layout` makes, has for each part the address of its kernel, and
where its rows and its constants lie.
"""

from enum import IntEnum
from typing import NamedTuple

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.naming import LimitKind
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import IntMatrix, QPViews, qp_views
from iiwa_dnn.references.targets import TargetData
from iiwa_dnn.schemes.parts import enter_cost, enter_limit, enter_task
from iiwa_dnn.schemes.step import StepViews


class ProgramSizes(NamedTuple):
    """Sizes of a scheme's programs, of the robot and of its targets.

    Attributes:
        n: Number of variables.
        m: Number of inequality rows.
        p: Number of equality rows.
        joints: Number of joints.
        pairs: Number of watched pairs.
        frames: Number of tracked frames.
    """

    n: int
    m: int
    p: int
    joints: int
    pairs: int
    frames: int


class BlockKind(IntEnum):
    """Kinds of parts, in the order of the rows of the table."""

    COST = 0
    TASK = 1
    SOFT_TASK = 2
    LIMIT = 3


class Column(IntEnum):
    """Columns of the table of parts.

    Members:
        KIND: `BlockKind` of the part.
        ADDRESS: Address of its kernel.
        REST: Address of a limit's second kernel, for motions to rest; 0: it has none.
        FIRST: Its first row among the program's equality or inequality rows.
        ROWS: Number of its rows; 0 for a cost.
        START: Beginning of its constants; those of a soft task are followed by its weight.
        STOP: Their end.
        TARGET: Index of the target of its frame.
    """

    KIND = 0
    ADDRESS = 1
    REST = 2
    FIRST = 3
    ROWS = 4
    START = 5
    STOP = 6
    TARGET = 7


class ProgramArrays(NamedTuple):
    """Arrays from which `assemble` writes programs; it changes none of them.

    At the desk those of the kinematics are `Kinematics`' own, overwritten by each of its updates.

    Attributes:
        sizes: Sizes of the programs.
        table: A row for each part, (parts, 8), by `Column`.
        constants: Constants of all parts, (k,).
        jacobian: `Kinematics.jacobian`, (dof, 6).
        placements: `Kinematics.placements`, (frames, 12).
        support: `Robot.support`, (frames, dof).
        inertia: `Kinematics.inertia`, (dof, dof).
        tip: Index of the first tracked frame.
    """

    sizes: ProgramSizes
    table: IntMatrix
    constants: Vector
    jacobian: Matrix
    placements: Matrix
    support: Matrix
    inertia: Matrix
    tip: int


@compiled
def program_views(data: Vector, sizes: ProgramSizes) -> QPViews:
    """Return views of the matrices and vectors in a program's `QP.data` (size,)."""
    return qp_views(data, sizes.n, sizes.m, sizes.p)


@compiled
def block_constants(arrays: ProgramArrays, k: int) -> Vector:
    """Return the constants of part k, a view."""
    start = arrays.table[k, Column.START]
    return arrays.constants[start : arrays.table[k, Column.STOP]]


@compiled
def assemble(data: Vector, arrays: ProgramArrays, step: StepViews) -> None:
    """Assemble the program of one instant.

    Writes data, step.least, step.lower_kind, step.upper_kind and step.row_pair.

    Args:
        data: The program, `QP.data`, (size,), overwritten.
        arrays: `ProgramLayout.arrays`.
        step: The instant. `least` is updated to the distances that pairs have to keep from now on,
            and the kinds of the bounds and the pairs of the rows are overwritten.
    """
    code = int(LimitKind.OTHER)
    qp = program_views(data, arrays.sizes)
    data[:] = 0.0
    qp.lb[:] = -np.inf
    qp.ub[:] = np.inf
    step.lower_kind[:] = 0.0
    step.upper_kind[:] = 0.0
    step.row_pair[:] = 0.0
    for k in range(len(arrays.table)):
        entry = arrays.table[k]
        kind = entry[Column.KIND]
        address = entry[Column.ADDRESS]
        first = entry[Column.FIRST]
        end = first + entry[Column.ROWS]
        own = block_constants(arrays, k)
        target = TargetData.of(step.targets[entry[Column.TARGET]])
        if kind == BlockKind.COST:
            enter_cost(address, step, own, qp.P, qp.q)
        elif kind == BlockKind.TASK:
            enter_task(address, step, own, target, qp.A[first:end], qp.b[first:end])
        elif kind == BlockKind.SOFT_TASK:
            A = np.zeros((end - first, qp.q.size))
            b = np.zeros(end - first)
            enter_task(address, step, own, target, A, b)
            add_soft(qp.P, qp.q, A, b, arrays.constants[entry[Column.STOP]])
        else:
            lower = qp.lb.copy()
            upper = qp.ub.copy()
            lower_kind = step.lower_kind.copy()
            upper_kind = step.upper_kind.copy()
            step.lower_kind[:] = code
            step.upper_kind[:] = code
            code += 1
            enter_limit(address, step, own, qp.G[first:end], qp.h[first:end], qp.lb, qp.ub)
            _keep_kinds(qp.lb, lower, step.lower_kind, lower_kind)
            _keep_kinds(qp.ub, upper, step.upper_kind, upper_kind)


@compiled
def _keep_kinds(bounds: Vector, before: Vector, kinds: Vector, others: Vector) -> None:
    """Set the kinds of those bounds that a limit has left as they were back to the earlier ones.

    Writes kinds.

    Args:
        bounds: Bounds after the limit's kernel, (n,).
        before: Bounds before it, (n,).
        kinds: `LimitKind` of each bound after it, (joints,).
        others: `LimitKind` of each bound before it, (joints,).
    """
    for i in range(kinds.size):
        if bounds[i] == before[i]:
            kinds[i] = others[i]


@compiled
def add_soft(P: Matrix, q: Vector, A: Matrix, b: Vector, weight: float) -> None:
    """Add the cost weight / 2 |A x - b|^2 to P (n, n) and q (n,), for A (rows, n) and b (rows,)."""
    for k in range(b.size):
        for i in range(q.size):
            scaled = weight * A[k, i]
            q[i] -= scaled * b[k]
            for j in range(q.size):
                P[i, j] += scaled * A[k, j]
