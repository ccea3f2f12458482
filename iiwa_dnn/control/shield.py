r"""A shield: any wish for a motion in, the nearest safe command out.

The wish is a joint velocity w, a twist v of a frame, or joint positions to reach. The command
answers the program of a `Controller` whose task is soft,

.. math::

    \min_x \; \tfrac12 \|x - w\|^2 \qquad \text{or} \qquad
    \min_x \; \tfrac12 \|J x - v\|^2 + \tfrac12 \lambda^2 \|x\|^2 ,

within the bounds and rows of its limits, and everything else is the controller's: the motion to
rest that is always in hand, and what is done where the limits leave no answer. A wish that the
limits admit, and from which the arm can stop, is the answer to the last bit. A wish for positions
is one for the quickest velocity from which each joint can still rest there. An arm without a wish
has one to rest.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.control.command import Command
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.state import BEFORE, LAST, YIELDS, ControllerState
from iiwa_dnn.control.stopping import least_periods
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.dense import all_finite
from iiwa_dnn.qp.layout import copied
from iiwa_dnn.references import Target
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes import (
    CollisionAvoidance,
    JointLimits,
    KineticEnergy,
    Limit,
    Obstacle,
    PoseTask,
    Scheme,
    Task,
    own_rate_limits,
)
from iiwa_dnn.schemes.collisions import avoidance_of
from iiwa_dnn.schemes.limits import (
    MotionLimits,
    Periods,
    braking,
    constant_periods,
    joint_bounds,
    positive_rates,
)
from iiwa_dnn.schemes.step import TARGET_SIZE, StepViews

DAMPING = 0.02
"""Lambda of a twist's program [m/rad]: near a singular pose the joints do not race."""

FASTEST = 1e3
"""Velocity [rad/s, m/s] to which a larger wish is cut before it is answered: no arm is so quick."""

TWIST = 6
"""Numbers of a twist."""

JOINTS = ""
"""Frame of wishes for all joints."""

REASONS = ("", "no wish", "wish too old", "wish not finite", "halted")
"""Reasons why a wish to rest counts; the first is none."""
NO_WISH, TOO_OLD, NOT_FINITE, HALTED = range(1, 5)

TAKEN_OVER = "measured positions taken over"

AGE, REASON, BEGUN, TAKEN = range(4)
"""Numbers of `ShieldState.flags`."""


@compiled
def wished_velocity(
    step: StepViews, constants: Vector, target: Vector, A: Matrix, b: Vector
) -> None:
    """Write A = I and b = w; the first numbers of the target (18,) are the velocity w (n,)."""
    for i in range(b.size):
        A[i, i] = 1.0
        b[i] = target[i]


@dataclass(frozen=True)
class JointVelocityTask(Task):
    """Joint velocities, a row each, which a step's target holds in place of a pose."""

    kernel = staticmethod(wished_velocity)
    weight = 1.0

    def row_count(self, robot: Robot) -> int:
        """Return the number of joints, at most as many as a target has numbers, 18."""
        return robot.dof


class ShieldState(NamedTuple):
    """Commanded positions and the wish that counts, which a step overwrites.

    Attributes:
        positions: Joint positions [rad], (n,).
        wish: The wish, (k,): zero without one.
        flags: Time since the wish came [s], its reason if it is not the given one, by its number in
            `REASONS`, 1 after the first step, and 1 if measured positions were taken over, (4,).
    """

    positions: Vector
    wish: Vector
    flags: Vector


@compiled
def take_positions(q: Vector, state: ShieldState, settings: Vector) -> None:
    """Take measured positions q (n,) [rad] over at the first step, or if they are far.

    The settings (3,) are control period [s], timeout [s] and tracking error [rad].
    """
    far = 0
    for i in range(q.size):
        far += not abs(q[i] - state.positions[i]) <= settings[2]
    state.flags[TAKEN] = 0.0
    if far > 0 or state.flags[BEGUN] == 0.0:
        state.flags[TAKEN] = state.flags[BEGUN]
        state.flags[BEGUN] = 1.0
        copied(state.positions, q)


