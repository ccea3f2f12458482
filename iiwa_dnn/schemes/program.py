"""Schemes: costs, tasks and limits composed into the program of a control step.

A scheme is laid out for a robot once, as named views (`ProgramLayout`).

`ProgramLayout` states which rows belong to which part. `assemble` writes all rows in one compiled
call, each part by its own kernel; what a part's kernel reads is brought up to date before it
(`ProgramLayout.refresh`). This is the only file that knows where a constant lies.
"""

from __future__ import annotations

import copy
from collections.abc import Iterable, Mapping, Sequence
from enum import IntEnum
from typing import Any, Literal, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.naming import LimitKind
from iiwa_dnn.qp import QP, Matrix, Vector
from iiwa_dnn.qp.layout import IntMatrix, QPViews, data_size, qp_views
from iiwa_dnn.references import Target
from iiwa_dnn.references.targets import TargetData
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.robot.kinematics import Kinematics
from iiwa_dnn.schemes.collisions import MEET, CollisionAvoidance
from iiwa_dnn.schemes.costs import KineticEnergy
from iiwa_dnn.schemes.limits import MotionLimits, RateLimits, merged
from iiwa_dnn.schemes.parts import (
    Cost,
    Limit,
    Part,
    Task,
    answer_of,
    answer_size,
    enter_cost,
    enter_limit,
    enter_task,
)
from iiwa_dnn.schemes.scene import SceneHead
from iiwa_dnn.schemes.step import Step, StepViews
from iiwa_dnn.schemes.tasks import JointCouplingTask

SchemeT = TypeVar("SchemeT", bound="Scheme")

_LISTS = ("costs", "tasks", "limits")
"""Attributes of a scheme that list its parts."""


class Scheme:
    """Costs, tasks and limits that choose the joint velocities.

    The program's variables are the n joint velocities [rad/s], then `slack` further variables that
    costs and limits of one's own may use; the command is the first n of the solution.

    Attributes:
        costs: Terms of the cost.
        tasks: Equality rows, or soft tasks.
        limits: Bounds and inequality rows.
        slack: Number of slack variables.
        sample: Time of the targets in a control loop: ``"start"`` or ``"end"`` of the control
            period; at the end with the mean twist over it (`Reference.feed_forward`).
    """

    costs: tuple[Cost, ...]
    tasks: tuple[Task, ...]
    limits: tuple[Limit, ...]
    slack: int = 0
    sample: Literal["start", "end"] = "start"

    def __init__(
        self,
        costs: Sequence[Cost] = (),
        tasks: Sequence[Task] = (),
        limits: Sequence[Limit] = (),
        slack: int = 0,
    ) -> None:
        """Compose the parts.

        Raises:
            InvalidInputError: A part is of another kind than its list, or `slack` is negative.
        """
        self._compose(costs, tasks, limits)
        self.slack = checks.integer("slack", slack, 0)

    def _compose(
        self, costs: Sequence[Cost], tasks: Sequence[Task], limits: Sequence[Limit]
    ) -> None:
        kinds = (Cost, Task, Limit)
        for name, parts, kind in zip(_LISTS, (costs, tasks, limits), kinds, strict=True):
            if not isinstance(parts, Iterable):
                raise InvalidInputError(name, f"must be a list of parts, not {parts!r}", parts)
            checked = tuple(checks.instance(name, part, kind) for part in parts)
            object.__setattr__(self, name, checked)  # a scheme may be a frozen dataclass

    def anchored(self: SchemeT, conf: Configuration) -> SchemeT:
        """Return the scheme with `conf` as the posture to come back to, where a part lacks one."""
        lists = [[part.anchored(conf) for part in getattr(self, name)] for name in _LISTS]
        if lists == [list(getattr(self, name)) for name in _LISTS]:
            return self
        scheme = copy.copy(self)
        scheme._compose(*lists)
        return scheme

    def program(self, robot: Robot) -> ProgramLayout:
        """Lay the parts out for a robot.

        Raises:
            NotFoundError: A part names a frame that the robot does not have.
            InvalidInputError: A parameter of a part does not fit the robot, or a subclass builds
                its programs in another way, which no control loop would follow.
        """
        if type(self).build_qp is not Scheme.build_qp:
            problem = f"{type(self).__name__} overrides build_qp; write a Cost, a Task or a Limit"
            raise InvalidInputError("scheme", problem, self)
        return ProgramLayout(robot, self)

    def build_qp(
        self,
        conf: Configuration,
        target: Target | Mapping[str, Target],
        dt: float = np.inf,
        dq: ArrayLike | None = None,
    ) -> QP:
        """Build the program of one instant; it is not solved here.

        Args:
            conf: Configuration of the robot, n joints; the posture to come back to where there is
                none.
            target: Target of the tip; with tasks of other frames, a target by frame name.
            dt: Control period [s], which a gain of inf stands for.
            dq: Joint velocities [rad/s], (n,), or the last command; None: zero.

        Returns:
            A QP in n + slack variables: the rows of the tasks in A, of the limits in G.

        Raises:
            InvalidInputError: A task's frame has no target, or a part does not fit the robot.
        """
        scheme = self.anchored(checks.instance("conf", conf, Configuration))
        program = scheme.program(conf.robot)
        if any(getattr(part, "gain", 0.0) == np.inf for part in program.parts):
            checks.positive("dt", dt)  # which a gain of inf is the inverse of
        q = conf.q
        velocity = np.zeros(q.size) if dq is None else checks.finite_array("dq", dq, (q.size,))
        targets = np.array(targets_of(conf.robot.tip, program.target_frames, target))
        return program.qp_at(q, velocity, velocity, targets, dt)

    def kinetic_index(self, conf: Configuration, dq: ArrayLike) -> float:
        """Compute dq^T G(q) dq of a joint velocity dq (n,) [rad/s].

        G is that of the scheme's `KineticEnergy`: [rad^2/s^2] with the identity, [J] (twice the
        energy) with the inertia matrix.
        """
        velocity = np.asarray(dq, dtype=np.float64)
        along = conf.inertia @ velocity if self.kinetic == "inertia" else velocity
        return float(velocity @ along)

    @property
    def kinetic(self) -> str:
        """G of the kinetic index: ``"identity"`` or ``"inertia"``."""
        return next(
            (part.kinetic for part in self.costs if isinstance(part, KineticEnergy)), "identity"
        )

    def settings(self) -> dict[str, Any]:
        """Return name, parts and parameters, as values that JSON can hold."""
        parts = {name: [part.settings() for part in getattr(self, name)] for name in _LISTS}
        own = {"slack": self.slack, "kinetic": self.kinetic}
        return {"name": type(self).__name__, **parts, **own}


