"""Requests of a shield: their kinds, reasons and cost."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.control.command import EXCEEDED
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
"""Lambda of a twist's program [m/rad]: near a singular pose the joints do not race."""

SIDEWAYS = 10.0
"""Weight of the motion beside a twist: where a twist cannot be had, the frame stays rather than
slides."""

SHORT = 0.02
"""Part of a twist that may be missing where the damping alone keeps it from being fulfilled."""

CUT = 100.0
"""Velocity to which a larger request is cut, in units of the largest one that joints can do."""

FASTEST = 1e4
"""Largest velocity of a joint that has no velocity limit [rad/s], for the cut."""

TWIST = 6
"""Numbers of a twist."""

ARGUMENTS = ("", "dq", "twist", "position")
"""Arguments of a step by the `Request` that they are."""

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
)
"""Words of each `Reason`."""


class Request(IntEnum):
    """Kinds of a request."""

    NONE = 0
    VELOCITY = 1
    TWIST = 2
    POSITION = 3


class Reason(IntEnum):
    """Reasons beside limits for another command than the request: those to rest come first."""

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


class RequestConstants(Record):
    """Request of a step, and the frame that a twist is of.

    Attributes:
        frame: Index of the frame.
        is_twist: Whether the request is a twist; else it is joint velocities.
        asked: Its numbers, (max(n, 6),).
    """

    frame: int
    is_twist: bool
    asked: Vector = part()


@compiled
def add_request(step: StepViews, constants: Vector, P: Matrix, q: Vector) -> None:
    """Add the cost of a request: of joint velocities w, or of a twist v with the damping.

    W leaves v as it is and weighs what is beside it.
    """
    own = RequestConstants.of(constants)
    n = q.size
    for i in range(n):
        P[i, i] += DAMPING * DAMPING if own.is_twist else 1.0
        q[i] -= 0.0 if own.is_twist else own.asked[i]
    if not own.is_twist:
        return
    v = own.asked[: Twist.width()]
    A = np.empty((TWIST, n))
    point = triple(Placement.of(step.placements[own.frame]).position)
    for j in range(n):
        support = step.support[own.frame, j]
        linear = point_rate(step.jacobian, j, point)
        angular = triple(Twist.of(step.jacobian[j]).angular)
        for i in range(3):
            A[i, j] = support * linear[i]
            A[3 + i, j] = support * angular[i]
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


@dataclass(frozen=True)
class RequestCost(Cost):
    """Distance of the command from the request, the one cost of a shield's programs.

    Attributes:
        frame: Name of the frame of twists.
    """

    kernel = staticmethod(add_request)
    frame: str

    def constants(self, robot: Robot) -> Vector:
        """Return `RequestConstants`, for a request to rest."""
        rest = np.zeros(max(robot.dof, TWIST))
        return RequestConstants.make(frame=robot.frame_id(self.frame), is_twist=False, asked=rest)


@compiled
def falls_short(qp: QPViews, twist: Vector) -> bool:
    """Test whether the damping alone keeps a twist (6,) from being fulfilled by `SHORT` of it.

    |W (J x - v)|^2 at the least of the cost of a twist's program, whose P is (W J)^T W J +
    DAMPING^2 I.
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
