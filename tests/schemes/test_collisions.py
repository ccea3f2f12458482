"""Collision avoidance: distances beside coal's, gradients, bounds on curves, rows, runs, files."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import iiwa_dnn
from helpers_kinematics import PAPER_Q0, Array, finite_difference
from helpers_simulation import rows_of, run
from iiwa_dnn import Configuration, HalfSpace, Sphere
from judge_distances import Judge, obstacles_for

ROBOT = iiwa_dnn.load_robot("iiwa7")
START = np.array(PAPER_Q0)
HERE = Configuration(ROBOT, START)
BALL = Sphere([0.36, 0.16, 0.64], 0.05)
LEAST = 0.02


def avoiding(obstacles: Any, **options: Any) -> iiwa_dnn.CollisionAvoidance:
    """With a gain so small that only rows of pairs at rest are idle."""
    options = {"self_collision": False, "gain": 1e-3, "nearest": 200} | options
    return iiwa_dnn.CollisionAvoidance(obstacles, distance=LEAST, **options)


def rows(avoidance: Any, q: Array, robot: Any = ROBOT, **options: Any) -> tuple[Array, Array]:
    """The gradients, and what is left of each distance beyond the least; 9 m of an idle row."""
    qp = rows_of(avoidance, Configuration(robot, q), **options)
    return qp.G, np.where(np.isfinite(qp.h), qp.h / avoidance.gain, 9.0)


def nearer_ends(left: Array) -> Array:
    """What is left of the distance of each pair."""
    return np.asarray(left.reshape(-1, 2).min(axis=1))


def postures(count: int, robot: Any = ROBOT) -> Array:
    half = 0.5 * np.array([robot.q_lower, robot.q_upper])
    return np.random.default_rng(0).uniform(*half, (count, robot.dof))


@pytest.mark.parametrize("obstacle", [*obstacles_for(True), None])
def test_distances_are_coals(obstacle: Any) -> None:
    avoidance = avoiding([obstacle] if obstacle else [], self_collision=not obstacle)
    judge = Judge(ROBOT, avoidance)
    places, times = postures(60), np.linspace(0.0, 6.0, 60)
    own = avoidance.scene(ROBOT).nearest(places, times)[0]
    found = np.array([judge.distances(q, t) for q, t in zip(places, times, strict=True)])
    coals = found[:, np.ptp(found, axis=0) > 1e-9].min(axis=1)  # pairs that no joint moves are out
    apart = np.maximum(own, coals) > 0.0
    assert apart.sum() > 10
    np.testing.assert_allclose(own[apart], coals[apart], rtol=0, atol=2e-6)


@pytest.mark.parametrize("name", ["iiwa7", "panda"])
def test_rows_are_the_gradients_of_the_distances(name: str) -> None:
    """Of a link that lies along an obstacle, the gradient is between those of its ends."""
    robot = iiwa_dnn.load_robot(name)
    avoidance = avoiding(obstacles_for(False), self_collision=True)
    lying = 0
    for q in postures(5, robot):
        G, left = rows(avoidance, q, robot)
        slope = finite_difference(lambda x: nearer_ends(rows(avoidance, x, robot)[1]), q)
        apart = (LEAST + nearer_ends(left) > 1e-3) & (-nearer_ends(-left) < 9.0)
        assert apart.sum() > 20
        one, other = -G[0::2][apart], -G[1::2][apart]
        across = other - one
        fraction = ((slope[apart] - one) * across).sum(axis=1) / (across**2).sum(axis=1)
        higher = (left[0::2] - left[1::2])[apart]
        lying += (np.abs(higher) < 1e-9).sum()
        fraction = np.where(np.abs(higher) < 1e-9, np.clip(fraction, 0.0, 1.0), higher > 0.0)
        # Second differences at the kinks of boxes.
        found = one + fraction[:, np.newaxis] * across
        np.testing.assert_allclose(found, slope[apart], rtol=0, atol=1e-5)
    assert lying > 5


def test_idle_rows_are_those_that_no_velocity_within_the_limits_can_break() -> None:
    avoidance = avoiding([BALL], gain=4.0)
    G, left = rows(avoidance, START)
    distances = rows(avoiding([BALL]), START)[1]
    idle = left == 9.0
    assert 0 < idle.sum() < len(left)
    np.testing.assert_allclose(left[~idle], distances[~idle], rtol=1e-9)
    assert (4.0 * distances >= np.abs(G) @ ROBOT.dq_max - 1e-9)[idle].all()


def test_points_move_on_curves_that_h_allows_for() -> None:
    # A floor is flat: what the row's gradient does not say of a distance is the points' curves.
    floor = avoiding([HalfSpace([0.0, 0.0, 1.0], -1.0)])
    dt, random = 0.02, np.random.default_rng(1)
    # Three parallel joints that bend a stretched arm need all of it: half, as the bound is twice.
    motions = [(np.array([0.0, 0.3, 0, 0, 0, 0, 0]), np.array([0.0, 1, 0, -1, 0, 1, 0]))]
    motions += [(q, ROBOT.dq_max * random.choice([-1.0, 1.0], 7)) for q in postures(40)]
    fractions = []
    for q, last in motions:
        G, still = rows(floor, q, dt=dt)
        allowed = still - rows(floor, q, dt=dt, dq=last)[1]
        after = rows(floor, q + dt * last)[1]
        counted = (allowed > 0.0) & (allowed < still) & (np.maximum(still, after) < 9.0)
        curved = np.abs(still - dt * (G @ last) - after)
        fractions.append(curved[counted] / allowed[counted])
    assert np.concatenate(fractions).max() < 0.5
    assert fractions[0].max() > 0.45


def test_within_what_a_step_may_take_h_asks_for_all_of_it_at_once() -> None:
    dt, gain = 0.02, 4.0
    last = np.array([0.3, 1.5, -0.4, 1.0, 0.5, -0.7, 0.1])
    distances = rows(avoiding([HalfSpace([-1.0, 0.0, 0.0], -1.0)]), START)[1]
    pair = int(distances.argmin())

    def speed(left: float, dq: Array) -> float:
        """The row's h where the pair is so much farther away than it has to be."""
        wall = HalfSpace([-1.0, 0.0, 0.0], -1.0 + distances[pair] - left)
        return gain * float(rows(avoiding([wall], gain=gain), START, dt=dt, dq=dq)[1][pair])

    assert speed(0.05, 0.0 * last) == pytest.approx(gain * 0.05, rel=1e-9)
    eps = 0.05 - speed(0.05, last) / gain
    assert speed(0.0, last) == pytest.approx(-eps / dt, rel=1e-9)
    assert speed(0.5 * eps, last) == pytest.approx(-0.5 * eps / dt, rel=1e-9)
    assert speed(eps + 5e-3, last) == pytest.approx(gain * 5e-3, rel=1e-9)
    assert speed(-1e-3, last) == pytest.approx(-eps / dt - gain * 1e-3, rel=1e-9)


