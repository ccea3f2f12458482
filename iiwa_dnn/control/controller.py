"""The velocity controller: joint positions in, joint velocities out, one program a step."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.control.answers import Answers
from iiwa_dnn.control.policies import POLICIES, Action, Policy, Resolution, resolve, stopped
from iiwa_dnn.control.step import control_step
from iiwa_dnn.errors import InvalidInputError, NoSolutionError
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Matrix, Solution, Status, Vector
from iiwa_dnn.references import Reference, Target
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.robot.kinematics import Kinematics
from iiwa_dnn.schemes import Scheme, Step
from iiwa_dnn.schemes.assembly import Layout, assemble

Mode = Literal["converged", "continuous"]
MODES: tuple[Mode, ...] = ("converged", "continuous")

References = Reference | Mapping[str, Reference]

FAR = 0.05
"""Distance from the tip to the first target from which on a warning is given [m]."""


class Command:
    """Decision of one control step.

    Attributes:
        dq: Joint velocity [rad/s], (n,), within the limits.
        resolution: Decision of the policy where the network had no answer; else None.
    """

    __slots__ = ("_answers", "dq", "resolution")

    def __init__(self, answers: Answers, dq: Vector, resolution: Resolution | None = None) -> None:
        self._answers, self.dq, self.resolution = answers, dq, resolution

    @property
    def qp(self) -> QP:
        """The program that was answered."""
        return self._answers.qp(0)

    @property
    def solution(self) -> Solution:
        """The answer: the network's unless there is a resolution."""
        return self._answers.solution(0)

    @property
    def action(self) -> Action:
        """The action taken; ``Action.NONE`` where the network's answer was taken."""
        return Action.NONE if self.resolution is None else self.resolution.action

    @property
    def ok(self) -> bool:
        """Whether the command does all that the tasks ask: solved, by the network or a fallback."""
        asked = self.resolution is None or self.resolution.action is Action.FALLBACK
        return asked and not self._answers.unsolved

    def __repr__(self) -> str:
        dq = np.array2string(self.dq, precision=4, separator=", ")
        return f"<Command dq = {dq} rad/s, {self.action.name.lower()}, ok = {self.ok}>"


