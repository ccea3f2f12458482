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

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.control.command import Command
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.state import BEFORE, LAST, REST, YIELDS, ControllerState, KeptStates
from iiwa_dnn.control.stopping import least_periods
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.references import Target
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes import (
    AccelerationLimits,
    CollisionAvoidance,
    JerkLimits,
    JointLimits,
    KineticEnergy,
    Limit,
    Obstacle,
    PoseTask,
    Scheme,
    Task,
)
from iiwa_dnn.schemes.collisions import avoidance_of
from iiwa_dnn.schemes.limits import MotionLimits, braking, joint_bounds
from iiwa_dnn.schemes.step import TARGET_SIZE, StepViews

DAMPING = 0.02
"""Lambda of a twist's program [m/rad]: near a singular pose the joints do not race."""

FASTEST = 1e3
"""Velocity [rad/s, m/s] to which a larger wish is cut before it is answered: no arm is so quick."""

JOINTS = ""
"""Frame of wishes for all joints."""

REASONS = ("", "no wish", "wish too old", "wish not finite", "halted")
"""Reasons why a wish to rest counts."""
NO_WISH, TOO_OLD, NOT_FINITE, HALTED = range(1, 5)

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
        """Return the number of joints, at most as many as a target has numbers."""
        if robot.dof > TARGET_SIZE:
            raise InvalidInputError("robot", f"has more than {TARGET_SIZE} joints", robot.dof)
        return robot.dof


@compiled
def approach_positions(
    q: Vector, past: Matrix, goal: Vector, limits: Vector, dt: float, dq: Vector
) -> None:
    """Write the quickest velocities dq (n,) from which all joints can still rest at a goal (n,).

    Args:
        q: Joint positions [rad], (n,).
        past: `ControllerState.past`, (8, n).
        goal: Joint positions to reach [rad], (n,).
        limits: `MotionLimits.constants`, (6 n,).
        dt: Control period [s].
        dq: The velocities [rad/s], (n,), overwritten.
    """
    for i in range(q.size):
        left = goal[i] - q[i]
        above = left if left >= 0.0 else np.inf
        below = -left if left < 0.0 else np.inf
        lower, upper = bounds_of(i, past, above, below, limits, dt)
        dq[i] = upper if left >= 0.0 else lower
        if not abs(dq[i]) < np.inf:
            dq[i] = min(max(left / dt, -FASTEST), FASTEST)


@compiled
def approach_velocities(
    q: Vector, past: Matrix, held: bool, limits: Vector, dt: float, dq: Vector
) -> None:
    """Replace wished velocities dq (n,) [rad/s] by the next ones on the quickest way to them.

    A joint that jerk limits keep from its velocity in this step, or that is asked for the same one
    as in the last step (`held`), does not pass it on that way. The other arguments are those of
    `approach_positions`.
    """
    n = q.size
    for i in range(n):
        dq[i] = min(max(dq[i], -FASTEST), FASTEST)
        above = limits[n + i] - q[i]
        below = q[i] - limits[i]
        lower, upper = bounds_of(i, past, above, below, limits, dt)
        if held or dq[i] < lower or dq[i] > upper:
            behind = past[LAST, i] - dq[i]
            dq[i] += braking(behind, -np.inf, np.inf, limits[4 * n + i], dt)


@compiled
def bounds_of(
    i: int, past: Matrix, above: float, below: float, limits: Vector, dt: float
) -> tuple[float, float]:
    """Compute the bounds of joint i by `joint_bounds`, for its distances [rad] from two positions.

    The other arguments are those of `approach_positions`.
    """
    n = past.shape[1]
    rates = (limits[2 * n + i], limits[3 * n + i], limits[4 * n + i], limits[5 * n + i])
    lower, upper = joint_bounds(past[LAST, i], past[BEFORE, i], above, below, rates, dt)
    return lower, upper


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
        for i in range(q.size):
            state.positions[i] = q[i]


