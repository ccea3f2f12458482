"""Step of a shield as kernels over the memory of an arm: at the desk, for many arms, and in C.

A step takes what it is given over, needs the kinematics at the commanded positions, and answers the
request. `Shield` asks Pinocchio for the kinematics, `step_arm` the kernel `write_kinematics`. An
arm keeps what can be asked about its last step: which limits are active, its margin, the time to
rest.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from iiwa_dnn.compiling.library import compiled, released
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.compiling.trigonometry import LARGEST
from iiwa_dnn.control.command import StepLog, log_of
from iiwa_dnn.control.cycle import INVALID, ControlPlan, take_step
from iiwa_dnn.control.requests import (
    CUT,
    FASTEST,
    TWIST,
    Reason,
    Request,
    RequestConstants,
    falls_short,
)
from iiwa_dnn.control.state import MotionState, change_spacing, count_as_sent
from iiwa_dnn.control.stopping import least_periods
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.dense import all_finite, largest_entry
from iiwa_dnn.qp.layout import IntVector, copied
from iiwa_dnn.robot.kinematics import Twist
from iiwa_dnn.robot.kinematics_kernel import ModelTables, write_kinematics
from iiwa_dnn.schemes.periods import Periods, periods_of
from iiwa_dnn.schemes.profiles import Rates, arriving, braking
from iiwa_dnn.schemes.program import ProgramArrays, block_constants, program_views
from iiwa_dnn.schemes.rate_limits import MotionConstants, joint_rates
from iiwa_dnn.schemes.scene import Body, scene_views, write_distances
from iiwa_dnn.schemes.viability import joint_bounds


class ArmSettings(Record):
    """Settings of a shield.

    Attributes:
        dt: Control period [s].
        longest: Longest control period where periods vary [s]; 0: they do not.
        timeout: Time for which a request counts [s].
        tracking_error: Difference from which on the arm is resynchronised to measured positions
            [rad].
        delay: Time by which the arm is behind its commands [s].
    """

    dt: float
    longest: float
    timeout: float
    tracking_error: float
    delay: float


class SentCommand(Record):
    """Command that was sent to n joints, and may not show in the measured positions yet.

    Attributes:
        period: Time for which it is held [s]; 0: there is none.
        dq: Joint velocity [rad/s], (n,).
    """

    period: float
    dq: Vector = part()


class ArmSizes(NamedTuple):
    """Sizes of `ArmState`, by its names."""

    n: int
    request: int
    motion: int
    network: int
    fallback: int
    obstacles: int
    limiting: int
    sent: int


class ArmState(Record):
    """All that an arm keeps from one step to the next, and of the last one what can be asked.

    Attributes:
        time: Time of the arm's clock [s].
        period: Period that counts for the last command [s].
        age: Time since the request came [s].
        reason: `Reason` why the request is replaced by one to rest.
        kind: `Request` of the last request.
        answered: `Request` that the last step answered; `NONE`: the positions are
            not known, and no step was taken.
        action: `Action` of the last step.
        has_begun: Whether there was a first step.
        is_repeated: Whether the request is that of the step before.
        is_resynchronised: Whether it was resynchronised to measured positions.
        is_blind: Whether the measured positions were not finite.
        is_cut: Whether the request was cut.
        is_late: Whether the period was above the longest.
        is_singular: Whether the damping alone kept a twist from being fulfilled.
        is_clipped: Whether the command was another one than the request.
        positions: Commanded joint positions [rad], (n,).
        request: The request that counts, (max(n, 6),): zero without one.
        motion: `MotionState`.
        network: State of the network that answers twists.
        fallback: States of the networks of fallback programs, for requests of joints.
        twist_fallback: The same for twists.
        obstacles: Places of the obstacles at time 0 [m], (k, 3).
        limiting: Bounds and rows that limit the command, as in `StepLog`, (n + m,).
        sent: `SentCommand` of the commands that cover the delay, the last first, (k (1 + n),).
    """

    time: float
    period: float
    age: float
    reason: int
    kind: int
    answered: int
    action: int
    has_begun: bool
    is_repeated: bool
    is_resynchronised: bool
    is_blind: bool
    is_cut: bool
    is_late: bool
    is_singular: bool
    is_clipped: bool
    positions: Vector = part("n")
    request: Vector = part("request")
    motion: Vector = part("motion")
    network: Vector = part("network")
    fallback: Vector = part("fallback")
    twist_fallback: Vector = part("fallback")
    obstacles: Matrix = part("obstacles", 3)
    limiting: Vector = part("limiting")
    sent: Vector = part("sent")


class ArmPlan(NamedTuple):
    """Layout and settings that all arms of a kind share.

    Attributes:
        robot: Tables of the robot, n joints.
        step: Layout of the control step.
        request: Number of the block of the request.
        scene: Number of the block of the watched pairs; -1: there is none.
        width: Length of the log of a step.
        motion: Limits of the joints.
        fastest: Largest number of a twist [m/s], [rad/s]; a larger one is cut to it.
        lower: Lower position limits [rad], (n,).
        upper: Upper position limits [rad], (n,).
        velocities: Velocities of the obstacles [m/s], (k, 3).
        settings: Settings of the shield.
        sizes: Sizes of `ArmState`.
    """

    robot: ModelTables
    step: ControlPlan
    request: int
    scene: int
    width: int
    motion: MotionConstants
    fastest: float
    lower: Vector
    upper: Vector
    velocities: Matrix
    settings: ArmSettings
    sizes: ArmSizes


class ArmInput(NamedTuple):
    """Hold what an arm is given for a step.

    Attributes:
        q: Measured joint positions [rad], (n,).
        kind: Kind of the new request; `NONE`: there is none.
        request: The request, at least (n,) or (6,).
        dt: Period for which the command will be held [s]; 0: not stated.
        elapsed: Time since the last step [s]; 0: not stated.
    """

    q: Vector
    kind: int
    request: Vector
    dt: float
    elapsed: float


@compiled
def arm_state(plan: ArmPlan, memory: Vector) -> ArmState:
    """View the memory (k,) of an arm by its names."""
    return ArmState.of(
        memory,
        plan.sizes.n,
        plan.sizes.request,
        plan.sizes.motion,
        plan.sizes.network,
        plan.sizes.fallback,
        plan.sizes.obstacles,
        plan.sizes.limiting,
        plan.sizes.sent,
    )


@compiled
def motion_of(plan: ArmPlan, own: ArmState) -> MotionState:
    """View the state of an arm's motion."""
    sizes = plan.step.arrays.sizes
    return MotionState.of(own.motion, sizes.joints, sizes.pairs)


