"""A Franka arm as a plant against franka-sim, an independent server of libfranka's protocol.

The server runs in an environment of its own, build/franka-sim, since it pins an older numpy. It
aborts a motion that breaks a limit or loses 20 commands in a row, as the robot does.
"""

import contextlib
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import iiwa_dnn
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.results.failures import failures

pytestmark = pytest.mark.realtime

FOLDER = Path(__file__).resolve().parents[3] / "build" / "franka-sim"
PYTHON = FOLDER / "bin" / "python"
PACKAGES = (
    *("franka-sim==1.1.7", "mujoco==3.2.7", "numpy==1.26.4"),
    *("absl-py", "etils", "glfw", "pyopengl"),  # MuJoCo's own
)
PORT = 1337  # the only one that libfranka asks
HOST = "127.0.0.1"
ROBOT = iiwa_dnn.load_robot("fr3")
TIP_SPEED = iiwa_dnn.TipSpeedLimit(iiwa_dnn.FrankaPlant.tip_speed)
LIMITS = (iiwa_dnn.AccelerationLimits(), iiwa_dnn.JerkLimits(), TIP_SPEED)

# The server's velocity servo is explicit at 1 kHz: with less inertia it is not stable.
MODEL = """
import sys, mujoco
text = open(sys.argv[1]).read()
head = '<mujoco><compiler fusestatic="false" discardvisual="true"/></mujoco>'
base = '<link name="base" />'
spec = mujoco.MjSpec.from_string(text.replace(base, head + base))
for geom in spec.geoms:
    geom.contype = geom.conaffinity = 0
for joint, armature in zip(spec.joints, [0.4] * 4 + [0.2] * 3):
    joint.armature = armature
    joint.damping = 1.0
    joint.frictionloss = 0.0
spec.compile()
open(sys.argv[2], "w").write(spec.to_xml())
"""


def make_environment() -> None:
    """Install the server, unless it is there already."""
    done = FOLDER / "done"
    if done.exists():
        return
    subprocess.run([sys.executable, "-m", "venv", FOLDER], check=True)
    install = [PYTHON, "-m", "pip", "install", "-q", "--no-deps", *PACKAGES]
    subprocess.run(install, check=True, capture_output=True)
    urdf = ROBOT.path
    subprocess.run([PYTHON, "-c", MODEL, str(urdf), FOLDER / "fr3.xml"], check=True)
    done.touch()


def hurry(priority: int = 10) -> None:
    """Let a robot's side of the loop come first, where that is allowed."""
    with contextlib.suppress(PermissionError):
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(priority))


@pytest.fixture(scope="module")
def server() -> Iterator[subprocess.Popen[bytes]]:
    """Start the server and wait until it answers."""
    pytest.importorskip("pylibfranka")
    try:
        make_environment()
    except (OSError, subprocess.CalledProcessError) as error:
        pytest.skip(f"franka-sim cannot be installed here: {error}")
    command = [
        *(PYTHON, "-m", "franka_sim.run_server", "--no-gripper"),
        *("--enforce-motion-limits", "--enforce-comm-constraints"),
    ]
    log = (FOLDER / "server.log").open("wb")
    process = subprocess.Popen(
        command,
        env={**os.environ, "FR3_MJCF": str(FOLDER / "fr3.xml")},
        stdout=log,
        stderr=log,
        start_new_session=True,
        preexec_fn=hurry,
    )
    deadline = time.monotonic() + 60.0
    while time.monotonic() < deadline and process.poll() is None:
        with contextlib.suppress(OSError), socket.create_connection((HOST, PORT), 1.0):
            break
        time.sleep(0.2)
    time.sleep(1.5)  # the server takes the next client after a while
    before = (os.sched_getscheduler(0), os.sched_getparam(0))
    hurry(5)
    yield process
    with contextlib.suppress(PermissionError):
        os.sched_setscheduler(0, *before)
    process.kill()
    process.wait()
    log.close()


def prepared(
    reference: Any = None, room: bool = True, **options: Any
) -> tuple[iiwa_dnn.FrankaPlant, iiwa_dnn.Simulation]:
    """Make a run from where the arm stands."""
    plant = iiwa_dnn.FrankaPlant(HOST)
    robot = plant.with_room(ROBOT) if room else ROBOT.with_limits(acceleration=50.0)
    start = iiwa_dnn.Configuration(robot, plant.posture)
    path = iiwa_dnn.Heart() if reference is None else reference
    extra = options.pop("limits", ())
    scheme = iiwa_dnn.DoubleIndicator(tracking="next", next_gain=100.0, extra_limits=LIMITS)
    scheme = iiwa_dnn.Scheme(scheme.costs, scheme.tasks, [*scheme.limits, *extra])
    arguments = {"dt": 1e-3, "duration": 0.7, "check": iiwa_dnn.CrossCheck(()), **options}
    anchored = path.anchored(start) if not isinstance(path, iiwa_dnn.MovingTarget) else path
    return plant, iiwa_dnn.Simulation(robot, scheme, anchored, start.q, plant=plant, **arguments)


class Jumps(iiwa_dnn.Reference):
    """A position that jumps by 0.3 m every 0.2 s, out of reach in the end."""

    name = "jumps"
    period = np.inf
    duration = np.inf

    def __init__(self, height: float) -> None:
        self.height = height

    def motion(self, t: float) -> Any:
        from iiwa_dnn.references.base import Motion

        side = 0.3 if int(t / 0.2) % 2 else -0.2
        return Motion(np.array([0.0, side, self.height]), np.zeros(3))


