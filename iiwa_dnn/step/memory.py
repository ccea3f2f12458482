"""Memory of an arm: sizes, settings and state, and what is written into it between steps."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.dense import all_finite
from iiwa_dnn.qp.layout import copied
from iiwa_dnn.robot.kinematics_kernel import ModelTables
from iiwa_dnn.schemes.program import block_constants
from iiwa_dnn.schemes.scene import Body, scene_views
from iiwa_dnn.schemes.separation import (
    FREE_BODY,
    FreeBody,
    separation_views,
)
from iiwa_dnn.step.bodies import (
    grow_older,
    is_newer,
    take_body,
    take_people,
)
from iiwa_dnn.step.plan import ControlPlan
from iiwa_dnn.step.requests import (
    Reason,
)
from iiwa_dnn.step.samples import (
    FollowState,
    have_meaning,
    keep_samples,
    samples_of,
)
from iiwa_dnn.step.state import MotionState


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
def tracks(plan: ArmPlan) -> bool:
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
    arm.reason = Reason.NONE if tracks(plan) else Reason.NO_REQUEST
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
def sent_command(arm: ArmState, k: int) -> SentCommand:
    """View the command that was sent k commands before the last one."""
    width = 1 + arm.positions.size
    return SentCommand.of(arm.sent[k * width : (k + 1) * width])


@compiled
def grow_all_older(arm: ArmState, seconds: float) -> None:
    """Add seconds to the age of all that was seen."""
    arm.seen.age += seconds
    grow_older(arm.bodies, seconds)


@compiled
def place_obstacles(plan: ArmPlan, arm: ArmState, t: float, constants: Vector) -> None:
    """Write the centres of the obstacles at time t [s] into the constants (k,) of a scene."""
    bodies = scene_views(constants).bodies
    first = len(bodies) - len(arm.obstacles)
    for k in range(len(arm.obstacles)):
        body = Body.of(bodies[first + k])
        for i in range(body.center.size):
            body.center[i] = arm.obstacles[k, i] + t * plan.velocities[k, i]
