"""Paths that stay near their rows: the rule by brute force, else scipy's splines."""

import warnings
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.spatial.transform import Rotation

from iiwa_dnn import Waypoints

Array = NDArray[np.float64]


def quiet(*arguments: Any, **options: Any) -> Waypoints:
    """A path, whatever it warns of."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return Waypoints(*arguments, **options)


def rows(seed: int) -> tuple[Array, Array, bool]:
    """Times and points of a path, closed or not: random ones, on a grid, with pauses, uneven."""
    rng = np.random.default_rng([seed, 3])
    closed = bool(seed % 2)
    count = int(rng.integers(3 if closed else 2, 14))
    times = np.cumsum(np.exp(rng.choice([0.0, 0.5, 1.5]) * rng.standard_normal(count)))
    steps = rng.standard_normal((count, 3))
    points = (
        steps,
        np.cumsum(steps, axis=0),
        np.round(steps),
        np.cumsum(rng.integers(0, 2, (count, 1)) * steps, axis=0),
    )[seed // 2 % 4]
    if closed:
        points[-1] = points[0]
    return times, points, closed


def allowed_beyond(steps: Array, closed: bool) -> Array:
    """A quarter of the smaller neighbouring step of each piece."""
    count = len(steps)
    found = np.full(steps.shape, np.inf)
    for piece in range(count):
        for beside in (piece - 1, piece + 1):
            if closed or 0 <= beside < count:
                found[piece] = np.minimum(found[piece], 0.25 * steps[beside % count])
    return found


def beyond(values: Array, ends: Array) -> Array:
    """How far values (k, 3) lead beyond the span of two rows (2, 3)."""
    return np.maximum(values.max(axis=0) - ends.max(axis=0), ends.min(axis=0) - values.min(axis=0))


def accelerations(path: Waypoints, points: Array) -> tuple[Array, Array]:
    """Acceleration before and after each row, out of velocities: they are parabolas of time."""
    knots = path.times - path.times[0]
    before = np.zeros((len(knots), 3))
    after = np.zeros((len(knots), 3))
    for i, (start, end) in enumerate(pairwise(knots)):
        inner = start + (end - start) * np.array([0.25, 0.5, 0.75])
        v = path.sample(inner).linear_velocity
        parabola = np.polyfit(inner - start, v, 2)
        after[i] = parabola[1]
        before[i + 1] = 2.0 * parabola[0] * (end - start) + parabola[1]
    if path.ends == "closed":
        before[0] = before[-1]
    return before, after


@pytest.mark.parametrize("seeds", [range(k, k + 40) for k in (0, 40, 80)])
def test_no_piece_leaves_its_rows_by_more_than_a_quarter_of_a_neighbours_step(seeds: range) -> None:
    unchanged = 0
    for seed in seeds:
        times, points, closed = rows(seed)
        path = quiet(times, points, "closed" if closed else "clamped")
        steps = np.abs(np.diff(points, axis=0))
        allowed = allowed_beyond(steps, closed) + 2e-9 * steps.max()
        knots = times - times[0]
        cubic = CubicSpline(knots, points, bc_type="periodic" if closed else "clamped")
        keeps = True
        for piece, (start, end) in enumerate(pairwise(knots)):
            inner = np.linspace(start, end, 201)
            most = allowed[piece] if steps[piece].any() else 2e-9
            ends = points[piece : piece + 2]
            assert (beyond(path.sample(inner).position + points[0], ends) <= most).all(), seed
            keeps &= bool((beyond(cubic(inner), ends) <= most).all())
        if keeps:
            unchanged += 1
            np.testing.assert_allclose(
                path.sample(0.999 * knots).position, cubic(0.999 * knots) - points[0], atol=1e-12
            )
            assert not path.jumps.size
    assert unchanged >= 3


@pytest.mark.parametrize("seeds", [range(60)])
def test_velocity_never_jumps_and_acceleration_at_the_rows_named_alone(seeds: range) -> None:
    jumped = 0
    for seed in seeds:
        times, points, closed = rows(seed)
        path = quiet(times, points, "closed" if closed else "clamped")
        knots = times - times[0]
        scale = np.abs(np.diff(points, axis=0) / np.diff(times)[:, None]).max()
        inner = knots[:-1] if closed else knots
        h = 1e-9 * np.diff(knots).min()
        velocities = [path.sample(inner + side * h).linear_velocity for side in (-1, 1)]
        np.testing.assert_allclose(velocities[0], velocities[1], atol=1e-6 * scale)
        before, after = accelerations(path, points)
        largest = max(np.abs(before).max(), np.abs(after).max())
        named = np.isin(np.arange(len(times)), path.jumps)
        ends = [len(times) - 1] if closed else [0, len(times) - 1]
        named[ends] = True
        np.testing.assert_allclose(before[~named], after[~named], rtol=0, atol=1e-7 * largest)
        jumped += np.count_nonzero(np.abs(before - after)[path.jumps].max(axis=1) > 1e-6 * largest)
    assert jumped > 100


def test_slopes_at_a_pause_and_at_a_long_step_are_the_shape_preserving_ones() -> None:
    times = np.array([0.0, 1.0, 2.0, 12.0, 13.0, 14.0])
    points = np.zeros((6, 3))
    points[:, 0] = [0.0, 1.0, 2.0, 2.1, 3.0, 4.0]
    points[:, 1] = times / 14.0
    with pytest.warns(UserWarning, match=r"at 2 of 6 rows \(at 2, 12 s\).*leave the rows") as said:
        path = Waypoints(times, points)
    assert path.jumps.tolist() == [2, 3]
    assert len(said) == 1
    preserving = PchipInterpolator(times, points[:, 0]).derivative()
    velocities = path.sample(times).linear_velocity
    np.testing.assert_allclose(velocities[[2, 3], 0], preserving([2.0, 12.0]), rtol=1e-13)
    # Between them the spline of given end slopes, and along the other axis the cubic spline.
    first = CubicSpline(times[:3], points[:3, 0], bc_type=((1, 0.0), (1, preserving(2.0))))
    t = np.linspace(0.0, 2.0, 51)
    np.testing.assert_allclose(path.sample(t).position[:, 0], first(t), rtol=0, atol=1e-14)
    other = CubicSpline(times, points[:, 1], bc_type="clamped")
    t = np.linspace(0.0, 14.0, 99)
    np.testing.assert_allclose(path.sample(t).position[:, 1], other(t), rtol=0, atol=1e-14)


@pytest.mark.filterwarnings("ignore:the acceleration jumps")
def test_a_pause_is_one() -> None:
    times = np.array([0.0, 1.0, 6.0, 7.0])
    points = np.zeros((4, 3))
    points[1:3, 2] = -0.1
    half = Rotation.from_rotvec([1.0, 0.0, 0.0]).as_quat()[[3, 0, 1, 2]]
    quaternions = np.array([[1, 0, 0, 0], half, -half, [1, 0, 0, 0]])
    path = Waypoints(times, points, quaternions=quaternions)
    assert path.jumps.tolist() == [1, 2]
    pause = path.sample(np.linspace(1.0, 6.0, 101))
    np.testing.assert_allclose(pause.position, np.tile([0, 0, -0.1], (101, 1)), rtol=0, atol=1e-15)
    np.testing.assert_allclose(pause.rotation, np.tile(pause.rotation[0], (101, 1, 1)), atol=1e-12)
    np.testing.assert_allclose(pause.data[:, 12:], 0.0, rtol=0, atol=1e-8)
    long = Waypoints(np.arange(9.0), points[[0, 1, 1, 1, 1, 1, 1, 1, 0]])
    assert long.jumps.tolist() == [1, 7]  # inside the pause nothing jumps


@pytest.mark.parametrize("closed", [False, True])
def test_dense_smooth_rows_have_the_digits_of_scipys_splines(closed: bool) -> None:
    """A circle at 30 Hz, at constant speed if it is closed, else begun and ended slowly."""
    t = np.arange(301) / 30.0
    fraction = t / 10.0 if closed else 3.0 * (t / 10.0) ** 2 - 2.0 * (t / 10.0) ** 3
    angle = 2.0 * np.pi * fraction
    points = 0.1 * np.stack([np.cos(angle), np.sin(angle), np.zeros(301)], axis=1)
    points[-1] = points[0]
    turns = Rotation.from_rotvec(np.stack([np.sin(angle), 0.4 * np.sin(2 * angle), 0 * t], axis=1))
    path = Waypoints(t, points, "closed" if closed else "clamped", turns.as_quat()[:, [3, 0, 1, 2]])
    assert not path.jumps.size
    spline = CubicSpline(t, points - points[0], bc_type="periodic" if closed else "clamped")
    between = path.sample(t[:-1] + 0.01)
    moved = between.position - points[0]
    np.testing.assert_allclose(moved, spline(t[:-1] + 0.01), rtol=0, atol=1e-15)
    at = np.interp(t[:-1] + 0.01, t, fraction)  # to the second order in a step
    vectors = np.stack([np.sin(2 * np.pi * at), 0.4 * np.sin(4 * np.pi * at), 0 * at], axis=1)
    error = Rotation.from_matrix(between.rotation) * Rotation.from_rotvec(vectors).inv()
    assert error.magnitude().max() < 2e-4


def turning(seed: int) -> tuple[Array, Rotation, bool]:
    """Times and orientations, some of them equal, all less than half a turn apart."""
    rng = np.random.default_rng([seed, 4])
    closed = bool(seed % 2)
    count = int(rng.integers(4, 12))
    times = np.cumsum(np.exp(rng.choice([0.0, 0.5, 1.0]) * rng.standard_normal(count)))
    vectors = rng.standard_normal((count, 3)) * rng.choice([0.05, 0.2, 0.5], (count, 1))
    if seed % 3:  # steadily
        times = np.arange(float(count))
        vectors = rng.standard_normal(3) / count * (1.0 + 0.2 * vectors)
    else:
        vectors[rng.random(count) < 0.2] = 0.0
    turns = [Rotation.identity()]
    for vector in vectors[1:-1]:
        turns.append(Rotation.from_rotvec(vector) * turns[-1])
    turns.append(turns[0] if closed else Rotation.from_rotvec(vectors[-1]) * turns[-1])
    return times, Rotation.concatenate(turns), closed


def test_turns_are_the_spline_of_their_quaternions_where_that_stays_near() -> None:
    unchanged = 0
    for seed in range(60):
        times, turns, closed = turning(seed)
        if (turns[1:] * turns[:-1].inv()).magnitude().max() > 3.0:
            continue
        quaternions = turns.as_quat()
        for before, after in pairwise(quaternions):
            after *= np.copysign(1.0, before @ after)
        shuffled = (
            quaternions[:, [3, 0, 1, 2]] * np.where(np.arange(len(times)) % 2, 1, -1)[:, None]
        )
        ends = "closed" if closed else "clamped"
        path = quiet(times, np.zeros((len(times), 3)), ends, shuffled)
        is_a_smooth_turn(path, turns)
        if not path.jumps.size and (not closed or quaternions[-1] @ quaternions[0] > 0.0):
            unchanged += 1
            spline = CubicSpline(times, quaternions, bc_type="periodic" if closed else "clamped")
            inner = np.linspace(times[0], times[-1], 101)[:-1]
            wanted = Rotation.from_quat(spline(inner)).as_matrix()
            found = path.sample(inner - times[0]).rotation
            np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-12)
    assert unchanged > 5


def test_a_closed_path_may_turn_right_round() -> None:
    angles = np.linspace(0.0, 2.0 * np.pi, 13)
    turns = Rotation.from_rotvec(np.outer(angles, [0.0, 0.0, 1.0])).as_quat()[:, [3, 0, 1, 2]]
    path = Waypoints(np.arange(13.0), np.zeros((13, 3)), "closed", turns)
    targets = path.sample(np.linspace(-12.0, 24.0, 101))
    np.testing.assert_allclose(targets.angular_velocity[:, 2], np.pi / 6.0, rtol=1e-4)
    assert not path.jumps.size


def is_a_smooth_turn(path: Waypoints, turns: Rotation) -> None:
    """Rotations everywhere, which meet their rows and are continuous there in angle and rate."""
    knots = path.times - path.times[0]
    inner = [np.linspace(*ends, 50, endpoint=False) for ends in pairwise(knots)]
    targets = path.sample(np.concatenate(inner))
    products = targets.rotation @ targets.rotation.swapaxes(1, 2)
    np.testing.assert_allclose(
        products, np.tile(np.eye(3), (len(products), 1, 1)), rtol=0, atol=1e-14
    )
    quickest = np.abs(targets.angular_velocity).max()
    h = 1e-9 * np.diff(knots).min()
    rows = knots[:-1] + (path.duration if path.ends == "closed" else 0.0)
    before, after = (path.sample(rows + side * h) for side in (-1, 1))
    for side in (before, after):
        np.testing.assert_allclose(
            side.rotation, turns.as_matrix()[:-1], rtol=0, atol=1e-8 + 2.0 * h * quickest
        )
    np.testing.assert_allclose(
        before.angular_velocity, after.angular_velocity, rtol=0, atol=1e-6 * quickest
    )


@pytest.mark.parametrize("ends", ["clamped", "closed"])
def test_turns_at_uneven_times_are_smooth(ends: str) -> None:
    """Times whose steps differ up to 5,000 times."""
    for seed in range(40):
        rng = np.random.default_rng([seed, 5])
        count = int(rng.integers(3, 9))
        times = np.append(0.0, np.cumsum(10.0 ** rng.uniform(-2.7, 1.0, count - 1)))
        vectors = 0.5 * rng.standard_normal((count, 3))
        vectors[-1] = vectors[0]
        turns = Rotation.from_rotvec(vectors)
        path = quiet(times, np.zeros((count, 3)), ends, turns.as_quat()[:, [3, 0, 1, 2]])
        is_a_smooth_turn(path, turns)


def test_the_file_that_is_warned_of_is_named(tmp_path) -> None:
    file = tmp_path / "dwell.csv"
    file.write_text("t,x,y,z\n0,0,0,0\n1,0,0,-0.1\n6,0,0,-0.1\n7,0,0,0\n")
    said = r"^.*dwell.csv: the acceleration jumps at 2 of 4 rows \(at 1, 6 s\): .* leave the rows$"
    with pytest.warns(UserWarning, match=said) as caught:
        path = Waypoints.from_csv(file)
    assert caught[0].filename == __file__
    assert path.sample(np.linspace(0.0, 7.0, 701)).position[:, 2].min() >= -0.1 - 1e-15
