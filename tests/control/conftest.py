"""Fixtures of the tests of the steps."""

from typing import Any

import numpy as np
import pytest

from iiwa_dnn.robot.kinematics import Kinematics
from iiwa_dnn.robot.kinematics_kernel import model_tables, write_kinematics


@pytest.fixture
def kernels_kinematics(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the kernel compute the kinematics of shields at the desk too, not Pinocchio."""

    def update(self: Any, q: np.ndarray) -> None:
        tables = vars(self).setdefault("tables", model_tables(self.robot, self.frame_ids))
        joints = np.ascontiguousarray(q)
        write_kinematics(tables, joints, self.jacobian, self.placements, self.inertia)

    monkeypatch.setattr(Kinematics, "update", update)
