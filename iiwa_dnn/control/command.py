"""Commands of control steps, and the layout of the logs behind them."""

from typing import Any, NamedTuple

import numpy as np

from iiwa_dnn.naming import DONE, LimitKind, active_limits, describe
from iiwa_dnn.qp import QP, Matrix, Solution, Vector
from iiwa_dnn.qp.layout import Sizes, offsets
from iiwa_dnn.schemes.names import LimitNames
from iiwa_dnn.schemes.periods import Periods
from iiwa_dnn.schemes.program import ProgramSizes
from iiwa_dnn.schemes.step import TARGET_SIZE
from iiwa_dnn.step.log import ADVANCED, STATUSES, StepLog, log_of, log_sizes
from iiwa_dnn.step.policies import Action, ProgramKind

EXCEEDED = "period exceeded"
"""Reason of a step whose stated period is above the longest."""

SINGULAR = "a singular posture, or tasks that contradict each other"
"""Reason of a relaxed program that no bound or row limits."""


class LogLayout(NamedTuple):
    """Layout of the step logs of a scheme.

    Attributes:
        sizes: Sizes of the programs.
        width: Number of floats in a log.
        dq: Slice of the command in a log.
        next_q: Slice of the joint positions at the end of the period in a log.
        names: `LimitNames` of the scheme; None if limits are not to be named.
    """

    sizes: ProgramSizes
    width: int
    dq: slice
    next_q: slice
    names: Any

    def targets(self, data: Vector) -> Matrix:
        """Return the targets of the k tracked frames in a log (width,), a view, (k, 18)."""
        frames = self.sizes.frames
        return data[self.width - frames * TARGET_SIZE :].reshape(frames, TARGET_SIZE)

    @property
    def qp_sizes(self) -> Sizes:
        """Numbers ``(n, m, p)`` of variables, inequality and equality rows of the programs."""
        return self.sizes[:3]

    def multipliers(self, logs: Matrix) -> tuple[Matrix, Matrix]:
        """Return the multipliers of the bounds and inequality rows that limit the answers.

        Args:
            logs: Logs of steps, (..., width).

        Returns:
            Entries of `Solution.z_box` (..., dof) and `Solution.z` (..., m); 0 for a bound or row
            that does not limit, whose `StepLog.limiting` is 0.
        """
        n, m, p = self.qp_sizes
        log = log_of(logs, self.sizes)
        of_rows, of_bounds = np.split(log.point[..., n + p :], [m], axis=-1)
        of_sides = np.concatenate([of_bounds, of_rows], axis=-1)
        active = np.where(log.limiting != 0.0, of_sides, 0.0)
        return active[..., : self.sizes.joints], active[..., n:]

    def excess(self, logs: Matrix) -> Vector:
        """Compute the largest violation of each command's limits, (k,); 0 if there is none.

        Limits are the bounds `StepLog.lower` and `StepLog.upper` [rad/s] and, unless the program is
        `RATE_LIMITED` or `STOPPED`, the inequality rows G x <= h, in the unit of h.

        Args:
            logs: Logs of k steps, (k, width).
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
    """Lay out the step logs for programs of some sizes, with the names of their limits."""
    columns = StepLog.columns(*log_sizes(sizes))
    width = columns["targets"].stop
    return LogLayout(sizes, width, columns["dq"], columns["next_q"], names)


class Command:
    """Command of one control step of n joints, with the program that was answered.

    Attributes:
        data: Numbers of the step's `log`, (width,).
        dq: Commanded joint velocity [rad/s], (n,), a view of `data`.
        action: Action of the policy; ``Action.NONE`` if the task was followed at full velocity.
        periods: Control periods for which the limits of the step were computed.
    """

    __slots__ = ("_layout", "_words", "action", "data", "dq", "periods")

    def __init__(
        self,
        data: Vector,
        layout: LogLayout,
        action: Action,
        periods: Periods,
        words: tuple[str, ...] = (),
    ) -> None:
        """Wrap the numbers of a log (width,), which are not copied, their layout, and `reasons`."""
        self.data = data
        self.dq = data[layout.dq]
        self.action = action
        self.periods = periods
        self._layout = layout
        self._words = words

    @property
    def log(self) -> StepLog:
        """Log of the step, a view of `data`."""
        return log_of(self.data, self._layout.sizes)

    @property
    def reasons(self) -> tuple[str, ...]:
        """Warnings of the step: a period that is too long, and bodies of bounded speed."""
        return (EXCEEDED,) * self.periods.exceeded + self._words

    @property
    def next_q(self) -> Vector:
        """Joint positions at the end of the period, q + dt dq [rad], (n,), a view of `data`."""
        return self.data[self._layout.next_q]

    @property
    def fraction(self) -> float:
        """Fraction of the control period by which the reference's clock advances, in [0, 1]."""
        return self.log.fraction

    @property
    def active_limits(self) -> tuple[str, ...]:
        """Names of the bounds and inequality rows that limit the command.

        The `reasons` come before them, and the `conditions` after. If the relaxed program is
        limited by none, a singular posture or contradicting tasks are named.
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
        """Texts on pairs that keep less than the scheme's distance, and unmet joint couplings."""
        log = self.log
        found: tuple[str, ...] = self._layout.names.conditions(log.q, log.least)
        return found

    @property
    def qp(self) -> QP:
        """Program that was answered; `kind` says how it differs from the nominal one."""
        return QP.from_data(self.log.program, self._layout.qp_sizes)

    @property
    def kind(self) -> ProgramKind:
        """Kind of the program that was answered."""
        return ProgramKind(self.log.kind)

    @property
    def bounds(self) -> Matrix:
        """Lower and upper bounds of the nominal program on the command [rad/s], (2, n)."""
        log = self.log
        return np.array([log.lower, log.upper])

    @property
    def limits(self) -> QP:
        """Program that was answered, a copy, with the nominal `bounds` on the joint velocities."""
        qp = QP.from_data(self.log.program.copy(), self._layout.qp_sizes)
        qp.lb[: self.dq.size], qp.ub[: self.dq.size] = self.bounds
        return qp

    @property
    def targets(self) -> Matrix:
        """Targets of the tracked frames, (k, 18)."""
        return self.log.targets

    @property
    def solution(self) -> Solution:
        """Answer to `qp`; if `kind` is `RATE_LIMITED`, `dq` is a step towards it."""
        log = self.log
        stats = log.stats
        residuals = (stats.primal, stats.dual, stats.gap)
        sizes = self._layout.qp_sizes
        status = STATUSES[log.status]
        return Solution(log.point, sizes, status, int(stats.iterations), stats.time, *residuals)

    @property
    def ok(self) -> bool:
        """True if no policy acted and the answer converged or, in continuous mode, was advanced."""
        return self.action is Action.NONE and self.log.status <= ADVANCED

    @property
    def limited(self) -> bool:
        """True if a policy other than ``stop`` acted and only rate limits are active.

        Rate limits are those of acceleration and jerk; at least one of them is active. The arm is
        then on its way to the task velocity, or the targets are too noisy to be followed.
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
