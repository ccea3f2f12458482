"""The step program: a scheme laid out for a robot, once, as named views.

`StepProgram` states which rows belong to which part. `assemble` writes all rows in one compiled
call, each part by its own kernel; parts written in numpy are asked afterwards
(`iiwa_dnn.schemes.filling`). This is the only file that knows where a constant lies.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.checks import read_only
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import QP, Matrix, Vector
from iiwa_dnn.qp.compiling import Signature, borrowed
from iiwa_dnn.qp.layout import QPViews, compiled, inlined, qp_views
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.kinematics import Kinematics
from iiwa_dnn.schemes.collisions import CollisionAvoidance
from iiwa_dnn.schemes.costs import KineticEnergy
from iiwa_dnn.schemes.filling import fill
from iiwa_dnn.schemes.joint_tasks import couplings
from iiwa_dnn.schemes.motion_limits import MotionLimits, merged
from iiwa_dnn.schemes.parts import COST, LIMIT, TASK, Cost, Limit, Part, Task
from iiwa_dnn.schemes.scene import BRAKED
from iiwa_dnn.schemes.step import Step, StepViews

if TYPE_CHECKING:
    from iiwa_dnn.schemes.base import Scheme

Table = NDArray[np.int64]
"""What compiled code reads of a step program: the head, then a row of `_Entry` for each part."""


class ProgramArrays(NamedTuple):
    """Arrays with which compiled code writes programs.

    Attributes:
        table: `StepProgram.table`.
        constants: `StepProgram.constants`, (k,).
        jacobian: `Kinematics.jacobian`, (dof, 6).
        placements: `Kinematics.placements`, (frames, 12).
        moves: `Kinematics.moves`, (frames, dof).
        inertia: `Kinematics.inertia`, (dof, dof).
        rate: Inverse of the control period [1/s]; inf outside of a loop.
    """

    table: Table
    constants: Vector
    jacobian: Matrix
    placements: Matrix
    moves: Matrix
    inertia: Matrix
    rate: float


class _Head(NamedTuple):
    """First row of a table."""

    n: int
    m: int
    p: int
    dof: int
    parts: int
    tip: int
    unused: int = 0
    unused_too: int = 0


class _Entry(NamedTuple):
    """Row of a table for one part with a kernel."""

    kind: int
    address: int
    first: int
    rows: int
    start: int
    stop: int
    target: int
    unused: int = 0


_COST, _TASK, _SOFT, _LIMIT = range(4)


class Block(NamedTuple):
    """Rows of one part.

    Attributes:
        part: The part.
        first: Its first row among the program's equality or inequality rows.
        rows: Number of its rows; none for a cost.
    """

    part: Part
    first: int
    rows: int


class StepProgram:
    """A scheme laid out for a robot of `dof` joints.

    Attributes:
        robot: The robot.
        scheme: The scheme.
        blocks: The parts in the order costs, tasks, limits.
        sizes: ``(n, m, p)`` of the programs.
        target_frames: Names of the frames that tasks track, in the order of the targets; the
            tip's if no task tracks one.
        kinematics: The robot's, overwritten by each step.
        table: What compiled code reads of the layout, (1 + parts, 8).
        constants: Numbers that compiled code reads, (k,).
    """

    def __init__(self, robot: Robot, scheme: Scheme) -> None:
        """Lay a scheme's parts out for a robot.

        Raises:
            NotFoundError: A part names a frame that the robot does not have.
            InvalidInputError: A parameter of a part does not fit the robot.
        """
        self.robot = robot
        self.scheme = scheme
        tasks: list[Task] = [*scheme.tasks, *couplings(robot)]
        _check_rows(robot, scheme.limits)
        self.target_frames = _tracked(robot, tasks)
        hard = [task for task in tasks if task.weight is None]
        soft = [task for task in tasks if task.weight is not None]
        rows_of_tasks = _stacked(robot, hard)
        rows_of_limits = _stacked(robot, merged(scheme.limits))
        self.blocks = (
            *(Block(cost, 0, 0) for cost in scheme.costs),
            *rows_of_tasks,
            *(Block(task, 0, task.row_count(robot)) for task in soft),
            *rows_of_limits,
        )
        m = sum(block.rows for block in rows_of_limits)
        p = sum(block.rows for block in rows_of_tasks)
        self.sizes = (robot.dof + scheme.slack, m, p)
        further = [name for block in self.blocks for name in block.part.extra_frames(robot)]
        own_frames = [block.part.frame_name(robot) for block in self.compiled_blocks]
        frames = dict.fromkeys([robot.tip, *self.target_frames, *own_frames, *further])
        self.kinematics = Kinematics(robot, frames, self.needs_inertia)
        self._unseen = True  # the answers of parts written in numpy
        self._encode()

    def _encode(self) -> None:
        """Write the table and the constants."""
        robot = self.robot
        n, m, p = self.sizes
        arrays: list[Vector] = [np.zeros(0)]
        stop = 0
        entries = []
        for block in self.compiled_blocks:
            part = block.part
            own = part.constants(robot)
            start = stop
            stop += own.size
            arrays.append(own)
            name = part.frame_name(robot)
            target = self.target_frames.index(name) if name in self.target_frames else 0
            kind, signature = _kind(part)
            address = signature.address(part.kernel)
            entry = _Entry(kind, address, block.first, block.rows, start, stop, target)
            entries.append(entry)
            if isinstance(part, Task) and part.weight is not None:
                arrays.append(np.array([part.weight]))  # follows the task's own constants
                stop += 1
        tip = robot.frame_id(self.target_frames[0])
        first = _Head(n, m, p, robot.dof, len(entries), tip)
        self.table: Table = np.array([first, *entries], dtype=np.int64)
        self.constants: Vector = np.concatenate(arrays)
        if self.rate_limits is not None:
            for start, _ in self.constants_of(CollisionAvoidance):
                self.constants[start + BRAKED] = 1.0

    @cached_property
    def compiled_blocks(self) -> tuple[Block, ...]:
        """Blocks of the parts with a kernel."""
        return tuple(block for block in self.blocks if block.part.is_compiled)

    @cached_property
    def numpy_blocks(self) -> tuple[Block, ...]:
        """Blocks of the parts that are written in numpy."""
        return tuple(block for block in self.blocks if not block.part.is_compiled)

    @cached_property
    def moving(self) -> list[tuple[Limit, Vector]]:
        """Limits with constants that change along a run, each with its constants, (k,)."""
        entries = self.table[1:].tolist()
        return [
            (block.part, self.constants[entry[4] : entry[5]])
            for block, entry in zip(self.compiled_blocks, entries, strict=False)
            if isinstance(block.part, Limit) and block.part.moves
        ]

    def constants_of(self, kind: type[Part]) -> list[tuple[int, int]]:
        """Return beginning and end in `constants` of those of each part of a kind."""
        blocks = self.compiled_blocks
        entries = self.table[1 : 1 + len(blocks)].tolist()
        pairs = zip(blocks, entries, strict=True)
        return [(entry[4], entry[5]) for block, entry in pairs if isinstance(block.part, kind)]

    @property
    def is_compiled(self) -> bool:
        """Test whether compiled code alone writes the programs."""
        return not self.numpy_blocks

    @property
    def needs_inertia(self) -> bool:
        """Test whether a cost takes the inertia matrix."""
        energies = (block.part for block in self.blocks if isinstance(block.part, KineticEnergy))
        return any(energy.kinetic == "inertia" for energy in energies)

    @cached_property
    def rate_limits(self) -> MotionLimits | None:
        """The acceleration and jerk limits, if there are any."""
        last = self.blocks[-1].part if self.blocks else None
        return last if isinstance(last, MotionLimits) else None

    @property
    def tasks(self) -> list[Task]:
        """Hard tasks, in the order of the equality rows."""
        parts = [block.part for block in self.blocks]
        return [part for part in parts if isinstance(part, Task) and part.weight is None]

    @property
    def row_weights(self) -> Vector:
        """Weight of each equality row where a policy lets the tasks yield, (p,)."""
        counts = [task.row_count(self.robot) for task in self.tasks]
        return np.repeat([task.row_weight for task in self.tasks], counts)

    @property
    def elastic(self) -> Vector:
        """1 for each inequality row of an elastic limit, else 0, (m,)."""
        found = np.zeros(self.sizes[1])
        for block in self.blocks:
            if isinstance(block.part, Limit) and block.part.elastic:
                found[block.first : block.first + block.rows] = 1.0
        return found

    @cached_property
    def ahead(self) -> frozenset[str]:
        """Names of the frames whose tasks track the next target."""
        ahead = [task for task in self.scheme.tasks if task.tracks and task.tracking == "next"]
        return frozenset(task.frame_name(self.robot) for task in ahead)

    @property
    def needs_period(self) -> bool:
        """Test whether a program needs a control period."""
        return any(task.tracking == "next" for task in self.scheme.tasks)

    @property
    def placement(self) -> Vector:
        """Placement of the first tracked frame, (12,), a view."""
        place: Vector = self.kinematics.placements[self.table[0, 5]]
        return place

    @property
    def data_size(self) -> int:
        """Length of the programs' `QP.data`."""
        n, m, p = self.sizes
        return (n + m + p) * (n + 1) + 2 * n

    def append(self, address: int, constants: Vector, second: int = 0) -> None:
        """Add an entry for another compiled function of a control step.

        Args:
            address: Address of the function.
            constants: Numbers that it reads, (k,).
            second: A further integer, in the third column.
        """
        start = self.constants.size
        entry = _Entry(0, address, second, 0, start, start + constants.size, 0)
        self.table = np.vstack([self.table, np.array([entry], dtype=np.int64)])
        self.constants = np.concatenate([self.constants, constants])

    def arrays(self, dt: float) -> ProgramArrays:
        """Return the arrays with which compiled code writes programs of a control period [s]."""
        kinematics = self.kinematics
        return ProgramArrays(
            self.table,
            self.constants,
            kinematics.jacobian,
            kinematics.placements,
            kinematics.moves,
            kinematics.inertia,
            1.0 / dt if dt < np.inf else np.inf,
        )

    def move(self, t: float) -> None:
        """Bring the constants that change along a run to a time [s]."""
        for part, constants in self.moving:
            part.move(self.robot, constants, t)

    def write(
        self,
        data: Vector,
        targets: Matrix,
        past: Matrix,
        dt: float,
        t: float = 0.0,
    ) -> None:
        """Write the whole program of one step, at the joint positions of `kinematics`.

        Args:
            data: The program, `QP.data`, (size,), overwritten.
            targets: Targets of the tracked frames, (k, 18).
            past: Joint positions [rad], last command and the one before [rad/s], (3, n).
            dt: Control period [s]; inf outside of a loop.
            t: Time [s].

        Raises:
            InvalidInputError: The answer of a part written in numpy is wrong; the part is named.
        """
        write_program(data, self.arrays(dt), past, targets, float(t))
        qp = QP.from_data(data, self.sizes)
        if self.numpy_blocks:
            by_name = dict(zip(self.target_frames, targets, strict=True))
            q = read_only(past[0])
            dq = read_only(past[1])
            step = Step.from_kinematics(self.kinematics, by_name, t, dt, q, dq)
            fill(self.numpy_blocks, qp, step, self.rate_limits is not None, self._unseen)
            self._unseen = False

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

    def settings(self) -> dict[str, object]:
        """Return the inequality rows and the names of unusual parts, for a run's settings.

        ``bounding`` names the limits with bounds, unless `JointLimits` alone; ``own_tasks`` the
        tasks that are not the package's.
        """
        scheme = self.scheme
        bounding = [
            type(limit).__name__
            for limit in scheme.limits
            if type(limit).bounds is not Limit.bounds
            or (limit.is_compiled and not limit.row_count(self.robot))
        ]
        kinds = [type(task) for task in scheme.tasks]
        own = [kind.__name__ for kind in kinds if not kind.__module__.startswith("iiwa_dnn.")]
        found: dict[str, object] = {"rows": self.row_names()}
        if bounding != ["JointLimits"]:
            found["bounding"] = bounding
        if own:
            found["own_tasks"] = own
        return found


