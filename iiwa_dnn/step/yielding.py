"""Commands of steps whose nominal program is not answered: the task is relaxed, not the limits.

`iiwa_dnn.step.policies` defines the policies. The nominal program is tried before, unless a
policy acted at the last step. Then the first of these programs that has a solution is answered:

1. The scaled program, with the scaling factor of the task; its bounds are those of position and
   velocity limits. It needs a factor of 1, or the policy ``slow`` and a moving reference.
2. The relaxed program, unless the policy is ``stop``.
3. If there is none, the next command of a motion to rest is taken.

With acceleration or jerk limits the command is a step from the last command towards the answer,
within the bounds of the nominal program. If collisions are avoided too, the command is blended
towards the stored stopping motion until the arm can stop after it (`iiwa_dnn.step.stopping`).
"""

import math

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.naming import LimitKind
from iiwa_dnn.networks.integrators.base import SolveStats
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.dense import largest_entry, row_dot, times
from iiwa_dnn.qp.layout import QPViews, copied
from iiwa_dnn.qp.residuals import point_residuals, within
from iiwa_dnn.references.targets import TargetData
from iiwa_dnn.schemes.joint_limits import MotionConstants, joint_range, motion_constants
from iiwa_dnn.schemes.profiles import braking
from iiwa_dnn.schemes.program import program_views
from iiwa_dnn.step.fallback import (
    REACHED,
    Yielding,
    attained,
    hold_distances,
    largest_factor,
    nearest_within,
    note_limiting,
    relax_task,
    scale_task,
    solve_warm,
)
from iiwa_dnn.step.log import NOT_CONVERGED, SOLVED, StepLog, note_active, note_command
from iiwa_dnn.step.plan import ControlPlan, Instant
from iiwa_dnn.step.policies import Action, ProgramKind
from iiwa_dnn.step.stopping import (
    BRIEF,
    TRIES,
    least_periods,
    next_velocity,
    periods_to_rest,
    slow_down,
    store_command,
)

NONE, SLOW, RELAX, STOP, _ = map(int, Action)
BRAKE = -1
"""Code of no policy: the arm brakes to rest."""

NOMINAL, SCALED, RELAXED, RATE_LIMITED, STOPPED = map(int, ProgramKind)

CREEP = 0.1
"""Scaling factor below which the task is relaxed, and least fraction of a period by which the clock
then advances, so that the target leaves a singular or unreachable pose."""

SINGULAR = 0.05
"""Tip motion for a unit of joint velocity [m/rad] below which a pose counts as singular."""

POSITION_GAIN = 20.0
"""Velocity bound per distance to a position limit in fallback programs [1/s]."""

HALVINGS = 12
"""Number of halvings of the way from a command to the stored stopping motion. A pair that begins
near an obstacle may leave it slowly alone."""


