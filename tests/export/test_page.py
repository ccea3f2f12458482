"""The pages of the documentation on which an exported controller and shield run in a browser."""

import runpy
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_browser import needs_browser, open_browser, picture, requested
from iiwa_dnn import Configuration
from iiwa_dnn.export.folder import run
from judge_limits import breaches

FOLDER = Path(__file__).parents[2] / "docs" / "browser"


@pytest.fixture
def browser(tmp_path: Path) -> Iterator[Any]:
    with open_browser(tmp_path) as browser:
        browser.get((FOLDER.parent / "heart.html").as_uri() + "#still")
        yield browser


@needs_browser
def test_the_page_gives_the_commands_of_python_and_a_hand_leads_it(browser: Any) -> None:
    controller, q = runpy.run_path(str(FOLDER / "make_page.py"))["heart_controller"]()
    robot = controller.robot
    q = run(controller, q, 1001)[-1, 1:8]
    joints, tip = browser.execute_script("run(1000); return [Array.from(q), skeleton(q).pop()]")
    np.testing.assert_allclose(joints, q, rtol=0, atol=1e-9)
    np.testing.assert_allclose(tip, Configuration(robot, joints).position, atol=1e-12)
    # Led by a hand, the arm follows as quickly as its limits allow, and no quicker.
    drag(browser, "target", 90, 40)
    goal = np.array(browser.execute_script("return Array.from(target.slice(0, 3))"))
    assert 0.1 < np.linalg.norm(goal - tip) < 0.6
    led = browser.execute_script(
        "const path = []; for (let k = 0; k < 3000; k++) { run(1); path.push(Array.from(q)); }"
        "return path"
    )
    kinds = (robot.q_lower, robot.q_upper, robot.dq_max, robot.ddq_max, robot.dddq_max)
    assert not breaches(np.vstack([joints, led]), controller.dt, *kinds, at_rest=False)
    assert np.abs(np.diff(led, 2, axis=0) / controller.dt**2 / robot.ddq_max).max() > 0.9
    np.testing.assert_allclose(Configuration(robot, led[-1]).position, goal, atol=1e-4)


@needs_browser
def test_a_ball_that_is_dragged_against_the_arm_drives_it_off(browser: Any) -> None:
    begun = browser.execute_script("run(10); draw(); return clearance(frames(q))")
    where = browser.execute_script(
        "const at = shown(Array.from(ball)), elbow = shown(skeleton(q)[4]);"
        "return elbow.map((x, i) => (x - at[i]) / devicePixelRatio)"
    )
    drag(browser, "ball", 0.8 * where[0], 0.8 * where[1])
    moved = browser.execute_script("return [clearance(frames(q)), Array.from(ball)]")
    assert moved[0] < begun
    before = picture(browser)
    browser.execute_script("run(3000); draw()")
    assert browser.execute_script("return clearance(frames(q))") > min(moved[0], 0.019)
    after = picture(browser)
    assert (np.abs(before.astype(int) - after).max(axis=-1) > 40).sum() > 500, "the arm has moved"
    blue = (after[..., 2] > 150) & (after[..., 0] < 100)
    assert blue.sum() > 200, "the ball is to be seen"
    orange = (after[..., 0] > 180) & (after[..., 1] > 60) & (after[..., 2] < 60)
    assert orange.sum() > 100, "and the arm"
    assert not [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]
    assert not [address for address in requested(browser) if address.startswith(("http", "ws"))]


@needs_browser
def test_the_shield_keeps_its_limits_whatever_a_hand_pulls_at(browser: Any) -> None:
    browser.get((FOLDER.parent / "shield-live.html").as_uri() + "#still")
    shield, _ = runpy.run_path(str(FOLDER / "make_page.py"))["pulled_shield"]()
    robot = shield.robot
    script = """
        const path = [Array.from(q)], near = []; let kept = 0;
        for (let k = 0; k < arguments[0]; k++) {
          run(1);
          path.push(Array.from(q));
          near.push(clearance(frames(q)));
          kept += action;
        }
        draw();
        return [path, Math.min(...near), kept, limits(), wasm.stopping_time()];"""
    roamed = browser.execute_script(script, 3000)
    before = picture(browser)
    drag(browser, "target", 300, 150)
    pulled = browser.execute_script(script, 3000)
    path = np.vstack([roamed[0], pulled[0][1:]])
    kinds = (robot.q_lower, robot.q_upper, robot.dq_max, robot.ddq_max, robot.dddq_max)
    assert not breaches(path, shield.dt, *kinds, at_rest=True)
    assert min(roamed[1], pulled[1]) > 0.0199, "the ball stands still"
    assert roamed[2] > 100, "the handle asks for more than the arm can do"
    assert pulled[2] > 100
    # Python's shield at the same posture, asked for the same, says the same.
    q, twist, said = browser.execute_script(
        "wasm.begin(); before = new Float64Array(n); pull(); const at = Array.from(q);"
        "const asked = Array.from(twist); run(1); return [at, asked, limits()]"
    )
    command = shield.step(q, twist=twist)
    np.testing.assert_allclose(
        command.dq, browser.execute_script("return Array.from(dq)"), atol=1e-9
    )
    assert said.startswith(", ".join(command.active_limits[:3]))
    assert said
    after = picture(browser)
    assert (np.abs(before.astype(int) - after).max(axis=-1) > 40).sum() > 500, "the arm has moved"
    assert not [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]


def drag(browser: Any, name: str, right: float, down: float) -> None:
    """Take the target or the ball with the pointer and move it by so many pixels."""
    from selenium.webdriver.common.action_chains import ActionChains

    at = browser.execute_script(
        "draw(); const box = stage.getBoundingClientRect();"
        f"const at = shown(Array.from({name}.slice(0, 3)));"
        "return [box.left + at[0] / devicePixelRatio, box.top + at[1] / devicePixelRatio]"
    )
    hand = ActionChains(browser)
    hand.w3c_actions.pointer_action.move_to_location(*map(int, at))
    hand.click_and_hold().move_by_offset(int(right / 2), int(down / 2))
    hand.move_by_offset(int(right / 2), int(down / 2)).release().perform()
