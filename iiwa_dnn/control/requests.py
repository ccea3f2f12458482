"""Requests of a shield as its steps are given them: their cost, and the words of reasons."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.control.command import EXCEEDED
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import Vector
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes import Cost
from iiwa_dnn.step.requests import TWIST, Request, RequestConstants, add_request

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
