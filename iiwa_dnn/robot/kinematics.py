"""Joint Jacobian, frame placements and inertia of a robot, in arrays that a loop holds once.

Pinocchio computes them; what it leaves in its own memory is seen here through views, so that a
control step converts nothing. `iiwa_dnn.Configuration` is the safe form for everyone else.
"""

from collections.abc import Iterable

import numpy as np
import pinocchio as pin

from iiwa_dnn.checks import Array, Matrix
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.robot.robot import Robot

_WORLD = pin.Convention.WORLD
_update_jacobians = pin.computeJointJacobians
_update_placements = pin.updateFramePlacements


class Placement(Record):
    """Placement of a frame in the world: its three axes, then its position [m]."""

    axes: Matrix = part(3, 3)
    position: Array = part(3)


class Twist(Record):
    """Linear velocity of the world's origin, and angular velocity, along the world's axes."""

    linear: Array = part(3)
    angular: Array = part(3)


class Kinematics:
    """Kinematics of the frames that a control loop needs, overwritten by each `update`.

    Attributes:
        robot: The robot, n joints.
        data: Pinocchio's data of the robot's model, current after `update`.
        frame_ids: Pinocchio's indices of the frames that `update` places: tip, world, others.
        jacobian: Joint Jacobian, (n, 6): row j is the twist [linear velocity of the world's origin;
            angular velocity] for each unit of velocity of joint j, along the world's axes.
        placements: Frame placements by frame index, (frames, 12): the rotation's columns, then the
            position [m]. A loop may keep only the rows of `frame_ids` current.
        inertia: Joint-space inertia matrix [kg m^2], (n, n), current where `dynamics` is set.
    """

    def __init__(self, robot: Robot, frames: Iterable[str] = (), dynamics: bool = False) -> None:
        """Allocate for the tip and for other frames, by name.

        Raises:
            NotFoundError: The robot has no frame of that name.
            InvalidInputError: The inertia matrix is asked for, and a mass is negative.
        """
        for name, body in zip(robot.model.names, robot.model.inertias, strict=True):
            if dynamics and body.mass < 0.0:
                problem = f"'inertia' takes no negative mass, on joint {name!r} ({body.mass:g} kg)"
                raise InvalidInputError("kinetic", problem, robot)
        self.robot = robot
        self.data = robot.model.createData()
        ids = [robot.tip_id, 0, *(robot.frame_id(name) for name in frames)]
        self.frame_ids = tuple(dict.fromkeys(ids))
        self._dynamics = dynamics
        # With one joint Pinocchio's views have one axis less.
        self.jacobian: Array = self.data.J.T.reshape(robot.dof, 6)
        self.inertia: Array = self.data.M.T.reshape(robot.dof, robot.dof)
        self.placements = _placements(robot.model, self.data)

    def update(self, q: Array) -> None:
        """Compute the kinematics at joint positions `q` (n,) [rad], which are not checked."""
        model = self.robot.model
        data = self.data
        if self._dynamics:
            pin.crba(model, data, q, _WORLD)  # leaves the joint Jacobian too
        else:
            _update_jacobians(model, data, q)
        _update_placements(model, data)  # no slower than one of them

    def frame(self, name: str) -> tuple[Array, Array]:
        """Return pose (4, 4) and Jacobian (6, n) of a frame, copies.

        The Jacobian's rows are [linear; angular] at the frame's origin, along the world's axes.

        Raises:
            NotFoundError: The robot has no frame of that name.
        """
        model = self.robot.model
        index = self.robot.frame_id(name)
        pose = pin.updateFramePlacement(model, self.data, index).homogeneous
        return pose, pin.getFrameJacobian(model, self.data, index, pin.LOCAL_WORLD_ALIGNED)


def _placements(model: pin.Model, data: pin.Data) -> Array:
    """View all frame placements as one array, (frames, 12): Pinocchio keeps them in one block."""
    shape = (model.nframes, Placement.width())
    view: Array = np.lib.stride_tricks.as_strided(data.oMf[0].rotation, shape, (8 * shape[1], 8))
    pin.framesForwardKinematics(model, data, pin.neutral(model))
    last = data.oMf[model.nframes - 1]  # where it lies in the block, the others do too
    if not np.array_equal(view[-1], np.append(last.rotation.T, last.translation)):
        raise RuntimeError("this build of Pinocchio keeps its frame placements in another way")
    return view
