"""One control step: configuration and target in, joint velocity out."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Literal, NamedTuple

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.control.answers import Answers
from iiwa_dnn.control.policies import POLICIES, Policy, Resolution, resolve, stopped
from iiwa_dnn.kernels import control_step
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Matrix, Solution, Status, Vector
from iiwa_dnn.references import Target
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.robot.robot import Robot
from iiwa_dnn.schemes import Scheme, compiled_program, identity

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
            (`iiwa_dnn.control.policies`); None: hand its last word to the caller. In ``continuous``
            mode it never settles and always answers.
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
        self._expected = Status.SOLVED if mode == "converged" else Status.ADVANCED
        self._parts: _Parts | None = None

    def step(self, conf: Configuration, target: Target) -> Command:
        """Build this instant's program and let the network answer it.

        Raises:
            NoSolutionError: There is no solution and the policy is ``raise``.
        """
        answers = self.answers(1)
        self.answer(conf, target.data, answers)
        return Command(answers.qp(0), answers.solution(0), answers.resolved.get(0))

    def answers(self, capacity: int) -> Answers:
        """Room for the answers of so many steps."""
        return Answers(capacity, self._expected)

    def answer(self, conf: Configuration, target: Vector, answers: Answers) -> Vector:
        """Take a step as `step` does, and add what it decided to `answers`.

        Args:
            conf: Where the robot is, n joints.
            target: Where it should be: `Target.data`, (18,).
            answers: Where to put program and solution.

        Returns:
            Joint velocity [rad/s], (n,), a view into `answers`.
        """
        parts = self._parts
        if parts is None or parts.scheme is not self.scheme or parts.robot is not conf.robot:
            self._parts = parts = self._take_apart(conf.robot)
        _, _, program, sizes, kinetic, constants = parts
        count = answers.count
        if constants is not None:
            state = self.solver.warm_state(sizes)
            if state is not None:
                if answers.sizes != sizes:
                    answers.shape(sizes)
                q, pose, jacobian = conf.arrays
                row = answers.rows[count]
                if kinetic is None:
                    kinetic = program.kinetic(conf)
                if control_step(
                    row, program.rows, program.mode, q, pose, jacobian, target, kinetic,
                    constants, state,
                ):  # fmt: skip
                    answers.count = count + 1
                    x: Vector = row[answers.x_slice]
                    return x
        # The first step, one that does not succeed, and parts without a compiled form.
        qp = self.scheme.build_qp(conf, Target.from_data(target))
        if self.mode == "converged":
            solution = self.solver.solve(qp)
        else:
            solution = self.solver.advance(qp, self.dt)
        if solution.status is not self._expected and self.policy is not None:
            if self.mode == "converged":
                resolution = resolve(qp, solution, self.policy, self.solver)
            else:
                resolution = stopped(qp, solution)  # it is no longer a number
            qp, solution = resolution.qp, resolution.solution
            answers.resolved[count] = resolution
        answers.add(qp, solution, conf.arrays[1])
        return answers.x(count)

    def _take_apart(self, robot: Robot) -> _Parts:
        """What a compiled step needs, where scheme and solver have a compiled form."""
        scheme, solver = self.scheme, self.solver
        program = compiled_program(scheme, robot)
        network = None
        # A subclass that solves in a way of its own is asked, not its parent.
        if program is not None and type(solver) is DNNSolver:
            network = solver.numbers(0.0 if self.mode == "converged" else self.dt)
        if program is None or network is None:
            return _Parts(scheme, robot, program, (0, 0, 0), None, None)
        sizes = (robot.dof, 0, program.rows)
        kinetic = None if program.inertia else identity(robot.dof)
        numbers = (network, program.weights, program.home, program.limits.ravel())
        return _Parts(scheme, robot, program, sizes, kinetic, np.concatenate(numbers))


class _Parts(NamedTuple):
    """What a compiled step needs, and whom it holds for."""

    scheme: Scheme
    robot: Robot
    program: Any
    sizes: tuple[int, int, int]
    kinetic: Matrix | None
    constants: Vector | None
