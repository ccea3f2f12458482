"""Kernels that test whether a plan that was read holds together, and count what its steps take.

Sizes have to agree and indices to lie within their arrays, so that no step on the plan leaves them.
Constants of parts are tested where they say sizes or indices themselves: those of collisions and of
separation. That the others are those of their parts is what a digest of the tables vouches for.
"""

from __future__ import annotations

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp import Vector
from iiwa_dnn.references.targets import TargetData
from iiwa_dnn.robot.kinematics_kernel import ModelTables
from iiwa_dnn.schemes.joint_limits import motion_constants
from iiwa_dnn.schemes.program import BlockKind, Column, ProgramArrays, ProgramSizes, block_constants
from iiwa_dnn.schemes.scene import Body, Pair, SceneHead, scene_views
from iiwa_dnn.schemes.separation import (
    FREE_BODY,
    SeparationHead,
    WatchedLink,
    separation_views,
)
from iiwa_dnn.schemes.step import TARGET_SIZE
from iiwa_dnn.step.fallback import Yielding
from iiwa_dnn.step.log import log_sizes
from iiwa_dnn.step.memory import ArmPlan
from iiwa_dnn.step.plan import ControlPlan, PathColumn
from iiwa_dnn.step.requests import RequestConstants
from iiwa_dnn.step.samples import ALONE, OF_JOINT, samples_of

MOST = 1000
"""Largest size of a plan: joints, rows, frames, pairs."""

LARGEST_NUMBER = 1e9
"""Largest number of a record that holds integers: beyond the range of those, C leaves open what
they are."""

COUNTS = 4
"""Numbers at the end of a `SeparationHead` that are integers; others may be infinite."""

LOG = 20
MOTION = 5
LINK = 12
"""Numbers of `StepLog`, `MotionState`, `WatchedLink` beside those of the sizes that they state."""


@compiled
def arm_scratch(plan: ArmPlan) -> int:
    """Count the numbers that a call takes for itself: twice what the package's kernels do."""
    base = plan.step.arrays
    n = base.sizes.n
    taken = 8 * n * (n + base.sizes.m + base.sizes.p + 10) + 2 * plan.width
    taken += 2 * (base.constants.size + base.inertia.size + plan.step.network.settings.numbers.size)
    taken += 2 * (10 * n + samples_of(n, plan.sizes.following))
    return taken + 12 * (base.placements.shape[0] + 4 * n)


@compiled
def arm_fits(plan: ArmPlan, collisions: int, separation: int, torque: int) -> bool:
    """Test whether the plan of a shield or a controller holds together.

    Args:
        plan: The plan.
        collisions: Number of the kernel of collisions.
        separation: Number of that of separation.
        torque: Number of that of torques.
    """
    if not _control_fits(plan.step, plan.robot, collisions, separation) or not _state_fits(plan):
        return False
    own = plan.sizes
    if not _networks_fit(plan.step, own.network, own.fallback):
        return False
    if not _is_kernel(plan, plan.torque, torque):
        return False
    return _parts_fit(plan, collisions) and _bodies_seen_fit(plan, separation)


@compiled
def _is_kernel(plan: ArmPlan, number: int, kernel: int) -> bool:
    """Test whether a block of the program is that of a kernel, or its number is -1."""
    table = plan.step.arrays.table
    if number == -1:
        return True
    return _is_within(number, 0, len(table)) and table[number, Column.ADDRESS] == kernel


@compiled
def _state_fits(plan: ArmPlan) -> bool:
    """Test the sizes of an arm's state."""
    sizes = plan.step.arrays.sizes
    own = plan.sizes
    n = sizes.joints
    if own.n != n or not _requests_fit(plan):
        return False
    if own.motion != _motion_width(sizes) or own.limiting != sizes.n + sizes.m:
        return False
    if own.obstacles != len(plan.velocities) or not _is_within(own.sent, 0, MOST * (1 + n)):
        return False
    return own.sent % (1 + n) == 0 and _samples_fit(plan)


