"""Controls of the live mode: a target to drag, weight and gains, and the controller's state."""

from collections import deque
from collections.abc import Callable
from functools import partial
from itertools import count
from queue import SimpleQueue
from typing import Any

import numpy as np
import pinocchio as pin

from iiwa_dnn.app.viewer import readout
from iiwa_dnn.app.viewer.curves import COLOURS, Curves
from iiwa_dnn.app.viewer.follower import Follower, FollowerState
from iiwa_dnn.app.viewer.stage import Stage, wxyz
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.references import Target
from iiwa_dnn.results.record import FloatArray
from iiwa_dnn.robot.obstacles import Sphere

BALL_RADIUS = 0.08
"""Radius of the ball that is dragged against the arm [m]."""
_MOST_STEPS = 40  # of one tick: a slow machine shows slow motion and does not fall behind for ever
_SLIDERS = {
    "weight": ("ξ weight", 1.0, 0.01),
    "drift_gain": ("m drift [1/s]", 30.0, 0.1),
    "position_gain": ("δ position [1/s]", 30.0, 0.1),
    "orientation_gain": ("ν turn [1/s]", 30.0, 0.1),
}
# Titles and colours of the diagrams; `LivePanel._draw` has their columns.
_CURVES = (
    ("error [m], angle in blue [rad]", COLOURS[:2]),
    ("distance of arm and ball [m]", COLOURS[2:3]),
    ("KKT residual of the network", COLOURS[4:5]),
    ("time to settle a step [s]", COLOURS[5:6]),
)
_SETTLING = "states to answer [rad/s] over time [ρ]"
_LEAST = 1e-12  # what lies below is rounding
_SECONDS, _PATH, _PATH_COLOUR = 20.0, 600, (220, 0, 30)