def _check_rows(robot: Robot, limits: Sequence[Limit]) -> None:
    """Raise InvalidInputError if a limit has inequalities but no rows."""
    for limit in limits:
        own = type(limit).inequalities is not Limit.inequalities
        if own and limit.row_count(robot) < 1:
            raise InvalidInputError(type(limit).__name__, "has inequalities but no rows", limit)


def _tracked(robot: Robot, tasks: list[Task]) -> tuple[str, ...]:
    """Return the names of the tracked frames, the tip first; the tip's if there are none.

    Raises:
        InvalidInputError: Tasks of one frame track its targets in different ways.
    """
    pairs = {(task.frame_name(robot), task.tracking) for task in tasks if task.tracks}
    names = dict.fromkeys(task.frame_name(robot) for task in tasks if task.tracks)
    if len(pairs) > len(names):
        problem = f"must be the same of all tasks of a frame: {sorted(pairs)}"
        raise InvalidInputError("tracking", problem)
    return tuple(sorted(names, key=lambda name: name != robot.tip)) or (robot.tip,)


def _stacked(robot: Robot, parts: list[Task] | list[Limit]) -> list[Block]:
    """Return the blocks of parts whose rows stand one after the other."""
    blocks = []
    first = 0
    for part in parts:
        rows = part.row_count(robot)
        blocks.append(Block(part, first, rows))
        first += rows
    return blocks


