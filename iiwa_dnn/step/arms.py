"""Step of an arm as kernels over its memory: of shields and controllers, at the desk and in C.

`begin_step` takes positions, request and periods into the state of the arm; `finish_step` computes
the command from the kinematics at the arm's positions. Between them `Shield` has Pinocchio compute
the kinematics; `step_arm`, for many arms and in C, calls the kernel `write_kinematics`. The state
holds what can be asked about the last step: active limits, margin, stopping time.

A shield answers requests, from the positions that it commands. A controller answers targets of
frames, which are given or sampled from its paths, from the positions that are measured: Pinocchio
computes their kinematics before `step_measured`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from iiwa_dnn.checks import Vector3
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.compiling.trigonometry import LARGEST
from iiwa_dnn.naming import LimitKind
from iiwa_dnn.networks.integrators.base import AnswerSettings, CompiledAnswer
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.dense import all_finite, largest_entry
from iiwa_dnn.qp.layout import copied
from iiwa_dnn.robot.kinematics import Twist
from iiwa_dnn.robot.kinematics_kernel import ModelTables, write_kinematics
from iiwa_dnn.schemes.joint_limits import (
    MotionConstants,
    joint_range,
    joint_rates,
    motion_constants,
)
from iiwa_dnn.schemes.periods import SLACK, Periods, periods_of
from iiwa_dnn.schemes.profiles import Rates, braking
from iiwa_dnn.schemes.program import ProgramArrays, block_constants, program_views
from iiwa_dnn.schemes.scene import Body, scene_views, write_distances
from iiwa_dnn.schemes.separation import (
    FREE_BODY,
    FreeBody,
    nearest_body,
    separation_factor,
    separation_views,
)
from iiwa_dnn.schemes.torque import torque_margin
from iiwa_dnn.schemes.viability import joint_bounds, reaching
from iiwa_dnn.step.bodies import (
    grow_older,
    is_newer,
    take_body,
    take_people,
    write_bodies,
)
from iiwa_dnn.step.cycle import INVALID, sample_targets, take_step
from iiwa_dnn.step.following import follow_samples
from iiwa_dnn.step.log import StepLog, log_of
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
    twist_rows,
)
from iiwa_dnn.step.samples import (
    FollowState,
    asks,
    forget_samples,
    have_meaning,
    keep_samples,
    samples_of,
)
from iiwa_dnn.step.state import MotionState, change_spacing, count_as_sent
from iiwa_dnn.step.stopping import brake_blindly, least_periods
from iiwa_dnn.step.yielding import NOMINAL, NONE, SLOW

TURN = 2.0 * math.pi
"""Turn after which a joint without position limits is at the same place [rad]."""

SHORTEST = 1e-9
LONGEST = 1e3
"""Periods below and above which a stated one is refused [s]: quotients by them overflow."""

RISE = 4.0
"""Largest rate at which the part of a request that a separation admits grows again [1/s]."""

BEHIND = 1.5
"""Way from one requested position to the next, times this, above which a joint is behind them."""

FOLLOWING = 1e-12
"""Difference of measured and commanded positions that counts as rounding [rad]."""


class ArmSettings(Record):
    """Settings of the steps of an arm; of a controller's the periods alone count.

    Attributes:
        dt: Control period [s].
        longest: Longest control period where periods vary [s]; 0: they are constant.
        timeout: Age above which a request no longer counts [s].
        tracking_error: Difference of measured and commanded positions above which the arm is
            resynchronised to the measured ones [rad].
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
        period: Time for which the command is held [s]; 0: no command was sent.
        dq: Joint velocity [rad/s], (n,).
    """

    period: float
    dq: Vector = part()


class ArmSizes(NamedTuple):
    """Sizes of the parts of `ArmState`, in the order of their names there."""

    n: int
    request: int
    motion: int
    network: int
    fallback: int
    twist_fallback: int
    obstacles: int
    limiting: int
    sent: int
    bodies: int
    following: int


class SeenBodies(Record):
    """State of an arm beside bodies of bounded speed.

    Attributes:
        age: Age of the last frame of people [s]; inf: there was none.
        is_refused: Whether the last frame, or body that was seen, had no meaning.
        withheld: Part of the request that the separation from bodies does not admit.
    """

    age: float
    is_refused: bool
    withheld: float


class ArmState(Record):
    """State of an arm between steps, with the results of the last step.

    Attributes:
        time: Time since the arm's first step [s]; of a controller the time of its steps.
        period: Time for which the last command is held [s].
        fraction: Fraction of it by which the paths' clock goes on.
        program: `ProgramKind` of the program that the last step answered.
        age: Time since the last request came [s].
        reason: `Reason` for which the request is replaced by zero velocity; `NONE`: it counts.
        kind: `Request` of the last request.
        answered: `Request` that the last step answered; `NONE`: the positions are not known, and
            no step was taken.
        has_begun: Whether joint positions are known.
        is_repeated: Whether the request is that of the step before.
        is_clipped: Whether the last command differs from the request.
        is_misplaced: Whether the place of an obstacle is not known.
        reduction: Part of the joints' velocity limits that requests must not use.
        positions: Joint positions at the end of the last command's period [rad], (n,).
        measured: Measured ones [rad], (n,), with the displacement that the delay hides, and with
            the turns of `positions`.
        wraps: 1 for each joint whose readings have skipped whole turns, (n,).
        behind: 1 for each joint that a stream of requested positions has left behind, (n,).
        request: The request that counts, (max(n, 6),), zero without one; (0,) of a controller.
        reasons: 1 for each `Reason` of the last step, else 0.
        motion: `MotionState`.
        network: State of the network that answers twists or targets; that of a `Controller` is its
            solver's.
        fallback: States of the networks of fallback programs, for requests of joints or targets.
        twist_fallback: The same for twists; (0,) of a controller.
        obstacles: Centres that the obstacles had, or would have had, at time 0 [m], (k, 3).
        limiting: Active bounds and rows of the last step, as in `StepLog`, (n + m,).
        sent: A `SentCommand` for each command of the last `delay` seconds, the last first,
            (k (1 + n),).
        seen: What is known of bodies of bounded speed.
        bodies: A `FreeBody` for each of them, as the last step left it.
        following: `FollowState`; (0,): no samples are followed.
    """

    time: float
    period: float
    fraction: float
    program: int
    age: float
    reason: int
    kind: int
    answered: int
    has_begun: bool
    is_repeated: bool
    is_clipped: bool
    is_misplaced: bool
    reduction: float
    positions: Vector = part("n")
    measured: Vector = part("n")
    wraps: Vector = part("n")
    behind: Vector = part("n")
    request: Vector = part("request")
    reasons: Vector = part(len(Reason))
    motion: Vector = part("motion")
    network: Vector = part("network")
    fallback: Vector = part("fallback")
    twist_fallback: Vector = part("twist_fallback")
    obstacles: Matrix = part("obstacles", 3)
    limiting: Vector = part("limiting")
    sent: Vector = part("sent")
    seen: SeenBodies = part(SeenBodies)
    bodies: Matrix = part("bodies", FREE_BODY)
    following: Vector = part("following")


class ArmPlan(NamedTuple):
    """Layout and settings of the steps of the arms of a shield or a controller.

    Attributes:
        robot: Tables of the robot, n joints.
        step: Layout of the control step.
        request: Number of the program's block that holds the request; -1: targets are tracked.
        scene: Number of the program's block that holds the watched pairs; -1: none are watched, or
            obstacles move in a way of their own.
        separation: Number of that of bodies of bounded speed; -1: there are none.
        torque: Number of that of the joints' torques; -1: they are not limited.
        width: Length of the log of a step.
        lag: Network time of a step per control period in continuous mode; 0 if the network solves.
        fastest: Largest entry of a twist [m/s], [rad/s]; a larger twist is scaled down to it.
        velocities: Velocities of the obstacles [m/s], (k, 3).
        settings: Settings of the shield.
        sizes: Sizes of `ArmState`.
    """

    robot: ModelTables
    step: ControlPlan
    request: int
    scene: int
    separation: int
    torque: int
    width: int
    lag: float
    fastest: float
    velocities: Matrix
    settings: ArmSettings
    sizes: ArmSizes


class ArmInput(NamedTuple):
    """Inputs of a step.

    Attributes:
        q: Measured joint positions [rad], (n,).
        kind: Kind of the new request; `Request.NONE`: there is none.
        request: Numbers of the new request, at least (n,) or (6,); or the targets of a controller's
            frames, (18 frames,), empty for those of its paths.
        dt: Period for which the command will be held [s]; 0: not stated.
        elapsed: Time since the last step [s]; 0: not stated.
        t: Time of a controller's step [s].
    """

    q: Vector
    kind: int
    request: Vector
    dt: float
    elapsed: float
    t: float


@compiled
def arm_state(plan: ArmPlan, memory: Vector) -> ArmState:
    """View the memory (k,) of an arm as its state."""
    return ArmState.of(
        memory,
        plan.sizes.n,
        plan.sizes.request,
        plan.sizes.motion,
        plan.sizes.network,
        plan.sizes.fallback,
        plan.sizes.twist_fallback,
        plan.sizes.obstacles,
        plan.sizes.limiting,
        plan.sizes.sent,
        plan.sizes.bodies,
        plan.sizes.following,
    )


@compiled
def _tracks(plan: ArmPlan) -> bool:
    """Test whether the arms are a controller's: they track targets, and have no requests."""
    return plan.request < 0


