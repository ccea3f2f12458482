"""The velocity controller: joint positions in, joint velocities out, one program a step."""

from __future__ import annotations

import copy
import threading
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.control.command import EXCEEDED, Command
from iiwa_dnn.control.cycle import INVALID, ControlLayout, take_step
from iiwa_dnn.control.paths import (
    References,
    beyond_reach,
    by_frame,
    paths_of,
    rank_warnings,
    setup_warnings,
    target_warnings,
    warn_of_bodies,
)
from iiwa_dnn.control.plan import ControlPlan, Instant
from iiwa_dnn.control.policies import POLICIES, Action, Policy
from iiwa_dnn.control.state import ControllerState, MotionState, count_as_sent
from iiwa_dnn.control.stopping import periods_to_rest
from iiwa_dnn.errors import InvalidInputError, warn_caller
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Matrix, Vector
from iiwa_dnn.references import Reference, Target
from iiwa_dnn.references.targets import TargetData
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.schemes import Scheme
from iiwa_dnn.schemes.layout import ProgramLayout, targets_of
from iiwa_dnn.schemes.periods import Periods, checked_longest, stated_periods
from iiwa_dnn.schemes.step import TARGET_SIZE

Mode = Literal["converged", "continuous"]
MODES: tuple[Mode, ...] = ("converged", "continuous")

_FLOAT = np.dtype(np.float64)

ACTION_OF = {int(action): action for action in Action}
"""Actions by their codes: a table is quicker than `Action(code)`."""


