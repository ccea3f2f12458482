"""The network among the solvers of qpsolvers, so that whatever solves through it can run on it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp.layout import Vector

if TYPE_CHECKING:
    import qpsolvers

NAME = "iiwa_dnn"
SOLVE: list[Callable[..., Any]] = []
"""The function that `register` enters, put here by `iiwa_dnn.networks`, a later room."""


def register() -> None:
    """Register the network as the dense solver "iiwa_dnn" of qpsolvers; twice is as good as once.

    From then on ``qpsolvers.solve_qp(P, q, ..., solver="iiwa_dnn")`` and ``solve_problem`` run
    `iiwa_dnn.solve_problem` with ``sharpen=True``, and ``qpsolvers.available_solvers`` lists it.
    Its keyword argument is ``eps_abs``, the absolute tolerance on primal residual, dual residual
    and gap (1e-9). The start is always cold: ``initvals`` is not used, nor is ``verbose``. A
    malformed or nonconvex problem raises ``qpsolvers.ProblemError``, an option of another name
    ``TypeError``.
    """
    from qpsolvers import solvers

    solvers.solve_function[NAME] = _solve_problem
    for names in (solvers.available_solvers, solvers.dense_solvers):
        if NAME not in names:
            names.append(NAME)


def _solve_problem(
    problem: qpsolvers.Problem,
    initvals: Vector | None = None,
    verbose: bool = False,
    eps_abs: float = 1e-9,
) -> qpsolvers.Solution:
    """Solve a problem as qpsolvers' own functions do; see `register`."""
    from qpsolvers import ProblemError

    try:
        solution: qpsolvers.Solution = SOLVE[0](problem, tol=eps_abs, sharpen=True)
        return solution
    except InvalidInputError as error:
        raise ProblemError(str(error)) from error
