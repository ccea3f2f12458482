"""The live mode: a target to drag, controls of the scheme, and diagrams of the last seconds."""

from collections import deque
from collections.abc import Callable
from functools import partial
from queue import SimpleQueue
from typing import Any

import numpy as np
import pinocchio as pin

from iiwa_dnn.app.viewer import readout
from iiwa_dnn.app.viewer.curves import COLORS, Curves
from iiwa_dnn.app.viewer.follower import Ball, Follower, FollowerState
from iiwa_dnn.app.viewer.readout import Readout
from iiwa_dnn.app.viewer.stage import Stage, wxyz
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.references import Target
from iiwa_dnn.results.record import FloatArray

BALL_RADIUS = 0.08
"""Radius of the ball that is dragged against the arm [m]."""

_MOST_STEPS = 40  # of one tick, so that a slow machine shows slow motion
_SLIDERS = {
    "weight": ("ξ weight", 1.0, 0.01),
    "drift_gain": ("m drift [1/s]", 30.0, 0.1),
    "position_gain": ("δ position [1/s]", 30.0, 0.1),
    "orientation_gain": ("ν turn [1/s]", 30.0, 0.1),
}
_SECONDS = 20.0  # of the diagrams
_TITLES = {
    "error [m], angle in blue [rad]": COLORS[:2],
    "distance of arm and ball [m]": COLORS[2:3],
    "KKT residual of the network": COLORS[4:5],
    "time to settle a step [s]": COLORS[5:6],
}
_SETTLING = "states to answer [rad/s] over time [ρ]"
_SETTLING_PERIOD = 10  # samples between two diagrams of the settling
_PATH_POINTS = 600
_PATH_COLOR = (220, 0, 30)
_BALL_COLOR = (60, 110, 200)


class LiveDiagrams:
    """Diagrams of the last seconds, and of the network's states on their way to the answer.

    Attributes:
        recent: Diagrams over time: errors, distance of the ball, residual, duration of a step.
        settling: Distances of the states from the answer over the network's time.
    """

    def __init__(self, gui: Any) -> None:
        """Put empty diagrams on a page."""
        ends = (-_SECONDS, 0.0)
        self.recent = [Curves(gui, title, colors, ends) for title, colors in _TITLES.items()]
        self.settling = Curves(gui, _SETTLING, COLORS, (-2.0, 7.0), powers=True)
        self._samples: deque[list[float]] = deque(maxlen=round(_SECONDS / readout.PERIOD))
        self._count = 0

    def add(self, state: FollowerState, follower: Follower) -> None:
        """Add the state of a follower; draw the settling once a second."""
        errors = (state.position_error, state.orientation_error)
        residual = state.command.solution.residuals.largest
        values = (*errors, follower.distance, residual, state.seconds)
        self._samples.append([follower.time, *values])
        times, *columns = np.split(np.array(self._samples), [1, 3, 4, 5], axis=1)
        if len(times) > 1:
            for curves, column in zip(self.recent, columns, strict=True):
                curves.show(times[:, 0] - follower.time, column, 0.0)
                curves.handle.visible = bool(np.isfinite(column).any())
        if self._count % _SETTLING_PERIOD == 0:
            self.settling.show(*follower.settling())
        self._count += 1


class BallHandle:
    """A ball in the scene that a person drags, and the ball that follows it and is avoided.

    Attributes:
        handle: The ball to drag, as viser moves it.
    """

    def __init__(self, scene: Any) -> None:
        """Put both on the scene, invisible."""
        self.handle = scene.add_transform_controls(
            "/ball", scale=0.15, depth_test=False, disable_rotations=True, visible=False
        )
        scene.add_icosphere("/ball/shape", BALL_RADIUS, color=_BALL_COLOR, opacity=0.3)
        self._avoided = scene.add_icosphere("/ball_now", BALL_RADIUS, _BALL_COLOR, visible=False)

    def place(self, position: FloatArray, visible: bool) -> None:
        """Put both at a point (3,) [m], and show or hide them there."""
        for ball in (self.handle, self._avoided):
            ball.position = position
            ball.visible = visible

    def move(self, ball: Ball, dt: float) -> None:
        """Let the avoided ball move towards the dragged one for a time [s]."""
        ball.move(self.handle.position, dt)
        self._avoided.position = ball.position


