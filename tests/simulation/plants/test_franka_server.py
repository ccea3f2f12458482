"""A Franka arm as a plant against franka-sim, an independent server of libfranka's protocol.

The server runs in an environment of its own, build/franka-sim, since it pins an older numpy. It
aborts a motion that breaks a limit or loses 20 commands in a row, as the robot does. Its clock
waits for the client (franka_lockstep.py), and commands are lost at random. libfranka can wait
without an end, with Python stopped: so a thread in C ends a test that takes too long, and the
server dies with its parent.
"""

import ctypes
import faulthandler
import fcntl
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import iiwa_dnn
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.references.base import Motion
from iiwa_dnn.results.failures import failures
from iiwa_dnn.simulation.plants import franka

pytestmark = pytest.mark.filterwarnings("ignore:the reference begins")

FOLDER = Path(__file__).resolve().parents[3] / "build" / "franka-sim"
PYTHON = FOLDER / "bin" / "python"
SERVER = Path(__file__).resolve().parents[2] / "franka_lockstep.py"
ENFORCE = ("--enforce-motion-limits", "--enforce-comm-constraints")
LOSSES = ("--lose=0.01", "--in-a-row=5")  # as many as the plant has room for
PACKAGES = (
    *("franka-sim==1.1.7", "mujoco==3.2.7", "numpy==1.26.4"),
    *("absl-py", "etils", "glfw", "pyopengl"),  # MuJoCo's own
)
HOST = "127.0.0.1"
TIME_LIMIT = 60.0  # of one test [s]
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
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", FOLDER], check=True)
    pip = [sys.executable, "-m", "pip", "--python", PYTHON, "--disable-pip-version-check"]
    install = [*pip, "install", "-q", "--no-deps", "--no-compile", *PACKAGES]
    subprocess.run(install, check=True, capture_output=True)
    urdf = ROBOT.path
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
            while not answers():
                assert process.poll() is None, (FOLDER / "server.log").read_text()
                assert time.monotonic() < deadline
                time.sleep(0.2)
            yield process
        finally:
            process.kill()
            process.wait()
            print((FOLDER / "server.log").read_text()[-4000:])


def answers() -> bool:
    """Test whether the server answers."""
    try:
        return iiwa_dnn.FrankaPlant(HOST).posture.size == 7
    except InvalidInputError:
        return False


@pytest.fixture(autouse=True)
def time_limit(capfd: pytest.CaptureFixture[str]) -> Iterator[None]:
    """End this process, with tracebacks, if a test takes too long."""
    with capfd.disabled():
        stderr = os.dup(2)
    faulthandler.dump_traceback_later(TIME_LIMIT, exit=True, file=stderr)
    yield
    faulthandler.cancel_dump_traceback_later()
    os.close(stderr)


Prepare = Callable[..., iiwa_dnn.Simulation]


@pytest.fixture
def prepare() -> Iterator[Prepare]:
    """Make runs from where the arm stands; a failed test does not stay connected."""
    plants = []

    def prepared(
        reference: Any = None, room: bool = True, limits: Any = (), **options: Any
    ) -> iiwa_dnn.Simulation:
        plant = iiwa_dnn.FrankaPlant(HOST)
        plants.append(plant)
        robot = plant.with_room(ROBOT) if room else ROBOT.with_limits(acceleration=50.0)
        start = iiwa_dnn.Configuration(robot, plant.posture)
        path = iiwa_dnn.Heart() if reference is None else reference
        extra = (*LIMITS, *limits)
        scheme = iiwa_dnn.DoubleIndicator(tracking="next", next_gain=100.0, extra_limits=extra)
        arguments = {"dt": 1e-3, "duration": 0.5, "check": iiwa_dnn.CrossCheck(()), **options}
        anchored = path.anchored(start) if not isinstance(path, iiwa_dnn.MovingTarget) else path
        return iiwa_dnn.Simulation(robot, scheme, anchored, start.q, plant=plant, **arguments)

    yield prepared
    for plant in plants:
        plant.stop()


class Jumps(iiwa_dnn.Reference):
    """A position that jumps by 0.5 m every 0.2 s, at a height [m]; it acts at its 250th call."""

    name = "jumps"
    period = np.inf
    duration = np.inf

    def __init__(self, height: float, act: Callable[[], object] | None = None) -> None:
        self.height = height
        self.act = act
        self.calls = 0

    def motion(self, t: float) -> Any:
        self.calls += 1
        if self.act is not None and self.calls == 250:  # more than a rehearsal has
            self.act()
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


def completed(run: iiwa_dnn.Simulation) -> iiwa_dnn.Record:
    """Run to the end."""
    record = run.run()
    assert record.settings["status"] == "completed"
    return record


def off_path(record: iiwa_dnn.Record) -> float:
    """Largest distance of the measured tip from the path, after the start [m]."""
    distance = np.linalg.norm(record.position - record.position_desired, axis=1)
    return float(distance[100:].max())


