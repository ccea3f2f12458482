"""Collision avoidance: distances beside a general minimiser, gradients, bounds, runs, files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import minimize

import iiwa_dnn
from helpers_simulation import rows_of
from iiwa_dnn.robot.kinematics import Kinematics
from iiwa_dnn.schemes.scene import (
    beyond,
    bounds_of_motion,
    depth,
    nearest_parameter,
    second_order,
    write_distances,
)
from judge_distances import Judge, obstacles_for

ROBOT = iiwa_dnn.load_robot("iiwa7")
START = np.array([-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0])
BALL = iiwa_dnn.Sphere([0.36, 0.16, 0.64], 0.05)


def scheme(*limits: iiwa_dnn.Limit) -> iiwa_dnn.Scheme:
    paper = iiwa_dnn.DoubleIndicator()
    return iiwa_dnn.Scheme(paper.costs, paper.tasks, [*paper.limits, *limits])


def heart(scale: float = 3.45e-3, period: float = 10.0) -> iiwa_dnn.Reference:
    path = iiwa_dnn.Heart(scale=scale, period=period)
    return path.anchored(iiwa_dnn.Configuration(ROBOT, START))


def pair_distances_at(
    avoidance: iiwa_dnn.CollisionAvoidance, robot: iiwa_dnn.Robot, q: np.ndarray
) -> np.ndarray:
    scene = avoidance.scene(robot)
    kinematics = Kinematics(robot, scene.frames)
    kinematics.update(q)
    distances = np.empty(len(scene.pairs))
    write_distances(scene.constants, robot.dof, kinematics.placements, distances)
    return distances


@pytest.mark.parametrize("name", ["iiwa7", "panda"])
def test_rows_are_the_gradients_of_the_distances(name: str) -> None:
    robot = iiwa_dnn.load_robot(name)
    avoidance = iiwa_dnn.CollisionAvoidance(obstacles_for(False), nearest=200)
    random, h, worst = np.random.default_rng(0), 1e-6, 0.0
    for _ in range(5):
        q = random.uniform(0.5 * robot.q_lower, 0.5 * robot.q_upper)
        conf = iiwa_dnn.Configuration(robot, q)
        G = scheme(avoidance).build_qp(conf, iiwa_dnn.Target(conf.position, conf.rotation)).G
        apart = pair_distances_at(avoidance, robot, q) > 1e-3
        for j, e in enumerate(np.eye(robot.dof)):
            ends = [pair_distances_at(avoidance, robot, q + s * h * e) for s in (-1.0, 1.0)]
            slope = (ends[1] - ends[0]) / (2.0 * h)
            worst = max(worst, np.abs(-G[apart, j] - slope[apart]).max())
    assert worst < 1e-5  # second differences at the kinks of boxes


def test_h_is_the_damper_without_a_control_period() -> None:
    avoidance = iiwa_dnn.CollisionAvoidance([BALL], distance=0.02, gain=4.0)
    conf = iiwa_dnn.Configuration(ROBOT, START)
    qp = scheme(avoidance).build_qp(conf, iiwa_dnn.Target(conf.position, conf.rotation))
    distances = pair_distances_at(avoidance, ROBOT, START)
    counted = np.isfinite(qp.h)
    assert counted.any()
    np.testing.assert_allclose(qp.h[counted], 4.0 * (distances - 0.02)[counted], rtol=1e-12)
    # Idle rows are those that no velocity within the limits can break.
    idle = ~counted
    assert (4.0 * (distances - 0.02) >= np.abs(qp.G) @ ROBOT.dq_max - 1e-9)[idle].all()


def test_in_a_loop_h_leaves_what_a_step_like_the_last_one_may_take() -> None:
    dt, gain, promised = 0.02, 4.0, 0.02
    last = np.array([0.3, 1.5, -0.4, 1.0, 0.5, -0.7, 0.1])

    def wall(offset: float) -> iiwa_dnn.CollisionAvoidance:
        plane = iiwa_dnn.HalfSpace([-1.0, 0.0, 0.0], offset)
        return iiwa_dnn.CollisionAvoidance([plane], self_collision=False, gain=gain)

    far = wall(-1.0)
    distances = pair_distances_at(far, ROBOT, START)
    pair = int(distances.argmin())

    def row(spare: float, dq: np.ndarray) -> tuple[np.ndarray, float]:
        """Return G and h where the pair is so much farther away than what is promised."""
        near = wall(-1.0 + distances[pair] - promised - spare)
        qp = rows_of(near, iiwa_dnn.Configuration(ROBOT, START), dt=dt, dq=dq)
        return qp.G[pair], float(qp.h[pair])

    g, still = row(0.05, np.zeros(7))
    assert still == pytest.approx(gain * 0.05, rel=1e-9)
    eps = (still - row(0.05, last)[1]) / gain
    # A wall is flat: the distance after the step is as the row says, less what the points' curves
    # take, and those may bend to either side.
    for sign in (-1.0, 1.0):
        after = pair_distances_at(far, ROBOT, START + sign * dt * last)[pair]
        assert abs(distances[pair] - sign * dt * (g @ last) - after) < eps
    # In the range that such a step could take the row asks for all of it at once.
    assert row(0.0, last)[1] == pytest.approx(-eps / dt, rel=1e-9)
    assert row(0.5 * eps, last)[1] == pytest.approx(-0.5 * eps / dt, rel=1e-9)
    assert row(eps + 5e-3, last)[1] == pytest.approx(gain * 5e-3, rel=1e-9)
    assert row(-1e-3, last)[1] == pytest.approx(-eps / dt - gain * 1e-3, rel=1e-9)


def test_no_acceleration_is_above_its_bound() -> None:
    random, joint, h = np.random.default_rng(1), 7, 1e-4
    point = np.array([0.02, -0.03, 0.06])
    for first in (0, 2):
        moves, radii = bounds_of_motion(ROBOT, first, joint, point[None])
        assert moves.tolist() == [0.0] * first + [1.0] * (joint - first)
        speed = float(np.abs(radii) @ ROBOT.dq_max)
        acceleration = second_order(moves[None], radii[None], 0, ROBOT.dq_max)
        found = []
        for _ in range(300):
            q, dq = random.uniform(-2.0, 2.0, 7), ROBOT.dq_max * random.choice([-1.0, 1.0], 7)
            place = []
            for s in (-h, 0.0, h):
                kinematics = iiwa_dnn.Configuration(ROBOT, q + s * dq)
                tip = kinematics.frame("iiwa7_link_7")
                x = tip.position + tip.rotation @ point
                if first:
                    base = kinematics.frame("iiwa7_link_2")
                    x = base.rotation.T @ (x - base.position)
                place.append(x)
            found.append([np.linalg.norm(place[2] - place[0]) / (2 * h),
                          np.linalg.norm(place[2] - 2 * place[1] + place[0]) / h**2])  # fmt: skip
        largest = np.max(found, axis=0)
        assert 0.2 * speed < largest[0] < speed
        assert 0.1 * acceleration < largest[1] < acceleration


def test_the_elbow_gives_way_and_the_heart_stays() -> None:
    avoidance = iiwa_dnn.CollisionAvoidance([BALL], distance=0.03)
    unchecked = iiwa_dnn.CrossCheck(())
    free = iiwa_dnn.simulate(ROBOT, scheme(), heart(), START, dt=5e-3, check=unchecked)
    record = iiwa_dnn.simulate(ROBOT, scheme(avoidance), heart(), START, dt=5e-3)
    metrics = iiwa_dnn.compute_metrics(record)
    assert iiwa_dnn.failures(record) == []
    assert avoidance.scene(ROBOT).nearest(free.q, free.t)[0].min() < 0.01
    near = metrics["collisions"]
    assert near["first"] == "Sphere 1"
    assert 0.03 <= near["least_distance_m"] < 0.032
    assert near["missing_m"] == 0.0
    without = iiwa_dnn.compute_metrics(free)["max_position_error_m"]
    assert metrics["max_position_error_m"] < 1.1 * without
    judge = Judge(ROBOT, avoidance)
    coals = [judge.distance(q, t) for q, t in zip(record.q, record.t, strict=True)]
    np.testing.assert_allclose(record.distance, coals, atol=1e-9)


def test_an_obstacle_that_comes_is_kept_away_from() -> None:
    coming = iiwa_dnn.Sphere([0.33, 0.16, 0.84], 0.05, velocity=[0.0, 0.0, -0.04])
    avoidance = iiwa_dnn.CollisionAvoidance([coming], distance=0.03)
    record = iiwa_dnn.simulate(ROBOT, scheme(avoidance), heart(), START, dt=5e-3, duration=5.0)
    assert record.distance.min() >= 0.03
    assert avoidance.scene(ROBOT).nearest(np.tile(START, (2, 1)), np.array([0.0, 5.0]))[0][1] < 0.03


def test_more_pairs_than_rows_keep_the_nearest() -> None:
    many = [iiwa_dnn.Sphere([0.36, 0.16, 0.64 + 0.3 * k], 0.05) for k in range(5)]
    few = iiwa_dnn.CollisionAvoidance(many, distance=0.03, nearest=4)
    conf = iiwa_dnn.Configuration(ROBOT, START)
    target = iiwa_dnn.Target(conf.position, conf.rotation)
    some = scheme(few).build_qp(conf, target)
    whole = scheme(iiwa_dnn.CollisionAvoidance(many, distance=0.03, nearest=99))
    qp = whole.build_qp(conf, target)
    slack = np.where(np.isfinite(qp.h), qp.h - np.abs(qp.G) @ ROBOT.dq_max, 0.0)
    chosen = np.sort(np.argsort(slack, kind="stable")[: np.isfinite(some.h).sum()])
    np.testing.assert_array_equal(some.G[np.isfinite(some.h)], qp.G[chosen])
    assert few.row_names(ROBOT) == []


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("[[obstacle]]\nshape = 'ball'", "shape: must be one of sphere"),
        ("[[obstacle]]\nshape = 'sphere'\nradius = 1", "Sphere: missing"),
        ("[[obstacle]]\nshape = 'sphere'\ncenter = [0, 0]\nradius = 1", "center"),
        ("[[obstacle]]\nshape = 'Box'\ncenter = [0,0,0]\nhalf_extents = [1,1,-1]", "half_extents"),
        ("distance = -1", "distance: must be a finite number above 0"),
        ("distanz = 1", "unexpected keyword argument 'distanz'"),
        ("[[obstacle]]\nshape = 'Sphere'\nradus = 1", "unexpected keyword argument 'radus'"),
        ("obstacle = 3", "not"),
        ("x = [", "cannot be read as TOML"),
    ],
)
def test_a_bad_file_is_refused_in_one_line(tmp_path: Path, text: str, reason: str) -> None:
    path = tmp_path / "obstacles.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(iiwa_dnn.FileError, match="toml: ") as caught:
        iiwa_dnn.CollisionAvoidance.from_toml(path)
    assert reason in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_file_is_what_python_says(tmp_path: Path) -> None:
    path = tmp_path / "obstacles.toml"
    path.write_text(
        "distance = 0.03\n[[obstacle]]\nshape = 'sphere'\n"
        "center = [0.36, 0.16, 0.64]\nradius = 0.05\n"
        "[[obstacle]]\nshape = 'half_space'\nnormal = [0, 0, 2]\noffset = -0.1\n"
        "[[obstacle]]\nshape = 'capsule'\na = [1, 0, 0]\nb = [1, 1, 0]\nradius = 0.1\n"
        "velocity = [0.1, 0, 0]\n",
        encoding="utf-8",
    )
    read = iiwa_dnn.CollisionAvoidance.from_toml(path)
    assert read.obstacles[0] == BALL
    assert read.obstacles[1] == iiwa_dnn.HalfSpace([0.0, 0.0, 1.0], -0.1)
    assert read.obstacles[2].speed == pytest.approx(0.1)
    assert read.distance == 0.03


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
