r"""Policies for a step whose program has no solution, or one that the network did not find.

A program without a solution asks for a task velocity b that no joint velocity within the limits
gives. Every policy that goes on replaces b by one that can be had and leaves bounds and inequality
rows alone, so no limit is relaxed, and the check gets a program of the usual shape:

``slow``
    :math:`b' = s\,b` with the largest feasible :math:`s \in [0, 1]` (`iiwa_dnn.control.relaxed`).
    Feedforward and feedback are slowed alike, and the reference's clock has to advance by s dt:
    then the arm goes along the same path, later. That is for a path: where the reference rests, a
    direct way has no merit, and the task yields as with ``relax``. So it does where next to nothing
    of the path can be had, in a singular pose or since a joint outside its limits has to come back;
    the clock creeps on by a tenth there, so that the path leads out of it.
``relax``
    :math:`b' = A \dot q'` with :math:`\dot q'` the point within the limits that violates the task
    rows least, damped near singular poses. The clock runs on.
``stop``
    No velocity; the run ends.

The multipliers of the relaxed programs name the bounds and rows that stand in the way. A row that
asks for more than all joints together can give is followed as far as they can. If the limits
contradict each other nevertheless, the arm stops.

With limits on acceleration or jerk, ``slow`` and ``relax`` approach the task's velocity on a
straight line, the clock of ``slow`` by the share of it that is reached, and ``stop`` brakes until
the arm stands (`iiwa_dnn.control.yielding`).

Sources: J. M. Hollerbach, "Dynamic scaling of manipulator trajectories", Journal of Dynamic
Systems, Measurement, and Control 106 (1984); for velocity limits, F. Flacco, A. De Luca, O. Khatib,
"Control of redundant robots under hard joint constraints", IEEE Trans. Robotics 31 (2015).
"""

from enum import IntEnum
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.qp import QP, Solution

Policy = Literal["slow", "relax", "stop"]
POLICIES: tuple[Policy, ...] = ("slow", "relax", "stop")

Sides = NDArray[np.int8]


class Action(IntEnum):
    """Action at a step in place of the network's answer; its code in a record."""

    NONE = 0
    """The network's answer was taken."""
    FALLBACK = 1
    """The network did not settle from its last state, but did on the way of a relaxed program."""
    SLOW = 2
    """A part of the task velocity."""
    RELAX = 3
    """The task rows hold as far as they can."""
    STOP = 4
    """No velocity."""
    EULER = 5
    """A later stage of midpoint or RK4 had no solution: an Euler step was taken."""


class Resolution(NamedTuple):
    """Decision of a policy at one step.

    Attributes:
        action: What was done.
        qp: The program that was answered: the step's own, or the one with b replaced.
        solution: The answer to it. One that nothing settled has its large residuals.
        fraction: By which share of a control period the reference's clock advances, in [0, 1].
        sides: Bounds that stood in the way, (n,): 1 upper, -1 lower, 0 neither.
        rows: Inequality rows that stood in the way, (m,): 1 or 0.
        against: The same bounds and rows in words.
    """

    action: Action
    qp: QP
    solution: Solution
    fraction: float
    sides: Sides
    rows: Sides
    against: tuple[str, ...] = ()

    def __repr__(self) -> str:
        way = ", ".join(self.against) or "no limit"
        return f"<Resolution {self.action.name}: {self.fraction:.3g} of the period, against {way}>"
