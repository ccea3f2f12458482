"""Step of an arm as a kernel over its memory: of shields and controllers, at the desk and in C.

`begin_step` takes positions, request and periods into the state of the arm; `finish_arm` computes
the command from the kinematics at the arm's positions. `step_arm` calls the kernel
`write_kinematics` between them; at the desk Pinocchio computes the kinematics
(`iiwa_dnn.control.desk`). The state holds what can be asked about the last step
(`iiwa_dnn.step.asking`).

A shield answers requests, from the positions that it commands. A controller answers targets of
frames, which are given or sampled from its paths, from the positions that are measured.
"""

from __future__ import annotations

import math

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.naming import LimitKind
from iiwa_dnn.networks.integrators.base import AnswerSettings, CompiledAnswer
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.dense import all_finite, largest_entry
from iiwa_dnn.qp.layout import copied
from iiwa_dnn.robot.kinematics import Twist
from iiwa_dnn.robot.kinematics_kernel import write_kinematics
from iiwa_dnn.schemes.joint_limits import (
    MotionConstants,
    joint_range,
    joint_rates,
    motion_constants,
)
from iiwa_dnn.schemes.periods import Periods
from iiwa_dnn.schemes.profiles import Rates, braking
from iiwa_dnn.schemes.program import ProgramArrays, block_constants, program_views
from iiwa_dnn.schemes.separation import (
    separation_factor,
)
from iiwa_dnn.schemes.viability import joint_bounds, reaching
from iiwa_dnn.step.bodies import (
    write_bodies,
)
from iiwa_dnn.step.cycle import INVALID, sample_targets, take_step
from iiwa_dnn.step.inputs import (
    FOLLOWING,
    begin_step,
    differing,
    displacement_left,
    is_refused,
    periods_of_inputs,
)
from iiwa_dnn.step.log import StepLog, log_of
from iiwa_dnn.step.memory import (
    ArmInput,
    ArmPlan,
    ArmSettings,
    ArmState,
    arm_state,
    grow_all_older,
    motion_of,
    place_obstacles,
    sent_command,
    tracks,
)
from iiwa_dnn.step.plan import ControlPlan
from iiwa_dnn.step.policies import ProgramKind
from iiwa_dnn.step.requests import (
    CUT,
    FASTEST,
    FOLLOW,
    TWIST,
    Reason,
    Request,
    RequestConstants,
    falls_short,
    twist_rates,
)
from iiwa_dnn.step.state import MotionState, change_spacing, count_as_sent
from iiwa_dnn.step.stopping import brake_blindly
from iiwa_dnn.step.yielding import NOMINAL, NONE, SLOW

RISE = 4.0
"""Largest rate at which the part of a request that a separation admits grows again [1/s]."""


@compiled
def send_arm(plan: ArmPlan, memory: Vector, dq: Vector, period: float, fraction: float) -> None:
    """Count a velocity as sent, in place of a step's command.

    Args:
        plan: Layout of the steps.
        memory: The arm's memory, (k,), overwritten.
        dq: The velocity [rad/s], (n,).
        period: Time for which it is held [s].
        fraction: Fraction of it by which the paths' clock goes on.
    """
    arm = arm_state(plan, memory)
    motion = motion_of(plan, arm)
    count_as_sent(motion, dq, period)
    motion.path_lag += period * (1.0 - fraction)
    arm.fraction = fraction
    arm.age += arm.period
    arm.period = period
    _advance(arm, plan.settings, motion)


@compiled
def brake_arm(plan: ArmPlan, memory: Vector) -> None:
    """Take the next command of an arm's motion to rest, in place of a step that is refused."""
    arm = arm_state(plan, memory)
    motion = motion_of(plan, arm)
    arm.age += arm.period
    arm.period = plan.settings.dt
    _brake_blindly(plan, arm, motion)
    _advance(arm, plan.settings, motion)


@compiled
def step_arm(plan: ArmPlan, memory: Vector, inputs: ArmInput) -> int:
    """Take a step of an arm; its command is then the last one of `motion_of` the arm.

    Returns:
        Of a shield the first `Reason` of the step. Of a controller the `Action` that was taken; or
        `INVALID` if an input is not valid: the arm has then taken the next command of its motion to
        rest.
    """
    begin_step(plan, memory, inputs)
    arm = arm_state(plan, memory)
    base = plan.step.arrays
    arrays = ProgramArrays(
        base.sizes,
        base.table,
        base.constants.copy(),
        np.empty((arm.positions.size, 6)),
        np.empty((base.placements.shape[0], 12)),
        base.support,
        np.empty((base.inertia.shape[0], base.inertia.shape[1])),
        base.tip,
    )
    write_kinematics(plan.robot, arm.positions, arrays.jacobian, arrays.placements, arrays.inertia)
    data = np.empty(plan.width)
    action = finish_arm(plan, arm, inputs, arrays, data, arm.network)
    return action if tracks(plan) else first_reason(arm)


