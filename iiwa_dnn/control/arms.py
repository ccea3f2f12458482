"""Step of a shield as one kernel, from all that an arm keeps in one array: in C, and for many arms.

`Shield` does the same at the desk, where Pinocchio computes the kinematics and a command carries
its program. Here the kinematics are `write_kinematics`, and an arm keeps what can be asked about
its last step: which limits were active, its margin, the time to rest.
"""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numpy as np

from iiwa_dnn.compiling.library import compiled, released
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.compiling.trigonometry import LARGEST
from iiwa_dnn.control.command import ACTIVE, StepLog, log_of
from iiwa_dnn.control.controller import SLACK
from iiwa_dnn.control.cycle import INVALID, ControlPlan, take_step
from iiwa_dnn.control.fallback import Yielding
from iiwa_dnn.control.policies import Action
from iiwa_dnn.control.shield import (
    TWIST,
    Flags,
    Reason,
    ShieldSettings,
    ShieldState,
    come_nearer,
    cut_twist,
    falls_short,
    take_request,
)
from iiwa_dnn.control.state import MotionState
from iiwa_dnn.control.stopping import least_periods
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.dense import row_dot
from iiwa_dnn.qp.layout import IntVector, copied
from iiwa_dnn.robot.kinematics import Placement
from iiwa_dnn.robot.kinematics_kernel import ModelTables, write_kinematics
from iiwa_dnn.schemes.limits import MotionNumbers, Periods, constant_periods, joint_rates
from iiwa_dnn.schemes.program import (
    ProgramArrays,
    block_constants,
    bound_kind,
    program_views,
)
from iiwa_dnn.schemes.scene import Body, scene_views, write_distances


class Request(IntEnum):
    """Kinds of a request."""

    NONE = 0
    VELOCITY = 1
    TWIST = 2
    POSITION = 3


class ArmSettings(Record):
    """Settings of a shield.

    Attributes:
        dt: Control period [s].
        longest: Longest control period where periods vary [s]; 0: they do not.
        timeout: Time for which a request counts [s].
        tracking_error: Difference from which on an arm is resynchronised to measured positions
            [rad].
    """

    dt: float
    longest: float
    timeout: float
    tracking_error: float


class ArmState(Record):
    """All that an arm keeps from one step to the next, and of the last one what can be asked.

    Attributes:
        time: Time of the arm's clock [s].
        period: Period that counts for the last command [s].
        spacing: Period over which accelerations count [s]; 0 before the first step.
        kind: `Request` of the last request.
        action: `Action` of the last step.
        is_clipped: Whether its command was another one than the request.
        is_late: Whether its period was above the longest.
        is_singular: Whether the damping alone kept a twist from being fulfilled.
        is_blind: Whether its measured positions were not finite.
        asked: State of the request.
        positions: Commanded joint positions [rad], (n,).
        request: The request that counts, (max(n, 6),).
        motion: `MotionState`.
        network: State of the network that answers twists.
        fallback: States of the networks of fallback programs, for requests of joints.
        twist_relaxed: The same for twists.
        obstacles: Places of the obstacles [m], three numbers each.
        limiting: For each joint the kind of the bound that limits it, below 0 for a lower one, or
            0; then 1 for each row that limits the command, (n + m,).
    """

    time: float
    period: float
    spacing: float
    kind: int
    action: int
    is_clipped: bool
    is_late: bool
    is_singular: bool
    is_blind: bool
    asked: Flags = part(Flags)
    positions: Vector = part("n")
    request: Vector = part("request")
    motion: Vector = part("motion")
    network: Vector = part("network")
    fallback: Vector = part("relaxed")
    twist_relaxed: Vector = part("twist_relaxed")
    obstacles: Vector = part("obstacles")
    limiting: Vector = part("limiting")


class ArmProgram(NamedTuple):
    """Step of one kind of request.

    Attributes:
        step: Layout of the control step.
        width: Length of its log.
        rates: Number of the block of acceleration and jerk limits; -1: there is none.
    """

    step: ControlPlan
    width: int
    rates: int


class ArmPlan(NamedTuple):
    """Layout and settings that all arms of a kind share.

    Attributes:
        robot: Tables of the robot, n joints.
        joint: Step for requests of joint velocities and positions.
        twist: Step for requests of a frame's twist.
        motion: Limits of the joints.
        range: Lower and upper position limits [rad], (2, n).
        settings: Settings of the shield.
        sizes: Sizes of `ArmState`, (8,).
    """

    robot: ModelTables
    joint: ArmProgram
    twist: ArmProgram
    motion: MotionNumbers
    range: Matrix
    settings: ArmSettings
    sizes: IntVector