@compiled
def take_wish(wish: Vector, given: bool, state: ShieldState, settings: Vector) -> bool:
    """Take a wish (k,) over if there is one, or one to rest; settings as `take_positions`.

    Returns:
        Whether the wish that counts is that of the last step.
    """
    flags = state.flags
    flags[AGE] += settings[0]
    if given and flags[REASON] != HALTED:
        flags[AGE] = 0.0
        flags[REASON] = 0.0
        for i in range(wish.size):
            if not abs(wish[i]) < np.inf:
                flags[REASON] = NOT_FINITE
    if flags[REASON] == 0.0 and flags[AGE] > settings[1] + 0.5 * settings[0]:
        flags[REASON] = TOO_OLD
    other = 0
    for i in range(wish.size):
        now = wish[i] if given else state.wish[i]
        if flags[REASON] != 0.0:
            now = 0.0
        other += now != state.wish[i]
        state.wish[i] = now
    return other == 0


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
        clipped: Whether it is another one than the given wish, or than the quickest approach to
            positions that the joints' own limits allow.
        reasons: Reasons for that beside the limits.
        stopping_time: Time of the motion to rest from it [s].
        command: The controller's command, with the program that was answered.
        shield: The shield.
        t: Time of the shield's clock [s].
    """

    dq: Vector
    clipped: bool
    reasons: tuple[str, ...]
    stopping_time: float
    command: Command
    shield: Shield
    t: float

    @property
    def limits(self) -> tuple[str, ...]:
        """Name the reasons, bounds and rows that keep the command from the given wish."""
        return (*self.reasons, *self.command.against) if self.clipped else ()

    @property
    def margin(self) -> Margin:
        """Distances at the joint positions that the command starts from, computed when asked."""
        q = self.command.past[0]
        robot = self.shield.robot
        joint = float(np.minimum(q - robot.q_lower, robot.q_upper - q).min())
        distance = math.inf
        if (avoidance := avoidance_of(self.shield)) is not None:
            nearest, _ = avoidance.scene(robot).nearest(q[np.newaxis], np.array([self.t]))
            distance = float(nearest[0]) - avoidance.distance
        return Margin(joint, distance)


class Shield:
    """The limits of a robot, kept for whoever drives it.

    The shield integrates its own commands; measured positions that are no further than
    `tracking_error` from them do not change them.

    Attributes:
        robot: The robot, n joints, whose limits hold.
        dt: Control period [s].
        limits: Limits that every command keeps.
        motion: Their numbers for the joints, `MotionLimits.constants`, (6 n,).
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
        if timeout != math.inf:
            checks.positive("timeout", timeout)
        checks.not_negative("tracking_error", tracking_error)
        self.settings = np.array([self.dt, timeout, tracking_error])
        rates: list[AccelerationLimits | JerkLimits] = []
        if np.isfinite(robot.ddq_max).any():
            rates.append(AccelerationLimits())
        if np.isfinite(robot.dddq_max).any():
            rates.append(JerkLimits())
        self.limits: list[Limit] = [JointLimits(), *rates]
        if obstacles is not None:
            self.limits.append(CollisionAvoidance(obstacles, distance=distance))
        self.motion = MotionLimits(tuple(rates)).constants(robot)
        self._controllers: dict[str, Controller] = {}
        self._kept = KeptStates(ControllerState.at_rest(robot.dof))
        self.reset()

    def reset(self) -> None:
        """Forget wishes, a halt and the last commands: the arm stands where it is measured next."""
        n = self.robot.dof
        self._kept.now = ControllerState.at_rest(n, self._kept.now.begun)
        self._state = ShieldState(np.zeros(n), np.zeros(n), np.zeros(4))
        self._state.flags[REASON] = NO_WISH
        self._kind = "dq"
        self._frame = JOINTS
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
        measured = checks.finite_array("q", q, (self.robot.dof,))
        given = {"dq": dq, "twist": twist, "position": position}
        held = self._take(measured, {k: x for k, x in given.items() if x is not None}, frame)
        positions, wish, flags = self._state
        controller = self.controller(self._frame)
        command = controller.step(positions, self._t, self._target(controller, held))
        # A wish that can be had again is had at once.
        self._kept.now.past[YIELDS] = 0.0
        other = (command.dq != wish).any() if self._kind == "dq" else command.against
        reasons = [REASONS[int(flags[REASON])]] if flags[REASON] else []
        if flags[TAKEN]:
            reasons.append("measured positions taken over")
        clipped = bool(reasons or other)
        rest = self._stopping_time(command)
        decision = ShieldCommand(command.dq, clipped, tuple(reasons), rest, command, self, self._t)
        positions += self.dt * command.dq
        self._t += self.dt
        return decision

    def _take(self, q: Vector, given: dict[str, ArrayLike], frame: str | None) -> bool:
        """Take a wish over; return whether it is that of the last step."""
        if len(given) > 1:
            raise InvalidInputError(" and ".join(given), "are several wishes")
        wish = self._state.wish
        for name, value in given.items():
            wish = checks.array(name, value, (6 if name == "twist" else q.size,)).copy()
            seen = JOINTS if name != "twist" else frame or self.robot.tip
            if (name, seen) != (self._kind, self._frame):
                self._state = self._state._replace(wish=np.full(wish.size, np.nan))
            self._kind = name
            self._frame = seen
        take_positions(q.copy(), self._state, self.settings)
        held: bool = take_wish(wish, bool(given), self._state, self.settings)
        if self._state.flags[REASON] and self._kind != "dq":
            self._kind = "dq"
            self._frame = JOINTS
            self._state = self._state._replace(wish=np.zeros(q.size))
        return held

    def controller(self, frame: str = JOINTS) -> Controller:
        """Return the controller for wishes of a frame, or of all joints; they share one state."""
        found = self._controllers.get(frame)
        if found is None:
            scheme = Scheme([], [JointVelocityTask()], self.limits)
            if frame != JOINTS:
                task = PoseTask(frame=frame, gain=0.0, weight=1.0)
                scheme = Scheme([KineticEnergy(weight=DAMPING * DAMPING)], [task], self.limits)
            found = Controller(self.robot, scheme, dt=self.dt, policy="relax")
            found._kept = self._kept
            self._controllers[frame] = found
        return found

    def _target(self, controller: Controller, held: bool) -> dict[str, Target]:
        """Return what a step is to answer, in the form of its target."""
        positions, wish, _ = self._state
        target = np.zeros(TARGET_SIZE)
        if self._kind == "twist":
            target[3:12:4] = 1.0
            target[12:] = np.clip(wish, -FASTEST, FASTEST)
            return {self._frame: Target.from_data(target)}
        aim = target[: wish.size]
        aim[:] = wish
        past = self._kept.now.past
        if self._kind == "position":
            approach_positions(positions, past, wish, self.motion, self.dt, aim)
        else:
            approach_velocities(positions, past, held, self.motion, self.dt, aim)
        # From here a network that has nothing to do hands the aim out as it is.
        sizes = controller.layout.sizes
        state = controller.solver.warm_state(sizes)
        if state is None:
            state = controller.solver.cold_state(sizes)
        state[:] = 0.0
        state[: wish.size] = aim
        return {self.robot.tip: Target.from_data(target)}

    def _stopping_time(self, command: Command) -> float:
        """Compute the time of the motion to rest from a command [s]."""
        rest = self._kept.now.past[REST, 0]
        if rest == 0.0:
            moves = float(command.dq.any())
            cubic = bool(np.isfinite(self.robot.dddq_max).any())
            last = command.past[1]
            rest = max(moves, least_periods(command.dq, last, self.motion, self.dt, cubic))
        return float(self.dt * rest)