@compiled
def _note_sent(arm: ArmState, period: float, dq: Vector) -> None:
    """Note a command dq (n,) [rad/s] as the last one that was sent.

    If the two before it last no longer than a control period [s] together, they become one with
    their mean velocity: so a bounded number of commands covers the delay.
    """
    last = sent_command(arm, 0)
    before = sent_command(arm, 1)
    both = last.period + before.period
    if min(last.period, before.period) > 0.0 and both <= period:
        for i in range(dq.size):
            displacement = last.period * last.dq[i] + before.period * before.dq[i]
            before.dq[i] = displacement / both
        before.period = both
    else:
        width = 1 + dq.size
        for k in range(arm.sent.size - width):
            place = arm.sent.size - 1 - k
            arm.sent[place] = arm.sent[place - width]
    last.period = arm.period
    copied(last.dq, dq)


@compiled
def finish_arm(
    plan: ArmPlan,
    arm: ArmState,
    inputs: ArmInput,
    arrays: ProgramArrays,
    data: Vector,
    network: Vector,
) -> int:
    """Compute the command of a step, and advance the arm by it: the part after the kinematics.

    Args:
        plan: Layout of the step, with the kinematics at the arm's positions.
        arm: The arm's state after `begin_step`; the command, and positions and time after it, are
            written to it.
        inputs: The inputs of the step.
        arrays: Arrays of the program, with constants that are overwritten.
        data: The log of the control step, overwritten, (width,).
        network: State of the network, (size,).

    Returns:
        The `Action` that was taken; `NONE`, without a log, if the positions are not known;
        `INVALID`, without a log, if an input is not valid: the arm brakes.
    """
    action = NONE
    motion = motion_of(plan, arm)
    if arm.answered != Request.NONE or tracks(plan):
        action = _answer(plan, arm, motion, inputs, arrays, data, network)
    _advance(arm, plan.settings, motion)
    return action


@compiled
def _advance(arm: ArmState, settings: ArmSettings, motion: MotionState) -> None:
    """Advance the commanded positions and the time by the last command's period."""
    if arm.sent.size > 0:
        _note_sent(arm, settings.dt, motion.last)
    for i in range(arm.positions.size):
        arm.positions[i] += arm.period * motion.last[i]
    arm.time += arm.period
    grow_all_older(arm, arm.period)


@compiled
def first_reason(arm: ArmState) -> int:
    """Return the first `Reason` of an arm's last step, by their codes; `NONE`: there is none."""
    for k in range(arm.reasons.size):
        if arm.reasons[k] != 0.0:
            return k
    return Reason.NONE


@compiled
def _answer(
    plan: ArmPlan,
    arm: ArmState,
    motion: MotionState,
    inputs: ArmInput,
    arrays: ProgramArrays,
    data: Vector,
    network: Vector,
) -> int:
    """Answer an arm's request or targets by a control step; keep its results; return the action."""
    timing = periods_of_inputs(arm, plan.settings, inputs)
    if plan.scene >= 0:
        place_obstacles(plan, arm, arm.time, block_constants(arrays, plan.scene))
    if plan.separation >= 0:
        write_bodies(block_constants(arrays, plan.separation), arm.bodies, arm.seen.age)
    change_spacing(motion, timing.dt)
    log = log_of(data, arrays.sizes)
    is_twist = arm.answered == Request.TWIST
    state = network if is_twist or tracks(plan) else np.zeros(network.size)
    is_valid = True
    if tracks(plan):
        is_valid = _aim(plan, arm, motion, inputs, timing.expected, log.targets)
    else:
        log.targets.reshape(log.targets.size)[:] = 0.0
        _take_request(plan, arm, arrays, timing, state)
    own = plan.step.network
    settings = AnswerSettings.of(own.settings.numbers.copy())
    settings.duration = plan.lag * timing.expected
    step = ControlPlan(
        arrays,
        CompiledAnswer(own.address, own.rates, settings),
        plan.step.paths,
        plan.step.yielding,
        arm.twist_fallback if is_twist else arm.fallback,
        plan.step.policy,
        timing,
    )
    next_motion_state = np.empty(arm.motion.size)
    action = take_step(data, step, arm.positions, arm.motion, next_motion_state, state, arm.time)
    if not is_valid or action == INVALID:
        arm.reasons[Reason.Q_NOT_FINITE] = 1.0
    if action == INVALID:
        _brake_blindly(plan, arm, motion)
        return action
    copied(arm.motion, next_motion_state)
    if tracks(plan):
        _note_targets(plan, arm, motion, arrays, timing, log, action)
    else:
        motion.yields = False  # the next step tries the request again
        _note_lag(arm, motion_constants(arrays), log)
        _keep_answer(arm, log)
        _note_request(plan, arm, arrays, log)
    return action if is_valid else INVALID


