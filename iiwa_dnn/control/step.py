"""A whole control step in one compiled call: targets, program and the network's answer.

For seven joints the way into compiled code is a large part of the cost of a call, so a control loop
enters it once a step.
"""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.control.command import (
    ADVANCED,
    NOT_FINITE,
    NOT_SETTLED,
    PAST,
    PLACEMENT,
    SOLVED,
    RowLayout,
    RowViews,
    row_views,
)
from iiwa_dnn.control.relaxed import Yielding, relaxed_size
from iiwa_dnn.control.state import (
    BEFORE,
    DELAY,
    HALTED,
    LAST,
    REST,
    WANTED,
    YIELDS,
    Q,
)
from iiwa_dnn.control.yielding import (
    BRAKE,
    NONE,
    OWN,
    STOPPED,
    guard_step,
    make_yielding,
    yield_step,
)
from iiwa_dnn.networks.integrators.base import BUDGET, DURATION, TOLERANCE, enter_answer
from iiwa_dnn.networks.projection import is_projection
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import qp_views
from iiwa_dnn.qp.residuals import within
from iiwa_dnn.references import Reference
from iiwa_dnn.references.base import Ahead, enter_path
from iiwa_dnn.references.rotations import set_mean_twist
from iiwa_dnn.schemes.limits import check_ranges
from iiwa_dnn.schemes.program import LimitNames, ProgramArrays, StepProgram, assemble

FEASIBLE_BUDGET = 60.0
"""Linear systems after which a program with acceleration or jerk limits counts as infeasible."""

INVALID = -1
"""Action at joint positions or targets that are not finite: nothing is changed."""


class StepPlan(NamedTuple):
    """Layout of a control step.

    Attributes:
        arrays: Arrays with which the program is written.
        yielding: What relaxed programs need beside them.
        policy: Action that the policy asks for at a step without a solution; `BRAKE`: none.
        shares_state: Whether relaxed programs start from the state of the step's own network.
    """

    arrays: ProgramArrays
    yielding: Yielding
    policy: int
    shares_state: bool


class ControlStep:
    """A control step laid out for a scheme, references and a network.

    Attributes:
        program: The scheme laid out for the robot.
        layout: Columns of the rows that are written.
        names: Names of the limits.
        dt: Control period [s].
        plan: Arrays and settings that stay the same from step to step.
        has_network: Whether the network is compiled.
        samples: Whether the compiled step samples the targets: all references are compiled, and no
            part is refreshed by the targets of a step.
        relaxed_size: Numbers of the states of relaxed programs' networks.
    """

    def __init__(
        self,
        program: StepProgram,
        references: Mapping[str, Reference],
        solver: DNNSolver,
        dt: float,
        policy: int,
    ) -> None:
        """Lay a control step out.

        Args:
            program: The scheme laid out for the robot.
            references: Reference of each tracked frame, or none.
            solver: The network that answers the programs.
            dt: Control period [s].
            policy: Action of a step without a solution; `BRAKE`: in continuous mode.
        """
        self.program = program
        self.dt = dt
        frames = program.target_frames
        self.names = LimitNames(program, dt)
        self.layout = RowLayout(program.sizes, program.robot.dof, len(frames), self.names)
        self.has_network = self._add_network(solver, dt if policy == BRAKE else 0.0)
        self.samples = self._add_paths(references) and not program.reads_targets
        arrays = program.arrays(dt)
        if program.rate_limits is not None:
            check_ranges(program.rate_limits.constants(program.robot), arrays.rate)
        yielding = make_yielding(program, solver.tol, dt)
        self.plan = StepPlan(arrays, yielding, policy, is_projection(solver.network))
        self.relaxed_size = relaxed_size(program.sizes)

    def set_period(self, dt: float) -> None:
        """Take another control period [s], without laying anything out anew.

        Raises:
            InvalidInputError: With a jerk limit, a joint's range is too short to turn round in.
        """
        program = self.program
        if program.rate_limits is not None:
            check_ranges(program.rate_limits.constants(program.robot), 1.0 / dt)
        self.dt = dt
        self.names.dt = dt
        arrays = self.plan.arrays._replace(rate=1.0 / dt)
        yielding = self.plan.yielding._replace(dt=dt)
        self.plan = self.plan._replace(arrays=arrays, yielding=yielding)
        if self.has_network:  # 0 where the network settles
            program.constants[self._duration_at] = dt * self._duration_rate

    @property
    def yields(self) -> bool:
        """Test whether the task yields to acceleration or jerk limits."""
        return self.plan.yielding.limits.size > 0

    def _add_network(self, solver: DNNSolver, duration: float) -> bool:
        """Add the network's entry to the table; return whether the network is compiled."""
        program = self.program
        answer = None
        # A subclass that solves in a way of its own is asked, not bypassed.
        if type(solver) is DNNSolver:
            answer = solver.compiled_answer(program.sizes, duration)
        if answer is None:
            program.append(0, np.zeros(0))
            return False
        if program.rate_limits is not None:
            # A program that a few systems do not solve most likely has no solution.
            answer.constants[BUDGET] = min(answer.constants[BUDGET], FEASIBLE_BUDGET)
        self._duration_at = program.constants.size + DURATION
        self._duration_rate = answer.constants[DURATION] / self.dt
        program.append(answer.address, answer.constants, answer.rates)
        return True

    def _add_paths(self, references: Mapping[str, Reference]) -> bool:
        """Add an entry for each reference; return whether all of them are compiled."""
        frames = self.program.target_frames
        seen = [references[name] for name in frames if name in references]
        paths = [path.along if isinstance(path, Ahead) else path for path in seen]
        if len(paths) < len(frames) or not all(path.compiled for path in paths):
            return False
        if any(isinstance(path, Ahead) and path.dt != self.dt for path in seen):
            return False
        for path, other in zip(paths, seen, strict=True):
            constants = np.concatenate([path.base, path.constants])
            self.program.append(
                enter_path.address(path.compiled), constants, int(path is not other)
            )
        return True