@compiled
def take_wish(wish: Vector, given: bool, state: ShieldState, settings: Vector) -> bool:
    """Take a wish (k,) over if one is given, else the last one, or one to rest for a reason.

    The settings are those of `take_positions`.

    Returns:
        Whether the wish that counts is that of the last step.
    """
    flags = state.flags
    flags[AGE] += settings[0]
    if given and flags[REASON] != HALTED:
        flags[AGE] = 0.0
        flags[REASON] = 0.0 if all_finite(wish, 0, wish.size) else NOT_FINITE
    if flags[REASON] == 0.0 and flags[AGE] > settings[1] + 0.5 * settings[0]:
        flags[REASON] = TOO_OLD
    other = 0
    for i in range(wish.size):
        now = wish[i] if flags[REASON] == 0.0 else 0.0
        other += now != state.wish[i]
        state.wish[i] = now
    return other == 0


@compiled
def come_nearer(
    state: ShieldState,
    past: Matrix,
    limits: Vector,
    periods: Periods,
    reaches: bool,
    held: bool,
    dq: Vector,
) -> None:
    """Write the next velocities dq (n,) [rad/s] on the quickest way to the wish that counts.

    Those on the way to positions are the quickest ones from which all joints can still rest there.
    A joint that jerk limits keep from its velocity in this step, or that is asked for the same one
    as in the last step, does not pass it.

    Args:
        state: The wish, and where the joints are.
        past: `ControllerState.past`, (8, n).
        limits: `MotionLimits.numbers`, (6 n,).
        periods: Periods of the step.
        reaches: Whether the wish is one for positions.
        held: Whether it is that of the last step.
        dq: The velocities, overwritten.
    """
    n = dq.size
    for i in range(n):
        wish = state.wish[i]
        above = limits[n + i] - state.positions[i]
        below = state.positions[i] - limits[i]
        if reaches:
            left = wish - state.positions[i]
            above = left if left >= 0.0 else np.inf
            below = -left if left < 0.0 else np.inf
            wish = left / periods.hold
        wish = min(max(wish, -FASTEST), FASTEST)
        rates = (limits[2 * n + i], limits[3 * n + i], limits[4 * n + i], limits[5 * n + i])
        lower, upper = joint_bounds(past[LAST, i], past[BEFORE, i], above, below, rates, periods)
        if reaches:
            wish = min(max(wish, lower), upper)
        elif held or wish < lower or wish > upper:
            wish += braking(past[LAST, i] - wish, -np.inf, np.inf, limits[4 * n + i], periods)
        dq[i] = wish


class Margin(NamedTuple):
    """Distances to what the shield keeps away from.

    Attributes:
        joint: Least distance of a joint from its position limits [rad].
        distance: Least distance of a link from an obstacle or another link, less the promised
            one [m]; inf where none is watched.
    """

    joint: float
    distance: float


class ShieldCommand(NamedTuple):
    """Decision of one step of a shield.

    Attributes:
        dq: Joint velocity [rad/s], (n,), within the limits.
        wish: Joint velocity that was wished for [rad/s], (n,); None: positions, or a twist.
        reasons: Reasons for another wish than the given one.
        command: The controller's command, with the program that was answered.
        shield: The shield.
        t: Time of the shield's clock [s].
    """

    dq: Vector
    wish: Vector | None
    reasons: tuple[str, ...]
    command: Command
    shield: Shield
    t: float

    @property
    def clipped(self) -> bool:
        """Test whether it is another one than the given wish.

        For positions, than the quickest approach to them that the joints' own limits allow.
        """
        if self.wish is None or self.reasons:
            return bool(self.reasons or self.command.against)
        return bool((self.dq != self.wish).any())

    @property
    def limits(self) -> tuple[str, ...]:
        """Name the reasons, bounds and rows that keep the command from the given wish."""
        return (*self.reasons, *self.command.against) if self.clipped else ()

    @property
    def stopping_time(self) -> float:
        """Time of the motion to rest from the command [s]."""
        shield = self.shield
        cubic = bool(np.isfinite(shield.robot.dddq_max).any())
        periods = least_periods(self.dq, self.command.past[1], shield.motion, shield.dt, cubic)
        return shield.dt * max(periods, float(self.dq.any()))

    @property
    def margin(self) -> Margin:
        """Distances at the joint positions that the command starts from."""
        q = self.command.past[0]
        lower, upper = self.shield.robot.limits[:2]
        distance = math.inf
        if (avoidance := avoidance_of(self.shield)) is not None:
            scene = avoidance.scene(self.shield.robot)
            distance = scene.nearest(q[np.newaxis], np.array([self.t]))[0][0] - avoidance.distance
        return Margin(np.minimum(q - lower, upper - q).min(), distance)


