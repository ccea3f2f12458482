"""A configuration: joint positions together with the kinematics that belong to them."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.robot.robot import Robot

_WORLD_AXES = pin.LOCAL_WORLD_ALIGNED
_jacobian, _place_tip = pin.computeFrameJacobian, pin.updateFramePlacement


class Configuration:
    """Joint positions of a robot, with the pose and the Jacobian of its tip up to date.

    Every array is a copy, and read-only: what a configuration says stays true, whatever becomes of
    ``q`` and ``data`` afterwards. Positions outside the joint limits are accepted.

    Attributes:
        arrays: ``(q, pose, jacobian)`` as compiled code takes them. They are not protected,
            which takes time, as does reading a protected array there; do not write into them.

    Args:
        robot: The robot.
        q: Joint positions [rad], shape (n,).
        data: Pinocchio scratch memory of ``robot.model`` to reuse; a loop saves time with it. It
            is overwritten here, and again when ``inertia`` is first asked for.

    Raises:
        InvalidInputError: If ``q`` has a wrong shape or is not finite.
    """

    # Built at every control step, so: slots, and no numpy call that is not needed.
    __slots__ = ("_data", "_inertia", "_robot", "arrays")
    arrays: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]
    _inertia: NDArray[np.float64] | None

    def __init__(self, robot: Robot, q: ArrayLike, data: pin.Data | None = None) -> None:
        vector = _joint_vector(q, robot.q_lower.shape)
        self._robot, self._data, self._inertia = robot, data, None
        self.arrays = _kinematics(robot, vector, data)

    @classmethod
    def from_checked(
        cls, robot: Robot, q: NDArray[np.float64], data: pin.Data | None = None
    ) -> Configuration:
        """A configuration over an existing array ``q`` (n,), which is neither copied nor checked.

        For a loop that computes ``q`` itself and does not write into it again.
        """
        conf = cls.__new__(cls)
        conf._robot, conf._data, conf._inertia = robot, data, None
        conf.arrays = _kinematics(robot, q, data)
        return conf

    @property
    def robot(self) -> Robot:
        """The robot that is in this configuration."""
        return self._robot

    @property
    def q(self) -> NDArray[np.float64]:
        """Joint positions [rad], shape (n,)."""
        return checks.read_only(self.arrays[0])

    @property
    def pose(self) -> NDArray[np.float64]:
        """Pose of the tip in the world as a homogeneous matrix, shape (4, 4)."""
        return checks.read_only(self.arrays[1])

    @property
    def position(self) -> NDArray[np.float64]:
        """Position of the tip in the world [m], shape (3,)."""
        return checks.read_only(self.arrays[1][:3, 3])

    @property
    def rotation(self) -> NDArray[np.float64]:
        """Orientation of the tip, shape (3, 3): columns are the tip's axes in the world."""
        return checks.read_only(self.arrays[1][:3, :3])

    @property
    def jacobian(self) -> NDArray[np.float64]:
        """Jacobian J of the tip, shape (6, n): J dq = [linear velocity; angular velocity].

        Rows 0 to 2 are [m/rad], rows 3 to 5 [rad/rad], along the world's axes, at the tip's origin
        (Pinocchio's LOCAL_WORLD_ALIGNED).
        """
        return checks.read_only(self.arrays[2])

    @property
    def inertia(self) -> NDArray[np.float64]:
        """Joint-space inertia matrix M [kg m^2], shape (n, n), symmetric positive definite.

        The kinetic energy is dq' M dq / 2. By the composite rigid body algorithm (Featherstone,
        "Rigid Body Dynamics Algorithms", 2008, section 6.2), on first use.
        """
        if self._inertia is None:
            model = self._robot.model
            data = model.createData() if self._data is None else self._data
            self._inertia = pin.crba(model, data, self.arrays[0])  # a copy of data's
        return checks.read_only(self._inertia)

    def __repr__(self) -> str:
        q = np.array2string(self.arrays[0], precision=4, separator=", ")
        return f"<Configuration of {self._robot.name}: q = {q} rad>"

    def __reduce__(self) -> tuple[object, ...]:
        # Cheaper to compute again than to carry, and the scratch memory stays behind.
        return Configuration, (self._robot, self.arrays[0])


def _kinematics(
    robot: Robot, q: NDArray[np.float64], data: pin.Data | None
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """``(q, pose, jacobian)``."""
    model, tip_id = robot.model, robot.tip_id
    if data is None:
        data = model.createData()
    # Both results are new arrays, not views of the scratch memory. The first call has placed the
    # joints, so the second need not run over the chain again.
    jacobian = _jacobian(model, data, q, tip_id, _WORLD_AXES)
    return q, _place_tip(model, data, tip_id).homogeneous, jacobian


def _joint_vector(q: ArrayLike, shape: tuple[int, ...]) -> NDArray[np.float64]:
    """A checked copy of joint positions."""
    try:
        vector = np.array(q, np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidInputError("q", "must be numbers", q) from error
    if vector.shape != shape:
        raise InvalidInputError("q", f"must have shape {shape}, not {vector.shape}", q)
    if not np.isfinite(vector).all():
        raise InvalidInputError("q", "must be finite", q)
    return vector
