r"""The controller closed around a target that may jump.

A dragged target can be far away, and out of reach. The feedback of the scheme asks for the
velocity :math:`\delta e`, so the error is cut to what the tip may do,
:math:`\|e\| \le v_{max} / \delta`, and likewise for the orientation. If even that has no
solution, shorter errors are tried, and in the end the arm stands still. It also does so rather than
be stretched out to a singular posture, which it could not leave again within its joints' speeds.
"""

import time
from dataclasses import dataclass, replace

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
from iiwa_dnn.references import Target
from iiwa_dnn.results.record import FloatArray
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.robot.obstacles import Sphere
from iiwa_dnn.robot.robot import Robot
from iiwa_dnn.schemes import CollisionAvoidance, DoubleIndicator, Limit

TIP_SPEED, TIP_RATE = 0.25, 1.0
"""Largest speed [m/s] and rate [rad/s] of the tip; 0.25 m/s is the limit beside people."""

LEAST_SINGULAR_VALUE = 0.05
"""Least one of the Jacobian: below it, 0.1 m/s of the tip would ask for 2 rad/s of the joints."""

_GAINS = ("drift_gain", "position_gain", "orientation_gain", "limit_gain")
_SHARES = (1.0, 0.3, 0.1, 0.03, 0.0)
_AT_REST = np.zeros(3)


@dataclass(frozen=True)
class FollowerState:
    """Result of a step.

    Attributes:
        q: Joint positions [rad], (n,).
        position_error: Distance from tip to target [m].
        orientation_error: Angle between them [rad].
        kkt_residual: Largest KKT residual of the network's answer.
        share: Share of the error that was asked for: below 1 the target cannot be followed in full,
            at 0 the tip stands still.
        seconds: Wall time of the control step [s].
    """

    q: Vector
    position_error: float
    orientation_error: float
    kkt_residual: float
    share: float
    seconds: float


