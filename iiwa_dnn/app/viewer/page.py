"""The page: its server, a session for each browser, and the loop that keeps them moving."""

import html
import json
import socket
import time
import warnings
from collections.abc import Callable
from contextlib import redirect_stdout
from functools import partial
from io import StringIO
from queue import SimpleQueue
from typing import Any

import numpy as np

from iiwa_dnn.app.viewer.follower import Follower
from iiwa_dnn.app.viewer.live import LivePanel
from iiwa_dnn.app.viewer.replay import ReplayPanel
from iiwa_dnn.app.viewer.stage import VIEWS, Stage, camera_pose
from iiwa_dnn.errors import InvalidInputError, import_extra
from iiwa_dnn.qp.program import Vector
from iiwa_dnn.results.record import FloatArray, Record
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.robot.robot import Robot
from iiwa_dnn.schemes import DoubleIndicator

TICK = 1.0 / 30.0
"""Time between two pictures [s]."""

_MODES = ("replay", "live")
# On a phone viser's controls would cover 60 % of the height, and leave a useless strip beside them.
_STYLE = """<style>
[style*="max-height: 60%"] { max-height: 40% !important }
[style*="max-height: 60%"], [style*="max-height: 60%"] [style*="width: 20em"] {
    width: 100% !important }
</style>"""


class Session:
    """Replay and live mode in one browser, with a state of their own.

    Attributes:
        stage: The three-dimensional part.
        replay: The replay; None without a record.
        live: The live mode.
    """

    def __init__(
        self,
        host: Any,
        robot: Robot,
        q0: Vector,
        record: Record | None,
        scheme: DoubleIndicator | None,
    ) -> None:
        """Put the robot and all controls into a browser; q0 (n,) [rad] and others as of `Page`."""
        follower = Follower(robot, q0, scheme)
        self.stage = Stage(host, robot, _path(robot, q0, record))
        if getattr(getattr(host, "camera", None), "aspect", 1.0) < 1.0:  # a phone, upright
            self.stage.turn_to("arm")
        view: Any = host.gui.add_button_group("view", VIEWS)
        view.on_click(lambda event: self.stage.turn_to(event.target.value))
        self.replay: ReplayPanel | None = None
        if record is not None:
            self._mode: Any = host.gui.add_button_group("mode", _MODES)
            self._mode.on_click(lambda event: self.set_mode(str(event.target.value).strip("● ")))
            self._mark("replay")
            self.replay = ReplayPanel(self.stage, record)
        self.live = LivePanel(self.stage, follower)
        if record is None:
            self.live.set_active(True)

    def set_mode(self, mode: str) -> None:
        """Change between ``"replay"`` and ``"live"``; both go on from their last state."""
        if self.replay is not None:
            self.live.set_active(mode == "live")
            self.replay.set_visible(mode == "replay")
            self._mark(mode)

    def _mark(self, active: str) -> None:
        """Mark the active mode's button."""
        self._mode.options = tuple(f"● {mode}" if mode == active else mode for mode in _MODES)

    def tick(self, elapsed: float) -> None:
        """Let `elapsed` seconds pass."""
        if self.live.active:
            self.live.tick(elapsed)
        elif self.replay is not None:
            self.replay.tick(elapsed)


