"""The loop of a Franka arm: on a stand-in that judges limits, and on franka-sim.

franka-sim is an independent server of libfranka's protocol, in an environment of its own,
build/franka-sim, since it pins an older numpy. It aborts a motion that breaks a limit or loses 20
commands in a row, as the robot does. Its clock waits for the client (franka_lockstep.py), and
commands are lost at random.
"""

import ctypes
import fcntl
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import iiwa_dnn
from helpers_franka import Arm, module
from scripts import franka

FOLDER = Path(__file__).resolve().parents[2] / "build" / "franka-sim"
PYTHON = FOLDER / "bin" / "python"
SERVER = Path(__file__).resolve().parents[1] / "franka_lockstep.py"
ENFORCE = ("--enforce-motion-limits", "--enforce-comm-constraints")
LOSSES = ("--lose=0.01", "--in-a-row=5")  # as many as there is room for
PACKAGES = (
    *("franka-sim==1.1.7", "mujoco==3.2.7", "numpy==1.26.4"),
    *("absl-py", "etils", "glfw", "pyopengl"),  # MuJoCo's own
)
HOST = "127.0.0.1"

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
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", FOLDER], check=True)
    pip = [sys.executable, "-m", "pip", "--python", PYTHON, "--disable-pip-version-check"]
    install = [*pip, "install", "-q", "--no-deps", "--no-compile", *PACKAGES]
    subprocess.run(install, check=True, capture_output=True)
    urdf = iiwa_dnn.load_robot("fr3").path
    subprocess.run([PYTHON, "-c", MODEL, str(urdf), FOLDER / "fr3.xml"], check=True)
    done.touch()


def die_with_parent() -> None:
    """Let the server be killed where its parent was."""
    ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG


@pytest.fixture(scope="module")
def server() -> Iterator[subprocess.Popen[bytes]]:
    """Start a server that judges limits and the connection, and kill it in the end."""
    pytest.importorskip("pylibfranka")
    FOLDER.mkdir(parents=True, exist_ok=True)
    with (FOLDER / "server.log").open("wb") as log:
        fcntl.flock(log, fcntl.LOCK_EX)  # the port is one, and the tests' processes are several
        try:
            make_environment()
        except (OSError, subprocess.CalledProcessError) as error:
            pytest.skip(f"franka-sim cannot be installed here: {error}")
        process = subprocess.Popen(
            [PYTHON, SERVER, "--no-gripper", *ENFORCE, *LOSSES],
            env={**os.environ, "FR3_MJCF": str(FOLDER / "fr3.xml")},
            stdout=log,
            stderr=log,
            start_new_session=True,
            preexec_fn=die_with_parent,
        )
        try:
            deadline = time.monotonic() + 60.0
            while not is_open():
                assert process.poll() is None, (FOLDER / "server.log").read_text()
                assert time.monotonic() < deadline
                time.sleep(0.2)
            yield process
        finally:
            process.kill()
            process.wait()
            print((FOLDER / "server.log").read_text()[-4000:])


def is_open() -> bool:
    """Test whether the server listens."""
    with socket.socket() as link:
        return link.connect_ex((HOST, 1337)) == 0


@pytest.fixture
def arm(monkeypatch: pytest.MonkeyPatch) -> Iterator[Arm]:
    """Put a stand-in of the robot in the place of pylibfranka, and keep the handler of Ctrl-C."""
    made = Arm(iiwa_dnn.load_robot("fr3").start_posture())
    monkeypatch.setitem(sys.modules, "pylibfranka", module(made))
    handler = signal.getsignal(signal.SIGINT)
    yield made
    signal.signal(signal.SIGINT, handler)


def test_lost_commands_break_no_limit(arm: Arm, capsys: pytest.CaptureFixture[str]) -> None:
    rng = np.random.default_rng(5)
    cycles = rng.choice(np.arange(1, 900), 40, replace=False)
    arm.lost = {int(k): int(rng.integers(1, 6)) for k in cycles}
    start = arm.q.copy()
    franka.main(HOST, 1.0, 0.1, 0.5)  # as quick as the limits let it
    assert arm.broken == []
    assert arm.finished
    assert not arm.dq.any()
    assert np.abs(arm.q - start).max() > 0.1
    late = int(capsys.readouterr().out.split()[2])
    assert late >= 30  # an arm that goes on as it was told has not lost anything


def test_without_room_lost_commands_break_limits(arm: Arm, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(franka, "with_room", lambda robot: robot)
    arm.lost = dict.fromkeys(range(20, 900, 20), 5)
    franka.main(HOST, 1.0, 0.1, 0.5)
    assert arm.broken


def test_the_circle_is_drawn(arm: Arm) -> None:
    start = arm.q.copy()
    robot = iiwa_dnn.load_robot("fr3")
    franka.main(HOST, 2.0, 0.02, 4.0)  # half a round
    conf = [iiwa_dnn.Configuration(robot, q) for q in (start, arm.q)]
    assert np.linalg.norm(conf[1].position - conf[0].position) == pytest.approx(0.04, abs=2e-3)


def test_ctrl_c_brings_the_arm_to_rest(arm: Arm, monkeypatch: pytest.MonkeyPatch) -> None:
    write = arm.writeOnce

    def interrupted(command) -> None:
        write(command)
        if arm.count == 300:
            signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(arm, "writeOnce", interrupted)
    franka.main(HOST, 60.0, 0.1, 2.0)
    assert 300 < arm.count < 2000
    assert arm.finished
    assert arm.broken == []


@pytest.mark.parametrize("size", [(0.02, 5.0), (0.1, 0.5)], ids=["slow", "too quick"])
def test_franka_sim_accepts_the_motion(
    server: subprocess.Popen[bytes], size: tuple[float, float]
) -> None:
    words = ["--duration", "1", "--radius", str(size[0]), "--period", str(size[1])]
    done = subprocess.run(
        [sys.executable, franka.__file__, HOST, *words], capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    assert "commands came too late" in done.stdout
    assert server.poll() is None
