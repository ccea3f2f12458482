"""A program that moves smoothly, with its exact rate of change."""

import numpy as np

from iiwa_dnn import QP


class MovingProgram:
    """Equality rows only: P, q, A and b are sinusoids of the time."""

    sizes = (3, 0, 1)

    def at(self, t: float) -> QP:
        P = np.diag([2.0 + 0.5 * np.sin(t), 3.0, 2.0 + 0.5 * np.cos(2 * t)])
        q = [np.sin(t), np.cos(3 * t), np.sin(2 * t + 1)]
        A = [[1.0, np.cos(t), np.sin(t)]]
        return QP(P, q, A=A, b=[0.5 * np.cos(2 * t)])

    def rate(self, t: float) -> np.ndarray:
        rate = QP.from_data(np.zeros(self.at(t).data.size), self.sizes)
        rate.P[:] = np.diag([0.5 * np.cos(t), 0.0, -np.sin(2 * t)])
        rate.q[:] = [np.cos(t), -3 * np.sin(3 * t), 2 * np.cos(2 * t + 1)]
        rate.A[:] = [[0.0, -np.sin(t), np.cos(t)]]
        rate.b[:] = [-np.sin(2 * t)]
        return rate.data
