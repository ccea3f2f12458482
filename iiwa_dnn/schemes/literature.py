r"""Schemes of the literature: that of the paper, and others to compare it with.

The paper's scheme blends minimum kinetic energy and cyclic motion by one weight.

.. math::

    \min_{\dot q} \; \tfrac12 \bigl(\xi\,\dot q^T G(q)\,\dot q
        + (1-\xi)\,\|\dot q + m\,(q - q_0)\|^2\bigr)

subject to the position rows, the orientation rows and the velocity bounds. Without its constant the
cost is that of a quadratic program with

.. math::

    P = \xi\,G(q) + (1-\xi)\,I, \qquad q_{\text{QP}} = (1-\xi)\,m\,(q - q_0).

With G = I, as in the paper, P = I, and the weight acts through the linear term alone. Source:
equations (6) and (7) of the paper.
"""

from collections.abc import Iterable
from dataclasses import asdict, dataclass, fields, replace
from typing import Any, Literal, get_args

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.schemes.costs import CyclicMotion, Kinetic, KineticEnergy, WeightedCost
from iiwa_dnn.schemes.joint_limits import JointLimits
from iiwa_dnn.schemes.parts import Limit
from iiwa_dnn.schemes.scheme import Scheme
from iiwa_dnn.schemes.step import Step
from iiwa_dnn.schemes.tasks import Orientation, OrientationTask, PositionTask

SMALLEST = 1e-3
"""Least weight of the velocity norm in `bi_criteria`; the largest speed leaves joints free."""

Sample = Literal["start", "end"]


@dataclass(frozen=True)
class DoubleIndicator(Scheme):
    """Scheme of the paper: minimum kinetic energy blended with cyclic motion generation.

    Attributes:
        weight: The paper's xi in [0, 1]; 1 is minimum kinetic energy, 0 cyclic motion.
        drift_gain: The paper's m [1/s], the rate at which the posture is drawn back to `home`.
        position_gain: The paper's delta [1/s].
        orientation_gain: The paper's nu as a feedback gain [1/s].
        limit_gain: The paper's kappa [1/s], for the bounds near a joint limit.
        orientation: ``"so3"``, ``"block"`` (the paper's) or ``"none"``.
        kinetic: G(q): ``"identity"`` (the paper's) or ``"inertia"``, the joint-space inertia
            matrix, which makes the index twice the true kinetic energy [J].
        home: Posture q_0 [rad], (n,); None: the one in which `simulate` or `Controller` begins.
        extra_limits: Limits beside `JointLimits`, for example `AccelerationLimits` and
            `JerkLimits`.
        sample: Time of the target: ``"start"`` of the control period, as in the paper, or
            ``"end"``, with feed-forward over the period and 1 / dt in place of both gains
            (`iiwa_dnn.schemes.tasks`). `Reference.feed_forward` is feed-forward with other gains.
    """

    weight: float = 0.2
    drift_gain: float = 10.2
    position_gain: float = 10.2
    orientation_gain: float = 10.2
    limit_gain: float = 20.0
    orientation: Orientation = "so3"
    kinetic: Kinetic = "identity"
    home: tuple[float, ...] | None = None
    extra_limits: tuple[Limit, ...] = ()
    sample: Sample = "start"

    def __post_init__(self) -> None:
        if checks.not_negative("weight", self.weight) > 1.0:
            raise InvalidInputError("weight", f"must be in [0, 1], not {self.weight}", self.weight)
        checks.one_of("sample", self.sample, get_args(Sample))
        cyclic = CyclicMotion(weight=1.0 - self.weight, gain=self.drift_gain, home=self.home)
        object.__setattr__(self, "home", cyclic.home)
        tasks = tip_tasks(self.position_gain, self.orientation_gain, self.orientation)
        if self.sample == "end":
            tasks = [replace(task, gain=np.inf) for task in tasks]
        energy = KineticEnergy(weight=self.weight, kinetic=self.kinetic)
        if not isinstance(self.extra_limits, Iterable):
            raise InvalidInputError("extra_limits", "must be a list of limits", self.extra_limits)
        limits = [JointLimits(gain=self.limit_gain), *self.extra_limits]
        self._compose([energy, cyclic], tasks, limits)

    def anchored(self, conf: Configuration) -> "DoubleIndicator":
        """Return the scheme with the posture `conf` as `home`, or itself if it has a home."""
        return self if self.home is not None else replace(self, home=tuple(conf.q.tolist()))

    def settings(self) -> dict[str, Any]:
        """Return name and parameters, as values that JSON can hold."""
        parameters = {field.name: getattr(self, field.name) for field in fields(self)}
        extra = tuple(limit.settings() for limit in self.extra_limits)
        return {"name": "double-indicator", **parameters, "extra_limits": extra}


