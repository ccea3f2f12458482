"""Inputs of a step, taken into the state of an arm: the part of a step before the kinematics."""

from __future__ import annotations

import math

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.trigonometry import LARGEST
from iiwa_dnn.qp import Vector
from iiwa_dnn.qp.dense import all_finite, largest_entry
from iiwa_dnn.qp.layout import copied
from iiwa_dnn.schemes.joint_limits import (
    motion_constants,
)
from iiwa_dnn.schemes.periods import SLACK, Periods, periods_of
from iiwa_dnn.step.following import follow_samples
from iiwa_dnn.step.memory import (
    ArmInput,
    ArmPlan,
    ArmSettings,
    ArmState,
    arm_state,
    follow_of,
    grow_all_older,
    motion_of,
    sent_command,
    tracks,
)
from iiwa_dnn.step.requests import (
    FOLLOW,
    TWIST,
    Reason,
    Request,
)
from iiwa_dnn.step.samples import (
    FollowState,
    asks,
    forget_samples,
)
from iiwa_dnn.step.state import MotionState, change_spacing

TURN = 2.0 * math.pi
"""Turn after which a joint without position limits is at the same place [rad]."""

SHORTEST = 1e-9
LONGEST = 1e3
"""Periods below and above which a stated one is refused [s]: quotients by them overflow."""

BEHIND = 1.5
"""Way from one requested position to the next, times this, above which a joint is behind them."""

FOLLOWING = 1e-12
"""Difference of measured and commanded positions that counts as rounding [rad]."""


@compiled
def begin_step(plan: ArmPlan, memory: Vector, inputs: ArmInput) -> None:
    """Take the inputs of a step into an arm's state: the part of a step before the kinematics.

    An input that has no meaning is a `Reason`, with which the arm brakes: measured positions beyond
    `LARGEST`, an unknown kind of request, a period that is negative, not finite, above that of a
    shield whose periods are constant, or stated twice.
    """
    arm = arm_state(plan, memory)
    settings = plan.settings
    arm.reasons[:] = 0.0
    arm.reasons[Reason.PERIOD_REFUSED] = 0.0 if _fits(plan, inputs) else 1.0
    arm.reasons[Reason.PLACE_NOT_FINITE] = 1.0 if arm.is_misplaced else 0.0
    arm.reasons[Reason.FRAME_REFUSED] = 1.0 if arm.seen.is_refused else 0.0
    periods = periods_of_inputs(arm, settings, inputs)
    if inputs.elapsed > 0.0 and arm.reasons[Reason.PERIOD_REFUSED] == 0.0:
        _correct_last_period(arm, motion_of(plan, arm), inputs.elapsed)
    arm.reasons[Reason.PERIOD_EXCEEDED] = 1.0 if periods.exceeded else 0.0
    if tracks(plan):
        _measure(arm, inputs)
    else:
        _update_positions(plan, arm, inputs.q, _is_unstated(plan, arm, inputs))
        _take_samples(plan, arm, inputs)
    if arm.reason != Reason.NONE:
        arm.reasons[arm.reason] = 1.0
    arm.period = periods.expected
    arm.answered = _answered(arm)
    if plan.sizes.following > 0:
        _follow(plan, arm, periods)


@compiled
def _measure(arm: ArmState, inputs: ArmInput) -> None:
    """Set the positions and the time of a controller's arm to the measured ones."""
    if not math.isfinite(inputs.t) or not largest_entry(inputs.q) <= LARGEST:
        arm.reasons[Reason.Q_NOT_FINITE] = 1.0
        return
    arm.has_begun = True
    arm.time = inputs.t
    copied(arm.positions, inputs.q)


@compiled
def _take_samples(plan: ArmPlan, arm: ArmState, inputs: ArmInput) -> None:
    """Take the request of a step, or without one that of samples: a velocity, written later.

    It is NaN for samples that are not finite, so that the arm brakes.
    """
    asked = inputs
    request = np.zeros(plan.sizes.n)
    if plan.sizes.following > 0:
        own = follow_of(plan, arm)
        arm.reasons[Reason.STALE] = 1.0 if own.is_stale else 0.0
        own.is_stale = False
        if inputs.kind != Request.NONE:
            forget_samples(own)
        elif asks(own):
            request[:] = np.nan if own.is_broken else 0.0
            asked = ArmInput(
                inputs.q, Request.VELOCITY, request, inputs.dt, inputs.elapsed, inputs.t
            )
    _update_request(arm, plan.settings, asked)