def targets_of(
    tip: str, frames: Sequence[str], target: Target | Mapping[str, Target]
) -> list[Vector]:
    """Return `Target.data`, (18,), of each of the frames; one target alone is the tip's.

    Raises:
        InvalidInputError: A frame has no target, or another object in its place.
    """
    given = target if isinstance(target, Mapping) else {tip: target}
    for name in frames:
        if name not in given:
            raise InvalidInputError("target", f"is missing for frame {name!r}", sorted(given))
    return [checks.instance("target", given[name], Target).data for name in frames]


class ProgramSizes(NamedTuple):
    """Sizes of a scheme's programs, and of what they are built for.

    Attributes:
        n: Number of variables.
        m: Number of inequality rows.
        p: Number of equality rows.
        joints: Number of joints.
        pairs: Number of watched pairs.
        frames: Number of tracked frames.
    """

    n: int
    m: int
    p: int
    joints: int
    pairs: int
    frames: int


class BlockKind(IntEnum):
    """Kinds of blocks, in the order in which they stand."""

    COST = 0
    TASK = 1
    SOFT_TASK = 2
    LIMIT = 3


class Column(IntEnum):
    """Columns of the table of blocks; their meaning is that of the fields of `Block`."""

    KIND = 0
    ADDRESS = 1
    FIRST = 2
    ROWS = 3
    START = 4
    STOP = 5
    TARGET = 6


class ProgramArrays(NamedTuple):
    """Arrays with which compiled code writes programs.

    Attributes:
        sizes: Sizes of the programs.
        table: `ProgramLayout.table`.
        constants: `ProgramLayout.constants`, (k,).
        jacobian: `Kinematics.jacobian`, (dof, 6).
        placements: `Kinematics.placements`, (frames, 12).
        support: `Robot.support`, (frames, dof).
        inertia: `Kinematics.inertia`, (dof, dof).
        tip: Index of the first tracked frame.
    """

    sizes: ProgramSizes
    table: IntMatrix
    constants: Vector
    jacobian: Matrix
    placements: Matrix
    support: Matrix
    inertia: Matrix
    tip: int


OFF = 1e-6
"""Error of a relation of joints from which on it is reported [rad]."""


