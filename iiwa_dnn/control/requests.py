"""Requests of a shield: their kinds, reasons and cost."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.control.command import EXCEEDED
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.dense import cholesky_factor, factor_solve
from iiwa_dnn.qp.layout import QPViews
from iiwa_dnn.references.rotations import triple
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.kinematics import Placement, Twist
from iiwa_dnn.schemes import Cost
from iiwa_dnn.schemes.program import add_soft
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

REASONS = (
    "",
    "no request",
    "request timed out",
    "request not finite",
    "halted",
    "q not finite",
    "resynchronised to measured positions",
    "request cut",
    EXCEEDED,
    "singular posture",
    "request of unknown kind",
    "period refused",
    "place of an obstacle not finite",
    "frame of bodies refused",
    "separation",
    "speed scale",
    "samples stale",
)
"""Words of each `Reason`, in the order of their codes."""


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


def one_request(
    shape: tuple[int, ...],
    dq: ArrayLike | None,
    twist: ArrayLike | None,
    position: ArrayLike | None,
) -> tuple[Request, Vector]:
    """Return the kind and the numbers of the one request that is given, which may be NaN.

    Args:
        shape: Shape of joint velocities, (n,), or (N, n) for N arms; that of twists ends in 6.
        dq: Joint velocities [rad/s].
        twist: Twists of a frame [m/s], [rad/s].
        position: Joint positions [rad].

    Returns:
        Kind and numbers; `Request.NONE` and zeros if none is given.

    Raises:
        InvalidInputError: There are several requests, or the one has a wrong shape.
    """
    if (dq is not None) + (twist is not None) + (position is not None) > 1:
        raise InvalidInputError("dq, twist, position", "pass exactly one of them")
    if dq is not None:
        own = dq if checks.is_plain(dq, shape) else checks.array("dq", dq, shape)
        return Request.VELOCITY, own  # read before anybody can change it
    if twist is not None:
        return Request.TWIST, checks.array("twist", twist, (*shape[:-1], TWIST))
    if position is not None:
        return Request.POSITION, checks.array("position", position, shape)
    return Request.NONE, np.zeros(shape)


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


@dataclass(frozen=True)
class RequestCost(Cost):
    r"""Distance of the command x from the request, the one cost of a shield's programs.

    For joint velocities w it is :math:`\tfrac12 \|x - w\|^2`; for a twist v of the frame with
    Jacobian J it is :math:`\tfrac12 \|W (J x - v)\|^2 + \tfrac12 \lambda^2 \|x\|^2`, with lambda
    `DAMPING`. W multiplies the component of an error perpendicular to v by `SIDEWAYS`.

    Attributes:
        frame: Name of the frame whose twists are requested.
    """

    kernel = staticmethod(add_request)
    frame: str

    def constants(self, robot: Robot) -> Vector:
        """Return `RequestConstants` of a request for zero joint velocity."""
        rest = np.zeros(max(robot.dof, TWIST))
        frame = robot.frame_id(self.frame)
        return RequestConstants.make(frame=frame, is_twist=False, velocity=rest)


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
