"""A scheme's parts laid out as the blocks of one program, and the compiled call that writes them.

`Layout` states once, for a scheme and a robot, which rows belong to which part. `assemble` then
writes a whole program into one `QP.data` array; parts without a compiled form are asked afterwards
(`iiwa_dnn.schemes.filling`) and write into the same array.
"""

from collections.abc import Callable, Sequence
from itertools import accumulate, pairwise
from typing import NamedTuple

import numpy as np
from numba import types

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.compiling import MATRIX, VECTOR, Signature
from iiwa_dnn.qp.layout import compiled, offsets
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes.acceleration import check_parts, damping_of
from iiwa_dnn.schemes.collisions import COLLISION, collision_rows
from iiwa_dnn.schemes.costs import (
    CYCLIC_MOTION,
    KINETIC_ENERGY,
    KineticEnergy,
    add_cyclic_motion,
    add_kinetic_energy,
)
from iiwa_dnn.schemes.limits import JOINT_LIMITS, joint_limits
from iiwa_dnn.schemes.motion_limits import MOTION_LIMITS, MotionLimits, merged, motion_limits
from iiwa_dnn.schemes.parts import CUSTOM, TARGET_SIZE, Codes, Cost, Limit, Part, Task
from iiwa_dnn.schemes.tasks import (
    ORIENTATION_BLOCK,
    ORIENTATION_SO3,
    POSITION,
    block_rows,
    position_rows,
    so3_rows,
)

HEADER, BLOCK = 11, 8
"""Entries of the codes' head (n, m, p, joints, blocks, frame, inertia; four entries that
`control.plan` fills in) and of each block (the last is the address of its function, or 0)."""

_COLLISION = Signature(
    types.void, VECTOR, *5 * [types.int64], VECTOR, types.int64, MATRIX, MATRIX, types.float64
)
_MOTION = Signature(
    types.void, VECTOR, *3 * [types.int64], VECTOR, types.int64, VECTOR, VECTOR, types.float64
)
_BLOCK = Signature(
    types.void, VECTOR, *3 * [types.int64], types.int64[::1], types.int64, types.float64,
    MATRIX, VECTOR, VECTOR, types.int64,
)  # fmt: skip
_enter_collision, _enter_motion, _enter_block = _COLLISION.enter, _MOTION.enter, _BLOCK.enter
_APART: dict[int, tuple[Signature, Callable[..., None]]] = {
    COLLISION: (_COLLISION, collision_rows),
    MOTION_LIMITS: (_MOTION, motion_limits),
    ORIENTATION_BLOCK: (_BLOCK, block_rows),
}


class Block(NamedTuple):
    """Rows of one part.

    Attributes:
        part: The part.
        start: Its first row among the program's equality or inequality rows.
        rows: How many rows it has; none for a cost.
    """

    part: Part
    start: int
    rows: int


