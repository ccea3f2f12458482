"""A configuration: joint positions together with the kinematics that belong to them."""

import pinocchio as pin
from numpy.typing import ArrayLike

from iiwa_dnn.checks import Array, finite_array, instance, read_only
from iiwa_dnn.robot.robot import Robot


class FrameState:
    """Pose and Jacobian of a frame, read-only."""

    __slots__ = ("_jacobian", "_pose")

    def __init__(self, pose: Array, jacobian: Array) -> None:
        self._pose = pose
        self._jacobian = jacobian

    @property
    def pose(self) -> Array:
        """Pose of the frame in the world as a homogeneous matrix, shape (4, 4)."""
        return read_only(self._pose)

    @property
    def position(self) -> Array:
        """Position of the frame in the world [m], shape (3,)."""
        return read_only(self._pose[:3, 3])

    @property
    def rotation(self) -> Array:
        """Orientation of the frame, shape (3, 3): columns are its axes in the world."""
        return read_only(self._pose[:3, :3])

    @property
    def jacobian(self) -> Array:
        """Jacobian J of the frame, shape (6, n): J dq = [linear velocity; angular velocity].

        Along the world's axes, at the frame's origin (Pinocchio's LOCAL_WORLD_ALIGNED).
        """
        return read_only(self._jacobian)


class Configuration(FrameState):
    """Joint positions of a robot, with pose and Jacobian of one frame, its tip.

    Every array is a copy, and read-only: a configuration stays as it is, whatever becomes of ``q``
    afterwards. Positions outside the joint limits are accepted.

    Args:
        robot: The robot.
        q: Joint positions [rad], shape (n,).

    Raises:
        InvalidInputError: If ``q`` has a wrong shape or is not finite.
    """

    # Built at every control step, so: slots, and no numpy call that is not needed.
    __slots__ = ("_inertia", "_q", "_robot")
    _inertia: Array | None

    def __init__(self, robot: Robot, q: ArrayLike) -> None:
        shape = instance("robot", robot, Robot).q_lower.shape
        self._robot = robot
        self._q = finite_array("q", q, shape).copy()  # not read-only, for compiled code
        self._inertia = None
        super().__init__(*_kinematics(robot, self._q, robot.tip_id))

    @property
    def arrays(self) -> tuple[Array, Array, Array]:
        """``(q, pose, jacobian)`` for compiled code, not protected, which makes it quicker."""
        return self._q, self._pose, self._jacobian

    @property
    def robot(self) -> Robot:
        """The robot that is in this configuration."""
        return self._robot

    @property
    def q(self) -> Array:
        """Joint positions [rad], shape (n,)."""
        return read_only(self._q)

    @property
    def inertia(self) -> Array:
        """Joint-space inertia matrix M [kg m^2], shape (n, n), symmetric positive definite.

        The kinetic energy is dq' M dq / 2. By the composite rigid body algorithm (Featherstone,
        "Rigid Body Dynamics Algorithms", 2008, section 6.2), on first use.
        """
        if self._inertia is None:
            model = self._robot.model
            self._inertia = pin.crba(model, model.createData(), self._q)
        return read_only(self._inertia)

    def frame(self, name: str) -> FrameState:
        """Compute pose and Jacobian of a frame out of `Robot.frame_names`, as those of the tip.

        Raises:
            NotFoundError: If there is no such frame; the error lists those of similar names.
        """
        index = self._robot.frame_id(name)
        return FrameState(*_kinematics(self._robot, self._q, index))


def _kinematics(robot: Robot, q: Array, index: int) -> tuple[Array, Array]:
    """Compute pose (4, 4) and Jacobian (6, n) of a frame."""
    model = robot.model
    data = model.createData()
    # The first call has placed the joints, so the second need not run over the chain again.
    jacobian = pin.computeFrameJacobian(model, data, q, index, pin.LOCAL_WORLD_ALIGNED)
    pose = pin.updateFramePlacement(model, data, index).homogeneous
    return pose, jacobian.reshape(6, -1)  # (6,) for a single joint