class Page:
    """A page that replays a record, follows a target live, or both in turn, in every browser anew.

    Attributes:
        server: The ``viser.ViserServer``.
        sessions: The sessions of the browsers by the browser's number.
        open: Function that returns a new session of a browser.
    """

    def __init__(
        self,
        robot: Robot,
        q0: Vector,
        record: Record | None = None,
        scheme: DoubleIndicator | None = None,
        host: str = "127.0.0.1",
        port: int = 8080,
    ) -> None:
        """Serve the page; `run` or `tick` moves it.

        Both modes show the robot's limits. The live mode keeps them and starts from q0 (n,) [rad];
        without a record the page starts in it. The host ``"0.0.0.0"`` lets other machines in, the
        port 0 is a free one.

        Raises:
            MissingDependencyError: If viser is not installed.
            InvalidInputError: If the address cannot be listened on, or `q0` is not acceptable.
        """
        self.server = _open_server(f"{robot.name} · iiwa_dnn", host, port)
        camera = self.server.initial_camera
        position, middle = camera_pose("arm", _path(robot, q0, record))
        camera.position = tuple(position)
        camera.look_at = tuple(middle)
        camera.fov = 0.95  # rad, from top to bottom
        self.sessions: dict[int, Session] = {}
        self.open = partial(Session, robot=robot, q0=q0, record=record, scheme=scheme)
        # Browsers come and go in threads of the server; sessions change in `tick` alone.
        self._comings: SimpleQueue[Any] = SimpleQueue()
        self._goings: SimpleQueue[Any] = SimpleQueue()
        self.server.on_client_connect(self._comings.put)
        self.server.on_client_disconnect(self._goings.put)

    @property
    def address(self) -> str:
        """Address of the page."""
        host = self.server.get_host()
        shown = "127.0.0.1" if host in ("0.0.0.0", "::") else host
        return f"http://{f'[{shown}]' if ':' in shown else shown}:{self.server.get_port()}"

    def tick(self, elapsed: float) -> None:
        """Let `elapsed` seconds pass in every browser."""
        while not self._comings.empty():
            client = self._comings.get()
            self.sessions[client.client_id] = self.open(client)
        while not self._goings.empty():
            self.sessions.pop(self._goings.get().client_id, None)
        for session in self.sessions.values():
            session.tick(elapsed)

    def run(self, stop: Callable[[], bool] = lambda: False) -> None:
        """Keep the page moving until `stop` returns True, or Ctrl-C."""
        before = time.perf_counter()
        while not stop():
            time.sleep(max(0.0, before + TICK - time.perf_counter()))
            now = time.perf_counter()
            self.tick(now - before)
            before = now

    def close(self) -> None:
        """Close the page."""
        with redirect_stdout(StringIO()):  # viser says so
            self.server.stop()


def _path(robot: Robot, q0: Vector, record: Record | None) -> FloatArray:
    """Return the points of the path, or where the tip is at the start, (M, 3) [m]."""
    if record is None:
        return Configuration(robot, q0).position[np.newaxis]
    return record.position_desired


def _open_server(title: str, host: str, port: int) -> Any:
    """Serve an empty page with a title, in the look of the project."""
    viser = import_extra("viser", "pip install 'iiwa-dnn[view]'")
    port = _checked_port(host, port)
    with redirect_stdout(StringIO()):  # its banner; the command prints the address
        server = viser.ViserServer(host=host, port=port, label=title, verbose=False)
    # No logo that links to the web, and no button that asks a relay for a public address.
    server.gui.configure_theme(
        control_width="large", show_logo=False, show_share_button=False, brand_color=(255, 102, 0)
    )
    server.gui.set_panel_label(title)
    # Title and style can only be set from within the page.
    script = html.escape(f"document.title = {json.dumps(title)}")
    head = f'<img src="data:," style="display:none" onerror="{script}">{_STYLE}'
    server.gui.add_html(head)
    server.scene.set_up_direction("+z")
    # A browser that goes away amid a tick needs no more pictures.
    warnings.filterwarnings("ignore", message="Queued a .* on a closed connection")
    return server


def _checked_port(host: str, port: int) -> int:
    """Return the port if it is free, or a free one for 0; viser would take another one silently."""
    try:
        family = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0][0]
        with socket.socket(family, socket.SOCK_STREAM) as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            probe.bind((host, port))
            return int(probe.getsockname()[1])
    except (OSError, OverflowError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        problem = f"cannot listen on {host}:{port}: {reason}"
        raise InvalidInputError("port", problem, port) from error
