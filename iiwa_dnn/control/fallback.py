"""Answers of the steps that compiled code alone does not answer."""

from __future__ import annotations

import numpy as np

from iiwa_dnn.control.cascade import Cascade
from iiwa_dnn.control.policies import Policy, Resolution, gave_way, resolve, stopped
from iiwa_dnn.control.state import ControllerState
from iiwa_dnn.control.yielding import Yielding
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Solution, Status
from iiwa_dnn.schemes.program import StepProgram


class Fallback:
    """The network called from Python, and the policy where it has no answer.

    Attributes:
        cascade: Levels of the tasks with priorities.
        yielding: Answers where tasks yield to acceleration and jerk limits; None without those.
    """

    def __init__(
        self,
        program: StepProgram,
        solver: DNNSolver,
        state: ControllerState,
        duration: float,
        dt: float,
    ) -> None:
        """Prepare for a scheme that is laid out for a robot.

        Args:
            program: The scheme, laid out.
            solver: The network.
            state: State of the controller; whether the task yields is noted in it.
            duration: Time that the network advances at each step [s]; 0: it settles.
            dt: Control period [s].
        """
        self.cascade = Cascade(program.priorities, program.sizes, solver)
        self.yielding: Yielding | None = None
        self._program = program
        self._solver = solver
        self._state = state
        self._duration = duration
        limits = program.rate_limits
        if limits is not None and not program.accelerates:
            constants = limits.constants(program.robot)
            self.yielding = Yielding(constants, program.row_weights, dt, state)

    def answer(self, qp: QP, policy: Policy) -> tuple[Solution, Resolution | None]:
        """Answer a program by the network or, if it has no answer, by the policy.

        Args:
            qp: The step's program.
            policy: One of ``POLICIES``.

        Returns:
            The answer, and the policy's decision if there was one.

        Raises:
            NoSolutionError: There is no solution and the policy is ``raise``.
        """
        decision = self._without_network(qp, policy)
        if decision is None:
            solver = self._solver
            if self._duration > 0.0:
                found = solver.advance(qp, self._duration)
                expected = Status.ADVANCED
            else:
                found = solver.solve(qp)
                expected = Status.SOLVED
            if found.status is expected:
                return found, None
            if self._duration > 0.0:  # it is no longer a number
                decision = stopped(qp, found, yielding=self.yielding)
            else:
                weights = self._program.row_weights
                decision = resolve(qp, found, policy, solver, weights, self.yielding)
                self._state.yields = self.yielding is not None
        return decision.solution, decision

    def _without_network(self, qp: QP, policy: Policy) -> Resolution | None:
        """Decide without the network: while the arm brakes, and while the task still yields."""
        state = self._state
        halted = state.halted
        if halted is not None:
            braking = stopped(qp, halted.solution, yielding=self.yielding)
            return braking._replace(sides=halted.sides, rows=halted.rows)
        if self.yielding is None or not state.yields or policy not in ("slow", "relax"):
            return None
        if not np.isfinite(qp.b).all():
            return None
        reach, fits = self.yielding.answer(qp)
        # If the program may have a solution again, the network is asked.
        state.yields = not fits
        return None if fits else gave_way(qp, policy, reach)
