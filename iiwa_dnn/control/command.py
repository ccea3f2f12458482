"""A command and its answer: the log of one step, which the step writes and records keep."""

from typing import Any, NamedTuple

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.control.policies import Action, ProgramKind
from iiwa_dnn.control.state import MotionState
from iiwa_dnn.naming import DONE, LimitKind, active_limits, describe
from iiwa_dnn.networks.integrators.base import SolveStats
from iiwa_dnn.qp import QP, Matrix, Solution, Status, Vector
from iiwa_dnn.qp.dense import row_dot
from iiwa_dnn.qp.layout import QPViews, Sizes, data_size, offsets
from iiwa_dnn.schemes.names import LimitNames
from iiwa_dnn.schemes.periods import Periods
from iiwa_dnn.schemes.program import ProgramSizes
from iiwa_dnn.schemes.step import TARGET_SIZE

PLACEMENT = 12
"""Numbers of a frame's placement, as `Kinematics.placements` has them."""

EXCEEDED = "period exceeded"


SINGULAR = "a singular posture, or tasks that contradict each other"


"""Reason of a relaxed program that no bound or row limits."""

STATUSES = tuple(Status)
"""Statuses by their number in a log."""
SOLVED, ADVANCED, NOT_CONVERGED, NOT_FINITE, *_ = range(len(STATUSES))


class StepLog(Record):
    """Log of one step, for a program of n variables, m and p rows, and dof joints.

    Attributes:
        fraction: Fraction of the period by which the reference's clock advances.
        status: Number of the answer's status in `STATUSES`.
        kind: `ProgramKind` of the program.
        stats: Statistics of the answer.
        placement: Placement of the first tracked frame, (12,).
        q: Joint positions that the program was built at [rad], (dof,).
        last: Last command [rad/s], (dof,).
        before: Command before it [rad/s], (dof,).
        dq: Command [rad/s], (dof,).
        next_q: Joint positions at the end of the period, q + dt dq [rad], (dof,).
        lower: Lower bounds of the step that the command keeps [rad/s], (dof,). Those of the program
            are others where limits of acceleration or jerk limit the command.
        upper: Upper bounds, (dof,).
        lower_kind: `LimitKind` of each lower bound of the program, (dof,).
        upper_kind: The same of the upper bounds, (dof,).
        program: The program, `QP.data`, (size,).
        point: The answer, `Solution.point`, (2 n + m + p,).
        limiting: For each joint the `LimitKind` of the bound that limits the solution, negative for
            a lower bound, or 0; after all variables for each inequality row 1 or 0, (n + m,).
        least: Distance that each watched pair has to keep [m], (pairs,), as in `MotionState`.
        targets: Targets of the tracked frames, (k, 18).
    """

    fraction: float
    status: int
    kind: int
    stats: SolveStats = part(SolveStats)
    placement: Vector = part(PLACEMENT)
    q: Vector = part("joints")
    last: Vector = part("joints")
    before: Vector = part("joints")
    dq: Vector = part("joints")
    next_q: Vector = part("joints")
    lower: Vector = part("joints")
    upper: Vector = part("joints")
    lower_kind: Vector = part("joints")
    upper_kind: Vector = part("joints")
    program: Vector = part("program")
    point: Vector = part("point")
    limiting: Vector = part("sides")
    least: Vector = part("pairs")
    targets: Matrix = part("frames", TARGET_SIZE)


@compiled
def log_sizes(sizes: ProgramSizes) -> tuple[int, int, int, int, int, int]:
    """Return the sizes of `StepLog`, in the order of their names."""
    program = data_size(sizes.n, sizes.m, sizes.p)
    sides = sizes.n + sizes.m
    point = sides + sizes.n + sizes.p
    return sizes.joints, program, point, sides, sizes.pairs, sizes.frames


@compiled
def log_of(data: Vector, sizes: ProgramSizes) -> StepLog:
    """View the log of a step, (width,)."""
    joints, program, point, sides, pairs, frames = log_sizes(sizes)
    return StepLog.of(data, joints, program, point, sides, pairs, frames)


@compiled
def note_command(log: StepLog, next_motion_state: MotionState, dq: Vector, dt: float) -> None:
    """Note the command of a step, and where the arm is after it.

    Args:
        log: The step's log.
        next_motion_state: State for the next step.
        dq: The command [rad/s], (dof,) or longer.
        dt: Control period [s].
    """
    for i in range(log.dq.size):
        log.dq[i] = dq[i]
        next_motion_state.last[i] = dq[i]
        log.next_q[i] = log.q[i] + dt * dq[i]