class Layout:
    """Blocks of a program, for one scheme and one robot of `dof` joints.

    Attributes:
        robot: The robot.
        sizes: ``(n, m, p)`` of the program.
        blocks: The parts in the order costs, tasks, limits.
        target_frames: Names of the frames that tasks track, in the order of the targets' array;
            the tip's where none does.
        frames: Names of all frames that parts name.
        codes: What compiled code reads of the layout: head, joints that move each frame, blocks.
        numbers: Constants of the compiled parts, one after the other.
        moving: Limits with constants that change along a run, each with their place in `numbers`.
        custom: Blocks of parts without a compiled form.
        needs_inertia: Whether a part asks for the inertia matrix.
        restrained: Whether a limit asks for the last commands.
        culprits: Names of parts, for a run's settings, where they are not the usual ones:
            ``bounding``, limits with bounds, and ``own_tasks``, tasks of one's own.
        row_weights: Weight of each equality row where a policy lets the tasks yield, (p,).
        priorities: Level of each equality row, (p,); 0 for one that has to hold.
        ahead: Names of the frames whose tasks track the next target.
        needs_period: Whether a program needs a control period.
        damping: `damping_of` at the acceleration level, (6 frames,); empty at the velocity level.
    """

    def __init__(
        self,
        robot: Robot,
        costs: Sequence[Cost],
        tasks: Sequence[Task],
        limits: Sequence[Limit],
        slack: int,
        accelerates: bool = False,
    ) -> None:
        """Lay the parts out.

        Raises:
            NotFoundError: A part names a frame that the robot does not have.
            InvalidInputError: A parameter of a part does not fit the robot.
        """
        if accelerates:
            check_parts(costs, tasks)
        for limit in limits:
            own = type(limit).inequalities is not Limit.inequalities
            if own and limit.row_count(robot) < 1:
                raise InvalidInputError(type(limit).__name__, "has inequalities but no rows", limit)
        self.robot = robot
        self.culprits = _culprits(robot, tasks, limits)
        limits = merged(limits)
        hard = [task for task in tasks if task.weight is None]
        soft = [task for task in tasks if task.weight is not None]
        bounding = [(limit, limit.row_count(robot)) for limit in limits]
        self.blocks = (
            *(Block(cost, 0, 0) for cost in costs),
            *_stacked([(part, part.rows) for part in hard]),
            *(Block(task, 0, task.rows) for task in soft),
            *_stacked(bounding),
        )
        m, p = sum(rows for _, rows in bounding), sum(task.rows for task in hard)
        self.sizes = (robot.dof + slack, m, p)
        self.custom = tuple(block for block in self.blocks if block.part.kind == CUSTOM)
        self.row_weights = np.repeat([t.row_weight for t in hard], [t.rows for t in hard])
        self.priorities = np.repeat([t.priority or 0 for t in hard], [t.rows for t in hard])
        self.restrained = any(isinstance(limit, MotionLimits) for limit in limits)
        self.needs_inertia = any(
            isinstance(cost, KineticEnergy) and cost.kinetic == "inertia" for cost in costs
        )
        names = dict.fromkeys(task.frame_name(robot) for task in tasks if task.tracks)
        # The tip first, where it is tracked: the record's first frame.
        self.target_frames = tuple(sorted(names, key=lambda name: name != robot.tip)) or (
            robot.tip,
        )
        more = [name for limit in limits for name in limit.extra_frames(robot)]
        self.frames = tuple(dict.fromkeys([robot.tip, *self.target_frames, *more]))
        tracked = {(task.frame_name(robot), task.tracking) for task in tasks if task.tracks}
        self.ahead = frozenset(name for name, tracking in tracked if tracking == "next")
        self.needs_period = accelerates or any(task.tracking == "next" for task in tasks)
        by_name = [(task.frame_name(robot), task) for task in tasks]
        self.damping: Vector = (
            damping_of(self.target_frames, by_name) if accelerates else np.zeros(0)
        )
        if len(tracked) > len(names):
            problem = f"must be the same of all tasks of a frame: {sorted(tracked)}"
            raise InvalidInputError("tracking", problem)
        self._encode()

    def _encode(self) -> None:
        """Write `codes` and `numbers`."""
        from iiwa_dnn.robot.kinematics import Kinematics

        compiled = [block for block in self.blocks if block.part.kind != CUSTOM]
        constants = [block.part.numbers(self.robot) for block in compiled]
        if self.damping.size:  # `iiwa_dnn.schemes.acceleration`: the gain of a task, squared
            for block, gains in zip(compiled, constants, strict=True):
                gains[0] **= 1 + isinstance(block.part, Task)
        starts = [0, *accumulate(map(len, constants))]
        self.numbers: Vector = np.concatenate([np.zeros(0), *constants])
        self.moving = [
            (block.part, slice(start, stop))
            for block, (start, stop) in zip(compiled, pairwise(starts), strict=True)
            if isinstance(block.part, Limit) and block.part.moves
        ]
        dof, count = self.robot.dof, len(compiled)
        kinematics = Kinematics(self.robot, self.frames)
        first = self.robot.frame_id(self.target_frames[0])
        head = [*self.sizes, dof, count, first, int(self.needs_inertia), 0, 0, 0, 0]
        blocks: list[int] = []
        for block, at in zip(compiled, starts, strict=False):
            name = block.part.frame_name(self.robot)
            frame = self.frames.index(name) if name in self.frames else 0
            target = self.target_frames.index(name) if name in self.target_frames else 0
            soft = isinstance(block.part, Task) and block.part.weight is not None
            support = HEADER + BLOCK * count + dof * frame
            place = kinematics.frame_ids[frame]
            blocks += [block.part.kind, block.start, -block.rows if soft else block.rows]
            apart = _APART.get(block.part.kind)
            address = 0 if apart is None else apart[0].address(apart[1])
            blocks += [place, support, TARGET_SIZE * target, at, address]
        moves = [kinematics.support(index) for index in kinematics.frame_ids]
        self.codes: Codes = np.concatenate([np.array(head + blocks, dtype=np.int64), *moves])
        weights = [
            0.0 if not isinstance(b.part, Task) or b.part.weight is None else b.part.weight
            for b in compiled
        ]
        # The weights of soft tasks come last, one for each block.
        self.numbers = np.concatenate([self.numbers, weights])

    @property
    def size(self) -> int:
        """Size of the program's `QP.data`."""
        n, m, p = self.sizes
        return (n + m + p) * (n + 1) + 2 * n

    def row_names(self) -> list[dict[str, object]]:
        """Return for each inequality row its part, its number in it from 1, and its name if any."""
        found: list[dict[str, object]] = []
        for block in self.blocks:
            if isinstance(block.part, Limit):
                names = block.part.row_names(self.robot)
                for i in range(block.rows):
                    about = {"about": names[i]} if names else {}
                    found.append({"part": type(block.part).__name__, "row": i + 1} | about)
        return found