@compiled
def rest_arm(plan: ArmPlan, memory: Vector, q: Vector) -> None:
    """Let an arm stand at joint positions q (n,) [rad], or without any where it is measured next.

    The obstacles stay where they are.
    """
    own = arm_state(plan, memory)
    places = own.obstacles.copy()
    memory[:] = 0.0
    for k in range(len(places)):
        copied(own.obstacles[k], places[k])
    own.period = plan.settings.dt
    own.reason = Reason.NO_REQUEST
    if q.size > 0:
        own.has_begun = True
        copied(own.positions, q)


@compiled
def place_arm(plan: ArmPlan, memory: Vector, centers: Matrix) -> None:
    """Let the obstacles have their centres at places (k, 3) [m] now, and move on from there."""
    own = arm_state(plan, memory)
    for k in range(len(own.obstacles)):
        for i in range(3):
            own.obstacles[k, i] = centers[k, i] - own.time * plan.velocities[k, i]


@compiled
def halt_arm(plan: ArmPlan, memory: Vector) -> None:
    """Brake from now on, whatever is requested, until the arm rests anew."""
    own = arm_state(plan, memory)
    own.reason = Reason.HALTED


@compiled
def send_arm(plan: ArmPlan, memory: Vector, dq: Vector, period: float) -> None:
    """Count a velocity dq (n,) [rad/s] as sent for a period [s], in place of a step's command."""
    own = arm_state(plan, memory)
    motion = motion_of(plan, own)
    count_as_sent(motion, dq, period)
    own.age += own.period
    own.period = period
    _go_on(own, plan.settings, motion)


