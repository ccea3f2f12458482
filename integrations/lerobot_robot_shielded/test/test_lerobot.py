"""The shielded robot under LeRobot's own commands: its record and teleoperation loops, at 30 Hz.

LeRobot has an environment of its own, build/lerobot, with the Python >= 3.12 that PYTHON_OF_LEROBOT
names.
"""

import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

import iiwa_dnn
from integrations.environment import environment
from judge_limits import breaches

HERE = Path(__file__).resolve().parent
PYTHON = os.environ.get("PYTHON_OF_LEROBOT", "python3.12")
DT = 1.0 / 30.0
ROBOT = iiwa_dnn.load_robot("iiwa7").with_limits(acceleration=10.0, jerk=200.0)
WORDS = (
    "--robot.type=shielded",
    "--robot.shield=arm_shield",
    "--robot.joints=[joint1,joint2,joint3,joint4,joint5,joint6,joint7]",
    "--robot.robot={type: ideal, id: arm}",
    "--teleop.type=chunks",
)
RECORD = (
    "--dataset.repo_id=tests/seams",
    "--dataset.single_task=none",
    "--dataset.num_episodes=1",
    "--dataset.episode_time_s=10",
    "--dataset.video=false",
    "--dataset.push_to_hub=false",
    "--play_sounds=false",
)


@pytest.fixture(scope="module")
def commands() -> Path:
    """Return the folder of LeRobot's commands, beside both robots and the exported shield."""
    folder = HERE.parents[2] / "build" / "lerobot"
    shield = iiwa_dnn.Shield(ROBOT, DT, obstacles=[])
    packages = ("lerobot[dataset]==0.6.1",)
    return environment(folder, PYTHON, packages, shield, HERE.parent, HERE / "ideal").parent


@pytest.mark.parametrize("command", ["record", "teleoperate"])
def test_chunks_with_seams_break_no_limit(commands: Path, command: str, tmp_path: Path) -> None:
    root = f"--dataset.root={tmp_path / 'data'}"
    words = (*RECORD, root) if command == "record" else ("--fps=30", "--teleop_time_s=10")
    files = {"GOALS_FILE": str(tmp_path / "goals.npy"), "HF_LEROBOT_HOME": str(tmp_path / "home")}
    done = subprocess.run(
        [commands / f"lerobot-{command}", *WORDS, *words],
        env=os.environ | files | {"HF_HUB_OFFLINE": "1"},
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr[-3000:]
    assert "shield: joint" in done.stderr + done.stdout
    goals = np.load(files["GOALS_FILE"])
    assert len(goals) > 100
    assert len(set(goals[:, -1])) > 50  # the gripper goes through
    q = np.radians(goals[:, :-1])
    assert np.ptp(q, axis=0).min() > 0.1
    assert breaches(q, DT, *ROBOT.limits) == []
    np.testing.assert_allclose(q[-1], q[-2], atol=1e-9)  # at rest before the motors are off
