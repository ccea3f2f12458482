"""The page in a real browser: what it shows, and what hands can do to it."""

from __future__ import annotations

import socket
import threading
from urllib.parse import urlsplit

import numpy as np
import pinocchio as pin
import pytest

from helpers_browser import needs_browser, open_browser, picture, requested, wait_for
from helpers_physics import START, heart_without_physics, papers_robot
from iiwa_dnn import Configuration, InvalidInputError, Target
from iiwa_dnn.app.viewer.page import Page, Session
from iiwa_dnn.app.viewer.stage import SEEN_THROUGH
from iiwa_dnn.results.metrics import position_error
from iiwa_dnn.robot.shapes import joint_poses

pytest.importorskip("viser", reason="pip install 'iiwa-dnn[view]'")
selenium = pytest.importorskip("selenium", reason="pip install 'iiwa-dnn[test]'")

from selenium.webdriver.common.action_chains import ActionChains  # noqa: E402
from selenium.webdriver.common.keys import Keys  # noqa: E402


@pytest.fixture(scope="module")
def page():
    """The page of a heart, kept moving as the script does it."""
    robot = papers_robot()
    record = heart_without_physics(robot)
    page = Page(robot, record.q[0], record, port=0)
    # Slow without a graphics card: at each loading, ten seconds to prepare the reflections alone.
    page.server.scene.configure_default_lights(cast_shadow=False)
    page.server.scene.configure_environment_map(hdri=None)
    stop = threading.Event()
    loop = threading.Thread(target=page.run, args=(stop.is_set,))
    loop.start()
    yield page
    stop.set()
    loop.join()
    page.close()


@pytest.fixture(scope="module")
def browser(page, tmp_path_factory):
    with open_browser(tmp_path_factory.mktemp("profile")) as browser:
        browser.get_log("performance")  # what the empty start page asked for
        browser.get(page.address)
        wait_for(lambda: page.sessions, "the session of this browser")
        wait_for(lambda: buttons(browser, "Play"), "the page's controls")
        wait_for(lambda: arm(picture(browser)).sum() > 1000, "the arm")
        yield browser


@pytest.fixture
def session(page, browser):
    """The session of the browser, which was the first."""
    return page.sessions[min(page.sessions)]


def buttons(browser, text: str) -> list:
    return browser.execute_script(
        "return [...document.querySelectorAll('button')].filter("
        "button => button.innerText.trim() === arguments[0])",
        text,
    )


def click(browser, text: str) -> None:
    """Click a button; the page may put a new one in its place meanwhile."""

    def try_to() -> bool:
        found = buttons(browser, text)
        if found:
            found[0].click()
        return bool(found)

    wait_for(try_to, f"the button {text!r}")


def sliders(browser) -> list:
    return browser.execute_script(
        "return [...document.querySelectorAll('[role=slider]')].filter("
        "slider => slider.offsetParent !== null)"
    )


def press(browser, key: str) -> None:
    """Press a key on the first slider; the page may put a new one in its place meanwhile."""
    wait_for(lambda: sliders(browser)[0].send_keys(key) is None, "a slider")


def arm(image: np.ndarray) -> np.ndarray:
    """Orange pixels, left of the page's controls, which are orange too."""
    image = image[:, :600].astype(int)
    return (image[..., 0] > image[..., 1] + 60) & (image[..., 1] > image[..., 2] + 40)


def red(image: np.ndarray) -> np.ndarray:
    """Pixels of the drawn path."""
    image = image[:, :600].astype(int)
    # Unlike the arm's orange in the shade, there is no more green than blue in it.
    return (image[..., 0] > 170) & (image[..., 1] < 60) & (image[..., 2] >= image[..., 1])


@needs_browser
def test_it_loads_from_this_machine_alone_and_is_not_blank(browser, page):
    image = picture(browser)
    assert arm(image).sum() > 1000
    assert len(np.unique(image[:, :600].reshape(-1, 3), axis=0)) > 500
    ours = {
        urlsplit(address).netloc
        for address in requested(browser)
        if urlsplit(address).scheme in ("http", "https", "ws", "wss")
    }
    assert ours == {urlsplit(page.address).netloc}
    errors = [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]
    assert not [entry for entry in errors if "favicon" not in entry["message"]]
    assert "position error" in browser.page_source
    assert "cross-check gap (proxqp)" in browser.page_source


