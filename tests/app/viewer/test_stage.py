"""The camera's poses: path and arm are in the part of the window that the controls leave free."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_physics import START, papers_robot
from iiwa_dnn import Configuration, Heart
from iiwa_dnn.app.viewer.stage import VIEWS, camera_pose

FIELD = 0.95  # of view, from top to bottom [rad]


def seen(points, position, look_at):
    """Pixels of points (M, 3) over the window's height, from its middle, right and up, (M, 2)."""
    forward = (look_at - position) / np.linalg.norm(look_at - position)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    axes = np.array([right, np.cross(right, forward), forward])
    x, y, depth = axes @ (points - position).T
    assert (depth > 0.0).all()
    return np.column_stack([x, y]) / depth[:, None] / (2.0 * np.tan(0.5 * FIELD))


@pytest.mark.parametrize("size", [(1280, 720), (390, 844)])
@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("scale", [3.45e-3, 1e-2])
def test_the_path_is_seen_beside_the_controls(view, size, scale):
    width, height = size
    start = Configuration(papers_robot(), START)
    path = Heart(scale=scale).anchored(start).sample(np.linspace(0.0, 10.0, 50)).position
    points = path if view != "arm" else np.vstack([path, np.zeros(3), [0.0, 0.0, 0.4]])
    pixels = height * seen(points, *camera_pose(view, path, upright=width < height))
    across = 0.5 * width + pixels[:, 0]
    down = 0.5 * height - pixels[:, 1]
    free = (width, 0.6 * height) if width < height else (width - 400, height)
    assert across.min() > 0.0
    assert across.max() < free[0]
    assert down.min() > 0.0
    assert down.max() < free[1]


def test_a_single_point_is_looked_at_from_half_a_metre():
    point = np.array([[0.4, 0.3, 0.3]])
    for view in ("top", "side"):
        position, _ = camera_pose(view, point)
        assert 0.5 <= np.linalg.norm(position - point[0]) < 0.52
