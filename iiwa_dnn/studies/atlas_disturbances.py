"""The disturbances of the atlas: noise in the network's rates, and arms unlike their model."""

from dataclasses import replace

import numpy as np
import pinocchio as pin

from iiwa_dnn.qp import QP, Matrix, Vector
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes.program import StepProgram

DT = 2e-3
"""Control period [s]."""


def learn(jacobian: Matrix, moved: Vector, motion: pin.SE3) -> None:
    """Correct an estimated Jacobian by the last motion, in place: Broyden's update.

    Source: C. G. Broyden, "A class of methods for solving nonlinear simultaneous equations",
    Mathematics of Computation 19 (1965); for arms, K. Hosoda, M. Asada, "Versatile visual servoing
    without knowledge of true Jacobian", IROS 1994.
    The estimate is as `Kinematics.jacobian`, (n, 6); the joints moved by (n,) [rad], the tool by a
    measured motion of the world's frame.
    """
    square = moved @ moved
    if square > 0.0:
        missing = pin.log6(motion).vector - moved @ jacobian
        jacobian += np.outer(moved, missing) / square


def pose_of(placement: Vector) -> pin.SE3:
    """Return a placement (12,) of `Kinematics.placements` as Pinocchio has it."""
    return pin.SE3(placement[:9].reshape(3, 3).T, placement[9:])