@needs_browser
def test_the_title_and_the_active_mode_are_told(browser, session):
    wait_for(lambda: browser.title == "iiwa7 · iiwa_dnn", "the window's title")
    assert buttons(browser, "● replay")
    assert not buttons(browser, "● live")


@needs_browser
def test_views_turn_the_camera_of_this_browser(browser, session):
    camera = session.stage.host.camera
    tip = session.replay.record.position_desired.mean(axis=0)
    first = np.array([camera.position, camera.look_at])
    for view, direction in (("top", [0.0, 0.0, 1.0]), ("side", [tip[1], -tip[0], 0.0])):
        click(browser, view)
        unit = np.array(direction) / np.linalg.norm(direction)

        def looks(unit=unit) -> bool:
            sight = np.array(camera.position) - np.array(camera.look_at)
            distance = np.linalg.norm(sight)
            beside = np.linalg.norm(np.array(camera.look_at) - tip)
            return bool(sight @ unit > 0.99 * distance > 0.1 and beside < 0.25 * distance)

        def opaque(expected=SEEN_THROUGH if view == "top" else None) -> bool:
            return {shape.opacity for shape in session.stage._shapes} == {expected}

        assert wait_for(looks, f"the view {view!r}")
        # Set after the camera, by the page's own thread.
        assert wait_for(opaque, f"the arm's opacity in the view {view!r}")
    click(browser, "arm")
    assert wait_for(
        lambda: np.allclose([camera.position, camera.look_at], first, atol=1e-3), "the first view"
    )


@needs_browser
def test_curves_have_powers_of_ten_and_a_line_at_the_present_time(browser, session):
    curve = session.replay.curves[0]
    handle = curve.handle
    session.replay.playback.seek(4.0)
    wait_for(lambda: curve.now == 4.0, "the line")
    times, values, line = handle.data
    assert times[np.argmax(line)] == 4.0
    assert (np.diff(times) >= 0.0).all()
    assert (line == curve.low).sum() == len(line) - 1
    errors = np.linalg.norm(position_error(session.replay.record), axis=1)
    assert errors.max() == values.max()
    assert all(tick.startswith("10") for tick in handle.axes[1]["values"])
    assert np.log10(handle.axes[1]["splits"]) == pytest.approx(
        np.round(np.log10(handle.axes[1]["splits"]))
    )


@pytest.fixture
def shared():
    """A session that all browsers of a page have in common: there is no browser."""
    page = Page(papers_robot(), START, port=0)
    yield page.open(page.server)
    page.close()


def test_the_ghost_stands_where_the_last_link_has_to_be(shared):
    stage = shared.stage
    q = np.array([0.3, -0.5, 0.2, 1.1, -0.4, 0.6, 0.9])
    at = Configuration(stage.robot, q)
    stage.ghost(Target(at.position, at.rotation))
    last = joint_poses(stage.robot, q)[-1]
    ghost = stage._ghost
    assert ghost.visible
    np.testing.assert_allclose(ghost.position, last.translation, atol=1e-12)
    turned = pin.Quaternion(*map(float, ghost.wxyz)).matrix()
    np.testing.assert_allclose(turned, last.rotation, atol=1e-12)
    stage.ghost(None)
    assert not ghost.visible


@needs_browser
def test_the_path_so_far_is_drawn(browser, session):
    session.replay.playback.seek(4.0)
    assert wait_for(lambda: red(picture(browser)).sum() > 50, "a drawn path")
    session.replay.playback.seek(0.0)
    assert wait_for(lambda: red(picture(browser)).sum() == 0, "no path at the start")


@needs_browser
def test_the_slider_moves_the_arm(browser, session):
    press(browser, Keys.HOME)
    wait_for(lambda: session.replay.playback.time == 0.0, "the start")
    wait_for(lambda: red(picture(browser)).sum() == 0, "no path at the start")
    start = picture(browser)
    slider = sliders(browser)[0]
    ActionChains(browser).drag_and_drop_by_offset(slider, 60, 0).perform()
    wait_for(lambda: 1.0 <= session.replay.playback.time < 10.0, "the slider to move the replay")
    assert not session.replay.playback.playing
    wait_for(lambda: changed(start, picture(browser)) > 500, "the arm to move")
    # What is on the stage is the record's own posture at that time.
    shown = [np.array(joint.position) for joint in session.stage._joints]
    q = session.replay.record.q[session.replay.sample]
    there = [pose.translation for pose in joint_poses(session.stage.robot, q)]
    np.testing.assert_allclose(shown, there, atol=1e-6)


