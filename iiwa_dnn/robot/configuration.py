"""A configuration: joint positions together with the kinematics that belong to them."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn.checks import finite_array, read_only
from iiwa_dnn.robot.robot import Robot

_Array = NDArray[np.float64]
_WORLD_AXES = pin.LOCAL_WORLD_ALIGNED
_jacobian, _place_frame = pin.computeFrameJacobian, pin.updateFramePlacement


class FrameState:
    """Pose and Jacobian of a frame, read-only.

    Args:
        pose: Pose of the frame in the world as a homogeneous matrix, shape (4, 4).
        jacobian: Its Jacobian, shape (6, n).
    """

    __slots__ = ("_jacobian", "_pose")

    def __init__(self, pose: _Array, jacobian: _Array) -> None:
        self._pose, self._jacobian = pose, jacobian

    @property
    def pose(self) -> _Array:
        """Pose of the frame in the world as a homogeneous matrix, shape (4, 4)."""
        return read_only(self._pose)

    @property
    def position(self) -> _Array:
        """Position of the frame in the world [m], shape (3,)."""
        return read_only(self._pose[:3, 3])

    @property
    def rotation(self) -> _Array:
        """Orientation of the frame, shape (3, 3): columns are its axes in the world."""
        return read_only(self._pose[:3, :3])

    @property
    def jacobian(self) -> _Array:
        """Jacobian J of the frame, shape (6, n): J dq = [linear velocity; angular velocity].

        Rows 0 to 2 are [m/rad], rows 3 to 5 [rad/rad], along the world's axes, at the frame's
        origin (Pinocchio's LOCAL_WORLD_ALIGNED).
        """
        return read_only(self._jacobian)


class Configuration(FrameState):
    """Joint positions of a robot, with the pose and the Jacobian of its tip up to date.

    Every array is a copy, and read-only: a configuration stays as it is, whatever becomes of ``q``
    and ``data`` afterwards. Positions outside the joint limits are accepted.

    Args:
        robot: The robot.
        q: Joint positions [rad], shape (n,).
        data: Pinocchio scratch memory of ``robot.model`` to reuse; a loop saves time with it. It
            is overwritten here, by `frame`, and when `inertia` is first asked for.

    Raises:
        InvalidInputError: If ``q`` has a wrong shape or is not finite.
    """

    # Built at every control step, so: slots, and no numpy call that is not needed.
    __slots__ = ("_data", "_inertia", "_q", "_robot")

    def __init__(self, robot: Robot, q: ArrayLike, data: pin.Data | None = None) -> None:
        # A second copy, as `arrays` is not protected.
        self._place(robot, finite_array("q", q, robot.q_lower.shape).copy(), data)

    @classmethod
    def from_checked(cls, robot: Robot, q: _Array, data: pin.Data | None = None) -> Configuration:
        """Make a configuration over an existing array ``q`` (n,), neither copied nor checked.

        For a loop that computes ``q`` itself and does not write into it again.
        """
        conf = cls.__new__(cls)
        conf._place(robot, q, data)
        return conf

    def _place(self, robot: Robot, q: _Array, data: pin.Data | None) -> None:
        self._robot, self._q, self._data = robot, q, data
        self._inertia: _Array | None = None
        super().__init__(*_kinematics(robot, q, data, robot.tip_id))

    @property
    def arrays(self) -> tuple[_Array, _Array, _Array]:
        """``(q, pose, jacobian)`` as compiled code takes them; do not write into them.

        They are not protected, which takes time, as does reading a protected array there.
        """
        return self._q, self._pose, self._jacobian

    @property
    def robot(self) -> Robot:
        """The robot that is in this configuration."""
        return self._robot

    @property
    def q(self) -> _Array:
        """Joint positions [rad], shape (n,)."""
        return read_only(self._q)

    @property
    def inertia(self) -> _Array:
        """Joint-space inertia matrix M [kg m^2], shape (n, n), symmetric positive definite.

        The kinetic energy is dq' M dq / 2. By the composite rigid body algorithm (Featherstone,
        "Rigid Body Dynamics Algorithms", 2008, section 6.2), on first use.
        """
        if self._inertia is None:
            model = self._robot.model
            data = model.createData() if self._data is None else self._data
            self._inertia = pin.crba(model, data, self._q)  # a copy of data's
        return read_only(self._inertia)

    def frame(self, name: str) -> FrameState:
        """Compute pose and Jacobian of any frame of the robot.

        Args:
            name: Name of the frame, out of `Robot.frame_names`.

        Returns:
            Position, rotation and Jacobian, with the conventions of the tip's.

        Raises:
            NotFoundError: If there is no such frame; the error lists those of similar names.
        """
        index = self._robot.frame_id(name)
        return FrameState(*_kinematics(self._robot, self._q, self._data, index))

    def __repr__(self) -> str:
        q = np.array2string(self._q, precision=4, separator=", ")
        return f"<Configuration of {self._robot.name}: q = {q} rad>"

    def __reduce__(self) -> tuple[object, ...]:
        # Cheaper to compute again than to carry, and the scratch memory stays behind.
        return Configuration, (self._robot, self._q)


def _kinematics(
    robot: Robot, q: _Array, data: pin.Data | None, frame_id: int
) -> tuple[_Array, _Array]:
    """Compute pose (4, 4) and Jacobian (6, n) of a frame."""
    model = robot.model
    if data is None:
        data = model.createData()
    # Both results are new arrays, not views of the scratch memory. The first call has placed the
    # joints, so the second need not run over the chain again.
    jacobian = _jacobian(model, data, q, frame_id, _WORLD_AXES)
    if jacobian.ndim == 1:  # of a single joint
        jacobian = jacobian[:, None]
    return _place_frame(model, data, frame_id).homogeneous, jacobian
