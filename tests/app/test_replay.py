"""The replay in a real browser: what it shows, and what hands can do to it."""

import os
import re
import signal
import socket
import subprocess
import sys
import threading
import time
import urllib.request
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import numpy as np
import pytest

import iiwa_dnn
from helpers_browser import needs_browser, open_browser, picture, requested, wait_for
from helpers_commands import call
from helpers_physics import ROOT, START, heart_without_physics
from helpers_records import make_record
from helpers_simulation import paper_robot
from iiwa_dnn import IiwaDnnError, InvalidInputError, Record, load_robot
from iiwa_dnn.app.replay import Replay, robot_of

pytest.importorskip("viser", reason="pip install 'iiwa-dnn[view]'")
pytest.importorskip("selenium", reason="pip install 'iiwa-dnn[test]'")

from selenium.webdriver.common.keys import Keys


@pytest.fixture(scope="module")
def slowed() -> Record:
    """A heart, slowed in its middle, beside a ball that falls and a box."""
    robot = paper_robot().with_limits(velocity=0.1 * paper_robot().dq_max)
    obstacles = [
        iiwa_dnn.Sphere([0.5, -0.45, 0.35], 0.05, velocity=[0.0, 0.0, -0.05]),
        iiwa_dnn.HalfSpace([0.0, 0.0, 1.0], -0.2),
        iiwa_dnn.Box([0.8, 0.8, 0.2], [0.1, 0.1, 0.1]),
    ]
    avoidance = iiwa_dnn.CollisionAvoidance(obstacles)
    scheme = iiwa_dnn.DoubleIndicator(extra_limits=(avoidance,))
    heart = iiwa_dnn.Heart(0.005).anchored(iiwa_dnn.Configuration(robot, START))
    return iiwa_dnn.simulate(robot, scheme, heart, START, dt=2e-2)


@pytest.fixture(scope="module")
def replay(slowed: Record) -> Iterator[Replay]:
    """The page, kept moving as the command does it."""
    page = Replay(paper_robot(), slowed, port=0)
    # Slow without a graphics card: at each loading, ten seconds to prepare the reflections alone.
    page.server.scene.configure_default_lights(cast_shadow=False)
    page.server.scene.configure_environment_map(hdri=None)
    stop = threading.Event()

    def run() -> None:
        while not stop.is_set():
            time.sleep(1 / 30)
            page.tick(1 / 30)

    loop = threading.Thread(target=run)
    loop.start()
    yield page
    stop.set()
    loop.join()
    page.server.stop()


def address(page: Replay) -> str:
    return f"http://127.0.0.1:{page.server.get_port()}"