class LivePanel:
    """Controls by which a person drags the target that the arm follows.

    Attributes:
        follower: The controlled arm.
        active: True while the arm follows; set it by `set_active`.
        target: The target in the scene, as viser moves it.
        ball: The ball in the scene.
        diagrams: Diagrams of the last seconds.
    """

    def __init__(self, stage: Stage, follower: Follower) -> None:
        """Put the controls on the page; the live mode is off."""
        self.follower = follower
        self.active = False
        self._stage = stage
        self._start = follower.configuration
        self._left_over = 0.0
        # The page's buttons have a thread of their own, steps are taken in `tick`.
        self._requests: SimpleQueue[Callable[[], None]] = SimpleQueue()
        self._path: deque[FloatArray] = deque(maxlen=_PATH_POINTS)
        scene = stage.host.scene
        self.target = scene.add_transform_controls(
            "/target", scale=0.2, depth_test=False, visible=False
        )
        self.move_target_home()
        self.ball = BallHandle(scene)
        gui = stage.host.gui
        controls = gui.add_folder("Live", visible=False)
        diagrams = gui.add_folder("Last 20 s", visible=False)
        self._hidden = (controls, diagrams, self.target)
        with controls:
            self._add_controls(gui)
            self._readout = Readout(gui)
        with diagrams:
            self.diagrams = LiveDiagrams(gui)

    def _add_controls(self, gui: Any) -> None:
        for name, (label, most, step) in _SLIDERS.items():
            value = min(getattr(self.follower.scheme, name), most)
            self.follower.tune(**{name: value})
            slider = gui.add_slider(label, 0.0, most, step, value)
            slider.on_update(partial(self._tune, name))
        random = np.random.default_rng(0)
        gui.add_button("Target back to the start").on_click(lambda _: self.move_target_home())
        gui.add_button("Push the arm").on_click(lambda _: self.push(random))
        ball = gui.add_checkbox("Ball to push the arm with", False)
        ball.on_update(lambda _: self.set_ball(ball.value))

    def set_active(self, active: bool) -> None:
        """Turn the live mode on or off; it goes on from its last state."""
        self.active = active
        for part in self._hidden:
            part.visible = active
        self._stage.set_line_visible("followed", active)
        if active:
            self.tick(0.0)

    def move_target_home(self) -> None:
        """Put the target back to the start of the arm."""
        self.target.position = self._start.position
        self.target.wxyz = wxyz(self._start.rotation)

    def push(self, random: np.random.Generator) -> None:
        """Displace the joints in a random direction by 0.1 rad in all, at the next tick."""
        direction = random.normal(size=self.follower.robot.dof)
        shift = 0.1 * direction / np.linalg.norm(direction)
        self._requests.put(partial(self.follower.push, shift))

    def set_ball(self, visible: bool) -> None:
        """Put a ball that the arm avoids above it, or take it away, at the next tick."""
        self._requests.put(partial(self._set_ball, visible))

    def _set_ball(self, visible: bool) -> None:
        position = self.follower.configuration.position + np.array([0.0, 0.0, 0.35])
        self.follower.avoid(Ball(position, BALL_RADIUS) if visible else None)
        self.ball.place(position, visible)

    def tick(self, elapsed: float) -> None:
        """Let the arm follow for `elapsed` seconds and show it."""
        while not self._requests.empty():
            self._requests.get()()
        position = np.array(self.target.position, dtype=np.float64)
        w, x, y, z = np.array(self.target.wxyz, dtype=np.float64)
        rotation = pin.Quaternion(w, x, y, z).normalized().matrix()
        periods, self._left_over = divmod(self._left_over + elapsed, self.follower.dt)
        for _ in range(min(max(int(periods), 1), _MOST_STEPS)):
            if self.follower.ball is not None:
                self.ball.move(self.follower.ball, self.follower.dt)
            state = self.follower.step(position, rotation)
        self._stage.show(state.q)
        self._path.append(self.follower.configuration.position)
        if len(self._path) > 1:
            self._stage.line("followed", np.array(self._path), _PATH_COLOR, 3.0)
        target = Target(position, rotation)
        self._stage.ghost(target, state.position_error, state.orientation_error)
        if self._readout.is_due(elapsed):
            self._readout.show(self._values(state), self.follower.robot, state.q)
            self.diagrams.add(state, self.follower)

    def _tune(self, name: str, event: Any) -> None:
        self.follower.tune(**{name: float(event.target.value)})

    def _values(self, state: FollowerState) -> dict[str, str]:
        """Return the state of the arm in words."""
        check = CrossCheck()
        gap = self.follower.check(check)
        return {
            "status": describe(state),
            "distance to the target": readout.length(state.position_error),
            "angle to the target": f"{state.orientation_error:.2e} rad",
            "KKT residual of the network": f"{state.command.solution.residuals.largest:.1e}",
            f"cross-check gap ({'+'.join(check.solvers)})": f"{gap:.1e} rad/s",
        }


def describe(state: FollowerState) -> str:
    """Describe the arm's progress in a few words."""
    if not state.command.ok:
        resolution = state.command.resolution
        against = ", ".join(resolution.against) if resolution is not None else ""
        return f"held back by {against}" if against else "out of reach"
    arrived = state.position_error < 1e-4 and state.orientation_error < 1e-3
    return "at the target" if arrived else "on its way"