class Block(NamedTuple):
    """Rows of one part; from `kind` on, a row of the table.

    Attributes:
        part: The part.
        kind: What kind of part it is.
        address: Address of its kernel.
        first: Its first row among the program's equality or inequality rows.
        rows: Number of its rows; none for a cost.
        start: Beginning of its constants; those of a soft task are followed by its weight.
        stop: Their end.
        target: Index of the target of its frame.
    """

    part: Part
    kind: BlockKind
    address: int
    first: int
    rows: int
    start: int
    stop: int
    target: int


class ProgramLayout:
    """A scheme laid out for a robot of `dof` joints.

    Attributes:
        robot: The robot.
        scheme: The scheme.
        tasks: Hard tasks, in the order of the equality rows.
        blocks: The parts in the order costs, hard tasks, soft tasks, limits.
        sizes: ``(n, m, p)`` of the programs.
        target_frames: Names of the frames that tasks track, in the order of the targets; the
            tip's if no task tracks one.
        refreshed: Blocks of the parts whose constants change along a run.
        kinematics: The robot's, overwritten by each step.
        table: What compiled code reads of the blocks, a row each, (parts, 7), by `Column`.
        constants: Numbers that compiled code reads, (k,).
        pairs: Names in words and least distance [m] of each watched pair.
        kinds: `LimitKind` of the lower and upper bounds in the last program of `qp_at`, (2, dof).
    """

    def __init__(self, robot: Robot, scheme: Scheme) -> None:
        """Lay a scheme's parts out for a robot.

        Raises:
            NotFoundError: A part names a frame that the robot does not have.
            InvalidInputError: A parameter of a part does not fit the robot.
        """
        self.robot = robot
        self.scheme = scheme
        tasks = list(scheme.tasks)
        limits = merged(scheme.limits, tasks)
        self.rate_limits = next((part for part in limits if isinstance(part, MotionLimits)), None)
        self.target_frames = _tracked(robot, tasks)
        self.tasks = [task for task in tasks if task.weight is None]
        soft = [task for task in tasks if task.weight is not None]
        n = robot.dof + scheme.slack
        self.blocks: list[Block] = []
        self.constants: Vector = np.zeros(0)
        self._add(BlockKind.COST, scheme.costs, n)
        p = self._add(BlockKind.TASK, self.tasks, n)
        self._add(BlockKind.SOFT_TASK, soft, n)
        m = self._add(BlockKind.LIMIT, limits, n)
        self.sizes = (n, m, p)
        self.kinds = np.zeros((2, robot.dof))
        self.pairs: list[tuple[str, float]] = []
        for block in self.blocks:
            if isinstance(block.part, CollisionAvoidance):
                scene = self.constants[block.start : block.start + SceneHead.width()]
                SceneHead.of(scene).first = len(self.pairs)
                self.pairs += block.part.pairs(robot)
        table = [block[1:] for block in self.blocks]
        self.table: IntMatrix = np.array(table, dtype=np.int64).reshape(-1, len(Column))
        self.refreshed = [block for block in self.blocks if block.part.refreshes]
        self.kinematics = Kinematics(robot, self._frames(), self.needs_inertia)

    def _add(self, kind: BlockKind, parts: Sequence[Part], n: int) -> int:
        """Add the blocks of the parts of a kind in programs of n variables; count their rows."""
        robot = self.robot
        first = 0
        for part in parts:
            rows = part.row_count(robot)
            own: Vector = np.asarray(part.constants(robot))
            if part.copies:
                own = np.zeros(answer_size(part, n, rows))
            name = part.frame_name(robot)
            target = self.target_frames.index(name) if name in self.target_frames else 0
            start = self.constants.size
            stop = start + own.size
            address = part.entry.address(part.kernel)
            self.blocks.append(Block(part, kind, address, first, rows, start, stop, target))
            weight = [part.weight] if kind is BlockKind.SOFT_TASK and isinstance(part, Task) else []
            self.constants = np.concatenate([self.constants, own, np.array(weight)])
            first += rows
        return first

    def _frames(self) -> list[str]:
        """Return the names of the frames whose placements the kernels read."""
        robot = self.robot
        own = [part.frame_name(robot) for part in self.parts if not part.copies]
        further = [name for part in self.parts for name in part.extra_frames(robot)]
        return [*self.target_frames, *own, *further]

    @property
    def parts(self) -> list[Part]:
        """The parts, in the order of the blocks."""
        return [block.part for block in self.blocks]

    def constants_of(self, kind: type[Part]) -> list[Vector]:
        """Return the constants of each part of a kind, views."""
        found = [self.blocks[k] for k in self.places_of(kind)]
        return [self.constants[block.start : block.stop] for block in found]

    def places_of(self, kind: type[Part]) -> list[int]:
        """Return the numbers of the blocks of the parts of a kind."""
        return [k for k, block in enumerate(self.blocks) if isinstance(block.part, kind)]

    @property
    def least(self) -> Vector:
        """Least distance of each watched pair [m], (pairs,), a copy."""
        return np.array([distance for _, distance in self.pairs])

    @property
    def reads_targets(self) -> bool:
        """Test whether `refresh` has to know the targets; obstacles that move do not."""
        return any(not isinstance(block.part, CollisionAvoidance) for block in self.refreshed)

    @property
    def needs_inertia(self) -> bool:
        """Test whether a cost takes the inertia matrix."""
        return any(getattr(part, "kinetic", "") == "inertia" for part in self.parts)

    @property
    def row_weights(self) -> Vector:
        """Weight of each equality row where a policy lets the tasks yield, (p,)."""
        counts = [task.row_count(self.robot) for task in self.tasks]
        return np.repeat([task.row_weight for task in self.tasks], counts)

    @property
    def arrays(self) -> ProgramArrays:
        """The arrays with which compiled code writes programs."""
        return ProgramArrays(
            ProgramSizes(*self.sizes, self.robot.dof, len(self.pairs), len(self.target_frames)),
            self.table,
            self.constants,
            self.kinematics.jacobian,
            self.kinematics.placements,
            self.kinematics.robot.support,
            self.kinematics.inertia,
            self.robot.frame_id(self.target_frames[0]),
        )

    def refresh(
        self, q: Vector, last: Vector, targets: Matrix, t: float, dt: float = np.inf
    ) -> None:
        """Bring the constants that change along a run up to date, for one step.

        Args:
            q: Joint positions [rad], (dof,), at which the kinematics are.
            last: Last command [rad/s], (dof,).
            targets: Targets of the tracked frames, (k, 18).
            t: Time [s].
            dt: Control period [s]; inf outside of a loop.

        Raises:
            InvalidInputError: The answer of a part written in numpy is wrong; the part is named.
        """
        named = dict(zip(self.target_frames, map(Target.from_data, targets), strict=True))
        step = Step(self.robot, q, named, dt, t, last, self.kinematics)
        for block in self.refreshed:
            own = self.constants[block.start : block.stop]
            if block.part.copies:
                own[:] = answer_of(block.part, step, self.sizes[0], block.rows)
            else:
                block.part.refresh(step, own)

    def qp_at(
        self,
        q: Vector,
        last: Vector,
        before: Vector,
        targets: Matrix,
        dt: float,
        t: float = 0.0,
        least: Vector | None = None,
    ) -> QP:
        """Build the program of one instant.

        Args:
            q: Joint positions [rad], (dof,).
            last: Last command [rad/s], (dof,).
            before: Command before the last one [rad/s], (dof,).
            targets: Targets of the tracked frames, (k, 18).
            dt: Control period [s]; inf outside of a loop.
            t: Time [s].
            least: Distance that each watched pair has to keep [m], (pairs,), brought up to date;
                None: that of the scheme.

        Raises:
            InvalidInputError: The answer of a part written in numpy is wrong; the part is named.
        """
        data = np.empty(data_size(*self.sizes))
        self.kinematics.update(q)
        self.refresh(q, last, targets, t, dt)
        kept = self.least if least is None else least
        arrays = self.arrays
        rate = 1.0 / dt if dt < np.inf else np.inf
        own = arrays[3:7]
        step = StepViews(float(t), rate, q, last, before, *own, targets, kept, *self.kinds)
        assemble(data, arrays, step)
        return QP.from_data(data, self.sizes)

    def settings(self) -> dict[str, object]:
        """Return what names in words need (`iiwa_dnn.naming.active_limits`).

        ``rows`` has for each inequality row its part, its number in it from 1, and its name if any,
        ``bounding`` the limits in the order of their codes (`LimitKind.OTHER`).
        """
        counts = [(limit, limit.row_count(self.robot)) for limit in self.scheme.limits]
        rows: list[dict[str, object]] = []
        for limit, count in counts:
            about = [{"about": name} for name in limit.row_names(self.robot)] or [{}] * count
            part: dict[str, object] = {"part": type(limit).__name__}
            rows += [part | {"row": number} | name for number, name in enumerate(about, 1)]
        names = [type(limit).__name__ for limit, _ in counts if not isinstance(limit, RateLimits)]
        return {"rows": rows, "bounding": names}


