"""The robot's motion: orders by regression on known flows, and on the heart itself."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_kinematics import Array, dh_pose
from helpers_simulation import heart, run
from iiwa_dnn.simulation import MOTIONS

ORDERS = {"euler": 1, "midpoint": 2, "rk4": 4}


def slope(steps: list[float], errors: list[float]) -> float:
    return float(np.polyfit(np.log(steps), np.log(errors), 1)[0])


def integrate(motion: str, velocity, q: Array, dt: float, duration: float) -> Array:
    for k in range(round(duration / dt)):
        q = q + dt * MOTIONS[motion].step(velocity, q, k * dt, dt)
    return q


@pytest.mark.parametrize("motion", ORDERS)
def test_order_on_a_rotating_field(motion: str) -> None:
    # dq/dt = w [0 -1; 1 0] q turns q by w t.
    def velocity(q: Array, t: float) -> Array:
        return 2.0 * np.array([-q[1], q[0]])

    exact = 0.5 * np.array([np.cos(2.0), np.sin(2.0)])
    steps = [0.1, 0.05, 0.025, 0.0125]
    errors = [
        float(np.linalg.norm(integrate(motion, velocity, np.array([0.5, 0.0]), dt, 1.0) - exact))
        for dt in steps
    ]
    assert slope(steps, errors) == pytest.approx(ORDERS[motion], abs=0.1)


@pytest.mark.parametrize("motion", ORDERS)
def test_order_on_a_field_that_depends_on_time(motion: str) -> None:
    # Feedback on a moving target, as in the robot's own loop: the solution is cos t exactly.
    def velocity(q: Array, t: float) -> Array:
        return -3.0 * (q - np.cos(t)) ** 3 - 3.0 * (q - np.cos(t)) - np.sin(t)

    steps, errors = [0.1, 0.05, 0.025, 0.0125], []
    for dt in steps:
        q, error = np.ones(1), 0.0
        for k in range(round(2.0 / dt)):
            q = q + dt * MOTIONS[motion].step(velocity, q, k * dt, dt)
            error = max(error, abs(float(q[0]) - np.cos((k + 1) * dt)))
        errors.append(error)
    assert slope(steps, errors) == pytest.approx(ORDERS[motion], abs=0.25)


@pytest.mark.parametrize("motion", ORDERS)
def test_order_on_the_heart(motion: str) -> None:
    # A heart in 2 s, its first 0.8 s; the position by the DH formula, not by the record.
    reference = heart(period=2.0)
    steps, errors = [0.02, 0.01, 0.005], []
    for dt in steps:
        record = run(reference=reference, dt=dt, duration=0.8, motion=motion)
        desired = np.array([reference.at(t).position for t in record.t])
        errors.append(float(np.linalg.norm(dh_pose(record.q)[0] - desired, axis=1).max()))
    assert slope(steps, errors) == pytest.approx(ORDERS[motion], abs=0.15)
