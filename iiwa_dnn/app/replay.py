"""``view``: the replay of a run in the browser, with its path, errors and verdict."""

import signal
import socket
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import pinocchio as pin
from tyro.conf import Positional

from iiwa_dnn import InvalidInputError, Record, Robot, compute_metrics
from iiwa_dnn.app.command_line import SETTINGS_FILE, shown
from iiwa_dnn.app.recording import read_recording, replayed
from iiwa_dnn.app.settings import load
from iiwa_dnn.errors import import_extra
from iiwa_dnn.files import one_line, read_toml
from iiwa_dnn.naming import ACTIONS, active_limits, describe
from iiwa_dnn.qp.program import Matrix, Vector
from iiwa_dnn.results.metrics import orientation_error, position_error
from iiwa_dnn.results.pictures import obstacles_of
from iiwa_dnn.results.plots import envelope
from iiwa_dnn.results.report import markdown_table, verdict
from iiwa_dnn.robot.obstacles import make_obstacles, outline
from iiwa_dnn.robot.shapes import visual_shapes

PIECES = 300
"""Straight pieces of a drawn path, points of the curve, and parts of the time bar."""


def view(
    run: Positional[Path],
    *,
    robot: Annotated[str | None, shown("NAME")] = None,
    host: str = "127.0.0.1",
    port: int = 8080,
) -> int:
    """Replay a run in the browser.

    Args:
        run: folder or record of a run
        robot: robot of the run, by name or file, if its own is elsewhere now
        host: address of the page; 0.0.0.0 lets other machines in
        port: port of the page; 0 takes a free one
    """
    file = run / "record.npz" if run.is_dir() else run
    record = Record.load(file)
    # Not by exceptions: modules that viser imports swallow those.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    replay = Replay(
        robot_of(record.settings, file.with_name(SETTINGS_FILE), robot), record, host, port
    )
    print(f"open http://{host}:{replay.server.get_port()} in a browser; Ctrl-C ends it", flush=True)
    while True:
        time.sleep(1 / 30)
        replay.tick(1 / 30)


def robot_of(kept: Mapping[str, Any], settings: Path, name: str | None = None) -> Robot:
    """Load a record's robot by its settings file; without one, by the record's own settings `kept`.

    Raises:
        InvalidInputError: The robot's joints are not those of the record.
    """
    tools = kept.get("tools", [])
    tip = tools[0]["flange"] if tools else kept.get("tip")
    table = {"name": kept["robot"], "tip": tip, "locked": list(kept["locked"] or ())}
    if settings.is_file():
        table |= read_toml(settings).get("robot", {})
    robot: Robot = load({**table, "name": name or table["name"]})
    for tool in () if robot.tools else tools:
        shapes = make_obstacles(tool["tool_shapes"])
        robot = robot.with_tool(tool["tool"], tool["name"], shapes)
    if list(robot.joint_names) != kept["joints"]:
        problem = f"{robot.name} has other joints than the record: {' '.join(robot.joint_names)}"
        raise InvalidInputError("--robot", problem, name)
    return robot


def replay(
    recording: Positional[Path], *, robot: Annotated[str | None, shown("NAME")] = None
) -> int:
    """Judge a recording of a shield's steps on an arm; write a report, and a file to attach.

    Args:
        recording: folder that `armstep.recorded` wrote
        robot: robot of the recording, by name or file, if its own is elsewhere now
    """
    head, rows = read_recording(recording)
    own = robot_of(head["tables"]["robot"], recording / SETTINGS_FILE, robot)
    findings, file = replayed(recording, head, rows, own)
    print(*findings, f"report: {recording / 'report.md'}; to attach: {file}", sep="\n")
    return int(len(findings) > 0)


def serve(title: str, host: str, port: int) -> Any:
    """Serve an empty page without external resources.

    Raises:
        MissingDependencyError: viser is not installed.
        InvalidInputError: The address cannot be listened on.
    """
    viser = import_extra("viser", "pip install 'iiwa-dnn[view]'")
    try:
        with socket.socket() as probe:  # viser would take another one silently
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            probe.bind((host, port))
    except (OSError, OverflowError) as error:
        problem = f"cannot listen on {host}:{port}: {one_line(error)}"
        raise InvalidInputError("--host, --port", problem, (host, port)) from error
    server = viser.ViserServer(host=host, port=port, label=title, verbose=False)
    server.gui.configure_theme(show_logo=False, show_share_button=False, control_width="large")
    server.scene.add_grid("/floor", width=3.0, height=3.0, cell_size=0.1, section_size=0.5)
    return server


def show_robot(server: Any, robot: Robot) -> Any:
    """Put a robot on a page, frames where it has no shapes; return Pinocchio's visualizer."""
    from pinocchio.visualize import ViserVisualizer

    shapes = visual_shapes(robot)
    visualizer = ViserVisualizer(robot.model, pin.GeometryModel(), shapes)
    visualizer.initViewer(viewer=server, loadModel=True)
    visualizer.displayFrames(shapes.ngeoms == 0)
    return visualizer


