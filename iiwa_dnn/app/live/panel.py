"""The live mode's controls: a target to drag, weight and gains, what the controller says."""

from __future__ import annotations

from typing import Any

import numpy as np
import pinocchio as pin

from iiwa_dnn.app.live.follower import Follower, FollowerState
from iiwa_dnn.app.viewer import Stage, readout
from iiwa_dnn.app.viewer.stage import wxyz
from iiwa_dnn.qp.crosscheck import CrossCheck

READOUT_PERIOD = 0.1
"""Time between two updates of words, bars and the cross-check [s]."""

_MOST_STEPS = 40  # of one tick: a slow machine shows slow motion and does not fall behind for ever
_SLIDERS = {
    "weight": ("ξ weight", 0.0, 1.0, 0.01),
    "drift_gain": ("m drift [1/s]", 0.0, 30.0, 0.1),
    "position_gain": ("δ position [1/s]", 0.0, 30.0, 0.1),
    "orientation_gain": ("ν turn [1/s]", 0.0, 30.0, 0.1),
}


class LivePanel:
    """Lets a person drag the target while the controller follows.

    Attributes:
        follower: The controlled arm.
        active: Whether the arm follows; set it by `set_active`.
    """

    def __init__(self, stage: Stage, follower: Follower, check: CrossCheck | None = None) -> None:
        """Put the controls on the page; the live mode is off."""
        self.follower, self.active = follower, False
        self._stage = stage
        self._check = CrossCheck() if check is None else check
        self._left_over, self._since_readout = 0.0, np.inf
        start = follower.configuration
        self._start = start
        self.target = stage.server.scene.add_transform_controls(
            "/target", scale=0.2, depth_test=False, position=start.position,
            wxyz=wxyz(start.rotation), visible=False,
        )  # fmt: skip
        gui = stage.server.gui
        self._folder = gui.add_folder("Live", visible=False)
        with self._folder:
            self._sliders = {
                name: gui.add_slider(label, low, high, step, getattr(follower.scheme, name))
                for name, (label, low, high, step) in _SLIDERS.items()
            }
            home = gui.add_button("Target back to the start")
            self._facts = gui.add_html("")
            self._bars = gui.add_html("")
        for name, slider in self._sliders.items():
            slider.on_update(self._tuner(name))
        home.on_click(lambda _: self.target_home())

    def set_active(self, active: bool) -> None:
        """Turn the live mode on or off; it goes on where it was."""
        self.active = active
        self.target.visible = self._folder.visible = active
        self._left_over = 0.0
        if active:
            self.tick(0.0)

    def target_home(self) -> None:
        """Put the target back to where the arm started."""
        self.target.position, self.target.wxyz = self._start.position, wxyz(self._start.rotation)

    def tick(self, elapsed: float) -> None:
        """Let the arm follow for `elapsed` seconds and show it."""
        self._left_over += elapsed
        self._since_readout += elapsed
        dt = self.follower.dt
        steps = int(self._left_over / dt)
        self._left_over -= steps * dt
        position = np.array(self.target.position, dtype=np.float64)
        w, x, y, z = np.array(self.target.wxyz, dtype=np.float64)
        rotation = pin.Quaternion(w, x, y, z).normalized().matrix()
        state = None
        for _ in range(min(max(steps, 1), _MOST_STEPS)):
            state = self.follower.step(position, rotation)
        if state is None:
            return
        self._stage.show(state.q)
        if self._since_readout >= READOUT_PERIOD:
            self._since_readout = 0.0
            self._read_out(state)

    def _tuner(self, name: str) -> Any:
        def tune(event: Any) -> None:
            self.follower.tune(**{name: float(event.target.value)})

        return tune

    def _read_out(self, state: FollowerState) -> None:
        gap = self.follower.check(self._check)
        solvers = "+".join(self._check.solvers)
        robot = self.follower.robot
        self._facts.content = readout.facts(
            {
                "status": describe(state),
                "distance to the target": readout.length(state.position_error),
                "angle to the target": f"{state.orientation_error:.2e} rad",
                "KKT residual of the network": f"{state.kkt_residual:.1e}",
                f"cross-check gap ({solvers})": f"{gap:.1e} rad/s",
            }
        )
        self._bars.content = readout.joint_bars(state.q, robot.q_lower, robot.q_upper)


def describe(state: FollowerState) -> str:
    """What the arm is doing, in a few words."""
    if state.share < 1.0:
        return "out of reach" if state.share == 0.0 else "near the edge of its reach"
    arrived = state.position_error < 1e-4 and state.orientation_error < 1e-3
    return "at the target" if arrived else "on its way"
