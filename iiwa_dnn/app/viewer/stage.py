"""The three-dimensional part of the page: the robot, the floor and the paths."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import pinocchio as pin

from iiwa_dnn.references import Target
from iiwa_dnn.results.record import FloatArray
from iiwa_dnn.results.scenery import OBSTACLE_COLOR
from iiwa_dnn.robot.obstacles import HalfSpace, Obstacle, outline
from iiwa_dnn.robot.robot import Robot
from iiwa_dnn.robot.shapes import Shape, joint_poses, visual_shapes

VIEWS = ("arm", "top", "side", "tool")
"""Directions from which the camera looks: at the whole arm, or at the path from near by."""

SEEN_THROUGH = 0.2
"""Opacity of the arm from above, where it would hide the path."""

_PIECES = 400  # straight pieces that a path is drawn with, at most


class Stage:
    """A robot in a browser.

    Attributes:
        host: The browser, a ``viser.ClientHandle``; or a ``viser.ViserServer`` for all of them.
        robot: The robot.
    """

    def __init__(self, host: Any, robot: Robot, path: FloatArray) -> None:
        """Put the robot's shapes and a floor on the page; views turn to a path (M, 3) [m]."""
        self.host = host
        self.robot = robot
        self._path = path
        self._data = robot.model.createData()
        scene = host.scene
        scene.add_grid(
            "/floor",
            width=3.0,
            height=3.0,
            cell_size=0.1,
            section_size=0.5,
            plane="xy",
            cell_color=(225, 225, 230),
            section_color=(195, 195, 205),
            shadow_opacity=0.25,
        )
        self._joints = [
            scene.add_frame(f"/robot/{i}", show_axes=False) for i in range(robot.model.njoints)
        ]
        self._ghost = scene.add_frame("/ghost", show_axes=False, visible=False)
        last = robot.model.frames[robot.tip_id].parentJoint
        self._shapes: list[Any] = []
        for number, shape in enumerate(visual_shapes(robot)):
            self._shapes.append(self._add(shape, f"/robot/{shape.joint}/shape_{number}"))
            if shape.joint == last:
                self._add(shape, f"/ghost/shape_{number}", opacity=0.35)
        self._lines: dict[str, Any] = {}
        self._obstacles: list[tuple[Any, Obstacle]] = []

    def add_obstacles(self, obstacles: Iterable[Obstacle]) -> None:
        """Draw obstacles, all but half-spaces; `show` moves them."""
        for number, obstacle in enumerate(obstacles):
            if not isinstance(obstacle, HalfSpace):
                node = self.host.scene.add_mesh_simple(
                    f"/obstacle_{number}", *outline(obstacle), color=_rgb(OBSTACLE_COLOR)
                )
                self._obstacles.append((node, obstacle))

    def _add(self, shape: Shape, name: str, **options: Any) -> Any:
        """Put a shape on the page, under the frame that its name begins with."""
        scene = self.host.scene
        options |= {
            "name": name,
            "color": _rgb(shape.color),
            "position": shape.position,
            "wxyz": wxyz(shape.rotation),
        }
        if shape.mesh is not None:
            return scene.add_mesh_simple(vertices=shape.mesh[0], faces=shape.mesh[1], **options)
        if shape.kind == "cylinder":
            return scene.add_cylinder(radius=shape.size[0], height=shape.size[1], **options)
        if shape.kind == "sphere":
            return scene.add_icosphere(radius=shape.size[0], subdivisions=4, **options)
        return scene.add_box(dimensions=shape.size, **options)

    def ghost(self, target: Target | None, distance: float = np.inf, angle: float = np.inf) -> None:
        """Show the last link, translucent, as it is at a target; hide it for None.

        It is hidden too if the tip is near the target, by distance [m] and angle [rad]: it would
        flicker inside the arm.
        """
        near = distance <= 1e-3 and angle <= 1e-2
        self._ghost.visible = target is not None and not near
        if target is not None:
            frame = self.robot.model.frames[self.robot.tip_id]
            pose = pin.SE3(target.rotation, target.position) * frame.placement.inverse()
            _move(self._ghost, pose)

    def show(self, q: FloatArray, t: float = 0.0) -> None:
        """Move the robot to joint positions (n,) [rad], and obstacles to where they are then."""
        with self.host.atomic():
            for node, obstacle in self._obstacles:
                node.position = obstacle.shift(t)
            poses = joint_poses(self.robot, q, self._data)
            for joint, pose in zip(self._joints, poses, strict=True):
                _move(joint, pose)

    def line(
        self, name: str, points: FloatArray, color: tuple[int, int, int], width: float
    ) -> None:
        """Draw a path through points (M, 3) [m], or draw it anew; its width is in pixels."""
        points = points[np.linspace(0, len(points) - 1, min(len(points), _PIECES + 1)).astype(int)]
        pieces = np.stack([points[:-1], points[1:]], axis=1).astype(np.float32)
        if name in self._lines:
            self._lines[name].points = pieces
            return
        self._lines[name] = self.host.scene.add_line_segments(
            f"/{name}", pieces, color, thickness=width, thickness_units="screen"
        )

    def set_line_visible(self, name: str, visible: bool) -> None:
        """Show or hide a path, if there is one of this name."""
        if name in self._lines:
            self._lines[name].visible = visible

    def turn_to(self, view: str) -> None:
        """Let the browser's camera look as one of ``VIEWS`` says; from above through the arm."""
        camera = self.host.camera
        position, middle = camera_pose(view, self._path, upright=camera.aspect < 1.0)
        camera.position = tuple(position)  # moves the point looked at along
        camera.look_at = tuple(middle)
        for shape in self._shapes:
            shape.opacity = SEEN_THROUGH if view == "top" else None


def camera_pose(
    view: str, path: FloatArray, upright: bool = False
) -> tuple[FloatArray, FloatArray]:
    """Return a camera's position and the point that it looks at, (3,) each [m].

    Args:
        view: One of ``VIEWS``.
        path: Points of the path, or of the tip alone, (M, 3) [m].
        upright: The window is a phone's: the controls cover its lower part, else its right.
    """
    point = path.mean(axis=0)
    up = np.array([0.0, 0.0, 1.0])
    side = np.array([point[1], -point[0], 0.0])  # across the way from the base to the path
    side /= max(float(np.linalg.norm(side)), 1e-9)
    distance = max(0.5, (4.5 if upright else 3.0) * float(np.ptp(path, axis=0).max()))
    away = {
        "arm": (2.0 if upright else 1.0) * (0.95 * side + 0.35 * point + 0.55 * up),
        "top": distance * up + 1e-3 * side,
        "side": distance * side,
        "tool": 0.5 * distance * (side + up),
    }[view]
    if view == "arm":
        point = 0.5 * point + 0.25 * up
    right = np.cross(up, away)
    right *= np.linalg.norm(away) / np.linalg.norm(right)
    hidden = np.cross(right, away) / np.linalg.norm(away) if upright else right
    point = point + 0.2 * hidden  # the middle of the part that the controls leave free
    return point + away, point


def _move(node: Any, pose: pin.SE3) -> None:
    node.position = pose.translation
    node.wxyz = wxyz(pose.rotation)


def _rgb(color: Iterable[float]) -> tuple[int, ...]:
    return tuple(round(255 * part) for part in color)


def wxyz(rotation: FloatArray) -> FloatArray:
    """Return a rotation (3, 3) as the quaternion [w, x, y, z] that viser takes."""
    x, y, z, w = pin.Quaternion(rotation).coeffs()
    return np.array([w, x, y, z])
