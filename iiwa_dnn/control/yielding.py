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
from iiwa_dnn.qp.layout import QPViews, compiled, qp_views
from iiwa_dnn.schemes.motion_limits import braking

DAMPING = 0.05
NEAR = 0.05
"""Lambda [m/rad] and sigma_0 [m/rad] of the damping near singular poses."""

BLEND = 1e-4
WISH = 0.1
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
        damping = soften(qp.data, qp.sizes, self._weights, self._limits, state.past[Q], data)
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
    if p == 0:
        return True
    qp = qp_views(data, n, m, p)
    gram = np.empty((p, p))
    missing = np.empty(p)
    for j in range(p):
        missing[j] = qp.b[j] - _product(qp.A, j, x)
        for k in range(p):
            gram[j, k] = _product(qp.A, j, qp.A[k]) + (1e-13 if j == k else 0.0)
    multiplier = np.linalg.solve(gram, missing)
    for j in range(p):
        for i in range(n):
            x[i] += qp.A[j, i] * multiplier[j]
    worst = 0.0
    for j in range(p):
        worst = max(worst, abs(_product(qp.A, j, x) - qp.b[j]))
    return worst <= _REACHED


@compiled
def _product(rows: Matrix, j: int, x: Vector) -> float:
    """Compute the product of row j and a point x (n,)."""
    value = 0.0
    for i in range(x.size):
        value += rows[j, i] * x[i]
    return value


@compiled
def inside(data: Vector, n: int, m: int, p: int, x: Vector) -> bool:
    """Return whether x (n,) is within the bounds and inequality rows of a program."""
    qp = qp_views(data, n, m, p)
    most = 0.0
    for i in range(n):
        most = max(most, qp.lb[i] - x[i], x[i] - qp.ub[i])
    for j in range(m):
        most = max(most, _product(qp.G, j, x) - qp.h[j])
    return most == 0.0


@compiled
def soften(
    data: Vector,
    sizes: tuple[int, int, int],
    weights: Vector,
    limits: Vector,
    q: Vector,
    out: Vector,
) -> float:
    """Write the program of the first stage, without equality rows, into `out`.

    Args:
        data: The step's program, laid out as `QP.data`, (size,).
        sizes: ``(n, m, p)`` of the program.
        weights: Weight of each task row, (p,).
        limits: `MotionLimits.constants`, (5 dof,).
        q: Joint positions [rad], (dof,).
        out: The program, (size,), in the same way.

    Returns:
        The square of the damping, lambda.
    """
    n, m, p = sizes
    qp = qp_views(data, n, m, p)
    soft = qp_views(out, n, m, 0)
    damping = _damping(qp.A, weights)
    pull = np.zeros(n)
    asked = 0.0
    for j in range(p):
        rhs = weights[j] * weights[j] * qp.b[j]
        asked += rhs * qp.b[j]
        for i in range(n):
            pull[i] += rhs * qp.A[j, i]
    _velocity_bounds(qp, limits, q, soft)
    wish = _wish(qp.q, pull, soft, q.size) if damping == 0.0 else 0.0
    size = math.sqrt(_squares(qp.q, n))
    drift = DRIFT * min(1.0, math.sqrt(asked) / FULL) / max(size, 1.0)
    for i in range(n):
        for k in range(n):
            soft.P[i, k] = BLEND * qp.P[i, k]
        soft.P[i, i] += damping
        soft.q[i] = wish * qp.q[i] + damping * drift * qp.q[i] - pull[i]
    for j in range(p):
        for i in range(n):
            for k in range(n):
                soft.P[i, k] += weights[j] * weights[j] * qp.A[j, i] * qp.A[j, k]
    for j in range(m):
        soft.h[j] = qp.h[j]
        for i in range(n):
            soft.G[j, i] = qp.G[j, i]
    return damping


@compiled
def _damping(A: Matrix, weights: Vector) -> float:
    """Compute the square of the damping for task rows A (p, n), which grows near singular poses."""
    p = weights.size
    if p == 0:
        return 0.0
    gram = np.empty((p, p))
    for j in range(p):
        for k in range(p):
            gram[j, k] = weights[j] * weights[k] * _product(A, j, A[k])
    smallest: float = np.linalg.eigvalsh(gram)[0]
    return DAMPING**2 * max(0.0, 1.0 - smallest / NEAR**2)


@compiled
def _velocity_bounds(qp: QPViews, limits: Vector, q: Vector, soft: QPViews) -> None:
    """Write the bounds that velocity and position limits alone put on the variables."""
    dof = q.size
    for i in range(qp.q.size):
        soft.lb[i] = qp.lb[i]
        soft.ub[i] = qp.ub[i]
        if i < dof:
            most = limits[2 * dof + i]
            soft.lb[i] = min(max(POSITION_GAIN * (limits[i] - q[i]), -most), most)
            soft.ub[i] = min(max(POSITION_GAIN * (limits[dof + i] - q[i]), -most), most)


@compiled
def _wish(gradient: Vector, pull: Vector, soft: QPViews, dof: int) -> float:
    """Compute the factor of the cost's own gradient (n,) beside the task's pull (n,).

    A wish for another posture may not outweigh the task, or it would hold the tip away from its
    target where joints at their limits leave the task little.
    """
    wished = _squares(gradient, dof)
    if wished == 0.0:
        return BLEND
    free = 0.0
    for i in range(dof):
        free += min(max(pull[i], soft.lb[i]), soft.ub[i]) ** 2
    return min(BLEND, WISH * math.sqrt(free / wished))


@compiled
def _squares(values: Vector, count: int) -> float:
    """Compute the sum of the first squares."""
    total = 0.0
    for i in range(count):
        total += values[i] * values[i]
    return total
