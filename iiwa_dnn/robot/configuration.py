"""A configuration: joint positions together with the kinematics that belong to them."""

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from iiwa_dnn.checks import Array, instance, joint_positions, read_only
from iiwa_dnn.errors import NotFoundError
from iiwa_dnn.robot.robot import Robot


@dataclass(frozen=True, eq=False, repr=False)
class FrameState:
    """Pose and Jacobian of a frame, read-only.

    Attributes:
        pose: Pose of the frame in the world as a homogeneous matrix, shape (4, 4).
        jacobian: Jacobian J of the frame, shape (6, n): J dq = [linear velocity; angular velocity],
            along the world's axes, at the frame's origin (Pinocchio's LOCAL_WORLD_ALIGNED).
    """

    pose: Array
    jacobian: Array

    @property
    def position(self) -> Array:
        """Position of the frame in the world [m], shape (3,)."""
        return self.pose[:3, 3]

    @property
    def rotation(self) -> Array:
        """Orientation of the frame, shape (3, 3): columns are its axes in the world."""
        return self.pose[:3, :3]


@dataclass(frozen=True, eq=False, repr=False, init=False)
class Configuration(FrameState):
    """Joint positions of a robot, with pose and Jacobian of one frame, its tip.

    Every array is a copy, and read-only: a configuration stays as it is, whatever becomes of ``q``
    afterwards. Positions outside the joint limits are accepted.

    Attributes:
        robot: The robot that is in this configuration.
        q: Joint positions [rad], shape (n,).

    Raises:
        InvalidInputError: If ``q`` has a wrong shape or is not finite.
    """

    robot: Robot
    q: Array

    def __init__(self, robot: Robot, q: ArrayLike) -> None:
        checked = joint_positions("q", q, instance("robot", robot, Robot).dof)
        super().__init__(*_kinematics(robot, checked, robot.tip_id))
        object.__setattr__(self, "robot", robot)
        object.__setattr__(self, "q", checked)

    def __repr__(self) -> str:
        q, position = (np.round(each, 4).tolist() for each in (self.q, self.position))
        return f"Configuration({self.robot.name}, q={q} rad, {self.robot.tip} at {position} m)"

    if not TYPE_CHECKING:  # else a checker of types takes any name

        def __getattr__(self, name: str) -> None:
            names = [each for each in dir(Configuration) if not each.startswith("_")]
            names += [each.name for each in fields(Configuration)]
            raise AttributeError(str(NotFoundError("Configuration attribute", name, names)))

    @property
    def inertia(self) -> Array:
        """Joint-space inertia matrix M [kg m^2], shape (n, n), symmetric positive definite.

        The kinetic energy is dq' M dq / 2. By the composite rigid body algorithm (Featherstone,
        "Rigid Body Dynamics Algorithms", 2008, section 6.2), at each use.
        """
        model = self.robot.model
        return read_only(pin.crba(model, model.createData(), self.q))

    def frame(self, name: str) -> FrameState:
        """Compute pose and Jacobian of a frame out of `Robot.frame_names`, as those of the tip.

        Raises:
            NotFoundError: If there is no such frame; the error lists those of similar names.
        """
        return FrameState(*_kinematics(self.robot, self.q, self.robot.frame_id(name)))


def _kinematics(robot: Robot, q: Array, index: int) -> tuple[Array, Array]:
    """Compute pose (4, 4) and Jacobian (6, n) of a frame."""
    model = robot.model
    data = model.createData()
    # The first call has placed the joints, so the second need not run over the chain again.
    jacobian = pin.computeFrameJacobian(model, data, q, index, pin.LOCAL_WORLD_ALIGNED)
    pose = pin.updateFramePlacement(model, data, index).homogeneous
    return read_only(pose), read_only(jacobian.reshape(6, -1))  # (6,) for a single joint
