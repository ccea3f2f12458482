"""Nearest points of segments and hulls beside coal's, and beside a general minimiser."""

from __future__ import annotations

import coal
import numpy as np
import pytest
from scipy.optimize import minimize

from iiwa_dnn.schemes.distances import hull_points, segment_points


def nearest(segment: np.ndarray, points: np.ndarray) -> np.ndarray:
    """The nearest points of a segment (2, 3) and a hull (k, 3), (2, 3)."""
    a, b = map(tuple, segment)
    if len(points) <= 2:
        return np.array(segment_points(a, b, tuple(points[0]), tuple(points[-1])))
    return np.array(hull_points(a, b, points))


def minimised(segment: np.ndarray, points: np.ndarray) -> float:
    """The distance by scipy, over the weights of all corners."""
    k = len(points)

    def squared(w: np.ndarray) -> float:
        return float(np.sum((w[:2] @ segment - w[2:] @ points) ** 2))

    sums = [{"type": "eq", "fun": lambda w: w[:2].sum() - 1.0},
            {"type": "eq", "fun": lambda w: w[2:].sum() - 1.0}]  # fmt: skip
    start = np.concatenate([[0.5, 0.5], np.full(k, 1.0 / k)])
    options = {"ftol": 1e-14, "maxiter": 500}
    found = minimize(squared, start, bounds=[(0, 1)] * (k + 2), constraints=sums, options=options)
    return float(np.sqrt(found.fun))


@pytest.mark.parametrize("count", [1, 2, 4, 8, 20])
def test_random_bodies_agree_with_a_general_minimiser(count: int) -> None:
    random = np.random.default_rng(count)
    for _ in range(40):
        segment = random.normal(size=(2, 3))
        points = random.normal(size=(count, 3)) + 3.0 * random.normal(size=3)
        x, y = nearest(segment, points)
        assert np.linalg.norm(x - y) == pytest.approx(minimised(segment, points), abs=2e-6)


def test_capsule_and_box_agree_with_coal() -> None:
    random, half = np.random.default_rng(0), np.array([0.1, 0.2, 0.3])
    corners = half * np.stack(np.meshgrid(*[[-1.0, 1.0]] * 3), axis=-1).reshape(-1, 3)
    request, result = coal.DistanceRequest(), coal.DistanceResult()
    for _ in range(300):
        segment = random.normal(size=(2, 3)) * 0.5 + random.normal(size=3) * 0.5
        ends = np.linalg.norm(segment[1] - segment[0])
        turn = coal.Transform3s()
        x = (segment[1] - segment[0]) / ends
        other = np.linalg.svd(x[np.newaxis])[2][1:]
        turn.setRotation(np.column_stack([*other, x]) * [1, np.linalg.det([*other, x]), 1])
        turn.setTranslation(segment.mean(axis=0))
        result.clear()
        theirs = coal.distance(
            coal.Capsule(0.01, ends),
            turn,
            coal.Box(*(2 * half)),
            coal.Transform3s(),
            request,
            result,
        )
        a, b = nearest(segment, corners)
        if theirs > 1e-3:
            assert np.linalg.norm(a - b) - 0.01 == pytest.approx(theirs, abs=2e-6)
        else:
            assert np.linalg.norm(a - b) <= 0.01 + 1e-3 + 2e-6


def test_of_segments_that_rounding_takes_for_parallel_the_ends_are_tried() -> None:
    # They run towards each other by 1e-8 m a metre: the formula's points are 1e-8 m too far apart.
    first = np.array([
        [0.0, 0.0, 0.0],
        [-1.2995298727420022, 1.8337820743159081, 1.6315190342809855],
    ])  # fmt: skip
    second = np.array([
        [-0.24098741560896667, 0.23722673342345224, 0.87458899883805],
        [0.423167983506479, -0.6999708535086914, 0.040762687052543045],
    ])  # fmt: skip
    from_ends = [nearest(np.array([end, end]), second) for end in first]
    from_ends += [nearest(first, np.array([end, end])) for end in second]
    least = min(np.linalg.norm(x - y) for x, y in from_ends)
    x, y = nearest(first, second)
    assert np.linalg.norm(x - y) == pytest.approx(least, abs=1e-12)


@pytest.mark.parametrize("tilt", [0.0, 1e-9, 1e-5, 0.3])
def test_nearly_parallel_segments_have_the_right_distance(tilt: float) -> None:
    first = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 1.0 + tilt]])
    second = np.array([[-1.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    x, y = nearest(first, second)
    assert np.linalg.norm(x - y) == pytest.approx(1.0, abs=1e-12)


def test_the_first_corner_may_be_the_nearest() -> None:
    corners = np.array([[1.0, 0.0, 0.0], [2.0, 1.0, 0.0], [2.0, -1.0, 0.0], [2.0, 0.0, 1.0]])
    x, y = nearest(np.array([[0.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]), corners)
    np.testing.assert_allclose([x, y], [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], atol=1e-12)


def test_a_segment_that_meets_a_hull_has_no_distance() -> None:
    corners = np.stack(np.meshgrid(*[[-1.0, 1.0]] * 3), axis=-1).reshape(-1, 3)
    x, y = nearest(np.array([[0.3, 0.2, -5.0], [0.1, 0.0, 5.0]]), corners)
    assert np.linalg.norm(x - y) < 1e-9
    x, y = nearest(np.array([[0.3, 0.2, 0.1], [0.3, 0.2, 0.1]]), corners)
    assert np.linalg.norm(x - y) < 1e-9