class Disturbance:
    """No disturbance, and the base of the others: each overrides the thought that it changes.

    Attributes:
        robot: The true arm, n joints.
        dt: Control period [s].
        rng: Source of everything random.
        direction: Direction in the space of the states, (100,).
        noise: Noise that is added to the network's state after each step, (steps, 100), or None.
        joint: Number of the joint that a locked arm loses.
        moment: Step from which on it has lost it.
    """

    def __init__(self, robot: Robot, rng: np.random.Generator, steps: int, dt: float = DT) -> None:
        """Draw a disturbance of so many periods of dt [s]: a seed draws the same for every kind."""
        self.dt = dt
        self.robot = robot
        self.rng = rng
        self.direction: Vector = rng.standard_normal(100) / np.sqrt(7.0)
        self.noise = self.noise_at(dt * np.arange(steps, dtype=np.float64))
        self.joint = int(rng.integers(robot.dof))
        self.moment = int(rng.integers(steps // 2))

    def noise_at(self, t: Vector) -> Matrix | None:
        """Return the noise in the network's state at times t (steps,) [s], (steps, 100)."""
        return None

    def measure(self, q: Vector) -> Vector:
        """Measure joint positions q (n,) [rad]."""
        return q

    def mislead(self, program: StepProgram, target: Vector, tool: Vector, q: Vector) -> None:
        """Change what a program is written from, in place.

        Args:
            program: The program, with the kinematics of the measured joint positions.
            target: Target of the tool, (18,).
            tool: True placement of the tool, (12,).
            q: True joint positions [rad], (n,).
        """

    def constrain(self, k: int, qp: QP) -> None:
        """Change the bounds of the program of step k."""

    def hold(self, k: int, velocity: Vector) -> None:
        """Change the velocity (n,) [rad/s] that the arm takes in step k, in place."""


class ConstantNoise(Disturbance):
    """Constant noise in the network's rates."""

    def noise_at(self, t: Vector) -> Matrix:
        """Return the noise in the network's state at times t (steps,) [s], (steps, 100)."""
        return np.tile(self.dt * self.direction, (t.size, 1))


class Ramp(Disturbance):
    """Noise in the network's rates that grows with time."""

    def noise_at(self, t: Vector) -> Matrix:
        """Return the noise in the network's state at times t (steps,) [s], (steps, 100)."""
        return self.dt * (t[:, np.newaxis] * self.direction)


class Sinusoid(Disturbance):
    """Noise of 5 Hz in the network's rates."""

    def noise_at(self, t: Vector) -> Matrix:
        """Return the noise in the network's state at times t (steps,) [s], (steps, 100)."""
        return self.dt * (np.sin(10.0 * np.pi * t)[:, np.newaxis] * self.direction)


class WhiteNoise(Disturbance):
    """White noise in the network's rates."""

    def noise_at(self, t: Vector) -> Matrix:
        """Draw the noise in the network's state at times t (steps,) [s], (steps, 100)."""
        return 0.01 * self.rng.standard_normal((t.size, self.direction.size))


class MeasurementNoise(Disturbance):
    """Noise on the measured joint positions."""

    def measure(self, q: Vector) -> Vector:
        """Measure joint positions q (n,) [rad]."""
        return q + 1e-4 * self.rng.standard_normal(q.size)


class OtherArm(Disturbance):
    """An arm with other links than the controller's model, and a tool whose pose is measured."""

    def __init__(self, robot: Robot, rng: np.random.Generator, steps: int, dt: float = DT) -> None:
        """Draw the lengths of the links: each is 5 % longer or shorter."""
        model = pin.Model(robot.model)
        for i, sign in enumerate(rng.choice([-1.0, 1.0], robot.dof)):
            placement = model.jointPlacements[i + 1]
            placement.translation = (1.0 + 0.05 * sign) * placement.translation
            model.jointPlacements[i + 1] = placement
        super().__init__(replace(robot, model=model), rng, steps, dt)

    def mislead(self, program: StepProgram, target: Vector, tool: Vector, q: Vector) -> None:
        """Move the target (18,) by the model's error of the placement (12,); q is in [rad].

        The program's error from it is then the one that was measured.
        """
        believed = program.placement
        target[:3] += believed[9:] - tool[9:]
        turn = tool[:9].reshape(3, 3) @ believed[:9].reshape(3, 3).T  # both by columns
        target[3:12] = (target[3:12].reshape(3, 3) @ turn).ravel()


class LockedJoint(Disturbance):
    """A joint that stands still from a step on, as the controller knows."""

    def constrain(self, k: int, qp: QP) -> None:
        """Fix the joint by its bounds."""
        if k >= self.moment:
            qp.lb[self.joint] = 0.0
            qp.ub[self.joint] = 0.0

    def hold(self, k: int, velocity: Vector) -> None:
        """Set the joint's velocity, of (n,) [rad/s], to zero."""
        if k >= self.moment:
            velocity[self.joint] = 0.0


class EstimatedJacobian(Disturbance):
    """A Jacobian that is wrong at the start, and is learned from the motion alone (`learn`)."""

    _estimate: Matrix | None = None
    _last: tuple[Vector, Vector]

    def mislead(self, program: StepProgram, target: Vector, tool: Vector, q: Vector) -> None:
        """Replace the Jacobian by the estimate; placement (12,), positions (n,) [rad]."""
        jacobian = program.kinematics.jacobian
        if self._estimate is None:
            self._estimate = jacobian * (1.0 + 0.1 * self.rng.standard_normal(jacobian.shape))
        else:
            last_tool, last_q = self._last
            learn(self._estimate, q - last_q, pose_of(tool) * pose_of(last_tool).inverse())
        jacobian[:] = self._estimate
        self._last = (tool, q)


DISTURBANCES: dict[str, type[Disturbance]] = {
    "none": Disturbance,
    "constant": ConstantNoise,
    "ramp": Ramp,
    "sinusoid": Sinusoid,
    "white": WhiteNoise,
    "measurement": MeasurementNoise,
    "parameter": OtherArm,
    "locked": LockedJoint,
    "estimated": EstimatedJacobian,
}
"""The first five but none disturb the network's rates, the others the loop around it:

constant 1 rad/s^2, ramp 1 rad/s^3, sinusoid 1 rad/s^2 of 5 Hz, along a direction in the space of
the states that the seed draws; white, 0.01 rad/s a control period (the paper's); measurement,
1e-4 rad on the joint positions; parameter, links 5 % longer or shorter than the controller's model,
the tool's pose being measured; locked, one joint that stands still from a moment in the first half
on, as the controller is told; estimated, a Jacobian whose entries are 10 % off at the start, and
which is learned from the motion alone (`learn`).
"""
