"""Many small programs of one shape."""

from inspect import signature
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp.layout import Matrix
from iiwa_dnn.qp.program import FIELDS, QP, real_array
from iiwa_dnn.qp.solution import Solution

_AXES = dict(zip(FIELDS, (2, 1, 2, 1, 2, 1, 1, 1), strict=True))
"""Axes of each field of one program."""

_PROGRAM = signature(QP)


class BatchSolution(NamedTuple):
    """The answers to k programs, each with the evidence for it.

    Attributes:
        x: Primal points, (k, n). Only those that were found are answers.
        y: Multipliers of the equalities, (k, p).
        z: Multipliers of the inequalities, (k, m).
        z_box: Multipliers of the bounds, (k, n).
        found: True where every residual is at most the tolerance, (k,).
        status: Each solve's end, a value of `Status`; "not finite" where a value is wrong, (k,).
        residuals: Primal residual, dual residual and duality gap, (k, 3); NaN where a value is
            wrong.
        iterations: Linear solves, (k,).
    """

    x: Matrix
    y: Matrix
    z: Matrix
    z_box: Matrix
    found: NDArray[np.bool_]
    status: NDArray[Any]
    residuals: Matrix
    iterations: NDArray[np.int64]


def solve_batch(
    *fields: ArrayLike | None, tol: float = 1e-9, **named: ArrayLike | None
) -> BatchSolution:
    """Solve k programs one after another, each from a cold start.

    A program with a wrong value spoils no other: it is not found.

    Args:
        fields: Fields of the programs in the order of `QP`: P, q, G, h, A, b, lb, ub. Each is that
            of one program, which all share, or has a first axis of k more, as (k, n, n) for P.
        tol: Absolute tolerance on the primal residual, the dual residual and the duality gap.
        named: Fields by their names.

    Raises:
        InvalidInputError: An array has the wrong shape. The message names the argument.
    """
    checks.positive("tol", tol)
    given = _PROGRAM.bind(*fields, **named).arguments.items()
    arrays = {name: real_array(name, value) for name, value in given if value is not None}
    stacks = {name: array for name, array in arrays.items() if array.ndim > _AXES[name]}
    count = max((len(stack) for stack in stacks.values()), default=1)
    for name, stack in stacks.items():
        if len(stack) != count or count == 0:
            raise InvalidInputError(name, f"has shape {stack.shape}, for {count} programs")
    shared: dict[str, ArrayLike] = {"P": np.empty(0), "q": np.empty(0), **arrays}
    own = [{name: stack[k] for name, stack in stacks.items()} for k in range(count)]
    solutions = [_solve(QP(**{**shared, **each}), tol) for each in own]
    parts = [
        np.array([getattr(solution, name) for solution in solutions])
        for name in BatchSolution._fields
    ]
    return BatchSolution(*parts)


def _solve(qp: QP, tol: float) -> Solution:
    """Solve a program; if a value is wrong, solve one of NaN, which has status NOT_FINITE."""
    try:
        qp.check_numbers()
    except InvalidInputError:
        qp = QP.from_data(np.nan * qp.data, qp.sizes)
    return DNNSolver(tol=tol).solve(qp)
