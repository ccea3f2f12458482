"""Schemes: costs, tasks and limits composed into the program of a control step.

A scheme is laid out for a robot once, as named views (`StepProgram`).

`StepProgram` states which rows belong to which part. `assemble` writes all rows in one compiled
call, each part by its own kernel; what a part's kernel reads is brought up to date before it
(`StepProgram.refresh`). This is the only file that knows where a constant lies.
"""

from __future__ import annotations

import copy
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import QP, Matrix, Vector
from iiwa_dnn.qp.layout import IntMatrix, QPViews, data_size, qp_views
from iiwa_dnn.references import Target
from iiwa_dnn.references.targets import TargetData
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.robot.kinematics import Kinematics
from iiwa_dnn.schemes.collisions import MEET, CollisionAvoidance
from iiwa_dnn.schemes.costs import KineticEnergy
from iiwa_dnn.schemes.limits import (
    NUMBERS,
    SHARE,
    MotionLimits,
    RateLimits,
    approach,
    constant_periods,
    merged,
)
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
    """A way to choose joint velocities among those that fulfil the tasks inside the limits.

    The program's variables are the n joint velocities [rad/s], then `slack` further variables that
    costs and limits of one's own may use; the command is the first n of the solution.

    Attributes:
        costs: Terms of the cost.
        tasks: Equality rows, or soft tasks.
        limits: Bounds and inequality rows.
        slack: Number of slack variables.
        ahead: Whether a control loop shows it its references one period ahead
            (`Reference.ahead`).
    """

    costs: tuple[Cost, ...]
    tasks: tuple[Task, ...]
    limits: tuple[Limit, ...]
    slack: int = 0
    ahead: bool = False

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

    def program(self, robot: Robot) -> StepProgram:
        """Lay the parts out for a robot.

        Raises:
            NotFoundError: A part names a frame that the robot does not have.
            InvalidInputError: A parameter of a part does not fit the robot, or a subclass builds
                its programs in another way, which no control loop would follow.
        """
        if type(self).build_qp is not Scheme.build_qp:
            problem = f"{type(self).__name__} overrides build_qp; write a Cost, a Task or a Limit"
            raise InvalidInputError("scheme", problem, self)
        return StepProgram(robot, self)

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
        return program.qp_at(np.array([q, velocity, velocity]), targets, dt)

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


class ProgramArrays(NamedTuple):
    """Arrays with which compiled code writes programs.

    Attributes:
        table: `StepProgram.table`.
        constants: `StepProgram.constants`, (k,).
        jacobian: `Kinematics.jacobian`, (dof, 6).
        placements: `Kinematics.placements`, (frames, 12).
        moves: `Robot.moves`, (frames, dof).
        inertia: `Kinematics.inertia`, (dof, dof).
        rate: Inverse of the control period [1/s]; inf outside of a loop.
    """

    table: IntMatrix
    constants: Vector
    jacobian: Matrix
    placements: Matrix
    moves: Matrix
    inertia: Matrix
    rate: float


POSITION, VELOCITY, ACCELERATION, JERK = range(1, 5)

_KINDS = (JERK, ACCELERATION, VELOCITY)
"""Kinds that a bound may have beside that of a position; of several the last counts."""

_CLOSE = 1e-9
"""Difference of two bounds that is rounding, in units of the velocity limit."""

OFF = 1e-6
"""What a relation of joints lacks from which on it is said [rad]."""

COSTS, TASKS, SOFT_TASKS, LIMITS = range(4)
"""Kinds of blocks, in the order in which they stand."""


class Block(NamedTuple):
    """Rows of one part; from `kind` on, a row of the table.

    Attributes:
        part: The part.
        kind: `COSTS`, `TASKS`, `SOFT_TASKS` or `LIMITS`.
        address: Address of its kernel.
        first: Its first row among the program's equality or inequality rows.
        rows: Number of its rows; none for a cost.
        start: Beginning of its constants; those of a soft task are followed by its weight.
        stop: Their end.
        target: Index of the target of its frame.
    """

    part: Part
    kind: int
    address: int
    first: int
    rows: int
    start: int
    stop: int
    target: int