@compiled
def _keep_answer(arm: ArmState, log: StepLog) -> None:
    """Keep what a step has answered."""
    arm.fraction = log.fraction
    arm.program = log.kind
    copied(arm.limiting, log.limiting)


@compiled
def _aim(
    plan: ArmPlan, arm: ArmState, motion: MotionState, inputs: ArmInput, dt: float, targets: Matrix
) -> bool:
    """Write the targets of a controller's step; without valid inputs the arm brakes.

    Args:
        plan: Layout of the step.
        arm: The arm.
        motion: State of its motion; whether it halts is written.
        inputs: Inputs of the step.
        dt: Period over which a velocity is the mean one, with feed-forward [s].
        targets: The targets, (frames, 18), overwritten.

    Returns:
        Whether all inputs have a meaning, and there are targets.
    """
    paths = plan.step.paths
    flat = targets.reshape(targets.size)
    refused = arm.reasons[Reason.PERIOD_REFUSED] + arm.reasons[Reason.Q_NOT_FINITE]
    is_valid = refused == 0.0 and inputs.request.size + len(paths.table) > 0
    if is_valid and inputs.request.size > 0:
        copied(flat, inputs.request)
    elif is_valid:
        sample_targets(paths, inputs.t - motion.path_lag, dt, targets)
    if not is_valid or not all_finite(flat, 0, flat.size):
        is_valid = False
        flat[:] = 0.0
    motion.halts = arm.reason == Reason.HALTED or arm.is_misplaced or not is_valid
    return is_valid


@compiled
def _take_request(
    plan: ArmPlan, arm: ArmState, arrays: ProgramArrays, timing: Periods, state: Vector
) -> None:
    """Write the request of a shield's step, as its limits admit it.

    Args:
        plan: Layout of the step.
        arm: The arm.
        arrays: Arrays of the step; the request is written to the constants.
        timing: Periods of the step.
        state: State of the network, (size,); where it begins for a request of joints is written.
    """
    request = RequestConstants.of(block_constants(arrays, plan.request))
    request.is_twist = arm.answered == Request.TWIST
    if request.is_twist:
        excess = max(largest_entry(arm.request[: Twist.width()]) / plan.fastest, 1.0)
        arm.reasons[Reason.CUT] = 1.0 if excess > 1.0 else 0.0
        for i in range(TWIST):
            request.velocity[i] = arm.request[i] / excess
    admitted = np.empty(arm.positions.size)
    admitted[:] = np.inf
    if arm.reduction > 0.0:
        _scale_request(plan, arm, arrays, timing, request, admitted)
    if plan.separation >= 0:
        _slow_down(plan, arm, arrays, timing, request, admitted)
    if not request.is_twist:
        limits = motion_constants(arrays)
        approach_request(arm, motion_of(plan, arm), limits, timing, admitted, state)
        copied(request.velocity, state[: arm.positions.size])


@compiled
def _scale_request(
    plan: ArmPlan,
    arm: ArmState,
    arrays: ProgramArrays,
    timing: Periods,
    request: RequestConstants,
    admitted: Vector,
) -> None:
    """Slow a request down to the part of the velocity limits that `scale_speed` lets it use.

    Args:
        plan: Layout of the step.
        arm: The arm.
        arrays: Arrays of the step.
        timing: Periods of the step.
        request: The request; a twist is scaled, by the rates that answer it without limits.
        admitted: Largest speeds of the joints for another request [rad/s], (n,), overwritten.
    """
    limits = motion_constants(arrays)
    dq = np.zeros(admitted.size)
    if request.is_twist:
        twist_rates(arrays, request, dq)
    factor = 1.0
    for i in range(dq.size):
        admitted[i] = (1.0 - arm.reduction) * min(limits.velocity[i], FASTEST)
        wanted = dq[i] if request.is_twist else arm.request[i]
        if arm.answered == Request.POSITION:
            wanted = _quickest(limits, arm, i, timing.hold)
        if abs(wanted) > admitted[i]:
            factor = min(factor, admitted[i] / abs(wanted))
    for i in range(TWIST if request.is_twist else 0):
        request.velocity[i] *= factor
    if factor < 1.0 and not is_refused(arm):
        arm.reasons[Reason.SPEED_SCALE] = 1.0


