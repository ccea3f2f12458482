"""The shielded robot under LeRobot's own commands: its loop that records, at 30 Hz.

LeRobot has an environment of its own, build/lerobot, with the Python >= 3.12 that PYTHON_OF_LEROBOT
names.
"""

import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

import iiwa_dnn
from integrations.environment import environment, tables_of
from judge_limits import breaches

HERE = Path(__file__).resolve().parent
PYTHON = os.environ.get("PYTHON_OF_LEROBOT", "python3.12")
DT = 1.0 / 30.0
ROBOT = iiwa_dnn.load_robot("so101").with_limits(acceleration=10.0, jerk=200.0)
RECORD = (
    f"--robot.joints=[{','.join(ROBOT.joint_names)}]",
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


def run(commands: Path, command: str, folder: Path, *words: str) -> subprocess.CompletedProcess:
    """Run a command of LeRobot with the shielded robot, which notes its goals in a folder."""
    shield = f"--robot.shield={tables_of(commands / 'python')}"
    robot = ("--robot.type=shielded", shield, "--robot.robot={type: ideal}")
    own = {"GOALS_FILE": str(folder / "goals.npy"), "HF_LEROBOT_HOME": str(folder / "home")}
    return subprocess.run(
        [commands / f"lerobot-{command}", *robot, "--teleop.type=chunks", *words],
        env=os.environ | own | {"HF_HUB_OFFLINE": "1"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=300,
    )


def test_chunks_with_seams_break_no_limit(commands: Path, tmp_path: Path) -> None:
    done = run(commands, "record", tmp_path, *RECORD, f"--dataset.root={tmp_path / 'data'}")
    assert done.returncode == 0, done.stdout[-3000:]
    for words in ("shoulder_pan lower", "shoulder_pan does not follow", "no number for each"):
        assert f"shield: {words}" in done.stdout
    goals = np.load(tmp_path / "goals.npy")
    assert len(goals) > 100
    assert len(set(goals[:, -1])) > 50  # the gripper goes through
    q = np.radians(goals[:, :-1])
    assert np.ptp(q, axis=0).min() > 0.1
    assert breaches(q, DT, *ROBOT.limits) == []
    assert np.abs(q[50:100, 0] - q[50, 0]).max() < 0.5  # the motor that is stuck
    np.testing.assert_allclose(q[-1], q[-2], atol=1e-9)  # at rest before the motors are off


def test_a_lead_of_one_action_makes_motors_one_action_late(commands: Path, tmp_path: Path) -> None:
    for lead, most in (("", 6), ("--robot.lead=1", 2)):
        words = (RECORD[0], "--teleop.smooth=true", "--fps=30", "--teleop_time_s=6", *lead.split())
        done = run(commands, "teleoperate", tmp_path, *words)
        assert done.returncode == 0, done.stdout[-3000:]
        q = np.radians(np.load(tmp_path / "goals.npy")[:, :-1])
        assert breaches(q, DT, *ROBOT.limits) == []
        k = np.arange(60, 150)
        off = [
            np.abs(q[k, 4] - np.radians(20.0 * np.sin(np.pi / 25.0 * (k - d)))) for d in range(8)
        ]
        late = int(np.argmin([each.sum() for each in off]))
        assert most - 2 <= late <= most
        assert lead == "" or off[late].max() < 5e-3


def test_a_motor_is_one_joint(commands: Path, tmp_path: Path) -> None:
    done = run(commands, "teleoperate", tmp_path, f"--robot.joints=[{','.join(5 * ['gripper'])}]")
    assert "joints: ['gripper.pos'" in done.stdout
