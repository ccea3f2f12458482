"""Quadratic programs, their solutions, and the check of an answer by other solvers."""

from iiwa_dnn.qp.layout import Matrix, Vector
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.solution import Residuals, Solution, Status, register

__all__ = ["QP", "Matrix", "Residuals", "Solution", "Status", "Vector", "register"]