@compiled
def note_active(log: StepLog, qp: QPViews, tolerance: float) -> None:
    """Note the active bounds and rows of the program that was answered.

    One is active if its multiplier is above the tolerance, and its part of the duality gap,
    multiplier times slack, is not; of a multiplier above one, the slack itself.
    """
    n = qp.q.size
    of_rows = log.point[n + qp.b.size :]
    log.limiting[:] = 0.0
    for j in range(qp.h.size):
        slack = np.inf if of_rows[j] == 0.0 else qp.h[j] - row_dot(qp.G, j, log.point)
        log.limiting[n + j] = 1.0 if is_active(of_rows[j], slack, tolerance) else 0.0
    for i in range(log.dq.size):
        multiplier = of_rows[qp.h.size + i]
        nearest = qp.ub[i] if multiplier > 0.0 else qp.lb[i]
        if is_active(multiplier, abs(nearest - log.point[i]), tolerance):
            log.limiting[i] = log.upper_kind[i] if multiplier > 0.0 else -log.lower_kind[i]


@compiled
def is_active(multiplier: float, slack: float, tolerance: float) -> bool:
    """Test whether a bound or row of some slack is active."""
    size = abs(multiplier)
    return size > tolerance and slack <= tolerance / min(size, 1.0)


class LogLayout(NamedTuple):
    """Layout of the logs of a scheme's steps.

    Attributes:
        sizes: Sizes of the programs.
        width: Length of a log.
        dq: Columns of the command.
        next_q: Columns of the joint positions after it.
        names: Names of the limits; None where nobody asks for them.
    """

    sizes: ProgramSizes
    width: int
    dq: slice
    next_q: slice
    names: Any

    def targets(self, data: Vector) -> Matrix:
        """Return the targets of a log, (k, 18), its last numbers, a view."""
        frames = self.sizes.frames
        return data[self.width - frames * TARGET_SIZE :].reshape(frames, TARGET_SIZE)

    @property
    def qp_sizes(self) -> Sizes:
        """Sizes ``(n, m, p)`` of the programs."""
        return self.sizes[:3]

    def multipliers(self, logs: Matrix) -> tuple[Matrix, Matrix]:
        """Return the multipliers of active bounds, (..., dof), and inequality rows, (..., m).

        They are those of `Solution.z_box` and `Solution.z` where `StepLog.limiting` names the bound
        or row, else 0.

        Args:
            logs: Logs of steps, (..., width).
        """
        n, m, p = self.qp_sizes
        log = log_of(logs, self.sizes)
        of_rows, of_bounds = np.split(log.point[..., n + p :], [m], axis=-1)
        of_sides = np.concatenate([of_bounds, of_rows], axis=-1)
        active = np.where(log.limiting != 0.0, of_sides, 0.0)
        return active[..., : self.sizes.joints], active[..., n:]

    def excess(self, logs: Matrix) -> Vector:
        """Compute by how much commands are beyond the bounds of their steps [rad/s], (k,).

        Of a command that is not rate-limited, the excess over the inequality rows
        counts too.

        Args:
            logs: Logs of the commands, (k, width).
        """
        log = log_of(logs, self.sizes)
        free = np.asarray(log.kind)[:, np.newaxis] < ProgramKind.RATE_LIMITED
        n, m, p = self.qp_sizes
        _, at_G, at_A, _ = offsets(n, m, p)
        G, h = np.split(log.program[:, at_G:at_A], [m * n], axis=1)
        product = np.einsum("kji,ki->kj", G.reshape(*h.shape, n), log.point[:, :n])
        of_rows = np.where(free, product - h, 0.0)
        sides = [log.lower - log.dq, log.dq - log.upper, of_rows]
        excess: Vector = np.hstack(sides).max(axis=1, initial=0.0)
        return excess


def lay_out_log(sizes: ProgramSizes, names: LimitNames | None) -> LogLayout:
    """Lay out the logs of steps."""
    columns = StepLog.columns(*log_sizes(sizes))
    width = columns["targets"].stop
    return LogLayout(sizes, width, columns["dq"], columns["next_q"], names)


