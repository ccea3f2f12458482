"""Control step in one compiled call: build the program of the targets and solve it.

For seven joints the call of compiled code from Python takes a large part of a step's time, so there
is one call per step.
"""

import math

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.trigonometry import LARGEST
from iiwa_dnn.networks.integrators.base import (
    AnswerSettings,
    CompiledAnswer,
    SolveStats,
    enter_answer,
)
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.dense import all_finite, largest_entry
from iiwa_dnn.qp.layout import QPViews, copied
from iiwa_dnn.qp.residuals import is_small_enough, within
from iiwa_dnn.references.base import enter_path
from iiwa_dnn.references.rotations import set_mean_twist
from iiwa_dnn.references.targets import TargetData
from iiwa_dnn.schemes.collisions import MEET
from iiwa_dnn.schemes.joint_limits import (
    motion_constants,
    state_periods,
)
from iiwa_dnn.schemes.program import ProgramArrays, assemble, program_views
from iiwa_dnn.schemes.step import StepViews
from iiwa_dnn.step.log import (
    ADVANCED,
    NOT_CONVERGED,
    NOT_FINITE,
    SOLVED,
    StepLog,
    log_of,
    note_active,
    note_command,
)
from iiwa_dnn.step.plan import ControlPlan, Instant, PathColumn, Paths
from iiwa_dnn.step.state import MotionState, change_spacing
from iiwa_dnn.step.stopping import TRIES, periods_to_rest
from iiwa_dnn.step.yielding import BRAKE, NOMINAL, NONE, contain, yield_step

INVALID = -1
"""Result of a step whose time, targets or joint positions are invalid, so no command is given."""


@compiled
def take_step(
    data: Vector,
    plan: ControlPlan,
    q: Vector,
    numbers: Vector,
    next_numbers: Vector,
    state: Vector,
    t: float,
) -> int:
    """Take a control step: answer the nominal program, else a fallback program, else brake.

    If a policy acted at the last step, or the arm is halted, the nominal program is not answered.
    If targets or time are not finite, or joint positions beyond 2^20 rad, nothing is written.

    Args:
        data: The step's log with its targets, (width,), overwritten.
        plan: Constants, settings and work arrays; network states of fallback programs are changed.
        q: Joint positions of the kinematics [rad], (dof,).
        numbers: Numbers of the `MotionState`, (k,); q is written to it, and it is converted to the
            step's period (`change_spacing`).
        next_numbers: Numbers of the next `MotionState`, (k,), overwritten.
        state: State of the network, (size,), overwritten if the network has an answer.
        t: Time [s].

    Returns:
        The action that was taken, or `INVALID`.
    """
    arrays = plan.arrays
    timing = plan.timing
    sizes = arrays.sizes
    log = log_of(data, sizes)
    motion_state = MotionState.of(numbers, sizes.joints, sizes.pairs)
    next_motion_state = MotionState.of(next_numbers, sizes.joints, sizes.pairs)
    if not is_valid(t, q, data, data.size - log.targets.size):
        return INVALID
    copied(motion_state.q, q)
    change_spacing(motion_state, timing.dt)
    limits = motion_constants(arrays)
    if timing.vary:
        state_periods(limits, timing)
    copied(next_numbers, numbers)
    copied(next_motion_state.before, motion_state.last)
    next_motion_state.stopping_periods = 0.0
    next_motion_state.yields = False
    step = StepViews(
        t,
        1.0 / timing.expected,
        q,
        motion_state.last,
        motion_state.before,
        arrays.jacobian,
        arrays.placements,
        arrays.support,
        arrays.inertia,
        log.targets,
        next_motion_state.least,
        log.lower_kind,
        log.upper_kind,
        log.row_pair,
        limits.velocity,
        limits.acceleration,
    )
    instant = Instant(step, motion_state, next_motion_state)
    assemble(log.program, arrays, step)
    if largest_entry(plan.yielding.lengthens) > 0.0:  # else its rows may leave nothing
        contain(program_views(log.program, sizes), plan, instant)
    _note_instant(log, arrays, motion_state, next_motion_state)
    halted = motion_state.halts or largest_entry(log.least) == MEET
    if not motion_state.yields and not halted and _answer(log, arrays, plan.network, state):
        note_command(log, next_motion_state, log.point, timing.expected)
        rest = periods_to_rest(plan, instant, next_motion_state.last, TRIES)
        if rest < np.inf:
            next_motion_state.stopping_periods = rest
            note_active(log, program_views(log.program, sizes), plan.yielding.tolerance)
            return NONE
    policy = BRAKE if halted else plan.policy
    return yield_step(log, plan, instant, policy)


