"""One control step: configuration and target in, joint velocity out."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal, NamedTuple

from iiwa_dnn import checks
from iiwa_dnn.configuration import Configuration
from iiwa_dnn.policies import POLICIES, Policy, Resolution, resolve, stopped
from iiwa_dnn.qp import QP, Solution, Status, Vector
from iiwa_dnn.references import Target
from iiwa_dnn.schemes import Scheme
from iiwa_dnn.solver import DNNSolver

Mode = Literal["converged", "continuous"]
MODES: tuple[Mode, ...] = ("converged", "continuous")


class Command(NamedTuple):
    """What a control step decided, and why.

    Attributes:
        qp: The program that was solved.
        solution: The answer to it, the network's where there is no resolution.
        resolution: What the policy decided where the network had no answer; else None.
    """

    qp: QP
    solution: Solution
    resolution: Resolution | None = None

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
        policy: What to do at a step that the network does not solve in ``converged`` mode
            (`iiwa_dnn.policies`); None: hand its last word to the caller. In ``continuous`` mode
            it never settles and always answers.
    """

    def __init__(
        self,
        scheme: Scheme,
        solver: DNNSolver,
        mode: Mode = "converged",
        dt: float = 1e-4,
        policy: Policy | None = None,
    ) -> None:
        """Bring the parts together.

        A limit gain above 1 / dt would let a joint step over its limit; it is cut to that.

        Raises:
            InvalidInputError: `mode` is not one of ``MODES``, `policy` not one of ``POLICIES``, or
                `dt` not a positive time.
        """
        checks.one_of("mode", mode, MODES)
        if policy is not None:
            checks.one_of("policy", policy, POLICIES)
        checks.positive("dt", dt)
        gain = scheme.limit_gain
        if gain is not None and gain * dt > 1.0:
            scheme = replace(scheme, limit_gain=1.0 / dt)  # type: ignore[type-var]
        self.scheme = scheme
        self.solver = solver
        self.mode = mode
        self.dt = dt
        self.policy = policy

    def step(self, conf: Configuration, target: Target) -> Command:
        """Build this instant's program and let the network answer it.

        Raises:
            NoSolutionError: There is no solution and the policy is ``raise``.
        """
        qp = self.scheme.build_qp(conf, target)
        if self.mode == "converged":
            solution = self.solver.solve(qp)
            if solution.status is not Status.SOLVED and self.policy is not None:
                resolution = resolve(qp, solution, self.policy, self.solver)
                return Command(resolution.qp, resolution.solution, resolution)
            return Command(qp, solution)
        solution = self.solver.advance(qp, self.dt)
        if solution.status is not Status.ADVANCED:  # no longer a number
            return Command(qp, solution, stopped(qp, solution))
        return Command(qp, solution)
