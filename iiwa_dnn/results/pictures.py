"""The arm at work, as a figure of five moments (the paper's Fig. 3) and as a video.

MuJoCo's renderer draws it, without a display. Only shapes are drawn: joint angles come from a
record, nothing is simulated.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.errors import FileError, import_extra
from iiwa_dnn.files import one_line, write_atomically
from iiwa_dnn.results.plots import DOUBLE_COLUMN, new_figure, write_figures
from iiwa_dnn.results.record import FloatArray, Record
from iiwa_dnn.results.scenery import SCENERY_GROUP, add_meshes, add_obstacles, make_scenery
from iiwa_dnn.robot.mujoco_model import VISUAL_GROUP, build_spec
from iiwa_dnn.robot.offscreen import import_mujoco, prepare_renderer
from iiwa_dnn.robot.robot import Robot

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Image = NDArray[np.uint8]
View = Literal["arm", "path"]

MOMENTS = 5
"""Pictures in the figure: after each fifth of the run, so at 2, 4, 6, 8 and 10 s of the paper's."""

FRAME_RATE = 25
"""Pictures in a second of the video, which runs in real time."""

WIDTH = 960  # of the video [pixel]
HEIGHT = 540
SIDE = 420  # width of the path on its right
_DESIRED = (0.2, 0.25, 0.35, 1.0)
_DRAWN = (0.86, 0.0, 0.1, 1.0)
_REMEDY = "pip install 'iiwa-dnn[sim]'"
_PIECES = 400  # straight ones that a path is drawn with
_ENCODING: dict[str, Any] = {
    "codec": "libx264",
    "quality": None,
    "macro_block_size": 2,
    "ffmpeg_log_level": "error",
    # Good quality; the index at the front, so that a page can start to play it at once.
    "output_params": ["-crf", "20", "-preset", "fast", "-movflags", "+faststart"],
}


def save_moments(robot: Robot, record: Record, folder: str | os.PathLike[str]) -> list[Path]:
    """Write ``moments.png`` and ``moments.pdf`` into a folder, made if need be; return the files.

    Raises:
        MissingDependencyError: MuJoCo or an OpenGL library is not installed.
        FileError: The folder cannot be written.
    """
    return write_figures({"moments": partial(moments_figure, robot, record)}, folder)


def moments_figure(robot: Robot, record: Record, pixels: int = 560) -> Figure:
    """Draw the arm after each fifth of a run, and below each the path so far, face on.

    Each picture is `pixels` wide and high.

    Raises:
        MissingDependencyError: MuJoCo or an OpenGL library is not installed.
    """
    figure = new_figure(DOUBLE_COLUMN, 2.0 * DOUBLE_COLUMN / MOMENTS + 0.2)
    layout: Any = figure.get_layout_engine()
    layout.set(w_pad=0.02, h_pad=0.02, wspace=0.0, hspace=0.0)
    times = np.linspace(record.t[0], record.t[-1], MOMENTS + 1)[1:]
    views: tuple[View, View] = ("arm", "path")
    for panels, view in zip(figure.subplots(2, MOMENTS), views, strict=True):
        with ArmRenderer(robot, record, pixels, pixels, view) as renderer:
            for panel, t in zip(panels, times, strict=True):
                panel.imshow(renderer.draw(sample_at(record, t)), interpolation="lanczos")
                panel.set_axis_off()
                if view == "arm":
                    panel.set_title(f"$t$ = {t:.3g} s", fontsize=8, pad=3)
    return figure


def save_video(
    robot: Robot,
    record: Record,
    path: str | os.PathLike[str],
    progress: Callable[[int], object] | None = None,
) -> Path:
    """Write a video of the run in real time: MP4 (H.264), which browsers play.

    The old file stays until the new one is whole. `progress` is called after each picture with 1.

    Raises:
        MissingDependencyError: MuJoCo, an OpenGL library or the encoder is not installed.
        FileError: The file cannot be written.
    """
    encoder = import_encoder()
    path = Path(path)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "video.mp4"
        try:
            with encoder.get_writer(file, fps=FRAME_RATE, **_ENCODING) as writer:
                for frame in frames(robot, record):
                    writer.append_data(frame)
                    if progress is not None:
                        progress(1)
        except OSError as error:
            raise FileError(path, f"cannot be encoded ({one_line(error)})") from error
        write_atomically(path, lambda target: target.write(file.read_bytes()))
    return path