@compiled
def yield_step(
    log: StepLog,
    plan: ControlPlan,
    instant: Instant,
    action: int,
) -> int:
    """Compute the command of a step without a nominal answer, by a fallback program or by braking.

    Called if the network has no answer or an unsafe one, if a policy acted at the last step, or if
    the arm is halted.

    Args:
        log: The step's log, with the nominal program and its joint positions; program, answer and
            command are overwritten.
        plan: Layout of the step; network states of the fallback programs are overwritten.
        instant: The instant of the step; the next state is overwritten.
        action: Action of the policy, or `BRAKE` to brake even if a program has a solution.

    Returns:
        The action that was taken.
    """
    yielding = plan.yielding
    next_motion_state = instant.next_motion
    sizes = plan.arrays.sizes
    qp = program_views(log.program, sizes)
    data = log.program.copy()
    nominal = program_views(data, sizes)
    lower_kind = log.lower_kind.copy()
    upper_kind = log.upper_kind.copy()
    kind = STOPPED
    factor = 0.0
    rest = 0.0
    nominal_solves = log.stats.iterations
    log.stats.iterations = 0.0
    if action != BRAKE:
        _widen_bounds(log, qp, motion_constants(plan.arrays))
        found, factor = _answer_fallback(log, qp, yielding, plan.fallback, action)
        kind = int(found)
    x = log.point[: qp.q.size].copy()
    limits = QPViews(qp.P, qp.q, qp.G, qp.h, qp.A, qp.b, nominal.lb, nominal.ub)
    own = log.program.copy()
    wider = program_views(own, sizes)
    copied(wider.lb, nominal.lb)
    copied(wider.ub, nominal.ub)
    contain(wider, plan, instant)
    if kind != STOPPED:
        _approach_answer(limits, wider, plan, instant, log.stats, x)
        rest = _make_stoppable(wider, plan, instant, log, x)
        missing = _note_missing(log, x[: sizes.joints])
        primal, dual, gap = point_residuals(limits, log.point)
        if missing > 0:
            kind = STOPPED if action == STOP else RATE_LIMITED
        elif factor == 1.0 and within(primal, dual, gap, yielding.tolerance):
            kind = NOMINAL
            copied(qp.lb, nominal.lb)
            copied(qp.ub, nominal.ub)
            copied(log.lower_kind, lower_kind)
            copied(log.upper_kind, upper_kind)
    _note_kinds(log, lower_kind, upper_kind)
    if kind == STOPPED:
        copied(log.program, data)
        copied(log.lower_kind, lower_kind)
        copied(log.upper_kind, upper_kind)
        rest = _brake(nominal, plan, instant, log, x)
        _keep_verified_distances(instant)
        log.point[:] = 0.0
        copied(log.point, x)
    log.stats.iterations += nominal_solves
    log.stats.primal, log.stats.dual, log.stats.gap = point_residuals(qp, log.point)
    taken = _note_decision(log, nominal, yielding, x, kind, factor, action)
    if taken == NONE:
        note_active(log, qp, yielding.tolerance)
    next_motion_state.stopping_periods = rest
    next_motion_state.path_lag += plan.timing.expected * (1.0 - log.fraction)
    next_motion_state.yields = kind != NOMINAL and action != BRAKE
    note_command(log, next_motion_state, x, plan.timing.expected)
    return taken


@compiled
def _note_kinds(log: StepLog, lower_kind: Vector, upper_kind: Vector) -> None:
    """Multiply the signs of the joints in log.limiting by the `LimitKind` of their bounds.

    A positive sign takes `upper_kind` (dof,), another `lower_kind` (dof,). The entries of rows are
    multiplied by 1 and their `StepLog.row_pair`.
    """
    for i in range(lower_kind.size):
        log.limiting[i] *= upper_kind[i] if log.limiting[i] > 0.0 else lower_kind[i]
    of_rows = log.limiting[log.limiting.size - log.row_pair.size :]
    for j in range(of_rows.size):
        of_rows[j] *= 1.0 + log.row_pair[j]


@compiled
def _note_decision(
    log: StepLog,
    nominal: QPViews,
    yielding: Yielding,
    x: Vector,
    kind: int,
    factor: float,
    action: int,
) -> int:
    """Write fraction, kind and status of a step into its log, and find the action that was taken.

    Args:
        log: The step's log; fraction, kind and status are overwritten. If the network of the
            nominal program failed and is not compiled, the primal residual of a nominal answer is
            set to inf.
        nominal: The nominal program.
        yielding: Weights of its equality rows, and whether its network is compiled.
        x: The command, with slack variables if any, (n,).
        kind: `ProgramKind` of the program that was answered.
        factor: Scaling factor of the task in the program.
        action: Action of the policy, or `BRAKE`.

    Returns:
        The action that was taken: `NONE`, `SLOW`, `RELAX` or `STOP`.
    """
    taken = STOP
    fraction = 0.0
    if kind <= SCALED:
        taken = NONE if factor == 1.0 else SLOW
        fraction = factor
    elif kind != STOPPED:
        taken = action if kind == RATE_LIMITED or _is_path(log.targets) else RELAX
        fraction = 1.0
        if taken == SLOW:
            fraction = max(attained(nominal.b, nominal.A, yielding.weights, x), CREEP)
    log.fraction = fraction
    log.kind = kind
    if taken == STOP:
        log.status = max(log.status, NOT_CONVERGED)
    elif kind != NOMINAL or yielding.alike:
        log.status = SOLVED
    elif log.status >= NOT_CONVERGED:  # another network than the failed one answered
        log.stats.primal = np.inf
    return taken