@compiled
def take_step(
    row: Vector,
    plan: StepPlan,
    past: Matrix,
    following: Matrix,
    state: Vector,
    relaxed: Vector,
    t: float,
    samples: bool,
) -> int:
    """Take a control step: its own program, or what the policy asks for.

    Args:
        row: The row, (width,), with the targets unless they are sampled.
        plan: What the step is laid out with.
        past: `ControllerState.past`, (8, dof); the kinematics are at its joint positions.
        following: The same for the next step, overwritten.
        state: The network's state, (size,), advanced.
        relaxed: States of the networks of relaxed programs, (`relaxed_size`,), advanced.
        t: Time [s].
        samples: Whether the references are asked for the targets.

    Returns:
        The action that was taken, or `INVALID`.
    """
    solved = begin_step(row, plan, past, following, state, t, samples, True)
    return finish_step(row, plan, past, following, state, relaxed, solved)


@compiled
def begin_step(
    row: Vector,
    plan: StepPlan,
    past: Matrix,
    following: Matrix,
    state: Vector,
    t: float,
    samples: bool,
    asks: bool,
) -> bool:
    """Write targets, program and answer of one control step into a row.

    Arguments are those of `take_step`; `asks` says that the network is asked, unless the task
    yielded at the last step, or the arm brakes.

    Returns:
        False if the network was not asked, did not settle or diverged; `state` is then as it was.
    """
    arrays = plan.arrays
    table = arrays.table
    constants = arrays.constants
    n = table[0, 0]
    m = table[0, 1]
    p = table[0, 2]
    dof = table[0, 3]
    network = 1 + table[0, 4]
    views = row_views(row, n, m, p, dof)
    qp = qp_views(views.program, n, m, p)
    for i in range(dof):
        for k in range(PAST):
            views.past[k, i] = past[k, i]
    if samples:
        sample_targets(arrays, t - past[DELAY, 0], views.targets)
    assemble(views.program, arrays, past, views.targets, t)
    for i in range(dof):
        views.bounds[0, i] = qp.lb[i]
        views.bounds[1, i] = qp.ub[i]
    for i in range(PLACEMENT):
        views.placement[i] = arrays.placements[table[0, 5], i]
    clear_answer(views)
    if not asks or past[YIELDS, 0] != 0.0 or past[HALTED, 0] != 0.0:
        return False
    own = constants[table[network, 4] : table[network, 5]]
    address = table[network, 1]
    rates = table[network, 2]
    before = state.copy()
    iterations, time, primal, dual, gap = enter_answer(address, qp, rates, own, state, views.point)
    views.figures[0] = iterations
    views.figures[1] = time
    views.figures[2] = primal
    views.figures[3] = dual
    views.figures[4] = gap
    views.decision[1] = 1.0
    views.decision[2] = status_of(primal, dual, gap, own, state)
    if views.decision[2] >= NOT_SETTLED:
        for i in range(state.size):
            state[i] = before[i]
        return False
    for i in range(dof):
        views.dq[i] = views.point[i]
        following[BEFORE, i] = past[LAST, i]
        following[LAST, i] = views.point[i]
        following[WANTED, i] = past[WANTED, i]
    following[REST, 0] = 0.0
    return True


