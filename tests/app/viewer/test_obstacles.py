"""Obstacles of a record on the page: one mesh each, moved with the time."""

from __future__ import annotations

import numpy as np
import pytest

import iiwa_dnn
from helpers_physics import START, papers_robot
from iiwa_dnn.app.viewer.page import Page

pytest.importorskip("viser", reason="pip install 'iiwa-dnn[view]'")


def test_obstacles_of_a_record_stand_where_they_are() -> None:
    robot = papers_robot()
    paper = iiwa_dnn.DoubleIndicator()
    obstacles = [
        iiwa_dnn.Sphere([0.36, 0.16, 0.94], 0.05, velocity=[0.0, 0.0, -0.05]),
        iiwa_dnn.HalfSpace([0.0, 0.0, 1.0], -0.2),
        iiwa_dnn.Box([0.8, 0.8, 0.2], [0.1, 0.1, 0.1]),
    ]
    avoid = iiwa_dnn.CollisionAvoidance(obstacles)
    scheme = iiwa_dnn.Scheme(paper.costs, paper.tasks, [*paper.limits, avoid])
    heart = iiwa_dnn.Heart().anchored(iiwa_dnn.Configuration(robot, START))
    record = iiwa_dnn.simulate(robot, scheme, heart, START, dt=1e-2, duration=0.2)
    page = Page(robot, record.q[0], record, port=0)
    try:
        stage = page.open(page.server).stage
        drawn = stage._obstacles
        assert [type(obstacle).__name__ for _, obstacle in drawn] == ["Sphere", "Box"]
        stage.show(record.q[-1], 2.0)
        np.testing.assert_allclose(drawn[0][0].position, [0.0, 0.0, -0.1])
        np.testing.assert_allclose(drawn[1][0].position, 0.0)
        ball = drawn[0][0].vertices
        corners = drawn[1][0].vertices
        np.testing.assert_allclose(np.linalg.norm(ball - [0.36, 0.16, 0.94], axis=1), 0.05, 1e-5)
        np.testing.assert_allclose(np.ptp(corners, axis=0), 0.2, 1e-5)
    finally:
        page.close()
