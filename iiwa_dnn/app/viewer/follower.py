"""The control loop of the live mode: an arm that follows a target and keeps away from a ball.

A target that jumps is approached at a limited speed (`iiwa_dnn.MovingTarget`). If the arm cannot
follow it within its limits, the policy ``slow`` scales the task velocity, in singular poses too.
"""

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from iiwa_dnn.control.command import Command
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.integrators import ImplicitEuler
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.qp.program import Vector
from iiwa_dnn.references import MovingTarget
from iiwa_dnn.results.record import FloatArray
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.robot.obstacles import Sphere
from iiwa_dnn.robot.robot import Robot
from iiwa_dnn.schemes import CollisionAvoidance, DoubleIndicator, Limit
from iiwa_dnn.simulation import IdealPlant, Moved

TIP_SPEED = 0.25
"""Largest speed of the target and of the ball [m/s]: the limit for robots beside people."""

TIP_RATE = 1.0
"""Largest angular speed of the target [rad/s]."""

_PUSH_DURATION = 0.1  # [s]
_GAINS = ("drift_gain", "position_gain", "orientation_gain", "limit_gain")


class PushedPlant(IdealPlant):
    """An ideal plant that is displaced inside its joint limits."""

    def start(self, robot: Robot, q0: Vector, dt: float, seed: int) -> Mapping[str, Any]:
        """Put the arm at q0 (n,) [rad]."""
        self._robot = robot
        self._pushes: list[Vector] = []
        return super().start(robot, q0, dt, seed)

    def push(self, shift: Vector) -> None:
        """Displace the joints by `shift` (n,) [rad] within the next 0.1 s."""
        count = max(1, round(_PUSH_DURATION / self._dt))
        self._pushes = [shift / count] * count

    def move(self, command: Vector) -> Moved:
        """Move by dt times the command (n,) [rad/s] and by the part of a push."""
        super().move(command)
        if self._pushes:
            pushed = self._q + self._pushes.pop()
            self._q = np.clip(pushed, self._robot.q_lower, self._robot.q_upper)
        return Moved(self._q)


class _Dragged(Sphere):
    """A sphere where its ball is, whatever the time."""

    def shift(self, t: float) -> FloatArray:
        """Return the displacement of the ball [m], (3,)."""
        ball: Ball = vars(self)["ball"]
        return ball.shift


class Ball:
    """A sphere that moves to a point at `TIP_SPEED`.

    Attributes:
        obstacle: The sphere as an obstacle.
    """

    def __init__(self, center: ArrayLike, radius: float) -> None:
        """Begin at a point (3,) [m]."""
        self._start = np.array(center)
        self._shift: FloatArray = np.zeros(3)
        fastest = (TIP_SPEED, 0.0, 0.0)  # whose length bounds the ball's speed
        self.obstacle = _Dragged(self._start.tolist(), radius, velocity=fastest)
        object.__setattr__(self.obstacle, "ball", self)

    @property
    def position(self) -> FloatArray:
        """The center [m], (3,)."""
        return self._start + self._shift

    @property
    def shift(self) -> FloatArray:
        """The displacement from the start [m], (3,)."""
        return self._shift

    def move(self, goal: ArrayLike, dt: float) -> None:
        """Move towards a point (3,) [m] for a time [s]."""
        remaining = np.asarray(goal) - self.position
        longest = TIP_SPEED * dt
        length = max(float(np.linalg.norm(remaining)), longest)
        self._shift = self._shift + longest / length * remaining


@dataclass(frozen=True)
class FollowerState:
    """Result of a step.

    Attributes:
        q: Joint positions [rad], (n,).
        position_error: Distance from tip to target [m].
        orientation_error: Angle between them [rad].
        command: Command of the step.
        seconds: Wall time of the control step [s].
    """

    q: Vector
    position_error: float
    orientation_error: float
    command: Command
    seconds: float


