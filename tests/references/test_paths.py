"""What holds for every reference: derivatives, period, start, anchoring, settings."""

from __future__ import annotations

import dataclasses
import json
import math
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.typing import NDArray

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.references import Circle, Heart, Line, Lissajous, Reference, Still, Waypoints
from iiwa_dnn.robot import Configuration, load_robot

CORNERS = [[1, 2, 3], [1.2, 2, 3.1], [1.2, 2.3, 3], [1, 2, 3]]
CLOSED = [
    Heart(scale=2e-3, period=7.0),
    Circle(radius=0.1, period=3.0),
    Circle(radius=0.2, period=5.0, normal=(1.0, -2.0, 0.5)),
    Circle(normal=(1.0, 0.1, 0.0)),
    Line(offset=(0.1, -0.2, 0.3), period=4.0),
    Lissajous(),
    Lissajous((0.1, 0.2, 0.3), (3, 2, 5), (0.3, 0.0, -1.0), 6.0),
    Waypoints([5, 6, 8, 9], CORNERS, "closed"),
]
OPEN = [Waypoints([5, 6, 8, 9], CORNERS, ends) for ends in ("clamped", "natural")]


def times(reference: Reference, count: int = 200) -> NDArray[np.float64]:
    """Seeded times inside the path."""
    return np.random.default_rng(5).uniform(0.0, reference.duration, count)


@pytest.mark.parametrize("reference", CLOSED + OPEN, ids=repr)
def test_velocity_is_the_derivative(reference: Reference) -> None:
    # Off the joints of a spline, across which a central difference is of lower order.
    t, step = times(reference), 1e-5 * reference.duration
    slope = (reference.displacement(t + step) - reference.displacement(t - step)) / (2 * step)
    speed = np.abs(slope).max()
    assert speed > 0
    np.testing.assert_allclose(reference.velocity(t), slope, rtol=0, atol=1e-7 * speed)


@pytest.mark.parametrize("reference", CLOSED + OPEN, ids=repr)
def test_starts_at_its_origin(reference: Reference) -> None:
    assert np.abs(reference.displacement(0.0)).max() == 0.0


@pytest.mark.parametrize("reference", CLOSED, ids=repr)
def test_closed_paths_repeat(reference: Reference) -> None:
    assert reference.duration == reference.period
    t = times(reference)
    for shift in (-reference.period, 3 * reference.period):
        for function in (reference.displacement, reference.velocity):
            np.testing.assert_allclose(function(t + shift), function(t), rtol=0, atol=1e-13)


@pytest.mark.parametrize("reference", CLOSED, ids=repr)
def test_no_shorter_period(reference: Reference) -> None:
    t = times(reference)
    for part in (2, 3, 5):
        moved = reference.displacement(t + reference.period / part) - reference.displacement(t)
        assert np.abs(moved).max() > 1e-3


@pytest.mark.parametrize("reference", CLOSED + OPEN, ids=repr)
@pytest.mark.parametrize("shape", [(), (4,), (2, 3), (0,)])
def test_vectorised(reference: Reference, shape: tuple[int, ...]) -> None:
    t = np.random.default_rng(6).uniform(-1.0, 12.0, shape)
    for function in (reference.displacement, reference.velocity):
        values = function(t)
        assert values.shape == (*shape, 3)
        one_by_one = [function(float(x)) for x in t.ravel()]
        np.testing.assert_allclose(
            values.reshape(-1, 3), np.reshape(one_by_one, (-1, 3)), atol=1e-15
        )


@pytest.mark.parametrize("reference", CLOSED + OPEN, ids=repr)
def test_anchored(reference: Reference) -> None:
    robot = load_robot("iiwa7")
    conf = Configuration(robot, np.random.default_rng(8).uniform(-1, 1, 7))
    anchored = reference.anchored(conf)
    assert type(anchored) is type(reference)
    start = anchored.at(0.0)
    np.testing.assert_array_equal(start.position, conf.position)
    np.testing.assert_array_equal(start.rotation, conf.rotation)
    t = 0.3 * reference.duration
    before, after = reference.at(t), anchored.at(t)
    np.testing.assert_array_equal(before.position, reference.displacement(t))
    np.testing.assert_array_equal(before.rotation, np.eye(3))
    np.testing.assert_array_equal(after.position, conf.position + before.position)
    np.testing.assert_array_equal(after.rotation, conf.rotation)
    np.testing.assert_array_equal(after.linear_velocity, reference.velocity(t))
    np.testing.assert_array_equal(after.angular_velocity, np.zeros(3))
    # Anchored again, it starts at the new place: displacements do not add up.
    again = anchored.anchored(SimpleNamespace(position=[1, 2, 3], rotation=np.eye(3)))
    np.testing.assert_array_equal(again.at(0.0).position, [1, 2, 3])