def changed(first: np.ndarray, second: np.ndarray) -> int:
    """Pixels left of the page's controls that differ."""
    return int((np.abs(first[:, :600].astype(int) - second[:, :600]).max(axis=-1) > 40).sum())


@needs_browser
def test_play_runs_and_pause_stops(browser, session):
    press(browser, Keys.HOME)
    wait_for(lambda: session.replay.playback.time == 0.0, "the start")
    first = picture(browser)
    click(browser, "Play")
    wait_for(lambda: session.replay.playback.time > 1.0, "the replay to run")
    assert session.replay.playback.playing
    wait_for(lambda: buttons(browser, "Pause"), "the button to say Pause")
    wait_for(lambda: changed(first, picture(browser)) > 500, "the arm to move")
    click(browser, "Pause")
    wait_for(lambda: not session.replay.playback.playing, "the replay to stop")
    time = session.replay.playback.time
    wait_for(lambda: buttons(browser, "Play"), "the button to say Play")
    assert session.replay.playback.time == time
    shown = float(sliders(browser)[0].get_attribute("aria-valuenow"))
    assert shown == pytest.approx(time, abs=0.02)


@needs_browser
def test_live_the_arm_follows_the_dragged_target(browser, session):
    click(browser, "live")
    assert wait_for(lambda: session.live.active, "the live mode")
    assert wait_for(lambda: len(sliders(browser)) == 4, "weight and gains")
    assert wait_for(lambda: "distance to the target" in browser.page_source, "the read-out")
    start = np.array(session.live.target.position)
    drag(browser, session, 0.05)
    moved = wait_for(
        lambda: (
            np.linalg.norm(np.array(session.live.target.position) - start) > 0.01
            and np.array(session.live.target.position)
        ),
        "the target to be dragged",
    )
    follower = session.live.follower
    assert wait_for(
        lambda: np.linalg.norm(follower.configuration.position - moved) < 1e-3,
        "the arm to follow",
    )
    assert wait_for(lambda: buttons(browser, "● live"), "the mark of the live mode")
    before = follower.scheme.weight
    press(browser, Keys.ARROW_RIGHT)
    assert wait_for(lambda: follower.scheme.weight > before, "the weight to change")
    click(browser, "Target back to the start")
    assert wait_for(
        lambda: np.linalg.norm(follower.configuration.position - start) < 1e-3, "the way back"
    )
    click(browser, "replay")
    assert wait_for(
        lambda: not session.live.active and buttons(browser, "Play"), "the replay again"
    )


@needs_browser
def test_live_the_arm_gives_way_to_a_dragged_ball(browser, session):
    follower = session.live.follower
    session.set_mode("live")
    session.live.set_ball(True)
    wait_for(lambda: follower.ball is not None, "the ball")
    elbow = follower.configuration.frame("iiwa7_link_4").position
    q = follower.configuration.q
    session.live.ball.handle.position = elbow
    assert wait_for(
        lambda: np.abs(follower.configuration.q - q).max() > 0.05, "the arm to give way"
    )
    session.live.set_ball(False)
    wait_for(lambda: follower.ball is None, "the ball to be gone")
    session.set_mode("replay")


def test_live_a_push_shows_in_the_curves_and_the_network_settles_again(shared):
    live = shared.live
    for _ in range(30):
        live.tick(0.1)
    live.push(np.random.default_rng(0))
    for _ in range(5):
        live.tick(0.1)
    error = live.diagrams.recent[0].handle.data[1]
    assert error.max() > 1e3 * error[:25].max()
    for _ in range(40):
        live.tick(0.1)
    times, error, _, line = live.diagrams.recent[0].handle.data
    assert error[-1] < 1e-3 * error.max()
    assert times[np.argmax(line)] == 0.0
    assert np.diff(times).max() == pytest.approx(0.1)
    path = live._stage._lines["followed"].points
    np.testing.assert_allclose(path[-1, 1], live.follower.configuration.position, atol=1e-6)
    states = np.array(live.diagrams.settling.handle.data[1:-1])
    assert states.shape[0] == live.follower.robot.dof
    assert states[:, -1].max() < 1e-6


@needs_browser
def test_each_browser_has_a_state_of_its_own(browser, page, session):
    first = browser.current_window_handle
    session.replay.playback.seek(4.0)
    browser.switch_to.new_window("tab")
    browser.get(page.address)
    other = wait_for(
        lambda: len(page.sessions) == 2 and page.sessions[max(page.sessions)], "a second session"
    )
    click(browser, "live")
    wait_for(lambda: other.live.active, "the live mode of the second")
    assert not session.live.active
    assert (session.replay.playback.time, other.replay.playback.time) == (4.0, 0.0)
    browser.close()
    browser.switch_to.window(first)
    wait_for(lambda: len(page.sessions) == 1, "the end of the second")