class Shield:
    """The limits of a robot, kept for whoever drives it.

    The shield integrates its own commands; measured positions that are no further than
    `tracking_error` from them do not change them.

    Attributes:
        robot: The robot, n joints, whose limits hold.
        dt: Control period [s].
        limits: Limits that every command keeps.
        motion: Their numbers for the joints, `MotionLimits.numbers`, (6 n,).
        settings: Control period [s], timeout [s], tracking error [rad], (3,).
    """

    def __init__(
        self,
        robot: Robot,
        dt: float = 1e-3,
        obstacles: Sequence[Obstacle] | None = None,
        distance: float = 0.02,
        timeout: float = 0.1,
        tracking_error: float = 0.02,
    ) -> None:
        """Take a robot, and what is to be kept clear of.

        Args:
            robot: The robot, with limits on position and velocity; those on acceleration and jerk
                hold where it has them.
            dt: Control period [s].
            obstacles: Obstacles to keep away from, beside the arm's own links; None: neither.
            distance: Least distance from them [m].
            timeout: Time for which a wish counts [s]; inf: until the next one.
            tracking_error: Difference of measured and commanded positions [rad] above which the
                measured ones are taken over.

        Raises:
            InvalidInputError: An argument is out of range; the message names it.
        """
        self.robot = checks.instance("robot", robot, Robot)
        self.dt = checks.positive("dt", dt)
        self._periods = constant_periods(self.dt)
        self.settings = np.array(
            [
                self.dt,
                positive_rates("timeout", timeout),
                checks.not_negative("tracking_error", tracking_error),
            ]
        )
        rates = own_rate_limits(robot)
        self.motion = MotionLimits(rates).numbers(robot)
        self.limits: list[Limit] = [JointLimits(), *rates]
        if obstacles is not None:
            self.limits.append(CollisionAvoidance(obstacles, distance=distance))
        self._controllers: dict[str, Controller] = {}
        self._kept = ControllerState(robot.dof)
        self.reset()

    def __getstate__(self) -> dict[str, Any]:
        # The controllers share one state, and are made anew to share the copy's.
        own = {name: copy.deepcopy(getattr(self, name)) for name in ("_kept", "_state")}
        return {**vars(self), **own, "_controllers": {}}

    def reset(self) -> None:
        """Forget wishes, a halt and the last commands: the arm stands where it is measured next."""
        n = self.robot.dof
        self._kept.rest(n)
        self._state = ShieldState(np.zeros(n), np.zeros(max(n, TWIST)), np.zeros(4))
        self._state.flags[REASON] = NO_WISH
        self._asked = ("dq", JOINTS)
        self._t = 0.0

    def halt(self) -> None:
        """Brake from now on, whatever is wished for, until `reset`."""
        self._state.flags[REASON] = HALTED

    def step(
        self,
        q: ArrayLike,
        dq: ArrayLike | None = None,
        *,
        twist: ArrayLike | None = None,
        position: ArrayLike | None = None,
        frame: str | None = None,
    ) -> ShieldCommand:
        """Compute the command that is nearest to a wish.

        Without a wish the last one counts, until it is older than `timeout`.

        Args:
            q: Measured joint positions [rad], (n,).
            dq: Joint velocity that is wished for [rad/s], (n,).
            twist: Or linear [m/s] and angular [rad/s] velocity of a frame along the base's axes,
                (6,).
            position: Or joint positions to reach [rad], (n,).
            frame: Name of the twist's frame; None stands for the tip.

        Raises:
            InvalidInputError: `q` or a wish has a wrong shape, `q` is not finite, or there are
                several wishes.
            NotFoundError: The robot has no frame of that name.
        """
        kept = ShieldState(*[part.copy() for part in self._state])
        before = (self._kept.past, kept, self._asked, self._t)
        wishes = {"dq": dq, "twist": twist, "position": position}
        try:
            return self._step(q, {k: x for k, x in wishes.items() if x is not None}, frame)
        except BaseException:  # refused, or interrupted before anybody got the command
            halted = self._state.flags[REASON] == HALTED
            self._kept.past, self._state, self._asked, self._t = before
            if halted:
                self.halt()
            raise

    def _step(self, q: ArrayLike, given: dict[str, ArrayLike], frame: str | None) -> ShieldCommand:
        """Take a step with a wish, or none."""
        measured = checks.finite_array("q", q, (self.robot.dof,)).copy()
        held = self._take(measured, given, frame)
        positions, wish, flags = self._state
        said = (REASONS[int(flags[REASON])], TAKEN_OVER if flags[TAKEN] else "")
        kind, seen = ("dq", JOINTS) if said[0] else self._asked
        controller = self.controller(seen)
        target = {seen or self.robot.tip: self._target(controller, kind, held)}
        command = controller.step(positions, self._t, target)
        # A wish that can be had again is had at once.
        self._kept.past[YIELDS] = 0.0
        velocity = wish[: positions.size].copy() if kind == "dq" else None
        reasons = tuple(filter(None, said))
        decision = ShieldCommand(command.dq, velocity, reasons, command, self, self._t)
        positions += self.dt * command.dq
        self._t += self.dt
        return decision

    def _take(self, q: Vector, given: dict[str, ArrayLike], frame: str | None) -> bool:
        """Take positions and a wish over; return whether it is that of the last step."""
        if len(given) > 1:
            raise InvalidInputError(" and ".join(given), "are several wishes")
        wish = self._state.wish.copy()
        for kind, value in given.items():
            size = TWIST if kind == "twist" else q.size
            wish[:size] = checks.array(kind, value, (size,))
            self._asked = (kind, frame or self.robot.tip if kind == "twist" else JOINTS)
        take_positions(q, self._state, self.settings)
        held: bool = take_wish(wish, bool(given), self._state, self.settings)
        return held

    def controller(self, frame: str = JOINTS) -> Controller:
        """Return the controller for wishes of a frame, or of all joints; they share one state."""
        if frame not in self._controllers:
            scheme = Scheme([], [JointVelocityTask()], self.limits)
            if frame != JOINTS:
                task = PoseTask(frame=frame, gain=0.0, weight=1.0)
                scheme = Scheme([KineticEnergy(weight=DAMPING * DAMPING)], [task], self.limits)
            self._controllers[frame] = Controller(self.robot, scheme, dt=self.dt, policy="relax")
            self._controllers[frame]._state = self._kept
        return self._controllers[frame]

    def _target(self, controller: Controller, kind: str, held: bool) -> Target:
        """Return what a step is to answer, in the form of its target."""
        if kind == "twist":
            v = np.clip(self._state.wish[:TWIST], -FASTEST, FASTEST)
            return Target(np.zeros(3), linear_velocity=v[:3], angular_velocity=v[3:])
        # From here a network that has nothing to do hands the aim out as it is.
        state = controller.solver.state_for(controller.program.sizes)
        state[:] = 0.0
        past = self._kept.past
        aim = state[: self.robot.dof]
        come_nearer(self._state, past, self.motion, self._periods, kind == "position", held, aim)
        target = np.zeros(TARGET_SIZE)
        target[: aim.size] = aim
        return Target.from_data(target)
