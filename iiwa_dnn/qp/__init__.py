"""Quadratic programs, their solutions, and the check of an answer by other solvers."""

from iiwa_dnn.qp.program import QP, Matrix, Refutation, Residuals, Solution, Status, Vector

__all__ = ["QP", "Matrix", "Refutation", "Residuals", "Solution", "Status", "Vector"]
