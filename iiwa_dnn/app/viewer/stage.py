"""The three-dimensional part of the page: the robot, the floor and the paths."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import pinocchio as pin

from iiwa_dnn.results.record import FloatArray
from iiwa_dnn.results.scenery import OBSTACLE_COLOUR
from iiwa_dnn.robot.obstacles import HalfSpace, Obstacle, outline
from iiwa_dnn.robot.robot import Robot
from iiwa_dnn.robot.shapes import joint_poses, visual_shapes

_PIECES = 400  # straight pieces that a path is drawn with, at most


class Stage:
    """A robot on a page.

    Attributes:
        server: The ``viser.ViserServer``.
        robot: The robot.
    """

    def __init__(self, server: Any, robot: Robot) -> None:
        """Put the robot's shapes and a floor on the page."""
        self.server, self.robot = server, robot
        self._data = robot.model.createData()
        scene = server.scene
        scene.add_grid(
            "/floor", width=3.0, height=3.0, cell_size=0.1, section_size=0.5, plane="xy",
            cell_color=(225, 225, 230), section_color=(195, 195, 205), shadow_opacity=0.25,
        )  # fmt: skip
        self._joints = [
            scene.add_frame(f"/robot/{i}", show_axes=False) for i in range(robot.model.njoints)
        ]
        for number, shape in enumerate(visual_shapes(robot)):
            place: dict[str, Any] = {
                "name": f"/robot/{shape.joint}/shape_{number}",
                "color": tuple(round(255 * part) for part in shape.colour),
                "position": shape.position,
                "wxyz": wxyz(shape.rotation),
            }
            if shape.kind == "cylinder":
                scene.add_cylinder(radius=shape.size[0], height=shape.size[1], **place)
            elif shape.kind == "sphere":
                scene.add_icosphere(radius=shape.size[0], subdivisions=4, **place)
            else:
                scene.add_box(dimensions=shape.size, **place)
        self._lines: dict[str, Any] = {}
        self._obstacles: list[tuple[Any, Obstacle]] = []

    def add_obstacles(self, obstacles: Iterable[Obstacle]) -> None:
        """Draw obstacles, all but half-spaces; `show` moves them."""
        for number, obstacle in enumerate(obstacles):
            if not isinstance(obstacle, HalfSpace):
                colour = tuple(round(255 * part) for part in OBSTACLE_COLOUR)
                name, outside = f"/obstacle_{number}", outline(obstacle)
                node = self.server.scene.add_mesh_simple(name, *outside, color=colour)
                self._obstacles.append((node, obstacle))

    def show(self, q: FloatArray, t: float = 0.0) -> None:
        """Move the robot to joint positions (n,) [rad], and obstacles to where they are then."""
        with self.server.atomic():
            for node, obstacle in self._obstacles:
                node.position = obstacle.shift(t)
            poses = joint_poses(self.robot, q, self._data)
            for joint, pose in zip(self._joints, poses, strict=True):
                joint.position, joint.wxyz = pose.translation, wxyz(pose.rotation)

    def line(
        self, name: str, points: FloatArray, colour: tuple[int, int, int], width: float
    ) -> None:
        """Draw a path through points (M, 3) [m], or draw it anew; its width is in pixels."""
        points = points[np.linspace(0, len(points) - 1, min(len(points), _PIECES + 1)).astype(int)]
        pieces = np.stack([points[:-1], points[1:]], axis=1).astype(np.float32)
        if name in self._lines:
            self._lines[name].points = pieces
            return
        self._lines[name] = self.server.scene.add_line_segments(
            f"/{name}", pieces, colour, thickness=width, thickness_units="screen"
        )

    def set_line_visible(self, name: str, visible: bool) -> None:
        """Show or hide a path, if there is one of this name."""
        if name in self._lines:
            self._lines[name].visible = visible

    def look_at(self, point: FloatArray) -> None:
        """Let the camera of a new page look at the arm and at a point [m], (3,)."""
        side = np.array([point[1], -point[0], 0.0])
        side /= max(float(np.linalg.norm(side)), 1e-9)
        middle = 0.5 * point + np.array([0.0, 0.0, 0.25])
        away = 0.95 * side + 0.35 * point + np.array([0.0, 0.0, 0.55])
        right = np.cross([0.0, 0.0, 1.0], away)
        middle += 0.2 * right / np.linalg.norm(right)  # the controls cover the right of the page
        camera = self.server.initial_camera
        camera.look_at, camera.position = tuple(middle), tuple(middle + away)
        camera.fov = 0.95  # rad, from top to bottom


def wxyz(rotation: FloatArray) -> FloatArray:
    """Return a rotation (3, 3) as the quaternion [w, x, y, z] that viser takes."""
    x, y, z, w = pin.Quaternion(rotation).coeffs()
    return np.array([w, x, y, z])
