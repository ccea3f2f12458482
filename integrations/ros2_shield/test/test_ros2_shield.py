"""The ROS 2 node between an arm that is simulated and hostile requests, two processes over DDS.

The node and the arm have an environment of their own, build/ros2, without a ROS installation. The
judges of limits and distances are the project's.
"""

import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import iiwa_dnn
from integrations.environment import environment, tables_of
from judge_distances import Judge

HERE = Path(__file__).resolve().parent
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
CONSTRAINTS = [f"constraints.iiwa7_joint_{k}.trajectory:=0.1" for k in range(1, 8)]
SIMULATED = ("use_sim_time:=true", "timeout:=0.5", *CONSTRAINTS)
TIMED = ("command:=trajectory", "following_error:=0.5", "timeout:=0.5")
DISTANCE = 0.02
ROBOT = iiwa_dnn.load_robot("iiwa7").with_limits(acceleration=10.0, jerk=500.0)
BALL = iiwa_dnn.Sphere(center=[0.36, 0.16, 0.64], radius=0.05)


@pytest.fixture(scope="module")
def python() -> Path:
    """Return the Python of the client library, the node and the exported shield."""
    settings = {"longest_period": 0.02, "tracking_error": 0.05, "distance": DISTANCE}
    shield = iiwa_dnn.Shield(ROBOT, dt=4e-3, obstacles=[BALL], **settings)
    folder = HERE.parents[2] / "build" / "ros2"
    return environment(folder, sys.executable, PACKAGES, shield, HERE.parent)


def start(python: Path, *words: Any, **options: Any) -> subprocess.Popen[str]:
    """Start a program of the environment, that no other one on the network sees."""
    own = {"ROS_DOMAIN_ID": str(os.getpid() % 100), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    words = (python, *map(str, words))
    return subprocess.Popen(words, env=os.environ | own, text=True, **options)


def start_node(python: Path, *settings: str, tables: Path | None = None) -> subprocess.Popen[str]:
    """Start the node with parameters beside its shield."""
    shield = f"shield:={tables or tables_of(python)}"
    words = [word for each in (shield, *settings) for word in ("-p", each)]
    program = ("-m", "ros2_shield.node", "--ros-args")
    return start(python, *program, *words, stderr=subprocess.PIPE)


def run(python: Path, folder: Path, mode: str, *settings: str, tables: Path | None = None) -> Any:
    """Run the node and an arm, end the node in motion, and return what the arm has written."""
    node = start_node(python, *settings, tables=tables)
    words = (HERE / "arm.py", tables or tables_of(python), folder / "run.npz", SECONDS, mode)
    arm = start(python, *words, stdout=subprocess.PIPE)
    try:
        for line in arm.stdout:
            print(line, end="")
            if line == "stop\n":
                break
        node.send_signal(signal.SIGTERM if mode == "timed" else signal.SIGINT)
        assert node.wait(60) == 0  # at rest
        assert arm.wait(60) == 0
    finally:
        node.kill()
        arm.kill()
    return np.load(folder / "run.npz")


@pytest.mark.parametrize(
    ("mode", "settings"), [("simulated", SIMULATED), ("timed", TIMED), ("moving", SIMULATED)]
)
def test_no_limit_is_broken_and_the_node_says_why_it_brakes(
    python: Path, mode: str, settings: tuple[str, ...], tmp_path: Path
) -> None:
    found = run(python, tmp_path, mode, *settings)
    judge(found["start"], found["log"])


def test_a_bad_network_breaks_no_limit_and_slows_the_arm_little(
    python: Path, tmp_path: Path
) -> None:
    ways = []
    for mode in ("near", "remote"):
        found = run(python, tmp_path, mode, *SIMULATED)
        judge(found["start"], found["log"])
        ways.append(np.abs(found["log"][:, :1] * found["log"][:, 1:]).sum())
    print(f"way {ways[1] / ways[0]:.3f} of that over a good network")
    assert ways[1] >= 0.9 * ways[0]


@pytest.mark.parametrize("mode", ["people", "bodies"])
def test_a_link_is_at_rest_before_a_person_is_there_whatever_the_network_does(
    python: Path, mode: str, tmp_path: Path
) -> None:
    """The project's judge of people: distances every 0.1 ms, kinematics of its own."""
    judge_people = pytest.importorskip("judge_people", reason="numba compiles the judge")
    about: dict[str, Any] = {"people": 1, "people_speed": 1.6, "field": 2.5}
    setting = "people_radii:=[0.1]"
    obstacles = []
    if mode == "bodies":
        about = {}
        setting = "body_names:=[hand]"
        obstacles = [iiwa_dnn.Sphere([2.2, 0.3, 0.6], 0.1, speed=1.6, name="hand")]
    about |= {"latency": 0.0, "tracking_error": 0.05, "longest_period": 0.02}
    robot = ROBOT.with_limits(jerk=np.inf)  # periods vary
    shield = iiwa_dnn.Shield(robot, 4e-3, obstacles, DISTANCE, **about)
    tables = tmp_path / "people.json"
    iiwa_dnn.export.tables(shield, tables)
    found = run(python, tmp_path, mode, *SIMULATED, setting, tables=tables)
    begun, ended, q, dq = np.split(found["places"], [3, 6, 13], axis=1)
    arm = judge_people.skeleton_of(ROBOT)
    least = np.inf
    for k in np.flatnonzero(dq.any(axis=1)):
        person = [np.tile(each[k], (1, 2, 1)) for each in (begun, ended)]
        near, _ = judge_people.judge(
            arm, q[k], dq[k], *person, (shield.dt, 0.1, 1.6, DISTANCE, 0.0), 1.0
        )
        least = min(least, near)
    moving = dq.any(axis=1).mean()
    print(f"{len(dq)} periods, moving in {moving:.3f}, least distance {1e3 * least:.3f} mm")
    assert DISTANCE - 1e-9 <= least < 1.0


def judge(start: np.ndarray, log: np.ndarray) -> None:
    """Judge periods [s] and the velocities [rad/s] held for them, (k, 1 + n), from a start."""
    periods = log[:, :1]
    dq = log[:, 1:]
    lower, upper, velocity, acceleration, jerk = ROBOT.limits
    q = start + np.vstack([0.0 * start, np.cumsum(periods * dq, axis=0)])
    assert (q >= lower - 1e-9).all()
    assert (q <= upper + 1e-9).all()
    assert (np.abs(dq) <= velocity + 1e-9).all()
    # A command's rates count over the period for which the one before it was held.
    slopes = np.diff(dq, axis=0) / periods[:-1]
    assert (np.abs(slopes) <= acceleration + 1e-6).all()
    assert (np.abs(np.diff(slopes, axis=0) / periods[1:-1]) <= jerk + 1e-4).all()
    scene = Judge(ROBOT, iiwa_dnn.CollisionAvoidance([BALL], distance=DISTANCE))
    least = min(scene.distance(each, 0.0) for each in q)
    assert least >= DISTANCE - 1e-6
    print(f"{len(dq)} periods, least distance {1e3 * least:.3f} mm")


def test_parameters_are_refused_by_name(python: Path) -> None:
    for setting in (
        "shield:=numpy",
        "shield:=./arm",
        "command:=torque",
        "timeout:=1",
        "people_radii:=[-0.1]",
        "people_radii:=[0.1]",
        "body_names:=[hand]",
    ):
        node = start_node(python, setting)
        said = node.communicate(timeout=60)[1]
        assert node.returncode == 2
        assert setting.split(":=")[0] in said
        assert "Traceback" not in said