def _kind(part: Part) -> tuple[int, Signature]:
    """Return the kind of a part in the table, and the signature of its kernel."""
    if isinstance(part, Cost):
        return _COST, COST
    if isinstance(part, Task):
        return (_TASK if part.weight is None else _SOFT), TASK
    return _LIMIT, LIMIT


_enter_cost = COST.enter
_enter_task = TASK.enter
_enter_limit = LIMIT.enter


@inlined
def borrowed_arrays(arrays: ProgramArrays) -> ProgramArrays:
    """Return the arrays of a program without counting who uses them."""
    return ProgramArrays(
        borrowed(arrays.table),
        borrowed(arrays.constants),
        borrowed(arrays.jacobian),
        borrowed(arrays.placements),
        borrowed(arrays.moves),
        borrowed(arrays.inertia),
        arrays.rate,
    )


@inlined
def step_views(arrays: ProgramArrays, past: Matrix, targets: Matrix, t: float) -> StepViews:
    """Make the views of one instant, from past (3, dof) and targets (k, 18) of `write_program`."""
    return StepViews(
        t,
        arrays.rate,
        past[0],
        past[1],
        past[2],
        arrays.jacobian,
        arrays.placements,
        arrays.moves,
        arrays.inertia,
        targets,
    )


@compiled
def write_program(
    data: Vector, arrays: ProgramArrays, past: Matrix, targets: Matrix, t: float
) -> None:
    """Write the rows of all parts with a kernel.

    Args:
        data: The program, `QP.data`, (size,), overwritten.
        arrays: `StepProgram.arrays`.
        past: Joint positions [rad], last command and the one before [rad/s], (3 or more, dof).
        targets: Targets of the tracked frames, (k, 18).
        t: Time [s].
    """
    table = arrays.table
    qp = qp_views(data, table[0, 0], table[0, 1], table[0, 2])
    assemble(step_views(arrays, past, targets, t), arrays, qp)