def import_encoder() -> Any:
    """Import the writer of videos, a part of the extra ``sim``; raises MissingDependencyError."""
    import_extra("imageio_ffmpeg", _REMEDY)
    return import_extra("imageio.v2", _REMEDY)


def frames(robot: Robot, record: Record) -> Iterator[Image]:
    """Draw the video's pictures, (HEIGHT, WIDTH, 3): the arm, beside it the path, the time."""
    from PIL import Image as PillowImage, ImageDraw, ImageFont

    font = ImageFont.load_default(22)
    count = max(1, round(float(record.t[-1] - record.t[0]) * FRAME_RATE)) + 1
    with ExitStack() as stack:
        left = WIDTH - SIDE
        arm = stack.enter_context(ArmRenderer(robot, record, left, HEIGHT, "arm", smooth=False))
        path = stack.enter_context(ArmRenderer(robot, record, SIDE, HEIGHT, "path"))
        for t in np.linspace(record.t[0], record.t[-1], count):
            sample = sample_at(record, t)
            frame = np.hstack([arm.draw(sample), path.draw(sample)])
            frame[:, left : left + 2] = 160  # a border
            picture = PillowImage.fromarray(frame)
            ImageDraw.Draw(picture).text((16, 12), f"t = {t:5.2f} s", fill=(40, 40, 40), font=font)
            yield np.asarray(picture)


def sample_at(record: Record, t: float) -> int:
    """Return the index of the record's sample nearest to a time [s]."""
    return int(np.abs(record.t - t).argmin())


class ArmRenderer(AbstractContextManager["ArmRenderer"]):
    """A renderer of an arm that follows a record, with the path so far; a context manager."""

    def __init__(
        self,
        robot: Robot,
        record: Record,
        width: int = 960,
        height: int = 540,
        view: View = "arm",
        smooth: bool = True,
    ) -> None:
        """Lay out the scene around the arm and the record's path.

        Pictures are `width` by `height` [pixel] and show ``"arm"``, all of it with the paths of all
        tracked frames, or ``"path"``, the tip's alone and face on. Smooth edges double the time in
        software.

        Raises:
            MissingDependencyError: MuJoCo or an OpenGL library is not installed.
            InvalidInputError: MuJoCo cannot take the robot.
        """
        self._mj = import_mujoco()
        prepare_renderer()  # before the slow part
        self._record = record
        self._view = view
        arm = build_spec(robot)
        if view == "arm":
            add_meshes(self._mj, arm, robot)
        spec = make_scenery(self._mj, record)
        spec.attach(arm, prefix="arm_", frame=spec.worldbody.add_frame())
        self._obstacles = add_obstacles(self._mj, spec, record)
        model = spec.compile()
        model.vis.global_.offwidth = width
        model.vis.global_.offheight = height
        model.vis.quality.offsamples = 4 if smooth else 0
        model.vis.quality.shadowsize = 4096 if smooth else 1024
        self._data = self._mj.MjData(model)
        self._camera = self._mj.MjvCamera()
        if view == "arm":
            self._pose(0)
            _aim_at_arm(self._camera, record, float(self._data.xpos[:, 2].max()))
        else:
            _aim_at_path(self._camera, record)
            self._camera.distance *= max(1.0, height / width)  # its angle is that of the height
        self._options = self._mj.MjvOption()
        self._options.sitegroup[:] = 0
        self._options.geomgroup[:] = 0
        self._options.geomgroup[SCENERY_GROUP] = 1
        self._options.geomgroup[VISUAL_GROUP] = view == "arm"
        self._paths = _paths(record, view)
        most = model.ngeom + 2 * _PIECES * len(self._paths) + 10
        self._renderer = self._mj.Renderer(model, height, width, most)
        self._renderer.scene.flags[self._mj.mjtRndFlag.mjRND_SHADOW] = view == "arm"

    def __exit__(self, *_: object) -> None:
        """Give the OpenGL context back."""
        self._renderer.close()

    def draw(self, sample: int) -> Image:
        """Draw the arm at a sample of the record, 0 to N: (height, width, 3), colors to 255."""
        self._pose(sample)
        renderer = self._renderer
        renderer.update_scene(self._data, self._camera, self._options)
        width = max(3.0, renderer.height / 130.0)
        # A little farther off than what is drawn, so that it never shows through that.
        behind = 2e-3 * self._camera.distance * renderer.scene.camera[0].forward
        steps = self._record.steps
        corners = np.linspace(0, steps, min(steps, _PIECES) + 1).astype(int)
        for desired, drawn in self._paths:
            self._line(desired[corners] + behind, 0.4 * width, _DESIRED)
            self._line(drawn[[*corners[corners < sample], sample]], width, _DRAWN)
        if self._view == "path":  # a dot for the tip
            size = 0.008 * self._camera.distance
            sphere = self._mj.mjtGeom.mjGEOM_SPHERE
            self._geom(sphere, (0.0, 0.0, 0.0, 1.0), size, self._record.position[sample])
        image: Image = renderer.render()
        return image

    def _pose(self, sample: int) -> None:
        """Bring the arm and the obstacles to where they are at a sample."""
        self._data.qpos[:] = self._record.q[sample]
        for i, obstacle in enumerate(self._obstacles):
            self._data.mocap_pos[i] = obstacle.shift(float(self._record.t[sample]))
        self._mj.mj_kinematics(self._data.model, self._data)
        self._mj.mj_camlight(self._data.model, self._data)

    def _line(self, points: FloatArray, width: float, color: tuple[float, ...]) -> None:
        """Add a path (M, 3) [m] to the scene as lines of this width [pixel]."""
        line = self._mj.mjtGeom.mjGEOM_LINE
        for start, end in pairwise(points):
            geom = self._geom(line, color, 0.0, start)
            self._mj.mjv_connector(geom, line, width, start, end)
            geom.emission = 1.0  # the color as it is, whatever the light

    def _geom(self, kind: Any, color: tuple[float, ...], size: float, at: FloatArray) -> Any:
        """Add a shape to the scene."""
        scene = self._renderer.scene
        geom = scene.geoms[scene.ngeom]
        rgba = np.array(color, dtype=np.float32)
        self._mj.mjv_initGeom(geom, kind, np.full(3, size), at, np.eye(3).ravel(), rgba)
        scene.ngeom += 1
        return geom