class Controller:
    """Velocity controller: the programs of a scheme, solved by a network at every step.

    In a robot's loop, `step` takes the measured joint positions and returns the command. Attributes
    may be set while the arm moves: the last commands and the reference's clock stay. Copies and
    pickles of a controller hold the last commands and the clock too. Threads may share a
    controller: its methods, other than `halt`, wait for each other. A reference, part or solver
    that is called by a step may read the controller; if it takes a step or sets an attribute, an
    error is raised.

    Attributes:
        robot: The robot, n joints, with the limits that the scheme keeps.
        scheme: Builds the programs; if it has no home, the first step's posture becomes it.
        reference: Path of the tip, or paths by frame name.
        dt: Control period [s].
        longest_period: Longest control period in a loop whose periods vary [s]; None: all are `dt`,
            unless a step states another one.
        mode: ``"converged"``: the network converges at every step. ``"continuous"``: the network's
            differential equation advances by one control period, as in the paper, so the command
            lags behind the solution: bounds of the joints hold, the rows of other limits only where
            the network has converged; beside obstacles the arm may stop.
        policy: Action at a step without a solution in ``converged`` mode (`control.policies`).
        solver: Network, integrators and tolerance; keeps the network's state between steps.
        path_lag: Time by which a policy has slowed the reference's clock [s].
    """

    def __init__(
        self,
        robot: Robot,
        scheme: Scheme,
        reference: References | None = None,
        *,
        dt: float = 1e-3,
        longest_period: float | None = None,
        mode: Mode = "converged",
        policy: Policy = "slow",
        solver: DNNSolver | None = None,
    ) -> None:
        """Take a robot, a scheme, and the settings of the loop.

        Args:
            robot: The robot.
            scheme: The scheme.
            reference: Path of the tip or of several frames; None where every step gets a target.
            dt: Control period [s].
            longest_period: Longest control period where periods vary [s]; None: they do not.
            mode: ``"converged"`` or ``"continuous"``.
            policy: ``"slow"``, ``"relax"`` or ``"stop"``.
            solver: The network and its integrators; None takes the paper's network, to 1e-9.

        Raises:
            InvalidInputError: An argument is out of range; the message names it.
        """
        self._lock = threading.RLock()
        self._state = ControllerState(0)
        self._derived: ControlLayout | None
        self._anchored: Scheme | None = None
        self.mode = mode
        self.policy = policy
        self.dt = dt
        self.longest_period = longest_period
        self.robot = robot
        self.scheme = scheme
        self.reference = reference
        self.solver = DNNSolver() if solver is None else solver

    def __setattr__(self, name: str, value: Any) -> None:
        if name.startswith("_"):
            object.__setattr__(self, name, value)
            return
        if name not in _CHECKS:
            raise AttributeError(f"Controller has no setting {name!r}")
        _CHECKS[name](name, value)
        with self._turn():
            self._set(name, value)

    def _set(self, name: str, value: Any) -> None:
        """Set an attribute, and discard the layout that depends on it."""
        before = vars(self).get(name)
        own = vars(self) | {name: value}
        if name in ("robot", "scheme") and "scheme" in own:
            own["scheme"].program(own["robot"])  # parts that do not fit the robot are refused
        if name in ("dt", "longest_period") and "longest_period" in own:
            checked_longest(own["longest_period"], own["dt"])
        # A number of numpy's names its type where it is written into C.
        number = float(value) if name in ("dt", "longest_period") and value is not None else value
        object.__setattr__(self, name, number)
        self._derived = None
        if name == "robot" and self._state.sizes[0] != value.dof:
            self._state = ControllerState(value.dof)
        # A verified stopping motion keeps the limits of before.
        if name in ("robot", "scheme") and value is not before:
            self._state.motion.stopping_periods = 0.0
            if "scheme" in vars(self):  # the robot is set before
                warn_of_bodies(self.robot, self.scheme.limits, self._state.warned)

    def __getstate__(self) -> dict[str, Any]:
        with self._lock:
            own = {"_state": copy.deepcopy(self._state), "solver": copy.deepcopy(self.solver)}
            return {**vars(self), **own, "_lock": None, "_derived": None}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state, _lock=threading.RLock(), _derived=None)

    def _turn(self) -> threading.RLock:
        """Return the lock of the kinematics and the state, which is not held yet.

        Raises:
            InvalidInputError: This thread holds the lock: a reference, part or solver that a step
                calls has called the controller.
        """
        if self._lock._is_owned():  # type: ignore[attr-defined]
            problem = "is within a step: what the step asks may only read it, or halt it"
            raise InvalidInputError("controller", problem, self)
        return self._lock

    @property
    def path_lag(self) -> float:
        """Time by which a policy has slowed the reference's clock [s]."""
        return self._state.motion.path_lag

    def step(
        self,
        q: ArrayLike,
        t: float,
        target: Target | Mapping[str, Target] | None = None,
        *,
        dt: float | None = None,
        elapsed: float | None = None,
    ) -> Command:
        """Compute the command for joint positions at a time, and count it as sent.

        Where periods vary (`longest_period`), either `dt` or `elapsed` is stated at each step. If
        neither is, the change of the velocities is limited as for the controller's `dt`, and their
        size as if they were held for the longest period.

        Args:
            q: Measured joint positions [rad], (n,).
            t: Time [s]; the reference is sampled at t - `path_lag`.
            target: Target in place of the reference's; with ``sample="end"`` as
                `Reference.feed_forward` gives it.
            dt: Period for which this command will be held [s]. If it varies without a
                `longest_period`, velocity and acceleration limits hold, jerk and position limits
                only where these allow (docs/limits.md).
            elapsed: Time since the last step [s], for which the last command was held.

        Returns:
            The command.

        Raises:
            InvalidInputError: `q` has another size than the robot has joints, or is not finite; or
                `t` is no number; or there is neither reference nor target; or a period is not above
                0; or both are given, or `elapsed` without a `longest_period`.
        """
        state = self._state
        before = state.numbers
        after = before
        if self._lock._is_owned():  # type: ignore[attr-defined]
            self._turn()
        try:
            with self._lock:
                before = state.numbers
                command = self._compute(q, t, target, dt, elapsed)
                after = state.next_numbers
                state.numbers = after
                if self.longest_period is not None:
                    state.slowed = 1.0 - command.fraction
                    state.booked = self.dt if dt is None else dt
                return command
        except BaseException as error:
            with self._lock:
                if state.numbers is after:  # interrupted before anybody got the command
                    state.numbers = before
            if isinstance(error, TypeError | InvalidInputError):
                checks.finite("t", t)
            raise

    def compute(self, q: Vector, t: float, target: Mapping[str, Target] | None = None) -> Command:
        """Compute a command that does not count as sent, unless it is passed to `send`.

        Args:
            q: Joint positions [rad], (n,).
            t: Time [s].
            target: Targets by frame name, in place of the reference's.
        """
        with self._turn():
            return self._compute(q, t, target, None, None)

    def send(self, dq: Vector, fraction: float = 1.0) -> None:
        """Count a velocity as sent for a control period, in place of a step's command.

        Args:
            dq: Joint velocity [rad/s], (n,).
            fraction: Fraction of the period by which the reference's clock advances.

        Raises:
            InvalidInputError: `dq` has another size, or is not finite, or the fraction is below 0.
        """
        sent = checks.finite_array("dq", dq, (self.robot.dof,))
        fraction = checks.not_negative("fraction", fraction)
        with self._turn():
            state = self._state
            motion = state.next_motion.duplicate()
            motion.last[:] = state.motion.last
            count_as_sent(motion, sent, self.dt)
            motion.path_lag = state.motion.path_lag + self.dt * (1.0 - fraction)
            state.numbers = motion.numbers

    def _compute(
        self,
        q: Any,
        t: float,
        target: Target | Mapping[str, Target] | None,
        dt: float | None,
        elapsed: float | None,
    ) -> Command:
        control_layout = self._derived
        state = self._state
        if control_layout is None or "start" not in state.warned:
            control_layout = self._prepare(q, t, target is None)
        plan = control_layout.plan if target is None else control_layout.given
        if control_layout.varies or not dt is elapsed is None:
            plan = self._vary(control_layout, plan, dt, elapsed)
        periods = plan.timing
        log_layout = control_layout.log_layout
        program = control_layout.program
        if not _is_plain(q, control_layout.shape):
            q = checks.joint_positions("q", q, self.robot.dof)
        program.kinematics.update(q)
        data = np.empty(log_layout.width)
        numbers = state.numbers
        if not plan.samples:
            found = self.targets(t - state.motion.path_lag, target, periods.expected)
            data[-found.size :] = found.ravel()  # the last numbers of a log
        if program.refreshed:
            last = state.motion.last
            program.refresh(q, last, log_layout.targets(data), t, periods.expected)
        next_numbers = np.empty(control_layout.width)
        if state.halted:
            motion = state.motion.duplicate()
            motion.halts = True
            numbers = motion.numbers
        network = self.solver.state_for(program.sizes) if control_layout.has_network else data[:0]
        action = take_step(data, plan, q, numbers, next_numbers, network, t)
        if action == INVALID:
            checks.finite("t", t)
            checks.joint_positions("q", q, self.robot.dof)
            checks.finite_array("target", log_layout.targets(data), (-1, TARGET_SIZE))
        state.next_numbers = next_numbers
        return Command(data, log_layout, ACTION_OF[action], periods)

    def _vary(
        self, layout: ControlLayout, plan: ControlPlan, dt: float | None, elapsed: float | None
    ) -> ControlPlan:
        """Return the plan of a step with stated periods; correct the path lag by `elapsed` [s]."""
        timing = periods_of_step(self, self._state.warned, dt, elapsed)
        plan.network.settings.duration = timing.expected * layout.lag
        if elapsed is not None:
            self._state.book(elapsed)
        return plan._replace(timing=timing)

    def is_clear(self, q: Vector, dq: Vector) -> bool:
        """Test whether a velocity brings no watched pair nearer than its least distance.

        With limits on acceleration or jerk the result is True, without a test.

        Args:
            q: Joint positions [rad], (n,).
            dq: Joint velocity within the bounds and rows of the program at q [rad/s], (n,).
        """
        with self._turn():
            control_layout = self.control_layout
            if control_layout.program.rate_limits is not None:
                return True
            plan = control_layout.plan
            rest = MotionState.zeros(*self._state.sizes)
            least = self._state.next_motion.least
            targets = np.zeros((0, TARGET_SIZE))
            step = control_layout.program.step_at(
                q, rest.last, rest.before, targets, self.dt, 0.0, least
            )
            return bool(periods_to_rest(plan, Instant(step, rest, rest), dq) < np.inf)

    def _prepare(self, q: ArrayLike, t: float, own: bool) -> ControlLayout:
        """Anchor the scheme at q (n,), warn of the start at the first step; return the layout.

        `own` says that the targets are the reference's.
        """
        checks.finite("t", t)
        start = Configuration(self.robot, checks.joint_positions("q", q, self.robot.dof))
        self.anchor(start)
        if "start" not in self._state.warned:
            self.warn_of_start(start, t, own)
        return self.control_layout

    @property
    def control_layout(self) -> ControlLayout:
        """Layout of the control step for the present settings."""
        control_layout = self._derived
        if control_layout is not None:
            return control_layout
        with self._lock:
            program = self.scheme.program(self.robot)
            policy = int(Action[self.policy.upper()])
            paths = self._seen(by_frame(self.reference, self.robot.tip), self.dt)
            longest = self.longest_period
            control_layout = ControlLayout(
                program, paths, self.solver, self.dt, policy, longest, self.mode == "continuous"
            )
            self._state.watch([names for names, _ in program.pairs])
            if self._anchored is self.scheme:  # else the next step gives the scheme its home
                self._derived = control_layout
            return control_layout

    @property
    def positions(self) -> Vector:
        """Joint positions of the last step [rad], (n,); before the first, the robot's start."""
        with self._lock:
            own = self._state.motion.q if self._anchored else self.robot.start_posture()
            return np.array(own)

    @property
    def program(self) -> ProgramLayout:
        """Layout of the scheme's program for the robot."""
        return self.control_layout.program

    def halt(self) -> None:
        """Brake at every step from now on."""
        self._state.halted = True  # no array: a step that goes on may replace it

    def anchor(self, start: Configuration) -> None:
        """Make a configuration the scheme's home, if it has none."""
        with self._lock:
            scheme = self.scheme.anchored(start)
            if scheme is not self.scheme:
                self._set("scheme", scheme)
            self._anchored = scheme
            self._state.motion.q[:] = start.q

    def warn_of_start(self, start: Configuration, t: float, own: bool) -> None:
        """Warn of settings, a start posture or a first target that are most likely wrong, once.

        Args:
            start: Configuration in which the loop begins.
            t: Time at which it begins [s].
            own: Whether the targets are the reference's.
        """
        self._state.warned.add("start")
        program = self.program
        found = [*setup_warnings(program, start, t, self.dt, self.mode)]
        if own:
            found += rank_warnings(program, start, t, self.dt, self.targets)
            found += target_warnings(self.scheme, program.target_frames, start, self.targets(t))
            away = beyond_reach(self.reference, self.robot)
            found += [f"the path leads {away:.3g} m beyond the arm's reach"] * (away > 0.0)
        for message in found:
            warn_caller(message)

    def reset(self) -> None:
        """Reset the network's state, the last commands, the path lag and a halt; the home stays."""
        with self._turn():
            self.solver.reset()
            self._state.rest()
            self._derived = None

    def warm_up(self, q: ArrayLike) -> None:
        """Lay the program out before the first step, which is then as quick as the others.

        Args:
            q: Joint positions of the first step [rad], (n,), which become the scheme's home if it
                has none.
        """
        with self._turn():
            self.anchor(Configuration(self.robot, q))
            self._derived = self.control_layout

    def targets(
        self,
        t: float,
        target: Target | Mapping[str, Target] | None = None,
        dt: float | None = None,
    ) -> Matrix:
        """Return the targets of the tracked frames, (k, 18): the given ones, or the reference's.

        Args:
            t: Time of the reference's clock [s].
            target: Targets in place of the reference's.
            dt: Control period, for feed-forward [s]; None takes the controller's.

        Raises:
            InvalidInputError: A tracked frame has no reference, or a frame that is not tracked has
                one.
        """
        frames = self.program.target_frames
        if target is not None:
            return np.array(targets_of(self.robot.tip, frames, target))
        given = paths_of(self.reference, self.robot.tip, frames)
        paths = self._seen(given, dt or self.dt).values()
        found = np.array([path.base for path in paths])
        for path, data in zip(paths, found, strict=True):
            path.move(t, TargetData.of(data))
        return found

    def _seen(self, paths: Mapping[str, Reference], dt: float) -> Mapping[str, Reference]:
        """Return references with feed-forward over dt [s], if the scheme samples at the end."""
        at_end = self.scheme.sample == "end"
        return {name: path.feed_forward(dt) if at_end else path for name, path in paths.items()}

    def placement(self, q: Vector) -> Vector:
        """Compute the placement of the first tracked frame at joint positions q (n,), (12,)."""
        with self._turn():
            arrays = self.control_layout.plan.arrays
            self.program.kinematics.update(q)
            return np.array(arrays.placements[arrays.tip])

    def program_at(self, q: Vector, targets: Matrix, t: float) -> QP:
        """Build the program at joint positions q (n,) [rad] for targets (k, 18)."""
        with self._turn():
            motion = self._state.motion
            least = self._state.next_motion.least.copy()
            return self.program.qp_at(q, motion.last, motion.before, targets, self.dt, t, least)


