"""The disturbances of the atlas: noise in the network's rates, and arms unlike their model."""

from dataclasses import replace

import numpy as np
import pinocchio as pin

from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Robot

DT = 2e-3
"""Control period [s]."""

DISTURBANCES = (
    "none",
    "constant",
    "ramp",
    "sinusoid",
    "white",
    "measurement",
    "parameter",
    "locked",
    "estimated",
)
"""The first five but none disturb the network's rates, the others the loop around it:

constant 1 rad/s^2, ramp 1 rad/s^3, sinusoid 1 rad/s^2 of 5 Hz, along a direction in the space of
the states that the seed draws; white, 0.01 rad/s a control period (the paper's); measurement,
1e-4 rad on the joint positions; parameter, links 5 % longer or shorter than the controller's model,
the tool's pose being measured; locked, one joint that stands still from a moment in the first half
on, as the controller is told; estimated, a Jacobian whose entries are 10 % off at the start, and
which is learned from the motion alone (`learn`).
"""


def noise_of(kind: str, rng: np.random.Generator, steps: int) -> Matrix | None:
    """Draw what is added to the states after each step, (steps, 100)."""
    direction = rng.standard_normal(100) / np.sqrt(7.0)
    t = DT * np.arange(steps)
    shapes = {"constant": np.ones(steps), "ramp": t, "sinusoid": np.sin(10.0 * np.pi * t)}
    if kind in shapes:
        return DT * np.outer(shapes[kind], direction)
    return 0.01 * rng.standard_normal((steps, 100)) if kind == "white" else None


def other_arm(robot: Robot, rng: np.random.Generator) -> Robot:
    """Return an arm whose links are 5 % longer or shorter."""
    model = pin.Model(robot.model)
    for i, sign in enumerate(rng.choice([-1.0, 1.0], robot.dof)):
        placement = model.jointPlacements[i + 1]
        placement.translation = (1.0 + 0.05 * sign) * placement.translation
        model.jointPlacements[i + 1] = placement
    return replace(robot, model=model)


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


def as_measured(target: Vector, tool: Vector, believed: Vector) -> None:
    """Move a target (18,) so that the model's error from it is the one that was measured."""
    target[:3] += believed[9:] - tool[9:]
    turn = tool[:9].reshape(3, 3) @ believed[:9].reshape(3, 3).T  # both by columns
    target[3:12] = (target[3:12].reshape(3, 3) @ turn).ravel()
