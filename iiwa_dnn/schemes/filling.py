"""The answers of parts written in numpy, checked and added to an assembled program."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import QP, Matrix
from iiwa_dnn.schemes.parts import Cost, Limit, Part, Task
from iiwa_dnn.schemes.step import Step

_ROUNDING = 1e-9
"""Asymmetry and negative curvature of P that are forgiven, by its largest entry."""


def fill(blocks: Sequence[Any], qp: QP, step: Step, restrained: bool, check_convex: bool) -> None:
    """Ask the parts written in numpy, and add their answers to an assembled program.

    Args:
        blocks: Their blocks in the program.
        qp: The program, n variables.
        step: The instant that the parts are asked about.
        restrained: Whether bounds of acceleration and jerk limits, which never yield, are in it.
        check_convex: Whether the costs' P have to be symmetric and positive semidefinite.

    Raises:
        InvalidInputError: A part's answer is no pair of arrays, has a wrong shape, is not finite
            where it has to be, is a P that is not convex, or bounds that cross; it is named.
    """
    for part, first, rows in blocks:
        own = slice(first, first + rows)
        if isinstance(part, Cost):
            _add_cost(qp, part, step, check_convex)
        elif isinstance(part, Task):
            _add_task(qp, part, step, own)
        else:
            if rows:
                _add_inequalities(qp, part, step, own)
            _add_bounds(qp, part, step, restrained)


def _add_cost(qp: QP, part: Cost, step: Step, check_convex: bool) -> None:
    P, q = _pair(part, "Pq", part.quadratic(step))
    width = _width(qp, step, len(P))
    _check(part, "P", P, (width, width))
    _check(part, "q", q, (width,))
    if check_convex:
        _check_convex(part, P)
    qp.P[:width, :width] += P
    qp.q[:width] += q


def _add_task(qp: QP, part: Task, step: Step, own: slice) -> None:
    A, b = _pair(part, "Ab", part.equations(step))
    rows = own.stop - own.start
    width = _width(qp, step, A.shape[-1])
    _check(part, "A", A, (rows, width))
    _check(part, "b", b, (rows,))
    if part.weight is None:
        qp.A[own, :width] = A
        qp.b[own] = b
    else:
        qp.P[:width, :width] += part.weight * A.T @ A
        qp.q[:width] -= part.weight * A.T @ b


def _add_inequalities(qp: QP, part: Limit, step: Step, own: slice) -> None:
    G, h = _pair(part, "Gh", part.inequalities(step))
    rows = own.stop - own.start
    width = _width(qp, step, G.shape[-1])
    _check(part, "G", G, (rows, width))
    _check(part, "h", h, (rows,), np.inf)
    qp.G[own, :width] = G
    qp.h[own] = h


def _add_bounds(qp: QP, part: Limit, step: Step, restrained: bool) -> None:
    bounds = part.bounds(step)
    if bounds is None:
        return
    lower, upper = _pair(part, ("lb", "ub"), bounds)
    _check(part, "lb", lower, qp.lb.shape, -np.inf)
    _check(part, "ub", upper, qp.ub.shape, np.inf)
    if (lower > upper).any():
        problem = f"lb is above ub: {lower} and {upper}"
        raise InvalidInputError(type(part).__name__, problem, bounds)
    if restrained:
        lower = np.clip(lower, qp.lb, qp.ub)
        upper = np.clip(upper, qp.lb, qp.ub)
    np.maximum(qp.lb, lower, out=qp.lb)
    np.minimum(qp.ub, upper, out=qp.ub)


def _width(qp: QP, step: Step, columns: int) -> int:
    """Return the number of variables that an answer is about; slack variables may be left out."""
    n = qp.sizes[0]
    return n if columns == n else step.robot.dof


def _pair(part: Part, names: Sequence[str], answer: object) -> tuple[Matrix, Matrix]:
    """Return both arrays of an answer; InvalidInputError names the part."""
    try:
        given: Any = answer
        first, second = (np.atleast_1d(np.asarray(x, dtype=np.float64)) for x in given)
    except (TypeError, ValueError) as error:
        problem = f"must return two arrays, {' and '.join(names)}, not {answer!r:.80}"
        raise InvalidInputError(type(part).__name__, problem, answer) from error
    return first, second


def _check(part: Part, name: str, array: Matrix, shape: tuple[int, ...], idle: float = 0.0) -> None:
    """Raise InvalidInputError unless an array has the shape and is finite, or `idle`."""
    if array.shape != shape:
        problem = f"{name} has shape {array.shape}, not {shape}"
        raise InvalidInputError(type(part).__name__, problem, array)
    finite = np.isfinite(array)
    if not finite.all() and not (finite | (array == idle)).all():
        problem = f"{name} holds {'NaN' if np.isnan(array).any() else 'an infinite number'}"
        raise InvalidInputError(type(part).__name__, problem, array)


def _check_convex(part: Part, P: Matrix) -> None:
    """Raise InvalidInputError, which names the part, unless P is symmetric and semidefinite."""
    forgiven = _ROUNDING * np.abs(P).max(initial=0.0)
    if np.abs(P - P.T).max() > forgiven:
        raise InvalidInputError(type(part).__name__, "P is not symmetric", P)
    if (least := np.linalg.eigvalsh(P)[0]) < -forgiven:
        problem = f"P is not convex, its least eigenvalue is {least:.3g}"
        raise InvalidInputError(type(part).__name__, problem, P)
