"""Poses of the frames that a run tracks beside its first."""

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.qp import Matrix
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.kinematics import Kinematics


class TrackedFrames:
    """Arrays of a record with the poses of f further frames, actual and desired.

    Attributes:
        arrays: By their names in `iiwa_dnn.Record`; none where f = 0.
    """

    def __init__(self, steps: int, robot: Robot, names: tuple[str, ...]) -> None:
        """Allocate for so many steps; the first of the frames has its own arrays."""
        self._kinematics = Kinematics(robot, names)
        self._ids = [robot.frame_id(name) for name in names[1:]]
        shape = (steps + 1, len(self._ids))
        self.arrays: dict[str, NDArray[np.float64]] = {}
        if self._ids:
            for suffix in ("", "_desired"):
                self.arrays["frame_position" + suffix] = np.empty((*shape, 3))
                self.arrays["frame_rotation" + suffix] = np.empty((*shape, 3, 3))

    def add(self, first: int, q: Matrix, targets: Matrix) -> None:
        """Take in k samples from number `first` on: q (k, n) [rad] and targets (k, 18 frames)."""
        if not self._ids:
            return
        samples, arrays = slice(first, first + len(q)), self.arrays
        desired = targets.reshape(len(q), -1, 18)[:, 1:]
        turned = desired[..., 3:12].reshape(len(q), -1, 3, 3)
        arrays["frame_position_desired"][samples] = desired[..., :3]
        arrays["frame_rotation_desired"][samples] = turned
        for k, posture in enumerate(q, first):
            self._kinematics.update(posture)
            places = self._kinematics.placements[self._ids]
            arrays["frame_position"][k] = places[:, 9:]
            # A placement holds the rotation column by column.
            arrays["frame_rotation"][k] = places[:, :9].reshape(-1, 3, 3).swapaxes(1, 2)