@compiled
def _widen_bounds(log: StepLog, qp: QPViews, limits: MotionConstants) -> None:
    """Replace the joints' bounds in a program by those of position and velocity limits alone.

    Overwrites the first entries of qp.lb and qp.ub [rad/s], and their kinds in the log; nothing
    without acceleration or jerk limits, and of a joint outside of its range, which comes back
    within these.
    """
    if not limits.rated:
        return
    for i in range(log.q.size):
        lower, upper = joint_range(limits, i)
        if log.q[i] < lower or log.q[i] > upper:
            continue
        fastest = limits.velocity[i]
        qp.lb[i] = min(max(POSITION_GAIN * (lower - log.q[i]), -fastest), fastest)
        qp.ub[i] = min(max(POSITION_GAIN * (upper - log.q[i]), -fastest), fastest)
        log.lower_kind[i] = LimitKind.POSITION if qp.lb[i] > -fastest else LimitKind.VELOCITY
        log.upper_kind[i] = LimitKind.POSITION if qp.ub[i] < fastest else LimitKind.VELOCITY


@compiled
def _answer_fallback(
    log: StepLog, qp: QPViews, yielding: Yielding, fallback: Vector, action: int
) -> tuple[float, float]:
    """Turn a program into the first fallback program that has a solution, and solve it.

    Args:
        log: The step's log; point, limiting and stats are overwritten.
        qp: The program with widened bounds, overwritten by the fallback program.
        yielding: Constants of the fallback programs.
        fallback: Network states of the fallback programs, (`fallback_size`,), overwritten.
        action: Action of the policy.

    Returns:
        `SCALED`, `RELAXED` or, if no program has a solution, `STOPPED`; and the scaling factor of
        the task, 0 unless `SCALED`.
    """
    n = qp.q.size
    m = qp.h.size
    tol = yielding.tolerance
    size = 3 * n + 3 + m + qp.b.size
    factor = _scaling_factor(log, qp, yielding, fallback[:size], action)
    if factor >= CREEP:
        asked = qp.b.copy()
        scale_task(qp, yielding.weights, factor)
        found = solve_warm(qp, tol, fallback[size:], log.point, log.stats)
        if qp.b.size == 0:
            note_limiting(log.point, n, m, 0, log.limiting)
        if found:
            return SCALED, factor
        copied(qp.b, asked)
        factor = factor if qp.b.size > 0 else -1.0
    if action == STOP:
        return STOPPED, 0.0
    retreat = 1.0
    if factor < 0.0:
        point = np.empty(2 * n + 2 + m + qp.b.size)
        retreat = largest_factor(qp, yielding, np.zeros(size), point, log.stats, True)
        retreat = max(retreat, 0.0)  # without a factor, the distance must not shrink
    relax_task(qp, yielding.weights, retreat)
    found = solve_warm(qp, tol, fallback[size:], log.point, log.stats)
    if not found and retreat > 0.0:  # retreats that contradict each other by less than rounding
        hold_distances(qp)
        found = solve_warm(qp, tol, fallback[size:], log.point, log.stats)
    note_limiting(log.point, n, m, 0, log.limiting)
    return RELAXED if found else STOPPED, 0.0


@compiled
def _scaling_factor(
    log: StepLog, qp: QPViews, yielding: Yielding, state: Vector, action: int
) -> float:
    """Compute the factor by which a policy scales the task; without a task it is 1.

    Args:
        log: The step's log; limiting and stats are overwritten.
        qp: The program with widened bounds.
        yielding: Constants of the fallback programs.
        state: Network state of the search, overwritten.
        action: Action of the policy.

    Returns:
        The factor; 0 if the policy does not scale by it; -1 if 0 is infeasible, too.
    """
    if qp.b.size == 0:
        return 1.0
    n = qp.q.size
    point = np.empty(2 * n + 2 + qp.h.size + qp.b.size)
    factor = largest_factor(qp, yielding, state, point, log.stats, False)
    note_limiting(point, n, qp.h.size, 1, log.limiting)
    follows = action == SLOW and _is_path(log.targets) and not _races(qp, point[:n])
    return factor if factor == 1.0 or follows else min(factor, 0.0)


