"""Schemes: costs, tasks and limits composed into the program of a control step."""

import copy
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import QP, Vector
from iiwa_dnn.references import Target
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.schemes.costs import KineticEnergy
from iiwa_dnn.schemes.parts import Cost, Limit, Part, Task
from iiwa_dnn.schemes.program import StepProgram

SchemeT = TypeVar("SchemeT", bound="Scheme")


class Scheme:
    """A way to choose joint velocities among those that fulfil the tasks inside the limits.

    The program's variables are the n joint velocities [rad/s], then `slack` further variables that
    costs and limits of one's own may use; the command is the first n of the solution.

    Attributes:
        costs: Terms of the cost.
        tasks: Equality rows, or soft tasks.
        limits: Bounds and inequality rows.
        slack: Number of slack variables.
        ahead: Whether a control loop shows it its references one period ahead
            (`Reference.ahead`).
    """

    costs: tuple[Cost, ...]
    tasks: tuple[Task, ...]
    limits: tuple[Limit, ...]
    slack: int = 0
    ahead: bool = False

    def __init__(
        self,
        costs: Sequence[Cost] = (),
        tasks: Sequence[Task] = (),
        limits: Sequence[Limit] = (),
        slack: int = 0,
    ) -> None:
        """Compose the parts.

        Raises:
            InvalidInputError: A part is of another kind than its list, or `slack` is negative.
        """
        self._compose(costs, tasks, limits)
        self.slack = checks.integer("slack", slack, 0)

    def _compose(
        self, costs: Sequence[Cost], tasks: Sequence[Task], limits: Sequence[Limit]
    ) -> None:
        kinds = (Cost, Task, Limit)
        for name, parts, kind in zip(_LISTS, (costs, tasks, limits), kinds, strict=True):
            if not isinstance(parts, Iterable):
                raise InvalidInputError(name, f"must be a list of parts, not {parts!r}", parts)
            checked = tuple(checks.instance(name, part, kind) for part in parts)
            object.__setattr__(self, name, checked)  # a scheme may be a frozen dataclass

    @property
    def parts(self) -> tuple[Part, ...]:
        """All parts: costs, tasks, limits."""
        return (*self.costs, *self.tasks, *self.limits)

    def anchored(self: SchemeT, conf: Configuration) -> SchemeT:
        """Return the scheme with `conf` as the posture to come back to, where a part lacks one."""
        lists = [[part.anchored(conf) for part in getattr(self, name)] for name in _LISTS]
        if lists == [list(getattr(self, name)) for name in _LISTS]:
            return self
        scheme = copy.copy(self)
        scheme._compose(*lists)
        return scheme

    def program(self, robot: Robot) -> StepProgram:
        """Lay the parts out for a robot.

        Raises:
            NotFoundError: A part names a frame that the robot does not have.
            InvalidInputError: A parameter of a part does not fit the robot, or a subclass builds
                its programs in another way, which no control loop would follow.
        """
        if type(self).build_qp is not Scheme.build_qp:
            problem = f"{type(self).__name__} overrides build_qp; write a Cost, a Task or a Limit"
            raise InvalidInputError("scheme", problem, self)
        return StepProgram(robot, self)

    def build_qp(
        self,
        conf: Configuration,
        target: Target | Mapping[str, Target],
        dt: float = np.inf,
        dq: ArrayLike | None = None,
    ) -> QP:
        """Build the program of one instant; it is not solved here.

        Args:
            conf: Configuration of the robot, n joints.
            target: Target of the tip; with tasks of other frames, a target by frame name.
            dt: Control period [s], which a gain of inf stands for.
            dq: Joint velocities [rad/s], (n,), or the last command; None: zero.

        Returns:
            A QP in n + slack variables: the rows of the tasks in A, of the limits in G.

        Raises:
            InvalidInputError: A task's frame has no target, or a part does not fit the robot.
        """
        program = self.program(checks.instance("conf", conf, Configuration).robot)
        if program.needs_period:
            checks.positive("dt", dt)
        q = conf.arrays[0]
        velocity = np.zeros(q.size) if dq is None else checks.finite_array("dq", dq, (q.size,))
        targets = np.array(targets_of(conf.robot.tip, program.target_frames, target))
        data = np.empty(program.data_size)
        program.kinematics.update(q)
        program.write(data, targets, np.array([q, velocity, velocity]), dt)
        return QP.from_data(data, program.sizes)

    def kinetic_index(self, conf: Configuration, dq: ArrayLike) -> float:
        """Compute dq^T G(q) dq of a joint velocity dq (n,) [rad/s].

        G is that of the scheme's `KineticEnergy`: [rad^2/s^2] with the identity, [J] (twice the
        energy) with the inertia matrix.
        """
        velocity = np.asarray(dq, dtype=np.float64)
        if self.kinetic == "identity":
            return float(velocity @ velocity)
        return float(velocity @ conf.inertia @ velocity)

    @property
    def kinetic(self) -> str:
        """G of the kinetic index: ``"identity"`` or ``"inertia"``."""
        found = [cost.kinetic for cost in self.costs if isinstance(cost, KineticEnergy)]
        return found[0] if found else "identity"

    def settings(self) -> dict[str, Any]:
        """Return name, parts and parameters, as values that JSON can hold."""
        parts: dict[str, Any] = {
            name: [part.settings() for part in getattr(self, name)] for name in _LISTS
        }
        return {"name": type(self).__name__, **parts, "slack": self.slack, "kinetic": self.kinetic}


_LISTS = ("costs", "tasks", "limits")


def targets_of(
    tip: str, frames: Sequence[str], target: Target | Mapping[str, Target]
) -> list[Vector]:
    """Return `Target.data`, (18,), of each of the frames; one target alone is the tip's.

    Raises:
        InvalidInputError: A frame has no target, or another object in its place.
    """
    given = target if isinstance(target, Mapping) else {tip: target}
    for name in frames:
        if name not in given:
            raise InvalidInputError("target", f"is missing for frame {name!r}", sorted(given))
    return [checks.instance("target", given[name], Target).data for name in frames]
