r"""Steps at which the task has to yield to acceleration and jerk limits.

Such limits leave a command little choice, so a program whose rows contradict them is common: at a
jump of the target, at every start. Two stages answer it within microseconds. The first finds the
velocity that the joints should have, inside the velocity and position limits alone,

.. math::

    \min_{v} \; \tfrac12 \|W (A v - b)\|^2 + \tfrac12 \lambda^2 \|v\|^2
        + \varepsilon\,(\tfrac12 v^T P v + q^T v), \qquad
    \lambda^2 = \Lambda^2 \max\bigl(0, 1 - (\sigma / \sigma_0)^2\bigr)

with :math:`\sigma` the smallest singular value of W A: away from singular poses it is the task's
velocity, near them it is damped. A direction of singular value s is short of its velocity by the
share :math:`\lambda^2 / (\lambda^2 + s^2)` at most, so that the tip lags a target of speed u by
:math:`u \lambda^2 / (\delta s^2)`, :math:`\delta` the task's gain; the joints' speed is at most
:math:`\|W b\| / (2 \lambda)`. The second stage lets each joint approach that velocity as quickly as
its limits allow without passing it (`iiwa_dnn.schemes.motion_limits.braking`): looking one step
ahead only, a limited jerk would make it swing about it for ever.

Source of the damping: Y. Nakamura, H. Hanafusa, "Inverse kinematic solutions with singularity
robustness for robot manipulator control", J. Dynamic Systems, Measurement, and Control 108 (1986).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from iiwa_dnn.control.clipping import clip_command
from iiwa_dnn.control.reach import Reach
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Vector
from iiwa_dnn.schemes.motion_limits import braking

DAMPING, NEAR = 0.05, 0.05
"""Lambda [m/rad] and sigma_0 [m/rad] of the damping near singular poses."""

BLEND = 1e-4
"""Epsilon: weight of the scheme's own cost beside the task."""

POSITION_GAIN = 20.0
"""Rate at which the wanted velocity falls towards a position limit [1/s]."""

CREEP = 0.1
"""Share of a period by which a slowed clock always advances: an arm that rests in a singular or
unreachable pose does not hold its target there."""

_SHORT = 1e-3


class Yielded(NamedTuple):
    """A command where the task yields.

    Attributes:
        reach: The command with the share of the task velocity that it gives.
        fits: Whether the task's velocity is within the limits again, so that the program may have
            a solution.
    """

    reach: Reach
    fits: bool


class Yielding:
    """Answers of the steps at which a task yields to acceleration and jerk limits."""

    def __init__(
        self, numbers: Vector, past: Vector, q: Vector, weights: Vector, dt: float
    ) -> None:
        """Prepare for a robot's loop.

        Args:
            numbers: `MotionLimits.numbers`, (5 n,).
            past: The last two commands [rad/s], (2 n,), kept current by the caller.
            q: Joint positions [rad], (n,), likewise.
            weights: Weight of each task row, (p,).
            dt: Control period [s].
        """
        self._lower, self._upper, self._fastest, _, self._jerk = numbers.reshape(5, -1)
        self._last, self._q, self._weights, self._dt = past[: q.size], q, weights, dt
        self._solver, self._clipper = DNNSolver(tol=1e-8), DNNSolver()

    def brake(self, qp: QP, wanted: Vector | None = None) -> Vector:
        """Compute the command (n,) [rad/s] that approaches a velocity, by default rest, quickest.

        It is within the bounds of `qp`, and within its rows if any velocity is.
        """
        aim = np.zeros(self._q.size) if wanted is None else wanted
        lb, ub = qp.lb, qp.ub
        dq = np.array([
            aim[i] + braking(last - aim[i], lb[i] - aim[i], ub[i] - aim[i], self._jerk[i], self._dt)
            for i, last in enumerate(self._last.tolist())
        ])  # fmt: skip
        return clip_command(qp, np.clip(dq, lb[: dq.size], ub[: dq.size]), self._clipper)[0]

    def answer(self, qp: QP) -> Yielded:
        """Compute the command at a program of n variables whose rows may contradict its bounds."""
        dof, n = self._q.size, qp.sizes[0]
        rows, rhs = self._weights[:, np.newaxis] * qp.A, self._weights * qp.b
        smallest = float(np.linalg.eigvalsh(rows @ rows.T)[0]) if rhs.size else 0.0
        damping = DAMPING**2 * max(0.0, 1.0 - smallest / NEAR**2)
        lb, ub = qp.lb.copy(), qp.ub.copy()
        lb[:dof] = np.clip(POSITION_GAIN * (self._lower - self._q), -self._fastest, self._fastest)
        ub[:dof] = np.clip(POSITION_GAIN * (self._upper - self._q), -self._fastest, self._fastest)
        P = rows.T @ rows + BLEND * qp.P + damping * np.eye(n)
        program = QP(P, BLEND * qp.q - rows.T @ rhs, G=qp.G, h=qp.h, lb=lb, ub=ub)
        solution = self._solver.solve(program)
        wanted = solution.x if solution.found else np.zeros(n)
        x = wanted.copy()
        x[:dof] = self.brake(qp, wanted[:dof])
        met = rows @ x
        length = float(rhs @ rhs)
        share = 1.0 if length == 0.0 else float(np.clip(rhs @ met / length, CREEP, 1.0))
        near = np.linalg.norm(rows @ wanted - rhs) <= _SHORT * (1.0 + np.sqrt(length))
        inside = (qp.lb[:dof] <= wanted[:dof]).all() and (wanted[:dof] <= qp.ub[:dof]).all()
        sides = np.zeros(n, np.int8)
        sides[:dof] = np.sign(wanted - x)[:dof] * (np.abs(wanted - x)[:dof] > 1e-9)
        reach = Reach(share, x, sides, np.zeros(qp.sizes[1], np.int8))
        return Yielded(reach, bool(near and inside))
