"""The replay: controls, curves and read-outs of one record."""

from __future__ import annotations

from typing import Any

import numpy as np

from iiwa_dnn.app.viewer import readout
from iiwa_dnn.app.viewer.playback import Playback
from iiwa_dnn.app.viewer.server import import_viser
from iiwa_dnn.app.viewer.stage import DESIRED_COLOUR, DRAWN_COLOUR, Stage
from iiwa_dnn.results.metrics import orientation_error, position_error
from iiwa_dnn.results.plots import envelope
from iiwa_dnn.results.record import FloatArray, Record

SPEEDS = ("0.1", "0.25", "0.5", "1", "2", "5")
READOUT_PERIOD = 0.1
"""Time between two updates of words and bars [s]; the robot moves at every tick."""

_CURVE_POINTS = 300


class ReplayPanel:
    """Replays a record on a stage.

    Attributes:
        record: The run.
        playback: Its clock; the page's controls act on it, and so may a caller.
    """

    def __init__(self, stage: Stage, record: Record) -> None:
        """Put the controls on the page and show the start of the run."""
        self.record, self._stage = record, stage
        self.playback = Playback(float(record.t[0]), float(record.t[-1]), float(record.t[0]))
        self._error = np.linalg.norm(position_error(record), axis=1)
        self._turn = orientation_error(record)
        self._lower = readout.limits(record.settings["q_lower"], -np.inf)
        self._upper = readout.limits(record.settings["q_upper"], np.inf)
        self._shown: tuple[float, bool] | None = None
        self._since_readout = np.inf
        stage.line("desired", record.position_desired, DESIRED_COLOUR, 2.0)
        stage.look_at(record.position_desired.mean(axis=0))
        gui = stage.server.gui
        folders = gui.add_folder("Replay"), gui.add_folder("State")
        self._folders = (*folders, gui.add_folder("Whole run", expand_by_default=False))
        with self._folders[0]:
            self._play = gui.add_button("Play")
            step = max((self.playback.end - self.playback.start) / 1000.0, 1e-6)
            self._slider = gui.add_slider(
                "time [s]", self.playback.start, max(self.playback.end, 1e-6), step,
                self.playback.start,
            )  # fmt: skip
            self._speed = gui.add_dropdown("speed", SPEEDS, initial_value="1")
        with self._folders[1]:
            self._facts = gui.add_html("")
            self._bars = gui.add_html("")
        with self._folders[2]:
            self._add_curves(gui)
        self._play.on_click(lambda _: self.playback.toggle())
        self._slider.on_update(self._on_slider)
        self._speed.on_update(self._on_speed)
        self.tick(0.0)

    def tick(self, elapsed: float) -> None:
        """Let `elapsed` seconds pass and show where the replay is then."""
        self.playback.advance(elapsed)
        self._since_readout += elapsed
        state = self.playback.time, self.playback.playing
        if state == self._shown:
            return
        k = self.sample
        self._stage.show(self.record.q[k])
        if k > 0:
            self._stage.line("drawn", self.record.position[: k + 1], DRAWN_COLOUR, 4.0)
        self._stage.set_line_visible("drawn", k > 0)
        paused = self._shown is None or not self.playback.playing
        if paused or self._since_readout >= READOUT_PERIOD:
            self._since_readout = 0.0
            self._read_out(k)
        self._shown = state

    def set_visible(self, visible: bool) -> None:
        """Show or hide the controls and the paths; shown again, the robot is put back."""
        for folder in self._folders:
            folder.visible = visible
        for name in ("desired", "drawn"):
            self._stage.set_line_visible(name, visible)
        self.playback.pause()
        self._shown = None

    @property
    def sample(self) -> int:
        """The record's sample that is shown."""
        return int(np.abs(self.record.t - self.playback.time).argmin())

    def _read_out(self, k: int) -> None:
        self._slider.value = float(np.clip(self.playback.time, self._slider.min, self._slider.max))
        self._play.label = "Pause" if self.playback.playing else "Play"
        record, step = self.record, min(k, self.record.steps - 1)
        values = {
            "position error": readout.length(float(self._error[k])),
            "orientation error": f"{self._turn[k]:.2e} rad",
        }
        if record.steps:
            values["KKT residual of the network"] = f"{record.kkt_residual[step]:.1e}"
            gap = record.crosscheck_gap[step]
            solvers = "+".join(record.settings["check"]["solvers"]) or "nobody"
            known = "not asked" if np.isnan(gap) else f"{gap:.1e} rad/s"
            values[f"cross-check gap ({solvers})"] = known
            if record.torque is not None:
                values["largest torque"] = f"{np.abs(record.torque[step]).max():.1f} N m"
        self._facts.content = readout.facts(values)
        self._bars.content = readout.joint_bars(record.q[k], self._lower, self._upper)

    def _on_slider(self, event: Any) -> None:
        # The replay moves the slider too; only a person's hand has a client.
        if event.client is not None:
            self.playback.pause()
            self.playback.seek(float(event.target.value))

    def _on_speed(self, event: Any) -> None:
        self.playback.speed = float(event.target.value)

    def _add_curves(self, gui: Any) -> None:
        """Position error and cross-check gap over the whole run."""
        t, steps = self.record.t, self.record.t[:-1]
        self._curve(gui, t, self._error, "log₁₀ of the position error [m]", "#d6001c")
        if self.record.steps and np.isfinite(self.record.crosscheck_gap).any():
            gap = self.record.crosscheck_gap
            self._curve(gui, steps, gap, "log₁₀ of the cross-check gap [rad/s]", "#1c7ed6")

    @staticmethod
    def _curve(gui: Any, t: FloatArray, values: FloatArray, title: str, colour: str) -> None:
        """The largest value of each stretch of time; what is not positive has no logarithm."""
        good = np.isfinite(values) & (values > 0.0)
        if good.sum() < 2:
            return
        uplot = import_viser().uplot
        times, _, _, greatest = envelope(t[good], values[good], _CURVE_POINTS)
        gui.add_uplot(
            (np.ascontiguousarray(times), np.log10(greatest)),
            (uplot.Series(label="t [s]"), uplot.Series(label=title, stroke=colour, width=1)),
            title=title,
            scales={"x": uplot.Scale(time=False)},
            height=170,
        )