class LivePanel:
    """Controls by which a person drags the target that the arm follows.

    Attributes:
        follower: The controlled arm.
        active: True while the arm follows; set it by `set_active`.
        target: The target in the scene, as viser moves it.
        curves: Diagrams of the last seconds, as `_CURVES` names them.
        settling: Diagram of the network's states on their way to the answer.
    """

    def __init__(self, stage: Stage, follower: Follower) -> None:
        """Put the controls on the page; the live mode is off."""
        self.follower, self.active = follower, False
        self._stage, self._check = stage, CrossCheck()
        self._left_over, self._since_readout = 0.0, np.inf
        self._wanted: SimpleQueue[Callable[[], None]] = SimpleQueue()
        self._random, self._time, self._count = np.random.default_rng(0), 0.0, count()
        self._samples: deque[list[float]] = deque(maxlen=round(_SECONDS / readout.PERIOD))
        self._path: deque[FloatArray] = deque(maxlen=_PATH)
        self._start = start = follower.configuration
        self.target = stage.host.scene.add_transform_controls(
            "/target", scale=0.2, depth_test=False, position=start.position,
            wxyz=wxyz(start.rotation), visible=False,
        )  # fmt: skip
        gui = stage.host.gui
        self._folder = gui.add_folder("Live", visible=False)
        with self._folder:
            for name, (label, most, step) in _SLIDERS.items():
                value = min(getattr(follower.scheme, name), most)
                follower.tune(**{name: value})
                slider = gui.add_slider(label, 0.0, most, step, value)
                slider.on_update(partial(self._tune, name))
            home = gui.add_button("Target back to the start")
            push = gui.add_button("Push the arm")
            ball = gui.add_checkbox("Ball to push the arm with", False)
            self._facts = gui.add_html("")
            self._bars = gui.add_html("")
        self._diagrams = gui.add_folder("Last 20 s", visible=False)
        with self._diagrams:
            ends = -_SECONDS, 0.0
            self.curves = tuple(Curves(gui, name, lines, ends) for name, lines in _CURVES)
            self.settling = Curves(gui, _SETTLING, COLOURS, (-2.0, 7.0), powers=True)
        home.on_click(lambda _: self.target_home())
        push.on_click(lambda _: self._wanted.put(self._push))
        ball.on_update(lambda _: self.set_ball(ball.value))
        scene = stage.host.scene
        self.ball = scene.add_transform_controls(
            "/ball", scale=0.15, depth_test=False, disable_rotations=True, visible=False
        )
        scene.add_icosphere("/ball/shape", BALL_RADIUS, color=(60, 110, 200), opacity=0.3)
        self._shown = scene.add_icosphere("/ball_now", BALL_RADIUS, (60, 110, 200), visible=False)

    def set_active(self, active: bool) -> None:
        """Turn the live mode on or off; it goes on from its last state."""
        self.active = active
        self.target.visible = self._folder.visible = self._diagrams.visible = active
        self._stage.set_line_visible("followed", active)
        self._left_over = 0.0
        if active:
            self.tick(0.0)

    def target_home(self) -> None:
        """Put the target back to the start of the arm."""
        self.target.position, self.target.wxyz = self._start.position, wxyz(self._start.rotation)

    def set_ball(self, there: bool) -> None:
        """Put a ball that the arm avoids beside it, or take it away, at the next tick."""
        # Not amid a step: the page's buttons have a thread of their own.
        self._wanted.put(partial(self._place_ball, there))

    def _push(self) -> None:
        """Displace the joints in a random direction, by 0.1 rad in all."""
        way = self._random.normal(size=self.follower.robot.dof)
        self.follower.push(0.1 * way / np.linalg.norm(way))

    def _place_ball(self, there: bool) -> None:
        place = self.follower.configuration.position + np.array([0.0, 0.0, 0.35])
        self.follower.avoid(Sphere(place.tolist(), BALL_RADIUS) if there else None)
        self.ball.position = self._shown.position = place
        self.ball.visible = self._shown.visible = there

    def tick(self, elapsed: float) -> None:
        """Let the arm follow for `elapsed` seconds and show it."""
        while not self._wanted.empty():
            self._wanted.get()()
        self._left_over += elapsed
        self._since_readout += elapsed
        dt = self.follower.dt
        steps = int(self._left_over / dt)
        self._left_over -= steps * dt
        position = np.array(self.target.position, dtype=np.float64)
        w, x, y, z = np.array(self.target.wxyz, dtype=np.float64)
        rotation = pin.Quaternion(w, x, y, z).normalized().matrix()
        steps = min(max(steps, 1), _MOST_STEPS)
        self._time += steps * dt
        for _ in range(steps):
            if self.follower.obstacle is not None:
                self._shown.position = self.follower.move_obstacle(self.ball.position)
            state = self.follower.step(position, rotation)
        self._stage.show(state.q)
        self._path.append(self.follower.configuration.position)
        if len(self._path) > 1:
            self._stage.line("followed", np.array(self._path), _PATH_COLOUR, 3.0)
        apart = state.position_error > 1e-3 or state.orientation_error > 1e-2
        self._stage.ghost(Target(position, rotation) if apart else None)
        if self._since_readout >= readout.PERIOD:
            self._since_readout = 0.0
            self._read_out(state)

    def _tune(self, name: str, event: Any) -> None:
        self.follower.tune(**{name: float(event.target.value)})

    def _read_out(self, state: FollowerState) -> None:
        gap = self.follower.check(self._check)
        self._facts.content = readout.facts(
            {
                "status": describe(state),
                "distance to the target": readout.length(state.position_error),
                "angle to the target": f"{state.orientation_error:.2e} rad",
                "KKT residual of the network": f"{state.kkt_residual:.1e}",
                f"cross-check gap ({'+'.join(self._check.solvers)})": f"{gap:.1e} rad/s",
            }
        )
        self._draw(state)
        robot = self.follower.robot
        self._bars.content = readout.joint_bars(state.q, robot.q_lower, robot.q_upper)

    def _draw(self, state: FollowerState) -> None:
        """Add a sample to the curves; draw the settling of the states once a second."""
        errors = state.position_error, state.orientation_error
        sample = (*errors, self.follower.distance, state.kkt_residual, state.seconds)
        self._samples.append([self._time, *sample])
        times, columns = np.split(np.array(self._samples), [1], axis=1)
        if len(times) > 1:
            parts = np.split(columns, [2, 3, 4], axis=1)
            for curve, part in zip(self.curves, parts, strict=True):
                curve.show(times[:, 0] - self._time, np.maximum(part, _LEAST), 0.0)
                curve.handle.visible = bool(np.isfinite(part).any())
        if next(self._count) % 10 == 0:
            times, apart = self.follower.settling()
            self.settling.show(times, np.maximum(apart, _LEAST))


def describe(state: FollowerState) -> str:
    """Describe the arm's progress in a few words."""
    if state.share < 1.0:
        return "out of reach" if state.share == 0.0 else "near the edge of its reach"
    arrived = state.position_error < 1e-4 and state.orientation_error < 1e-3
    return "at the target" if arrived else "on its way"
