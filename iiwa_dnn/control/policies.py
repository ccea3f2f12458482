r"""Policies for a step whose program has no solution, or one that the network did not find.

A program without a solution asks for a task velocity b that no joint velocity within the limits
gives. A policy that goes on answers a fallback program (`iiwa_dnn.control.fallback`), which keeps
the bounds and the inequality rows. It is handed out, recorded and checked as it was answered
(`ProgramKind`).

``slow``
    Along a path, the scaled program: the task velocity becomes s b with the largest feasible
    :math:`s \in [0, 1]`, less a thousandth of it. The reference's clock advances by s dt, so
    without limits on acceleration or jerk the arm follows the same path, later. The task is
    relaxed where the reference rests, where s is below a tenth, and where the joints race while
    the tip hardly moves, as in a singular pose.
    Along a path the clock then advances by the fraction of the task velocity that is reached, at
    least by a tenth, so that the path leads out of it.
``relax``
    The relaxed program: the task rows are violated least, damped. The clock runs on.
``stop``
    A stopping motion to zero. A run ends there; a loop goes on once the task has a solution.

The multipliers of the fallback programs name the bounds and rows that limit the solution. A row
that asks for more than all joints together can give is followed as far as they can. If the limits
contradict each other nevertheless, the arm stops.

With limits on acceleration or jerk the fallback programs have the bounds of position and velocity
alone, and the command is a point on the way to their answer, within the bounds of the step: each
joint goes there as quickly as it may, so that ``slow`` leaves the path, and comes back to it;
``stop`` brakes until the arm is at rest (`iiwa_dnn.control.yielding`).

Sources: J. M. Hollerbach, "Dynamic scaling of manipulator trajectories", Journal of Dynamic
Systems, Measurement, and Control 106 (1984); for velocity limits, F. Flacco, A. De Luca, O. Khatib,
"Control of redundant robots under hard joint constraints", IEEE Trans. Robotics 31 (2015).
"""

from enum import IntEnum
from typing import Literal

Policy = Literal["slow", "relax", "stop"]
POLICIES: tuple[Policy, ...] = ("slow", "relax", "stop")


class Action(IntEnum):
    """Action at a step in place of the network's answer; its code in a record."""

    NONE = 0
    """The network's answer was taken."""
    SLOW = 2
    """A part of the task velocity."""
    RELAX = 3
    """The task rows hold as far as they can."""
    STOP = 4
    """A stopping motion to zero."""
    EULER = 5
    """A later stage of midpoint or RK4 had no solution: an Euler step was taken."""


class ProgramKind(IntEnum):
    """Program of a step that is handed out, recorded and checked; its code in a record."""

    NOMINAL = 0
    """The program of the step, as the scheme builds it."""
    SCALED = 1
    """The scaled program, A x = s b (`iiwa_dnn.control.fallback`)."""
    RELAXED = 2
    """The relaxed program, with the task in its cost."""
    RATE_LIMITED = 3
    """One of these: acceleration, jerk or the stopping motion limit the command on its way to the
    answer, within the bounds and rows of the step."""
    STOPPED = 4
    """The nominal program, which has no answer: the command brakes."""