@compiled
def _requests_fit(plan: ArmPlan) -> bool:
    """Test the room for requests, which a shield's arms have alone."""
    own = plan.sizes
    if plan.request < 0:
        return own.request == 0 and own.twist_fallback == 0
    is_one = plan.step.arrays.sizes.frames == 1
    return is_one and own.request == max(own.n, 6) and own.twist_fallback == own.fallback


@compiled
def _samples_fit(plan: ArmPlan) -> bool:
    """Test the room for samples that are followed, four at least for a stream."""
    n = plan.sizes.n
    width = plan.sizes.following
    if width == 0 or plan.request < 0:
        return width == 0
    m = samples_of(n, width)
    return _is_within(m, 4, MOST) and width == ALONE + OF_JOINT * n + m * (2 + 3 * n)


@compiled
def _is_within(index: int, first: int, end: int) -> bool:
    """Test whether an index is one from `first` to the one before `end`."""
    return first <= index and index < end


@compiled
def _are_bounded(numbers: Vector) -> bool:
    """Test whether the numbers of a record may be read as integers."""
    outside = 0
    for i in range(numbers.size):
        outside += not abs(numbers[i]) <= LARGEST_NUMBER
    return outside == 0


@compiled
def _motion_width(sizes: ProgramSizes) -> int:
    """Count the numbers of a `MotionState`."""
    return MOTION + 4 * sizes.joints + sizes.pairs


@compiled
def _control_fits(plan: ControlPlan, robot: ModelTables, collisions: int, separation: int) -> bool:
    """Test the layout of a control step."""
    arrays = plan.arrays
    if not _sizes_fit(arrays.sizes) or not _arrays_fit(arrays) or not _model_fits(robot, arrays):
        return False
    for k in range(len(arrays.table)):
        if not _row_fits(arrays, k):
            return False
        constants = block_constants(arrays, k)
        kernel = arrays.table[k, Column.ADDRESS]
        if kernel == collisions and not _scene_fits(constants, arrays):
            return False
        if kernel == separation and not _separation_fits(constants, arrays):
            return False
    return _yielding_fits(plan.yielding, arrays) and _paths_fit(plan)


@compiled
def _sizes_fit(sizes: ProgramSizes) -> bool:
    """Test the sizes of programs."""
    if not _is_within(sizes.joints, 1, sizes.n + 1) or not _is_within(sizes.n, 1, MOST):
        return False
    if not _is_within(sizes.m, 0, MOST) or not _is_within(sizes.p, 0, MOST):
        return False
    return _is_within(sizes.pairs, 0, MOST) and _is_within(sizes.frames, 1, MOST)


@compiled
def _arrays_fit(arrays: ProgramArrays) -> bool:
    """Test the shapes of the arrays from which programs are assembled."""
    n = arrays.sizes.joints
    frames = len(arrays.placements)
    if not _is_within(frames, 1, MOST) or not _is_within(arrays.tip, 0, frames):
        return False
    if arrays.placements.shape[1] != 12 or arrays.table.shape[1] != 8:
        return False
    if len(arrays.support) != frames or arrays.support.shape[1] != n:
        return False
    return arrays.inertia.size == 0 or arrays.inertia.size == n * n


@compiled
def _row_fits(arrays: ProgramArrays, k: int) -> bool:
    """Test the row of part k in the table of parts."""
    entry = arrays.table[k]
    kind = entry[Column.KIND]
    rows = arrays.sizes.m
    more = 0
    if kind == BlockKind.TASK:
        rows = arrays.sizes.p
    elif kind == BlockKind.SOFT_TASK:
        more = 1  # the weight
    if entry[Column.ADDRESS] <= 0:  # no kernel
        return False
    if not _is_within(entry[Column.ROWS], 0, MOST) or not _is_within(entry[Column.FIRST], 0, MOST):
        return False
    fills = kind == BlockKind.TASK or kind == BlockKind.LIMIT
    if fills and entry[Column.FIRST] + entry[Column.ROWS] > rows:
        return False
    if not _is_within(entry[Column.TARGET], 0, arrays.sizes.frames):
        return False
    stop = entry[Column.STOP]
    return _is_within(stop, 0, arrays.constants.size + 1 - more) and _is_within(
        entry[Column.START], 0, stop + 1
    )