@pytest.mark.parametrize("reference", CLOSED + OPEN, ids=repr)
def test_sample_is_at_for_many_times(reference: Reference) -> None:
    anchored = reference.anchored(SimpleNamespace(position=[1, 2, 3], rotation=np.eye(3)[::-1]))
    t = times(reference, 20)
    targets = anchored.sample(t)
    assert len(targets) == 20
    names = ("position", "rotation", "linear_velocity", "angular_velocity")
    for i in range(-20, 20):
        one, other = targets[i], anchored.at(t[i])
        for name in names:
            np.testing.assert_allclose(getattr(one, name), getattr(other, name), rtol=0, atol=1e-15)
            assert not getattr(one, name).flags.writeable
            assert not getattr(other, name).flags.writeable
    with pytest.raises(IndexError):
        targets[20]


@pytest.mark.parametrize("reference", CLOSED + OPEN, ids=repr)
def test_settings_say_how_to_make_it_again(reference: Reference) -> None:
    settings = reference.settings()
    assert json.loads(json.dumps(settings, allow_nan=False)) == settings
    assert settings.pop("name") == type(reference).__name__.lower()
    again = type(reference)(**settings)
    t = times(reference)
    np.testing.assert_array_equal(again.displacement(t), reference.displacement(t))


@pytest.mark.parametrize("reference", CLOSED + OPEN, ids=repr)
def test_immutable(reference: Reference) -> None:
    for name in ("period", "origin", "orientation"):
        with pytest.raises((dataclasses.FrozenInstanceError, AttributeError)):
            setattr(reference, name, 1.0)
    with pytest.raises(ValueError, match="read-only"):
        reference.origin[0] = 1.0
    with pytest.raises(AttributeError):
        reference.at(0.0).position = None


def test_bad_times_and_poses() -> None:
    heart = Heart()
    for bad in (math.nan, math.inf, [1.0, 2.0], "now"):
        with pytest.raises(InvalidInputError, match=r"^t: "):
            heart.at(bad)
    for bad in ([0.0, math.nan], 1.0, [[1.0]]):
        with pytest.raises(InvalidInputError, match=r"^times: "):
            heart.sample(bad)
    with pytest.raises(InvalidInputError, match=r"^position: "):
        heart.anchored(SimpleNamespace(position=[0, 0, math.nan], rotation=np.eye(3)))
    with pytest.raises(InvalidInputError, match=r"^rotation: "):
        heart.anchored(SimpleNamespace(position=[0, 0, 0], rotation=np.eye(2)))


@pytest.mark.parametrize(
    ("make", "argument"),
    [
        *[(lambda v=v: Heart(scale=v), "scale") for v in (0, -1, math.nan, math.inf, "1", None)],
        (lambda: Heart(period=0), "period"),
        (lambda: Circle(radius=-0.1), "radius"),
        (lambda: Circle(period=math.inf), "period"),
        (lambda: Circle(normal=(0, 0, 0)), "normal"),
        (lambda: Circle(normal=(0, 1)), "normal"),
        (lambda: Line(offset=(0, 0, 0)), "offset"),
        (lambda: Line(offset=(math.nan, 0, 0)), "offset"),
        (lambda: Line(period=-1), "period"),
        (lambda: Lissajous(turns=(0.5, 1, 1)), "turns"),
        (lambda: Lissajous(amplitudes=(0, 0, 1), turns=(1, 1, 0)), "amplitudes"),
        (lambda: Lissajous(phases="abc"), "phases"),
        (lambda: Lissajous(period=0), "period"),
    ],
)
def test_bad_parameters(make, argument: str) -> None:
    with pytest.raises(InvalidInputError) as caught:
        make()
    assert caught.value.argument == argument


def test_a_pose_that_is_held_does_not_move() -> None:
    robot = load_robot("iiwa7")
    q0 = robot.start_posture()
    goal = Configuration(robot, q0 + 0.1)
    still = Still(period=3.0).anchored(goal)
    targets = still.sample([0.0, 1.0, 2.9])
    np.testing.assert_array_equal(targets.position, np.tile(goal.position, (3, 1)))
    np.testing.assert_array_equal(targets.data[:, 12:], 0.0)
    assert still.duration == 3.0
    with pytest.raises(InvalidInputError, match="period"):
        Still(period=0.0)
