"""The whole page: replay and live mode on one stage, and the loop that keeps it moving."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from iiwa_dnn.app.live.follower import Follower
from iiwa_dnn.app.live.panel import LivePanel
from iiwa_dnn.app.viewer import ReplayPanel, Stage
from iiwa_dnn.app.viewer.server import HOST, PORT, close_server, open_server
from iiwa_dnn.qp.program import Vector
from iiwa_dnn.results.record import Record
from iiwa_dnn.robot.robot import Robot
from iiwa_dnn.schemes import DoubleIndicator

TICK = 1.0 / 30.0
"""Time between two pictures [s]."""

REPLAY, LIVE = "replay", "live"


class Page:
    """A page that replays a record, follows a target live, or both in turn.

    Attributes:
        server: The ``viser.ViserServer``.
        stage: Its three-dimensional part.
        replay: The replay; None without a record.
        live: The live mode.
    """

    def __init__(
        self,
        robot: Robot,
        q0: Vector,
        record: Record | None = None,
        scheme: DoubleIndicator | None = None,
        host: str = HOST,
        port: int = PORT,
    ) -> None:
        """Serve the page; `run` or `tick` brings it to life.

        Args:
            robot: The robot, with the limits that the live mode keeps.
            q0: Where the live mode starts [rad], (n,).
            record: What to replay; without one the page starts in live mode.
            scheme: Of the live mode.
            host: Address to listen on; the default is the local machine only.
            port: Port to listen on; 0 takes a free one.

        Raises:
            MissingDependencyError: If viser is not installed.
            InvalidInputError: If the address cannot be listened on, or `q0` is not acceptable.
        """
        follower = Follower(robot, q0, scheme)
        self.server = open_server(f"{robot.name} · iiwa_dnn", host, port)
        self.stage = Stage(self.server, robot)
        self._mode: Any = None
        if record is not None:
            self._mode = self.server.gui.add_button_group("mode", (REPLAY, LIVE))
            self._mode.on_click(lambda event: self.set_mode(str(event.target.value)))
        self.replay = None if record is None else ReplayPanel(self.stage, record)
        self.live = LivePanel(self.stage, follower)
        if record is None:
            self.stage.look_at(follower.configuration.position)
            self.stage.show(follower.configuration.q)
            self.live.set_active(True)

    @property
    def address(self) -> str:
        """Where the page is."""
        host = self.server.get_host()
        shown = "127.0.0.1" if host in ("0.0.0.0", "::") else host
        return f"http://{f'[{shown}]' if ':' in shown else shown}:{self.server.get_port()}"

    def set_mode(self, mode: str) -> None:
        """Change between ``"replay"`` and ``"live"``; both go on where they were."""
        if self.replay is None:
            return
        self.live.set_active(mode == LIVE)
        self.replay.set_visible(mode != LIVE)

    def tick(self, elapsed: float) -> None:
        """Let `elapsed` seconds pass."""
        if self.live.active:
            self.live.tick(elapsed)
        elif self.replay is not None:
            self.replay.tick(elapsed)

    def run(self, stop: Callable[[], bool] = lambda: False) -> None:
        """Keep the page moving until `stop` says so, or Ctrl-C."""
        before = time.perf_counter()
        while not stop():
            time.sleep(max(0.0, before + TICK - time.perf_counter()))
            now = time.perf_counter()
            self.tick(now - before)
            before = now

    def close(self) -> None:
        """Close the page."""
        close_server(self.server)


def scheme_of(record: Record) -> DoubleIndicator:
    """The scheme that a record was made with, without its home; the default for another kind."""
    settings = dict(record.settings.get("scheme") or {})
    if settings.pop("name", None) != DoubleIndicator().settings()["name"]:
        return DoubleIndicator()
    return DoubleIndicator(**{**settings, "home": None})


def limits_of(record: Record, robot: Robot) -> Robot:
    """The robot with the limits that a record was made with."""
    settings = record.settings
    lower, upper, speed = (
        np.array([unlimited if value is None else value for value in settings[key]])
        for key, unlimited in (("q_lower", -np.inf), ("q_upper", np.inf), ("dq_max", np.inf))
    )
    return robot.with_limits(lower=lower, upper=upper, velocity=speed)
