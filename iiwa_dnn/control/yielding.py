"""Answers of steps without a solution, in one compiled call: limits hold, the task yields.

`iiwa_dnn.control.policies` says what each policy means. The nominal program came first, unless
the task yielded at the last step; then

1. the scaling factor of the task is computed, by position and velocity limits alone. If it is 1,
   the task as it is; with ``slow``, along a path, the scaled program;
2. else the relaxed program;
3. else the next command of a motion to rest.

With acceleration or jerk limits the command is a point on the way to the answer of that program,
within the bounds of the step; where collisions are avoided too, one from which the arm can stop
(`iiwa_dnn.control.stopping`), in the end the next command of the stored stopping motion.
"""

import math

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.control.command import NOT_CONVERGED, SOLVED, StepLog, note_active, note_command
from iiwa_dnn.control.fallback import (
    REACHED,
    Yielding,
    attained,
    largest_factor,
    nearest_within,
    note_limiting,
    relax_task,
    scale_task,
    solve_warm,
)
from iiwa_dnn.control.policies import Action, ProgramKind
from iiwa_dnn.control.state import MotionState
from iiwa_dnn.control.stopping import (
    least_periods,
    next_velocity,
    stopping_time,
    stretched,
)
from iiwa_dnn.naming import LimitKind
from iiwa_dnn.networks.integrators.base import SolveStats
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.dense import largest_entry, row_dot, times
from iiwa_dnn.qp.layout import QPViews, copied
from iiwa_dnn.qp.residuals import point_residuals, within
from iiwa_dnn.references.targets import TargetData
from iiwa_dnn.schemes.collisions import CollisionAvoidance
from iiwa_dnn.schemes.layout import ProgramLayout
from iiwa_dnn.schemes.periods import Periods
from iiwa_dnn.schemes.profiles import braking
from iiwa_dnn.schemes.program import ProgramArrays, block_constants, program_views
from iiwa_dnn.schemes.rate_limits import MotionConstants, MotionLimits
from iiwa_dnn.schemes.scene import scene_views

NONE, SLOW, RELAX, STOP, _ = map(int, Action)
BRAKE = -1
"""No policy: the arm goes to rest."""

NOMINAL, SCALED, RELAXED, RATE_LIMITED, STOPPED = map(int, ProgramKind)

CREEP = 0.1
"""Scaling factor below which the task is relaxed, and fraction of a period by which the clock then
advances: an arm that rests in a singular or unreachable pose does not hold its target there."""

SINGULAR = 0.05
"""Tip motion for a unit of joint velocity [m/rad] below which a pose counts as singular."""

POSITION_GAIN = 20.0
"""Rate at which the wanted velocity falls towards a position limit [1/s]."""

HALVINGS = 4
HALVINGS_NEAR = 12
"""Fractions of the way from the stored stopping motion to the wanted command that are tried, each
half
of the one before: where a pair began nearer, there is but a micrometre for the motion's curve."""


def make_yielding(program: ProgramLayout, tol: float, alike: bool) -> Yielding:
    """Return the constants of the fallback programs of a scheme.

    Args:
        program: The scheme.
        tol: Tolerance of the answers.
        alike: Whether the network of the steps is that of the fallback programs.
    """
    limits = MotionConstants.zeros(0)
    if program.rate_limits is not None:
        limits = program.rate_limits.constants(program.robot)
    weights = program.row_weights
    return Yielding(
        weights,
        limits,
        tol,
        [*program.places_of(MotionLimits), -1][0],
        np.array(program.places_of(CollisionAvoidance), dtype=np.int64),
        bool((limits.jerk < np.inf).any()),
        bool((weights == 0.0).any()),
        alike,
    )


