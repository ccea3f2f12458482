"""The arm at work, as a figure of five moments (the paper's Fig. 3) and as a video.

MuJoCo's renderer draws it, without a display. Only shapes are drawn: joint angles come from a
record, nothing is simulated.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.checks import Array
from iiwa_dnn.errors import import_extra
from iiwa_dnn.files import write_atomically
from iiwa_dnn.results.plots import COLUMN, new_figure, write_figures
from iiwa_dnn.results.record import Record
from iiwa_dnn.robot.mujoco_model import (
    VISUAL_GROUP,
    build_spec,
    import_mujoco,
    prepare_renderer,
)
from iiwa_dnn.robot.obstacles import HalfSpace, Obstacle, make_obstacles, outline
from iiwa_dnn.robot.robot import Robot
from iiwa_dnn.robot.shapes import visual_meshes

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOMENTS = 5
"""Pictures in the figure: after each fifth of the run, so at 2, 4, 6, 8 and 10 s of the paper's."""

FRAME_RATE = 25
"""Pictures in a second of the video, which runs in real time."""

SIZE = (960, 540)
"""Width and height of the video [pixel]."""

OBSTACLE_COLOR = (0.25, 0.45, 0.75, 1.0)
_PIECES = 400  # straight ones that a path is drawn with
SCENERY = f"""
<mujoco>
  <visual>
    <headlight ambient="0.4 0.4 0.4" diffuse="0.3 0.3 0.3" specular="0.1 0.1 0.1"/>
    <quality offsamples="4" shadowsize="4096"/>
    <global offwidth="2000" offheight="2000"/>
  </visual>
  <statistic center="0 0 0.4" extent="1.2"/>
  <asset>
    <texture name="sky" type="skybox" builtin="flat" rgb1="1 1 1" rgb2="1 1 1"
      width="16" height="16"/>
    <texture name="tiles" type="2d" builtin="checker" rgb1="0.90 0.91 0.93" rgb2="0.84 0.86 0.89"
      width="256" height="256"/>
    <!-- A repeat has two tiles a side: they are 0.25 m wide. -->
    <material name="floor" texture="tiles" texuniform="true" texrepeat="2 2"/>
  </asset>
  <worldbody>
    <geom type="plane" size="1.25 1.25 0.1" material="floor" group="{VISUAL_GROUP}"
      contype="0" conaffinity="0"/>
    <light type="spot" pos="0.8 -0.6 2.6" dir="-0.25 0.2 -1" diffuse="0.55 0.55 0.55"
      cutoff="60" exponent="1"/>
  </worldbody>
</mujoco>
"""


def save_pictures(robot: Robot, record: Record, folder: Path) -> list[Path]:
    """Write the figure ``moments`` and ``video.mp4`` into a folder; return the figure's files.

    Raises:
        MissingDependencyError: MuJoCo or an OpenGL library is not installed.
        FileError: The folder cannot be written.
    """
    save_video(robot, record, folder / "video.mp4")
    return write_figures({"moments": partial(moments_figure, robot, record)}, folder)


def moments_figure(robot: Robot, record: Record, pixels: int = 560) -> Figure:
    """Draw the arm after each fifth of a run, each picture `pixels` wide and high.

    Raises:
        MissingDependencyError: MuJoCo or an OpenGL library is not installed.
    """
    figure = new_figure(2 * COLUMN, 2 * COLUMN / MOMENTS + 0.2)
    samples = np.linspace(0, record.steps, MOMENTS + 1).astype(int)[1:]
    images = draw_arm(robot, record, samples, (pixels, pixels))
    for panel, sample, image in zip(figure.subplots(1, MOMENTS), samples, images, strict=True):
        panel.imshow(image, interpolation="lanczos")
        panel.set_axis_off()
        panel.set_title(f"$t$ = {record.t[sample]:.3g} s", fontsize=8, pad=3)
    return figure


def save_video(robot: Robot, record: Record, path: str | os.PathLike[str]) -> None:
    """Write a video of the run in real time: MP4 (H.264), which browsers play.

    The old file stays until the new one is whole.

    Raises:
        MissingDependencyError: MuJoCo, an OpenGL library or the encoder is not installed.
        FileError: The file cannot be written.
    """
    imageio = import_extra("imageio.v3", "pip install 'iiwa-dnn[sim]'")
    count = max(1, round(float(record.t[-1] - record.t[0]) * FRAME_RATE)) + 1
    samples = np.linspace(0, record.steps, count).astype(int)
    # The index at the front, so that a page can start to play it at once.
    options = {
        "fps": FRAME_RATE,
        "macro_block_size": 2,
        "output_params": ["-movflags", "+faststart"],
    }
    mp4 = partial(imageio.imwrite, plugin="FFMPEG", extension=".mp4", is_batch=True, **options)
    write_atomically(path, partial(mp4, image=draw_arm(robot, record, samples, SIZE)))


