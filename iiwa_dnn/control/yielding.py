"""Commands of steps whose nominal program is not answered: the task is relaxed, not the limits.

`iiwa_dnn.control.policies` defines the policies. The nominal program is tried before, unless a
policy acted at the last step. Then the first of these programs that has a solution is answered:

1. The scaled program, with the scaling factor of the task; its bounds are those of position and
   velocity limits. It needs a factor of 1, or the policy ``slow`` and a moving reference.
2. The relaxed program, unless the policy is ``stop``.
3. If there is none, the next command of a motion to rest is taken.

With acceleration or jerk limits the command is a step from the last command towards the answer,
within the bounds of the nominal program. If collisions are avoided too, the command is blended
towards the stored stopping motion until the arm can stop after it (`iiwa_dnn.control.stopping`).
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
"""Code of no policy: the arm brakes to rest."""

NOMINAL, SCALED, RELAXED, RATE_LIMITED, STOPPED = map(int, ProgramKind)

CREEP = 0.1
"""Scaling factor below which the task is relaxed, and least fraction of a period by which the clock
then advances, so that the target leaves a singular or unreachable pose."""

SINGULAR = 0.05
"""Tip motion for a unit of joint velocity [m/rad] below which a pose counts as singular."""

POSITION_GAIN = 20.0
"""Velocity bound per distance to a position limit in fallback programs [1/s]."""

HALVINGS = 4
HALVINGS_NEAR = 12
"""Numbers of blends of the stopping motion with a command that are tried, each with half the
command's part of the one before; HALVINGS_NEAR if a pair keeps less than its scene's distance."""


def make_yielding(program: ProgramLayout, tol: float, alike: bool) -> Yielding:
    """Return the constants of the fallback programs of a scheme.

    Args:
        program: The scheme.
        tol: Tolerance of the residuals of an answer.
        alike: Whether the network of the nominal program is compiled.
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
    """Compute the command of a step without a nominal answer, by a fallback program or by braking.

    Called if the network has no answer or an unsafe one, if a policy acted at the last step, or if
    the arm is halted.

    Args:
        log: The step's log, with the nominal program and its joint positions; program, answer and
            command are overwritten.
        arrays: Arrays of the scheme's programs, with the kinematics at the joint positions.
        motion_state: State of the motion.
        next_motion_state: State for the next step, overwritten.
        yielding: Constants of the fallback programs and stopping motions.
        timing: Periods of the step.
        fallback: Network states of the fallback programs, (`fallback_size`,), overwritten.
        action: Action of the policy, or `BRAKE` to brake even if a program has a solution.

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
    """Multiply the signs of the joints in log.limiting by the `LimitKind` of their bounds.

    A positive sign takes `upper_kind` (dof,), another `lower_kind` (dof,).
    """
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
    without acceleration or jerk limits.
    """
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
        retreat = max(retreat, 0.0)  # without a factor, the distance must not shrink
    relax_task(qp, yielding.weights, retreat)
    found = solve_warm(qp, tol, fallback[size:], log.point, log.stats)
    note_limiting(log.point, n, m, 0, log.limiting)
    return RELAXED if found else STOPPED, 0.0


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
    motion_state: MotionState,
    next_motion_state: MotionState,
    yielding: Yielding,
    timing: Periods,
    stats: SolveStats,
    x: Vector,
) -> None:
    """Replace the answer x of a fallback program by the next command towards it, within limits.

    Without acceleration and jerk limits nothing changes.

    Args:
        limits: The program that was answered, with the nominal bounds.
        motion_state: State of the motion.
        next_motion_state: State for the next step; the answer is written to `wanted`.
        yielding: Constants of the fallback programs, with the rate limits.
        timing: Periods of the step.
        stats: Statistics of the step, updated as in `solve_warm`.
        x: The answer, overwritten by the command [rad/s], (n,).
    """
    if yielding.limits.velocity.size == 0:
        return
    copied(next_motion_state.wanted, x[: motion_state.q.size])
    # A straight line keeps the ratios of coupled joints.
    if yielding.coupled:
        _approach_together(motion_state, yielding, timing, x)
    else:
        _approach_each(limits, motion_state, yielding, timing, x)
    nearest_within(limits, x, yielding, stats)