def periods_of_step(
    loop: Any, warned: set[str], dt: float | None, elapsed: float | None
) -> Periods:
    """Return the periods of a step; warn of one above the longest.

    Args:
        loop: A controller or shield.
        warned: Warnings that the loop has given; `EXCEEDED` is added.
        dt: Period for which the command will be held [s], if it is stated.
        elapsed: Time since the last step [s], if it is stated.

    Raises:
        InvalidInputError: A period is not above 0, or another one than the loop's may be stated.
    """
    longest = loop.longest_period
    periods = stated_periods(loop.dt, longest, dt, elapsed)
    if periods.exceeded and EXCEEDED not in warned:
        warned.add(EXCEEDED)
        problem = f"a period of {periods.dt:g} s is above the longest, {longest:g} s"
        warn_caller(f"{problem}: limits may be passed")
    return periods


def _is_plain(q: Any, shape: tuple[int, ...]) -> bool:
    """Test whether joint positions are an array of float64 of this shape, without gaps."""
    # Of bytes in another order Pinocchio makes other numbers, without a word.
    plain: bool = type(q) is np.ndarray and q.dtype is _FLOAT and q.shape == shape
    return plain and (q.base is None or q.flags.c_contiguous)  # own data have no gaps


# Checks of the attributes that may be set.
_CHECKS: dict[str, Callable[[str, Any], object]] = {
    "robot": partial(checks.instance, kind=Robot),
    "scheme": partial(checks.instance, kind=Scheme),
    "reference": lambda name, value: by_frame(value, ""),
    "dt": checks.positive,
    "longest_period": lambda name, value: value is None or checks.positive(name, value),
    "mode": partial(checks.one_of, choices=MODES),
    "policy": partial(checks.one_of, choices=POLICIES),
    "solver": partial(checks.instance, kind=DNNSolver),
}