class ArmInput(NamedTuple):
    """What an arm is given for a step.

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
    own = plan.sizes
    return ArmState.of(memory, own[0], own[1], own[2], own[3], own[4], own[5], own[6], own[7])


@compiled
def rest_arm(plan: ArmPlan, memory: Vector, q: Vector) -> None:
    """Let an arm stand at joint positions q (n,) [rad], or without any where it is measured next.

    The obstacles stay where they are.
    """
    own = arm_state(plan, memory)
    places = own.obstacles.copy()
    memory[:] = 0.0
    copied(own.obstacles, places)
    own.period = plan.settings.dt
    own.asked.reason = Reason.NO_REQUEST
    if q.size > 0:
        own.asked.begun = True
        copied(own.positions, q)


@compiled
def motion_of(plan: ArmPlan, own: ArmState) -> MotionState:
    """View the state of an arm's motion."""
    sizes = plan.joint.step.arrays.sizes
    return MotionState.of(own.motion, sizes.joints, sizes.pairs)


@compiled
def step_arm(plan: ArmPlan, memory: Vector, given: ArmInput) -> int:
    """Take a step of a shield; its command is then the last one of `motion_of` the arm.

    Joint positions that are not finite count as those that were commanded, and the arm brakes.

    Returns:
        The first `Reason` for another command than the request; `INVALID` if a stated period is
        none: then nothing is changed.
    """
    own = arm_state(plan, memory)
    settings = plan.settings
    stated = max(given.dt, given.elapsed)
    fits = min(given.dt, given.elapsed) >= 0.0 and stated < np.inf
    if not fits or min(given.dt, given.elapsed) > 0.0:
        return INVALID
    if given.elapsed > 0.0 and settings.longest == 0.0:
        return INVALID
    periods = _stated_periods(settings, given.dt, given.elapsed)
    _take_period(plan, own, periods, given.elapsed)
    own.is_late = 0.0 < settings.longest * (1.0 + SLACK) < stated
    held = _take_input(own, settings, given)
    own.period = given.dt if given.dt > 0.0 else settings.dt
    if own.asked.begun:
        counts = own.asked.reason == Reason.NONE and not own.is_blind
        if own.kind == Request.TWIST and counts:
            own.action = _answer(plan, plan.twist, own, periods, Request.TWIST, held)
        elif own.kind == Request.POSITION and counts:
            own.action = _answer(plan, plan.joint, own, periods, Request.POSITION, held)
        else:
            own.action = _answer(plan, plan.joint, own, periods, Request.VELOCITY, held)
    dq = motion_of(plan, own).last
    for i in range(dq.size):
        own.positions[i] += own.period * dq[i]
    own.time += own.period
    return first_reason(own)


@compiled
def first_reason(own: ArmState) -> int:
    """Return the first `Reason` for another command than the request, beside limits."""
    if own.is_blind and own.asked.reason != Reason.HALTED:
        return Reason.Q_NOT_FINITE
    if own.asked.reason != Reason.NONE:
        return own.asked.reason
    if own.asked.resynchronised:
        return Reason.RESYNCHRONISED
    if own.asked.is_cut:
        return Reason.CUT
    if own.is_late:
        return Reason.PERIOD_EXCEEDED
    return Reason.SINGULAR if own.is_singular else Reason.NONE


@compiled
def _stated_periods(settings: ArmSettings, dt: float, elapsed: float) -> Periods:
    """Return `limits.stated_periods`, where 0 is a period that is not stated."""
    longest = settings.longest
    hold = dt if dt > 0.0 else settings.dt
    if longest == 0.0:
        return constant_periods(hold)
    if dt > 0.0:
        return Periods(hold, hold, longest, 1.0, True)
    if elapsed > 0.0:
        return Periods(elapsed, longest, longest, 1.0, True)
    return Periods(hold, hold, hold, hold / longest, True)


@compiled
def _take_period(plan: ArmPlan, own: ArmState, periods: Periods, elapsed: float) -> None:
    """Count the last command as held for `elapsed` [s], if that is stated; go on in periods."""
    motion = motion_of(plan, own)
    if elapsed > 0.0:
        for i in range(motion.last.size):
            own.positions[i] += (elapsed - own.period) * motion.last[i]
        own.time += elapsed - own.period
        own.period = elapsed
    if own.spacing > 0.0 and periods.dt != own.spacing:
        ratio = periods.dt / own.spacing
        for i in range(motion.last.size):
            motion.before[i] = motion.last[i] - ratio * (motion.last[i] - motion.before[i])
        motion.stopping_periods = motion.stopping_periods / ratio
    own.spacing = periods.dt


