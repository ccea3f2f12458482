r"""Steps at which the task has to yield to acceleration and jerk limits.

Such limits leave a command little choice, so a program whose rows contradict them is common: at a
jump of the target, at every start. Two stages answer it within microseconds. The first finds the
velocity that the joints should have, inside the velocity and position limits alone,

.. math::

    \min_{v} \; \tfrac12 \|W (A v - b)\|^2 + \tfrac12 \lambda^2 \|v - v_0\|^2
        + \tfrac12 \varepsilon\, v^T P v + \varepsilon'\, q^T v, \quad
    \lambda^2 = \Lambda^2 \max\bigl(0, 1 - (\sigma / \sigma_0)^2\bigr)

with :math:`\sigma` the smallest singular value of W A: away from singular poses it is the task's
velocity, near them it is damped, towards a slow drift :math:`v_0` along -q. A direction of singular
value s is short of its velocity by the share :math:`\lambda^2 / (\lambda^2 + s^2)` at most, so that
the tip lags a target of speed u by :math:`u \lambda^2 / (\delta s^2)`, :math:`\delta` the task's
gain; the joints' speed is at most :math:`\|W b\| / (2 \lambda)` and that of the drift. The second
stage lets each joint approach that velocity as quickly as its limits allow without passing it
(`iiwa_dnn.schemes.motion_limits.braking`): looking one step ahead only, a limited jerk would make
it swing about it for ever.

Source of the damping: Y. Nakamura, H. Hanafusa, "Inverse kinematic solutions with singularity
robustness for robot manipulator control", J. Dynamic Systems, Measurement, and Control 108 (1986).
"""

import math
from typing import NamedTuple

import numpy as np

from iiwa_dnn.control.clipping import clip_command
from iiwa_dnn.control.reach import DRIFT, Reach
from iiwa_dnn.control.state import LAST, WANTED, ControllerState, Q
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Matrix, Vector
from iiwa_dnn.qp.dense import dot
from iiwa_dnn.qp.layout import compiled, offsets
from iiwa_dnn.schemes.motion_limits import braking

DAMPING, NEAR = 0.05, 0.05
"""Lambda [m/rad] and sigma_0 [m/rad] of the damping near singular poses."""

BLEND, WISH = 1e-4, 0.1
"""Epsilon: weight of the scheme's own cost beside the task, and the share of the task's gradient in
the joints that can follow it that the cost's own gradient may reach."""

POSITION_GAIN = 20.0
"""Rate at which the wanted velocity falls towards a position limit [1/s]."""

CREEP = 0.1
"""Share of a period by which a slowed clock always advances: an arm that rests in a singular or
unreachable pose does not hold its target there."""

FULL = 0.1
"""Task velocity [m/s] below which the drift of the damping is less, so that a target is reached."""

_REACHED = 1e-9


class Yielded(NamedTuple):
    """A command where the task yields.

    Attributes:
        reach: The command, with the share of the task velocity that it gives.
        fits: Whether the task has a velocity within the limits after all.
    """

    reach: Reach
    fits: bool


class Yielding:
    """Answers of the steps at which a task yields to acceleration and jerk limits."""

    def __init__(self, limits: Vector, weights: Vector, dt: float, state: ControllerState) -> None:
        """Prepare for a robot's loop.

        Args:
            limits: `MotionLimits.constants`, (5 n,).
            weights: Weight of each task row, (p,).
            dt: Control period [s].
            state: State of the controller.
        """
        self._state = state
        self._limits = limits
        self._weights = weights
        self._dt = dt
        self._solver = DNNSolver(tol=1e-8)
        self._clipper = DNNSolver()

    def brake(self, qp: QP) -> Vector:
        """Compute the command (n,) [rad/s] that comes to rest quickest.

        It is within the bounds of `qp`, and within its rows if any velocity is.
        """
        state = self._state
        dq = np.zeros(state.past.shape[1])
        approach_velocity(self._limits, state.past, state.following, dq, qp.lb, qp.ub, self._dt)
        return clip_command(qp, dq, self._clipper)[0] if qp.sizes[1] else dq

    def answer(self, qp: QP) -> Yielded:
        """Compute the command at a program of n variables whose rows may contradict its bounds."""
        state = self._state
        n, m, p = qp.sizes
        dof = state.past.shape[1]
        data = np.empty((n + m) * (n + 1) + 2 * n)
        damping = soften(qp.data, n, m, p, self._weights, self._limits, state.past[Q], data)
        solution = self._solver.solve(QP.from_data(data, (n, m, 0)))
        x: Vector = solution.x.copy() if solution.found else np.zeros(n)
        # The scheme's own cost may not bend the task: where that can be had, all of it is wanted.
        exact = x.copy()
        on = on_rows(qp.data, n, m, p, exact)
        if on and damping == 0.0 and inside(data, n, m, 0, exact):
            x = exact
        wanted = x[:dof].copy()
        if on and inside(qp.data, n, m, p, exact):
            state.following[WANTED] = wanted
            return Yielded(Reach(1.0, x, np.zeros(n, np.int8), np.zeros(m, np.int8)), True)
        approach_velocity(
            self._limits, state.past, state.following, x[:dof], qp.lb, qp.ub, self._dt
        )
        if m:
            x[:dof] = clip_command(qp, x[:dof], self._clipper)[0]
        rhs = self._weights * qp.b
        length = float(rhs @ rhs)
        share = 1.0 if length == 0.0 else float(rhs @ (self._weights * (qp.A @ x))) / length
        sides = np.zeros(n, np.int8)
        sides[:dof] = np.sign(wanted - x[:dof]) * (np.abs(wanted - x[:dof]) > _REACHED)
        reach = Reach(min(max(share, CREEP), 1.0), x, sides, np.zeros(m, np.int8))
        return Yielded(reach, False)


