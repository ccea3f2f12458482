"""Layout of a scheme for a robot: rows, constants and kernels of its parts, and their targets.

Constants that change from step to step are updated before each (`ProgramLayout.refresh`).
"""

from collections.abc import Mapping, Sequence

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import QP, Matrix, Vector
from iiwa_dnn.qp.layout import IntMatrix, data_size
from iiwa_dnn.references import Target
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.kinematics import Kinematics
from iiwa_dnn.schemes.collisions import CollisionAvoidance
from iiwa_dnn.schemes.joint_limits import MotionConstants, merged, motion_constants
from iiwa_dnn.schemes.parts import Cost, Limit, Part, Task, answer_of, enter_rest, flat, idle_arrays
from iiwa_dnn.schemes.program import BlockKind, Column, ProgramArrays, ProgramSizes, assemble
from iiwa_dnn.schemes.scene import SceneHead
from iiwa_dnn.schemes.step import Step, StepViews


class ProgramLayout:
    """A scheme laid out for a robot of `dof` joints.

    Attributes:
        robot: The robot.
        limits: The scheme's limits.
        tasks: Hard tasks, in the order of the equality rows.
        parts: The parts in the order costs, hard tasks, soft tasks, limits; those of the joints
            are one, the last.
        sizes: ``(n, m, p)`` of the programs.
        target_frames: Names of the frames that tasks track, in the order of the targets; the
            tip's if no task tracks one.
        refreshed: Indices of the parts whose constants change from step to step.
        kinematics: Kinematics of the robot, overwritten by each step.
        table: A row for each part, (parts, 8), by `Column`.
        constants: Constants of all parts, (k,).
        pairs: Names in words and least distance [m] of each watched pair.
        kinds: `LimitKind` of the lower and upper bounds in the last program of `qp_at`, (dof,)
            both, and the pair of each row, `StepViews.row_pair`, (m,).
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
        self.parts: list[Part] = []
        self.table: IntMatrix = np.zeros((0, len(Column)), dtype=np.int64)
        self.constants: Vector = np.zeros(0)
        self._add(BlockKind.COST, costs, n)
        p = self._add(BlockKind.TASK, self.tasks, n)
        self._add(BlockKind.SOFT_TASK, soft, n)
        m = self._add(BlockKind.LIMIT, merged(limits, tasks), n)
        self.sizes = (n, m, p)
        self.kinds = (np.zeros(robot.dof), np.zeros(robot.dof), np.zeros(m))
        self.pairs: list[tuple[str, float]] = []
        for k, part in enumerate(self.parts):
            if isinstance(part, CollisionAvoidance):
                head = SceneHead.of(self.constants_of(k)[: SceneHead.width()])
                head.first = len(self.pairs)
                head.row = int(self.table[k, Column.FIRST])
                self.pairs += part.pairs(robot)
        self.refreshed = [k for k, part in enumerate(self.parts) if part.refreshes]
        self.kinematics = Kinematics(robot, self._frames(), self.needs_inertia)

    def _add(self, kind: BlockKind, parts: Sequence[Part], n: int) -> int:
        """Add parts of a kind to programs of n variables, and return the number of their rows."""
        robot = self.robot
        first = 0
        for part in parts:
            rows = part.row_count(robot)
            own: Vector = np.asarray(part.constants(robot))
            if part.copies:
                own = flat(idle_arrays(part, n, rows), rows)
            name = part.frame_name(robot)
            target = self.target_frames.index(name) if name in self.target_frames else 0
            start = self.constants.size
            stop = start + own.size
            if part.kernel is None:
                methods = " or ".join(part._methods)
                problem = f"{type(part).__name__} has no kernel, and no method {methods} in numpy"
                raise InvalidInputError("parts", problem, part)
            address = part.entry.address(part.kernel)
            self.parts.append(part)
            rest = enter_rest.address(part.rest_kernel) if part.rest_kernel else 0
            row = (kind, address, rest, first, rows, start, stop, target)
            self.table = np.vstack([self.table, np.array(row, dtype=np.int64)])
            weight = [part.weight] if kind is BlockKind.SOFT_TASK and isinstance(part, Task) else []
            self.constants = np.concatenate([self.constants, own, np.array(weight)])
            first += rows
        return first

    def _frames(self) -> list[str]:
        """Return the names of the frames whose placements the kernels read, some more than once."""
        robot = self.robot
        own = [part.frame_name(robot) for part in self.parts if not part.copies]
        further = [name for part in self.parts for name in part.extra_frames(robot)]
        return [*self.target_frames, *own, *further]

    @property
    def joint_limits(self) -> MotionConstants:
        """Limits of the joints, a view of the constants."""
        return motion_constants(self.arrays)

    def constants_of(self, k: int) -> Vector:
        """Return the constants of part k, (size,), a view."""
        return self.constants[self.table[k, Column.START] : self.table[k, Column.STOP]]

    def places_of(self, kind: type[Part]) -> list[int]:
        """Return the indices of the parts of a kind."""
        return [k for k, part in enumerate(self.parts) if isinstance(part, kind)]

    @property
    def least(self) -> Vector:
        """Least distance of each watched pair by the scheme [m], (pairs,)."""
        return np.array([distance for _, distance in self.pairs])

    @property
    def reads_targets(self) -> bool:
        """Test whether a part that is refreshed may read the targets, as methods in numpy may."""
        return any(not isinstance(self.parts[k], CollisionAvoidance) for k in self.refreshed)

    @property
    def needs_inertia(self) -> bool:
        """Test whether a cost needs the inertia matrix."""
        return any(getattr(part, "kinetic", "") == "inertia" for part in self.parts)

    @property
    def row_weights(self) -> Vector:
        """`Task.row_weight` of each equality row, (p,)."""
        counts = [task.row_count(self.robot) for task in self.tasks]
        return np.repeat([task.row_weight for task in self.tasks], counts)

    @property
    def arrays(self) -> ProgramArrays:
        """Arrays from which `assemble` writes the programs."""
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
        """Update the constants that change from step to step, in place.

        Args:
            q: Joint positions [rad], (dof,), at which `kinematics` was updated last.
            last: Last command [rad/s], (dof,).
            targets: Targets of the tracked frames, (k, 18); of a shield none, (0, 18).
            t: Time [s].
            dt: Control period [s]; inf outside of a loop.

        Raises:
            InvalidInputError: A method in numpy returns something wrong; its part is named.
        """
        frames = self.target_frames[: len(targets)]
        named = dict(zip(frames, map(Target.from_data, targets), strict=True))
        step = Step(self.robot, q, named, dt, t, last, self.kinematics)
        for k in self.refreshed:
            part = self.parts[k]
            own = self.constants_of(k)
            if part.copies:
                own[:] = answer_of(part, step, self.sizes[0], int(self.table[k, Column.ROWS]))
            else:
                part.refresh(step, own)

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
            least: Distance that each watched pair has to keep [m], (pairs,), updated in place;
                None: that of the scheme.

        Raises:
            InvalidInputError: A method in numpy returns something wrong; its part is named.
        """
        data = np.empty(data_size(*self.sizes))
        kept = self.least if least is None else least
        step = self.step_at(q, last, before, targets, dt, t, kept)
        self.refresh(q, last, targets, t, dt)
        assemble(data, self.arrays, step)
        return QP.from_data(data, self.sizes)

    def step_at(
        self,
        q: Vector,
        last: Vector,
        before: Vector,
        targets: Matrix,
        dt: float,
        t: float,
        least: Vector,
    ) -> StepViews:
        """Return one instant, with the kinematics at q; the arguments are those of `qp_at`."""
        self.kinematics.update(q)
        arrays = self.arrays
        limits = motion_constants(arrays)
        return StepViews(
            t=float(t),
            rate=1.0 / dt if dt < np.inf else np.inf,
            q=q,
            last=last,
            before=before,
            jacobian=arrays.jacobian,
            placements=arrays.placements,
            support=arrays.support,
            inertia=arrays.inertia,
            targets=targets,
            least=least,
            lower_kind=self.kinds[0],
            upper_kind=self.kinds[1],
            row_pair=self.kinds[2],
            velocity_limits=limits.velocity,
            acceleration_limits=limits.acceleration,
        )


def _tracked(robot: Robot, tasks: Sequence[Task]) -> tuple[str, ...]:
    """Return the names of the frames that tasks track, the tip first; the tip alone if none is."""
    names = dict.fromkeys(task.frame_name(robot) for task in tasks if task.tracks)
    return tuple(sorted(names, key=lambda name: name != robot.tip)) or (robot.tip,)


def targets_of(
    tip: str, frames: Sequence[str], target: Target | Mapping[str, Target]
) -> list[Vector]:
    """Return `Target.data`, (18,), of each of the frames.

    Args:
        tip: Name of the tip.
        frames: Names of the frames.
        target: Targets by frame name, or the target of the tip alone.

    Raises:
        InvalidInputError: A frame has no target, or an object of another type.
    """
    given = target if isinstance(target, Mapping) else {tip: target}
    for name in frames:
        if name not in given:
            raise InvalidInputError("target", f"is missing for frame {name!r}", sorted(given))
    return [checks.instance("target", given[name], Target).data for name in frames]