@compiled
def motion_of(plan: ArmPlan, arm: ArmState) -> MotionState:
    """View the state of an arm's motion."""
    sizes = plan.step.arrays.sizes
    return MotionState.of(arm.motion, sizes.joints, sizes.pairs)


@compiled
def follow_of(plan: ArmPlan, arm: ArmState) -> FollowState:
    """View what an arm follows, if it has room for samples."""
    n = plan.sizes.n
    m = samples_of(n, plan.sizes.following)
    return FollowState.of(arm.following, n, m, n * m)


@compiled
def follow_arm(plan: ArmPlan, memory: Vector, times: Vector, positions: Matrix, mode: int) -> bool:
    """Let an arm follow samples from their time on; return whether they have a meaning.

    Args:
        plan: Layout of the steps.
        memory: The arm's memory, (k,), overwritten.
        times: Time of each sample [s], rising; of a chunk on the arm's clock, (m,).
        positions: Joint positions of each [rad], (m, n).
        mode: Their `Mode`; of a stream one sample comes at a time.
    """
    arm = arm_state(plan, memory)
    if not have_meaning(times, mode, samples_of(plan.sizes.n, plan.sizes.following)):
        return False
    keep_samples(follow_of(plan, arm), times, positions.reshape(positions.size), mode, arm.time)
    return True