class Controller:
    """A robot, a scheme and a reference, closed by a network.

    In a robot's loop, `step` takes the encoders' reading and returns the command::

        controller = iiwa_dnn.Controller(robot, scheme, reference, dt=1e-3)
        command = controller.step(q, t)

    Attributes:
        robot: The robot, n joints, with the limits that the scheme keeps.
        scheme: Builds the programs; where it has no home, the first step's posture becomes it.
        reference: Path of the tip, or paths by frame name.
        dt: Control period [s].
        mode: ``"converged"``: the network settles at every step. ``"continuous"``: it advances by
            one control period, as in the paper, and lags.
        policy: What to do at a step that the network does not solve in ``converged`` mode
            (`iiwa_dnn.control.policies`).
        solver: Network, integrators and tolerance; keeps the network's state between steps.
        delay: Time by which the reference's clock is behind, since a policy slowed it [s].
    """

    def __init__(
        self,
        robot: Robot,
        scheme: Scheme,
        reference: References | None = None,
        *,
        dt: float = 1e-3,
        mode: Mode = "converged",
        policy: Policy = "slow",
        tol: float = 1e-9,
        solver: DNNSolver | None = None,
    ) -> None:
        """Bring the parts together.

        Args:
            robot: The robot.
            scheme: A `Scheme`, or an object with its methods `build_qp` and `settings`.
            reference: Path of the tip or of several frames; None where every step gets a target.
            dt: Control period [s].
            mode: ``"converged"`` or ``"continuous"``.
            policy: ``"slow"``, ``"relax"``, ``"stop"`` or ``"raise"``.
            tol: Absolute tolerance on the KKT residuals in ``converged`` mode.
            solver: The network and its integrators; None takes the paper's network with `tol`.

        Raises:
            InvalidInputError: An argument is out of range; the message names it.
        """
        checks.one_of("mode", mode, MODES)
        checks.one_of("policy", policy, POLICIES)
        checks.positive("dt", dt)
        self.robot, self.scheme, self.reference = robot, scheme, reference
        self.dt, self.mode, self.policy = dt, mode, policy
        self.solver = DNNSolver(tol=tol) if solver is None else solver
        self.delay = 0.0
        self._q = np.zeros(robot.dof)
        self._begun = False

    def __setattr__(self, name: str, value: Any) -> None:
        object.__setattr__(self, name, value)
        if name in _PLANNED:
            self._plan: _Plan | None = None

    def step(
        self, q: ArrayLike, t: float, target: Target | Mapping[str, Target] | None = None
    ) -> Command:
        """Compute the command for joint positions at a time.

        Args:
            q: Measured joint positions [rad], (n,).
            t: Time [s]; the reference is asked for the time `delay` before it.
            target: Where the tip should be, in place of the reference's target.

        Returns:
            The command.

        Raises:
            InvalidInputError: `q` has another size than the robot has joints, or is not finite; or
                there is neither reference nor target.
            NoSolutionError: There is no solution and the policy is ``raise``.
        """
        if len(q) != self._q.size:  # type: ignore[arg-type]
            raise InvalidInputError("q", f"must have {self._q.size} values, not {np.shape(q)}", q)
        self._q[:] = q
        if not self._begun:
            self._begin(t, target)
        answers = self.answers(1)
        data = self.targets(t - self.delay) if target is None else self._target_data(target)
        dq = self.answer(self._q, data, answers, t)
        resolution = answers.resolved.get(0)
        if resolution is not None:
            self.delay += self.dt * (1.0 - resolution.fraction)
        return Command(answers, dq, resolution)

    def _begin(self, t: float, target: Target | Mapping[str, Target] | None) -> None:
        """Anchor the scheme at the first posture, and say if the target is far from there."""
        start = Configuration(self.robot, self._q)
        self.anchor(start)
        if target is None:
            warn_if_far(start, Target.from_data(self.targets(t)[0, :18]), stacklevel=4)

    def anchor(self, start: Configuration) -> None:
        """Make a configuration the posture to come back to, where the scheme has none."""
        anchored = getattr(self.scheme, "anchored", None)
        if anchored is not None:
            self.scheme = anchored(start)
        self._q[:] = start.q
        self._begun = True

    def reset(self) -> None:
        """Forget the network's state, the last command and the delay; the home stays."""
        self.solver.reset()
        self.delay = 0.0
        self._plan = None

    def warm_up(self) -> None:
        """Compile whatever a step needs, so that the first one is as quick as the others."""
        begun, scheme, home = self._begun, self.scheme, self.robot.start_posture()
        conf = Configuration(self.robot, home)
        pose = Target(conf.position, conf.rotation)
        frames = self.plan.layout.target_frames if self.plan.layout else (self.robot.tip,)
        for _ in range(3):
            self.step(home, 0.0, dict.fromkeys(frames, pose))
        if self.reference is not None:
            self.targets(0.0)
        self.scheme, self._begun = scheme, begun
        self.reset()

    @property
    def plan(self) -> _Plan:
        """The scheme laid out for the robot, made anew where an attribute has changed."""
        plan = self._plan
        if plan is None or plan.version != getattr(self.solver, "version", 0):
            self._plan = plan = _Plan.of(self)
        return plan

    def answers(self, capacity: int) -> Answers:
        """Return room for the answers of so many steps."""
        plan = self.plan
        return Answers(capacity, plan.sizes, self._q.size, plan.expected)

    def targets(self, t: float) -> Matrix:
        """Return the reference's targets at a time, (1, 18 frames)."""
        return self.sample(np.array([t])) if self._many else self._one.at(t).data[np.newaxis]

    def sample(self, times: Vector) -> Matrix:
        """Return the reference's targets at many times, one frame after the other, (k, 18 frames).

        Raises:
            InvalidInputError: There is no reference, or none for a frame that a task tracks.
        """
        if self.reference is None:
            raise InvalidInputError("reference", "is missing: give one, or a target to each step")
        if isinstance(self.reference, Reference):
            return self.reference.sample(times).data
        layout = self.plan.layout
        frames = (self.robot.tip,) if layout is None else layout.target_frames
        for name in frames:
            if name not in self.reference:
                raise InvalidInputError("reference", f"is missing for frame {name!r}")
        return np.concatenate([self.reference[name].sample(times).data for name in frames], axis=1)

    @property
    def _many(self) -> bool:
        return not isinstance(self.reference, Reference)

    @property
    def _one(self) -> Reference:
        return self.reference  # type: ignore[return-value]

    def _target_data(self, target: Target | Mapping[str, Target]) -> Matrix:
        if isinstance(target, Target):
            return target.data[np.newaxis]
        layout = self.plan.layout
        frames = (self.robot.tip,) if layout is None else layout.target_frames
        return np.concatenate([target[name].data for name in frames])[np.newaxis]

    def answer(self, q: Vector, targets: Matrix, answers: Answers, t: float = 0.0) -> Vector:
        """Take a step and add its program and answer to `answers`.

        Args:
            q: Joint positions [rad], (n,).
            targets: One row a step, of which row `answers.count` is this step's.
            answers: Where to put program and answer.
            t: Time [s], for parts of one's own.

        Returns:
            Joint velocity [rad/s], (n,), a view into `answers`.
        """
        plan, index = self.plan, answers.count
        plan.kinematics.update(q)
        built = plan.build(answers.program(index), q, targets[index], t) if plan.asks else False
        state = self.solver.warm_state(plan.sizes)
        if (
            state is not None
            and plan.network is not None
            and control_step(answers.rows, index, *plan.compiled, q, *plan.arrays, targets,
                             plan.memory, state, built, 0.0)
        ):  # fmt: skip
            answers.count = index + 1
            return answers.dq(index)
        return self._solve(q, targets, answers, t)

    def follow(self, q: Vector, targets: Matrix, answers: Answers, count: int) -> int:
        """Take up to `count` steps of which each answer moves `q` for one control period.

        Args:
            q: Joint positions [rad], (n,); moved in place.
            targets: One row a step.
            answers: Where to put programs and answers.
            count: How many steps at most.

        Returns:
            How many steps were taken; the next one is not solved by compiled code alone.
        """
        plan = self.plan
        state = self.solver.warm_state(plan.sizes)
        if state is None or plan.network is None or plan.asks:
            return 0
        rows, first, update = answers.rows, answers.count, plan.kinematics.update
        compiled, arrays, memory, dt = plan.compiled, plan.arrays, plan.memory, self.dt
        index = first
        for index in range(first, first + count):
            update(q)
            if not control_step(
                rows, index, *compiled, q, *arrays, targets, memory, state, False, dt
            ):
                break
        else:
            index += 1
        answers.count = index
        return index - first

    def _solve(self, q: Vector, targets: Matrix, answers: Answers, t: float) -> Vector:
        """Take a first step, one that does not succeed, or one without a compiled form."""
        plan, index = self.plan, answers.count
        checks.finite_array("q", q, (q.size,))
        if not plan.asks:
            plan.assemble(answers.program(index), q, targets[index])
        qp = QP.from_data(answers.program(index), plan.sizes)
        if self.mode == "converged":
            solution = self.solver.solve(qp)
        else:
            solution = self.solver.advance(qp, self.dt)
        if solution.status is not plan.expected:
            if self.mode == "converged":
                resolution = resolve(qp, solution, self.policy, self.solver, plan.row_weights)
            else:
                resolution = stopped(qp, solution)  # it is no longer a number
            qp, solution = resolution.qp, resolution.solution
            answers.resolved[index] = resolution
        answers.add(qp, solution, plan.kinematics.placements[self.robot.tip_id], q)
        plan.memory[1:] = answers.dq(index)
        return answers.dq(index)

    def place(self, q: Vector) -> Vector:
        """Return the tip's placement at joint positions q (n,), as `Kinematics.placements`."""
        kinematics = self.plan.kinematics
        kinematics.update(q)
        return kinematics.placements[self.robot.tip_id]

    def program_at(self, q: Vector, targets: Vector, t: float) -> QP:
        """Build the program at joint positions, without solving it."""
        plan = self.plan
        plan.kinematics.update(q)
        data = np.empty((sum(plan.sizes)) * (plan.sizes[0] + 1) + 2 * plan.sizes[0])
        plan.build(data, q, targets, t)
        return QP.from_data(data, plan.sizes)