def test_more_pairs_than_rows_keep_the_nearest_to_being_active() -> None:
    many = [Sphere([0.36, 0.16, 0.64 + 0.3 * k], 0.05) for k in range(5)]
    few = avoiding(many, gain=20.0, nearest=4, self_collision=True)
    some, left = rows(few, START)
    G, each = rows(avoiding(many, gain=20.0, self_collision=True), START)
    slack = np.where(each < 9.0, 20.0 * each - np.abs(G) @ ROBOT.dq_max, 0.0)
    active = left < 9.0
    chosen = np.sort(np.argsort(slack, kind="stable")[: active.sum()])
    np.testing.assert_array_equal(some[active], G[chosen])
    assert few.row_names(ROBOT) == []


def test_the_elbow_gives_way_and_the_heart_stays() -> None:
    paper = iiwa_dnn.DoubleIndicator()
    near = iiwa_dnn.CollisionAvoidance([BALL], distance=0.03)
    path = iiwa_dnn.Heart().anchored(HERE)
    free, record = [
        run(scheme, path, ROBOT, dt=5e-3, duration=10.0)
        for scheme in (paper, replace(paper, extra_limits=(near,)))
    ]
    assert near.scene(ROBOT).nearest(free.q, free.t)[0].min() < 0.01
    assert iiwa_dnn.failures(record) == []
    metrics = iiwa_dnn.compute_metrics(record)
    assert metrics["collisions"]["first"] == "Sphere 1"
    assert 0.03 <= metrics["collisions"]["least_distance_m"] < 0.032
    assert metrics["collisions"]["missing_m"] == 0.0
    without = iiwa_dnn.compute_metrics(free)["max_position_error_m"]
    assert metrics["max_position_error_m"] < 1.1 * without


def test_a_file_is_what_python_says(tmp_path: Path) -> None:
    path = tmp_path / "obstacles.toml"
    path.write_text(
        "distance = 0.03\n[[obstacle]]\nshape = 'sphere'\ncenter = [0.36, 0.16, 0.64]\n"
        "radius = 0.05\n[[obstacle]]\nshape = 'half_space'\nnormal = [0, 0, 2]\noffset = -0.1\n",
        encoding="utf-8",
    )
    read = iiwa_dnn.CollisionAvoidance.from_toml(path)
    assert read.obstacles == (BALL, HalfSpace([0.0, 0.0, 1.0], -0.1))
    assert read.distance == 0.03


@pytest.mark.parametrize(
    ("names", "words"),
    [
        (("ball", "ball"), "two go by the name 'ball'"),
        ((None, "Sphere 1"), "two go by the name 'Sphere 1'"),
        (("iiwa7_link_5", None), "one goes by the link's name 'iiwa7_link_5'"),
    ],
)
def test_a_name_is_that_of_one_body(names: tuple[str | None, str | None], words: str) -> None:
    balls = [Sphere([1.0, k, 0.0], 0.1, name=name) for k, name in enumerate(names)]
    with pytest.raises(iiwa_dnn.InvalidInputError, match=words):
        iiwa_dnn.CollisionAvoidance(balls).scene(iiwa_dnn.load_robot("iiwa7"))