class StepProgram:
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
        table: What compiled code reads of the layout, (1 + parts, 7): in its first row
            ``n, m, p``, the number of joints, that of parts, and the first target's frame.
        constants: Numbers that compiled code reads, (k,).
        pairs: Names in words and least distance [m] of each watched pair.
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
        rows = [
            self._add(kind, parts, n)
            for kind, parts in enumerate((scheme.costs, self.tasks, soft, limits))
        ]
        self.sizes = (n, rows[LIMITS], rows[TASKS])
        self.pairs: list[tuple[str, float]] = []
        for block in self.blocks:
            if isinstance(block.part, CollisionAvoidance):
                scene = self.constants[block.start : block.start + SceneHead.width()]
                SceneHead.of(scene).first = len(self.pairs)
                self.pairs += block.part.pairs(robot)
        tip = robot.frame_id(self.target_frames[0])
        head = (*self.sizes, robot.dof, len(self.blocks), tip, 0)
        self.table: IntMatrix = np.array(
            [head, *(block[1:] for block in self.blocks)], dtype=np.int64
        )
        self.refreshed = [block for block in self.blocks if block.part.refreshes]
        self.kinematics = Kinematics(robot, self._frames(), self.needs_inertia)

    def _add(self, kind: int, parts: Sequence[Part], n: int) -> int:
        """Add the blocks of the parts of a kind in programs of n variables; count their rows."""
        robot = self.robot
        first = 0
        for part in parts:
            rows = part.row_count(robot)
            own: Vector = part.constants(robot)
            if part.copies:
                own = np.zeros(answer_size(part, n, rows))
            name = part.frame_name(robot)
            target = self.target_frames.index(name) if name in self.target_frames else 0
            start = self.constants.size
            stop = start + own.size
            address = part.entry.address(part.kernel)
            self.blocks.append(Block(part, kind, address, first, rows, start, stop, target))
            weight = [part.weight] if kind == SOFT_TASKS and isinstance(part, Task) else []
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

    def constants_of(self, kind: type[Part]) -> list[tuple[int, int]]:
        """Return beginning and end in `constants` of those of each part of a kind."""
        return [(block.start, block.stop) for block in self.blocks if isinstance(block.part, kind)]

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
    def placement(self) -> Vector:
        """Placement of the first tracked frame, (12,), a copy."""
        return np.array(self.kinematics.placements[self.table[0, 5]])

    def append(self, address: int, constants: Vector, second: int = 0) -> None:
        """Add an entry for another compiled function of a control step.

        Args:
            address: Address of the function.
            constants: Numbers that it reads, (k,).
            second: A further integer, in the third column.
        """
        start = self.constants.size
        entry = (0, address, second, 0, start, start + constants.size, 0)
        self.table = np.vstack([self.table, np.array([entry], dtype=np.int64)])
        self.constants = np.concatenate([self.constants, constants])

    def arrays(self, dt: float) -> ProgramArrays:
        """Return the arrays with which compiled code writes programs of a control period [s]."""
        return ProgramArrays(
            self.table,
            self.constants,
            self.kinematics.jacobian,
            self.kinematics.placements,
            self.kinematics.robot.moves,
            self.kinematics.inertia,
            1.0 / dt if dt < np.inf else np.inf,
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

    def write(
        self,
        data: Vector,
        targets: Matrix,
        past: Matrix,
        dt: float,
        t: float = 0.0,
        least: Vector | None = None,
    ) -> None:
        """Write the whole program of one step, at the joint positions of `kinematics`.

        Args:
            data: The program, `QP.data`, (size,), overwritten.
            targets: Targets of the tracked frames, (k, 18).
            past: Joint positions [rad], last command and the one before [rad/s], (3, n).
            dt: Control period [s]; inf outside of a loop.
            t: Time [s].
            least: Distance that each watched pair has to keep [m], (pairs,), brought up to date;
                None: that of the scheme.

        Raises:
            InvalidInputError: The answer of a part written in numpy is wrong; the part is named.
        """
        self.refresh(past[0], past[1], targets, t, dt)
        kept = self.least if least is None else least
        assemble(data, self.arrays(dt), past, kept, targets, float(t))

    def qp_at(
        self,
        past: Matrix,
        targets: Matrix,
        dt: float,
        t: float = 0.0,
        least: Vector | None = None,
    ) -> QP:
        """Build the program at the joint positions of `past`; arguments as of `write`."""
        data = np.empty(data_size(*self.sizes))
        self.kinematics.update(past[0])
        self.write(data, targets, past, dt, t, least)
        return QP.from_data(data, self.sizes)

    def settings(self) -> dict[str, object]:
        """Return what names in words need (`iiwa_dnn.naming.in_the_way`).

        ``rows`` has for each inequality row its part, its number in it from 1, and its name if any,
        ``bounding`` the limits that bound without a kind of their own (`naming.KINDS`), and
        ``ramps`` the joints whose velocity limit depends on their position.
        """
        counts = [(limit, limit.row_count(self.robot)) for limit in self.scheme.limits]
        rows: list[dict[str, object]] = []
        for limit, count in counts:
            about = [{"about": name} for name in limit.row_names(self.robot)] or [{}] * count
            part: dict[str, object] = {"part": type(limit).__name__}
            rows += [part | {"row": number} | name for number, name in enumerate(about, 1)]
        names = [
            type(limit).__name__
            for limit, count in counts
            if not (count or isinstance(limit, RateLimits))
        ]
        ramps = np.flatnonzero(np.isfinite(self.robot.ramps[1])).tolist()
        return {"rows": rows, "bounding": names, "ramps": ramps}


def _tracked(robot: Robot, tasks: Sequence[Task]) -> tuple[str, ...]:
    """Return the names of the tracked frames, the tip first; the tip's if there are none."""
    names = dict.fromkeys(task.frame_name(robot) for task in tasks if task.tracks)
    return tuple(sorted(names, key=lambda name: name != robot.tip)) or (robot.tip,)


@compiled
def assemble(
    data: Vector, arrays: ProgramArrays, past: Matrix, least: Vector, targets: Matrix, t: float
) -> None:
    """Write the rows of all parts into a program.

    Args:
        data: The program, `QP.data`, (size,), overwritten.
        arrays: `StepProgram.arrays`.
        past: Joint positions [rad], last command and the one before [rad/s], (3 or more, dof).
        least: Distance that each watched pair has to keep [m], (pairs,), brought up to date.
        targets: Targets of the tracked frames, (k, 18).
        t: Time [s].
    """
    table = arrays.table
    constants = arrays.constants
    step = StepViews(
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
        least,
    )
    qp = qp_views(data, table[0, 0], table[0, 1], table[0, 2])
    data[:] = 0.0
    qp.lb[:] = -np.inf
    qp.ub[:] = np.inf
    for k in range(1, 1 + table[0, 4]):
        kind = table[k, 0]
        address = table[k, 1]
        first = table[k, 2]
        rows = table[k, 3]
        own = constants[table[k, 4] : table[k, 5]]
        target = TargetData.of(step.targets[table[k, 6]])
        if kind == COSTS:
            enter_cost(address, step, own, qp.P, qp.q)
        elif kind == TASKS:
            A = qp.A[first : first + rows]
            enter_task(address, step, own, target, A, qp.b[first : first + rows])
        elif kind == SOFT_TASKS:
            A = np.zeros((rows, qp.q.size))
            b = np.zeros(rows)
            enter_task(address, step, own, target, A, b)
            add_soft(qp, A, b, constants[table[k, 5]])
        else:
            G = qp.G[first : first + rows]
            enter_limit(address, step, own, G, qp.h[first : first + rows], qp.lb, qp.ub)


@compiled
def add_soft(qp: QPViews, A: Matrix, b: Vector, weight: float) -> None:
    """Add weight A^T A to P and -weight A^T b to q, for rows A (rows, n) and b (rows,)."""
    for k in range(b.size):
        for i in range(qp.q.size):
            scaled = weight * A[k, i]
            qp.q[i] -= scaled * b[k]
            for j in range(qp.q.size):
                qp.P[i, j] += scaled * A[k, j]


class LimitNames:
    """Names of the bounds and inequality rows of a controller's programs.

    Attributes:
        settings: `StepProgram.settings`.
        periods: Periods of the step.
    """

    def __init__(self, program: StepProgram, dt: float) -> None:
        """Take the limits of a step program and its control period [s]."""
        self.settings = program.settings()
        self.periods = constant_periods(dt)
        self._program = program
        numbers = (program.rate_limits or MotionLimits()).numbers(program.robot)
        self._limits = numbers.reshape(NUMBERS, -1)

    def conditions(self, q: Vector, least: Vector) -> tuple[str, ...]:
        """State which promises wait for the arm to come nearer to them.

        They are pairs that keep another distance than the scheme's, `least` (pairs,) [m], and
        relations of joints that the positions q (n,) [rad] do not fulfil.
        """
        near = [
            f"{names} meet, and no direction leads apart"
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

    def codes(self, bounds: Matrix, sides: NDArray[Any], past: Matrix) -> NDArray[np.int8]:
        """Give the bounds on some sides of a program's joints their codes.

        Args:
            bounds: Lower and upper bounds of the joints [rad/s], (2, n).
            sides: Above 0 for an upper bound, below for a lower one, 0 for neither, (n,).
            past: Joint positions [rad], last command and the one before [rad/s], (3, n).

        Returns:
            Places in `naming.KINDS`, from 1, negative for lower bounds; 0 where `sides` is, (n,).
        """
        dof = past.shape[1]
        sign = np.sign(sides[:dof])
        lower, upper = bounds[:, :dof]
        value = np.where(sign > 0.0, upper, -lower)
        kinds = np.full(dof, POSITION)
        # Crossed bounds are others' than the robot's.
        close = np.where(lower > upper, -1.0, _CLOSE * self._limits[2])
        with np.errstate(invalid="ignore"):  # joints without limits
            for kind, candidate in zip(_KINDS, self._candidates(sign * past), strict=True):
                kinds[np.abs(candidate - value) <= close] = kind
        return np.asarray(sign * kinds, np.int8)

    def _candidates(self, past: Matrix) -> list[Vector]:
        """Return the upper bounds that the limit of each of `_KINDS` alone makes, (n,) [rad/s].

        Args:
            past: Joint positions [rad], last command and the one before [rad/s], (3, n); of the
                joints whose lower bounds are meant they have the other sign.
        """
        _, last, before = past
        _, _, velocity, acceleration, jerk, braking, _, lag = self._limits
        dt, _, longest, _, vary = self.periods
        usable = np.fmin(braking / longest, velocity / longest**2) / SHARE
        unit = dt**2 * np.fmin(jerk, usable)
        ways = zip((velocity - last) / unit, vary | (lag > 0.0), strict=True)
        room = [approach(x, own) for x, own in ways]
        # The velocity after which the acceleration can still be taken back in time.
        fastest = np.where(jerk < np.inf, last + unit * room, velocity)
        by_jerk = 2.0 * last - before + dt**2 * jerk
        return [by_jerk, last + dt * acceleration, fastest]