def _culprits(robot: Robot, tasks: Sequence[Task], limits: Sequence[Limit]) -> dict[str, list[str]]:
    """Name limits with bounds, unless `JointLimits` alone, and tasks that are not the package's."""
    bounding = [
        type(limit).__name__
        for limit in limits
        if type(limit).bounds is not Limit.bounds or (limit.kind and not limit.row_count(robot))
    ]
    own = [type(task) for task in tasks if not type(task).__module__.startswith("iiwa_dnn.")]
    named = {} if bounding == ["JointLimits"] else {"bounding": bounding}
    return named | ({"own_tasks": [kind.__name__ for kind in own]} if own else {})


def _stacked(parts: Sequence[tuple[Part, int]]) -> list[Block]:
    """Blocks of parts whose rows stand one after the other."""
    starts = accumulate((rows for _, rows in parts), initial=0)
    return [Block(part, start, rows) for (part, rows), start in zip(parts, starts, strict=False)]


@compiled
def assemble(
    data: Vector, codes: Codes, numbers: Vector, q: Vector, jacobian: Matrix, placements: Matrix,
    inertia: Vector, targets: Vector, rate: float, past: Vector,
) -> None:  # fmt: skip
    """Write a program into `data`, without the rows of parts that have no compiled form.

    The functions of the parts get n, the number of variables, dof, that of the joints, which are
    the first ones, and `at`, the place of their own constants in `numbers`.

    Args:
        data: The program, laid out as `QP.data`, (size,).
        codes: `Layout.codes`.
        numbers: `Layout.numbers`, (c,).
        q: Joint positions [rad], (dof,).
        jacobian: `Kinematics.jacobian`, (dof, 6).
        placements: `Kinematics.placements`, (frames, 12).
        inertia: Joint-space inertia matrix row by row, (dof dof), where a cost takes it.
        targets: One `Target.data` after the other, (18 frames,).
        rate: 1 / dt [1/s]; inf where there is no control period.
        past: The last command and the one before [rad/s], (2 dof,).
    """
    n, m, p, dof, blocks = codes[0], codes[1], codes[2], codes[3], codes[4]
    _, _, at_A, at_lb = offsets(n, m, p)
    at_b = at_lb - p
    for i in range(at_lb):
        data[i] = 0.0
    for i in range(n):
        data[at_lb + i] = -np.inf
        data[at_lb + n + i] = np.inf
    for k in range(blocks):
        block = HEADER + BLOCK * k
        kind, start, rows = codes[block], codes[block + 1], codes[block + 2]
        at, address = codes[block + 6], codes[block + 7]
        if kind == KINETIC_ENERGY:
            add_kinetic_energy(data, n, dof, numbers, at, inertia)
        elif kind == CYCLIC_MOTION:
            add_cyclic_motion(data, n, dof, numbers, at, q)
        elif kind == JOINT_LIMITS:
            joint_limits(data, at_lb, n, dof, numbers, at, q, rate)
        elif kind == MOTION_LIMITS:
            _enter_motion(address, data, at_lb, n, dof, numbers, at, q, past, rate)
        elif kind == COLLISION:
            at_G = n * n + n + start * n
            at_h = n * n + n + m * n + start
            _enter_collision(
                address, data, at_G, at_h, n, dof, rows, numbers, at, jacobian, placements, rate
            )
        else:
            count = abs(rows)
            if rows > 0:
                out, A, b = data, at_A + start * n, at_b + start
            else:
                out, A, b = np.zeros(count * (n + 1)), 0, count * n
            place, support = placements[codes[block + 3]], codes[block + 4]
            target = codes[block + 5]
            gain, period = numbers[at], 0.0
            if numbers[at + 1] != 0.0:
                gain, period = min(gain, rate), rate
            if kind == POSITION:
                position_rows(out, A, b, n, codes, support, gain, jacobian, place, targets, target)
            elif kind == ORIENTATION_SO3:
                so3_rows(
                    out, A, b, n, codes, support, gain, jacobian, place, targets, target, period
                )
            elif kind == ORIENTATION_BLOCK:
                _enter_block(
                    address, out, A, b, n, codes, support, gain, jacobian, place, targets, target
                )
            if rows < 0:
                _add_soft(data, n, out, count, numbers[numbers.size - blocks + k])


ASSEMBLE = Signature(
    types.void, VECTOR, types.int64[::1], VECTOR, VECTOR, MATRIX, MATRIX, VECTOR, VECTOR,
    types.float64, VECTOR,
)  # fmt: skip


@compiled
def _add_soft(data: Vector, n: int, soft: Vector, rows: int, weight: float) -> None:
    """Add weight A^T A to P and -weight A^T b to q; `soft` holds A row by row, then b."""
    for k in range(rows):
        for i in range(n):
            scaled = weight * soft[k * n + i]
            data[n * n + i] -= scaled * soft[rows * n + k]
            for j in range(n):
                data[i * n + j] += scaled * soft[k * n + j]