def _tracked(robot: Robot, tasks: Sequence[Task]) -> tuple[str, ...]:
    """Return the names of the tracked frames, the tip first; the tip's if there are none."""
    names = dict.fromkeys(task.frame_name(robot) for task in tasks if task.tracks)
    return tuple(sorted(names, key=lambda name: name != robot.tip)) or (robot.tip,)


@compiled
def program_views(data: Vector, sizes: ProgramSizes) -> QPViews:
    """Make the views of a program, `QP.data` (size,)."""
    return qp_views(data, sizes.n, sizes.m, sizes.p)


@compiled
def block_constants(arrays: ProgramArrays, k: int) -> Vector:
    """Return the constants of block k, (k,)."""
    start = arrays.table[k, Column.START]
    return arrays.constants[start : arrays.table[k, Column.STOP]]


@compiled
def assemble(data: Vector, arrays: ProgramArrays, step: StepViews) -> None:
    """Write the rows of all parts into a program.

    Args:
        data: The program, `QP.data`, (size,), overwritten.
        arrays: `ProgramLayout.arrays`.
        step: The instant; the distances that pairs keep and the kinds of the bounds are brought up
            to date.
    """
    code = int(LimitKind.OTHER)
    qp = program_views(data, arrays.sizes)
    data[:] = 0.0
    qp.lb[:] = -np.inf
    qp.ub[:] = np.inf
    for k in range(len(arrays.table)):
        entry = arrays.table[k]
        kind = entry[Column.KIND]
        address = entry[Column.ADDRESS]
        first = entry[Column.FIRST]
        end = first + entry[Column.ROWS]
        own = block_constants(arrays, k)
        target = TargetData.of(step.targets[entry[Column.TARGET]])
        if kind == BlockKind.COST:
            enter_cost(address, step, own, qp.P, qp.q)
        elif kind == BlockKind.TASK:
            enter_task(address, step, own, target, qp.A[first:end], qp.b[first:end])
        elif kind == BlockKind.SOFT_TASK:
            A = np.zeros((end - first, qp.q.size))
            b = np.zeros(end - first)
            enter_task(address, step, own, target, A, b)
            add_soft(qp.P, qp.q, A, b, arrays.constants[entry[Column.STOP]])
        else:
            lower = qp.lb.copy()
            upper = qp.ub.copy()
            lower_kind = step.lower_kind.copy()
            upper_kind = step.upper_kind.copy()
            step.lower_kind[:] = code
            step.upper_kind[:] = code
            code += 1
            enter_limit(address, step, own, qp.G[first:end], qp.h[first:end], qp.lb, qp.ub)
            _keep_kinds(qp.lb, lower, step.lower_kind, lower_kind)
            _keep_kinds(qp.ub, upper, step.upper_kind, upper_kind)


