"""The pages of the documentation on which an exported controller and shield run in a browser."""

import runpy
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
import pytest

from helpers_browser import needs_browser, open_browser, picture, requested, wait_for
from iiwa_dnn import Configuration, Robot, Shield
from iiwa_dnn.export.folder import run
from judge_limits import breaches
from judge_people import ROUNDING, apart, judge, place, skeleton_of

FOLDER = Path(__file__).parents[2] / "docs" / "browser"


RECORD = """
    const path = [Array.from(q)], handle = [], hands = [Array.from(hand)], said = {};
    for (let k = 0; k < arguments[0]; k++) {
      STEER;
      run(1);
      path.push(Array.from(q));
      handle.push(Array.from(target.slice(0, 3)));
      hands.push(Array.from(hand));
      if (k % 10 === 0) for (const name of limits(scene.first).split(", ")) said[name] = 1;
    }
    draw();
    return [path, handle, hands, Object.keys(said)];"""
"""Steps of a scene of the shield's page: joint positions, the handle, the hand, what limited."""


@pytest.fixture
def browser(tmp_path: Path) -> Iterator[Any]:
    with open_browser(tmp_path) as browser:
        browser.set_script_timeout(90)
        visit(browser, "heart")
        yield browser


def visit(browser: Any, name: str, scene: str = "") -> None:
    """Open a page and wait until its code is inflated; nothing moves by itself."""
    browser.get((FOLDER.parent / f"{name}.html").as_uri() + f"#still-{scene}")
    browser.refresh()  # another fragment alone is no other page
    wait_for(lambda: browser.execute_script("return typeof draw === 'function'"), "the scripts")


def made() -> tuple[dict[str, Shield], Robot]:
    """Return the shields of the page by their tables, and the arm without a weight."""
    shields, _ = runpy.run_path(str(FOLDER / "make_page.py"))["shields"]()
    return shields, shields["beside_ball"].robot


def limits_of(robot: Robot) -> tuple[Any, ...]:
    """Return what `breaches` takes of a robot."""
    return robot.q_lower, robot.q_upper, robot.dq_max, robot.ddq_max, robot.dddq_max


def record(browser: Any, steps: int, steer: str = "") -> tuple[Any, Any, Any, list[str]]:
    """Take steps of a scene, and what is steered before each."""
    *numbers, said = browser.execute_script(RECORD.replace("STEER", steer), steps)
    path, handle, hands = map(np.array, numbers)
    return path, handle, hands, said


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
    visit(browser, "shield-live")
    shields, robot = made()
    shield = shields["beside_ball"]
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


@needs_browser
def test_an_arm_rests_before_a_hand_touches_it_and_goes_on_when_it_leaves(browser: Any) -> None:
    shields, robot = made()
    shield = shields["beside_person"]
    arm, radius, speed = skeleton_of(robot), 0.06, 1.6

    def nearest_in_motion(path: Any, hands: Any) -> float:
        bodies = np.stack([hands, hands], axis=1)[:, np.newaxis]  # both ends of one capsule
        own = (shield.dt, radius, speed, 0.02, 0.0)
        least = 1e300
        for k, dq in enumerate(np.diff(path, axis=0) / shield.dt):
            found, _ = judge(arm, path[k], dq, bodies[k], bodies[k + 1], own, 1.0)
            least = min(least, found)
        return least

    def nearest(q: Any, hand: Any) -> float:
        links = np.empty(arm.ends.shape)
        place(arm, q, links)
        there = np.array([hand, hand])
        return float(
            min(
                apart(each, there)[0] - own - radius
                for each, own in zip(links, arm.radii, strict=True)
            )
        )

    # As the pointer moves it, it goes no quicker than is promised.
    visit(browser, "shield-live", "person")
    record(browser, 500)
    begun = np.array(browser.execute_script("return Array.from(hand)"))
    drag(browser, "hand", -250, 120)
    goal = np.array(browser.execute_script("return person.goal"))
    assert np.linalg.norm(goal - begun) > 0.2
    path, _, hands, _ = record(browser, 50)
    ways = np.linalg.norm(np.diff(hands, axis=0), axis=1) / shield.dt
    np.testing.assert_allclose(ways, speed, rtol=1e-9)
    np.testing.assert_allclose(record(browser, 2000)[2][-1], goal, atol=1e-12)
    # It pursues the wrist, stays, and leaves.
    visit(browser, "shield-live", "person")
    near, _, touching, said = record(
        browser, 3000, "person.free = false; person.goal = skeleton(q)[6]"
    )
    away, _, leaving, _ = record(browser, 2500, "person.goal = [-0.7, 0.3, 0.95]")
    path, hands = np.vstack([near, away[1:]]), np.vstack([touching, leaving[1:]])
    assert not breaches(path, shield.dt, *limits_of(robot), at_rest=True)
    assert np.linalg.norm(np.diff(hands, axis=0), axis=1).max() <= speed * shield.dt * (1 + 1e-9)
    assert nearest_in_motion(path, hands) >= 0.02 - ROUNDING
    assert nearest(near[-1], touching[-1]) < 0.0, "the hand has come"
    assert np.ptp(near[:200], axis=0).max() > 0.05, "the arm was in motion"
    assert not np.diff(near[-500:], axis=0).any(), "and rests"
    assert np.abs(np.diff(away, axis=0)).sum(axis=0).max() > 0.5, "and goes on"
    assert any(f"separation of iiwa7_link_{i} from person 1" in said for i in range(3, 8))
    # A hand three times as quick is touched in motion: the judge can say no.
    visit(browser, "shield-live", "person")
    path, _, hands, _ = record(
        browser, 1500, "HAND.speed = 4.8; person.free = false; person.goal = skeleton(q)[6]"
    )
    assert nearest_in_motion(path, hands) < 0.02