@compiled
def _is_path(targets: Matrix) -> bool:
    """Test whether any of the targets (k, 18) moves, by a linear or angular velocity."""
    fastest = 0.0
    for k in range(targets.shape[0]):
        target = TargetData.of(targets[k])
        fastest = max(fastest, largest_entry(target.linear_velocity))
        fastest = max(fastest, largest_entry(target.angular_velocity))
    return fastest > 0.0


@compiled
def _races(qp: QPViews, x: Vector) -> bool:
    """Test whether joint velocities x (n,) are large while the rates A x of the task are small."""
    tip = 0.0
    for j in range(qp.b.size):
        tip = max(tip, abs(row_dot(qp.A, j, x)))
    return tip < SINGULAR * largest_entry(x)


@compiled
def _note_missing(log: StepLog, dq: Vector) -> int:
    """Count the joints whose command dq (dof,) [rad/s] differs from the answer in log.point.

    For each, log.limiting becomes the sign of the answer minus the command.
    """
    count = 0
    for i in range(dq.size):
        missing = log.point[i] - dq[i]
        if abs(missing) > REACHED:
            log.limiting[i] = math.copysign(1.0, missing)
            count += 1
    return count


@compiled
def _approach_answer(
    limits: QPViews,
    wider: QPViews,
    plan: ControlPlan,
    instant: Instant,
    stats: SolveStats,
    x: Vector,
) -> None:
    """Replace the answer x of a fallback program by the next command towards it, within limits.

    Without acceleration and jerk limits nothing changes.

    Args:
        limits: The program that was answered, with the nominal bounds.
        wider: The same, with bounds and rows that admit the stored motion (`contain`).
        plan: Layout of the step.
        instant: The instant of the step; the answer is written to `wanted` of the next state.
        stats: Statistics of the step, updated as in `solve_warm`.
        x: The answer, overwritten by the command [rad/s], (n,).
    """
    yielding = plan.yielding
    if not motion_constants(plan.arrays).rated:
        return
    copied(instant.next_motion.wanted, x[: instant.motion.q.size])
    # A straight line keeps the ratios of coupled joints.
    if yielding.coupled:
        _approach_together(plan, instant, x)
    else:
        _approach_each(limits, plan, instant, x)
    nearest_within(wider, x, yielding, stats)


@compiled
def _approach_each(limits: QPViews, plan: ControlPlan, instant: Instant, x: Vector) -> None:
    """Replace the wanted velocity x (n,) [rad/s] by the next command, joint by joint.

    Each joint approaches its wanted velocity as quickly as its limits allow. It does not overshoot
    a wanted velocity that keeps changing as since the last step (`motion_state.wanted`). Bounds are
    those of the program `limits`.
    """
    motion_state = instant.motion
    own = motion_constants(plan.arrays)
    for i in range(motion_state.q.size):
        most = own.acceleration[i] * plan.timing.dt
        change = min(max(x[i] - motion_state.wanted[i], -most), most)
        behind = motion_state.last[i] - (x[i] - change)
        jerk = own.jerk[i]
        x[i] += braking(behind, limits.lb[i] - x[i], limits.ub[i] - x[i], jerk, plan.timing)


@compiled
def _approach_together(plan: ControlPlan, instant: Instant, x: Vector) -> None:
    """Replace the wanted velocity x (n,) [rad/s] by the next command on a straight line to it.

    All joints reach it together; if no number of periods is enough, x stays.
    """
    motion_state = instant.motion
    limits = motion_constants(plan.arrays)
    dof = motion_state.q.size
    now = np.empty(dof)
    before = np.empty(dof)
    for i in range(dof):
        now[i] = motion_state.last[i] - x[i]
        before[i] = motion_state.before[i] - x[i]
    periods = least_periods(now, before, limits, plan.timing.dt, False)
    for i in range(dof):
        if periods < np.inf:
            x[i] += next_velocity(now[i], before[i], periods, limits.cubic)