@compiled
def _keep_kinds(bounds: Vector, before: Vector, kinds: Vector, others: Vector) -> None:
    """Keep the kinds (joints,) of those bounds (n,) that a limit has not changed."""
    for i in range(kinds.size):
        if bounds[i] == before[i]:
            kinds[i] = others[i]


@compiled
def add_soft(P: Matrix, q: Vector, A: Matrix, b: Vector, weight: float) -> None:
    """Add weight A^T A to P and -weight A^T b to q, for rows A (rows, n) and b (rows,)."""
    for k in range(b.size):
        for i in range(q.size):
            scaled = weight * A[k, i]
            q[i] -= scaled * b[k]
            for j in range(q.size):
                P[i, j] += scaled * A[k, j]


class LimitNames:
    """Names of the bounds and inequality rows of a controller's programs.

    Attributes:
        settings: `ProgramLayout.settings`.
    """

    def __init__(self, program: ProgramLayout) -> None:
        """Take the limits of a step program."""
        self.settings = program.settings()
        self._program = program

    def conditions(self, q: Vector, least: Vector) -> tuple[str, ...]:
        """State which promises wait for the arm to come nearer to them.

        They are pairs that keep another distance than the scheme's, `least` (pairs,) [m], and
        relations of joints that the positions q (n,) [rad] do not fulfil.
        """
        near = [
            f"{names} meet, and no direction separates them"
            if kept == MEET
            else f"{names} began nearer than {promised:g} m, and keep {kept:.3g} m"
            for (names, promised), kept in zip(self._program.pairs, least, strict=True)
            if kept != promised
        ]
        found = [
            (task.coefficients, task.missing(self._program.robot, q))
            for task in self._program.tasks
            if isinstance(task, JointCouplingTask)
        ]
        off = [
            f"{' and '.join(joints)}: {missing:.3g} rad off their JointCouplingTask"
            for joints, missing in found
            if abs(missing) > OFF
        ]
        return (*near, *off)