@needs_browser
def test_with_a_weight_no_torque_exceeds_its_limit(browser: Any) -> None:
    shields, robot = made()
    dt = shields["beside_ball"].dt
    effort = robot.model.effortLimit

    def demand(path: Any, mass: float) -> Any:
        """The largest part of each joint's limit, of a point mass at 7 cm from the flange."""
        model = robot.model.copy()
        frame = model.frames[robot.tip_id]
        body = pin.Inertia(mass, np.array([0.0, 0.0, 0.07]), np.zeros((3, 3)))
        model.appendBodyToJoint(frame.parentJoint, body, frame.placement)
        data = model.createData()
        v = np.diff(path, axis=0) / dt
        torques = [
            pin.rnea(model, data, path[k], v[k - 1], (v[k] - v[k - 1]) / dt)
            for k in range(1, len(v))
        ]
        return np.abs(torques).max(axis=0) / effort

    visit(browser, "shield-live", "weight")
    browser.execute_script("turn(0); begin()")
    light, *_ = record(browser, 3000)
    assert demand(light, 14.0).max() > 1.0, "a weight that it does not know of is too much"
    browser.execute_script("turn(2)")
    fetching, *_ = record(browser, 2500)
    assert browser.execute_script("return MODEL.weights[table - 2]") == 14.0
    path, _, _, said = record(browser, 3000)
    whole = np.vstack([light, fetching[1:], path[1:]])
    assert not breaches(whole, dt, *limits_of(robot), at_rest=True)
    taken = demand(path, 14.0)
    assert 0.8 < taken.max() <= 1.0
    assert any(f"joint {i} torque" in said for i in range(1, 8))


@needs_browser
def test_a_target_of_30_hz_is_followed_as_late_as_is_said(browser: Any) -> None:
    shields, robot = made()
    dt = shields["beside_ball"].dt
    for lead, late in enumerate((0.066, 0.033, 0.0)):
        visit(browser, "shield-live", "stream")
        browser.execute_script("turn(arguments[0])", lead)
        before, *_ = record(browser, 3500)
        path, handle, *_ = record(browser, 1500)
        assert not breaches(np.vstack([before, path[1:]]), dt, *limits_of(robot), at_rest=True)
        places = np.arange(200, 1400, 10)
        tip = np.array([Configuration(robot, path[k]).position for k in places])
        lags = np.arange(-30, 120)
        off = [np.linalg.norm(tip - handle[places - lag], axis=1).mean() for lag in lags]
        assert abs(dt * lags[np.argmin(off)] - late) < 4e-3
        assert np.min(off) < 4e-3
        said = browser.execute_script("return lag()")
        assert abs(said["late"] - late) < 8e-3
    drag(browser, "target", 60, -40)
    goal = browser.execute_script("return Array.from(target.slice(0, 3))")
    path, *_ = record(browser, 2000)
    assert not breaches(path, dt, *limits_of(robot), at_rest=False)
    np.testing.assert_allclose(Configuration(robot, path[-1]).position, goal, atol=1e-3)
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