@compiled
def approach_velocity(
    limits: Vector,
    past: Matrix,
    following: Matrix,
    wanted: Vector,
    lb: Vector,
    ub: Vector,
    dt: float,
) -> None:
    """Overwrite wanted velocities by the commands that approach them in the shortest time.

    Args:
        limits: `MotionLimits.constants`, (5 n,).
        past: `ControllerState.past`, (4, n).
        following: `ControllerState.following`, (4, n); the wanted velocities are noted in it.
        wanted: Velocities that are wanted [rad/s], (n,); becomes the commands.
        lb: Lower bounds [rad/s], (n,) or more.
        ub: Upper bounds [rad/s], (n,) or more.
        dt: Control period [s].
    """
    n = wanted.size
    for i in range(n):
        aim = wanted[i]
        most = limits[3 * n + i] * dt
        change = min(max(aim - past[WANTED, i], -most), most)
        behind = past[LAST, i] - (aim - change)
        dq = aim + braking(behind, lb[i] - aim, ub[i] - aim, limits[4 * n + i], dt)
        following[WANTED, i] = aim
        wanted[i] = min(max(dq, lb[i]), ub[i])


@compiled
def on_rows(data: Vector, n: int, m: int, p: int, x: Vector) -> bool:
    """Move x (n,) to the nearest point on the equality rows; return False where that fails."""
    _, _, at_A, at_lb = offsets(n, m, p)
    if p == 0:
        return True
    A, gram, missing = data[at_A : at_A + p * n].reshape(p, n), np.empty((p, p)), np.empty(p)
    for j in range(p):
        missing[j] = data[at_lb - p + j] - dot(A[j], 0, x, n)
        for k in range(p):
            gram[j, k] = dot(A[j], 0, A[k], n) + (1e-13 if j == k else 0.0)
    multiplier = np.linalg.solve(gram, missing)
    worst = 0.0
    for j in range(p):
        for i in range(n):
            x[i] += A[j, i] * multiplier[j]
    for j in range(p):
        worst = max(worst, abs(dot(A[j], 0, x, n) - data[at_lb - p + j]))
    return worst <= _REACHED


@compiled
def inside(data: Vector, n: int, m: int, p: int, x: Vector) -> bool:
    """Return whether x (n,) is within the bounds and inequality rows of a program."""
    _, at_G, _, at_lb = offsets(n, m, p)
    most = 0.0
    for i in range(n):
        most = max(most, data[at_lb + i] - x[i], x[i] - data[at_lb + n + i])
    for j in range(m):
        most = max(most, dot(data, at_G + j * n, x, n) - data[at_G + m * n + j])
    return most == 0.0


@compiled
def soften(
    data: Vector, n: int, m: int, p: int, weights: Vector, numbers: Vector, q: Vector, out: Vector
) -> float:
    """Write the program of the first stage, without equality rows, into `out`.

    Args:
        data: The step's program, laid out as `QP.data`, (size,).
        n: Number of variables.
        m: Number of inequality rows.
        p: Number of task rows.
        weights: Weight of each task row, (p,).
        numbers: `MotionLimits.constants`, (5 dof,).
        q: Joint positions [rad], (dof,).
        out: The program, (size,), in the same way.

    Returns:
        The square of the damping, lambda.
    """
    at_q, at_G, at_A, at_lb = offsets(n, m, p)
    dof, damping = q.size, 0.0
    if p > 0:
        gram = np.empty((p, p))
        for j in range(p):
            for k in range(p):
                gram[j, k] = (
                    weights[j] * weights[k] * dot(data, at_A + j * n, data[at_A + k * n :], n)
                )
        smallest = np.linalg.eigvalsh(gram)[0]
        damping = DAMPING**2 * max(0.0, 1.0 - smallest / NEAR**2)
    pull, wish = np.zeros(n), 0.0
    for j in range(p):
        for i in range(n):
            pull[i] += weights[j] * weights[j] * data[at_A + j * n + i] * data[at_lb - p + j]
    for i in range(n):
        lb, ub = data[at_lb + i], data[at_lb + n + i]
        if i < dof:
            most = numbers[2 * dof + i]
            lb = min(max(POSITION_GAIN * (numbers[i] - q[i]), -most), most)
            ub = min(max(POSITION_GAIN * (numbers[dof + i] - q[i]), -most), most)
        out[at_A + i], out[at_A + n + i] = lb, ub
    # A wish for another posture may not outweigh the task, or it would hold the tip away from its
    # target: near a singular pose, or where joints at their limits leave the task little.
    if damping == 0.0:
        free, wished = 0.0, 0.0
        for i in range(dof):
            free += min(max(pull[i], out[at_A + i]), out[at_A + n + i]) ** 2
            wished += data[at_q + i] ** 2
        wish = min(BLEND, WISH * math.sqrt(free / wished)) if wished > 0.0 else BLEND
    for i in range(at_A):
        out[i] = data[i] * (BLEND if i < at_q else wish if i < at_G else 1.0)
    for j in range(p):
        row, square = at_A + j * n, weights[j] * weights[j]
        for i in range(n):
            for k in range(n):
                out[i * n + k] += square * data[row + i] * data[row + k]
    asked, size = 0.0, math.sqrt(dot(data, at_q, data[at_q:], n))
    for j in range(p):
        asked += (weights[j] * data[at_lb - p + j]) ** 2
    drift = DRIFT * min(1.0, math.sqrt(asked) / FULL) / max(size, 1.0)
    for i in range(n):
        out[at_q + i] += damping * drift * data[at_q + i] - pull[i]
        out[i * n + i] += damping
    return damping