def _paths(record: Record, view: View) -> list[tuple[FloatArray, FloatArray]]:
    """Return the desired and the drawn path, (N+1, 3) each: the tip's, of the arm all frames'."""
    paths = [(record.position_desired, record.position)]
    if view == "arm":
        desired = record.frame_position_desired.swapaxes(0, 1)
        paths += zip(desired, record.frame_position.swapaxes(0, 1), strict=True)
    return paths


def _aim_at_arm(camera: Any, record: Record, top: float) -> None:
    """Aim a camera at the whole arm, up to its top [m], from beside the path."""
    path = record.position_desired.mean(axis=0)
    radius = max(float(np.linalg.norm(record.position, axis=1).max()), 0.4)
    camera.lookat[:] = 0.5 * path + np.array([0.0, 0.0, 0.26 * radius])
    camera.distance = 1.8 * radius
    if top > 1.1 * radius:  # a head, for example
        camera.lookat[2] = 0.5 * top
        camera.distance = 1.8 * top
    # MuJoCo's azimuth is the direction of sight.
    camera.azimuth = np.degrees(np.arctan2(path[1], path[0])) + 120.0
    camera.elevation = -38.0


def _aim_at_path(camera: Any, record: Record) -> None:
    """Aim a camera at the path's own plane, from above where it can."""
    path = record.position_desired
    camera.lookat[:] = 0.5 * (path.min(axis=0) + path.max(axis=0))
    normal = np.linalg.svd(path - path.mean(axis=0), full_matrices=False)[2][-1]
    sight = -normal if normal[2] >= 0.0 else normal
    camera.distance = max(2.2 * float(np.ptp(path, axis=0).max()), 0.05)
    camera.elevation = np.degrees(np.arcsin(np.clip(sight[2], -1.0, 1.0)))
    level = float(np.hypot(sight[0], sight[1]))
    camera.azimuth = 90.0 if level < 1e-6 else np.degrees(np.arctan2(sight[1], sight[0]))
