"""The shield under random policies, through Gymnasium and in the form of LeRobot's processors."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import iiwa_dnn
from judge_limits import breaches

SCRIPTS = Path(__file__).parents[2] / "scripts"


@pytest.mark.parametrize(("run", "dt"), [("run_gymnasium", 0.01), ("run_chunks", 0.02)])
def test_random_policies_break_no_limit(
    run: str, dt: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(str(SCRIPTS))
    import shielded_policies

    robot = iiwa_dnn.load_robot("iiwa7").with_limits(acceleration=10.0, jerk=500.0)
    path, clipped = getattr(shielded_policies, run)(robot, 400)
    kinds = (robot.q_lower, robot.q_upper, robot.dq_max, robot.ddq_max, robot.dddq_max)
    assert breaches(np.array(path), dt, *kinds) == []
    assert clipped > 0
    assert np.ptp(path, axis=0).min() > 0.1  # and they move


def test_the_step_leaves_what_is_no_joint(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(SCRIPTS))
    import shielded_policies

    robot = iiwa_dnn.load_robot("iiwa7")
    names = list(robot.joint_names)
    step = shielded_policies.ShieldStep(iiwa_dnn.Shield(robot, 0.02), names)
    here = {f"{name}.pos": float(x) for name, x in zip(names, np.degrees(np.zeros(7)), strict=True)}
    made = step({"observation": here, "action": here | {"gripper.pos": 40.0}, "reward": 1.0})
    assert made["action"] == here | {"gripper.pos": 40.0}
    assert made["reward"] == 1.0
