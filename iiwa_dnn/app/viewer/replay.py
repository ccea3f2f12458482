"""The replay of a record: its clock, controls, curves and read-outs."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from iiwa_dnn.app.viewer import readout
from iiwa_dnn.app.viewer.curves import COLOURS, Curves
from iiwa_dnn.app.viewer.stage import Stage
from iiwa_dnn.references import Target
from iiwa_dnn.results.envelope import envelope
from iiwa_dnn.results.metrics import orientation_error, position_error
from iiwa_dnn.results.record import FloatArray, Record
from iiwa_dnn.results.scenery import obstacles_of

SPEEDS = ("0.1", "0.25", "0.5", "1", "2", "5")
_DESIRED_COLOUR, _DRAWN_COLOUR = (70, 80, 100), (220, 0, 30)
_CURVE_POINTS = 300


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
        self.record, self._stage = record, stage
        start, end = float(record.t[0]), float(record.t[-1])
        self.playback = Playback(start, end)
        self._error = np.linalg.norm(position_error(record), axis=1)
        self._turn = orientation_error(record)
        self._shown: tuple[float, bool] | None = None
        self.curves: list[Curves] = []
        self._since_readout = np.inf
        stage.line("desired", record.position_desired, _DESIRED_COLOUR, 2.0)
        stage.add_obstacles(obstacles_of(record))
        gui = stage.host.gui
        folders = gui.add_folder("Replay"), gui.add_folder("State")
        self._folders = (*folders, gui.add_folder("Whole run", expand_by_default=False))
        with self._folders[0]:
            self._play = gui.add_button("Play")
            step = max((end - start) / 1000.0, 1e-6)
            self._slider = gui.add_slider("time [s]", start, max(end, 1e-6), step, start)
            self._speed = gui.add_dropdown("speed", SPEEDS, initial_value="1")
        with self._folders[1]:
            self._facts = gui.add_html("")
            self._bars = gui.add_html("")
        with self._folders[2]:
            steps = record.t[:-1]
            self._curve(record.t, self._error, "position error [m]", COLOURS[0])
            if record.distance is not None:
                self._curve(
                    record.t, record.distance, "distance of the nearest pair [m]", COLOURS[2]
                )
            self._curve(steps, record.kkt_residual, "KKT residual of the network", COLOURS[4])
            self._curve(steps, record.crosscheck_gap, "cross-check gap [rad/s]", COLOURS[1])
        self._play.on_click(lambda _: self.playback.toggle())
        self._slider.on_update(self._on_slider)
        self._speed.on_update(self._on_speed)
        self.tick(0.0)

    def tick(self, elapsed: float) -> None:
        """Let `elapsed` seconds pass and show the record's state then."""
        self.playback.advance(elapsed)
        self._since_readout += elapsed
        state = self.playback.time, self.playback.playing
        if state == self._shown:
            return
        k = self.sample
        self._stage.show(self.record.q[k], float(self.record.t[k]))
        target = Target(self.record.position_desired[k], self.record.rotation_desired[k])
        apart = self._error[k] > 1e-3 or self._turn[k] > 1e-2  # else it would flicker in the arm
        self._stage.ghost(target if apart else None)
        if k > 0:
            self._stage.line("drawn", self.record.position[: k + 1], _DRAWN_COLOUR, 4.0)
        self._stage.set_line_visible("drawn", k > 0)
        paused = self._shown is None or not self.playback.playing
        if paused or self._since_readout >= readout.PERIOD:
            self._since_readout = 0.0
            self._read_out(k)
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

    def _read_out(self, k: int) -> None:
        self._slider.value = float(np.clip(self.playback.time, self._slider.min, self._slider.max))
        self._play.label = "Pause" if self.playback.playing else "Play"
        record, step = self.record, min(k, self.record.steps - 1)
        values = {
            "position error": readout.length(float(self._error[k])),
            "orientation error": f"{self._turn[k]:.2e} rad",
        }
        if record.distance is not None:
            values["distance of the nearest pair"] = readout.length(float(record.distance[k]))
        if record.steps:
            values["KKT residual of the network"] = f"{record.kkt_residual[step]:.1e}"
            gap = record.crosscheck_gap[step]
            solvers = "+".join(record.settings["check"]["solvers"]) or "nobody"
            known = "not asked" if np.isnan(gap) else f"{gap:.1e} rad/s"
            values[f"cross-check gap ({solvers})"] = known
            if record.torque is not None:
                values["largest torque"] = f"{np.abs(record.torque[step]).max():.1f} N m"
        self._facts.content = readout.facts(values)
        for curve in self.curves:
            curve.mark(self.playback.time)
        robot = self._stage.robot
        self._bars.content = readout.joint_bars(record.q[k], robot.q_lower, robot.q_upper)

    def _on_slider(self, event: Any) -> None:
        # The replay moves the slider too; only a person's hand has a client.
        if event.client is not None:
            self.playback.playing = False
            self.playback.seek(float(event.target.value))

    def _on_speed(self, event: Any) -> None:
        self.playback.speed = float(event.target.value)

    def _curve(self, t: FloatArray, values: FloatArray, title: str, colour: str) -> None:
        """Draw the largest value of each stretch of time."""
        if (values > 0.0).sum() > 1:
            times, _, _, greatest = envelope(t, np.nan_to_num(values, posinf=0.0), _CURVE_POINTS)
            curve = Curves(
                self._stage.host.gui, title, (colour,), (self.playback.start, self.playback.end)
            )
            curve.show(times, greatest)
            self.curves.append(curve)
