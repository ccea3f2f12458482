"""Layout of a scheme for a robot: the rows, constants and kernels of its parts, and the targets.

Constants that change along a run are brought up to date before a step (`ProgramLayout.refresh`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import QP, Matrix, Vector
from iiwa_dnn.qp.layout import IntMatrix, data_size
from iiwa_dnn.references import Target
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.kinematics import Kinematics
from iiwa_dnn.schemes.collisions import CollisionAvoidance
from iiwa_dnn.schemes.parts import Cost, Limit, Part, Task, answer_of, answer_size
from iiwa_dnn.schemes.program import BlockKind, Column, ProgramArrays, ProgramSizes, assemble
from iiwa_dnn.schemes.rate_limits import MotionLimits, merged
from iiwa_dnn.schemes.scene import SceneHead
from iiwa_dnn.schemes.step import Step, StepViews


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
        limits: The scheme's limits.
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

    def __init__(
        self,
        robot: Robot,
        costs: Sequence[Cost],
        tasks: Sequence[Task],
        limits: Sequence[Limit],
        slack: int,
    ) -> None:
        """Lay the parts and slack variables of a scheme out for a robot.

        Raises:
            NotFoundError: A part names a frame that the robot does not have.
            InvalidInputError: A parameter of a part does not fit the robot.
        """
        self.robot = robot
        self.limits = limits
        self.target_frames = _tracked(robot, tasks)
        self.tasks = [task for task in tasks if task.weight is None]
        soft = [task for task in tasks if task.weight is not None]
        n = robot.dof + slack
        self.blocks: list[Block] = []
        self.constants: Vector = np.zeros(0)
        self._add(BlockKind.COST, costs, n)
        p = self._add(BlockKind.TASK, self.tasks, n)
        self._add(BlockKind.SOFT_TASK, soft, n)
        m = self._add(BlockKind.LIMIT, merged(limits, tasks), n)
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

    @property
    def rate_limits(self) -> MotionLimits | None:
        """Acceleration and jerk limits, if there are any."""
        return next((part for part in self.parts if isinstance(part, MotionLimits)), None)

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


def _tracked(robot: Robot, tasks: Sequence[Task]) -> tuple[str, ...]:
    """Return the names of the tracked frames, the tip first; the tip's if there are none."""
    names = dict.fromkeys(task.frame_name(robot) for task in tasks if task.tracks)
    return tuple(sorted(names, key=lambda name: name != robot.tip)) or (robot.tip,)


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