@compiled
def is_valid(t: float, q: Vector, data: Vector, targets: int) -> bool:
    """Test whether t [s], q (n,) [rad] and the targets, from data[targets] on, are valid."""
    for i in range(q.size):
        if not abs(q[i]) <= LARGEST:
            return False
    return math.isfinite(t) and all_finite(data, targets, data.size)


@compiled
def _note_instant(
    log: StepLog, arrays: ProgramArrays, motion_state: MotionState, next_motion_state: MotionState
) -> None:
    """Write the state and bounds of a step's nominal program into its log, and reset its answer."""
    qp = program_views(log.program, arrays.sizes)
    copied(log.q, motion_state.q)
    copied(log.last, motion_state.last)
    copied(log.before, motion_state.before)
    copied(log.lower, qp.lb[: log.lower.size])
    copied(log.upper, qp.ub[: log.upper.size])
    copied(log.placement, arrays.placements[arrays.tip])
    copied(log.least, next_motion_state.least)
    log.stats.numbers[:] = 0.0
    log.limiting[:] = 0.0
    log.fraction = 0.0
    log.status = SOLVED
    log.kind = NOMINAL


@compiled
def _answer(log: StepLog, arrays: ProgramArrays, network: CompiledAnswer, state: Vector) -> bool:
    """Answer the program of a log by the network, and write point, stats and status into the log.

    Returns:
        True if the network converged or, in continuous mode, was advanced; `state` (size,) is then
        overwritten, else unchanged.
    """
    qp = program_views(log.program, arrays.sizes)
    if network.settings.duration == 0.0 and _is_empty(qp, network.settings.tolerance):
        log.status = NOT_CONVERGED
        return False
    before = state.copy()
    stats = log.stats
    stats.iterations, stats.time, stats.primal, stats.dual, stats.gap = enter_answer(
        network.address, qp, network.rates, network.settings, state, log.point
    )
    log.fraction = 1.0
    log.status = status_of(qp, log.point, stats, network.settings, state)
    if log.status >= NOT_CONVERGED:
        copied(state, before)
        return False
    return True


@compiled
def _is_empty(qp: QPViews, tolerance: float) -> bool:
    """Test whether some inequality row admits no point within the bounds, beyond the tolerance.

    The network would search for one as long as it may.
    """
    for j in range(qp.h.size):
        least = 0.0
        for i in range(qp.q.size):
            rate = qp.G[j, i]
            least += rate * (qp.lb[i] if rate > 0.0 else qp.ub[i]) if rate != 0.0 else 0.0
        if least > qp.h[j] + tolerance:
            return True
    return False


@compiled
def status_of(
    qp: QPViews, point: Vector, stats: SolveStats, settings: AnswerSettings, state: Vector
) -> int:
    """Return the status of an answer, its index in `STATUSES`, from its residuals.

    A point (2n + m + p,) whose residuals are above the tolerance by rounding alone is an answer.

    If the network was advanced by a duration, its state (size,) has to be finite too: the point of
    an infinite state may be finite, since it is clipped to the bounds.
    """
    size = stats.primal + stats.dual + stats.gap
    if settings.duration > 0.0:
        for i in range(state.size):
            size += abs(state[i])
    if not size < np.inf:
        return NOT_FINITE
    if settings.duration > 0.0:
        return ADVANCED
    tol = settings.tolerance
    if within(stats.primal, stats.dual, stats.gap, tol) or is_small_enough(qp, point, tol, 0.0):
        return SOLVED
    return NOT_CONVERGED


@compiled
def sample_targets(paths: Paths, t: float, dt: float, targets: Matrix) -> None:
    """Sample all paths at time t [s] into `targets` (k, 18), which is overwritten.

    With feed-forward, the velocity of a target is the mean one over the period of dt [s].
    """
    for k in range(len(paths.table)):
        entry = paths.table[k]
        address = entry[PathColumn.ADDRESS]
        own = paths.constants[entry[PathColumn.START] : entry[PathColumn.STOP]]
        target = TargetData.of(targets[k])
        base = own[: TargetData.width()]
        move = own[TargetData.width() :]
        copied(target.numbers, base)
        enter_path(address, t, move, target)
        if entry[PathColumn.FEED_FORWARD] != 0:
            then = TargetData.of(base.copy())
            enter_path(address, t + dt, move, then)
            set_mean_twist(target, then, dt)
