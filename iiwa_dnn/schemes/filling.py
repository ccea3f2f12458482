"""The answers of parts without a compiled form, checked and added to an assembled program."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import QP, Matrix, Vector
from iiwa_dnn.schemes.assembly import Layout
from iiwa_dnn.schemes.parts import Cost, Limit, Part, Step, Task

_ROUNDING = 1e-9
"""Asymmetry and negative curvature of P that are forgiven, by its largest entry."""


def fill(layout: Layout, data: Vector, step: Step, first: bool = True) -> None:
    """Ask the parts without a compiled form, and add their answers to an assembled program.

    Args:
        layout: Blocks of the program.
        data: The program, laid out as `QP.data`, (size,).
        step: The instant that the parts are asked about.
        first: Whether the costs' P are looked at too: symmetric, and positive semidefinite.

    Raises:
        InvalidInputError: A part's answer is no pair of arrays, has a wrong shape, is not finite
            where it has to be, is a P that is not convex, or bounds that cross; it is named.
    """
    qp = QP.from_data(data, layout.sizes)
    n, dof = layout.sizes[0], layout.robot.dof
    for part, start, rows in layout.custom:
        at = slice(start, start + rows)
        if isinstance(part, Cost):
            P, q = _pair(part, "Pq", part.quadratic(step))
            width = n if len(P) == n else dof  # the slack variables may be left out
            P, q = _shaped(part, "P", P, (width, width)), _shaped(part, "q", q, (width,))
            if first:
                _check_convex(part, P)
            qp.P[:width, :width] += P
            qp.q[:width] += q
        elif isinstance(part, Task):
            A, b = _pair(part, "Ab", part.equations(step))
            width = n if A.shape[-1] == n else dof
            A, b = _shaped(part, "A", A, (rows, width)), _shaped(part, "b", b, (rows,))
            if part.weight is None:
                qp.A[at, :width], qp.b[at] = A, b
            else:
                qp.P[:width, :width] += part.weight * A.T @ A
                qp.q[:width] -= part.weight * A.T @ b
        elif isinstance(part, Limit):
            if rows:
                G, h = _pair(part, "Gh", part.inequalities(step))
                width = n if G.shape[-1] == n else dof
                qp.G[at, :width] = _shaped(part, "G", G, (rows, width))
                qp.h[at] = _shaped(part, "h", h, (rows,), np.inf)
            if (bounds := part.bounds(step)) is not None:
                lower, upper = _pair(part, ("lb", "ub"), bounds)
                lower = _shaped(part, "lb", lower, (n,), -np.inf)
                upper = _shaped(part, "ub", upper, (n,), np.inf)
                if (lower > upper).any():
                    problem = f"lb is above ub: {lower} and {upper}"
                    raise InvalidInputError(type(part).__name__, problem, bounds)
                if layout.restrained:  # acceleration and jerk limits never give way
                    lower, upper = (np.clip(b, qp.lb, qp.ub) for b in (lower, upper))
                np.maximum(qp.lb, lower, out=qp.lb)
                np.minimum(qp.ub, upper, out=qp.ub)


def _pair(part: Part, names: Sequence[str], answer: object) -> tuple[Matrix, Matrix]:
    """Return both arrays of an answer; InvalidInputError names the part."""
    try:
        given: Any = answer
        first, second = (np.atleast_1d(np.asarray(x, dtype=np.float64)) for x in given)
    except (TypeError, ValueError) as error:
        problem = f"must return two arrays, {' and '.join(names)}, not {answer!r:.80}"
        raise InvalidInputError(type(part).__name__, problem, answer) from error
    return first, second


def _shaped(
    part: Part, name: str, array: Matrix, shape: tuple[int, ...], idle: float = 0.0
) -> Matrix:
    """Return an array that has the shape and is finite, or `idle`; else InvalidInputError."""
    if array.shape != shape:
        problem = f"{name} has shape {array.shape}, not {shape}"
        raise InvalidInputError(type(part).__name__, problem, array)
    finite = np.isfinite(array)
    if not finite.all() and not (finite | (array == idle)).all():
        problem = f"{name} holds {'NaN' if np.isnan(array).any() else 'an infinite number'}"
        raise InvalidInputError(type(part).__name__, problem, array)
    return array


def _check_convex(part: Part, P: Matrix) -> None:
    """Raise InvalidInputError, which names the part, unless P is symmetric and semidefinite."""
    forgiven = _ROUNDING * np.abs(P).max(initial=0.0)
    if np.abs(P - P.T).max() > forgiven:
        raise InvalidInputError(type(part).__name__, "P is not symmetric", P)
    if (least := np.linalg.eigvalsh(P)[0]) < -forgiven:
        problem = f"P is not convex, its least eigenvalue is {least:.3g}"
        raise InvalidInputError(type(part).__name__, problem, P)