@compiled
def yield_step(
    log: StepLog,
    arrays: ProgramArrays,
    motion_state: MotionState,
    next_motion_state: MotionState,
    yielding: Yielding,
    timing: Periods,
    fallback: Vector,
    action: int,
) -> int:
    """Answer a step whose nominal program was not answered, by the policy or the stopping motion.

    The network had no answer, or one that is not safe; or it was not asked, since the task yielded
    at the last step or the arm is halted.

    Args:
        log: The log, with the nominal program and what it was built at.
        arrays: Arrays of the loop; the kinematics are at the joint positions of the state.
        motion_state: State of the motion.
        next_motion_state: The same for the next step, overwritten.
        yielding: Weights, limits and settings of the fallback programs.
        timing: Periods of the step.
        fallback: States of the networks of fallback programs, (`fallback_size`,), advanced.
        action: Action that the policy asks for; `BRAKE`: the arm goes to rest, whatever has a
            solution.

    Returns:
        The action that was taken.
    """
    qp = program_views(log.program, arrays.sizes)
    data = log.program.copy()
    nominal = program_views(data, arrays.sizes)
    lower_kind = log.lower_kind.copy()
    upper_kind = log.upper_kind.copy()
    kind = STOPPED
    factor = 0.0
    rest = 0.0
    if action != BRAKE:
        _widen_bounds(log, qp, yielding.limits)
        found, factor = _answer_fallback(log, qp, yielding, fallback, action)
        kind = int(found)
    x = log.point[: qp.q.size].copy()
    limits = QPViews(qp.P, qp.q, qp.G, qp.h, qp.A, qp.b, nominal.lb, nominal.ub)
    if kind != STOPPED:
        _approach_answer(limits, motion_state, next_motion_state, yielding, timing, log.stats, x)
        rest = _make_stoppable(
            limits, arrays, motion_state, next_motion_state, yielding, timing, log, x
        )
        missing = _note_missing(log, x[: arrays.sizes.joints])
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
        rest = _brake(nominal, arrays, motion_state, yielding, timing, log, x)
        _keep_verified_distances(motion_state, next_motion_state)
        log.point[:] = 0.0
        copied(log.point, x)
    log.stats.primal, log.stats.dual, log.stats.gap = point_residuals(qp, log.point)
    taken = _note_decision(log, nominal, yielding, x, kind, factor, action)
    if taken == NONE:
        note_active(log, qp, yielding.tolerance)
    next_motion_state.stopping_periods = rest
    next_motion_state.path_lag += timing.expected * (1.0 - log.fraction)
    next_motion_state.yields = kind != NOMINAL and action != BRAKE
    note_command(log, next_motion_state, x, timing.expected)
    return taken