_PLANNED = frozenset({"robot", "scheme", "reference", "dt", "mode", "policy", "solver"})


class _Plan(NamedTuple):
    """All that does not change from step to step.

    Attributes:
        scheme: The scheme.
        layout: Its blocks; None where the scheme builds its programs in a way of its own.
        kinematics: The robot's, overwritten at each step.
        sizes: ``(n, m, p)`` of the programs.
        version: Of the solver's parameters.
        expected: Status of an answer that is taken.
        network: The solver's compiled form, if it has one.
        compiled: The first arguments of `control_step` after the row.
        arrays: The kinematics' arrays.
        memory: ``[1 / dt, last command]``.
        asks: Whether Python code has to be asked for (a part of) the program.
        dt: Control period [s].
    """

    scheme: Scheme
    layout: Layout | None
    kinematics: Kinematics
    sizes: tuple[int, int, int]
    version: int
    expected: Status
    network: Vector | None
    compiled: tuple[Any, Any, Any]
    arrays: tuple[Matrix, Matrix, Matrix]
    memory: Vector
    asks: bool
    dt: float

    @classmethod
    def of(cls, controller: Controller) -> _Plan:
        """Lay a controller's scheme out for its robot.

        Raises:
            InvalidInputError: The scheme's program has another number of variables than it states.
        """
        scheme, robot, solver = controller.scheme, controller.robot, controller.solver
        converged = controller.mode == "converged"
        own = not isinstance(scheme, Scheme) or type(scheme).build_qp is not Scheme.build_qp
        layout = None if own else scheme.layout(robot)
        if layout is None:
            kinematics = Kinematics(robot)
            conf = Configuration(robot, controller._q)
            sizes = scheme.build_qp(conf, Target(conf.position, conf.rotation)).sizes
            slack = getattr(scheme, "slack", 0)
            if sizes[0] != robot.dof + slack:
                problem = (
                    f"built a program in {sizes[0]} variables for {robot.dof} joints and "
                    f"{slack} slack variables"
                )
                raise InvalidInputError("scheme", problem, scheme)
            head = [*sizes, robot.dof, 0, robot.tip_id]
            codes, numbers = np.array(head, dtype=np.int64), np.zeros(0)
        else:
            kinematics = Kinematics(robot, layout.frames, layout.needs_inertia)
            sizes, codes, numbers = layout.sizes, layout.codes, layout.numbers
        network = None
        if type(solver) is DNNSolver:  # a subclass that solves in a way of its own is asked
            network = solver.numbers(0.0 if converged else controller.dt)
        memory = np.zeros(1 + robot.dof)
        memory[0] = 1.0 / controller.dt
        return cls(
            scheme, layout, kinematics, sizes, getattr(solver, "version", 0),
            Status.SOLVED if converged else Status.ADVANCED, network, (codes, numbers, network),
            (kinematics.jacobian, kinematics.placements, kinematics.inertia), memory,
            layout is None or bool(layout.custom), controller.dt,
        )  # fmt: skip

    @property
    def row_weights(self) -> Vector | None:
        """Weight of each task row where a policy lets the tasks yield, (p,); None: all alike."""
        return None if self.layout is None else self.layout.row_weights

    def assemble(self, data: Vector, q: Vector, targets: Vector) -> None:
        """Write the compiled parts' program at the current kinematics into `data`."""
        codes, numbers, _ = self.compiled
        assemble(data, codes, numbers, q, *self.arrays, targets, self.memory[0])

    def build(self, data: Vector, q: Vector, targets: Vector, t: float) -> bool:
        """Write the whole program at the current kinematics into `data`; returns True."""
        last = self.memory[1:]
        if self.layout is None:
            conf = Configuration.from_checked(self.kinematics.robot, q)
            qp = self.scheme.build_qp(conf, Target.from_data(targets))
            if qp.sizes != self.sizes:
                problem = f"built a program of sizes {qp.sizes} after others of {self.sizes}"
                raise InvalidInputError("scheme", problem)
            data[:] = qp.data
            return True
        self.assemble(data, q, targets)
        frames = self.layout.target_frames
        by_name = {name: targets[18 * i : 18 * i + 18] for i, name in enumerate(frames)}
        self.layout.fill(data, Step(self.kinematics, by_name, t, self.dt, q, last))
        return True


def warn_if_far(start: Configuration, first: Target, stacklevel: int) -> None:
    """Warn where the first target is far from the tip: the reference was most likely not anchored."""
    distance = float(np.linalg.norm(first.position - start.position))
    if distance > FAR:
        warnings.warn(
            f"the reference begins {distance:.3g} m from the tip; to begin where the tip is: "
            "reference.anchored(configuration)",
            stacklevel=stacklevel,
        )


__all__ = ["MODES", "Command", "Controller", "Mode", "NoSolutionError", "warn_if_far"]