@compiled
def _follow(plan: ArmPlan, arm: ArmState, periods: Periods) -> None:
    """Make the velocities by which an arm follows samples its request, of one that asks for some.

    If it brakes because of its request, the samples are forgotten.
    """
    own = follow_of(plan, arm)
    if arm.reason != Reason.NONE:
        own.count = 0
        own.waiting = 0
    if own.count + own.waiting == 0 or arm.answered != Request.VELOCITY or is_refused(arm):
        return
    _turn_samples(arm, own)
    motion = motion_of(plan, arm)
    change_spacing(motion, periods.dt)
    limits = motion_constants(plan.step.arrays)
    follow_samples(own, arm.positions, motion, limits, periods, arm.time, arm.request)
    arm.answered = FOLLOW


@compiled
def _turn_samples(arm: ArmState, own: FollowState) -> None:
    """Put waiting samples on the nearest turns, of joints whose readings have skipped turns."""
    n = arm.wraps.size
    for i in range(n):
        near: float = arm.positions[i]
        for j in range(own.waiting if arm.wraps[i] != 0.0 else 0):
            near = own.next_positions[j * n + i] + TURN * turns_between(
                own.next_positions[j * n + i], near
            )
            own.next_positions[j * n + i] = near


@compiled
def _answered(arm: ArmState) -> int:
    """Return the kind of request whose program a step answers: that of a velocity if it brakes."""
    if not arm.has_begun:
        return Request.NONE
    if arm.reason != Reason.NONE or is_refused(arm):
        return Request.VELOCITY
    kind: int = arm.kind
    return kind


@compiled
def _fits(plan: ArmPlan, inputs: ArmInput) -> bool:
    """Test whether the stated periods of a step have a meaning, and are not above the limits."""
    settings = plan.settings
    dt = inputs.dt
    elapsed = inputs.elapsed
    stated = max(dt, elapsed)
    if not (dt >= 0.0 and elapsed >= 0.0 and stated <= LONGEST and min(dt, elapsed) == 0.0):
        return False
    if stated > 0.0 and stated < SHORTEST:
        return False
    longest: float = settings.longest
    most = LONGEST if tracks(plan) else settings.dt * (1.0 + SLACK)
    return longest > 0.0 or (elapsed == 0.0 and dt <= most)


@compiled
def periods_of_inputs(arm: ArmState, settings: ArmSettings, inputs: ArmInput) -> Periods:
    """Return the periods of a step; those that are refused count as not stated."""
    if arm.reasons[Reason.PERIOD_REFUSED] != 0.0:
        return periods_of(settings.dt, settings.longest, 0.0, 0.0)
    return periods_of(settings.dt, settings.longest, inputs.dt, inputs.elapsed)


@compiled
def is_refused(arm: ArmState) -> bool:
    """Test whether an arm brakes at this step, whatever its request is."""
    count: float = arm.reasons[Reason.Q_NOT_FINITE] + arm.reasons[Reason.PERIOD_REFUSED]
    count += arm.reasons[Reason.PLACE_NOT_FINITE]
    return count > 0.0


@compiled
def _correct_last_period(arm: ArmState, motion: MotionState, elapsed: float) -> None:
    """Correct positions, time and path lag for a last command that was held for `elapsed` [s]."""
    motion.path_lag += (1.0 - arm.fraction) * (elapsed - arm.period)
    for i in range(motion.last.size):
        arm.positions[i] += (elapsed - arm.period) * motion.last[i]
    arm.time = arm.time + elapsed - arm.period
    grow_all_older(arm, max(elapsed - arm.period, 0.0))
    arm.period = elapsed
    if arm.sent.size > 0:
        last = sent_command(arm, 0)
        last.period = elapsed


@compiled
def _is_unstated(plan: ArmPlan, arm: ArmState, inputs: ArmInput) -> bool:
    """Test whether it is unknown how long a command that moved the arm was held."""
    if plan.settings.longest == 0.0 or largest_entry(motion_of(plan, arm).last) == 0.0:
        return False
    return arm.reasons[Reason.PERIOD_REFUSED] != 0.0 or inputs.dt + inputs.elapsed == 0.0


@compiled
def _update_positions(plan: ArmPlan, arm: ArmState, measured: Vector, unstated: bool) -> None:
    """Set the commanded positions to the measured ones, where these count.

    They count at the first step; where they differ by more than the tracking error; and where
    periods vary and none is stated, since the time for which the last command was held, if it was
    not 0, is then unknown. The displacement that the delay still hides is added to them.

    Args:
        plan: Layout of the step.
        arm: The arm.
        measured: Measured joint positions [rad], (n,), or longer.
        unstated: The result of `_is_unstated`.
    """
    settings = plan.settings
    q = arm.measured
    copied(q, measured[: q.size])
    add_pending(arm, settings.delay, q)
    if arm.has_begun:
        _add_turns(plan, arm, q)
    far = 0
    beyond = 0
    for i in range(q.size):
        far += not abs(q[i] - arm.positions[i]) <= settings.tracking_error
        beyond += not abs(q[i]) <= LARGEST
    if beyond > 0:
        arm.reasons[Reason.Q_NOT_FINITE] = 1.0
    elif far > 0 or unstated or not arm.has_begun:
        arm.reasons[Reason.RESYNCHRONISED] = 1.0 if arm.has_begun and not unstated else 0.0
        arm.has_begun = True
        copied(arm.positions, q)


