"""Nearest points of a segment and a box beside coal's, and beside a general minimiser."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize

from iiwa_dnn.schemes.scene import beyond, depth, nearest_parameter


def distance(segment: np.ndarray, half: np.ndarray) -> float:
    """The distance of a segment (2, 3) from a box about the origin."""
    start, way = segment[0], segment[1] - segment[0]
    s = nearest_parameter(tuple(start), tuple(way), tuple(half))
    assert 0.0 <= s <= 1.0
    return float(np.linalg.norm(beyond(tuple(start + s * way), tuple(half))))


def minimised(segment: np.ndarray, half: np.ndarray) -> float:
    """The distance by scipy, over the segment's parameter and the box's point."""

    def squared(x: np.ndarray) -> float:
        return float(np.sum((segment[0] + x[0] * (segment[1] - segment[0]) - x[1:]) ** 2))

    bounds = [(0.0, 1.0), *zip(-half, half, strict=True)]
    found = minimize(squared, [0.5, 0.0, 0.0, 0.0], bounds=bounds, options={"ftol": 1e-16})
    return float(np.sqrt(found.fun))


@pytest.mark.parametrize("extents", [0, 1, 2, 3])
def test_random_bodies_agree_with_a_general_minimiser(extents: int) -> None:
    random = np.random.default_rng(extents)
    for _ in range(60):
        segment = random.normal(size=(2, 3)) + 3.0 * random.normal(size=3)
        half = random.uniform(0.1, 1.0, 3) * (np.arange(3) < extents)
        assert distance(segment, half) == pytest.approx(minimised(segment, half), abs=2e-5)


@pytest.mark.parametrize("tilt", [0.0, 1e-9, 1e-5, 0.3])
def test_nearly_parallel_segments_have_the_right_distance(tilt: float) -> None:
    first = np.array([[0.5, 1.0, 1.0], [0.5 + tilt, 1.0, -1.0]])
    assert distance(first, np.array([0.0, 0.0, 2.0])) == pytest.approx(
        np.hypot(0.5, 1.0), abs=1e-12
    )


def test_a_segment_that_meets_a_box_has_no_distance_but_a_depth() -> None:
    half = np.ones(3)
    assert distance(np.array([[0.3, 0.2, -5.0], [0.1, 0.0, 5.0]]), half) == 0.0
    found, normal = depth((0.3, -0.9, 0.1), tuple(half))
    assert found == pytest.approx(-0.1, abs=1e-15)
    assert normal == (0.0, -1.0, 0.0)
