"""The replay of a run in the browser, with its path, errors and verdict."""

from __future__ import annotations

import socket
from contextlib import redirect_stdout, suppress
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

from iiwa_dnn import checks
from iiwa_dnn.app.command_line import SETTINGS_FILE
from iiwa_dnn.app.track import load
from iiwa_dnn.errors import FileError, InvalidInputError, import_extra
from iiwa_dnn.files import one_line, read_toml
from iiwa_dnn.naming import describe, in_the_way
from iiwa_dnn.qp.program import Matrix, Vector
from iiwa_dnn.results.failures import failures
from iiwa_dnn.results.metrics import ACTIONS, position_error, rotation_angle
from iiwa_dnn.results.pictures import obstacles_of
from iiwa_dnn.results.plots import envelope
from iiwa_dnn.results.record import Record
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.obstacles import outline
from iiwa_dnn.robot.shapes import read_shapes

PIECES = 300
"""Straight pieces of a drawn path, points of the curve, and parts of the time bar."""

LEAST = 1e-15
"""Least value of the curve [m]: smaller ones are rounding errors."""

_STYLE = """<style>
[style*="max-height: 60%"] { max-height: 40% !important }
[style*="max-height: 60%"], [style*="max-height: 60%"] [style*="width: 20em"] {
    width: 100% !important }
</style>"""
"""On a phone viser's controls would cover 60 % of the height, and leave a strip beside them."""


def open_replay(run: Path, robot: str | None, host: str, port: int) -> Replay:
    """Serve the page of a run, by its folder or its record.

    Raises:
        FileError: There is no record.
        IiwaDnnError: As of `robot_of` and `serve`.
    """
    file = run / "record.npz" if run.is_dir() else run
    if not file.exists():
        raise FileError(file, "no such file: not the folder of a run")
    record = Record.load(file)
    return Replay(robot_of(record, file.with_name(SETTINGS_FILE), robot), record, host, port)


def robot_of(record: Record, settings: Path, name: str | None = None) -> Robot:
    """Load the robot of a record as a settings file describes it, else the record itself.

    Raises:
        InvalidInputError: The robot does not have as many joints as the record.
    """
    kept = record.settings
    table = {"name": kept["robot"], "tip": kept.get("tip"), "locked": list(kept["locked"] or ())}
    if settings.is_file():
        table = {"name": kept["robot"], **read_toml(settings).get("robot", {})}
    robot = load({**table, "name": name or table["name"]})
    if robot.dof != record.dof:
        problem = f"{robot.name} has {robot.dof} free joints, the record {record.dof}"
        raise InvalidInputError("--robot", problem, name)
    checks.finite_array("q0", table.get("q0", record.q[0]), (robot.dof,))
    return robot


def serve(title: str, host: str, port: int) -> Any:
    """Serve an empty page that asks for nothing from elsewhere.

    Raises:
        MissingDependencyError: viser is not installed.
        InvalidInputError: The address cannot be listened on.
    """
    viser = import_extra("viser", "pip install 'iiwa-dnn[view]'")
    try:
        with socket.create_server((host, port)) as probe:  # viser would take another one silently
            free = probe.getsockname()[1]
    except (OSError, OverflowError) as error:
        problem = f"cannot listen on {host}:{port}: {one_line(error)}"
        raise InvalidInputError("--host, --port", problem, (host, port)) from error
    with redirect_stdout(StringIO()):  # its banner
        server = viser.ViserServer(host=host, port=free, label=title, verbose=False)
    server.gui.configure_theme(show_logo=False, show_share_button=False, control_width="large")
    server.gui.add_html(_STYLE)
    server.scene.set_up_direction("+z")
    server.scene.add_grid("/floor", width=3.0, height=3.0, cell_size=0.1, section_size=0.5)
    return server


def show_robot(server: Any, robot: Robot) -> Any:
    """Put a robot on a page, frames where it has no shapes; return Pinocchio's visualizer."""
    from pinocchio.visualize import ViserVisualizer

    shapes = pin.GeometryModel()
    with suppress(ValueError):  # a mesh is missing
        for shape in read_shapes(robot, pin.GeometryType.VISUAL):
            shapes.addGeometryObject(shape)
    visualizer = ViserVisualizer(robot.model, pin.GeometryModel(), shapes)
    visualizer.initViewer(viewer=server, loadModel=True)
    visualizer.displayFrames(shapes.ngeoms == 0)
    return visualizer