def aim(server: Any, point: Vector) -> None:
    """Aim the cameras at the arm and a point before it (3,) [m]."""
    middle = 0.6 * point + [0.0, 0.0, 0.2]
    # The first vector lies across the line from the base to the point.
    view = 1.6 * np.array([point[1], -point[0], 0.0]) + 0.4 * point + [0.0, 0.0, 0.4]
    server.initial_camera.look_at = tuple(middle)
    server.initial_camera.position = tuple(middle + view)


def draw_path(server: Any, name: str, points: Matrix, color: tuple[int, int, int]) -> None:
    """Draw a path through points (M, 3) [m] in place of the one of the same name."""
    chosen = points[np.linspace(0, len(points) - 1, min(len(points), PIECES + 1)).astype(int)]
    pieces = np.stack([chosen[:-1], chosen[1:]], axis=1)
    server.scene.add_line_segments(
        f"/{name}", pieces, color, thickness=3.0, thickness_units="screen"
    )


class Replay:
    """A page that replays a record, in one state for all browsers.

    Attributes:
        server: The page's ``viser.ViserServer``.
        record: The run.
        playing: Checkbox: whether the time advances; after the end it begins again.
        clock: Slider: time of the record that is shown [s].
        marks: Bar below the slider, red at times at which a policy acted.
        speed: Menu: seconds of the record in a second.
        obstacles: Obstacles, and their meshes on the page.
    """

    def __init__(
        self, robot: Robot, record: Record, host: str = "127.0.0.1", port: int = 8080
    ) -> None:
        """Serve the page; `tick` moves it. Errors as of `serve`."""
        self.record = record
        self.server = serve(f"{robot.name} · iiwa_dnn", host, port)
        self._visualizer = show_robot(self.server, robot)
        scene = self.server.scene
        draw_path(self.server, "desired", record.position_desired, (70, 80, 100))
        self.obstacles = [
            (obstacle, scene.add_mesh_simple(f"/obstacle_{i}", *outline(obstacle)))
            for i, obstacle in enumerate(obstacles_of(record))
        ]
        aim(self.server, record.position_desired.mean(axis=0))
        gui = self.server.gui
        end = max(float(record.t[-1]), 1e-6)
        self.playing = gui.add_checkbox("play", False)
        self.clock = gui.add_slider("time [s]", 0.0, end, 1e-3 * end, 0.0)
        self.marks = gui.add_html(self._bar())
        self.speed = gui.add_dropdown("speed", ("0.1", "0.5", "1", "2", "5"), initial_value="1")
        gui.add_markdown("\n".join(f"- {line}" for line in verdict(compute_metrics(record))))
        self._readout = gui.add_markdown("")
        self._distances = np.linalg.norm(position_error(record), axis=1)
        self._angles = orientation_error(record)
        self._add_curve()
        self.show()

    def _bar(self) -> str:
        """Return the bar of time, red where a policy acted."""
        acts = envelope(self.record.t[:-1], self.record.filled("action"), PIECES)[3]
        colors = np.where(acts > 0, "#d6001c", "#e5e7ec")
        parts = "".join(f'<i style="flex:1;background:{color}"></i>' for color in colors)
        return f'<div style="display:flex;height:6px;margin:0 1em">{parts}</div>'

    def _add_curve(self) -> None:
        """Draw the largest position error of each stretch of time, by its decimal logarithm."""
        from viser import uplot  # of an extra

        shown = np.maximum(self._distances, 1e-15)  # less is rounding
        times, _, _, errors = envelope(self.record.t, shown, PIECES)
        self.server.gui.add_uplot(
            (times, np.log10(errors)),
            (uplot.Series(), uplot.Series(stroke="#d6001c", width=1)),
            scales={"x": uplot.Scale(time=False)},
            title="position error, decimal logarithm [m]",
            legend=uplot.Legend(show=False),
            height=170,
        )

    def tick(self, elapsed: float) -> None:
        """Advance the clock by `elapsed` seconds if the replay plays; show the new state."""
        if self.playing.value:
            passed = self.clock.value + float(self.speed.value) * elapsed
            self.clock.value = passed % self.clock.max
        if self.clock.value != self._shown:
            self.show()

    def show(self) -> None:
        """Show the sample at the present time."""
        record = self.record
        self._shown = self.clock.value
        k = int(np.searchsorted(record.t, self._shown).clip(0, record.steps))
        self._visualizer.display(record.q[k])
        for obstacle, mesh in self.obstacles:
            mesh.position = obstacle.shift(self._shown)
        draw_path(self.server, "drawn", record.position[: k + 2], (220, 0, 30))
        step = min(k, record.steps - 1)
        acting = [record.filled(column)[step] for column in ("limiting", "limiting_rows")]
        action = ACTIONS.get(int(record.filled("action")[step]), "none")
        rows = [
            ("position error", f"{self._distances[k]:.3g} m"),
            ("orientation error", f"{self._angles[k]:.3g} rad"),
            ("KKT residual", f"{record.kkt_residual[step]:.1e}"),
            ("gap to the reference", f"{record.crosscheck_gap[step]:.1e} rad/s"),
            (
                "policy",
                ", ".join([action, *map(describe, active_limits(record.settings, *acting))]),
            ),
        ]
        joints = zip(record.settings["joints"], record.q[k], strict=True)
        rows += [(f"{name} [rad]", f"{q:+.3f}") for name, q in joints]
        self._readout.content = markdown_table(rows[0], rows[1:])
