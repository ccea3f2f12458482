"""A scheme laid out for a robot's control loop: the arrays that its compiled steps work in."""

from collections.abc import Callable

import numpy as np
from numba import typeof
from numba.core.dispatcher import Dispatcher
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.control.cascade import Cascade
from iiwa_dnn.control.policies import Policy, Resolution, gave_way, resolve, stopped
from iiwa_dnn.control.step import control_step
from iiwa_dnn.control.yielding import Yielding
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.integrators.base import BUDGET, NETWORK
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Matrix, Solution, Status, Vector
from iiwa_dnn.references import Target
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.robot.kinematics import Kinematics
from iiwa_dnn.schemes import Scheme, Step
from iiwa_dnn.schemes.acceleration import lift_targets, lower_limits
from iiwa_dnn.schemes.assembly import ASSEMBLE, assemble
from iiwa_dnn.schemes.filling import fill

_BUDGET = 60.0


class Plan:
    """All that does not change from step to step, and the arrays that compiled code works in.

    Attributes:
        layout: Blocks of the scheme; None where the scheme builds its programs in its own way.
        kinematics: The robot's, overwritten at each step.
        sizes: ``(n, m, p)`` of the programs.
        version: Version of the solver's parameters.
        expected: Status of an answer that is taken.
        network: The solver's compiled form, if it has one.
        pinocchio: `Kinematics.pinocchio`.
        compiled: Arguments of `control_step`: codes, work, jacobian, placements.
        step: `control_step`, entered without looking at the types of its arguments again.
        past: The last command and the one before [rad/s], (2 n,), a view into the work array.
        last: The last command, (n,), likewise.
        q: Joint positions [rad], (n,), likewise.
        shape: Shape of q.
        inertia: Inertia matrix row by row, likewise; empty where no cost takes it.
        needs_more: Whether more kinematics than Jacobian and tip are asked for.
        moves: Whether constants change along a run (`move`).
        asks: Whether Python code has to be asked for (a part of) the program.
        cascade: Levels of the tasks with priorities.
        frames: Names of the frames that tasks track, in the order of the targets.
        ahead: Names of those whose tasks track the next target.
        place: Placement of the first of them, (12,), as `Kinematics.placements`.
        yielding: Answers where tasks yield to acceleration and jerk limits; None without those.
        stuck: Whether the task yielded at the last step.
        halted: Decision to stop, by which every step brakes; None: goes on.
        accelerates: Whether the programs are of the acceleration level.
        wanted: Accelerations of the next targets there, (6 frames,).
        row_weights: Weight of each task row where a policy lets the tasks yield; None: all alike.
    """

    def __init__(
        self, robot: Robot, scheme: Scheme, solver: DNNSolver, dt: float, converged: bool, q: Vector
    ) -> None:
        """Lay a scheme out for a robot.

        Args:
            robot: The robot, n joints.
            scheme: The scheme.
            solver: The network that answers its programs.
            dt: Control period [s].
            converged: Whether the network settles at every step.
            q: Joint positions [rad], (n,), at which a scheme of one's own is asked for its sizes.

        Raises:
            InvalidInputError: The scheme's program has another number of variables than it states.
        """
        # A scheme of one's own may be any object with a build_qp.
        own = getattr(type(scheme), "build_qp", None) is not Scheme.build_qp
        self.layout = layout = None if own else scheme.layout(robot)
        self._scheme, self._dt, self._unseen = scheme, dt, True
        dof = robot.dof
        constants: Vector = np.zeros(0)
        inertia = np.zeros(0)
        if layout is None:
            self.kinematics = Kinematics(robot)
            self.sizes = _sizes_of(scheme, Configuration(robot, q))
            codes = np.array([*self.sizes, dof, 0, robot.tip_id, 0, 0, 0, 0, 0], dtype=np.int64)
        else:
            self.kinematics = Kinematics(robot, layout.frames, layout.needs_inertia)
            self.sizes, codes, constants = layout.sizes, layout.codes, layout.numbers
            inertia = np.zeros(dof * dof if layout.needs_inertia else 0)
        priorities = np.zeros(0, dtype=np.int64) if layout is None else layout.priorities
        self.cascade = Cascade(priorities, self.sizes, solver)
        self.asks = layout is None or bool(
            layout.custom or self.cascade.levels or layout.damping.size
        )
        self.frames = (robot.tip,) if layout is None else layout.target_frames
        self.ahead = frozenset() if layout is None else layout.ahead
        self.place: Vector = self.kinematics.placements[codes[5]]
        self.row_weights = None if layout is None else layout.row_weights
        self._damping = np.zeros(0) if layout is None else layout.damping
        self.accelerates, self.wanted = self._damping.size > 0, np.zeros_like(self._damping)
        self.version = solver.version
        self.expected = Status.SOLVED if converged else Status.ADVANCED
        # A subclass that solves in a way of its own is asked, not bypassed.
        compiled = type(solver) is DNNSolver and not self.accelerates
        answer = solver.compiled_answer(self.sizes, 0.0 if converged else dt) if compiled else None
        self.network = None if answer is None else answer.constants
        self._numbers = self.network
        network = np.zeros(NETWORK) if answer is None else answer.constants.copy()
        if layout is not None and layout.restrained:
            # A program that a few systems do not solve most likely has no solution.
            network[BUDGET] = min(network[BUDGET], _BUDGET)
        head = [1.0 / dt, *np.zeros(3 * dof)]
        n, m, p = self.sizes
        work = np.concatenate([head, network, inertia, constants, np.zeros(3 * n + m + p)])
        self.past, self.q = work[1 : 1 + 2 * dof], work[1 + 2 * dof : 1 + 3 * dof]
        self.last = self.past[:dof]
        self._shown = checks.read_only(self.q), checks.read_only(self.last)  # to parts of one's own
        self._restrain(dt)
        self.inertia = work[1 + 3 * dof + network.size :][: inertia.size]
        self._constants = work[1 + 3 * dof + network.size + inertia.size :][: constants.size]
        moving = () if layout is None else layout.moving
        self._moving = [(part, self._constants[place]) for part, place in moving]
        self.moves = bool(self._moving)
        self.pinocchio = self.kinematics.pinocchio
        self.compiled = (codes, work, self.kinematics.jacobian, self.kinematics.placements)
        self.shape, self.needs_more = (dof,), bool(self.pinocchio[3] or inertia.size)
        codes[7] = ASSEMBLE.address(assemble)
        if answer is not None:
            codes[8:10] = answer.address, answer.rates
        codes[10] = network.size
        self.step = self._entrance()

    def _restrain(self, dt: float) -> None:
        """Prepare for acceleration and jerk limits, where there are some."""
        self.rates: Matrix | None = None
        self.yielding: Yielding | None = None
        self.stuck = False
        self.halted: Resolution | None = None
        layout, dof = self.layout, self.q.size
        if layout is not None and layout.restrained:
            limits = layout.blocks[-1].part.numbers(layout.robot)
            self.rates = limits[3 * dof :].reshape(2, dof)
            if not self.accelerates:
                self.yielding = Yielding(limits, self.past, self.q, layout.row_weights, dt)

    def _entrance(self) -> Callable[..., bool]:
        """Compile the control step for the types of its arguments."""
        if not isinstance(control_step, Dispatcher):
            return control_step
        given = (np.empty((1, 1)), 0, *self.compiled, np.empty(1), False, 0.0)
        compiled: Callable[..., bool] = control_step.compile(tuple(map(typeof, given)))
        return compiled

    def halt(self, decision: Resolution) -> None:
        """Brake at every step from now on, where the arm cannot stop at once."""
        if (self.yielding is not None or self.accelerates) and self.halted is None:
            self.halted, self.network = decision, None

    def stick(self, stuck: bool) -> None:
        """Note whether the task yields: as long as it does, the compiled step is not tried."""
        self.stuck = stuck and self.yielding is not None
        self.network = None if self.stuck else self._numbers

    def begin(self) -> Vector:
        """Begin a step of several stages, or one whose command may be altered.

        Returns:
            The last command [rad/s], (n,), a copy.
        """
        if self.yielding is not None:
            self._before = self.past.copy()
        return self.last.copy()

    def rewind(self) -> None:
        """Let limits of the change of commands count from the last step, not the last stage."""
        if self.yielding is not None:
            self.past[:] = self._before

    def tell(self, dq: Vector) -> None:
        """Take note of a command dq (n,) [rad/s]."""
        self.past[dq.size :] = self.last
        self.last[:] = dq

    def measure(self, dq: ArrayLike) -> None:
        """Take measured joint velocities (n,) [rad/s] for those after the last command."""
        if not self.accelerates:
            raise InvalidInputError("dq", "is for schemes of the acceleration level", dq)
        self.last[:] = checks.finite_array("dq", dq, self.shape)

    def update(self, q: Vector) -> None:
        """Bring the kinematics to joint positions q (n,) [rad]."""
        self.q[:] = q
        self.kinematics.update(self.q)
        if self.inertia.size:
            self.inertia[:] = self.kinematics.inertia.ravel()

    def move(self, t: float) -> None:
        """Bring the constants that change along a run to a time [s]."""
        for part, numbers in self._moving:
            part.move(self.kinematics.robot, numbers, t)

    def assemble(self, data: Vector, targets: Vector) -> None:
        """Write the program of the compiled parts into `data`."""
        codes, work, jacobian, placements = self.compiled
        q = self.q
        if self.accelerates:
            targets = lift_targets(
                self.kinematics, self.frames, self._damping, targets, self.wanted, q, self.last
            )
            q = q + 0.5 * self._dt * self.last
        assemble(
            data, codes, self._constants, q, jacobian, placements, self.inertia, targets,
            work[0], self.past,
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
            by_name = {name: targets[18 * i : 18 * i + 18] for i, name in enumerate(self.frames)}
            step = Step(self.kinematics, by_name, t, self._dt, *self._shown)
            fill(self.layout, data, step, self._unseen)
            self._unseen = False
        if self.accelerates:
            lower_limits(QP.from_data(data, self.sizes), self.last, self._dt)
        if self.cascade.levels:
            self.cascade.resolve(QP.from_data(data, self.sizes))

    def answer(
        self, qp: QP, solver: DNNSolver, policy: Policy, duration: float
    ) -> tuple[Solution, Resolution | None]:
        """Answer a program by the network or, where it has no answer, by the policy.

        Args:
            qp: The step's program.
            solver: The network.
            policy: One of ``POLICIES``.
            duration: Time that the network advances [s]; 0: it settles.

        Returns:
            The answer, and the policy's decision if there was one.

        Raises:
            NoSolutionError: There is no solution and the policy is ``raise``.
        """
        decision = self._decided(qp, policy)
        if decision is None:
            found = solver.solve(qp) if duration == 0.0 else solver.advance(qp, duration)
            if found.status is self.expected:
                return found, None
            if duration > 0.0:  # it is no longer a number
                decision = stopped(qp, found, yielding=self.yielding)
            else:
                decision = resolve(qp, found, policy, solver, self.row_weights, self.yielding)
                self.stick(True)
        return decision.solution, decision

    def _decided(self, qp: QP, policy: Policy) -> Resolution | None:
        """Decide without the network: while the arm brakes, and while the task still yields."""
        yielding, halted = self.yielding, self.halted
        if halted is not None:
            braking = stopped(qp, halted.solution, yielding=yielding)
            return braking._replace(sides=halted.sides, rows=halted.rows)
        if yielding is None or not self.stuck or policy not in ("slow", "relax"):
            return None
        if not np.isfinite(qp.b).all():
            return None
        reach, fits = yielding.answer(qp)
        # Where the program may have a solution again, the network is asked.
        self.stick(not fits)
        return None if fits else gave_way(qp, policy, reach)


def _sizes_of(scheme: Scheme, conf: Configuration) -> tuple[int, int, int]:
    """Sizes of the programs of a scheme that builds them in a way of its own, from one of them."""
    qp = scheme.build_qp(conf, Target(conf.position, conf.rotation))
    sizes = checks.instance("build_qp", qp, QP).sizes
    dof, slack = conf.robot.dof, getattr(scheme, "slack", 0)
    if sizes[0] != dof + slack:
        problem = f"built a program in {sizes[0]} variables for {dof} joints and {slack} slacks"
        raise InvalidInputError("scheme", problem, scheme)
    return sizes
