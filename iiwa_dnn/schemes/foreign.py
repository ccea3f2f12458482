"""Schemes that are any object with a `build_qp` of its own, as parts that copy its programs."""

from typing import Any

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import QP, Matrix, Vector
from iiwa_dnn.references import Target
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.schemes.base import Scheme
from iiwa_dnn.schemes.parts import Cost, Limit, Task
from iiwa_dnn.schemes.step import Step


class _Builder:
    """Programs of an object with `build_qp`, one for each step."""

    def __init__(self, scheme: Any) -> None:
        self._scheme = scheme
        self._step: Step | None = None
        self._qp: QP

    def program(self, step: Step) -> QP:
        if step is not self._step:
            self._qp = self._scheme.build_qp(Configuration(step.robot, step.q), step.target())
            self._step = step
        return self._qp


class _Built:
    """Base of the parts of such programs."""

    def __init__(self, builder: _Builder, rows: int = 0) -> None:
        self._builder = builder
        self.rows = rows


class BuiltCost(_Built, Cost):
    """Cost of the programs that an object builds."""

    def quadratic(self, step: Step) -> tuple[Matrix, Vector]:
        """Return P (n, n) and q (n,)."""
        qp = self._builder.program(step)
        return qp.P, qp.q


class BuiltRows(_Built, Task):
    """Equality rows of the programs that an object builds."""

    def equations(self, step: Step) -> tuple[Matrix, Vector]:
        """Return A (rows, n) and b (rows,)."""
        qp = self._builder.program(step)
        return qp.A, qp.b


class BuiltLimits(_Built, Limit):
    """Inequality rows and bounds of the programs that an object builds."""

    def inequalities(self, step: Step) -> tuple[Matrix, Vector]:
        """Return G (rows, n) and h (rows,)."""
        qp = self._builder.program(step)
        return qp.G, qp.h

    def bounds(self, step: Step) -> tuple[Vector, Vector]:
        """Return lb (n,) and ub (n,)."""
        qp = self._builder.program(step)
        return qp.lb, qp.ub


def composed(scheme: Any, robot: Robot, q: Vector) -> Scheme:
    """Compose the scheme of an object with `build_qp`, from its program at a q (n,) [rad].

    Raises:
        InvalidInputError: The program has another number of variables than the object states.
    """
    conf = Configuration(robot, q)
    qp = scheme.build_qp(conf, Target(conf.position, conf.rotation))
    n, m, p = checks.instance("build_qp", qp, QP).sizes
    slack = getattr(scheme, "slack", 0)
    if n != robot.dof + slack:
        problem = f"built a program in {n} variables for {robot.dof} joints and {slack} slacks"
        raise InvalidInputError("scheme", problem, scheme)
    builder = _Builder(scheme)
    limits = [BuiltLimits(builder, m)]
    return Scheme([BuiltCost(builder)], [BuiltRows(builder, p)], limits, slack)