@compiled
def _model_fits(robot: ModelTables, arrays: ProgramArrays) -> bool:
    """Test the tables of the robot."""
    n = arrays.sizes.joints
    frames = len(arrays.placements)
    if robot.parents.size != n or robot.joints.size != 12 * n or robot.joints.shape[1] != 12:
        return False
    if robot.slides.size != n or robot.carriers.size != robot.frames.size:
        return False
    if len(robot.offsets) != robot.frames.size or robot.offsets.shape[1] != 12:
        return False
    if not _bodies_fit(robot, arrays):
        return False
    for i in range(n):
        if not _is_within(robot.parents[i], 0, i + 1):
            return False
    return _frames_fit(robot, frames)


@compiled
def _bodies_fit(robot: ModelTables, arrays: ProgramArrays) -> bool:
    """Test the tables of what the joints carry, which are empty without the inertia matrix."""
    n = arrays.sizes.joints
    if len(robot.bodies) == 0:
        return True
    if len(robot.bodies) != n or robot.bodies.shape[1] != 18 or arrays.inertia.size != n * n:
        return False
    return len(robot.supports) == n and robot.supports.shape[1] == n and robot.armature.size == n


@compiled
def _frames_fit(robot: ModelTables, frames: int) -> bool:
    """Test the indices of the robot's frames, of which there are `frames`."""
    n = robot.parents.size
    for k in range(robot.frames.size):
        if not _is_within(robot.frames[k], 0, frames) or not _is_within(
            robot.carriers[k], 0, n + 1
        ):
            return False
    return True


@compiled
def _yielding_fits(own: Yielding, arrays: ProgramArrays) -> bool:
    """Test the constants of fallback programs and stopping motions."""
    n = arrays.sizes.joints
    parts = len(arrays.table)
    if own.weights.size != arrays.sizes.p or parts == 0:
        return False
    if motion_constants(arrays).slope.size != n:
        return False
    outside = 0
    for k in range(own.rests.size):
        outside += not _is_within(own.rests[k], 0, parts)
    return outside == 0


@compiled
def _scene_fits(constants: Vector, arrays: ProgramArrays) -> bool:
    """Test the constants of a scene: bodies in frames, and pairs of bodies."""
    n = arrays.sizes.joints
    if constants.size < SceneHead.width():
        return False
    if not _are_bounded(constants[: SceneHead.width()]):
        return False
    head = SceneHead.of(constants[: SceneHead.width()])
    if not _is_within(head.bodies, 0, MOST) or not _is_within(head.pairs, 0, MOST):
        return False
    tables = Body.width() * head.bodies + head.pair_size * head.pairs
    if head.pair_size < 0 or constants.size != SceneHead.width() + tables:
        return False
    if not _is_within(head.first, 0, arrays.sizes.pairs + 1 - head.pairs):
        return False
    scene = scene_views(constants)
    fit = True
    for k in range(head.bodies):
        body = Body.of(scene.bodies[k])
        fit = fit and _body_fits(body, len(arrays.placements))
    for k in range(head.pairs):
        pair = Pair.of(scene.pairs[k])
        fit = fit and _pair_fits(pair, n, head.bodies)
    return fit


@compiled
def _body_fits(body: Body, frames: int) -> bool:
    """Test a body by the number of frames."""
    return _are_bounded(body.numbers) and _is_within(body.frame, 0, frames)


@compiled
def _pair_fits(pair: Pair, joints: int, bodies: int) -> bool:
    """Test a pair of bodies by the numbers of joints and of bodies."""
    if pair.radii.size != joints or not _are_bounded(pair.numbers):
        return False
    return _is_within(pair.first, 0, bodies) and _is_within(pair.second, 0, bodies)


