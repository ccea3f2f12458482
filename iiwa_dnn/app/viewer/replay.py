"""The replay of a record: its clock, controls, diagrams and values."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from iiwa_dnn.app.viewer import readout
from iiwa_dnn.app.viewer.curves import COLORS, Curves
from iiwa_dnn.app.viewer.readout import Readout
from iiwa_dnn.app.viewer.stage import Stage
from iiwa_dnn.naming import describe, in_the_way
from iiwa_dnn.references import Target
from iiwa_dnn.results.envelope import envelope, stretches
from iiwa_dnn.results.failures import failures
from iiwa_dnn.results.metrics import orientation_error, position_error
from iiwa_dnn.results.record import Record
from iiwa_dnn.results.scenery import obstacles_of

SPEEDS = ("0.1", "0.25", "0.5", "1", "2", "5")
_DESIRED_COLOR = (70, 80, 100)
_DRAWN_COLOR = (220, 0, 30)
_POINTS = 300  # of a curve
_POLICIES = {1: "second attempt", 2: "slowed", 3: "relaxed", 4: "stopped", 5: "Euler step"}
"""Words for the codes of a record's actions."""


@dataclass
class Playback:
    """The clock of a replay.

    Attributes:
        start: First time of the record [s].
        end: Its last time [s].
        time: Present time of the replay [s].
        speed: Record seconds in a second.
        playing: Whether it runs.
    """

    start: float
    end: float
    time: float = 0.0
    speed: float = 1.0
    playing: bool = False

    def __post_init__(self) -> None:
        self.seek(self.time)

    def toggle(self) -> None:
        """Pause, or play: on from here, or from the start again if the end was reached."""
        if not self.playing and self.time >= self.end:
            self.time = self.start
        self.playing = not self.playing

    def seek(self, time: float) -> None:
        """Go to a time [s], or to the end that is nearer."""
        self.time = min(max(time, self.start), self.end)

    def advance(self, elapsed: float) -> None:
        """Let `elapsed` seconds pass; the replay stops at its end."""
        if self.playing:
            self.seek(self.time + self.speed * elapsed)
            self.playing = self.time < self.end


