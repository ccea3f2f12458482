"""A whole control step in one compiled call: targets, program and the network's answer.

For seven joints the way into compiled code is a large part of the cost of a call, so a control loop
enters it once a step.
"""

import math
from collections.abc import Mapping
from functools import partial
from typing import NamedTuple

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.trigonometry import LARGEST
from iiwa_dnn.control.command import (
    ADVANCED,
    NOT_FINITE,
    NOT_SETTLED,
    PAST,
    SOLVED,
    RowLayout,
    RowViews,
    note_command,
    row_views,
)
from iiwa_dnn.control.relaxed import Yielding, largest_entry, relaxed_size
from iiwa_dnn.control.state import (
    BEFORE,
    DELAY,
    HALTED,
    LAST,
    REST,
    YIELDS,
    Q,
    kept_distances,
    rows_of,
)
from iiwa_dnn.control.yielding import (
    BRAKE,
    NONE,
    guard_step,
    make_yielding,
    yield_step,
)
from iiwa_dnn.networks.integrators.base import (
    BUDGET,
    DURATION,
    TOLERANCE,
    CompiledAnswer,
    Settled,
    enter_answer,
)
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Matrix, Status, Vector
from iiwa_dnn.qp.dense import all_finite
from iiwa_dnn.qp.layout import IntVector, QPViews, Sizes, copied, qp_views
from iiwa_dnn.qp.residuals import within
from iiwa_dnn.references import Reference
from iiwa_dnn.references.base import Ahead, enter_path
from iiwa_dnn.references.rotations import set_mean_twist
from iiwa_dnn.references.targets import TargetData
from iiwa_dnn.schemes.collisions import MEET
from iiwa_dnn.schemes.limits import (
    STATED,
    JointLimits,
    MotionLimits,
    Periods,
    check_ranges,
    checked_longest,
    constant_periods,
)
from iiwa_dnn.schemes.program import LimitNames, ProgramArrays, StepProgram, assemble

FEASIBLE_BUDGET = 60.0
"""Linear systems after which a program with acceleration or jerk limits counts as infeasible."""

INVALID = -1
"""Action at targets that are not finite, or joint positions that are none: nothing is changed."""


class StepPlan(NamedTuple):
    """Layout of a control step.

    Attributes:
        arrays: Arrays with which the program is written.
        ends: `RowLayout.ends`, (12,).
        yielding: What relaxed programs need beside them.
        relaxed: States of the networks of relaxed programs, (`relaxed_size`,), warm starts.
        policy: Action that the policy asks for at a step without a solution; `BRAKE`: none.
    """

    arrays: ProgramArrays
    ends: IntVector
    yielding: Yielding
    relaxed: Vector
    policy: int


