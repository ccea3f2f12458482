r"""Policies for a step whose program has no solution, or one that the network did not find.

A program has no solution if no joint velocity within the limits gives its task velocity b. The
policies ``slow`` and ``relax`` then answer a fallback program (`iiwa_dnn.step.fallback`), which
keeps the bounds and the inequality rows; ``stop`` brakes. `Command.qp` and the record hold the
program that was answered (`ProgramKind`).

``slow``
    If the reference moves, answer the scaled program: the task velocity becomes s b, with s a
    thousandth below the largest feasible factor in [0, 1]. The reference's clock advances by s dt,
    so without limits on acceleration or jerk the arm follows the same path, later.
    If the reference rests, if s is below a tenth, or if joint velocities are large while the tip
    hardly moves, as in a singular pose, answer the relaxed program. The clock of a moving reference
    then advances by the fraction of the task velocity that is reached, at least by a tenth, so that
    the reference leaves the singular pose.
``relax``
    Answer the relaxed program, which minimises the damped squared error of the task rows. The
    reference's clock advances by dt.
``stop``
    Brake to rest. `simulate` ends there; a controller that is stepped again follows the task once
    its program has a solution.

The multipliers of the fallback programs name the bounds and rows that limit the solution. An
inequality row that asks for a larger velocity than the joints can give is scaled down to the
largest feasible one. If the limits contradict each other even then, the arm brakes.

With limits on acceleration or jerk the fallback programs have the bounds of position and velocity
alone. The command is then a step from the last command towards their answer, within the bounds of
the nominal program. Each joint changes its velocity as quickly as its limits allow, so that
``slow`` may leave the path and return to it (`iiwa_dnn.step.yielding`).

Sources: J. M. Hollerbach, "Dynamic scaling of manipulator trajectories", Journal of Dynamic
Systems, Measurement, and Control 106 (1984); for velocity limits, F. Flacco, A. De Luca, O. Khatib,
"Control of redundant robots under hard joint constraints", IEEE Trans. Robotics 31 (2015).
"""

from enum import IntEnum
from typing import Literal

Policy = Literal["slow", "relax", "stop"]
POLICIES: tuple[Policy, ...] = ("slow", "relax", "stop")


class Action(IntEnum):
    """Action of a policy, or of an integrator, at one step; the number is its code in a record."""

    NONE = 0
    """No action: the task velocity is not reduced."""
    SLOW = 2
    """A fraction of the task velocity is followed."""
    RELAX = 3
    """The task rows are fulfilled with the least squared error."""
    STOP = 4
    """The arm brakes to rest."""
    EULER = 5
    """A later stage of midpoint or RK4 had no solution: an Euler step was taken."""


class ProgramKind(IntEnum):
    """Kind of the program that a step answered; the number is its code in a record."""

    NOMINAL = 0
    """The program that the scheme builds."""
    SCALED = 1
    """The scaled program, A x = s b (`iiwa_dnn.step.fallback`)."""
    RELAXED = 2
    """The relaxed program, with the task in its cost."""
    RATE_LIMITED = 3
    """The scaled or relaxed program; acceleration, jerk or the need to be able to stop keep the
    command from reaching its answer in this step."""
    STOPPED = 4
    """The nominal program, not answered: the command brakes."""