@compiled
def _slow_down(
    plan: ArmPlan,
    arm: ArmState,
    arrays: ProgramArrays,
    timing: Periods,
    request: RequestConstants,
    admitted: Vector,
) -> None:
    """Slow a request down as the separation from bodies of bounded speed demands.

    Args:
        plan: Layout of the step.
        arm: The arm; what is withheld of its request is noted.
        arrays: Arrays of the step, with the bodies in the constants.
        timing: Periods of the step.
        request: The request; a twist is scaled.
        admitted: Largest speeds of the joints for another request [rad/s], (n,), overwritten.
    """
    constants = block_constants(arrays, plan.separation)
    limits = motion_constants(arrays)
    n = arm.positions.size
    dq = np.zeros(n)
    if request.is_twist:
        twist_rates(arrays, request, dq)
    excess = 1.0
    for i in range(n):
        fastest = min(limits.velocity[i], FASTEST)
        excess = max(excess, abs(dq[i]) / fastest)
        if not request.is_twist and not is_refused(arm):
            wanted = arm.request[i]
            if arm.answered == Request.POSITION:
                wanted = _quickest(limits, arm, i, timing.hold)
            dq[i] = min(max(wanted, -fastest), fastest)
    for i in range(n):
        dq[i] /= excess
    factor = separation_factor(constants, arrays, limits, dq, timing.longest)
    factor = min(factor, 1.0 - arm.seen.withheld + RISE * timing.expected)
    arm.seen.withheld = 1.0 - factor
    if factor == 1.0:
        return
    arm.reasons[Reason.SEPARATION] = 1.0 if largest_entry(dq) > 0.0 else 0.0
    for i in range(n):
        admitted[i] = min(admitted[i], factor * abs(dq[i]))
    for i in range(TWIST if request.is_twist else 0):
        request.velocity[i] *= factor / excess


@compiled
def _quickest(limits: MotionConstants, arm: ArmState, i: int, hold: float) -> float:
    """Return a velocity of joint i on its way to a requested position [rad/s].

    No acceleration limit lets it be quicker, nor has it to be, to be there after `hold` [s].
    """
    left = displacement_left(arm, i)
    quickest = math.sqrt(2.0 * limits.acceleration[i] * abs(left))
    return math.copysign(min(quickest, abs(left) / hold), left)


@compiled
def _brake_blindly(plan: ArmPlan, arm: ArmState, motion: MotionState) -> None:
    """Command the next velocity of a motion to rest, for a step that no program can answer."""
    copied(motion.q, arm.positions)
    brake_blindly(motion, motion_constants(plan.step.arrays), arm.period)
    motion.path_lag += arm.period
    arm.fraction = 0.0
    arm.program = ProgramKind.STOPPED
    arm.is_clipped = True


@compiled
def approach_request(
    arm: ArmState,
    motion: MotionState,
    limits: MotionConstants,
    periods: Periods,
    admitted: Vector,
    dq: Vector,
) -> None:
    """Write the next velocities dq (n,) [rad/s] of the joints on their way to the request.

    For requested positions each joint takes the largest velocity from which it can still come to
    rest there (`displacement_left`). A joint that cannot reach its requested velocity in this step
    because of a jerk limit, or whose request is that of the step before, approaches it without
    overshoot. The velocities of an arm that follows samples are taken as they are: they are within
    its limits.

    Args:
        arm: The arm, with its request.
        motion: The last commands.
        limits: Limits of the joints.
        periods: Periods of the step.
        admitted: Largest speeds that are admitted [rad/s], (n,).
        dq: The velocities, or longer, overwritten.
    """
    reaches = arm.answered == Request.POSITION
    follows = arm.answered == FOLLOW
    brakes = is_refused(arm)
    for i in range(arm.positions.size):
        last = motion.last[i]
        before = motion.before[i]
        wanted = 0.0 if brakes else arm.request[i]
        left = displacement_left(arm, i)
        first, end = joint_range(limits, i)
        above = end - arm.positions[i]
        below = arm.positions[i] - first
        rates = joint_rates(limits, i)
        most = CUT * min(rates.velocity, FASTEST)
        if reaches or follows:
            dq[i] = wanted
            if reaches:
                accel = rates.acceleration
                rates = Rates(rates.velocity, accel, rates.jerk, accel, np.inf, 0.0)
                dq[i] = reaching(last, before, left, most, rates, periods)
            if admitted[i] < most:
                slowest = _towards(-admitted[i], last, rates.jerk, periods)
                dq[i] = max(dq[i], slowest)
                dq[i] = min(dq[i], _towards(admitted[i], last, rates.jerk, periods))
            continue
        if abs(wanted) > most:
            wanted = math.copysign(most, wanted)
            arm.reasons[Reason.CUT] = 1.0
        wanted = min(max(wanted, -admitted[i]), admitted[i])
        lower, upper, _, _ = joint_bounds(last, before, above, below, rates, periods)
        if arm.is_repeated or wanted < lower or wanted > upper:
            wanted = _towards(wanted, last, rates.jerk, periods)
        dq[i] = wanted