@compiled
def _approach_each(
    limits: QPViews, motion_state: MotionState, yielding: Yielding, timing: Periods, x: Vector
) -> None:
    """Replace the wanted velocity x (n,) [rad/s] by the next command, joint by joint.

    Each joint approaches its wanted velocity as quickly as its limits allow. It does not overshoot
    a wanted velocity that keeps changing as since the last step (`motion_state.wanted`). Bounds are
    those of the program `limits`.
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
    """Replace the wanted velocity x (n,) [rad/s] by the next command on a straight line to it.

    All joints reach it together; if no number of periods is enough, x stays.
    """
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
    """Blend a command towards the stored stopping motion until the arm can stop after it.

    Args:
        limits: The program that was answered, with the nominal bounds.
        arrays: Arrays of the scheme's programs, with the kinematics at the joint positions.
        motion_state: State of the motion, with the stored stopping motion.
        next_motion_state: State for the next step; `least` is overwritten if the stopping motion
            itself is taken.
        yielding: Constants of the fallback programs and stopping motions.
        timing: Periods of the step.
        log: The step's log, with the answer; its stats are updated.
        x: The command, overwritten [rad/s], (n,).

    Returns:
        Periods until the arm rests after the command; 0 if no stopping motion has to be verified.
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
    """Test whether the distance that a pair has to keep, of `least` (pairs,) [m], is reduced.

    It is if it is below the least distance of the pair's scene.
    """
    found = False
    for k in range(len(yielding.scenes)):
        own = block_constants(arrays, yielding.scenes[k])
        scene = scene_views(own, arrays.sizes.joints)
        for i in range(len(scene.pairs)):
            found = found or least[scene.head.first + i] < scene.head.least
    return found


@compiled
def _keep_verified_distances(motion_state: MotionState, next_motion_state: MotionState) -> None:
    """If a stopping motion is stored, copy its verified distances `least` to the next state."""
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
    """Compute the next command of the stored stopping motion or, if none is stored, of a new one.

    Without acceleration and jerk limits the command is zero. A new motion takes the number of
    periods of `least_periods`; its command keeps the bounds, widened so that it may go to rest, and
    the inequality rows are ignored.

    Args:
        limits: A program with the nominal bounds.
        arrays: Arrays of the scheme's programs, with the kinematics at the joint positions.
        motion_state: State of the motion.
        yielding: Constants of the fallback programs and stopping motions.
        timing: Periods of the step.
        log: The step's log; its stats are updated.
        dq: The command [rad/s], (n,), overwritten.

    Returns:
        Periods until rest after the command; 0 if no stopping motion from it is verified.
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
    # Coupled joints keep their ratios as they brake.
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
    """Compute the next command of a motion that comes to rest after a number of periods.

    The command dq [rad/s], (n,), is overwritten, within velocity and acceleration limits.
    """
    dof = motion_state.q.size
    for i in range(dof):
        last = motion_state.last[i]
        fastest = max(yielding.limits.velocity[i], abs(last))
        change = yielding.limits.acceleration[i] * timing.dt
        dq[i] = next_velocity(last, motion_state.before[i], periods, yielding.cubic)
        # After a change of the control period the curve may exceed a limit.
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
    """Test whether the arm can stop after a step's command without breaking a limit or distance.

    Args:
        arrays: Arrays of the scheme's programs, with the kinematics at the joint positions.
        motion_state: State of the motion.
        next_motion_state: State for the next step, with the command in `last`; `stopping_periods`
            is overwritten.
        yielding: Limits of the joints, and the scheme's collision avoidance.
        timing: Periods of the step.
    """
    rest = stopping_time(
        arrays, motion_state, next_motion_state.least, yielding, timing, next_motion_state.last
    )
    next_motion_state.stopping_periods = max(rest, 0.0)
    return rest >= 0.0