@compiled
def step_arm(plan: ArmPlan, memory: Vector, given: ArmInput) -> int:
    """Take a step of a shield; its command is then the last one of `motion_of` the arm.

    Joint positions that are not finite count as those that were commanded, and the arm brakes.

    Returns:
        The first `Reason` for another command than the request; `INVALID` if a stated period is
        none: then nothing is changed.
    """
    if take_input(plan, memory, given) == INVALID:
        return INVALID
    own = arm_state(plan, memory)
    base = plan.step.arrays
    jacobian = np.empty((own.positions.size, 6))
    placements = np.empty((base.placements.shape[0], 12))
    write_kinematics(plan.robot, own.positions, jacobian, placements, base.inertia)
    row = np.empty(plan.width)
    answer_request(plan, memory, given, jacobian, placements, row)
    return first_reason(own)


@compiled
def take_input(plan: ArmPlan, memory: Vector, given: ArmInput) -> int:
    """Take positions, a request and periods over: the part of a step before the kinematics.

    Returns:
        The `Request` that is to be answered; `NONE`: the arm's positions are not known. `INVALID`
        if a stated period is none: then nothing is changed.
    """
    own = arm_state(plan, memory)
    settings = plan.settings
    stated = max(given.dt, given.elapsed)
    fits = stated < np.inf and min(given.dt, given.elapsed) == 0.0
    if not fits or (given.elapsed > 0.0 and settings.longest == 0.0):
        return INVALID
    periods = _periods_of(settings, given)
    if given.elapsed > 0.0:
        _count_as_elapsed(own, motion_of(plan, own), given.elapsed)
    own.is_late = periods.exceeded
    _take_positions(own, settings, given)
    _take_request(own, settings, given)
    own.period = periods.expected
    own.answered = Request.VELOCITY
    if own.reason == Reason.NONE and not own.is_blind:
        own.answered = own.kind
    if not own.has_begun:
        own.answered = Request.NONE
    return own.answered


@compiled
def _periods_of(settings: ArmSettings, given: ArmInput) -> Periods:
    """Return the periods that a step states."""
    return periods_of(settings.dt, settings.longest, given.dt, given.elapsed)


@compiled
def _count_as_elapsed(own: ArmState, motion: MotionState, elapsed: float) -> None:
    """Count the last command as held for `elapsed` [s]."""
    for i in range(motion.last.size):
        own.positions[i] += (elapsed - own.period) * motion.last[i]
    own.time = own.time + elapsed - own.period
    own.period = elapsed
    if own.sent.size > 0:
        last = _sent_command(own, 0)
        last.period = elapsed


@compiled
def _take_positions(own: ArmState, settings: ArmSettings, given: ArmInput) -> None:
    """Take measured positions over at the first step, if they are far, or if nobody states periods.

    Then nobody says for how long the last command was held. What commands have moved that do not
    show yet is added to the measured positions.
    """
    q = given.q[: own.positions.size].copy()
    _add_pending(own, settings.delay, q)
    far = 0
    beyond = 0
    for i in range(q.size):
        far += not abs(q[i] - own.positions[i]) <= settings.tracking_error
        beyond += not abs(q[i]) <= LARGEST
    unstated = settings.longest > 0.0 and max(given.dt, given.elapsed) == 0.0
    own.is_blind = beyond > 0
    own.is_resynchronised = False
    if not own.is_blind and (far > 0 or unstated or not own.has_begun):
        own.is_resynchronised = own.has_begun and not unstated
        own.has_begun = True
        copied(own.positions, q)


@compiled
def _sent_command(own: ArmState, k: int) -> SentCommand:
    """View the command that was sent k commands before the last one."""
    width = 1 + own.positions.size
    return SentCommand.of(own.sent[k * width : (k + 1) * width])


