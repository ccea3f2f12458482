"""Schemes: costs, tasks and limits, composed into the quadratic program of a control step."""

import copy
from collections.abc import Mapping, Sequence
from typing import Any, Literal, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import QP
from iiwa_dnn.references import Target
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.schemes.costs import KineticEnergy
from iiwa_dnn.schemes.layout import ProgramLayout, targets_of
from iiwa_dnn.schemes.parts import Cost, Limit, Task

SchemeT = TypeVar("SchemeT", bound="Scheme")

_LISTS = ("costs", "tasks", "limits")
"""Names of the attributes of a scheme that list its parts."""


class Scheme:
    """Costs, tasks and limits whose program has the joint velocities as its solution.

    The variables are the n joint velocities [rad/s], then `slack` variables for costs and limits of
    one's own; the command is the first n numbers of the solution.

    Attributes:
        costs: Terms of the cost.
        tasks: Equality rows, or soft tasks.
        limits: Bounds and inequality rows.
        slack: Number of slack variables.
        sample: Time of the targets in a control loop: the ``"start"`` of the control period, or
            its ``"end"``, with the mean twist over the period (`Reference.feed_forward`).
    """

    costs: tuple[Cost, ...]
    tasks: tuple[Task, ...]
    limits: tuple[Limit, ...]
    slack: int = 0
    sample: Literal["start", "end"] = "start"

    def __init__(
        self,
        costs: Sequence[Cost] = (),
        tasks: Sequence[Task] = (),
        limits: Sequence[Limit] = (),
        slack: int = 0,
    ) -> None:
        """Compose the parts.

        Raises:
            InvalidInputError: A list has an object of another kind, or `slack` is negative.
        """
        self._compose(costs, tasks, limits)
        self.slack = checks.integer("slack", slack, 0)

    def _compose(
        self, costs: Sequence[Cost], tasks: Sequence[Task], limits: Sequence[Limit]
    ) -> None:
        kinds = (Cost, Task, Limit)
        for name, parts, kind in zip(_LISTS, (costs, tasks, limits), kinds, strict=True):
            checked = checks.instances(name, parts, kind)
            object.__setattr__(self, name, checked)  # a scheme may be a frozen dataclass

    def anchored(self: SchemeT, conf: Configuration) -> SchemeT:
        """Return the scheme with the posture `conf` in each part whose posture was left None."""
        lists = [[part.anchored(conf) for part in getattr(self, name)] for name in _LISTS]
        if lists == [list(getattr(self, name)) for name in _LISTS]:
            return self
        scheme = copy.copy(self)
        scheme._compose(*lists)
        return scheme

    def program(self, robot: Robot) -> ProgramLayout:
        """Lay the parts out for a robot.

        Raises:
            NotFoundError: A part names a frame that the robot does not have.
            InvalidInputError: A parameter of a part does not fit the robot, or a subclass overrides
                `build_qp`, which control loops do not call.
        """
        if type(self).build_qp is not Scheme.build_qp:
            problem = f"{type(self).__name__} overrides build_qp; write a Cost, a Task or a Limit"
            raise InvalidInputError("scheme", problem, self)
        return ProgramLayout(robot, self.costs, self.tasks, self.limits, self.slack)

    def build_qp(
        self,
        conf: Configuration,
        target: Target | Mapping[str, Target],
        dt: float = np.inf,
        dq: ArrayLike | None = None,
    ) -> QP:
        """Build the program of one instant; it is not solved here.

        Args:
            conf: Configuration of the robot, n joints, and the posture of each part whose own was
                left None.
            target: Target of the tip; with tasks of other frames, targets by frame name.
            dt: Control period [s], of which a gain is at most the inverse.
            dq: Last command [rad/s], (n,); None: zero.

        Returns:
            A QP in n + slack variables: the rows of the tasks in A, of the limits in G.

        Raises:
            InvalidInputError: A task's frame has no target, or a part does not fit the robot.
        """
        scheme = self.anchored(checks.instance("conf", conf, Configuration))
        program = scheme.program(conf.robot)
        if any(getattr(part, "gain", 0.0) == np.inf for part in program.parts):
            checks.positive("dt", dt)  # which a gain of inf is the inverse of
        q = conf.q
        velocity = np.zeros(q.size) if dq is None else checks.finite_array("dq", dq, (q.size,))
        targets = np.array(targets_of(conf.robot.tip, program.target_frames, target))
        return program.qp_at(q, velocity, velocity, targets, dt)

    def kinetic_index(self, conf: Configuration, dq: ArrayLike) -> float:
        """Compute the kinetic index dq^T G(q) dq of joint velocities dq (n,) [rad/s].

        G is that of the scheme's `KineticEnergy`: with the identity the index is in [rad^2/s^2],
        with the inertia matrix it is twice the kinetic energy [J].
        """
        velocity = np.asarray(dq, dtype=np.float64)
        along = conf.inertia @ velocity if self.kinetic == "inertia" else velocity
        return float(velocity @ along)

    @property
    def kinetic(self) -> str:
        """G of the kinetic index: ``"identity"`` or ``"inertia"``."""
        return next(
            (part.kinetic for part in self.costs if isinstance(part, KineticEnergy)), "identity"
        )

    def settings(self) -> dict[str, Any]:
        """Return class name, parts and parameters, as values that JSON can hold."""
        parts = {name: [part.settings() for part in getattr(self, name)] for name in _LISTS}
        own = {"slack": self.slack, "kinetic": self.kinetic}
        return {"name": type(self).__name__, **parts, **own}