@compiled
def _take_input(own: ArmState, settings: ArmSettings, given: ArmInput) -> bool:
    """Take measured positions and a request over; return whether it is that of the last step."""
    n = own.positions.size
    q = own.positions.copy()
    far = 0
    for i in range(n):
        far += not abs(given.q[i]) <= LARGEST
    own.is_blind = far > 0
    if far == 0:
        copied(q, given.q[:n])
        if settings.longest > 0.0 and max(given.dt, given.elapsed) == 0.0:
            copied(own.positions, q)  # nobody says for how long the last command was held
    numbers = ShieldSettings.of(np.zeros(4))
    numbers.period = own.period
    numbers.timeout = settings.timeout
    numbers.tracking_error = settings.tracking_error
    request = own.request.copy()
    if given.kind != Request.NONE:
        own.kind = given.kind
        copied(request, given.request[: TWIST if given.kind == Request.TWIST else n])
    begun = own.asked.begun
    state = ShieldState(own.positions, own.request, own.asked)
    held = take_request(q, request, given.kind != Request.NONE, state, numbers)
    if far > 0:
        own.asked.begun = begun  # not by positions that nobody has measured
    return held and far == 0


@compiled
def _answer(
    plan: ArmPlan, program: ArmProgram, own: ArmState, periods: Periods, kind: int, held: bool
) -> int:
    """Answer a request by the program of its kind, and keep its command; return the action."""
    n = own.positions.size
    motion = motion_of(plan, own)
    base = program.step.arrays
    jacobian = np.empty((n, 6))
    placements = np.empty((base.placements.shape[0], 12))
    write_kinematics(plan.robot, own.positions, jacobian, placements, base.inertia)
    arrays = ProgramArrays(
        base.sizes,
        base.table,
        base.constants.copy(),
        jacobian,
        placements,
        base.support,
        base.inertia,
        1.0 / own.period,
        base.tip,
    )
    _state_changes(program, own, periods, arrays)
    row = np.zeros(program.width)
    log = log_of(row, base.sizes)
    targets = log.targets.reshape(log.targets.size)
    state = own.network if kind == Request.TWIST else np.zeros(own.network.size)
    if kind == Request.TWIST:
        copied(targets[12:], own.request[:TWIST])
        placement = Placement.of(placements[base.tip])
        support = base.support[base.tip]
        own.asked.is_cut = cut_twist(targets[12:18], jacobian, placement, support, plan.motion)
    else:
        request = np.zeros(n) if own.is_blind else own.request
        come_nearer(
            ShieldState(own.positions, request, own.asked),
            motion.last,
            motion.before,
            plan.motion,
            periods,
            kind == Request.POSITION,
            held,
            state[:n],
        )
        copied(targets, state[:n])
    settings = program.step.yielding
    yielding = Yielding(
        settings.weights,
        settings.limits,
        settings.tolerance,
        settings.budget,
        settings.scenes,
        own.period,
        periods,
        settings.cubic,
        settings.coupled,
        settings.alike,
    )
    fallback = own.twist_relaxed if kind == Request.TWIST else own.fallback
    step = ControlPlan(
        arrays, program.step.network, program.step.paths, yielding, fallback, program.step.policy
    )
    next_motion_state = np.empty(own.motion.size)
    action = take_step(
        row, step, own.positions, own.motion, next_motion_state, state, own.time, False
    )
    if action == INVALID:  # positions that have been led beyond all limits
        motion.last[:] = 0.0
        return action
    copied(own.motion, next_motion_state)
    motion.yields = False
    _note_limits(plan, own, log, step, action, kind)
    return action


@compiled
def _state_changes(
    program: ArmProgram, own: ArmState, periods: Periods, arrays: ProgramArrays
) -> None:
    """Write stated periods and the places of the obstacles among a program's constants."""
    if periods.vary and program.rates >= 0:
        limits = MotionNumbers.of(block_constants(arrays, program.rates))
        limits.dt = periods.dt
        limits.hold = periods.hold
        limits.longest = periods.longest
        limits.fraction = periods.fraction
    count = own.obstacles.size // 3
    if count > 0:
        numbers = block_constants(arrays, program.step.yielding.scenes[0])
        bodies = scene_views(numbers, own.positions.size).bodies
        for k in range(count):
            body = Body.of(bodies[len(bodies) - count + k])
            copied(body.center, own.obstacles[3 * k : 3 * k + 3])