@compiled
def _add_pending(own: ArmState, delay: float, q: Vector) -> None:
    """Add the displacement by the commands of the last `delay` [s] to positions q (n,) [rad]."""
    age = 0.0
    for k in range(own.sent.size // (1 + q.size)):
        command = _sent_command(own, k)
        pending = min(max(delay - age, 0.0), command.period)
        for i in range(q.size):
            q[i] += pending * command.dq[i]
        age += command.period


@compiled
def _note_sent(own: ArmState, period: float, dq: Vector) -> None:
    """Note a command as the last one that was sent.

    Args:
        own: The arm.
        period: Control period [s]; two commands that last no longer together become one.
        dq: The command [rad/s], (n,).
    """
    last = _sent_command(own, 0)
    before = _sent_command(own, 1)
    both = last.period + before.period
    if min(last.period, before.period) > 0.0 and both <= period:
        for i in range(dq.size):
            displacement = last.period * last.dq[i] + before.period * before.dq[i]
            before.dq[i] = displacement / both
        before.period = both
    else:
        width = 1 + dq.size
        for k in range(own.sent.size - width):
            place = own.sent.size - 1 - k
            own.sent[place] = own.sent[place - width]
    last.period = own.period
    copied(last.dq, dq)


@compiled
def _take_request(own: ArmState, settings: ArmSettings, given: ArmInput) -> None:
    """Take a request over; without one the last one counts, or one to rest for a reason."""
    count = 0
    if given.kind != Request.NONE:
        own.kind = given.kind
        count = TWIST if given.kind == Request.TWIST else own.positions.size
    own.age += own.period
    if count > 0 and own.reason != Reason.HALTED:
        own.age = 0.0
        finite = all_finite(given.request, 0, count)
        own.reason = Reason.NONE if finite else Reason.NOT_FINITE
    if own.reason == Reason.NONE and own.age > settings.timeout + 0.5 * own.period:
        own.reason = Reason.TIMED_OUT
    other = 0
    for i in range(own.request.size):
        now = given.request[i] if i < count else own.request[i]
        now = now if own.reason == Reason.NONE else 0.0
        other += now != own.request[i]
        own.request[i] = now
    own.is_repeated = other == 0 and not own.is_blind


@compiled
def answer_request(
    plan: ArmPlan,
    memory: Vector,
    given: ArmInput,
    jacobian: Matrix,
    placements: Matrix,
    row: Vector,
) -> int:
    """Answer the request that `take_input` has found: the part of a step after the kinematics.

    Args:
        plan: Layout of the step.
        memory: The arm's memory, (k,).
        given: As for `take_input`.
        jacobian: `Kinematics.jacobian` at the commanded positions, (n, 6).
        placements: `Kinematics.placements` there, (frames, 12).
        row: Room for the log of the control step.

    Returns:
        The action that was taken, or `INVALID`; that of the step before if `take_input` found that
        no step can be taken.
    """
    own = arm_state(plan, memory)
    if own.answered != Request.NONE:
        own.action = _answer(plan, own, given, jacobian, placements, row)
    _go_on(own, plan.settings, motion_of(plan, own))
    return own.action


@compiled
def _go_on(own: ArmState, settings: ArmSettings, motion: MotionState) -> None:
    """Lead positions and clock to the end of the last command's period."""
    if own.sent.size > 0:
        _note_sent(own, settings.dt, motion.last)
    for i in range(own.positions.size):
        own.positions[i] += own.period * motion.last[i]
    own.time += own.period


@compiled
def first_reason(own: ArmState) -> int:
    """Return the first `Reason` for another command than the request, beside limits."""
    if own.is_blind and own.reason != Reason.HALTED:
        return Reason.Q_NOT_FINITE
    if own.reason != Reason.NONE:
        return own.reason
    if own.is_resynchronised:
        return Reason.RESYNCHRONISED
    if own.is_cut:
        return Reason.CUT
    if own.is_late:
        return Reason.PERIOD_EXCEEDED
    return Reason.SINGULAR if own.is_singular else Reason.NONE


@compiled
def _answer(
    plan: ArmPlan,
    own: ArmState,
    given: ArmInput,
    jacobian: Matrix,
    placements: Matrix,
    row: Vector,
) -> int:
    """Answer a request by the program of a step, and keep its command; return the action."""
    timing = _periods_of(plan.settings, given)
    base = plan.step.arrays
    arrays = ProgramArrays(
        base.sizes,
        base.table,
        base.constants.copy(),
        jacobian,
        placements,
        base.support,
        base.inertia,
        base.tip,
    )
    if plan.scene >= 0:
        _place_obstacles(plan, own, own.time, block_constants(arrays, plan.scene))
    motion = motion_of(plan, own)
    change_spacing(motion, timing.dt)
    log = log_of(row, base.sizes)
    log.targets.reshape(log.targets.size)[:] = 0.0
    is_twist = own.answered == Request.TWIST
    state = own.network if is_twist else np.zeros(own.network.size)
    request = RequestConstants.of(block_constants(arrays, plan.request))
    request.is_twist = is_twist
    if is_twist:
        size = largest_entry(own.request[: Twist.width()])
        own.is_cut = size > plan.fastest
        for i in range(TWIST):
            request.asked[i] = own.request[i] / max(size / plan.fastest, 1.0)
    else:
        come_nearer(own, motion, plan.motion, timing, state)
        copied(request.asked, state[: own.positions.size])
    step = ControlPlan(
        arrays,
        plan.step.network,
        plan.step.paths,
        plan.step.yielding,
        own.twist_fallback if is_twist else own.fallback,
        plan.step.policy,
        False,
        timing,
    )
    next_motion_state = np.empty(own.motion.size)
    action = take_step(row, step, own.positions, own.motion, next_motion_state, state, own.time)
    if action == INVALID:  # positions that have been led beyond all limits
        motion.last[:] = 0.0
        return action
    copied(own.motion, next_motion_state)
    motion.yields = False  # a request that can be had again is had at once
    qp = program_views(log.program, base.sizes)
    own.is_singular = is_twist and falls_short(qp, request.asked)
    _note_limits(own, log)
    return action


@compiled
def _place_obstacles(plan: ArmPlan, own: ArmState, t: float, constants: Vector) -> None:
    """Write the places of the obstacles at time t [s] among the constants (k,) of a scene."""
    bodies = scene_views(constants, own.positions.size).bodies
    first = len(bodies) - len(own.obstacles)
    for k in range(len(own.obstacles)):
        body = Body.of(bodies[first + k])
        for i in range(body.center.size):
            body.center[i] = own.obstacles[k, i] + t * plan.velocities[k, i]


@compiled
def come_nearer(
    own: ArmState, motion: MotionState, limits: MotionConstants, periods: Periods, dq: Vector
) -> None:
    """Write the next velocities dq (n,) [rad/s] on the quickest path to the request that counts.

    Those on the way to positions are the quickest ones from which all joints can still rest there.
    A joint that jerk limits keep from its velocity in this step, or that is asked for the same one
    as in the last step, does not pass it.

    Args:
        own: The request, and where the joints are.
        motion: Last commands.
        limits: Limits of the joints.
        periods: Periods of the step.
        dq: The velocities, or longer, overwritten.
    """
    reaches = own.answered == Request.POSITION
    own.is_cut = False
    for i in range(own.positions.size):
        last = motion.last[i]
        before = motion.before[i]
        wanted = 0.0 if own.is_blind else own.request[i]
        left = wanted - own.positions[i]
        above = limits.upper[i] - own.positions[i]
        below = own.positions[i] - limits.lower[i]
        rates = joint_rates(limits, i)
        most = CUT * min(rates.velocity, FASTEST)
        if reaches:
            above = left if left >= 0.0 else np.inf
            below = -left if left < 0.0 else np.inf
            accel = rates.acceleration
            rates = Rates(rates.velocity, accel, rates.jerk, accel, np.inf, 0.0)
            wanted = min(max(left / periods.hold, -most), most)
        elif abs(wanted) > most:
            wanted = math.copysign(most, wanted)
            own.is_cut = True
        lower, upper, _, _ = joint_bounds(last, before, above, below, rates, periods)
        if reaches:
            wanted = min(max(wanted, lower), upper)
            wanted = arriving(last, before, left, wanted, rates, periods)
        elif own.is_repeated or wanted < lower or wanted > upper:
            wanted += braking(last - wanted, -np.inf, np.inf, limits.jerk[i], periods)
        dq[i] = wanted


@compiled
def _note_limits(own: ArmState, log: StepLog) -> None:
    """Note which bounds and rows keep the command from the request, and whether they do."""
    copied(own.limiting, log.limiting)
    differs = 0
    limits = 0
    for i in range(own.limiting.size):
        limits += own.limiting[i] != 0.0
    for i in range(own.positions.size):
        differs += log.dq[i] != own.request[i]
    reason = first_reason(own)
    own.is_clipped = limits > 0 or reason != Reason.NONE
    if own.answered == Request.VELOCITY and reason == Reason.NONE:
        own.is_clipped = differs > 0


@compiled
def margin_of(plan: ArmPlan, memory: Vector) -> tuple[float, float]:
    """Compute `Margin` at the joint positions that an arm's last command starts from."""
    own = arm_state(plan, memory)
    q = motion_of(plan, own).q
    joint = np.inf
    for i in range(q.size):
        joint = min(joint, min(q[i] - plan.lower[i], plan.upper[i] - q[i]))
    distance = np.inf
    if plan.scene >= 0:
        base = plan.step.arrays
        jacobian = np.empty((q.size, 6))
        placements = np.empty((base.placements.shape[0], 12))
        write_kinematics(plan.robot, q, jacobian, placements, base.inertia)
        constants = block_constants(base, plan.scene).copy()
        _place_obstacles(plan, own, own.time - own.period, constants)
        scene = scene_views(constants, q.size)
        distances = np.empty(len(scene.pairs))
        write_distances(constants, q.size, placements, distances)
        for k in range(distances.size):
            distance = min(distance, distances[k] - scene.head.least)
    return joint, distance


@compiled
def stopping_time_of(plan: ArmPlan, memory: Vector) -> float:
    """Compute the time of the motion to rest from an arm's last command [s]."""
    own = arm_state(plan, memory)
    motion = motion_of(plan, own)
    support = 0.0
    for i in range(motion.last.size):
        support = 1.0 if motion.last[i] != 0.0 else support
    cubic = plan.step.yielding.cubic
    dt = motion.spacing
    periods = least_periods(motion.last, motion.before, plan.motion, dt, cubic, False)
    return dt * max(periods, support)


class ArmInputs(NamedTuple):
    """Hold what N arms are given for a step.

    Attributes:
        q: Measured joint positions [rad], (N, n).
        kind: Kind of the new requests.
        requests: The requests, (N, n) or (N, 6).
        given: 1 for the arms that have a new one, else 0, (N,).
        dt: As in `ArmInput`.
        elapsed: As in `ArmInput`.
    """

    q: Matrix
    kind: int
    requests: Matrix
    given: IntVector
    dt: float
    elapsed: float


class ArmOutputs(NamedTuple):
    """Commands of N arms, overwritten.

    Attributes:
        dq: Joint velocities [rad/s], (N, n).
        next_q: Joint positions at the end of the period [rad], (N, n).
        clipped: 1 where the command differs from the request, else 0, (N,).
        reason: `Reason` of each arm, (N,).
    """

    dq: Matrix
    next_q: Matrix
    clipped: IntVector
    reason: IntVector


@released
def step_arms(
    plan: ArmPlan, memories: Matrix, given: ArmInputs, out: ArmOutputs, first: int, last: int
) -> int:
    """Take a step of the arms from one number to another; returns the last of `step_arm`'s."""
    found = 0
    for k in range(first, last):
        kind = given.kind if given.given[k] != 0 else Request.NONE
        own = ArmInput(given.q[k], kind, given.requests[k], given.dt, given.elapsed)
        found = step_arm(plan, memories[k], own)
        state = arm_state(plan, memories[k])
        copied(out.dq[k], motion_of(plan, state).last)
        copied(out.next_q[k], state.positions)
        out.clipped[k] = 1 if state.is_clipped else 0
        out.reason[k] = found
    return found