@compiled
def _separation_fits(constants: Vector, arrays: ProgramArrays) -> bool:
    """Test the constants of a separation from bodies of bounded speed: links in frames."""
    if constants.size < SeparationHead.width():
        return False
    counts = SeparationHead.width() - COUNTS
    if not _are_bounded(constants[counts : SeparationHead.width()]):
        return False
    head = SeparationHead.of(constants[: SeparationHead.width()])
    if not _is_within(head.bodies, 0, MOST) or not _is_within(head.links, 0, MOST):
        return False
    if not _is_within(head.people, 0, head.bodies + 1):
        return False
    if head.link_size != LINK + 2 * arrays.sizes.joints:
        return False
    tables = head.link_size * head.links + FREE_BODY * head.bodies
    if constants.size != SeparationHead.width() + tables:
        return False
    own = separation_views(constants)
    outside = 0
    for k in range(head.links):
        link = WatchedLink.of(own.links[k])
        bounded = _are_bounded(own.links[k])
        outside += not (bounded and _is_within(link.frame, 0, len(arrays.placements)))
    return outside == 0


@compiled
def _bodies_seen_fit(plan: ArmPlan, separation: int) -> bool:
    """Test the part of a shield that bodies of bounded speed are written into."""
    arrays = plan.step.arrays
    if plan.separation == -1:
        return plan.sizes.bodies == 0
    if not _is_kernel(plan, plan.separation, separation):
        return False
    constants = block_constants(arrays, plan.separation)
    head = SeparationHead.of(constants[: SeparationHead.width()])
    return plan.sizes.bodies == head.bodies


@compiled
def _paths_fit(plan: ControlPlan) -> bool:
    """Test the table of paths: none, or one for each frame."""
    table = plan.paths.table
    if (len(table) > 0 and len(table) != plan.arrays.sizes.frames) or table.shape[1] != 4:
        return False
    for k in range(len(table)):
        start = table[k, PathColumn.START]
        stop = table[k, PathColumn.STOP]
        if not _is_within(stop, 0, plan.paths.constants.size + 1):
            return False
        if not _is_within(start, 0, stop + 1 - TargetData.width()):
            return False
    return True


@compiled
def _networks_fit(plan: ControlPlan, network: int, fallback: int) -> bool:
    """Test the lengths of the states of networks."""
    sizes = plan.arrays.sizes
    whole = sizes.n + sizes.m + sizes.p
    if fallback != 6 * sizes.n + 2 * sizes.m + 2 * sizes.p + 3 or plan.fallback.size != fallback:
        return False
    return _is_within(network, 0, 4 * whole + 1)


@compiled
def _log_width(sizes: ProgramSizes) -> int:
    """Count the numbers of a `StepLog`."""
    joints, rows, program, point, sides, pairs, frames = log_sizes(sizes)
    return LOG + 9 * joints + rows + program + point + sides + pairs + TARGET_SIZE * frames


@compiled
def _parts_fit(plan: ArmPlan, collisions: int) -> bool:
    """Test the parts that a step writes into: a shield's request, and the scene."""
    arrays = plan.step.arrays
    parts = len(arrays.table)
    if plan.width != _log_width(arrays.sizes) or plan.velocities.shape[1] != 3:
        return False
    if not _is_within(plan.request, -1, parts) or not _is_within(plan.scene, -1, parts):
        return False
    if plan.request >= 0 and not _request_fits(plan):
        return False
    if plan.scene < 0:
        return plan.sizes.obstacles == 0
    scene = block_constants(arrays, plan.scene)
    if arrays.table[plan.scene, Column.ADDRESS] != collisions:
        return False
    head = SceneHead.of(scene[: SceneHead.width()])
    return plan.sizes.obstacles <= head.bodies


@compiled
def _request_fits(plan: ArmPlan) -> bool:
    """Test the part that a shield writes its request into."""
    arrays = plan.step.arrays
    constants = block_constants(arrays, plan.request)
    request = RequestConstants.of(constants)
    if not _are_bounded(constants) or request.velocity.size != plan.sizes.request:
        return False
    return _is_within(request.frame, 0, len(arrays.placements))
