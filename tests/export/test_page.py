"""The page of the documentation on which the exported heart runs in a browser."""

import runpy
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_browser import needs_browser, open_browser, requested
from iiwa_dnn import Configuration
from iiwa_dnn.export.folder import run

FOLDER = Path(__file__).parents[2] / "docs" / "browser"


@pytest.fixture
def browser(tmp_path: Path) -> Iterator[Any]:
    with open_browser(tmp_path) as browser:
        browser.get((FOLDER.parent / "heart.html").as_uri() + "#still")
        yield browser


@needs_browser
def test_the_page_gives_the_commands_of_python_and_a_hand_leads_it(browser: Any) -> None:
    controller, q = runpy.run_path(str(FOLDER / "make_page.py"))["heart_controller"]()
    q = run(controller, q, 1001)[-1, 1:8]
    joints, tip = browser.execute_script("run(1000); return [Array.from(q), skeleton(q).pop()]")
    np.testing.assert_allclose(joints, q, rtol=0, atol=1e-12)
    np.testing.assert_allclose(tip, Configuration(controller.robot, q).position, atol=1e-12)
    # Led 20 cm to the right, the arm follows as quickly as its limits allow.
    browser.execute_script(
        "draw(); const box = stage.getBoundingClientRect(), at = shown(target);"
        "lead({buttons: 1, clientX: box.left + (at[0] + 0.2 * scale()) / devicePixelRatio,"
        "      clientY: box.top + at[1] / devicePixelRatio});"
    )
    goal = np.array(browser.execute_script("return Array.from(target.slice(0, 3))"))
    assert np.linalg.norm(goal - tip) == pytest.approx(0.2, abs=2e-3)
    fastest = browser.execute_script(
        "let most = 0; for (let k = 0; k < 2000; k++) { run(1);"
        "dq.forEach((v, i) => { most = Math.max(most, Math.abs(v) / MODEL.limits[i]); }); }"
        "return most"
    )
    assert fastest == pytest.approx(1.0, abs=1e-9)
    led = np.array(browser.execute_script("draw(); return skeleton(q).pop()"))
    np.testing.assert_allclose(led, goal, atol=1e-6)
    assert not [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]
    assert not [address for address in requested(browser) if address.startswith(("http", "ws"))]