@compiled
def _note_limits(
    plan: ArmPlan, own: ArmState, log: StepLog, step: ControlPlan, action: int, kind: int
) -> None:
    """Note which bounds and rows keep the command from the request, and whether they do."""
    qp = program_views(log.program, step.arrays.sizes)
    n = own.positions.size
    first_row = qp.q.size + qp.b.size
    first_bound = first_row + qp.h.size
    own.limiting[:] = 0.0
    differs = 0
    limits = 0
    for i in range(n):
        side = log.limiting[i]
        if action == Action.NONE:
            side = log.point[first_bound + i]
            nearest = qp.ub[i] if side > 0.0 else qp.lb[i]
            side = _active(side, abs(nearest - log.point[i]))
        if side != 0.0:
            rates = joint_rates(plan.motion, i)
            bounds = (log.lower[i], log.upper[i])
            periods = step.yielding.periods
            code = bound_kind(bounds, log.last[i], log.before[i], side, rates, periods)
            own.limiting[i] = code if side > 0.0 else -code
            limits += 1
        differs += log.dq[i] != own.request[i]
    for j in range(qp.h.size):
        side = log.limiting[qp.q.size + j]
        if action == Action.NONE:
            side = _active(log.point[first_row + j], qp.h[j] - row_dot(qp.G, j, log.point))
        if side != 0.0:
            own.limiting[n + j] = 1.0
            limits += 1
    own.is_singular = kind == Request.TWIST and falls_short(qp, log.targets[0, 12:])
    reason = first_reason(own)
    if kind == Request.VELOCITY and reason == Reason.NONE:
        own.is_clipped = differs > 0
    else:
        own.is_clipped = limits > 0 or reason != Reason.NONE


@compiled
def _active(multiplier: float, slack: float) -> float:
    """Return the multiplier of a bound or row, 0 where it is not active."""
    size = abs(multiplier)
    if size > ACTIVE and slack <= ACTIVE / min(max(size, ACTIVE), 1.0):
        return multiplier
    return 0.0


@compiled
def margin_of(plan: ArmPlan, memory: Vector) -> tuple[float, float]:
    """Compute `Margin` at the joint positions that an arm's last command starts from."""
    own = arm_state(plan, memory)
    q = motion_of(plan, own).q
    joint = np.inf
    for i in range(q.size):
        joint = min(joint, min(q[i] - plan.range[0, i], plan.range[1, i] - q[i]))
    base = plan.joint.step.arrays
    distance = np.inf
    if plan.joint.step.yielding.scenes.size > 0:
        jacobian = np.empty((q.size, 6))
        placements = np.empty((base.placements.shape[0], 12))
        write_kinematics(plan.robot, q, jacobian, placements, base.inertia)
        arrays = ProgramArrays(
            base.sizes,
            base.table,
            base.constants.copy(),
            jacobian,
            placements,
            base.support,
            base.inertia,
            base.rate,
            base.tip,
        )
        _state_changes(plan.joint, own, constant_periods(1.0), arrays)
        numbers = block_constants(arrays, plan.joint.step.yielding.scenes[0])
        scene = scene_views(numbers, q.size)
        distances = np.empty(len(scene.pairs))
        write_distances(numbers, q.size, placements, distances)
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
    cubic = plan.joint.step.yielding.cubic
    periods = least_periods(motion.last, motion.before, plan.motion, own.spacing, cubic, False)
    return own.spacing * max(periods, support)


@compiled
def halt_arm(plan: ArmPlan, memory: Vector) -> None:
    """Brake from now on, whatever is requested, until the arm rests anew."""
    own = arm_state(plan, memory)
    own.asked.reason = Reason.HALTED


@compiled
def send_arm(plan: ArmPlan, memory: Vector, dq: Vector, period: float) -> None:
    """Count a velocity dq (n,) [rad/s] as sent for a period [s], in place of a step's command."""
    own = arm_state(plan, memory)
    motion = motion_of(plan, own)
    copied(motion.before, motion.last)
    copied(motion.last, dq[: motion.last.size])
    motion.stopping_periods = 0.0
    own.asked.age += own.period
    own.period = period
    own.time += period
    for i in range(motion.last.size):
        own.positions[i] += period * dq[i]


class ArmInputs(NamedTuple):
    """What N arms are given for a step.

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
