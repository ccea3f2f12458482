"""Requests of a shield: their kinds, reasons, and the rows of their cost."""

from __future__ import annotations

from enum import IntEnum

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.dense import cholesky_factor, factor_solve
from iiwa_dnn.qp.layout import QPViews
from iiwa_dnn.references.rotations import triple
from iiwa_dnn.robot.kinematics import Placement, Twist
from iiwa_dnn.schemes.program import ProgramArrays, add_soft
from iiwa_dnn.schemes.step import StepViews, point_rate

DAMPING = 0.02
"""Damping lambda of a twist's program [m/rad], which limits joint velocities near a singular pose.
"""

SIDEWAYS = 10.0
"""Weight of the error perpendicular to a twist, relative to the error along it."""

SHORT = 0.02
"""Relative error above which a twist that only the damping limits is reported as not fulfilled."""

CUT = 100.0
"""Largest request, in units of the largest velocity of the joints; a larger one is cut to it."""

FASTEST = 1e4
"""Velocity limit of a joint without one [rad/s], where requests are cut."""

TWIST = 6
"""Numbers of a twist."""


class Request(IntEnum):
    """Kinds of a request: the quantity that it states."""

    NONE = 0
    VELOCITY = 1
    TWIST = 2
    POSITION = 3


FOLLOW = len(Request)
"""Kind that a step answers if the velocities requested are those by which an arm follows samples.
"""


class Reason(IntEnum):
    """Reasons, other than limits, for a command that differs from the request.

    With those from `NO_REQUEST` to `Q_NOT_FINITE` and from `UNKNOWN_KIND` to `PLACE_NOT_FINITE` the
    arm brakes to rest. `SEPARATION` and `SPEED_SCALE` slow the request down.
    """

    NONE = 0
    NO_REQUEST = 1
    TIMED_OUT = 2
    NOT_FINITE = 3
    HALTED = 4
    Q_NOT_FINITE = 5
    RESYNCHRONISED = 6
    CUT = 7
    PERIOD_EXCEEDED = 8
    SINGULAR = 9
    UNKNOWN_KIND = 10
    PERIOD_REFUSED = 11
    PLACE_NOT_FINITE = 12
    FRAME_REFUSED = 13
    SEPARATION = 14
    SPEED_SCALE = 15
    STALE = 16


class RequestConstants(Record):
    """Request of a step as the constants of its cost.

    Attributes:
        frame: Index of the frame whose twist is requested.
        is_twist: Whether the request is a twist; else it is joint velocities.
        velocity: The requested joint velocities [rad/s] or twist [m/s], [rad/s], (max(n, 6),).
    """

    frame: int
    is_twist: bool
    velocity: Vector = part("request")


@compiled
def add_request(step: StepViews, constants: Vector, P: Matrix, q: Vector) -> None:
    """Add the cost of a request (`RequestCost`) to P (n, n) and q (n,)."""
    request = RequestConstants.of(constants)
    n = q.size
    for i in range(n):
        P[i, i] += DAMPING * DAMPING if request.is_twist else 1.0
        q[i] -= 0.0 if request.is_twist else request.velocity[i]
    if not request.is_twist:
        return
    v = request.velocity[: Twist.width()]
    A = np.empty((TWIST, n))
    twist_rows(step.jacobian, step.placements, step.support, request.frame, A)
    square = 0.0
    for k in range(TWIST):
        square += v[k] * v[k]
    for i in range(n):
        along = 0.0
        for k in range(TWIST):
            along += A[k, i] * v[k]
        fraction = (1.0 - SIDEWAYS) * along / square if square > 0.0 else 0.0
        for k in range(TWIST):
            A[k, i] = SIDEWAYS * A[k, i] + fraction * v[k]
    add_soft(P, q, A, v, 1.0)


@compiled
def twist_rows(
    jacobian: Matrix, placements: Matrix, support: Matrix, frame: int, A: Matrix
) -> None:
    """Write the Jacobian A (6, n) of a frame's twist from the kinematics of `StepViews`."""
    point = triple(Placement.of(placements[frame]).position)
    for j in range(len(jacobian)):
        linear = point_rate(jacobian, j, point)
        angular = triple(Twist.of(jacobian[j]).angular)
        for i in range(3):
            A[i, j] = support[frame, j] * linear[i]
            A[3 + i, j] = support[frame, j] * angular[i]


@compiled
def twist_rates(arrays: ProgramArrays, request: RequestConstants, dq: Vector) -> None:
    """Compute the joint velocities dq (n,) [rad/s] that answer a requested twist without limits."""
    n = dq.size
    v = request.velocity[: Twist.width()]
    A = np.empty((TWIST, n))
    twist_rows(arrays.jacobian, arrays.placements, arrays.support, request.frame, A)
    P = np.zeros((n, n))
    q = np.zeros(n)
    add_soft(P, q, A, v, 1.0)
    for i in range(n):
        P[i, i] += DAMPING * DAMPING
        q[i] = -q[i]
    dq[:] = 0.0
    if cholesky_factor(P):
        factor_solve(P, q, dq)


@compiled
def falls_short(qp: QPViews, twist: Vector) -> bool:
    """Test whether even without limits a twist v (6,) is missed by more than `SHORT` |v|.

    The error is |W (J x - v)| at the unconstrained minimum x of the twist's program `qp`, whose P
    is (W J)^T W J + DAMPING^2 I.
    """
    n = qp.q.size
    K = qp.P.copy()
    x = np.zeros(n)
    if cholesky_factor(K):
        factor_solve(K, qp.q, x)
    square = 0.0
    for i in range(TWIST):
        square += twist[i] * twist[i]
    missing = square
    for i in range(n):
        missing -= x[i] * (qp.q[i] + DAMPING * DAMPING * x[i])
    return missing > SHORT * SHORT * square