@compiled
def assemble(step: StepViews, arrays: ProgramArrays, qp: QPViews) -> None:
    """Write the rows of all parts with a kernel into a program; arguments as `write_program`."""
    table = arrays.table
    constants = arrays.constants
    _clear(qp)
    for k in range(1, 1 + table[0, 4]):
        kind = table[k, 0]
        address = table[k, 1]
        first = table[k, 2]
        rows = table[k, 3]
        own = constants[table[k, 4] : table[k, 5]]
        target = step.targets[table[k, 6]]
        if kind == _COST:
            _enter_cost(address, step, own, qp.P, qp.q)
        elif kind == _TASK:
            A = qp.A[first : first + rows]
            _enter_task(address, step, own, target, A, qp.b[first : first + rows])
        elif kind == _SOFT:
            A = np.zeros((rows, qp.q.size))
            b = np.zeros(rows)
            _enter_task(address, step, own, target, A, b)
            _add_soft(qp, A, b, constants[table[k, 5]])
        else:
            G = qp.G[first : first + rows]
            _enter_limit(address, step, own, G, qp.h[first : first + rows], qp.lb, qp.ub)


@compiled
def _clear(qp: QPViews) -> None:
    """Set all rows and costs to zero, and all bounds to infinity."""
    n = qp.q.size
    for i in range(n):
        qp.q[i] = 0.0
        qp.lb[i] = -np.inf
        qp.ub[i] = np.inf
        for k in range(n):
            qp.P[i, k] = 0.0
    for j in range(qp.h.size):
        qp.h[j] = 0.0
        for k in range(n):
            qp.G[j, k] = 0.0
    for j in range(qp.b.size):
        qp.b[j] = 0.0
        for k in range(n):
            qp.A[j, k] = 0.0


@compiled
def _add_soft(qp: QPViews, A: Matrix, b: Vector, weight: float) -> None:
    """Add weight A^T A to P and -weight A^T b to q, for rows A (rows, n) and b (rows,)."""
    for k in range(b.size):
        for i in range(qp.q.size):
            scaled = weight * A[k, i]
            qp.q[i] -= scaled * b[k]
            for j in range(qp.q.size):
                qp.P[i, j] += scaled * A[k, j]
