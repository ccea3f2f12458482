r"""Methods that integrate the robot's motion over one control step of length dt.

Tracking is the ODE :math:`\dot q = w(q, t)`, w being the controller's answer. Each method gives
the mean velocity of the step, so that the robot moves to ``q + dt * mean`` whatever happens to
that velocity on its way (noise, a filter).

Sources: Euler is the paper's equation (10). Midpoint and the classical fourth-order method:
E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary Differential Equations I", section II.1.
"""

from collections.abc import Callable
from typing import Literal, NamedTuple

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp.program import Vector

Motion = Literal["euler", "midpoint", "rk4"]
VelocityField = Callable[[Vector, float], Vector]
Step = Callable[[VelocityField, Vector, float, float], Vector]


def check_motion(motion: str, one_clock: bool, ahead: bool) -> None:
    """Raise InvalidInputError unless a run can take this motion.

    Network or physics that advance by one control period a step have one clock; `ahead` are tasks
    that track the target one control period ahead.
    """
    checks.one_of("motion", motion, tuple(MOTIONS))
    problem = "must be euler in continuous mode and in physics: they have one clock"
    if ahead:
        problem = "must be euler with tasks that track the next target"
    if motion != "euler" and (one_clock or ahead):
        raise InvalidInputError("motion", problem, motion)


def euler(velocity: VelocityField, q: Vector, t: float, dt: float) -> Vector:
    """Order 1: the velocity at the start of the step [rad/s], (n,)."""
    return velocity(q, t)


def midpoint(velocity: VelocityField, q: Vector, t: float, dt: float) -> Vector:
    """Order 2: the velocity half a step ahead [rad/s], (n,)."""
    return velocity(q + 0.5 * dt * velocity(q, t), t + 0.5 * dt)


def rk4(velocity: VelocityField, q: Vector, t: float, dt: float) -> Vector:
    """Order 4: the classical weighted mean of four velocities [rad/s], (n,)."""
    k1 = velocity(q, t)
    k2 = velocity(q + 0.5 * dt * k1, t + 0.5 * dt)
    k3 = velocity(q + 0.5 * dt * k2, t + 0.5 * dt)
    k4 = velocity(q + dt * k3, t + dt)
    return (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0


class Method(NamedTuple):
    """A method and how often it asks for the velocity in one step.

    Attributes:
        step: Gives the mean velocity of a step.
        nodes: When it asks for a velocity, in the order of its questions, in units of dt.
    """

    step: Step
    nodes: tuple[float, ...]

    @property
    def stages(self) -> int:
        """Number of velocities that it asks for in one step."""
        return len(self.nodes)


MOTIONS: dict[str, Method] = {
    "euler": Method(euler, (0.0,)),
    "midpoint": Method(midpoint, (0.0, 0.5)),
    "rk4": Method(rk4, (0.0, 0.5, 0.5, 1.0)),
}


def accelerated(
    method: Method, ask: VelocityField, last: Vector, q: Vector, t: float, dt: float
) -> tuple[Vector, Vector]:
    """Integrate positions q (n,) [rad] and velocities over one step of the acceleration level.

    The velocity that is asked for is wanted dt later; the controller starts from `last` (n,)
    [rad/s], which is overwritten. Returns the velocities after the step [rad/s], (n,), and their
    mean in it; Euler holds one acceleration.
    """
    n = q.size
    before = last.copy()

    def rate(state: Vector, time: float) -> Vector:
        last[:] = state[n:]
        return np.append(state[n:], (ask(state[:n], time) - state[n:]) / dt)

    mean = method.step(rate, np.append(q, before), t, dt)
    change = dt * mean[n:]
    moved = before + 0.5 * change if method.stages == 1 else mean[:n]
    return before + change, moved