def spiral(folder: Path) -> iiwa_dnn.Waypoints:
    """Write a path as a CSV file and read it."""
    t = np.linspace(0.0, 2.0, 41)
    rows = np.stack([t, 0.02 * t * np.cos(3.0 * t), 0.02 * t * np.sin(3.0 * t), 0.01 * t], axis=1)
    file = folder / "spiral.csv"
    np.savetxt(file, rows, delimiter=",", header="t,x,y,z", comments="")
    return iiwa_dnn.Waypoints.from_csv(file)


PATHS = {
    "heart": lambda folder: iiwa_dnn.Heart(period=5.0),
    "turning tool": lambda folder: iiwa_dnn.Tilting(iiwa_dnn.Circle(0.03, 4.0), 0.1),
    "own CSV": spiral,
    "jumps": lambda folder: Jumps(0.0),
    "out of reach": lambda folder: Jumps(5.0),
}


@pytest.mark.parametrize("name", PATHS)
def test_no_path_ends_in_a_reflex(server: Any, name: str, tmp_path: Path) -> None:
    _, run = prepared(PATHS[name](tmp_path))
    record = run.run()
    assert record.settings["status"] == "completed"  # the server judges limits, with its rounding
    if name in ("heart", "turning tool", "own CSV"):
        assert record.action is None or not record.action[20:].any()


def test_an_obstacle_in_the_way_is_not_touched(server: Any) -> None:
    start = iiwa_dnn.Configuration(ROBOT, iiwa_dnn.FrankaPlant(HOST).posture)
    ball = iiwa_dnn.Sphere(start.position + [0.0, 0.25, 0.0], 0.08)
    avoidance = iiwa_dnn.CollisionAvoidance([ball], distance=0.03)
    line = iiwa_dnn.Line((0.0, 0.25, 0.0), period=3.0)
    _, run = prepared(line, limits=[avoidance], duration=2.0)
    record = run.run()
    assert record.settings["status"] == "completed"
    assert record.distance is not None
    assert 0.02 < record.distance.min() < 0.06  # it came near, by the encoders


def test_a_hand_that_jumps(server: Any) -> None:
    start = iiwa_dnn.Configuration(ROBOT, iiwa_dnn.FrankaPlant(HOST).posture)
    hand = iiwa_dnn.MovingTarget(start, speed=0.4, rate=1.0)
    _, run = prepared(hand, duration=2.0)
    rng = np.random.default_rng(1)
    for k in range(8):
        goal = start.position + rng.uniform(-0.15, 0.15, 3)
        threading.Timer(0.2 * k + 1.0, hand.set, [goal]).start()
    record = run.run()
    assert record.settings["status"] == "completed"
    assert np.ptp(record.position, axis=0).max() > 0.05


def test_the_arm_takes_the_next_client_after_one_was_killed(server: Any) -> None:
    program = [
        "import iiwa_dnn, numpy as np",
        f"plant = iiwa_dnn.FrankaPlant({HOST!r})",
        "robot = iiwa_dnn.load_robot('fr3')",
        "plant.start(robot, plant.posture, 1e-3, 0)",
        "for k in range(100_000):",
        "    plant.read()",
        "    plant.move(np.full(7, min(1e-5 * k, 0.01)))",
        "    print(plant.fault, flush=True)",
    ]
    command = [sys.executable, "-c", "\n".join(program)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as client:
        assert client.stdout is not None
        lines = [client.stdout.readline() for _ in range(200)]
        client.kill()
    assert lines[-1] == "None\n"
    time.sleep(2.0)
    _, run = prepared(duration=0.3)
    assert run.run().settings["status"] == "completed"


def test_ctrl_c_brakes_and_the_record_is_there(server: Any) -> None:
    _, run = prepared(Jumps(0.0), duration=5.0)
    threading.Timer(0.5, signal.raise_signal, [signal.SIGINT]).start()
    record = run.run()
    assert run.interrupt == signal.SIGINT
    assert record.settings["status"].endswith("s): interrupted")
    assert np.abs(record.dq_solver[-1]).max() == 0.0
    assert np.abs(record.dq_solver).max() > 0.1  # it was in motion


def test_a_reflex_is_the_reports_first_line(server: Any) -> None:
    import pylibfranka

    _, run = prepared(Jumps(0.0), room=False)
    record = run.run()
    assert "acceleration_discontinuity" in record.settings["status"]
    assert any("acceleration_discontinuity" in line for line in failures(record)[:2])
    time.sleep(1.5)
    pylibfranka.Robot(HOST, pylibfranka.RealtimeConfig.kIgnore).automatic_error_recovery()
    time.sleep(1.5)


def test_a_silent_server_ends_the_run(server: Any) -> None:
    _, run = prepared(duration=5.0)
    threading.Timer(1.0, server.send_signal, [signal.SIGSTOP]).start()
    began = time.monotonic()
    record = run.run()
    server.send_signal(signal.SIGCONT)
    assert time.monotonic() - began < 15.0
    assert record.settings["status"].startswith("stopped at step")
    assert "\n" not in record.settings["status"]
    assert record.steps > 10
    time.sleep(3.0)


def test_a_killed_server_ends_the_run_and_a_missing_one_is_named(server: Any) -> None:
    _, run = prepared(duration=5.0)
    threading.Timer(0.5, server.kill).start()
    record = run.run()
    assert record.settings["status"].startswith("stopped at step")
    assert "\n" not in record.settings["status"]
    assert record.steps > 10
    plant = iiwa_dnn.FrankaPlant(HOST)
    with pytest.raises(InvalidInputError, match=f"host: {HOST}: .*onnection"):
        _ = plant.posture
