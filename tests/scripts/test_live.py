"""The live page: the arm follows a dragged target, and gives way to a dragged ball."""

import re
import runpy
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import iiwa_dnn

pytest.importorskip("viser", reason="pip install 'iiwa-dnn[view]'")

SCRIPT = Path(__file__).parents[2] / "scripts" / "live.py"


@pytest.fixture(scope="module")
def script() -> dict[str, Any]:
    return runpy.run_path(str(SCRIPT))


@pytest.fixture
def page(script: dict[str, Any]) -> Iterator[Any]:
    page = script["Live"](iiwa_dnn.load_robot("iiwa7"), port=0)
    yield page
    page.server.stop()


def tip(page: Any, frame: str = "iiwa7_flange") -> np.ndarray:
    return iiwa_dnn.Configuration(page.robot, page.q).frame(frame).position


def test_the_arm_follows_a_dragged_target_at_a_limited_speed(page: Any) -> None:
    start = tip(page)
    page.tick()
    goal = start + [0.0, 0.1, -0.05]
    page.target.position = tuple(goal)
    for _ in range(5):  # 0.2 s
        page.tick()
    assert 0.02 < np.linalg.norm(tip(page) - start) < 1.1 * 0.2 * 0.25
    page.sliders["weight"].value = 0.7
    for _ in range(45):
        page.tick()
    assert np.linalg.norm(tip(page) - goal) < 1e-3
    assert page.controller.scheme.weight == 0.7
    gap = re.search(r"gap to ProxQP (\S+) rad/s", page.state.content)
    assert gap is not None
    assert float(gap[1]) < 1e-6
    assert "as wanted" in page.state.content


def test_the_arm_gives_way_to_a_dragged_ball(page: Any) -> None:
    elbow = tip(page, "iiwa7_link_4")
    page.tick()
    page.ball.position = tuple(elbow)
    for _ in range(60):
        page.tick()
        assert np.linalg.norm(tip(page, "iiwa7_link_4") - page.center) > 0.08
    assert np.linalg.norm(tip(page, "iiwa7_link_4") - elbow) > 0.02


def test_the_command_ends_by_itself(
    script: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    script["main"](port=0, seconds=0.2)
    assert re.search(r"open http://127\.0\.0\.1:\d+ in a browser", capsys.readouterr().out)
