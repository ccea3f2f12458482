"""The velocity controller: joint positions in, joint velocities out, one program a step."""

from __future__ import annotations

import copy
import math
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.checks import Vector3
from iiwa_dnn.control.arm_layout import ArmLayout, lay_out_arm, see
from iiwa_dnn.control.command import EXCEEDED, Command
from iiwa_dnn.control.desk import step_measured
from iiwa_dnn.control.news import News, separation_in
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
from iiwa_dnn.control.step_layout import ControlLayout
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
from iiwa_dnn.step.arms import send_arm
from iiwa_dnn.step.cycle import INVALID
from iiwa_dnn.step.inputs import LONGEST, SHORTEST, begin_step
from iiwa_dnn.step.memory import ArmInput, ArmPlan, ArmSettings, halt_arm, motion_of
from iiwa_dnn.step.plan import Instant
from iiwa_dnn.step.policies import POLICIES, Action, Policy
from iiwa_dnn.step.state import MotionState
from iiwa_dnn.step.stopping import TRIES, periods_to_rest

Mode = Literal["converged", "continuous"]
MODES: tuple[Mode, ...] = ("converged", "continuous")

NOTHING = np.zeros(0)
"""No targets, for those of the paths; no state, of a network in Python."""

ACTION_OF = {int(action): action for action in Action}
"""Actions by their codes: a table is quicker than `Action(code)`."""


class Kept(NamedTuple):
    """State of a controller that a layout for other settings takes over.

    Attributes:
        motion: Numbers of the `MotionState`, (k,).
        pairs: Names and least distance of each watched pair.
        period: Time for which the last command is held [s].
        fraction: Fraction of it by which the reference's clock goes on.
        robot: The robot whose limits a verified stopping motion keeps.
        scheme: The scheme whose limits it keeps.
    """

    motion: Vector
    pairs: list[Any]
    period: float
    fraction: float
    robot: Robot
    scheme: Scheme


@dataclass(slots=True)
class Arm:
    """Layout and memories of a controller's arm, (k,) each.

    Attributes:
        layout: Layout of a step.
        plan: Its plan.
        last: Memory after the last step.
        spare: That which the next computation overwrites.
        computed: That of the two which was computed last.
    """

    layout: ArmLayout
    plan: ArmPlan
    last: Vector
    spare: Vector
    computed: Vector