@compiled
def rest_arm(plan: ArmPlan, memory: Vector, q: Vector) -> None:
    """Reset an arm to rest at joint positions q (n,) [rad]; obstacles and speed scale stay.

    If q is empty, the arm begins at the positions that the next step measures; they are NaN before.
    Bodies of bounded speed have to be seen anew.
    """
    arm = arm_state(plan, memory)
    centers = arm.obstacles.copy()
    reduction = arm.reduction
    memory[:] = 0.0
    arm.reduction = reduction
    for k in range(len(centers)):
        copied(arm.obstacles[k], centers[k])
    arm.period = plan.settings.dt
    arm.fraction = 1.0
    arm.reason = Reason.NONE if _tracks(plan) else Reason.NO_REQUEST
    arm.positions[:] = np.nan
    if plan.separation >= 0:
        own = separation_views(block_constants(plan.step.arrays, plan.separation))
        copied(arm.bodies.reshape(arm.bodies.size), own.bodies.reshape(own.bodies.size))
        arm.seen.age = np.inf
        arm.seen.withheld = 1.0
    if q.size > 0:
        arm.has_begun = True
        copied(arm.positions, q)


@compiled
def place_arm(plan: ArmPlan, memory: Vector, centers: Matrix) -> None:
    """Place the centres of an arm's obstacles, (k, 3) [m], at the present time.

    If one is not finite, all stay where they are, and the arm brakes until they are placed again.
    """
    arm = arm_state(plan, memory)
    flat = centers.reshape(centers.size)
    arm.is_misplaced = not all_finite(flat, 0, flat.size)
    for k in range(0 if arm.is_misplaced else len(arm.obstacles)):
        for i in range(3):
            arm.obstacles[k, i] = centers[k, i] - arm.time * plan.velocities[k, i]


