"""Seeded random runs of the whole loop: whatever is asked for, limits hold and nothing crashes."""

import warnings
from typing import Any

import numpy as np
import pytest

import iiwa_dnn
from iiwa_dnn import Configuration, Record, Robot
from iiwa_dnn.simulation import NOISE_ENTRIES
from iiwa_dnn.simulation.estimation import NoiseModel
from iiwa_dnn.step.policies import POLICIES

ROBOTS = ("iiwa7", "panda", "xarm7")
STEPS = 60


def reference(number: int, size: float, rng: np.random.Generator) -> iiwa_dnn.Reference:
    """A path of about that size [m], run through in 0.5 to 10 s."""
    period = float(10 ** rng.uniform(-0.3, 1.0))
    paths = (
        iiwa_dnn.Heart(scale=size / 30.0, period=period),
        iiwa_dnn.Circle(radius=size, period=period),
        iiwa_dnn.Lissajous(amplitudes=(size, size / 2, size / 3), period=period),
        iiwa_dnn.Line(offset=tuple(size * rng.standard_normal(3)), period=period),
        iiwa_dnn.Waypoints(
            np.linspace(0.0, period, 5),
            size * rng.standard_normal((5, 3)),
        ),
    )
    return paths[number % 5]


def options(number: int) -> dict[str, Any]:
    """All that run `number` is made of."""
    rng = np.random.default_rng([number, 11])
    robot = iiwa_dnn.load_robot(ROBOTS[number % 3])
    lower, upper = np.maximum(robot.q_lower, -3.0), np.minimum(robot.q_upper, 3.0)
    if rng.random() < 0.3:
        robot = robot.with_limits(velocity=float(10 ** rng.uniform(-2, 0)) * robot.dq_max)
    q0 = rng.uniform(lower, upper)
    if rng.random() < 0.3:  # some joints outside, by up to half a radian
        outside = rng.random(robot.dof) < 0.3
        q0 = np.where(outside, upper + 0.5 * rng.random(robot.dof), q0)
    size = float(10 ** rng.uniform(-3, 1))
    dt = float(10 ** rng.uniform(-4, -2))
    path = reference(number, size, rng)
    anchor = q0
    if rng.random() < 0.2:  # a path that begins elsewhere
        anchor = q0 + 0.3 * rng.standard_normal(robot.dof)
    noisy = rng.random() < 0.5
    entry = str(rng.choice(NOISE_ENTRIES))
    mode = "continuous" if rng.random() < 0.2 else "converged"
    motion = str(rng.choice(["euler", "midpoint", "rk4"]))
    scale = 0.01 if entry == "measurement" else 1.0
    return {
        "robot": robot,
        "scheme": iiwa_dnn.DoubleIndicator(
            weight=float(rng.random()),
            orientation=str(rng.choice(["so3", "block", "none"])),
            kinetic=str(rng.choice(["identity", "inertia"])),
            limit_gain=float(10 ** rng.uniform(0, 3)),
            position_gain=float(10 ** rng.uniform(0, 2)),
        ),
        "reference": path.anchored(Configuration(robot, anchor)),
        "q0": q0,
        "dt": dt,
        "duration": STEPS * dt,
        "mode": mode,
        "motion": motion if mode == "converged" else "euler",
        "noise": float(10 ** rng.uniform(-4, 1)) * scale * noisy,
        "noise_at": entry,
        "filter_window": int(rng.choice([1, 1, 10])),
        "estimator": NoiseModel(bias_walk=0.01) if rng.random() < 0.2 else None,
        "policy": POLICIES[int(rng.integers(3))],
        "seed": number,
        "check": iiwa_dnn.CrossCheck(()),
    }


def beyond(record: Record, robot: Robot) -> float:
    """How far a limit was broken: no joint further out than it was, none faster than it may be."""
    out = np.maximum(record.q - robot.q_upper, 0.0) + np.maximum(robot.q_lower - record.q, 0.0)
    fast = np.abs(record.dq) - robot.dq_max
    return float(max(np.diff(out, axis=0).max(initial=0.0), fast.max(initial=0.0)))


@pytest.mark.filterwarnings("ignore:the acceleration jumps")  # of random rows
def test_limits_hold_and_every_run_has_an_end() -> None:
    actions = set()
    clipped = 0
    for number in range(45):
        asked = options(number)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            # Off its path and its limits on purpose.
            warnings.filterwarnings("ignore", "the (reference begins|start posture|path leads)")
            record = iiwa_dnn.simulate(**asked)
            iiwa_dnn.failures(record)
        assert beyond(record, asked["robot"]) <= 1e-9, number
        for name in ("q", "dq", "dq_solver", "position", "rotation", "position_desired"):
            assert np.isfinite(getattr(record, name)).all(), (number, name)
        status = record.settings["status"]
        assert status.startswith("stopped at step") or record.steps == STEPS, (number, status)
        actions |= set(record.action.tolist())
        clipped += int(record.clipped.sum())
    # Otherwise nothing was tried.
    assert {0, 2, 3, 4} <= actions
    assert clipped > 100