class Follower:
    """An arm that follows a target, one control period after the other.

    Attributes:
        robot: The robot, n joints, with the limits that are kept.
        dt: Control period [s].
        ball: The ball that is avoided; None: none.
    """

    def __init__(
        self, robot: Robot, q0: ArrayLike, scheme: DoubleIndicator | None = None, dt: float = 5e-3
    ) -> None:
        """Start at rest at q0 (n,) [rad], the home posture of a scheme that has none.

        Gains above 1 / dt are lowered to it.

        Raises:
            InvalidInputError: `q0` has a wrong shape or is not finite.
        """
        start = Configuration(robot, q0)
        scheme = DoubleIndicator() if scheme is None else scheme
        lowered = {name: min(getattr(scheme, name), 1.0 / dt) for name in _GAINS}
        scheme = replace(scheme, **lowered).anchored(start)
        self.robot = robot
        self.dt = dt
        self.ball: Ball | None = None
        self._target = MovingTarget(start, TIP_SPEED, TIP_RATE)
        self._controller = Controller(robot, scheme, self._target, dt=dt, policy="slow")
        self._controller.warm_up()
        self._plant = PushedPlant()
        self._plant.start(robot, start.q, dt, seed=0)
        self._steps = 0
        self._command: Command | None = None

    @property
    def scheme(self) -> DoubleIndicator:
        """The scheme in use."""
        scheme: DoubleIndicator = self._controller.scheme  # type: ignore[assignment]
        return scheme

    @property
    def configuration(self) -> Configuration:
        """Configuration of the arm."""
        return Configuration(self.robot, self._plant.read())

    @property
    def time(self) -> float:
        """Time since the start [s]."""
        return self._steps * self.dt

    def tune(self, **parameters: float) -> None:
        """Change parameters of the scheme: ``weight``, ``position_gain`` and so on.

        Raises:
            InvalidInputError: A parameter is out of range; nothing has changed then. A gain must be
                at most 1 / dt: above it, one period's step overshoots the error that it corrects.
        """
        for name in _GAINS:
            if parameters.get(name, 0.0) * self.dt > 1.0:
                most = f"must be at most 1 / dt = {1.0 / self.dt:g} 1/s, not {parameters[name]:g}"
                raise InvalidInputError(name, most, parameters[name])
        self._controller.scheme = replace(self.scheme, **parameters)  # type: ignore[arg-type]

    def avoid(self, ball: Ball | None) -> None:
        """Keep away from a ball; None: from nothing."""
        self.ball = ball
        limits: tuple[Limit, ...] = ()
        if ball is not None:
            limits = (CollisionAvoidance([ball.obstacle], self_collision=False),)
        self._controller.scheme = replace(self.scheme, extra_limits=limits)

    def push(self, shift: FloatArray) -> None:
        """Displace the joints by `shift` (n,) [rad] within the next 0.1 s, inside their limits."""
        self._plant.push(shift)

    def step(self, position: FloatArray, rotation: FloatArray) -> FollowerState:
        """Follow a target for one control period.

        Args:
            position: Position of the target [m], (3,).
            rotation: Orientation of the target, (3, 3).

        Returns:
            The state of the arm; errors are those before the step.
        """
        conf = self.configuration
        self._target.set(position, rotation)
        began = time.perf_counter()
        command = self._controller.step(self._plant.read(), self.time)
        seconds = time.perf_counter() - began
        self._command = command
        self._steps += 1
        return FollowerState(
            q=self._plant.move(command.dq).q,
            position_error=float(np.linalg.norm(position - conf.position)),
            orientation_error=float(np.linalg.norm(pin.log3(rotation @ conf.rotation.T))),
            command=self._command,
            seconds=seconds,
        )

    @property
    def distance(self) -> float:
        """Distance of the arm from the ball [m]; NaN without one."""
        for part in self.scheme.extra_limits:
            if isinstance(part, CollisionAvoidance):
                distances, _ = part.scene(self.robot).nearest(self._plant.read()[None], np.zeros(1))
                return float(distances[0])
        return float("nan")

    def settling(self) -> tuple[FloatArray, FloatArray]:
        """Let a network settle on the last program from rest, and record its states.

        Returns:
            Decimal logarithms of the network time [rho], (M,), and the distances of the states
            from the answer [rad/s], (M, n). Before the first step both are empty.
        """
        if self._command is None:
            return np.empty(0), np.empty((0, self.robot.dof))
        network = self._controller.solver.network
        solver = DNNSolver(network, follower=ImplicitEuler(step=1e12))
        steps = 0.01 * 1.3 ** np.arange(70)
        points = [solver.advance(self._command.qp, h * network.rho).x for h in steps]
        return np.log10(np.cumsum(steps)), np.abs(np.array(points) - self._command.dq)

    def check(self, check: CrossCheck) -> float:
        """Return the largest gap [rad/s] between the last command and the reference solvers.

        Before the first step it is NaN; if a reference solver has no answer, it is inf.
        """
        if self._command is None:
            return float("nan")
        gaps = check.check(self._command.qp, self._command.dq).solution_gap
        return float("inf") if np.isnan(gaps).any() else float(np.max(gaps, initial=0.0))
