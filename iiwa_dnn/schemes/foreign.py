"""Schemes that are any object with a `build_qp` of its own, as parts that copy its programs."""

from collections.abc import Callable
from functools import lru_cache
from typing import Any

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import QP, Matrix, Vector
from iiwa_dnn.references import Target
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.schemes.base import Scheme
from iiwa_dnn.schemes.parts import Cost, Limit, Part, Task
from iiwa_dnn.schemes.step import Step


class _Built(Part):
    """Base of the parts of such programs, which are built once a step."""

    def __init__(self, build: Callable[[Step], QP], rows: int = 0) -> None:
        self._build = build
        self.rows = rows


class BuiltCost(_Built, Cost):
    """Cost of the programs that an object builds."""

    def quadratic(self, step: Step) -> tuple[Matrix, Vector]:
        """Return P (n, n) and q (n,)."""
        return self._build(step).P, self._build(step).q


class BuiltRows(_Built, Task):
    """Equality rows of the programs that an object builds."""

    def equations(self, step: Step) -> tuple[Matrix, Vector]:
        """Return A (rows, n) and b (rows,)."""
        return self._build(step).A, self._build(step).b


class BuiltLimits(_Built, Limit):
    """Inequality rows and bounds of the programs that an object builds."""

    def inequalities(self, step: Step) -> tuple[Matrix, Vector]:
        """Return G (rows, n) and h (rows,)."""
        return self._build(step).G, self._build(step).h

    def bounds(self, step: Step) -> tuple[Vector, Vector]:
        """Return lb (n,) and ub (n,)."""
        return self._build(step).lb, self._build(step).ub


def composed(scheme: Any, robot: Robot, q: Vector) -> Scheme:
    """Compose the scheme of an object with `build_qp`, from its program at a q (n,) [rad].

    Raises:
        InvalidInputError: The program has another number of variables than the object states.
    """

    @lru_cache(maxsize=1)
    def build(step: Step) -> QP:
        qp: QP = scheme.build_qp(Configuration(robot, step.q), step.target())
        return checks.instance("build_qp", qp, QP)

    conf = Configuration(robot, q)
    target = Target(conf.position, conf.rotation)
    n, m, p = build(Step(robot, q, target)).sizes
    slack = getattr(scheme, "slack", 0)
    if n != robot.dof + slack:
        problem = f"built a program in {n} variables for {robot.dof} joints and {slack} slacks"
        raise InvalidInputError("scheme", problem, scheme)
    return Scheme([BuiltCost(build)], [BuiltRows(build, p)], [BuiltLimits(build, m)], slack)