@pytest.fixture(scope="module")
def browser(replay: Replay, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    with open_browser(tmp_path_factory.mktemp("profile")) as browser:
        browser.get_log("performance")  # what the empty start page asked for
        browser.get(address(replay))
        wait_for(lambda: sliders(browser), "the page's controls")
        wait_for(lambda: arm(picture(browser)).sum() > 500, "the arm")
        yield browser


def sliders(browser: Any) -> list[Any]:
    found: list[Any] = browser.execute_script(
        "return [...document.querySelectorAll('[role=slider]')].filter("
        "slider => slider.offsetParent !== null)"
    )
    return found


def press_play(browser: Any) -> None:
    browser.execute_script(
        "[...document.querySelectorAll('input[type=checkbox]')]"
        ".find(box => box.offsetParent !== null).click()"
    )


def arm(image: np.ndarray) -> np.ndarray:
    """Orange pixels, left of the page's controls."""
    image = image[:, :600].astype(int)
    return (image[..., 0] > image[..., 1] + 60) & (image[..., 1] > image[..., 2] + 40)


def red(image: np.ndarray) -> np.ndarray:
    """Pixels of the drawn path; unlike the orange in the shade it has no more green than blue."""
    image = image[:, :600].astype(int)
    return (image[..., 0] > 170) & (image[..., 1] < 60) & (image[..., 2] >= image[..., 1])


@needs_browser
def test_it_loads_from_this_machine_alone_and_tells_the_run(browser: Any, replay: Replay) -> None:
    image = picture(browser)
    assert len(np.unique(image[:, :600].reshape(-1, 3), axis=0)) > 500
    ours = {
        urlsplit(asked).netloc
        for asked in requested(browser)
        if urlsplit(asked).scheme in ("http", "https", "ws", "wss")
    }
    assert ours == {urlsplit(address(replay)).netloc}
    errors = [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]
    assert not [entry for entry in errors if "favicon" not in entry["message"]]
    page = browser.find_element("tag name", "body").text
    for text in ("play", "time [s]", "position error", "KKT residual", "iiwa7_joint_7", "slowed"):
        assert text in page


@needs_browser
def test_the_path_so_far_is_drawn_and_the_values_are_the_samples(browser, replay) -> None:
    replay.clock.value = 6.0
    assert wait_for(lambda: red(picture(browser)).sum() > 50, "a drawn path")
    record = replay.record
    error = np.linalg.norm(record.position[300] - record.position_desired[300])

    def shown() -> bool:
        page = browser.find_element("tag name", "body").text
        joint = f"{record.q[300, 3]:+.3f}"
        return f"{error:.3g} m" in page and joint in page

    assert wait_for(shown, "the values of the sample at 6 s")
    replay.clock.value = 0.0
    assert wait_for(lambda: red(picture(browser)).sum() < 20, "no path at the start")


@needs_browser
def test_hands_move_the_clock_and_play(browser: Any, replay: Replay) -> None:
    replay.clock.value = 1.0
    wait_for(lambda: sliders(browser)[0].send_keys(Keys.END) is None, "a slider")
    assert wait_for(lambda: replay.clock.value == 10.0, "the end")
    replay.speed.value = "5"
    press_play(browser)
    # The replay begins again at the end.
    assert wait_for(lambda: 0.2 < replay.clock.value < 8.0, "the time to pass")
    press_play(browser)
    assert wait_for(lambda: not replay.playing.value, "the pause")


def test_obstacles_stand_where_they_are_and_slowed_stretches_are_marked(slowed: Record) -> None:
    page = Replay(paper_robot(), slowed, port=0)
    try:
        drawn = dict(page.obstacles)
        assert [type(obstacle).__name__ for obstacle in drawn] == ["Sphere", "Box"]
        page.clock.value = 2.0
        page.tick(0.0)
        ball, box = drawn.values()
        np.testing.assert_allclose(ball.position, [0.0, 0.0, -0.1])
        np.testing.assert_allclose(box.position, 0.0)
        sphere = ball.vertices - [0.5, -0.45, 0.35]
        np.testing.assert_allclose(np.linalg.norm(sphere, axis=1), 0.05, 1e-5)
        np.testing.assert_allclose(np.ptp(box.vertices, axis=0), 0.2, 1e-5)
        marks = re.findall("background:(#[0-9a-f]+)", page.marks.content)
        red = np.flatnonzero([color == "#d6001c" for color in marks]) / len(marks)
        acted = np.flatnonzero(slowed.action) / slowed.steps
        assert 0.05 < len(red) / len(marks) < 0.95
        np.testing.assert_allclose(red[[0, -1]], acted[[0, -1]], atol=1.0 / len(marks))
    finally:
        page.server.stop()


def test_the_command_opens_the_page_of_a_folder_until_ctrl_c(tmp_path: Path) -> None:
    heart_without_physics(100).save(tmp_path / "record.npz")
    command = [sys.executable, "-m", "iiwa_dnn", "view", str(tmp_path), "--port", "0"]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as process:
        assert process.stdout is not None
        line = next(line for line in process.stdout if line.startswith("open "))
        opened = re.search(r"http://127\.0\.0\.1:\d+", line)
        assert opened is not None
        with urllib.request.urlopen(opened[0], timeout=10) as answer:
            assert b"<html" in answer.read()
        # Another address of this same machine: nobody listens there.
        with pytest.raises(OSError, match="refused"):
            socket.create_connection(("127.0.0.2", urlsplit(opened[0]).port or 0), timeout=5)
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=60) == -signal.SIGINT  # a shell says 130


def test_the_robot_is_the_one_of_the_settings_or_the_record(tmp_path: Path) -> None:
    joints = [f"iiwa7_joint_{k}" for k in (2, 3, 4, 5, 6, 7)]
    kept = {"robot": "iiwa7", "locked": {"iiwa7_joint_1": 0.0}, "joints": joints}
    record = make_record(dof=6, settings=kept)
    none = tmp_path / "none.toml"
    assert robot_of(record.settings, none).locked == ("iiwa7_joint_1",)
    with pytest.raises(IiwaDnnError):
        robot_of(record.settings, none, "iiwa7_dual")
    with pytest.raises(InvalidInputError, match="panda has other joints than the record"):
        robot_of(
            make_record(settings={"locked": None}).settings, none, "panda"
        )  # it has seven, too
    file = tmp_path / "settings.toml"
    urdf = load_robot("iiwa7").path
    file.write_text(
        f'[robot]\nname = "{urdf}"\nlocked = ["iiwa7_joint_1"]\nq0 = [0, 0, 0, 0, 0, 0]\n'
    )
    moved = replace(record, settings={**record.settings, "robot": "my_arm"})
    assert robot_of(moved.settings, file).locked == ("iiwa7_joint_1",)
    file.write_text('[robot]\nname = "gone.urdf"\nlocked = ["iiwa7_joint_1"]\n')
    assert robot_of(moved.settings, file, "iiwa7").name == "iiwa7"


def test_bad_input_is_one_line_and_2(tmp_path, capsys, monkeypatch) -> None:
    heart_without_physics(100).save(tmp_path / "record.npz")
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        bad = {
            "did you mean: iiwa7": (tmp_path, "--robot", "iiwa8"),
            "cannot listen on no such host:0": (tmp_path, "--host", "no such host", "--port", 0),
            "cannot listen on 127.0.0.1:70000": (tmp_path, "--port", 70_000),
            f"cannot listen on 127.0.0.1:{port}": (tmp_path, "--port", port),
        }
        for said, words in bad.items():
            assert call("view", *words) == 2
            captured = capsys.readouterr()
            assert said in captured.err
            assert captured.err.count("\n") == 1
    monkeypatch.setitem(sys.modules, "viser", None)
    assert call("view", tmp_path) == 2
    assert "pip install 'iiwa-dnn[view]'" in capsys.readouterr().err