@compiled
def see_people(plan: ArmPlan, memory: Vector, capsules: Matrix, age: float) -> bool:
    """Take a frame of all people in the field, seen some time ago [s]; return if it has a meaning.

    Else all bodies grow older until the next frame, and a `Reason` is noted.

    Args:
        plan: Layout of the steps.
        memory: The arm's memory, (k,), overwritten.
        capsules: Ends and radius of each body, with the error of its place [m], (k, 7).
        age: Time since it was seen [s].
    """
    arm = arm_state(plan, memory)
    people = 0
    if plan.separation >= 0:
        own = separation_views(block_constants(plan.step.arrays, plan.separation))
        people = own.head.people
    taken = people > 0 and is_newer(age, arm.seen.age)
    taken = taken and take_people(arm.bodies, people, capsules)
    arm.seen.is_refused = not taken
    if taken:
        arm.seen.age = age
        for k in range(len(arm.bodies) - people, len(arm.bodies)):
            body = FreeBody.of(arm.bodies[k])
            body.age = age
    return taken


@compiled
def see_body(plan: ArmPlan, memory: Vector, number: int, box: Vector, age: float) -> bool:
    """Place one body, as `see_people`; others grow older. Without one of this number do nothing.

    Args:
        plan: Layout of the steps.
        memory: The arm's memory, (k,), overwritten.
        number: Number of the body.
        box: Half-extents [m], axes one a row, and center [m] of its box, (15,).
        age: Time since it was seen [s].
    """
    arm = arm_state(plan, memory)
    named = len(arm.bodies)
    if plan.separation >= 0:
        own = separation_views(block_constants(plan.step.arrays, plan.separation))
        named -= own.head.people
    if not 0 <= number < named:
        return False
    taken = take_body(FreeBody.of(arm.bodies[number]), box, age)
    arm.seen.is_refused = not taken
    return taken


@compiled
def halt_arm(plan: ArmPlan, memory: Vector) -> None:
    """Make an arm brake at each step, whatever is requested, until `rest_arm`."""
    arm = arm_state(plan, memory)
    arm.reason = Reason.HALTED


@compiled
def scale_speed(plan: ArmPlan, memory: Vector, scale: float) -> bool:
    """Let requests use a part of the joints' velocity limits; one outside of [0, 1] is refused."""
    arm = arm_state(plan, memory)
    fits = 0.0 <= scale <= 1.0
    if fits:
        arm.reduction = 1.0 - scale
    return fits


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
    return action if _tracks(plan) else first_reason(arm)


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
    if _tracks(plan):
        _measure(arm, inputs)
    else:
        stated = inputs.dt + inputs.elapsed
        unstated = arm.reasons[Reason.PERIOD_REFUSED] != 0.0 or stated == 0.0
        _update_positions(plan, arm, inputs.q, unstated and settings.longest > 0.0)
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
    motion = motion_of(plan, arm)
    change_spacing(motion, periods.dt)
    limits = motion_constants(plan.step.arrays)
    follow_samples(own, arm.positions, motion, limits, periods, arm.time, arm.request)
    arm.answered = FOLLOW


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
    most = LONGEST if _tracks(plan) else settings.dt * (1.0 + SLACK)
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
    _grow_older(arm, max(elapsed - arm.period, 0.0))
    arm.period = elapsed
    if arm.sent.size > 0:
        last = _sent_command(arm, 0)
        last.period = elapsed