class ControlStep:
    """A control step laid out for a scheme, references and a network.

    Attributes:
        program: The scheme laid out for the robot.
        layout: Columns of the rows that are written.
        shape: Shape of the states from step to step, (8 + k, dof).
        dt: Period that the next command is for [s].
        steady: The same where periods do not vary, else NaN.
        plan: Arrays and settings that stay the same from step to step.
        has_network: Whether the network is compiled.
        samples: Whether the compiled step samples the targets: all references are compiled, and no
            part is refreshed by the targets of a step.
    """

    def __init__(
        self,
        program: StepProgram,
        references: Mapping[str, Reference],
        solver: DNNSolver,
        dt: float,
        policy: int,
        longest: float | None = None,
    ) -> None:
        """Lay a control step out.

        Args:
            program: The scheme laid out for the robot.
            references: Reference of each tracked frame, or none.
            solver: The network that answers the programs.
            dt: Control period [s].
            policy: Action of a step without a solution; `BRAKE`: in continuous mode.
            longest: Longest control period [s]; None: all are dt.

        Raises:
            InvalidInputError: With a jerk limit, a joint's range is too short to turn round in; or
                `longest` is below `dt`.
        """
        checked_longest(longest, dt)
        self.program = program
        frames = len(program.target_frames)
        names = LimitNames(program, dt)
        pairs = program.least.size
        self.shape = (rows_of(pairs, program.robot.dof), program.robot.dof)
        self.layout = RowLayout(program.sizes, program.robot.dof, frames, names, pairs)
        self.has_network = self._add_network(solver, dt, policy == BRAKE)
        self.samples = self._add_paths(references, dt) and not program.reads_targets
        arrays = program.arrays(dt)
        yielding = make_yielding(program, solver.tol, dt, self.has_network)
        relaxed = np.zeros(relaxed_size(program.sizes))
        self.plan = StepPlan(arrays, self.layout.ends, yielding, relaxed, policy)
        if yielding.limits.size:
            check_ranges(yielding.limits, 1.0 / (longest or dt))
        if longest is not None:
            for start, _ in program.constants_of(JointLimits):
                program.constants[start] = min(program.constants[start], 1.0 / longest)
        self._varies = longest is not None
        self.set_periods(dt, constant_periods(dt))

    def set_periods(self, dt: float, periods: Periods) -> None:
        """Take other control periods, without laying anything out anew.

        Args:
            dt: Period that the next command is for [s].
            periods: Periods as limits count them.
        """
        self.dt = dt
        self.steady = math.nan if self._varies else dt
        self.layout = self.layout.at_periods(periods)
        arrays = self.plan.arrays._replace(rate=1.0 / dt)
        yielding = self.plan.yielding._replace(dt=dt, periods=periods)
        self.plan = self.plan._replace(arrays=arrays, yielding=yielding)
        self.program.constants[self._duration_at] = dt * self._duration_rate
        if periods.vary:
            for _, stop in self.program.constants_of(MotionLimits):
                self.program.constants[stop - STATED : stop] = periods[:STATED]

    def _add_network(self, solver: DNNSolver, dt: float, lags: bool) -> bool:
        """Add the network's entry to the table; return whether the network is compiled."""
        program = self.program
        answer = None
        # A subclass that solves in a way of its own is asked, not bypassed.
        if type(solver) is DNNSolver:
            answer = solver.compiled_answer(program.sizes, lags * dt)
        compiled = answer is not None
        if answer is None:
            address = enter_answer.address(partial(ask, solver, program.sizes))
            answer = CompiledAnswer(address, 0, np.array([solver.tol, np.inf, lags * dt]))
        if program.rate_limits is not None:
            # A program that a few systems do not solve most likely has no solution.
            answer.constants[BUDGET] = min(answer.constants[BUDGET], FEASIBLE_BUDGET)
        self._duration_at = program.constants.size + DURATION
        self._duration_rate = answer.constants[DURATION] / dt  # 0 where the network settles
        program.append(answer.address, answer.constants, answer.rates)
        return compiled

    def _add_paths(self, references: Mapping[str, Reference], dt: float) -> bool:
        """Add an entry for each reference; return whether all of them are compiled."""
        frames = self.program.target_frames
        seen = [references[name] for name in frames if name in references]
        paths = [path.along if isinstance(path, Ahead) else path for path in seen]
        if len(paths) < len(frames) or not all(path.compiled for path in paths):
            return False
        if any(isinstance(path, Ahead) and path.dt != dt for path in seen):
            return False
        for path, other in zip(paths, seen, strict=True):
            constants = np.concatenate([path.base, path.constants])
            self.program.append(
                enter_path.address(path.compiled), constants, int(path is not other)
            )
        return True


def ask(
    solver: DNNSolver,
    sizes: Sizes,
    qp: QPViews,
    rates: int,
    constants: Vector,
    state: Vector,
    point: Vector,
) -> Settled:
    """Answer a program of some sizes by a solver that is not compiled (`enter_answer`).

    It keeps its state itself, and its duration is in seconds.
    """
    program = QP.from_data(np.concatenate([part.ravel() for part in qp]), sizes)
    if constants[DURATION] > 0.0:
        solution = solver.advance(program, float(constants[DURATION]))
    else:
        solution = solver.solve(program)
    point[:] = solution.point
    finite = solution.status is not Status.NOT_FINITE
    residuals = solution.residuals if finite else (np.inf, np.inf, np.inf)
    return solution.iterations, solution.network_time, *residuals


