"""The ROS 2 node between an arm that is simulated and hostile requests, two processes over DDS.

The node and the arm have an environment of their own, build/ros2, without a ROS installation. The
judges of limits and distances are the project's.
"""

import os
import signal
import subprocess
import sys
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import iiwa_dnn
from judge_distances import Judge

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[2]
FOLDER = ROOT / "build" / "ros2"
PYTHON = FOLDER / "bin" / "python"
MESSAGES = ("sensor-msgs", "geometry-msgs", "trajectory-msgs", "std-msgs", "diagnostic-msgs")
PACKAGES = (
    "numpy>=2",
    "ros-jazzy-rclpy==7.1.6",
    "ros-jazzy-rmw-fastrtps-cpp==8.4.3",
    "ros-jazzy-rosgraph-msgs==2.0.3",
    *(f"ros-jazzy-{name}==5.3.6" for name in (*MESSAGES, "std-srvs")),
)
pytestmark = pytest.mark.skipif(
    sys.version_info[:2] != (3, 11), reason="the wheels of ROS Jazzy are for Python 3.11"
)
SECONDS = os.environ.get("SECONDS_OF_HOSTILE_REQUESTS", "5")
DT = 4e-3
LONGEST = 0.02
DISTANCE = 0.02


def make_shield() -> iiwa_dnn.Shield:
    """Return the shield that is exported: an iiwa 7 beside a ball."""
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(acceleration=10.0, jerk=500.0)
    ball = iiwa_dnn.Sphere(center=[0.36, 0.16, 0.64], radius=0.05)
    scene = {"obstacles": [ball], "distance": DISTANCE}
    # A machine that stalls shows the arm late, and the test is not about that.
    return iiwa_dnn.Shield(robot, DT, longest_period=LONGEST, tracking_error=0.5, **scene)


@pytest.fixture(scope="module")
def environment() -> dict[str, str]:
    """Install the client library, the node and the exported shield; return their environment."""
    run = partial(subprocess.run, check=True)
    pip = [sys.executable, "-m", "pip", "--python", str(PYTHON), "--disable-pip-version-check"]
    if not PYTHON.exists():
        run([sys.executable, "-m", "venv", "--without-pip", FOLDER])
        run([*pip, "install", "-q", *PACKAGES])
    folder = iiwa_dnn.export.python(make_shield(), FOLDER / "arm_shield", name="arm_shield")
    run([*pip, "install", "-q", "--force-reinstall", "--no-deps", folder, HERE.parent])
    own = {"ROS_DOMAIN_ID": str(os.getpid() % 100), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    return os.environ | own


def start(environment: dict[str, str], *words: Any, **options: Any) -> subprocess.Popen[str]:
    """Start a program of the node's environment."""
    return subprocess.Popen([PYTHON, *map(str, words)], env=environment, text=True, **options)


def node_with(environment: dict[str, str], *settings: str, **options: Any) -> subprocess.Popen[str]:
    """Start the node with parameters."""
    words = [word for each in settings for word in ("-p", each)]
    return start(environment, "-m", "ros2_shield.node", "--ros-args", *words, **options)


def test_no_limit_is_broken_and_the_node_says_why_it_brakes(environment, tmp_path: Path) -> None:
    node = node_with(environment, "shield:=arm_shield", "use_sim_time:=true")
    words = (HERE / "arm.py", "arm_shield", tmp_path / "run.npz", SECONDS)
    arm = start(environment, *words, stdout=subprocess.PIPE)
    try:
        for line in arm.stdout:
            print(line, end="")
            if line == "stop\n":
                break
        node.send_signal(signal.SIGINT)
        assert node.wait(60) == 0  # at rest
        assert arm.wait(60) == 0
    finally:
        node.kill()
        arm.kill()
    run = np.load(tmp_path / "run.npz")
    judge(run["start"], run["log"][:, 0], run["log"][:, 1:])


def test_positions_at_the_rate_of_a_timer_break_no_limit(environment, tmp_path: Path) -> None:
    node = node_with(environment, "shield:=arm_shield", "pacing:=timer", "command:=trajectory")
    words = (HERE / "arm.py", "arm_shield", tmp_path / "run.npz", SECONDS, "timed")
    try:
        print(subprocess.check_output([PYTHON, *map(str, words)], env=environment, text=True))
        node.terminate()
        assert node.wait(60) == 0
    finally:
        node.kill()
    path = np.load(tmp_path / "run.npz")["path"]
    judge(path[0], np.full(len(path) - 1, DT), np.diff(path, axis=0) / DT)


def judge(start: np.ndarray, periods: np.ndarray, dq: np.ndarray) -> None:
    """Judge velocities (k, n) [rad/s] that are held for periods (k,) [s], from a start."""
    shield = make_shield()
    lower, upper, velocity, acceleration, jerk = shield.robot.limits
    q = start + np.vstack([0.0 * start, np.cumsum(periods[:, np.newaxis] * dq, axis=0)])
    assert (q >= lower - 1e-9).all()
    assert (q <= upper + 1e-9).all()
    assert (np.abs(dq) <= velocity + 1e-9).all()
    # A command's rates count over the period for which the one before it was held.
    elapsed = periods[:-1, np.newaxis]
    slopes = np.diff(dq, axis=0) / elapsed
    assert (np.abs(slopes) <= acceleration + 1e-6).all()
    assert (np.abs(np.diff(slopes, axis=0) / elapsed[1:]) <= jerk + 1e-4).all()
    scene = Judge(shield.robot, next(each for each in shield.limits if hasattr(each, "obstacles")))
    assert min(scene.distance(each, 0.0) for each in q) >= DISTANCE - 1e-6


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        (("shield:=nothing_here",), "parameter shield: 'nothing_here'"),
        (("shield:=arm_shield", "command:=torque"), "parameter command: 'torque'"),
        (("shield:=arm_shield", "longest_period:=0.5"), "longest_period: 0.5 s, but the shield"),
    ],
)
def test_parameters_are_refused_by_name(environment, settings: tuple[str, ...], words: str) -> None:
    node = node_with(environment, *settings, stderr=subprocess.PIPE)
    _, said = node.communicate(timeout=60)
    assert node.returncode == 2
    assert words in said