class Controller(checks.Whole):
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
        self._warned: set[str] = set()  # "start", and warnings that are not given again
        self._halted = False
        self._kept: Kept | None = None
        self._arm: Any = None  # an `Arm`, if it is laid out
        self._ready: ControlLayout | None = None  # if nothing is left to do before a step
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
        self._kept = self._state()
        object.__setattr__(self, name, number)
        self._arm = self._ready = None
        if name in ("robot", "scheme") and value is not before and "scheme" in vars(self):
            warn_of_bodies(self.robot, self.scheme.limits, self._warned)

    def _state(self) -> Kept | None:
        """Return the state for another layout; None before the first one."""
        if self._arm is None:
            return self._kept
        layout = self._arm.layout
        arm = layout.state(self._arm.last)
        own = (arm.motion.copy(), layout.step.program.pairs, arm.period, arm.fraction)
        return Kept(*own, layout.step.program.robot, self.scheme)

    def __getstate__(self) -> dict[str, Any]:
        with self._lock:
            own = {"_kept": self._state(), "_warned": {*self._warned}}
            none = dict.fromkeys(("_lock", "_arm", "_ready"))
            return {**vars(self), **own, "solver": copy.deepcopy(self.solver), **none}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state, _lock=threading.RLock())

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
        return self._motion.path_lag

    @property
    def _motion(self) -> MotionState:
        """State of the motion, a view."""
        layout = self.arm_layout
        return motion_of(layout.plan, layout.state(self._arm.last))

    def step(
        self,
        q: ArrayLike,
        t: float,
        target: Target | Mapping[str, Target] | None = None,
        *,
        people: ArrayLike | Sequence[Any] | None = None,
        obstacles: Mapping[str, Any] | None = None,
        age: float | None = None,
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
            people: A frame of people, as for `Shield.step`, where a limit is a `Separation`.
            obstacles: Or the place of each body with a speed that was seen, by its name.
            age: Time since they were seen [s]; None: the latency.
            dt: Period for which this command will be held [s]. If it varies without a
                `longest_period`, velocity and acceleration limits hold, jerk and position limits
                only where these allow (docs/limits.md).
            elapsed: Time since the last step [s], for which the last command was held.

        Returns:
            The command.

        Raises:
            InvalidInputError: `q` has another size than the robot has joints, or is not finite; or
                `t` is no number; or there is neither reference nor target; or a period is not above
                0; or both are given, or `elapsed` without a `longest_period`; or people have a
                wrong shape, or no limit keeps away from them.
            NotFoundError: There is no body of a name.
        """
        arm = None
        before: Vector = NOTHING
        after: Vector = NOTHING
        if self._lock._is_owned():  # type: ignore[attr-defined]
            self._turn()
        try:
            with self._lock:
                if people is not None or obstacles is not None:
                    self._see(News(separation_in(self.scheme.limits), people, obstacles, age))
                command = self._compute(q, t, target, dt, elapsed)
                arm = self._arm
                before = arm.last
                after = arm.spare
                arm.last = after
                arm.spare = before
                return command
        except BaseException as error:
            with self._lock:
                if arm and arm.last is after:  # interrupted before anybody got the command
                    arm.last = before
                    arm.spare = after
            if isinstance(error, TypeError | InvalidInputError):
                checks.finite("t", t)
            raise

    def _see(self, news: News) -> None:
        """Take what was seen of bodies of bounded speed."""
        see(self.arm_layout.plan, self._arm.last, news)

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
            layout = self.arm_layout
            memory = self._arm.computed.copy()
            motion = motion_of(layout.plan, layout.state(memory))
            motion.last[:] = self._motion.last
            motion.path_lag = self._motion.path_lag
            send_arm(layout.plan, memory, sent, self.dt, fraction)
            self._arm.last[:] = memory

    def _compute(
        self,
        q: Any,
        t: float,
        target: Target | Mapping[str, Target] | None,
        dt: float | None,
        elapsed: float | None,
    ) -> Command:
        """Compute a command, and the memory after it."""
        step = self._ready or self._prepare(q, t, target is None)
        program = step.program
        periods = step.timing
        clock = (t, 0.0, 0.0)
        if step.varies or not dt is elapsed is None:
            periods = periods_of_step(self, self._warned, dt, elapsed)
            clock = (t, dt or 0.0, elapsed or 0.0)
        if not checks.is_plain(q, step.shape):
            q = checks.joint_positions("q", q, self.robot.dof)
        program.kinematics.update(q)
        arm = self._arm
        if self._halted:
            halt_arm(arm.plan, arm.last)
        targets: Vector = NOTHING
        if step.asks or target is not None:
            targets = self._ask(q, clock, target, periods.expected)
        data = np.empty(step.width)
        network = self.solver.state_for(program.sizes) if step.has_network else NOTHING
        action = step_measured(arm.plan, arm.last, arm.spare, q, targets, clock, data, network)
        if action == INVALID:
            self._refuse(q, clock, targets)
        arm.computed = arm.spare
        words = arm.layout.reasons_of_bodies(arm.spare)
        return Command(data, step.log_layout, ACTION_OF[action], periods, words)

    def _refuse(self, q: Vector, clock: Vector3, targets: Vector) -> None:
        """Raise the error of a step that is refused, whose arguments are those of `_compute`."""
        checks.finite("t", clock[0])
        checks.joint_positions("q", q, self.robot.dof)
        checks.finite_array("target", targets, (-1,))
        problem = f"must be from {SHORTEST:g} to {LONGEST:g} s"
        raise InvalidInputError("dt or elapsed", problem, clock[1:])

    def _ask(
        self,
        q: Vector,
        clock: Vector3,
        target: Target | Mapping[str, Target] | None,
        dt: float,
    ) -> Vector:
        """Call what is in Python for a step; return its targets, (18 k,).

        Args:
            q: Joint positions [rad], (n,).
            clock: As that of `step_measured`.
            target: Targets in place of the reference's.
            dt: Period that is expected [s].

        Returns:
            The targets; none if the compiled paths have them.
        """
        layout = self.arm_layout
        t, _, elapsed = clock
        memory = self._arm.last.copy()
        begin_step(layout.plan, memory, ArmInput(q, 0, NOTHING, 0.0, elapsed, t))
        motion = motion_of(layout.plan, layout.state(memory))
        targets = NOTHING
        if target is not None or not layout.step.samples:
            targets = self.targets(t - motion.path_lag, target, dt).ravel()
        if layout.step.program.refreshed:
            found = targets.reshape(-1, TARGET_SIZE)
            layout.step.program.refresh(q, motion.last, found, t, dt)
        return targets

    def is_clear(self, q: Vector, dq: Vector) -> bool:
        """Test whether a velocity brings no watched pair nearer than its least distance.

        With limits on acceleration or jerk the result is True, without a test.

        Args:
            q: Joint positions [rad], (n,).
            dq: Joint velocity within the bounds and rows of the program at q [rad/s], (n,).
        """
        with self._turn():
            control_layout = self.control_layout
            if control_layout.program.joint_limits.rated:
                return True
            plan = control_layout.plan
            least = self._least
            rest = MotionState.zeros(dq.size, least.size)
            targets = np.zeros((0, TARGET_SIZE))
            step = control_layout.program.step_at(
                q, rest.last, rest.before, targets, self.dt, 0.0, least
            )
            return bool(periods_to_rest(plan, Instant(step, rest, rest), dq, TRIES) < np.inf)

    @property
    def _least(self) -> Vector:
        """Distance that each pair has to keep after the last computation [m], (pairs,), a copy."""
        layout = self.arm_layout
        return motion_of(layout.plan, layout.state(self._arm.computed)).least.copy()

    def _prepare(self, q: ArrayLike, t: float, own: bool) -> ControlLayout:
        """Anchor the scheme at q (n,), warn of the start at the first step; return the layout.

        `own` says that the targets are the reference's.
        """
        checks.finite("t", t)
        start = Configuration(self.robot, checks.joint_positions("q", q, self.robot.dof))
        self.anchor(start)
        if "start" not in self._warned:
            self.warn_of_start(start, t, own)
        step = self.control_layout
        self._ready = step
        return step

    @property
    def control_layout(self) -> ControlLayout:
        """Layout of the control step for the present settings."""
        return self.arm_layout.step

    @property
    def arm_layout(self) -> ArmLayout:
        """Layout of the arm's step for the present settings."""
        if self._arm is not None:
            return self._arm.layout  # type: ignore[no-any-return]
        with self._lock:
            program = self.scheme.program(self.robot)
            policy = int(Action[self.policy.upper()])
            paths = self._seen(by_frame(self.reference, self.robot.tip), self.dt)
            longest = self.longest_period
            step = ControlLayout(
                program, paths, self.solver, self.dt, policy, longest, self.mode == "continuous"
            )
            settings = ArmSettings.make(
                dt=self.dt,
                longest=longest or 0.0,
                timeout=math.inf,
                tracking_error=0.0,
                delay=0.0,
            )
            layout = lay_out_arm(step, self.solver, settings)
            memory = self._taken_over(layout)
            self._arm = Arm(layout, layout.plan, memory, memory.copy(), memory)
            return layout

    def _taken_over(self, layout: ArmLayout) -> Vector:
        """Return the memory of an arm for a layout, with the state that is kept.

        If the watched pairs are others, the distances of all of them are set to 0, so that the next
        step initialises them. A stopping motion that was verified for other limits is none.
        """
        memory = layout.memory.copy()
        kept = self._kept
        if kept is not None and kept.robot.dof == self.robot.dof:
            arm = layout.state(memory)
            arm.period = kept.period
            arm.fraction = kept.fraction
            alike = dict(kept.pairs).keys() == dict(layout.step.program.pairs).keys()
            count = kept.motion.size - (0 if alike else len(kept.pairs))
            arm.motion[:count] = kept.motion[:count]
            if kept.robot is not self.robot or kept.scheme is not self.scheme:
                motion_of(layout.plan, arm).stopping_periods = 0.0
        return memory

    @property
    def positions(self) -> Vector:
        """Joint positions of the last step [rad], (n,); before the first, the robot's start."""
        with self._lock:
            own = self._motion.q if self._anchored else self.robot.start_posture()
            return np.array(own)

    @property
    def program(self) -> ProgramLayout:
        """Layout of the scheme's program for the robot."""
        return self.control_layout.program

    def halt(self) -> None:
        """Brake at every step from now on."""
        self._halted = True  # no array: a step that goes on may replace it

    def anchor(self, start: Configuration) -> None:
        """Make a configuration the scheme's home, if it has none."""
        with self._lock:
            scheme = self.scheme.anchored(start)
            if scheme is not self.scheme:
                self._set("scheme", scheme)
            self._anchored = scheme
            self._motion.q[:] = start.q

    def warn_of_start(self, start: Configuration, t: float, own: bool) -> None:
        """Warn of settings, a start posture or a first target that are most likely wrong, once.

        Args:
            start: Configuration in which the loop begins.
            t: Time at which it begins [s].
            own: Whether the targets are the reference's.
        """
        self._warned.add("start")
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
            self._halted = False
            self._kept = self._arm = self._ready = None

    def warm_up(self, q: ArrayLike) -> None:
        """Lay the program out before the first step, which is then as quick as the others.

        Args:
            q: Joint positions of the first step [rad], (n,), which become the scheme's home if it
                has none.
        """
        with self._turn():
            self.anchor(Configuration(self.robot, q))

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
            motion = self._motion
            last, before = motion.last, motion.before
            return self.program.qp_at(q, last, before, targets, self.dt, t, self._least)


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