@compiled
def take_step(
    row: Vector,
    plan: StepPlan,
    q: Vector,
    past: Matrix,
    following: Matrix,
    state: Vector,
    t: float,
    samples: bool,
) -> int:
    """Take a control step: its own program, or what the policy asks for.

    The network is not asked if the task yielded at the last step, or the arm brakes. If targets
    or the time are not finite, or joint positions beyond 2^20 rad, nothing but the row is written.

    Args:
        row: The row, (width,), with the targets unless they are sampled.
        plan: What the step is laid out with.
        q: Joint positions [rad], (dof,), that the kinematics are at.
        past: `ControllerState.past`, (8 + k, dof); its joint positions are overwritten.
        following: The same for the next step, overwritten.
        state: The network's state, (size,), advanced.
        t: Time [s].
        samples: Whether the references are asked for the targets.

    Returns:
        The action that was taken, or `INVALID`.
    """
    arrays = plan.arrays
    table = arrays.table
    views = row_views(row, plan.ends, table[0, 3])
    if samples:
        sample_targets(arrays, t - past[DELAY, 0], views.targets)
    first = row.size - views.targets.size
    finite = math.isfinite(t)
    for i in range(q.size):
        finite = finite and abs(q[i]) <= LARGEST
    if not finite or not all_finite(row, first, row.size):
        return INVALID
    copied(past[Q], q)
    copied(following.reshape(following.size), past.reshape(past.size))
    copied(following[BEFORE], past[LAST])
    following[REST, 0] = 0.0
    following[YIELDS, 0] = 0.0
    assemble(views.program, arrays, past, kept_distances(following), views.targets, t)
    _note_instant(views, arrays, past, following)
    halted = past[HALTED, 0] != 0.0 or largest_entry(views.least) == MEET
    if past[YIELDS, 0] == 0.0 and not halted and _answer(views, arrays, state):
        note_command(views, following, views.point, plan.yielding.dt)
        if guard_step(arrays, past, following, plan.yielding):
            return NONE
    policy = BRAKE if halted else plan.policy
    return yield_step(views, arrays, past, following, plan.yielding, plan.relaxed, policy)


@compiled
def _note_instant(views: RowViews, arrays: ProgramArrays, past: Matrix, following: Matrix) -> None:
    """Note what the program in a row was built at, and that it is not answered yet."""
    table = arrays.table
    dof = table[0, 3]
    qp = qp_views(views.program, table[0, 0], table[0, 1], table[0, 2])
    copied(views.past.reshape(PAST * dof), past[:PAST].reshape(PAST * dof))
    copied(views.bounds[0], qp.lb[:dof])
    copied(views.bounds[1], qp.ub[:dof])
    copied(views.placement, arrays.placements[table[0, 5]])
    copied(views.least, kept_distances(following)[: views.least.size])
    views.figures[:] = 0.0
    views.decision[:] = 0.0
    views.blocking[:] = 0.0


@compiled
def _answer(views: RowViews, arrays: ProgramArrays, state: Vector) -> bool:
    """Ask the network for the answer to the program in a row, and note it.

    Returns:
        False if it did not settle or diverged; its state (size,) is then as it was.
    """
    table = arrays.table
    entry = table[1 + table[0, 4]]
    own = arrays.constants[entry[4] : entry[5]]
    qp = qp_views(views.program, table[0, 0], table[0, 1], table[0, 2])
    before = state.copy()
    figures = views.figures
    figures[0], figures[1], figures[2], figures[3], figures[4] = enter_answer(
        entry[1], qp, entry[2], own, state, views.point
    )
    views.decision[1] = 1.0
    views.decision[2] = status_of(figures, own, state)
    if views.decision[2] >= NOT_SETTLED:
        copied(state, before)
        return False
    return True


@compiled
def status_of(figures: Vector, own: Vector, state: Vector) -> int:
    """Judge an answer by its figures (5,); one that was advanced by its state (size,) too.

    The point of an infinite state is finite, since it is clipped to the bounds. `own` are the
    constants of the network.
    """
    size = figures[2] + figures[3] + figures[4]
    if own[DURATION] > 0.0:
        for i in range(state.size):
            size += abs(state[i])
    if not size < np.inf:
        return NOT_FINITE
    if own[DURATION] > 0.0:
        return ADVANCED
    settled = within(figures[2], figures[3], figures[4], own[TOLERANCE])
    return SOLVED if settled else NOT_SETTLED


@compiled
def sample_targets(arrays: ProgramArrays, t: float, targets: Matrix) -> None:
    """Write the targets (k, 18) of all paths at time t [s]; the constants begin with their base."""
    table = arrays.table
    first = 2 + table[0, 4]
    period = 1.0 / arrays.rate
    for k in range(first, table.shape[0]):
        own = arrays.constants[table[k, 4] : table[k, 5]]
        target = TargetData.of(targets[k - first])
        base = own[: TargetData.width()]
        move = own[TargetData.width() :]
        copied(target.numbers, base)
        enter_path(table[k, 1], t, move, target)
        if table[k, 2] != 0:
            then = TargetData.of(base.copy())
            enter_path(table[k, 1], t + period, move, then)
            set_mean_twist(target, then, period)