@compiled
def _towards(wanted: float, last: float, jerk: float, periods: Periods) -> float:
    """Return the next velocity [rad/s] of a joint that comes from the last to the wanted one."""
    return wanted + braking(last - wanted, -np.inf, np.inf, jerk, periods)


@compiled
def _note_targets(
    plan: ArmPlan,
    arm: ArmState,
    motion: MotionState,
    arrays: ProgramArrays,
    timing: Periods,
    log: StepLog,
    action: int,
) -> None:
    """Note whether a controller's command does less than its tasks ask, and if no limit is why."""
    if plan.separation >= 0 and action != NONE:
        _note_separation(plan, arm, motion, arrays, timing, log)
    _keep_answer(arm, log)
    arm.is_clipped = arm.program != NOMINAL
    if arm.program == ProgramKind.RELAXED and largest_entry(arm.limiting) == 0.0:
        arm.reasons[Reason.SINGULAR] = 1.0


@compiled
def _note_separation(
    plan: ArmPlan,
    arm: ArmState,
    motion: MotionState,
    arrays: ProgramArrays,
    timing: Periods,
    log: StepLog,
) -> None:
    """Note whether bodies are too near for the velocity that a controller's arm wants.

    While it rests for them, the clock of its paths stands: a person may stay for long.
    """
    wanted = motion.wanted if log.kind == ProgramKind.STOPPED else log.point[: log.dq.size]
    constants = block_constants(arrays, plan.separation)
    limits = motion_constants(arrays)
    if separation_factor(constants, arrays, limits, wanted, timing.longest) == 1.0:
        return
    arm.reasons[Reason.SEPARATION] = 1.0
    if plan.step.policy == SLOW and largest_entry(log.dq) == 0.0:
        motion.path_lag += timing.expected * log.fraction
        log.fraction = 0.0


@compiled
def _note_lag(arm: ArmState, limits: MotionConstants, log: StepLog) -> None:
    """Note by which limits joints stay behind a stream of positions, each of which is a rest."""
    for i in range(arm.behind.size if arm.answered == Request.POSITION else 0):
        left = displacement_left(arm, i) - arm.period * log.dq[i]
        kind = 0.0  # nothing of its own
        if abs(log.dq[i]) >= limits.velocity[i] * (1.0 - FOLLOWING):
            kind = float(LimitKind.VELOCITY)
        elif limits.acceleration[i] < np.inf:
            kind = float(LimitKind.ACCELERATION)
        elif limits.jerk[i] < np.inf:
            kind = float(LimitKind.JERK)
        if arm.behind[i] > 0.0 and log.limiting[i] == 0.0 and abs(left) > FOLLOWING:
            log.limiting[i] = math.copysign(kind, left)


@compiled
def _note_request(plan: ArmPlan, arm: ArmState, arrays: ProgramArrays, log: StepLog) -> None:
    """Note whether the command of a step differs from the request.

    A command for a twist or for positions differs if a limit is active or there is a `Reason`.
    """
    request = RequestConstants.of(block_constants(arrays, plan.request))
    qp = program_views(log.program, arrays.sizes)
    if request.is_twist and falls_short(qp, request.velocity):
        arm.reasons[Reason.SINGULAR] = 1.0
    reason = first_reason(arm)
    arm.is_clipped = largest_entry(log.limiting) > 0.0 or reason != Reason.NONE
    if arm.answered == Request.VELOCITY and reason == Reason.NONE:
        arm.is_clipped = differing(log.dq, arm.request) > 0