class Command:
    """Decision of one control step.

    Attributes:
        data: The numbers of its `log`, (width,), which the properties are views of.
        dq: Joint velocity [rad/s], (n,), within the limits.
        action: The action taken; ``Action.NONE`` where the network's answer was taken.
        periods: Periods of the step.
    """

    __slots__ = ("_layout", "action", "data", "dq", "periods")

    def __init__(self, data: Vector, layout: LogLayout, action: Action, periods: Periods) -> None:
        """Take a log (width,), which is not copied, its layout, the action and the periods."""
        self.data = data
        self.dq = data[layout.dq]
        self.action = action
        self.periods = periods
        self._layout = layout

    @property
    def log(self) -> StepLog:
        """The log of the step, a view."""
        return log_of(self.data, self._layout.sizes)

    @property
    def reasons(self) -> tuple[str, ...]:
        """Reasons beside limits for a command that need not be what is asked."""
        return (EXCEEDED,) if self.periods.exceeded else ()

    @property
    def next_q(self) -> Vector:
        """Joint positions at the end of the period, q + dt dq [rad], (n,), a view."""
        return self.data[self._layout.next_q]

    @property
    def fraction(self) -> float:
        """Fraction of the control period by which the reference's clock advances, in [0, 1]."""
        return self.log.fraction

    @property
    def active_limits(self) -> tuple[str, ...]:
        """Reasons, bounds and rows that keep the command from what tasks and cost ask, in words.

        The `conditions` are among them.
        """
        sizes = self._layout.sizes
        settings = self._layout.names.settings
        codes = self.log.limiting[: sizes.joints]
        words = [*map(describe, active_limits(settings, codes, self.log.limiting[sizes.n :]))]
        if not words and self.kind is ProgramKind.RELAXED:
            words = [SINGULAR]
        return (*self.reasons, *words, *self.conditions)

    @property
    def conditions(self) -> tuple[str, ...]:
        """Pairs that began nearer than they have to be, and relations that joints do not fulfil."""
        log = self.log
        found: tuple[str, ...] = self._layout.names.conditions(log.q, log.least)
        return found

    @property
    def qp(self) -> QP:
        """The program that was answered; `kind` says how it differs from the nominal one."""
        return QP.from_data(self.log.program, self._layout.qp_sizes)

    @property
    def kind(self) -> ProgramKind:
        """Kind of the program that was answered."""
        return ProgramKind(self.log.kind)

    @property
    def bounds(self) -> Matrix:
        """Lower and upper bounds of the command [rad/s], those of the step, (2, n)."""
        log = self.log
        return np.array([log.lower, log.upper])

    @property
    def limits(self) -> QP:
        """The program that was answered, with the bounds of the step: what the command keeps."""
        qp = QP.from_data(self.log.program.copy(), self._layout.qp_sizes)
        qp.lb[: self.dq.size], qp.ub[: self.dq.size] = self.bounds
        return qp

    @property
    def targets(self) -> Matrix:
        """Targets of the tracked frames, (k, 18)."""
        return self.log.targets

    @property
    def solution(self) -> Solution:
        """The network's answer to `qp`, which a rate-limited command is on its way to."""
        log = self.log
        stats = log.stats
        residuals = (stats.primal, stats.dual, stats.gap)
        sizes = self._layout.qp_sizes
        status = STATUSES[log.status]
        return Solution(log.point, sizes, status, int(stats.iterations), stats.time, *residuals)

    @property
    def ok(self) -> bool:
        """True if the command does all that the tasks ask."""
        return self.action is Action.NONE and self.log.status <= ADVANCED

    @property
    def limited(self) -> bool:
        """True if acceleration and jerk limits alone keep it from all that the tasks ask.

        Then the arm is on its way there, or noise asks for more than it may follow; a command that
        is neither `ok` nor limited cannot do it.
        """
        sizes = self._layout.sizes
        rows = self.log.limiting[sizes.n :]
        if self.action in (Action.NONE, Action.STOP) or rows.any():
            return False
        kinds = np.abs(self.log.limiting[: sizes.joints])
        found = kinds[kinds > 0]
        return bool(np.isin(found, [LimitKind.ACCELERATION, LimitKind.JERK]).all() and found.size)

    def __repr__(self) -> str:
        dq = np.array2string(self.dq, precision=4, separator=", ")
        words = "solved" if self.ok else "not converged"
        if self.action:
            words = f"no solution: {DONE[self.action.name.lower()]}"
            words += f", limited by {', '.join(self.active_limits)}" if self.active_limits else ""
        return f"<Command dq = {dq} rad/s, {words}; ok = {self.ok}>"