@compiled
def _make_stoppable(
    limits: QPViews, plan: ControlPlan, instant: Instant, log: StepLog, x: Vector
) -> float:
    """Move a command towards the stored stopping motion, by halves, until all limits agree.

    If they do not agree with the command, the way begins at the next one on a straight line to the
    answer, along which all joints keep their direction. Bounds and rows that admit both admit each
    command between them.

    Args:
        limits: The program that was answered, with the nominal bounds.
        plan: Layout of the step.
        instant: The instant of the step; `least` of the next state is overwritten if the stored
            stopping motion itself is taken.
        log: The step's log, with the answer; its stats are updated.
        x: The command, overwritten [rad/s], (n,).

    Returns:
        Periods until the arm rests after the command; 0 if no stopping motion has to be verified.
    """
    dof = instant.motion.q.size
    rest = periods_to_rest(plan, instant, x[:dof], TRIES)
    if rest < np.inf:
        return rest
    wanted = log.point[: x.size].copy()
    if motion_constants(plan.arrays).rated:
        _approach_together(plan, instant, wanted)
        nearest_within(limits, wanted, plan.yielding, log.stats)
    brake = np.zeros(x.size)
    left = _brake(limits, plan, instant, log, brake)
    # Near a long stored motion, what is left of it is enough; a short one may have to grow.
    tries = 2 if instant.motion.stopping_periods * plan.timing.dt > BRIEF else TRIES
    fraction = 1.0
    for _ in range(HALVINGS):
        for i in range(dof):
            x[i] = brake[i] + fraction * (wanted[i] - brake[i])
        rest = periods_to_rest(plan, instant, x[:dof], tries)
        if rest < np.inf:
            return rest
        fraction *= 0.5
    copied(x, brake)
    _keep_verified_distances(instant)
    return left


@compiled
def contain(limits: QPViews, plan: ControlPlan, instant: Instant) -> None:
    """Widen bounds and rows of a program so that they admit the stored stopping motion.

    Writes limits.lb, limits.ub and limits.h; nothing if no motion is stored. The next command of
    the motion is then within them, so they are not empty.
    """
    if instant.motion.stopping_periods == 0.0:
        return
    brake = np.zeros(limits.q.size)
    store_command(plan, instant.motion, brake[: instant.motion.q.size])
    for i in range(instant.motion.q.size):
        limits.lb[i] = min(limits.lb[i], brake[i])
        limits.ub[i] = max(limits.ub[i], brake[i])
    for j in range(limits.h.size):
        limits.h[j] = max(limits.h[j], row_dot(limits.G, j, brake))


@compiled
def _keep_verified_distances(instant: Instant) -> None:
    """If a stopping motion is stored, copy its verified distances `least` to the next state."""
    if instant.motion.stopping_periods > 0.0:
        copied(instant.next_motion.least, instant.motion.least)


@compiled
def _brake(limits: QPViews, plan: ControlPlan, instant: Instant, log: StepLog, dq: Vector) -> float:
    """Compute the next command of the stored stopping motion or, if none is stored, of a new one.

    Without acceleration and jerk limits the command is zero. A new motion takes the number of
    periods of `least_periods`; its command keeps the bounds, widened so that it may go to rest, and
    the inequality rows are ignored.

    Args:
        limits: A program with the nominal bounds.
        plan: Layout of the step.
        instant: The instant of the step.
        log: The step's log; its stats are updated.
        dq: The command [rad/s], (n,), overwritten.

    Returns:
        Periods until rest after the command; 0 if no stopping motion from it is verified.
    """
    rates = motion_constants(plan.arrays)
    motion = instant.motion
    dq[:] = 0.0
    if motion.stopping_periods > 0.0:
        return store_command(plan, motion, dq)
    if not rates.rated:
        return 0.0
    dof = motion.q.size
    periods = least_periods(motion.last, motion.before, rates, plan.timing.dt, False)
    if periods < np.inf:
        slow_down(plan, motion, periods, dq)
    lb = limits.lb.copy()
    ub = limits.ub.copy()
    for i in range(dq.size if periods < np.inf else 0):
        lb[i] = min(lb[i], max(dq[i], 0.0))
        ub[i] = max(ub[i], min(dq[i], 0.0))
    # Coupled joints keep their ratios as they brake.
    coupled = np.zeros(limits.b.size)
    idle = np.empty(limits.h.size)
    idle[:] = np.inf
    times(limits.A, dq, coupled)
    braking = QPViews(limits.P, limits.q, limits.G, idle, limits.A, coupled, lb, ub)
    nearest_within(braking, dq, plan.yielding, log.stats)
    rest = periods_to_rest(plan, instant, dq[:dof], TRIES)
    return rest if rest < np.inf else 0.0