class ReplayPanel:
    """Controls that replay a record on a stage.

    Attributes:
        record: The run.
        playback: Its clock; the page's controls act on it, and so may a caller.
        curves: Diagrams of the whole run.
    """

    def __init__(self, stage: Stage, record: Record) -> None:
        """Put the controls on the page and show the start of the run."""
        self.record = record
        self.playback = Playback(float(record.t[0]), float(record.t[-1]))
        self._stage = stage
        self._position_error = np.linalg.norm(position_error(record), axis=1)
        self._orientation_error = orientation_error(record)
        self._shown: tuple[float, bool] | None = None
        stage.line("desired", record.position_desired, _DESIRED_COLOR, 2.0)
        stage.add_obstacles(obstacles_of(record))
        gui = stage.host.gui
        controls = gui.add_folder("Replay")
        state = gui.add_folder("State")
        diagrams = gui.add_folder("Whole run", expand_by_default=False)
        self._folders = (controls, state, diagrams)
        with controls:
            self._add_controls(gui)
        with state:
            self._readout = Readout(gui)
        with diagrams:
            self.curves = self._diagrams(gui)
        self.tick(0.0)

    def _add_controls(self, gui: Any) -> None:
        start = self.playback.start
        length = max(self.playback.end - start, 1e-6)
        self._play = gui.add_button("Play")
        self._slider = gui.add_slider("time [s]", start, start + length, length / 1000.0, start)
        acted = stretches(self.record.filled("action"), _POINTS)
        if acted.size:
            gui.add_html(readout.marks(acted.tolist()))
        gui.add_html(readout.verdict(failures(self.record)))
        speed = gui.add_dropdown("speed", SPEEDS, initial_value="1")
        self._play.on_click(lambda _: self.playback.toggle())
        self._slider.on_update(self._on_slider)
        speed.on_update(lambda event: setattr(self.playback, "speed", float(event.target.value)))

    def _diagrams(self, gui: Any) -> list[Curves]:
        """Draw the largest value of each stretch of time, of every positive quantity."""
        record = self.record
        steps = record.t[:-1]
        quantities = [
            ("position error [m]", COLORS[0], record.t, self._position_error),
            ("distance of the nearest pair [m]", COLORS[2], record.t, record.distance),
            ("KKT residual of the network", COLORS[4], steps, record.kkt_residual),
            ("cross-check gap [rad/s]", COLORS[1], steps, record.crosscheck_gap),
        ]
        curves = []
        for title, color, t, values in quantities:
            if values is not None and np.isfinite(values).sum() > 1:
                known = np.where(np.isfinite(values), values, -np.inf)
                times, _, _, largest = envelope(t, known, _POINTS)
                curve = Curves(gui, title, (color,), (self.playback.start, self.playback.end))
                curve.show(times, largest)
                curves.append(curve)
        return curves

    def tick(self, elapsed: float) -> None:
        """Let `elapsed` seconds pass and show the record's state then."""
        self.playback.advance(elapsed)
        due = self._readout.is_due(elapsed)
        state = (self.playback.time, self.playback.playing)
        if state == self._shown:
            return
        k = self.sample
        record = self.record
        self._stage.show(record.q[k], float(record.t[k]))
        target = Target(record.position_desired[k], record.rotation_desired[k])
        self._stage.ghost(target, self._position_error[k], self._orientation_error[k])
        if k > 0:
            self._stage.line("drawn", record.position[: k + 1], _DRAWN_COLOR, 4.0)
        self._stage.set_line_visible("drawn", k > 0)
        if due or self._shown is None or not self.playback.playing:
            self._show_values(k)
        self._shown = state

    def set_visible(self, visible: bool) -> None:
        """Show or hide the controls and the paths; shown again, the robot is put back."""
        for folder in self._folders:
            folder.visible = visible
        for name in ("desired", "drawn"):
            self._stage.set_line_visible(name, visible)
        self._stage.ghost(None)
        self.playback.playing = False
        self._shown = None

    @property
    def sample(self) -> int:
        """Index of the record's sample that is shown."""
        return int(np.abs(self.record.t - self.playback.time).argmin())

    def _show_values(self, k: int) -> None:
        """Show the values of a sample, and the time on the controls and in the diagrams."""
        self._slider.value = self.playback.time
        self._play.label = "Pause" if self.playback.playing else "Play"
        for curve in self.curves:
            curve.mark(self.playback.time)
        record = self.record
        values = {
            "position error": readout.length(float(self._position_error[k])),
            "orientation error": f"{self._orientation_error[k]:.2e} rad",
        }
        if len(record.distance):
            values["distance of the nearest pair"] = readout.length(float(record.distance[k]))
        if record.steps:
            values |= self._step_values(min(k, record.steps - 1))
        self._readout.show(values, self._stage.robot, record.q[k])

    def _step_values(self, step: int) -> dict[str, str]:
        """Return the values of a step in words."""
        record = self.record
        gap = record.crosscheck_gap[step]
        solvers = "+".join(record.settings["check"]["solvers"]) or "none"
        values = {
            "KKT residual of the network": f"{record.kkt_residual[step]:.1e}",
            f"cross-check gap ({solvers})": "-" if np.isnan(gap) else f"{gap:.1e} rad/s",
        }
        if record.action is not None:
            values["policy"] = policy_words(record, step)
        if len(record.torque):
            values["largest torque"] = f"{np.abs(record.torque[step]).max():.1f} N m"
        return values

    def _on_slider(self, event: Any) -> None:
        # The replay moves the slider too, but without a client.
        if event.client is not None:
            self.playback.playing = False
            self.playback.seek(float(event.target.value))


def policy_words(record: Record, step: int) -> str:
    """Say in words what a policy did at a step, and what was in the way."""
    code = int(record.filled("action")[step])
    if not code:
        return "-"
    acting = [record.filled(column)[step] for column in ("blocking", "blocking_rows")]
    against = in_the_way({"rows": (), **record.settings}, *acting)
    return ", ".join([_POLICIES.get(code, "acted"), *map(describe, against)])