@compiled
def _note_kinds(log: StepLog, lower_kind: Vector, upper_kind: Vector) -> None:
    """Put the kinds (dof,) of the step's bounds in place of the sides that limit the solution."""
    for i in range(lower_kind.size):
        log.limiting[i] *= upper_kind[i] if log.limiting[i] > 0.0 else lower_kind[i]


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
    """Note how far the reference's clock advances, status and kind of the program.

    Args:
        log: The step's log.
        nominal: The nominal program.
        yielding: Weights of its task rows, and whose the network is.
        x: The command, (n,).
        kind: Kind of the program that was answered.
        factor: Scaling factor of the task in it.
        action: Action that the policy asks for.

    Returns:
        The action that was taken.
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
    elif log.status >= NOT_CONVERGED:  # the answer is not that of the network that failed
        log.stats.primal = np.inf
    return taken


@compiled
def _widen_bounds(log: StepLog, qp: QPViews, limits: MotionConstants) -> None:
    """Replace bounds that acceleration limits have narrowed by those of position and velocity."""
    for i in range(limits.velocity.size):
        fastest = limits.velocity[i]
        qp.lb[i] = min(max(POSITION_GAIN * (limits.lower[i] - log.q[i]), -fastest), fastest)
        qp.ub[i] = min(max(POSITION_GAIN * (limits.upper[i] - log.q[i]), -fastest), fastest)
        log.lower_kind[i] = LimitKind.POSITION if qp.lb[i] > -fastest else LimitKind.VELOCITY
        log.upper_kind[i] = LimitKind.POSITION if qp.ub[i] < fastest else LimitKind.VELOCITY


@compiled
def _answer_fallback(
    log: StepLog, qp: QPViews, yielding: Yielding, fallback: Vector, action: int
) -> tuple[float, float]:
    """Turn a step's program into the first fallback program that has a solution, and answer it.

    Returns:
        Its kind, and the scaling factor of the task in it.
    """
    n = qp.q.size
    m = qp.h.size
    tol = yielding.tolerance
    point = np.empty(2 * n + 2 + m + qp.b.size)
    size = 3 * n + 3 + m + qp.b.size
    factor = largest_factor(qp, yielding, fallback[:size], point, log.stats, False)
    note_limiting(point, n, m, 1, log.limiting)
    follows = action == SLOW and _is_path(log.targets) and not _races(qp, point[:n])
    if factor == 1.0 or (follows and factor >= CREEP):
        asked = qp.b.copy()
        scale_task(qp, yielding.weights, factor)
        if solve_warm(qp, tol, fallback[size:], log.point, log.stats):
            return SCALED, factor
        copied(qp.b, asked)
    if action == STOP:
        return STOPPED, 0.0
    retreat = 1.0
    if factor < 0.0:
        retreat = largest_factor(qp, yielding, np.zeros(size), point, log.stats, True)
        retreat = max(retreat, 0.0)  # what cannot be said to retreat may come no nearer
    relax_task(qp, yielding.weights, retreat)
    found = solve_warm(qp, tol, fallback[size:], log.point, log.stats)
    note_limiting(log.point, n, m, 0, log.limiting)
    return RELAXED if found else STOPPED, 0.0


@compiled
def _is_path(targets: Matrix) -> bool:
    """Test whether a target (k, 18) has a velocity."""
    fastest = 0.0
    for k in range(targets.shape[0]):
        target = TargetData.of(targets[k])
        fastest = max(fastest, largest_entry(target.linear_velocity))
        fastest = max(fastest, largest_entry(target.angular_velocity))
    return fastest > 0.0


@compiled
def _races(qp: QPViews, x: Vector) -> bool:
    """Test whether joints are fast in x (n,) while the tip hardly moves."""
    tip = 0.0
    for j in range(qp.b.size):
        tip = max(tip, abs(row_dot(qp.A, j, x)))
    return tip < SINGULAR * largest_entry(x)


@compiled
def _note_missing(log: StepLog, dq: Vector) -> int:
    """Note the joints whose command dq (dof,) is short of the answer; return how many are."""
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
    motion_state: MotionState,
    next_motion_state: MotionState,
    yielding: Yielding,
    timing: Periods,
    stats: SolveStats,
    x: Vector,
) -> None:
    """Turn a wanted velocity x (n,) into the next command on the way to it.

    Args:
        limits: The program that was answered, with the bounds of the step.
        motion_state: State of the motion.
        next_motion_state: State for the next step: the wanted velocity is noted.
        yielding: Weights, limits and settings.
        timing: Periods of the step.
        stats: Statistics of the answer, as of `solve_warm`.
        x: The velocity, overwritten.
    """
    if yielding.limits.velocity.size == 0:
        return
    copied(next_motion_state.wanted, x[: motion_state.q.size])
    # Joints that follow others have to go with them, on a straight line.
    if yielding.coupled:
        _approach_together(motion_state, yielding, timing, x)
    else:
        _approach_each(limits, motion_state, yielding, timing, x)
    nearest_within(limits, x, yielding, stats)


@compiled
def _approach_each(
    limits: QPViews, motion_state: MotionState, yielding: Yielding, timing: Periods, x: Vector
) -> None:
    """Replace the wanted velocity x (n,) by the next command, joint by joint.

    Each joint goes as quickly as its limits allow, without passing a velocity that goes on changing
    as it has done since the last step.
    """
    dof = motion_state.q.size
    for i in range(dof):
        most = yielding.limits.acceleration[i] * timing.dt
        change = min(max(x[i] - motion_state.wanted[i], -most), most)
        behind = motion_state.last[i] - (x[i] - change)
        rate = yielding.limits.jerk[i]
        x[i] += braking(behind, limits.lb[i] - x[i], limits.ub[i] - x[i], rate, timing)


@compiled
def _approach_together(
    motion_state: MotionState, yielding: Yielding, timing: Periods, x: Vector
) -> None:
    """Replace the wanted velocity x (n,) by the next command on the straight line to it."""
    dof = motion_state.q.size
    now = np.empty(dof)
    before = np.empty(dof)
    for i in range(dof):
        now[i] = motion_state.last[i] - x[i]
        before[i] = motion_state.before[i] - x[i]
    dt = timing.dt
    periods = least_periods(now, before, yielding.limits, dt, yielding.cubic, False)
    for i in range(dof):
        if periods < np.inf:
            x[i] += next_velocity(now[i], before[i], periods, yielding.cubic)


@compiled
def _make_stoppable(
    limits: QPViews,
    arrays: ProgramArrays,
    motion_state: MotionState,
    next_motion_state: MotionState,
    yielding: Yielding,
    timing: Periods,
    log: StepLog,
    x: Vector,
) -> float:
    """Blend a command x (n,) towards the stored stopping motion until the arm can stop from it.

    Returns:
        Periods until it rests; 0 where none is asked for.
    """
    dof = motion_state.q.size
    rest = stopping_time(arrays, motion_state, log.least, yielding, timing, x[:dof])
    if rest >= 0.0:
        return rest
    wanted = log.point[: x.size].copy()
    if yielding.limits.velocity.size > 0:
        _approach_together(motion_state, yielding, timing, wanted)
        nearest_within(limits, wanted, yielding, log.stats)
    brake = np.zeros(x.size)
    left = _brake(limits, arrays, motion_state, yielding, timing, log, brake)
    fraction = 1.0
    for _ in range(HALVINGS_NEAR if _is_near(arrays, yielding, log.least) else HALVINGS):
        for i in range(dof):
            x[i] = brake[i] + fraction * (wanted[i] - brake[i])
        rest = stopping_time(arrays, motion_state, log.least, yielding, timing, x[:dof])
        if rest >= 0.0:
            return rest
        fraction *= 0.5
    copied(x, brake)
    _keep_verified_distances(motion_state, next_motion_state)
    return left


@compiled
def _is_near(arrays: ProgramArrays, yielding: Yielding, least: Vector) -> bool:
    """Test whether a pair keeps less than the least distance of its scene, `least` (pairs,) [m]."""
    found = False
    for k in range(len(yielding.scenes)):
        own = block_constants(arrays, yielding.scenes[k])
        scene = scene_views(own, arrays.sizes.joints)
        for i in range(len(scene.pairs)):
            found = found or least[scene.head.first + i] < scene.head.least
    return found


@compiled
def _keep_verified_distances(motion_state: MotionState, next_motion_state: MotionState) -> None:
    """Keep the distances of pairs for which the stored stopping motion was verified."""
    if motion_state.stopping_periods > 0.0:
        copied(next_motion_state.least, motion_state.least)


@compiled
def _brake(
    limits: QPViews,
    arrays: ProgramArrays,
    motion_state: MotionState,
    yielding: Yielding,
    timing: Periods,
    log: StepLog,
    dq: Vector,
) -> float:
    """Write the next command (n,) of the stored stopping motion, or of the quickest one.

    It is zero without acceleration limits. The quickest one keeps the bounds as far as they do not
    lead away from rest; no row asks it for motion.

    Returns:
        Periods that are left afterwards. If no stopping motion is stored, those of one from the new
        command, 0 if there is none.
    """
    dq[:] = 0.0
    if yielding.limits.velocity.size == 0:
        return 0.0
    rest: float = motion_state.stopping_periods
    dof = motion_state.q.size
    dt = timing.dt
    periods = rest
    last = motion_state.last
    before = motion_state.before
    if rest == 0.0:
        periods = least_periods(last, before, yielding.limits, dt, yielding.cubic, False)
    elif yielding.cubic and timing.vary:
        periods = stretched(last, before, yielding.limits, dt, rest)
    if periods < np.inf:
        _slow_down(motion_state, yielding, timing, periods, dq)
    if rest > 0.0:
        return max(periods - 1.0, 0.0)
    lb = limits.lb.copy()
    ub = limits.ub.copy()
    for i in range(dq.size if periods < np.inf else 0):
        lb[i] = min(lb[i], max(dq[i], 0.0))
        ub[i] = max(ub[i], min(dq[i], 0.0))
    # Joints that follow others go on to, as they brake.
    rates = np.zeros(limits.b.size)
    idle = np.empty(limits.h.size)
    idle[:] = np.inf
    times(limits.A, dq, rates)
    braking = QPViews(limits.P, limits.q, limits.G, idle, limits.A, rates, lb, ub)
    nearest_within(braking, dq, yielding, log.stats)
    return max(stopping_time(arrays, motion_state, log.least, yielding, timing, dq[:dof]), 0.0)


@compiled
def _slow_down(
    motion_state: MotionState, yielding: Yielding, timing: Periods, periods: float, dq: Vector
) -> None:
    """Write the next command (n,) on the straight path to rest in so many periods."""
    dof = motion_state.q.size
    for i in range(dof):
        last = motion_state.last[i]
        fastest = max(yielding.limits.velocity[i], abs(last))
        change = yielding.limits.acceleration[i] * timing.dt
        dq[i] = next_velocity(last, motion_state.before[i], periods, yielding.cubic)
        # Where the control period has changed, the curve has too.
        dq[i] = min(max(dq[i], last - change), last + change)
        dq[i] = min(max(dq[i], -fastest), fastest)


@compiled
def guard_step(
    arrays: ProgramArrays,
    motion_state: MotionState,
    next_motion_state: MotionState,
    yielding: Yielding,
    timing: Periods,
) -> bool:
    """Test whether the arm can stop from the next state's command, and note in how many periods.

    Args:
        arrays: Arrays of the loop.
        motion_state: State of the motion.
        next_motion_state: State for the next step.
        yielding: Limits and scenes.
        timing: Periods of the step.
    """
    rest = stopping_time(
        arrays, motion_state, next_motion_state.least, yielding, timing, next_motion_state.last
    )
    next_motion_state.stopping_periods = max(rest, 0.0)
    return rest >= 0.0