def aim(server: Any, point: Vector) -> None:
    """Aim the cameras at the arm and a point in front of it (3,) [m]; on a phone from afar."""
    middle = 0.6 * point + [0.0, 0.0, 0.2]
    side = np.array([point[1], -point[0], 0.0])  # across the way from the base to the point
    view = 1.6 * side + 0.4 * point + [0.0, 0.0, 0.4]
    server.initial_camera.look_at = tuple(middle)
    server.initial_camera.position = tuple(middle + view)

    def step_back(client: Any) -> None:
        if client.camera.aspect < 1.0:
            client.camera.position = tuple(middle + 1.8 * view)
            client.camera.look_at = tuple(middle - [0.0, 0.0, 0.4])

    server.on_client_connect(step_back)


def draw_path(server: Any, name: str, points: Matrix, color: tuple[int, int, int]) -> None:
    """Draw a path through points (M, 3) [m], or draw it anew."""
    chosen = points[np.linspace(0, len(points) - 1, min(len(points), PIECES + 1)).astype(int)]
    pieces = np.stack([chosen[:-1], chosen[1:]], axis=1)
    server.scene.add_line_segments(f"/{name}", pieces, color, line_width=3.0)


class Replay:
    """A page that replays a record, in one state for all browsers.

    Attributes:
        server: The page's ``viser.ViserServer``.
        record: The run.
        playing: Checkbox: the time passes, and begins again at the end.
        clock: Slider: the present time of the record [s].
        marks: Bar below it, red where a policy acted.
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
        path = record.position_desired
        scene = self.server.scene
        draw_path(self.server, "desired", path, (70, 80, 100))
        self._target = scene.add_frame("/target", axes_length=0.06, axes_radius=0.002)
        self.obstacles = [
            (obstacle, scene.add_mesh_simple(f"/obstacle_{i}", *outline(obstacle)))
            for i, obstacle in enumerate(obstacles_of(record))
        ]
        aim(self.server, path.mean(axis=0))
        gui = self.server.gui
        start = float(record.t[0])
        end = max(float(record.t[-1]), start + 1e-6)
        self.playing = gui.add_checkbox("play", False)
        self.clock = gui.add_slider("time [s]", start, end, 1e-3 * (end - start), start)
        self.marks = gui.add_html(self._bar())
        self.speed = gui.add_dropdown("speed", ("0.1", "0.5", "1", "2", "5"), initial_value="1")
        verdict = failures(record) or ["completed within all limits"]
        gui.add_markdown("\n".join(f"- {line}" for line in verdict))
        self._readout = gui.add_markdown("")
        self._errors = np.linalg.norm(position_error(record), axis=1)
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

        times, _, _, errors = envelope(self.record.t, np.maximum(self._errors, LEAST), PIECES)
        self.server.gui.add_uplot(
            (times, np.log10(errors)),
            (uplot.Series(), uplot.Series(stroke="#d6001c", width=1)),
            scales={"x": uplot.Scale(time=False)},
            title="position error, decimal logarithm [m]",
            legend=uplot.Legend(show=False),
            height=170,
        )

    def tick(self, elapsed: float) -> None:
        """Let `elapsed` seconds pass, and show the state if the time has changed."""
        if self.playing.value:
            passed = self.clock.value - self.clock.min + float(self.speed.value) * elapsed
            self.clock.value = self.clock.min + passed % (self.clock.max - self.clock.min)
        if self.clock.value != self._shown:
            self.show()

    def show(self) -> None:
        """Show the sample at the present time."""
        record = self.record
        self._shown = self.clock.value
        k = int(np.searchsorted(record.t, self._shown).clip(0, record.steps))
        self._visualizer.display(record.q[k])
        self._target.position = record.position_desired[k]
        self._target.wxyz = pin.Quaternion(record.rotation_desired[k]).coeffs()[[3, 0, 1, 2]]
        for obstacle, mesh in self.obstacles:
            mesh.position = obstacle.shift(self._shown)
        draw_path(self.server, "drawn", record.position[: k + 2], (220, 0, 30))
        angle = rotation_angle(record.rotation[k], record.rotation_desired[k])
        step = min(k, record.steps - 1)
        acting = [record.filled(column)[step] for column in ("blocking", "blocking_rows")]
        against = map(describe, in_the_way(record.settings, *acting))
        action = ACTIONS.get(int(record.filled("action")[step]), "none")
        rows = [
            f"position error | {self._errors[k]:.3g} m",
            "---|---",
            f"orientation error | {float(angle):.3g} rad",
            f"KKT residual | {record.kkt_residual[step]:.1e}",
            f"gap to the reference | {record.crosscheck_gap[step]:.1e} rad/s",
            f"policy | {', '.join([action, *against])}",
        ]
        for name, q in zip(record.settings["joints"], record.q[k], strict=True):
            rows.append(f"{name} [rad] | {q:+.3f}")
        self._readout.content = "\n".join(f"| {row} |" for row in rows)
