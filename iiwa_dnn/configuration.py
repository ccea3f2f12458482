"""A configuration: joint positions together with the kinematics that belong to them."""

from __future__ import annotations

from math import isfinite

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn.exceptions import InvalidInputError
from iiwa_dnn.robot import Robot

_WORLD_AXES = pin.LOCAL_WORLD_ALIGNED


class Configuration:
    """Joint positions of a robot, with the pose and the Jacobian of its tip up to date.

    Every array is a read-only copy: what a configuration says stays true, whatever becomes of
    ``q`` and ``data`` afterwards. Positions outside the joint limits are accepted.

    Args:
        robot: The robot.
        q: Joint positions [rad], shape (n,).
        data: Pinocchio scratch memory of ``robot.model`` to reuse; a loop saves time with it. It
            is overwritten here, and again when ``inertia`` is first asked for.

    Raises:
        InvalidInputError: If ``q`` has a wrong shape or is not finite.
    """

    # Built at every control step, so: slots, and no numpy call that is not needed.
    __slots__ = ("_data", "_inertia", "_jacobian", "_pose", "_q", "_robot")
    _jacobian: NDArray[np.float64]
    _pose: NDArray[np.float64]

    def __init__(self, robot: Robot, q: ArrayLike, data: pin.Data | None = None) -> None:
        self._q = q = _joint_vector(q, robot.q_lower.shape)
        self._robot = robot
        self._data = data
        self._inertia: NDArray[np.float64] | None = None
        model, tip_id = robot.model, robot.tip_id
        if data is None:
            data = model.createData()
        # Both are new arrays, not views of the scratch memory.
        self._jacobian = pin.computeFrameJacobian(model, data, q, tip_id, _WORLD_AXES)
        # The call above has placed the joints, so this one need not run over the chain again.
        self._pose = pin.updateFramePlacement(model, data, tip_id).homogeneous
        self._jacobian.setflags(write=False)
        self._pose.setflags(write=False)

    @property
    def robot(self) -> Robot:
        """The robot that is in this configuration."""
        return self._robot

    @property
    def q(self) -> NDArray[np.float64]:
        """Joint positions [rad], shape (n,)."""
        return self._q

    @property
    def pose(self) -> NDArray[np.float64]:
        """Pose of the tip in the world as a homogeneous matrix, shape (4, 4)."""
        return self._pose

    @property
    def position(self) -> NDArray[np.float64]:
        """Position of the tip in the world [m], shape (3,)."""
        return self._pose[:3, 3]

    @property
    def rotation(self) -> NDArray[np.float64]:
        """Orientation of the tip, shape (3, 3): columns are the tip's axes in the world."""
        return self._pose[:3, :3]

    @property
    def jacobian(self) -> NDArray[np.float64]:
        """Jacobian J of the tip, shape (6, n): J dq = [linear velocity; angular velocity].

        Rows 0 to 2 are [m/rad], rows 3 to 5 [rad/rad], along the world's axes, at the tip's origin
        (Pinocchio's LOCAL_WORLD_ALIGNED).
        """
        return self._jacobian

    @property
    def inertia(self) -> NDArray[np.float64]:
        """Joint-space inertia matrix M [kg m^2], shape (n, n), symmetric positive definite.

        The kinetic energy is dq' M dq / 2. By the composite rigid body algorithm (Featherstone,
        "Rigid Body Dynamics Algorithms", 2008, section 6.2), on first use.
        """
        if self._inertia is None:
            model = self._robot.model
            data = model.createData() if self._data is None else self._data
            self._inertia = inertia = pin.crba(model, data, self._q)  # a copy of data's
            inertia.setflags(write=False)
        return self._inertia

    def __repr__(self) -> str:
        q = np.array2string(self._q, precision=4, separator=", ")
        return f"<Configuration of {self._robot.name}: q = {q} rad>"

    def __reduce__(self) -> tuple[object, ...]:
        # Cheaper to compute again than to carry, and the scratch memory stays behind.
        return Configuration, (self._robot, self._q)


def _joint_vector(q: ArrayLike, shape: tuple[int, ...]) -> NDArray[np.float64]:
    """A checked, read-only copy of joint positions."""
    try:
        vector = np.array(q, np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidInputError("q", "must be numbers", q) from error
    if vector.shape != shape:
        raise InvalidInputError("q", f"must have shape {shape}, not {vector.shape}", q)
    # A sum of floats is finite unless one of them is not, or they overflow: the quick test errs on
    # one side only, and np.isfinite decides.
    if not isfinite(sum(vector.tolist())) and not np.isfinite(vector).all():
        raise InvalidInputError("q", "must be finite", q)
    vector.setflags(write=False)
    return vector