def draw_arm(
    robot: Robot, record: Record, samples: Iterable[int], size: tuple[int, int]
) -> Iterator[NDArray[np.uint8]]:
    """Yield pictures of the arm, with the path so far, at samples of a record, 0 to N each.

    A picture has the shape (height, width, 3) and colors to 255; the size is width by height
    [pixel].

    Raises:
        MissingDependencyError: MuJoCo or an OpenGL library is not installed.
        InvalidInputError: MuJoCo cannot take the robot.
    """
    mujoco = import_mujoco()
    prepare_renderer()  # before the slow part
    obstacles = obstacles_of(record)
    model = build_scene(mujoco, robot, obstacles)
    data = mujoco.MjData(model)
    camera = mujoco.MjvCamera()
    _aim(camera, record)
    options = mujoco.MjvOption()
    options.geomgroup[:] = np.arange(options.geomgroup.size) == VISUAL_GROUP
    options.sitegroup[:] = 0
    corners = np.linspace(0, record.steps, min(record.steps, _PIECES) + 1).astype(int)
    width = max(3.0, size[1] / 130.0)
    with mujoco.Renderer(model, size[1], size[0], model.ngeom + 2 * _PIECES + 10) as renderer:
        for sample in samples:
            data.qpos[:] = record.q[sample]
            for i, obstacle in enumerate(obstacles):
                data.mocap_pos[i] = obstacle.shift(float(record.t[sample]))
            mujoco.mj_forward(model, data)
            renderer.update_scene(data, camera, options)
            # A little farther off than what is drawn, so that it never shows through that.
            behind = 2e-3 * camera.distance * renderer.scene.camera[0].forward
            desired = record.position_desired[corners] + behind
            _add_line(mujoco, renderer.scene, desired, 0.4 * width, (0.2, 0.25, 0.35, 1.0))
            drawn = record.position[[*corners[corners < sample], sample]]
            _add_line(mujoco, renderer.scene, drawn, width, (0.86, 0.0, 0.1, 1.0))
            yield renderer.render()


def build_scene(
    mujoco: Any, robot: Robot, obstacles: Iterable[Obstacle], scenery: str = SCENERY
) -> Any:
    """Compile MuJoCo's model of robot, floor, light, and obstacles that can be displaced."""
    spec = mujoco.MjSpec.from_string(scenery)
    arm = build_spec(robot)
    shell = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
    shape = {
        "type": mujoco.mjtGeom.mjGEOM_MESH,
        "group": VISUAL_GROUP,
        "contype": 0,
        "conaffinity": 0,
    }
    for i, (part, corners, faces) in enumerate(visual_meshes(robot)):
        name = f"mesh_{i}"
        arm.add_mesh(name=name, uservert=corners.ravel(), userface=faces.ravel(), inertia=shell)
        joint = robot.model.names[part.parentJoint]
        body = arm.joint(joint).parent if part.parentJoint else arm.worldbody
        body.add_geom(meshname=name, rgba=[*part.meshColor[:3], 1.0], **shape)
    spec.attach(arm, prefix="arm_", frame=spec.worldbody.add_frame())
    for i, obstacle in enumerate(obstacles):
        body = spec.worldbody.add_body(name=f"obstacle_{i}", mocap=True)
        vertices, triangles = outline(obstacle)
        spec.add_mesh(name=body.name, uservert=vertices.ravel(), userface=triangles.ravel())
        body.add_geom(meshname=body.name, rgba=OBSTACLE_COLOR, **shape)
    return spec.compile()


def _add_line(
    mujoco: Any, scene: Any, points: Array, width: float, color: tuple[float, ...]
) -> None:
    """Add a path (M, 3) [m] to the scene as lines of this width [pixel]."""
    kind = mujoco.mjtGeom.mjGEOM_LINE
    for start, end in pairwise(points):
        geom = scene.geoms[scene.ngeom]
        mujoco.mjv_initGeom(geom, kind, np.zeros(3), start, np.eye(3).ravel(), color)
        mujoco.mjv_connector(geom, kind, width, start, end)
        geom.emission = 1.0  # the color as it is, whatever the light
        scene.ngeom += 1


def obstacles_of(record: Record) -> list[Obstacle]:
    """Return the obstacles of a record that can be drawn: no half-spaces."""
    made = make_obstacles((record.settings.get("collisions") or {}).get("obstacles", []))
    return [obstacle for obstacle in made if not isinstance(obstacle, HalfSpace)]


def _aim(camera: Any, record: Record) -> None:
    """Aim a camera at arm and path, from the side of the path."""
    path = record.position_desired.mean(axis=0)
    radius = max(float(np.linalg.norm(record.position, axis=1).max()), 0.4)
    camera.lookat[:] = 0.72 * path + np.array([0.0, 0.0, 0.2 * radius])
    camera.distance = 1.6 * radius
    # MuJoCo's azimuth is the direction of sight; from the front no link hides the path.
    camera.azimuth = np.degrees(np.arctan2(path[1], path[0])) + 205.0
    camera.elevation = -36.0
