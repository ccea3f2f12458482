"""One control step: configuration and target in, joint velocity out."""

from __future__ import annotations

from typing import Literal, NamedTuple

from iiwa_dnn import checks
from iiwa_dnn.configuration import Configuration
from iiwa_dnn.qp import QP, Solution, Vector
from iiwa_dnn.references import Target
from iiwa_dnn.schemes import Scheme
from iiwa_dnn.solver import DNNSolver

Mode = Literal["converged", "continuous"]
MODES: tuple[Mode, ...] = ("converged", "continuous")


class Command(NamedTuple):
    """What a control step decided, and why.

    Attributes:
        qp: The program that was solved.
        solution: The network's answer to it.
    """

    qp: QP
    solution: Solution

    @property
    def dq(self) -> Vector:
        """Joint velocity [rad/s], (n,), inside the velocity bounds."""
        return self.solution.x


class Controller:
    """A scheme and a network, closed around the robot.

    Attributes:
        scheme: Builds the program.
        solver: Solves it; keeps the network's state between steps.
        mode: ``"converged"``: the network settles at every step. ``"continuous"``: it advances
            by one control period, as in the paper, and lags.
        dt: Control period [s], the time that the network advances in ``continuous`` mode.
    """

    def __init__(
        self, scheme: Scheme, solver: DNNSolver, mode: Mode = "converged", dt: float = 1e-4
    ) -> None:
        """Bring the parts together.

        Raises:
            InvalidInputError: `mode` is not one of ``MODES``, or `dt` is not a positive time.
        """
        checks.one_of("mode", mode, MODES)
        checks.positive("dt", dt)
        self.scheme = scheme
        self.solver = solver
        self.mode = mode
        self.dt = dt

    def step(self, conf: Configuration, target: Target) -> Command:
        """Build this instant's program and let the network answer it."""
        qp = self.scheme.build_qp(conf, target)
        if self.mode == "converged":
            solution = self.solver.solve(qp)
        else:
            solution = self.solver.advance(qp, self.dt)
        return Command(qp, solution)