@compiled
def finish_step(
    row: Vector,
    plan: StepPlan,
    past: Matrix,
    following: Matrix,
    state: Vector,
    relaxed: Vector,
    solved: bool,
) -> int:
    """Answer a step that is not solved, or whose command cannot be stopped; advance the clock.

    Arguments and result are those of `take_step`; `solved` is the result of `begin_step`.
    """
    table = plan.arrays.table
    yielding = plan.yielding
    following[DELAY, 0] = past[DELAY, 0]
    following[YIELDS, 0] = 0.0
    following[HALTED, 0] = past[HALTED, 0]
    if solved and guard_step(plan.arrays, past, following, yielding):
        return NONE
    views = row_views(row, table[0, 0], table[0, 1], table[0, 2], table[0, 3])
    if not _all_finite(past[Q]) or not _all_finite(row[row.size - views.targets.size :]):
        return INVALID
    policy = plan.policy if past[HALTED, 0] == 0.0 else BRAKE
    cold = np.zeros(3 * table[0, 0] + table[0, 1] + table[0, 2])
    if plan.shares_state and state.size == cold.size:
        cold = state
    action = yield_step(row, plan.arrays, past, following, cold, yielding, relaxed, policy)
    kind = views.decision[3]
    following[DELAY, 0] += yielding.dt * (1.0 - views.decision[1])
    following[YIELDS, 0] = 1.0 if OWN < kind < STOPPED else 0.0
    return action


@compiled
def _all_finite(values: Vector) -> bool:
    """Test whether all of some numbers (k,) are finite."""
    others = 0
    for i in range(values.size):
        others += not math.isfinite(values[i])
    return others == 0


@compiled
def clear_answer(views: RowViews) -> None:
    """Note that no answer was asked for: no figures, no decision, and nothing in the way."""
    for k in range(views.figures.size):
        views.figures[k] = 0.0
    for k in range(views.decision.size):
        views.decision[k] = 0.0
    for k in range(views.blocking.size):
        views.blocking[k] = 0.0


@compiled
def status_of(primal: float, dual: float, gap: float, own: Vector, state: Vector) -> int:
    """Judge an answer by its residuals; one that was advanced by its state (size,) too.

    The point of an infinite state is finite, since it is clipped to the bounds. `own` are the
    constants of the network.
    """
    size = primal + dual + gap
    if own[DURATION] > 0.0:
        for i in range(state.size):
            size += abs(state[i])
    if not size < np.inf:
        return NOT_FINITE
    if own[DURATION] > 0.0:
        return ADVANCED
    return SOLVED if within(primal, dual, gap, own[TOLERANCE]) else NOT_SETTLED


@compiled
def sample_targets(arrays: ProgramArrays, t: float, targets: Matrix) -> None:
    """Write the targets (k, 18) of all paths at time t [s]; the constants begin with their base."""
    table = arrays.table
    first = 2 + table[0, 4]
    period = 1.0 / arrays.rate
    for k in range(first, table.shape[0]):
        own = arrays.constants[table[k, 4] : table[k, 5]]
        target = targets[k - first]
        move = own[target.size :]
        for i in range(target.size):
            target[i] = own[i]
        enter_path(table[k, 1], t, move, target)
        if table[k, 2] != 0:
            then = np.empty(target.size)
            for i in range(target.size):
                then[i] = own[i]
            enter_path(table[k, 1], t + period, move, then)
            set_mean_twist(target, then, period)
