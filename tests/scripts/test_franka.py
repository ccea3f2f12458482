"""The loop of a Franka arm on franka-sim, an independent server of libfranka's protocol.

It has an environment of its own, build/franka-sim, since it pins an older numpy. It aborts a motion
that breaks a limit or loses 20 commands in a row, as the robot does. Its clock waits for the client
(franka_lockstep.py), and commands are lost at random.
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
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import iiwa_dnn
from helpers_export import use_armstep
from helpers_physics import ROOT, run_python
from judge_distances import Judge
from scripts import franka

FOLDER = ROOT / "build" / "franka-sim"
PYTHON = FOLDER / "bin" / "python"
SERVER = (PYTHON, ROOT / "tests" / "franka_lockstep.py", "--no-gripper")
CHECKS = ("--enforce-motion-limits", "--enforce-comm-constraints")
PACKAGES = ("franka-sim==1.1.7", "mujoco==3.2.7", "numpy==1.26.4")
MUJOCOS_OWN = ("absl-py", "etils", "glfw", "pyopengl")

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
    if (FOLDER / "fr3.xml").exists():
        return
    run = partial(subprocess.run, check=True)
    run([sys.executable, "-m", "venv", "--without-pip", FOLDER])
    pip = [sys.executable, "-m", "pip", "--python", PYTHON, "--disable-pip-version-check"]
    run([*pip, "install", "-q", "--no-deps", *PACKAGES, *MUJOCOS_OWN])
    run([PYTHON, "-c", MODEL, str(iiwa_dnn.load_robot("fr3").path), FOLDER / "fr3.xml"])


@pytest.fixture
def server() -> Iterator[subprocess.Popen[bytes]]:
    """Start a server that judges limits and the connection, and kill it in the end.

    One a test: the arm stands where the test before has left it, and other commands are lost.
    """
    pytest.importorskip("pylibfranka")
    FOLDER.mkdir(parents=True, exist_ok=True)
    with (FOLDER / "server.log").open("wb") as log:
        fcntl.flock(log, fcntl.LOCK_EX)  # the port is one, and the tests' processes are several
        try:
            make_environment()
        except (OSError, subprocess.CalledProcessError) as error:
            pytest.skip(f"franka-sim cannot be installed here: {error}")
        options = {"env": {**os.environ, "FR3_MJCF": str(FOLDER / "fr3.xml")}, "stdout": log}
        # Killed where its parent was: PR_SET_PDEATHSIG.
        die = partial(ctypes.CDLL(None).prctl, 1, signal.SIGKILL)
        process = subprocess.Popen([*SERVER, *CHECKS], stderr=log, preexec_fn=die, **options)
        try:
            with socket.socket() as link:
                while link.connect_ex(("127.0.0.1", 1337)):
                    assert process.poll() is None, (FOLDER / "server.log").read_text()
                    time.sleep(0.2)
            yield process
        finally:
            process.kill()
            process.wait()
            print((FOLDER / "server.log").read_text()[-4000:])


@pytest.mark.parametrize(
    ("duration", "radius", "period", "before", "fault"),
    [
        (1.0, 0.02, 5.0, "", ""),
        (1.0, 0.1, 0.5, "", ""),  # as quick as the limits let it
        (60.0, 0.1, 2.0, "gc.disable = Timer(1.0, raise_signal, [SIGINT]).start", ""),  # Ctrl-C
        (9.0, 0.1, 0.5, "franka.with_reserve = lambda robot: robot", "discontinuity"),
    ],
    ids=["slow", "too quick", "interrupted", "without reserve"],
)
def test_the_motion_is_accepted_with_reserve_for_lost_commands(
    server, duration: float, radius: float, period: float, before: str, fault: str
) -> None:
    code = (
        "import gc; from signal import *; from threading import Timer\n"
        f"from scripts import franka\n{before}\n"
        f"franka.main('127.0.0.1', {duration}, {radius}, {period})"
    )
    done = run_python(code)
    assert server.poll() is None
    if fault:
        assert fault in done.stderr
    else:
        assert done.returncode == 0, done.stderr
        seconds, _, late, *_ = done.stdout.split()
        assert int(late) > 0
        assert duration <= float(seconds) or 0.2 < float(seconds) < 20.0


RECORDING = """
import sys
sys.path.insert(0, "tests")
import numpy as np
from armstep import Shield
from franka_requests import Sender
step, log, sender = Shield.step, [], Sender(PORT)
def recorded(shield, q, **request):
    sender.cycle(len(log))
    begin = time.perf_counter()
    command = step(shield, q, **request)
    log.append((*q, time.perf_counter() - begin, bool(request), *command.dq, *command.next_q))
    return command
Shield.step = recorded
"""


def test_a_port_alone_is_one_of_this_machine_and_a_refusal_is_said_at_once(capfd) -> None:
    source = franka.Requests("0")
    place = source._socket.getsockname()
    assert place[0] == "127.0.0.1"
    for _ in range(2):
        source._socket.sendto(b'{"dq": [1]}', place)
        assert np.isnan(source.newest()["dq"]).all()
    assert capfd.readouterr().err.count("refused") == 1
    assert source.refused == 2


def test_hostile_requests_of_a_slow_policy_abort_no_motion(server, tmp_path: Path) -> None:
    tables = iiwa_dnn.export.tables(franka.make_shield(), tmp_path / "fr3_shield.json")
    package = Path(use_armstep().__file__).parents[1]
    seconds = float(os.environ.get("SECONDS_OF_HOSTILE_REQUESTS", "5"))
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        link.bind(("127.0.0.1", 0))
        port = link.getsockname()[1]
    file = tmp_path / "log.npy"
    code = (
        f"import atexit, time\nPORT = {port}\n{RECORDING}\n"
        f"atexit.register(lambda: np.save({str(file)!r}, log))\n"
        "from scripts import franka\n"
        f"franka.main('127.0.0.1', {seconds}, requests='{port}',"
        f" shield={str(tables)!r})"
    )
    done = run_python(code, timeout=300.0 + 5.0 * seconds, PYTHONPATH=str(package))
    assert done.returncode == 0, done.stderr
    assert server.poll() is None
    log = np.load(file)
    times = 1e6 * np.percentile(log[:, 7], [50, 99])
    print(done.stdout, f"a step p50 {times[0]:.0f} us, p99 {times[1]:.0f} us")
    assert int(done.stdout.split()[2]) > 0  # commands that were lost
    assert log[:, 8].any()
    q = log[:, :7]
    robot = iiwa_dnn.load_robot("fr3")
    assert (q >= robot.q_lower).all()
    assert (q <= robot.q_upper).all()
    judge = Judge(robot, iiwa_dnn.CollisionAvoidance([], distance=0.02))
    commanded = log[:-1, 16:][::20]
    least = min(judge.distance(q[0], 0.0), 0.02)  # nearer, if the motion before has left it so
    for wanted, there in zip(commanded, q[1::20], strict=True):
        assert judge.distance(wanted, 0.0) >= least - 1e-4  # commands are lost
        # The arm sags, and follows as it can: by so much it may be nearer.
        sag = 2.0 * robot.reach * np.abs(there - wanted).sum()
        assert judge.distance(there, 0.0) >= least - sag
        assert sag < 0.02