@dataclass(frozen=True)
class PseudoInverse(Scheme):
    r"""Scheme of the pseudoinverse: the least joint velocity that fulfils the task.

    .. math::  \dot q = A^{+} b = \arg\min \tfrac12 \|\dot q\|^2 \;\; \text{s.t.} \;\; A \dot q = b

    The paper's baseline: it has no limits, and drifts on closed paths.

    Source: D. E. Whitney, "Resolved motion rate control of manipulators and human prostheses", IEEE
    Transactions on Man-Machine Systems 10 (1969).

    Attributes:
        position_gain: Feedback gain [1/s].
        orientation_gain: Feedback gain [1/s].
        orientation: ``"so3"``, ``"block"`` or ``"none"``.
    """

    position_gain: float = 10.2
    orientation_gain: float = 10.2
    orientation: Orientation = "so3"

    def __post_init__(self) -> None:
        tasks = tip_tasks(self.position_gain, self.orientation_gain, self.orientation)
        self._compose([KineticEnergy()], tasks, [])

    def settings(self) -> dict[str, Any]:
        """Return name and parameters, as values that JSON can hold."""
        return {"name": "pseudo-inverse", **asdict(self)}


def tip_tasks(
    position_gain: float, orientation_gain: float, orientation: Orientation
) -> list[PositionTask | OrientationTask]:
    """Return a task of the tip's position, and one of its orientation unless that is ``"none"``."""
    checks.one_of("orientation", orientation, get_args(Orientation))
    position = PositionTask(gain=position_gain)
    if orientation == "none":
        return [position]
    return [position, OrientationTask(gain=orientation_gain, form=orientation)]


class LargestSpeed(WeightedCost):
    r"""Cost of the largest joint speed s, the only slack variable of a scheme: w s^2 / 2."""

    def quadratic(self, step: Step) -> tuple[Matrix, Vector]:
        """Return P (n + 1, n + 1) and q (n + 1,), for n joints and the slack variable."""
        none = np.zeros(step.q.size + 1)
        return np.diag([*none[1:], self.weight]), none


class SpeedsBelowSlack(Limit):
    r"""Rows :math:`\pm \dot q_i - s \le 0` for the only slack variable s of a scheme."""

    def __init__(self, robot: Robot) -> None:
        """Make the 2 n rows for a robot with n joints."""
        self.rows = 2 * robot.dof
        signs = [[1.0], [-1.0]]
        self._G = np.hstack([np.kron(signs, np.eye(robot.dof)), -np.ones((self.rows, 1))])

    def inequalities(self, step: Step) -> tuple[Matrix, Vector]:
        """Return G (2 n, n + 1) and h (2 n,)."""
        return self._G, np.zeros(self.rows)


def bi_criteria(robot: Robot, weight: float = 0.5, gain: float = 10.2) -> Scheme:
    """Compose a scheme between the least velocity norm (weight 1) and the least maximum speed (0).

    Source: Y. Zhang, J. Wang, Y. Xu, "A dual neural network for bi-criteria kinematic control of
    redundant manipulators", IEEE Trans. Robotics and Automation 18 (2002).

    Raises:
        InvalidInputError: The weight is not in [0, 1].
    """
    costs = [KineticEnergy(weight=max(weight, SMALLEST)), LargestSpeed(weight=1.0 - weight)]
    tasks = tip_tasks(gain, gain, "so3")
    return Scheme(costs, tasks, [JointLimits(), SpeedsBelowSlack(robot)], slack=1)
