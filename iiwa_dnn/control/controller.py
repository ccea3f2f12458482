"""The velocity controller: joint positions in, joint velocities out, one program a step."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike
from pinocchio import computeJointJacobians, updateFramePlacement

from iiwa_dnn import checks
from iiwa_dnn.control.answers import Answers
from iiwa_dnn.control.policies import POLICIES, Action, Policy, Resolution, resolve, stopped
from iiwa_dnn.control.step import NETWORK, control_step
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Matrix, Solution, Status, Vector
from iiwa_dnn.references import Reference, Target
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.robot.kinematics import Kinematics
from iiwa_dnn.schemes import Scheme, Step
from iiwa_dnn.schemes.assembly import assemble

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
        data = self.targets(t - self.delay) if target is None else self._target_data(target)
        answers = self.answers(data)
        dq = self.answer(self._q, answers, t)
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
        if plan is None or plan.version != self.solver.version:
            self._plan = plan = _Plan(self)
        return plan

    def answers(self, targets: Matrix) -> Answers:
        """Return room for the answers to a stretch of targets, (k, 18 frames)."""
        plan = self.plan
        return Answers(plan.sizes, self._q.size, plan.expected, targets)

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

    def answer(self, q: Vector, answers: Answers, t: float = 0.0) -> Vector:
        """Take a step towards the next target in `answers`, and add program and answer to them.

        Args:
            q: Joint positions [rad], (n,).
            answers: Targets, programs and answers.
            t: Time [s], for parts of one's own.

        Returns:
            Joint velocity [rad/s], (n,), a view into `answers`.
        """
        plan, index = self.plan, answers.count
        plan.update(q)
        if plan.asks:
            plan.build(answers.program(index), answers.targets[index], t)
        state = self.solver.warm_state(plan.sizes)
        if (
            state is not None
            and plan.network is not None
            and control_step(answers.rows, index, *plan.compiled, state, plan.asks, 0.0)
        ):
            answers.count = index + 1
            return answers.dq(index)
        return self._solve(answers)

    def follow(self, q: Vector, answers: Answers, count: int) -> int:
        """Take up to `count` steps of which each answer moves `q` for one control period.

        Args:
            q: Joint positions [rad], (n,); moved in place.
            answers: Targets, programs and answers.
            count: Most steps to take.

        Returns:
            Steps taken; the next one, if any is left, is not solved by compiled code alone.
        """
        plan = self.plan
        state = self.solver.warm_state(plan.sizes)
        if state is None or plan.network is None or plan.asks or plan.inertia.size:
            return 0
        rows, first, dt, step = answers.rows, answers.count, self.dt, control_step
        codes, work, jacobian, placements = plan.compiled
        model, data, tip, others = plan.kinematics.pinocchio
        plan.q[:] = q
        moving, index = plan.q, first
        for index in range(first, first + count):
            computeJointJacobians(model, data, moving)
            updateFramePlacement(model, data, tip)
            for frame in others:
                updateFramePlacement(model, data, frame)
            if not step(rows, index, codes, work, jacobian, placements, state, False, dt):
                break
        else:
            index = first + count
        q[:] = moving
        answers.count = index
        return index - first

    def _solve(self, answers: Answers) -> Vector:
        """Take a first step, one that does not succeed, or one without a compiled form."""
        plan, index = self.plan, answers.count
        checks.finite_array("q", plan.q, (plan.q.size,))
        if not plan.asks:
            plan.assemble(answers.program(index), answers.targets[index])
        qp = answers.qp(index)
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
        answers.add(qp, solution, plan.kinematics.placements[self.robot.tip_id], plan.q)
        plan.last[:] = answers.dq(index)
        return answers.dq(index)

    def place(self, q: Vector) -> Vector:
        """Return the tip's placement at joint positions q (n,), as `Kinematics.placements`."""
        self.plan.update(q)
        place: Vector = self.plan.kinematics.placements[self.robot.tip_id]
        return place

    def program_at(self, q: Vector, targets: Vector, t: float) -> QP:
        """Build the program at joint positions, without solving it."""
        plan = self.plan
        n, m, p = plan.sizes
        plan.update(q)
        data = np.empty((n + m + p) * (n + 1) + 2 * n)
        plan.build(data, targets, t)
        return QP.from_data(data, plan.sizes)


_PLANNED = frozenset({"robot", "scheme", "reference", "dt", "mode", "policy", "solver"})


