"""The robot's motion: its order by regression on the heart."""

import numpy as np
import pytest

from helpers_kinematics import dh_pose
from helpers_simulation import heart, run

ORDERS = {"euler": 1, "midpoint": 2, "rk4": 4}


@pytest.mark.parametrize("motion", ORDERS)
def test_order_on_the_heart(motion: str) -> None:
    # A heart in 2 s, its first 0.8 s; the position by the DH formula, not by the record.
    reference = heart(period=2.0)
    steps, errors = [0.02, 0.01, 0.005], []
    for dt in steps:
        record = run(reference=reference, dt=dt, duration=0.8, motion=motion)
        desired = np.array([reference.at(t).position for t in record.t])
        errors.append(float(np.linalg.norm(dh_pose(record.q)[0] - desired, axis=1).max()))
    slope = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert slope == pytest.approx(ORDERS[motion], abs=0.15)
