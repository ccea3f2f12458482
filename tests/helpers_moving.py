"""A program that moves smoothly."""

import numpy as np

from iiwa_dnn import QP


class MovingProgram:
    """Equality rows only: P, q, A and b are sinusoids of the time."""

    def at(self, t: float) -> QP:
        P = np.diag([2.0 + 0.5 * np.sin(t), 3.0, 2.0 + 0.5 * np.cos(2 * t)])
        q = [np.sin(t), np.cos(3 * t), np.sin(2 * t + 1)]
        A = [[1.0, np.cos(t), np.sin(t)]]
        return QP(P, q, A=A, b=[0.5 * np.cos(2 * t)])