class _Plan:
    """All that does not change from step to step, and the arrays that compiled code works in.

    Attributes:
        layout: Blocks of the scheme; None where the scheme builds its programs in its own way.
        kinematics: The robot's, overwritten at each step.
        sizes: ``(n, m, p)`` of the programs.
        version: Version of the solver's parameters.
        expected: Status of an answer that is taken.
        network: The solver's compiled form, if it has one.
        compiled: Arguments of `control_step`: codes, work, jacobian, placements.
        last: Last command [rad/s], (n,), a view into the work array.
        q: Joint positions [rad], (n,), likewise.
        inertia: Inertia matrix row by row, likewise; empty where no cost takes it.
        asks: Whether Python code has to be asked for (a part of) the program.
        row_weights: Weight of each task row where a policy lets the tasks yield; None: all alike.
    """

    def __init__(self, controller: Controller) -> None:
        """Lay a controller's scheme out for its robot.

        Raises:
            InvalidInputError: The scheme's program has another number of variables than it states.
        """
        robot, solver, scheme = controller.robot, controller.solver, controller.scheme
        converged = controller.mode == "converged"
        # A scheme of one's own may be any object with a build_qp.
        own = getattr(type(scheme), "build_qp", None) is not Scheme.build_qp
        self.layout = layout = None if own else scheme.layout(robot)
        self._scheme, self._dt = scheme, controller.dt
        dof = robot.dof
        constants: Vector = np.zeros(0)
        inertia = np.zeros(0)
        if layout is None:
            self.kinematics = Kinematics(robot)
            self.sizes = _sizes_of(scheme, Configuration(robot, controller._q))
            codes = np.array([*self.sizes, dof, 0, robot.tip_id, 0], dtype=np.int64)
        else:
            self.kinematics = Kinematics(robot, layout.frames, layout.needs_inertia)
            self.sizes, codes, constants = layout.sizes, layout.codes, layout.numbers
            inertia = np.zeros(dof * dof if layout.needs_inertia else 0)
        self.asks = layout is None or bool(layout.custom)
        self.row_weights = None if layout is None else layout.row_weights
        self.version = solver.version
        self.expected = Status.SOLVED if converged else Status.ADVANCED
        # A subclass that solves in a way of its own is asked, not bypassed.
        compiled = type(solver) is DNNSolver
        self.network = solver.numbers(0.0 if converged else controller.dt) if compiled else None
        network = np.zeros(NETWORK) if self.network is None else self.network
        head = [1.0 / controller.dt, *np.zeros(2 * dof)]
        work = np.concatenate([head, network, inertia, constants])
        self.last, self.q = work[1 : 1 + dof], work[1 + dof : 1 + 2 * dof]
        self.inertia = work[1 + 2 * dof + NETWORK :][: inertia.size]
        self._constants = work[1 + 2 * dof + NETWORK + inertia.size :]
        self.compiled = (codes, work, self.kinematics.jacobian, self.kinematics.placements)

    def update(self, q: Vector) -> None:
        """Bring the kinematics to joint positions q (n,) [rad]."""
        self.q[:] = q
        self.kinematics.update(self.q)
        if self.inertia.size:
            self.inertia[:] = self.kinematics.inertia.ravel()

    def assemble(self, data: Vector, targets: Vector) -> None:
        """Write the program of the compiled parts into `data`."""
        codes, work, jacobian, placements = self.compiled
        assemble(
            data, codes, self._constants, self.q, jacobian, placements, self.inertia, targets,
            work[0],
        )  # fmt: skip

    def build(self, data: Vector, targets: Vector, t: float) -> None:
        """Write the whole program into `data`."""
        if self.layout is None:
            conf = Configuration(self.kinematics.robot, self.q)
            qp = self._scheme.build_qp(conf, Target.from_data(targets))
            if qp.sizes != self.sizes:
                problem = f"built a program of sizes {qp.sizes} after others of {self.sizes}"
                raise InvalidInputError("scheme", problem)
            data[:] = qp.data
            return
        self.assemble(data, targets)
        if self.layout.custom:
            names = self.layout.target_frames
            by_name = {name: targets[18 * i : 18 * i + 18] for i, name in enumerate(names)}
            step = Step(self.kinematics, by_name, t, self._dt, self.q, self.last)
            self.layout.fill(data, step)


def _sizes_of(scheme: Scheme, conf: Configuration) -> tuple[int, int, int]:
    """Sizes of the programs of a scheme that builds them in a way of its own, from one of them."""
    sizes = scheme.build_qp(conf, Target(conf.position, conf.rotation)).sizes
    dof, slack = conf.robot.dof, getattr(scheme, "slack", 0)
    if sizes[0] != dof + slack:
        problem = f"built a program in {sizes[0]} variables for {dof} joints and {slack} slacks"
        raise InvalidInputError("scheme", problem, scheme)
    return sizes


def warn_if_far(start: Configuration, first: Target, stacklevel: int) -> None:
    """Warn where the first target is far from the tip: most likely it was not anchored."""
    distance = float(np.linalg.norm(first.position - start.position))
    if distance > FAR:
        warnings.warn(
            f"the reference begins {distance:.3g} m from the tip; to begin where the tip is: "
            "reference.anchored(configuration)",
            stacklevel=stacklevel,
        )
