"""Log of a control step: its program, its answer and its command."""

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.networks.integrators.base import SolveStats
from iiwa_dnn.qp import Matrix, Status, Vector
from iiwa_dnn.qp.dense import row_dot
from iiwa_dnn.qp.layout import QPViews, data_size
from iiwa_dnn.schemes.program import ProgramSizes
from iiwa_dnn.schemes.step import TARGET_SIZE
from iiwa_dnn.step.state import MotionState

PLACEMENT = 12
"""Numbers of a frame's placement, as `Kinematics.placements` has them."""

STATUSES = tuple(Status)
"""Statuses of an answer; the index of each is its code in a log."""
SOLVED, ADVANCED, NOT_CONVERGED, NOT_FINITE, *_ = range(len(STATUSES))


class StepLog(Record):
    """Log of one control step of dof joints.

    Its program has n variables, m inequality and p equality rows.

    Attributes:
        fraction: Fraction of the period by which the reference's clock advances.
        status: Index of the answer's status in `STATUSES`.
        kind: `ProgramKind` of the program that was answered.
        stats: Iterations, network time and residuals of the answer.
        placement: Placement of the first tracked frame, (12,).
        q: Joint positions at which the program was built [rad], (dof,).
        last: Command of the step before [rad/s], (dof,).
        before: Command of the step before `last` [rad/s], (dof,).
        dq: Command of this step [rad/s], (dof,).
        next_q: Joint positions at the end of the period, q + dt dq [rad], (dof,).
        lower: Lower bounds of the nominal program [rad/s], (dof,). If a fallback program was
            answered, its bounds may be wider.
        upper: Upper bounds of the nominal program [rad/s], (dof,).
        lower_kind: `LimitKind` of each lower bound of `program`, (dof,).
        upper_kind: `LimitKind` of each upper bound of `program`, (dof,).
        row_pair: `StepViews.row_pair` of each inequality row, (m,).
        program: The program that was answered, `QP.data`, (size,).
        point: The primal-dual answer, `Solution.point`, (2 n + m + p,).
        limiting: For each variable the `LimitKind` of the bound that limits it, negative for a
            lower bound, or 0; then for each inequality row 0, or 1 and its `row_pair` if it limits,
            (n + m,).
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
    row_pair: Vector = part("rows")
    program: Vector = part("program")
    point: Vector = part("point")
    limiting: Vector = part("sides")
    least: Vector = part("pairs")
    targets: Matrix = part("frames", TARGET_SIZE)


@compiled
def log_sizes(sizes: ProgramSizes) -> tuple[int, int, int, int, int, int, int]:
    """Return ``(joints, rows, program, point, sides, pairs, frames)``, the sizes of a `StepLog`."""
    program = data_size(sizes.n, sizes.m, sizes.p)
    sides = sizes.n + sizes.m
    point = sides + sizes.n + sizes.p
    return sizes.joints, sizes.m, program, point, sides, sizes.pairs, sizes.frames


@compiled
def log_of(data: Vector, sizes: ProgramSizes) -> StepLog:
    """View the numbers of a step log, (width,), as a `StepLog`."""
    joints, rows, program, point, sides, pairs, frames = log_sizes(sizes)
    return StepLog.of(data, joints, rows, program, point, sides, pairs, frames)


@compiled
def note_command(log: StepLog, next_motion_state: MotionState, dq: Vector, dt: float) -> None:
    """Write the command of a step into its log and the next state.

    Args:
        log: The step's log; `dq` and `next_q` are overwritten.
        next_motion_state: State for the next step; `last` is overwritten.
        dq: The command [rad/s], (dof,); further entries are ignored.
        dt: Control period [s].
    """
    for i in range(log.dq.size):
        log.dq[i] = dq[i]
        next_motion_state.last[i] = dq[i]
        log.next_q[i] = log.q[i] + dt * dq[i]


@compiled
def note_active(log: StepLog, qp: QPViews, tolerance: float) -> None:
    """Find the active bounds and inequality rows at the answer of a program (`is_active`).

    Args:
        log: The step's log, with the answer in `point`; `limiting` (n + m,) is overwritten.
        qp: The program, n variables and m inequality rows.
        tolerance: Tolerance of the answer.
    """
    n = qp.q.size
    of_rows = log.point[n + qp.b.size :]
    log.limiting[:] = 0.0
    for j in range(qp.h.size):
        slack = np.inf if of_rows[j] == 0.0 else qp.h[j] - row_dot(qp.G, j, log.point)
        acts = is_active(of_rows[j], slack, tolerance)
        log.limiting[n + j] = 1.0 + log.row_pair[j] if acts else 0.0
    for i in range(log.dq.size):
        multiplier = of_rows[qp.h.size + i]
        nearest = qp.ub[i] if multiplier > 0.0 else qp.lb[i]
        if is_active(multiplier, abs(nearest - log.point[i]), tolerance):
            log.limiting[i] = log.upper_kind[i] if multiplier > 0.0 else -log.lower_kind[i]


@compiled
def is_active(multiplier: float, slack: float, tolerance: float) -> bool:
    """Test whether a bound or row with this multiplier and slack is active.

    It is if the multiplier's size |z| is above the tolerance, and slack times min(|z|, 1) is not.
    """
    size = abs(multiplier)
    return size > tolerance and slack <= tolerance / min(size, 1.0)