@needs_browser
def test_on_a_phone_the_arm_stands_above_the_controls(browser, page, session):
    first = browser.current_window_handle
    browser.switch_to.new_window("tab")
    phone = {"width": 390, "height": 844, "deviceScaleFactor": 1, "mobile": True}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", phone)
    browser.get(page.address)
    wait_for(lambda: buttons(browser, "Play"), "the page's controls")

    left, top, width = browser.execute_script(
        "let part = [...document.querySelectorAll('button')].find("
        "button => button.innerText.trim() === 'Play');"
        "while (getComputedStyle(part).position !== 'fixed') part = part.parentElement;"
        "let box = part.getBoundingClientRect(); return [box.left, box.top, box.width]"
    )
    assert top > 0.59 * 844  # the scene has more than half
    assert (left, width) == (0, 390)  # and no strip beside the controls

    def seen() -> bool:
        rows, columns = np.nonzero(arm(picture(browser)[: int(top)]))
        return len(rows) > 500 and bool(columns.min() > 0 and columns.max() < 389)

    assert wait_for(seen, "the whole arm above the controls")
    browser.close()
    browser.switch_to.window(first)
    wait_for(lambda: len(page.sessions) == 1, "the end of the second")


def drag(browser, session: Session, metres: float) -> None:
    """Take the handle of one of the target's axes with the mouse and pull it."""
    camera = session.stage.host.camera
    w, x, y, z = map(float, camera.wxyz)
    to_camera = pin.Quaternion(w, x, y, z).matrix().T
    scale = 0.5 * camera.image_height / np.tan(0.5 * camera.fov)

    def pixel(point: np.ndarray) -> np.ndarray:
        seen = to_camera @ (point - camera.position)
        return scale * seen[:2] / seen[2]  # from the middle of the canvas

    origin = np.array(session.live.target.position)
    w, x, y, z = map(float, session.live.target.wxyz)
    axes = pin.Quaternion(w, x, y, z).matrix().T
    # The axis that lies across the picture, not the one that points into it.
    axis = max(axes, key=lambda axis: np.linalg.norm(pixel(origin + axis) - pixel(origin)))
    # One call: the canvases of curves come and go while Python looks at them.
    canvas = browser.execute_script(
        "return [...document.querySelectorAll('canvas')].sort("
        "(one, other) => other.clientWidth - one.clientWidth)[0]"
    )
    grip = pixel(origin + 0.12 * axis)
    goal = pixel(origin + (0.12 + metres) * axis)
    hand = ActionChains(browser).move_to_element_with_offset(canvas, *map(int, grip))
    hand = hand.click_and_hold().pause(0.2).move_by_offset(*map(int, goal - grip))
    hand.pause(0.3).release().perform()


def test_only_this_machine_is_let_in_unless_told_otherwise():
    robot = papers_robot()
    page = Page(robot, START, port=0)
    try:
        address = urlsplit(page.address)
        assert address.hostname == "127.0.0.1"
        with socket.create_connection(("127.0.0.1", address.port), timeout=5):
            pass
        # Another address of this same machine: nobody listens there.
        with pytest.raises(OSError):  # noqa: PT011
            socket.create_connection(("127.0.0.2", address.port), timeout=5)
        session = page.open(page.server)
        assert session.live.active
        session.tick(0.1)
        page.tick(0.1)
    finally:
        page.close()
    open_page = Page(robot, START, host="0.0.0.0", port=0)
    try:
        port = urlsplit(open_page.address).port
        with socket.create_connection(("127.0.0.2", port), timeout=5):
            pass
    finally:
        open_page.close()


def test_a_port_that_is_taken():
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(InvalidInputError, match=f"cannot listen on 127.0.0.1:{port}"):
            Page(papers_robot(), START, port=port)


@pytest.mark.parametrize(("host", "port"), [("127.0.0.1", 70_000), ("no such host", 0)])
def test_an_address_that_is_none(host, port):
    with pytest.raises(InvalidInputError, match="cannot listen"):
        Page(papers_robot(), START, host=host, port=port)


def test_the_start_is_checked():
    with pytest.raises(InvalidInputError, match="q"):
        Page(papers_robot(), START[:5], port=0)