@compiled
def _update_positions(plan: ArmPlan, arm: ArmState, measured: Vector, unstated: bool) -> None:
    """Set the commanded positions to the measured ones, where these count.

    They count at the first step; where they differ by more than the tracking error; and where
    periods vary and none is stated, since the time for which the last command was held is then
    unknown. The displacement that the delay still hides is added to them.

    Args:
        plan: Layout of the step.
        arm: The arm.
        measured: Measured joint positions [rad], (n,), or longer.
        unstated: Whether periods vary, and none is stated.
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
            turns = _turns_between(q[i], arm.positions[i])
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
def _turns_between(position: float, other: float) -> float:
    """Return the number of whole turns from a position to the same place nearest to another."""
    return math.floor((other - position) / TURN + 0.5)


@compiled
def _sent_command(arm: ArmState, k: int) -> SentCommand:
    """View the command that was sent k commands before the last one."""
    width = 1 + arm.positions.size
    return SentCommand.of(arm.sent[k * width : (k + 1) * width])


@compiled
def add_pending(arm: ArmState, delay: float, q: Vector) -> None:
    """Add the displacement by the commands of the last `delay` [s] to positions q (n,) [rad]."""
    age = 0.0
    for k in range(arm.sent.size // (1 + q.size)):
        command = _sent_command(arm, k)
        pending = min(max(delay - age, 0.0), command.period)
        for i in range(q.size):
            q[i] += pending * command.dq[i]
        age += command.period


@compiled
def _note_sent(arm: ArmState, period: float, dq: Vector) -> None:
    """Note a command dq (n,) [rad/s] as the last one that was sent.

    If the two before it last no longer than a control period [s] together, they become one with
    their mean velocity: so a bounded number of commands covers the delay.
    """
    last = _sent_command(arm, 0)
    before = _sent_command(arm, 1)
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
        arm.behind[i] = 1.0 if streams and 0.0 < BEHIND * way < abs(_left(arm, i)) else 0.0


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
    if arm.answered != Request.NONE or _tracks(plan):
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
    _grow_older(arm, arm.period)


@compiled
def _grow_older(arm: ArmState, seconds: float) -> None:
    """Add seconds to the age of all that was seen."""
    arm.seen.age += seconds
    grow_older(arm.bodies, seconds)


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
        _place_obstacles(plan, arm, arm.time, block_constants(arrays, plan.scene))
    if plan.separation >= 0:
        write_bodies(block_constants(arrays, plan.separation), arm.bodies, arm.seen.age)
    change_spacing(motion, timing.dt)
    log = log_of(data, arrays.sizes)
    is_twist = arm.answered == Request.TWIST
    state = network if is_twist or _tracks(plan) else np.zeros(network.size)
    is_valid = True
    if _tracks(plan):
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
    if _tracks(plan):
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
    left = _left(arm, i)
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
def _place_obstacles(plan: ArmPlan, arm: ArmState, t: float, constants: Vector) -> None:
    """Write the centres of the obstacles at time t [s] into the constants (k,) of a scene."""
    bodies = scene_views(constants).bodies
    first = len(bodies) - len(arm.obstacles)
    for k in range(len(arm.obstacles)):
        body = Body.of(bodies[first + k])
        for i in range(body.center.size):
            body.center[i] = arm.obstacles[k, i] + t * plan.velocities[k, i]


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
    rest there (`_left`). A joint that cannot reach its requested velocity in this step because of a
    jerk limit, or whose request is that of the step before, approaches it without overshoot. The
    velocities of an arm that follows samples are taken as they are: they are within its limits.

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
        left = _left(arm, i)
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
def _left(arm: ArmState, i: int) -> float:
    """Compute the displacement of joint i to its requested position [rad].

    The joint is there where its commanded or its measured position is, or between them: a request
    for the measured positions holds the arm. Of a joint whose readings have skipped turns, the
    nearest of all positions that are one place is requested.
    """
    wanted: float = arm.request[i]
    commanded: float = arm.positions[i]
    measured: float = arm.measured[i]
    if arm.wraps[i] != 0.0:
        wanted += TURN * _turns_between(wanted, commanded)
    if not abs(measured - commanded) > FOLLOWING:
        return wanted - commanded
    nearest = max(wanted, min(commanded, measured))
    return wanted - min(nearest, max(commanded, measured))


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
        left = _left(arm, i) - arm.period * log.dq[i]
        kind = float(LimitKind.ACCELERATION if limits.acceleration[i] < np.inf else LimitKind.JERK)
        if abs(log.dq[i]) >= limits.velocity[i] * (1.0 - FOLLOWING):
            kind = float(LimitKind.VELOCITY)
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


@compiled
def separation_of(plan: ArmPlan, memory: Vector) -> Vector3:
    """Find the nearest link and body, as `nearest_body`, where an arm's last command starts from.

    Without bodies of bounded speed the separation is inf.
    """
    arm = arm_state(plan, memory)
    if plan.separation < 0 or not arm.has_begun:
        return np.inf, 0.0, 0.0
    base = plan.step.arrays
    q = motion_of(plan, arm).q
    jacobian = np.empty((q.size, 6))
    placements = np.empty((base.placements.shape[0], 12))
    write_kinematics(plan.robot, q, jacobian, placements, base.inertia)
    constants = block_constants(base, plan.separation).copy()
    write_bodies(constants, arm.bodies, arm.seen.age)
    grow_older(separation_views(constants).bodies, -arm.period)
    head = separation_views(constants).head
    head.age -= arm.period
    return nearest_body(constants, placements)


@compiled
def margin_of(plan: ArmPlan, memory: Vector) -> tuple[float, float]:
    """Compute the `Margin` of an arm at the joint positions that its last command starts from."""
    arm = arm_state(plan, memory)
    q = motion_of(plan, arm).q
    limits = motion_constants(plan.step.arrays)
    joint = np.inf
    for i in range(q.size):
        joint = min(joint, min(q[i] - limits.lower[i], limits.upper[i] - q[i]))
    distance = np.inf
    if plan.scene >= 0:
        base = plan.step.arrays
        jacobian = np.empty((q.size, 6))
        placements = np.empty((base.placements.shape[0], 12))
        write_kinematics(plan.robot, q, jacobian, placements, base.inertia)
        constants = block_constants(base, plan.scene).copy()
        _place_obstacles(plan, arm, arm.time - arm.period, constants)
        scene = scene_views(constants)
        distances = np.empty(len(scene.pairs))
        write_distances(constants, placements, distances)
        for k in range(distances.size):
            distance = min(distance, distances[k] - scene.head.least)
    return joint, distance


@compiled
def frame_at(plan: ArmPlan, q: Vector, placement: Vector, jacobian: Matrix) -> None:
    """Write where the frame of a shield's twists is at joint positions, and its Jacobian.

    Args:
        plan: Layout of the step.
        q: Joint positions, (n,).
        placement: `Placement` of the frame, (12,), overwritten.
        jacobian: Its linear over angular rows, (6, n), overwritten.
    """
    base = plan.step.arrays
    twists = np.empty((q.size, TWIST))
    placements = np.empty((base.placements.shape[0], placement.size))
    write_kinematics(plan.robot, q, twists, placements, base.inertia)
    frame = RequestConstants.of(block_constants(base, plan.request)).frame
    copied(placement, placements[frame])
    twist_rows(twists, placements, base.support, frame, jacobian)


@compiled
def torque_of(plan: ArmPlan, memory: Vector) -> float:
    """Compute the `torque_margin` of an arm's last command; inf without limits of torques."""
    arm = arm_state(plan, memory)
    if plan.torque < 0 or not arm.has_begun:
        return np.inf
    motion = motion_of(plan, arm)
    constants = block_constants(plan.step.arrays, plan.torque)
    return torque_margin(constants, motion.q, motion.before, motion.last, arm.period)


@compiled
def stopping_time_of(plan: ArmPlan, memory: Vector) -> float:
    """Compute the time of the stopping motion from an arm's last command [s]."""
    arm = arm_state(plan, memory)
    motion = motion_of(plan, arm)
    dt = motion.spacing
    limits = motion_constants(plan.step.arrays)
    periods = least_periods(motion.last, motion.before, limits, dt, False)
    return dt * max(periods, 1.0 if largest_entry(motion.last) > 0.0 else 0.0)
