r"""Methods that integrate the robot's motion over one control step of length dt.

Tracking is the ODE :math:`\dot q = w(q, t)`, w being the controller's answer. Each method gives
the mean velocity of the step, so that the robot moves to ``q + dt * mean`` whatever happens to
that velocity on its way (noise, a filter).

Sources: Euler is the paper's equation (10). Midpoint and the classical fourth-order method:
E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary Differential Equations I", section II.1.
"""

from collections.abc import Callable
from typing import Literal, NamedTuple

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp.program import Vector

Motion = Literal["euler", "midpoint", "rk4"]
VelocityField = Callable[[Vector, float], Vector]


def check_motion(motion: str, one_clock: bool, at_end: bool) -> None:
    """Raise InvalidInputError if a motion with stages within a period does not fit the run.

    Args:
        motion: Name out of `MOTIONS`.
        one_clock: Whether network or physics advance by one control period at each evaluation.
        at_end: Whether tasks track the target at the end of the control period.
    """
    problem = "must be euler in continuous mode and in physics: they have one clock"
    if at_end:
        problem = "must be euler with tasks that track the next target"
    if motion != "euler" and (one_clock or at_end):
        raise InvalidInputError("motion", problem, motion)


class Method(NamedTuple):
    """An explicit Runge-Kutta method, each stage of which depends on the stage before alone.

    Attributes:
        nodes: Times of the stages, in units of dt.
        weights: Weights of the stages' velocities in the mean velocity of the step.
    """

    nodes: tuple[float, ...]
    weights: tuple[float, ...]

    @property
    def stages(self) -> int:
        """Number of its stages."""
        return len(self.nodes)

    def step(self, velocity: VelocityField, q: Vector, t: float, dt: float) -> Vector:
        """Compute the mean velocity [rad/s], (n,), of a step of dt [s] from q (n,) [rad] at t."""
        slope = velocity(q, t)
        total = self.weights[0] * slope
        for node, weight in zip(self.nodes[1:], self.weights[1:], strict=True):
            slope = velocity(q + node * dt * slope, t + node * dt)
            total += weight * slope
        return total / sum(self.weights)


MOTIONS: dict[str, Method] = {
    "euler": Method((0.0,), (1.0,)),
    "midpoint": Method((0.0, 0.5), (0.0, 1.0)),
    "rk4": Method((0.0, 0.5, 0.5, 1.0), (1.0, 2.0, 2.0, 1.0)),
}
"""Methods by name, of the orders 1, 2 and 4."""