@pytest.mark.parametrize("name", PATHS)
def test_no_path_ends_in_a_reflex(server: Any, prepare: Prepare, name: str, tmp_path: Path) -> None:
    record = completed(prepare(PATHS[name](tmp_path)))
    if name in ("heart", "turning tool", "own CSV"):
        assert off_path(record) < 5e-3


def test_an_obstacle_in_the_way_is_not_touched(server: Any, prepare: Prepare) -> None:
    start = iiwa_dnn.Configuration(ROBOT, iiwa_dnn.FrankaPlant(HOST).posture)
    ball = iiwa_dnn.Sphere(start.position + [0.0, 0.25, 0.0], 0.08)
    avoidance = iiwa_dnn.CollisionAvoidance([ball], distance=0.03)
    line = iiwa_dnn.Line((0.0, 0.25, 0.0), period=3.0)
    record = completed(prepare(line, limits=[avoidance], duration=1.2))
    assert record.distance is not None
    assert 0.02 < record.distance.min() < 0.06  # it came near, by the encoders


def test_a_hand_that_jumps(server: Any, prepare: Prepare) -> None:
    rng = np.random.default_rng(1)

    start = iiwa_dnn.Configuration(ROBOT, iiwa_dnn.FrankaPlant(HOST).posture)
    hand = iiwa_dnn.MovingTarget(start, speed=0.4, rate=1.0)
    for k in range(3):
        shift = rng.uniform(-0.15, 0.15, 3)
        threading.Timer(0.3 * k + 0.3, hand.set, [start.position + shift]).start()
    record = completed(prepare(hand, duration=1.4))
    assert np.ptp(record.position, axis=0).max() > 0.02


def test_the_arm_takes_the_next_client_after_one_was_killed(server: Any, prepare: Prepare) -> None:
    fork = multiprocessing.get_context("fork")
    moving = fork.Event()

    def drive() -> None:
        plant = iiwa_dnn.FrankaPlant(HOST)
        plant.start(ROBOT, plant.posture, 1e-3, 0)
        for k in range(100_000):
            plant.read()
            plant.move(np.full(7, min(1e-5 * k, 0.01)))
            assert plant.fault is None
            if k == 200:
                moving.set()

    client = fork.Process(target=drive, daemon=True)
    client.start()
    assert moving.wait(20.0)
    client.kill()
    client.join()
    completed(prepare(duration=0.3))


def test_ctrl_c_brakes_and_the_record_is_there(server: Any, prepare: Prepare) -> None:
    run = prepare(Jumps(0.0, lambda: signal.raise_signal(signal.SIGINT)), duration=5.0)
    record = run.run()
    assert run.interrupt == signal.SIGINT
    assert record.settings["status"].endswith("s): interrupted")
    assert np.abs(record.dq_solver[-1]).max() == 0.0
    assert np.abs(record.dq_solver).max() > 0.1  # it was in motion


@pytest.mark.filterwarnings("ignore:a gain of 100")  # stable with the robot's own limits alone
def test_a_reflex_is_the_reports_first_line(server: Any, prepare: Prepare) -> None:
    import pylibfranka

    record = prepare(Jumps(0.0), room=False).run()
    assert "acceleration_discontinuity" in record.settings["status"]
    assert any("acceleration_discontinuity" in line for line in failures(record)[:2])
    pylibfranka.Robot(HOST, pylibfranka.RealtimeConfig.kIgnore).automatic_error_recovery()


def test_a_second_program_is_told(
    server: Any, prepare: Prepare, monkeypatch: pytest.MonkeyPatch
) -> None:
    prepare()
    monkeypatch.setattr(franka, "PATIENCE", 1.0)
    with pytest.raises(InvalidInputError, match=f"host: {HOST}: no answer .* program may be conn"):
        _ = iiwa_dnn.FrankaPlant(HOST).posture


@pytest.mark.parametrize("moves", [False, True])
def test_a_server_that_freezes_ends_the_run(server: Any, prepare: Prepare, moves: bool) -> None:
    run = prepare(Jumps(0.0, lambda: server.send_signal(signal.SIGSTOP)), duration=5.0)
    if not moves:
        server.send_signal(signal.SIGSTOP)
    began = time.monotonic()
    record = run.run()
    server.send_signal(signal.SIGCONT)
    assert time.monotonic() - began < 15.0
    assert record.settings["status"].startswith("stopped at step")
    assert record.settings["status"].endswith("s): UDP receive: Timeout")
    assert (record.steps > 100) == moves


def test_a_killed_server_ends_the_run_and_a_missing_one_is_named(
    server: Any, prepare: Prepare
) -> None:
    record = prepare(Jumps(0.0, server.kill), duration=5.0).run()
    assert record.settings["status"].startswith("stopped at step")
    assert "\n" not in record.settings["status"]
    assert record.steps > 100
    with pytest.raises(InvalidInputError, match=f"host: {HOST}: Connection refused"):
        _ = iiwa_dnn.FrankaPlant(HOST).posture
