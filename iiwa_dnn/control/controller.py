"""The velocity controller: joint positions in, joint velocities out, one program a step."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike
from pinocchio import computeJointJacobians, updateFramePlacement, updateFramePlacements

from iiwa_dnn import checks
from iiwa_dnn.control.answers import Answers, Command
from iiwa_dnn.control.paths import References, by_frame, paths_of, warn_if_far, warn_if_outside
from iiwa_dnn.control.plan import Plan
from iiwa_dnn.control.policies import POLICIES, Action, Policy
from iiwa_dnn.control.room import SIZE, Room
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Matrix, Vector
from iiwa_dnn.references import Reference, Target
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.schemes import Scheme
from iiwa_dnn.schemes.base import targets_of

Mode = Literal["converged", "continuous"]
MODES: tuple[Mode, ...] = ("converged", "continuous")


class Controller:
    """A robot, a scheme and a reference, closed by a network.

    In a robot's loop, `step` takes the encoders' reading and returns the command.

    Attributes:
        robot: The robot, n joints, with the limits that the scheme keeps.
        scheme: Builds the programs; where it has no home, the first step's posture becomes it.
        reference: Path of the tip, or paths by frame name.
        dt: Control period [s].
        mode: ``"converged"``: the network settles at every step. ``"continuous"``: it advances by
            one control period, as in the paper, and lags.
        policy: Action at a step without a solution in ``converged`` mode (`control.policies`).
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
        self.mode, self.policy, self.dt = mode, policy, dt
        self.robot, self.scheme, self.reference = robot, scheme, reference
        self.solver = DNNSolver(tol=tol) if solver is None else solver
        self.delay, self._begun, self._q = 0.0, False, np.zeros(robot.dof)

    def __setattr__(self, name: str, value: Any) -> None:
        if check := _CHECKS.get(name):
            check(name, value)
            self._plan: Plan | None = None
            self._room: Room | None = None
        object.__setattr__(self, name, value)

    def step(
        self,
        q: ArrayLike,
        t: float,
        target: Target | Mapping[str, Target] | None = None,
        dq: ArrayLike | None = None,
    ) -> Command:
        """Compute the command for joint positions at a time.

        Args:
            q: Measured joint positions [rad], (n,).
            t: Time [s]; the reference is asked for the time `delay` before it.
            target: Target in place of the reference's; for tasks towards the next one `ahead` too.
                At the acceleration level it has no acceleration.
            dq: Measured joint velocities [rad/s], (n,), at the acceleration level; None takes the
                last command.

        Returns:
            The command.

        Raises:
            InvalidInputError: `q` has another size than the robot has joints, or is not finite; or
                there is neither reference nor target.
            NoSolutionError: There is no solution and the policy is ``raise``.
        """
        plan, room = self._plan, self._room
        if room is None or plan is None or plan.version != self.solver.version:
            plan, room = self._prepare(q, t, target)
        if type(q) is not np.ndarray or q.shape != plan.shape:
            q = checks.finite_array("q", q, plan.shape)
        plan.q[...] = q  # quicker than [:]
        index = room.count
        if index == SIZE:
            self._room, index = (room := room.following()), 0
        if target is not None or not room.paths:
            room.targets[index] = self.targets(t - self.delay, target)
        else:
            room.sample(t - self.delay, index)
        if plan.accelerates:
            plan.wanted[:] = self._accelerations(t) if target is None else 0.0
        if dq is not None:
            plan.measure(dq)
        try:
            self._answer(plan, room, index, t)
        except BaseException:
            self._room = None  # its row is half written
            raise
        if index in room.resolved:
            self.delay += self.dt * (1.0 - room.resolved[index].fraction)
        return Command(room, index, room.commands[index])

    def _prepare(
        self, q: ArrayLike, t: float, target: Target | Mapping[str, Target] | None
    ) -> tuple[Plan, Room]:
        """Lay out whatever a step needs, and at the first step anchor the scheme."""
        posture = checks.finite_array("q", q, (self.robot.dof,))
        if not self._begun:
            start = Configuration(self.robot, posture)
            self.anchor(start)
            if target is None:
                self.warn_if_far(start, t, stacklevel=4)
        plan, given = self.plan, by_frame(self.reference, self.robot.tip)
        seen = [self._ahead(name, given[name]) for name in plan.frames if name in given]
        self._room = room = Room(plan, seen if len(seen) == len(plan.frames) else [])
        return plan, room

    def warn_if_far(self, start: Configuration, t: float, stacklevel: int) -> None:
        """Warn where a first target is far from its frame: most likely it was not anchored."""
        warn_if_far(self.scheme, self.plan.frames, start, self.targets(t), stacklevel + 1)

    def anchor(self, start: Configuration) -> None:
        """Make a configuration the posture to come back to, where the scheme has none."""
        warn_if_outside(start, stacklevel=4)
        if (anchored := getattr(self.scheme, "anchored", None)) is not None:
            self.scheme = anchored(start)
        self._q[:] = start.q
        self._begun = True

    def reset(self) -> None:
        """Forget the network's state, the last command and the delay; the home stays."""
        self.solver.reset()
        self.delay = 0.0
        self._plan = self._room = None

    def warm_up(self) -> None:
        """Compile whatever a step needs, so that the first one is as quick as the others."""
        begun, scheme, home = self._begun, self.scheme, self.robot.start_posture()
        conf = Configuration(self.robot, home)
        frames = {name: conf.frame(name) for name in self.plan.frames}
        poses = {name: Target(at.position, at.rotation) for name, at in frames.items()}
        for _ in range(3):
            self.step(home, 0.0, poses)
        if self.reference is not None:
            self.step(home, 0.0)
        self.scheme, self._begun = scheme, begun
        self.reset()

    @property
    def plan(self) -> Plan:
        """The scheme laid out for the robot, made anew where an attribute has changed."""
        plan = self._plan
        if plan is None or plan.version != self.solver.version:
            converged = self.mode == "converged"
            parts = self.robot, self.scheme, self.solver, self.dt, converged
            self._plan = plan = Plan(*parts, self._q)
        return plan

    def answers(self, targets: Matrix) -> Answers:
        """Return room for the answers to a stretch of targets, (k, 18 frames)."""
        plan = self.plan
        return Answers(plan.sizes, self._q.size, plan.expected, targets, plan.accelerates)

    def targets(self, t: float, target: Target | Mapping[str, Target] | None = None) -> Vector:
        """Return the targets of a time, (18 frames,): those given, else the reference's."""
        if target is None:
            targets: Vector = self.sample(np.array([t]))[0]
            return targets
        return np.concatenate(targets_of(self.robot.tip, self.plan.frames, target))

    def sample(self, times: Vector) -> Matrix:
        """Return the reference's targets at many times, one frame after the other, (k, 18 frames).

        Raises:
            InvalidInputError: A frame that a task tracks has no reference, or another one has.
        """
        paths = paths_of(self.reference, self.robot.tip, self.plan.frames)
        seen = (self._ahead(name, path).sample(times) for name, path in paths.items())
        return np.concatenate([targets.data for targets in seen], axis=1)

    def _accelerations(self, t: float) -> Vector:
        """Return the accelerations of the targets of a time [s], (6 frames,)."""
        paths = paths_of(self.reference, self.robot.tip, self.plan.frames).values()
        return np.concatenate([path.accelerations(t - self.delay) for path in paths])

    def _ahead(self, frame: str, reference: Reference) -> Reference:
        """Return a frame's reference, one period ahead where its tasks track the next target."""
        return reference.ahead(self.dt) if frame in self.plan.ahead else reference

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
        plan.q[:] = q
        if plan.accelerates:
            plan.wanted[:] = self._accelerations(t)
        self._answer(plan, answers, index, t)
        return answers.dq(index)

    def _answer(self, plan: Plan, answers: Answers, index: int, t: float) -> None:
        """Take a step at the joint positions that the plan holds."""
        if plan.needs_more:
            plan.update(plan.q)
            plan.move(t)
        else:
            model, data, tip, _ = plan.pinocchio
            computeJointJacobians(model, data, plan.q)
            updateFramePlacement(model, data, tip)
        if plan.asks:
            plan.build(answers.program(index), answers.targets[index], t)
        state = self.solver.warm_state(plan.sizes)
        ready = state is not None and plan.network is not None
        if ready and plan.step(answers.rows, index, *plan.compiled, state, plan.asks, 0.0):
            answers.count = index + 1
            return
        # Where tasks yield to acceleration limits that is quicker found out than proven.
        plan.stick(self.mode == "converged")
        self._solve(answers)

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
        in_python = plan.asks or plan.moves or plan.inertia.size
        if state is None or plan.network is None or in_python:
            return 0
        rows, first, dt, step = answers.rows, answers.count, self.dt, plan.step
        codes, work, jacobian, placements = plan.compiled
        model, data, tip, others = plan.pinocchio
        plan.q[:] = q
        moving = plan.q
        for index in range(first, first + count):
            computeJointJacobians(model, data, moving)
            updateFramePlacement(model, data, tip)
            if others:
                updateFramePlacements(model, data)
            if not step(rows, index, codes, work, jacobian, placements, state, False, dt):
                break
        else:
            index = first + count
        q[:] = moving
        answers.count = index
        return index - first

    def _solve(self, answers: Answers) -> None:
        """Take a first step, one that does not succeed, or one without a compiled form."""
        plan, index = self.plan, answers.count
        checks.finite_array("q", plan.q, (plan.q.size,))
        checks.finite_array("target", answers.targets[index], (-1,))
        if not plan.asks:
            plan.assemble(answers.program(index), answers.targets[index])
        qp = answers.qp(index)
        duration = 0.0 if self.mode == "converged" else self.dt
        if duration == 0.0 and plan.network is not None and plan.yielding is None:
            self.solver.reset()  # compiled code has tried from the last state already
        # The clock of an arm that is in motion cannot be slowed down at once.
        policy = "relax" if plan.accelerates and self.policy == "slow" else self.policy
        solution, resolution = plan.answer(qp, self.solver, policy, duration)
        if resolution is not None:
            qp, answers.resolved[index] = resolution.qp, resolution
            if plan.accelerates and resolution.action is Action.STOP:
                solution.point[: qp.lb.size] = np.clip(-plan.last / self.dt, qp.lb, qp.ub)
        answers.add(qp, solution, plan.place, plan.q)
        if plan.accelerates:
            answers.dq(index)[:] = plan.last + self.dt * solution.x[: plan.q.size]
        plan.tell(answers.dq(index))

    def place(self, q: Vector) -> Vector:
        """Return the first frame's placement at joint positions q (n,), (12,)."""
        self.plan.update(q)
        return self.plan.place

    def program_at(self, q: Vector, targets: Vector, t: float) -> QP:
        """Build the program at joint positions q (n,) [rad] for targets (18 frames,)."""
        plan = self.plan
        n, m, p = plan.sizes
        plan.update(q)
        plan.move(t)
        data = np.empty((n + m + p) * (n + 1) + 2 * n)
        plan.build(data, targets, t)
        return QP.from_data(data, plan.sizes)


# What a plan depends on; a change of it is checked, and makes another plan.
_CHECKS: dict[str, Callable[[str, Any], object]] = {
    "robot": partial(checks.instance, kind=Robot),
    "scheme": lambda name, value: checks.offers(name, value, "build_qp", "settings"),
    "reference": lambda name, value: by_frame(value, ""),
    "dt": checks.positive,
    "mode": partial(checks.one_of, choices=MODES),
    "policy": partial(checks.one_of, choices=POLICIES),
    "solver": partial(checks.instance, kind=DNNSolver),
}