@compiled
def _add_turns(plan: ArmPlan, arm: ArmState, q: Vector) -> None:
    """Add whole turns to measured positions q (n,) [rad] of joints without position limits.

    Their encoders may begin anew after a turn: that nearest to the commanded position is meant.
    """
    for i in range(q.size):
        if abs(q[i]) <= LARGEST and _is_endless(plan, i):
            turns = turns_between(q[i], arm.positions[i])
            if turns != 0.0:
                q[i] += TURN * turns
                arm.wraps[i] = 1.0


@compiled
def _is_endless(plan: ArmPlan, i: int) -> bool:
    """Test whether joint i turns, and has no position limits."""
    slides: float = plan.robot.slides[i]
    limits = motion_constants(plan.step.arrays)
    return limits.lower[i] == -np.inf and limits.upper[i] == np.inf and slides == 0.0


@compiled
def turns_between(position: float, other: float) -> float:
    """Return the number of whole turns from a position to the same place nearest to another."""
    return math.floor((other - position) / TURN + 0.5)


@compiled
def add_pending(arm: ArmState, delay: float, q: Vector) -> None:
    """Add the displacement by the commands of the last `delay` [s] to positions q (n,) [rad]."""
    age = 0.0
    for k in range(arm.sent.size // (1 + q.size)):
        command = sent_command(arm, k)
        pending = min(max(delay - age, 0.0), command.period)
        for i in range(q.size):
            q[i] += pending * command.dq[i]
        age += command.period


@compiled
def _update_request(arm: ArmState, settings: ArmSettings, inputs: ArmInput) -> None:
    """Set the request that counts: the new one, else the last one, or zero for a `Reason`."""
    kind = inputs.kind
    streams = kind == Request.POSITION and arm.kind == Request.POSITION
    count = 0
    if kind != Request.NONE:
        count = TWIST if kind == Request.TWIST else arm.positions.size
        arm.kind = kind
    arm.age += arm.period
    if count > 0 and arm.reason != Reason.HALTED:
        arm.age = 0.0
        arm.reason = _fault_of(kind, inputs.request, count)
    if arm.reason == Reason.NONE and arm.age > settings.timeout + 0.5 * arm.period:
        arm.reason = Reason.TIMED_OUT
    before = arm.request.copy()
    for i in range(arm.request.size):
        if arm.reason != Reason.NONE:
            arm.request[i] = 0.0
        elif i < count:
            arm.request[i] = inputs.request[i]
    refused = is_refused(arm)
    arm.is_repeated = not refused and differing(arm.request, before) == 0
    _note_behind(arm, before, streams)


@compiled
def _note_behind(arm: ArmState, before: Vector, streams: bool) -> None:
    """Note for each joint whether it is behind a new position, by the way from that `before`."""
    changes = differing(arm.request, before)
    for i in range(arm.behind.size if changes > 0 else 0):
        way = abs(arm.request[i] - before[i])
        arm.behind[i] = (
            1.0 if streams and 0.0 < BEHIND * way < abs(displacement_left(arm, i)) else 0.0
        )


@compiled
def _fault_of(kind: int, request: Vector, count: int) -> int:
    """Return the `Reason` for which a new request of `count` numbers does not count, or `NONE`."""
    if kind < Request.NONE or kind > Request.POSITION:
        return Reason.UNKNOWN_KIND
    return Reason.NONE if all_finite(request, 0, count) else Reason.NOT_FINITE


@compiled
def differing(values: Vector, others: Vector) -> int:
    """Count the entries of an array (n,) that differ from those of another, (n,) or longer."""
    count = 0
    for i in range(values.size):
        count += values[i] != others[i]
    return count


@compiled
def displacement_left(arm: ArmState, i: int) -> float:
    """Compute the displacement of joint i to its requested position [rad].

    The joint is there where its commanded or its measured position is, or between them: a request
    for the measured positions holds the arm. Of a joint whose readings have skipped turns, the
    nearest of all positions that are one place is requested.
    """
    wanted: float = arm.request[i]
    commanded: float = arm.positions[i]
    measured: float = arm.measured[i]
    if arm.wraps[i] != 0.0:
        wanted += TURN * turns_between(wanted, commanded)
    if not abs(measured - commanded) > FOLLOWING:
        return wanted - commanded
    nearest = max(wanted, min(commanded, measured))
    return wanted - min(nearest, max(commanded, measured))