class Follower:
    """An arm that follows a target, one control period after the other.

    Attributes:
        robot: The robot, n joints, with the limits that are kept.
        dt: Control period [s].
        obstacle: The ball that is avoided, where it began; None: none.
    """

    obstacle: Sphere | None

    def __init__(
        self, robot: Robot, q0: ArrayLike, scheme: DoubleIndicator | None = None, dt: float = 5e-3
    ) -> None:
        """Start at rest at q0 (n,) [rad], the posture to come back to where the scheme has none.

        Gains above 1 / dt, as a run of a shorter period may have, are lowered to it.

        Raises:
            InvalidInputError: If `q0` is not acceptable.
        """
        self.robot, self.dt = robot, dt
        self._scratch = robot.model.createData()
        start = Configuration(robot, q0, self._scratch)
        self._q = start.q
        scheme = DoubleIndicator() if scheme is None else scheme
        lowered = {name: min(getattr(scheme, name), 1.0 / dt) for name in _GAINS}
        scheme = replace(scheme, **lowered)
        self._controller = Controller(robot, scheme.anchored(start), dt=dt, policy="stop")
        self._controller.warm_up()
        self._command: Command | None = None
        self._level = 0  # which share of the error to try first
        self._shift, self.obstacle = np.zeros(3), None
        self._pushes: list[FloatArray] = []

    @property
    def scheme(self) -> DoubleIndicator:
        """The scheme in use."""
        scheme: DoubleIndicator = self._controller.scheme  # type: ignore[assignment]
        return scheme

    @property
    def configuration(self) -> Configuration:
        """Configuration of the arm."""
        return Configuration(self.robot, self._q)

    def tune(self, **parameters: float) -> None:
        """Change parameters of the scheme: ``weight``, ``position_gain`` and so on.

        Raises:
            InvalidInputError: If one is out of range; nothing has changed then. A gain must be at
                most 1 / dt: above it, one period's step overshoots the error that it corrects.
        """
        for name in _GAINS:
            if parameters.get(name, 0.0) * self.dt > 1.0:
                most = f"must be at most 1 / dt = {1.0 / self.dt:g} 1/s, not {parameters[name]:g}"
                raise InvalidInputError(name, most, parameters[name])
        self._controller.scheme = replace(self.scheme, **parameters)  # type: ignore[arg-type]

    def avoid(self, obstacle: Sphere | None) -> None:
        """Keep away from a ball, which `move_obstacle` moves; None: from nothing."""
        limits: tuple[Limit, ...] = ()
        if obstacle is not None:
            obstacle = replace(obstacle, motion=lambda _: self._shift, speed=TIP_SPEED)
            limits = (CollisionAvoidance([obstacle], self_collision=False),)
        self._shift, self.obstacle = np.zeros(3), obstacle
        self._controller.scheme = replace(self.scheme, extra_limits=limits)
        # The arm gives way: where both do not go together, its tip leaves the target.
        self._controller.policy = "stop" if obstacle is None else "relax"

    def move_obstacle(self, place: ArrayLike) -> FloatArray:
        """Move the ball towards a place (3,) [m] for one period, at `TIP_SPEED` at most.

        Returns:
            The place of the ball afterwards, (3,) [m].
        """
        if self.obstacle is None:
            raise InvalidInputError("obstacle", "is missing: avoid one first")
        center = np.asarray(self.obstacle.center)
        way = np.asarray(place) - center - self._shift
        length = float(np.linalg.norm(way))
        most = TIP_SPEED * self.dt
        self._shift = self._shift + way * (most / length if length > most else 1.0)
        return center + self._shift

    def step(self, position: FloatArray, rotation: FloatArray) -> FollowerState:
        """Move towards a target for one control period.

        Args:
            position: Where the tip is wanted [m], (3,).
            rotation: How, (3, 3).

        Returns:
            The state of the arm afterwards.
        """
        conf = Configuration(self.robot, self._q, self._scratch)
        shift = position - conf.position
        turn = np.asarray(pin.log3(rotation @ conf.rotation.T))
        distance, angle = float(np.linalg.norm(shift)), float(np.linalg.norm(turn))
        scheme = self.scheme
        shift *= _share(distance, TIP_SPEED, scheme.position_gain)
        turn *= _share(angle, TIP_RATE, scheme.orientation_gain)
        asked, residual, began = 0.0, float("inf"), time.perf_counter()
        for level in range(self._level, len(_SHARES)):
            share = _SHARES[level]
            near = pin.exp3(share * turn) @ conf.rotation
            target = Target(conf.position + share * shift, near, _AT_REST, _AT_REST)
            command = self._controller.step(self._q, 0.0, target)
            residual = command.solution.residuals.largest
            given_way = share == 0.0 and self.obstacle is not None
            if not command.ok and not given_way:
                # The multipliers of a program without a solution grow and grow: a bad start.
                self._controller.solver.reset()
                continue
            self._command = command
            q = conf.q + self.dt * command.dq
            after = Configuration(self.robot, q, self._scratch)
            if given_way or self._stays_clear(conf, after):
                self._q, asked = q, share
                # The next step begins one share higher: at the edge, few programs are in vain.
                self._level = max(0, level - 1)
                break
        seconds = time.perf_counter() - began
        if self._pushes:
            moved = self._q + self._pushes.pop()
            self._q = np.clip(moved, self.robot.q_lower, self.robot.q_upper)
        return FollowerState(self._q, distance, angle, residual, asked, seconds)

    def push(self, shift: FloatArray) -> None:
        """Displace the joints by `shift` (n,) [rad] within the next 0.1 s, inside their limits."""
        count = max(1, round(0.1 / self.dt))
        self._pushes = [shift / count] * count

    @property
    def distance(self) -> float:
        """Distance of the arm from the ball [m]; NaN without one."""
        for part in self.scheme.extra_limits:
            if isinstance(part, CollisionAvoidance):
                found = part.scene(self.robot).nearest(self._q[None], np.zeros(1))
                return float(found[0][0])
        return float("nan")

    def settling(self) -> tuple[FloatArray, FloatArray]:
        """Let a network settle on the last program from rest, and record its way.

        Returns:
            Decimal logarithms of the network time [rho], (M,), and the distances of the M points
            from the answer [rad/s], (M, n). Empty before the first step.
        """
        if self._command is None:
            return np.empty(0), np.empty((0, self.robot.dof))
        network = self._controller.solver.network
        solver = DNNSolver(network, follower=ImplicitEuler(step=1e12))
        steps = 0.01 * 1.3 ** np.arange(70)
        points = [solver.advance(self._command.qp, h * network.rho).x for h in steps]
        return np.log10(np.cumsum(steps)), np.abs(np.array(points) - self._command.dq)

    def _stays_clear(self, now: Configuration, then: Configuration) -> bool:
        """Tell whether a step leads the arm neither into nor deeper into a singular posture."""
        rows = 3 if self.scheme.orientation == "none" else 6
        least = [np.linalg.svd(conf.jacobian[:rows], compute_uv=False)[-1] for conf in (now, then)]
        return bool(least[1] >= min(LEAST_SINGULAR_VALUE, least[0]))

    def check(self, check: CrossCheck) -> float:
        """Ask the reference solvers for the last program's solution.

        Returns:
            The largest gap [rad/s]; NaN before the first step, inf where a reference has no answer.
        """
        if self._command is None:
            return float("nan")
        gaps = check.check(self._command.qp, self._command.dq).solution_gap
        return float("inf") if np.isnan(gaps).any() else float(np.max(gaps, initial=0.0))


def _share(size: float, fastest: float, gain: float) -> float:
    """Compute the share of an error that may be fed back: gain times it is at most `fastest`."""
    speed = gain * size
    return 1.0 if speed <= fastest else fastest / speed
