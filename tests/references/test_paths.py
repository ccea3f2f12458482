"""Every path: derivatives, period, start, anchoring and settings, and its own formula."""

import json
import math
import warnings
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pinocchio as pin
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

import iiwa_dnn as d
from iiwa_dnn.references import rotations
from iiwa_dnn.references.base import SoftStart

CORNERS = [[1, 2, 3], [1.2, 2, 3.1], [1.2, 2.3, 3], [1, 2, 3]]
TURNS = Rotation.from_rotvec([[3.0, 0.2, 0], [2.8, 0.9, 0.3], [2.4, 0.2, -0.8], [3.0, 0.2, 0]])
QUATERNIONS = TURNS.as_quat()[:, [3, 0, 1, 2]] * [[1], [-1], [1], [-1]]
POSE = d.Target([0.4, 0.1, 0.5], Rotation.from_rotvec([2.9, 0.4, -0.2]).as_matrix())


def waypoints(ends: Any = "clamped", quaternions: Any = None) -> d.Waypoints:
    """The corners as a path, whose limited slopes are warned of."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return d.Waypoints([5, 6, 8, 9], CORNERS, ends, quaternions)


CLOSED = [
    d.Heart(scale=2e-3, period=7.0),
    d.Circle(radius=0.2, period=5.0, normal=(1.0, -2.0, 0.5), begin=0.0),
    d.Circle(normal=(1.0, 0.1, 0.0), begin=0.0),
    d.Line(offset=(0.1, -0.2, 0.3), period=4.0),
    d.Lissajous(begin=0.0),
    d.Lissajous((0.1, 0.2, 0.3), (3, 2, 5), (0.3, 0.0, -1.0), 6.0, begin=0.0),
    d.Cone(0.3, 4.0, begin=0.0),
    d.Tilting(begin=0.0),
    d.Tilting(
        d.Lissajous((0.1, 0.2, 0.3), (3, 2, 5), (0.3, 0, -1), 5.0), 0.2, (1.0, 2.0, -1.0), begin=0
    ),
    d.Tilting(d.Heart(5e-3, 6.0), 0.4, (0.0, 1.0, 0.0), begin=0.0),
    d.Tilting(d.Line(), 0.4, begin=0.0),
    d.Tilting(waypoints("closed", QUATERNIONS), 0.2, begin=0.0),
    waypoints("closed"),
    waypoints("closed", QUATERNIONS),
]
OPEN = [
    waypoints(),
    waypoints(quaternions=QUATERNIONS),
]
SOFT = [
    d.Circle(radius=0.2, period=5.0, normal=(1.0, -2.0, 0.5)),
    d.Circle(period=25.0),
    d.Lissajous((0.1, 0.2, 0.3), (3, 2, 5), (0.3, 0.0, -1.0), 6.0, begin=2.5),
    d.Cone(0.05, 0.3),
    d.Tilting(d.Lissajous((0.1, 0.2, 0.3), (3, 2, 5), (0.3, 0, -1), 5.0, begin=0.3), 0.2),
    d.Tilting(d.Heart(5e-3, 6.0), 0.4, (0.0, 1.0, 0.0), begin=4.0),
    d.Tilting(waypoints("closed", QUATERNIONS), 0.2),
]
"""Paths with a soft start."""
TIMES = np.random.default_rng(4).uniform(-5.0, 25.0, 300)


def times(reference: d.Reference, count: int = 200) -> NDArray[np.float64]:
    """Seeded times inside the path."""
    return np.random.default_rng(5).uniform(0.01, reference.duration - 0.01, count)


@pytest.mark.parametrize("reference", CLOSED + OPEN + SOFT, ids=lambda path: type(path).__name__)
def test_the_twist_is_the_derivative_of_the_pose(reference: d.Reference) -> None:
    anchored = reference.anchored(POSE)
    t = times(reference)
    h = 1e-5
    before, after, now = (anchored.sample(t + step) for step in (-h, h, 0.0))
    turned = Rotation.from_matrix(after.rotation @ before.rotation.swapaxes(1, 2)).as_rotvec()
    np.testing.assert_allclose(now.angular_velocity, turned / (2 * h), rtol=0, atol=2e-8)
    moved = (after.position - before.position) / (2 * h)
    np.testing.assert_allclose(now.linear_velocity, moved, rtol=0, atol=2e-8)
    assert max(np.abs(moved).max(), np.abs(turned).max() / h) > 1e-3
    square = now.rotation @ now.rotation.swapaxes(1, 2)
    np.testing.assert_allclose(square, np.tile(np.eye(3), (len(t), 1, 1)), atol=1e-13)


@pytest.mark.parametrize("reference", CLOSED, ids=lambda path: type(path).__name__)
def test_closed_paths_repeat_after_their_period_and_not_before(reference: d.Reference) -> None:
    assert reference.duration == reference.period
    t = times(reference)
    now = reference.sample(t).data
    for rounds in (-1, 3):
        again = reference.sample(t + rounds * reference.period).data
        np.testing.assert_allclose(again, now, rtol=0, atol=1e-12)
    for part in (2, 3, 5):
        assert np.abs(reference.sample(t + reference.period / part).data - now).max() > 1e-3


@pytest.mark.parametrize(
    "reference", [*CLOSED, *OPEN, *SOFT, d.FixedPose()], ids=lambda path: type(path).__name__
)
def test_an_anchor_moves_the_start_and_keeps_the_axes(reference: d.Reference) -> None:
    anchored = reference.anchored(POSE)
    assert type(anchored) is type(reference)
    start = anchored.at(0.0)
    np.testing.assert_allclose(start.position, POSE.position, rtol=0, atol=1e-15)
    np.testing.assert_allclose(start.rotation, POSE.rotation, rtol=0, atol=1e-15)
    t = 0.3 * reference.duration
    free = reference.anchored(d.Target(np.zeros(3))).at(t)
    moved = anchored.anchored(POSE).at(t)  # again: displacements do not add up
    np.testing.assert_allclose(moved.position, POSE.position + free.position, atol=1e-15)
    if not isinstance(reference, d.Cone):  # which turns about the tool's axes, not the world's
        np.testing.assert_allclose(moved.rotation, free.rotation @ POSE.rotation, atol=1e-14)
        np.testing.assert_allclose(moved.data[12:], free.data[12:], rtol=0, atol=1e-15)


@pytest.mark.filterwarnings("ignore:the acceleration jumps")
@pytest.mark.parametrize("reference", CLOSED + OPEN + SOFT, ids=lambda path: type(path).__name__)
def test_settings_say_how_to_make_it_again(reference: d.Reference) -> None:
    settings = reference.settings()
    assert json.loads(json.dumps(settings, allow_nan=False)) == settings
    assert settings.pop("name") == type(reference).__name__.lower()
    if "along" in settings:
        settings["along"] = reference.along
    t = times(reference)
    targets = reference.sample(t)
    np.testing.assert_array_equal(type(reference)(**settings).sample(t).data, targets.data)
    np.testing.assert_array_equal(targets[7].data, reference.at(t[7]).data)
    for name in ("position", "rotation", "linear_velocity", "angular_velocity"):
        assert getattr(targets, name).shape[0] == t.size
        with pytest.raises(ValueError, match="read-only"):
            getattr(targets[3], name)[0] = 0.0


def test_the_heart_is_the_papers_formula_and_starts_at_rest() -> None:
    a, period = 3.45e-3, 10.0  # the defaults
    expected = []
    for t in TIMES:
        wt = 2 * math.pi / period * t
        x = a * 16 * math.sin(wt) ** 3
        y = a * (13 * math.cos(wt) - 5 * math.cos(2 * wt) - 2 * math.cos(3 * wt) - math.cos(4 * wt))
        expected.append((x, y - 5 * a, 0.0))
    np.testing.assert_allclose(d.Heart().sample(TIMES).position, expected, rtol=0, atol=1e-16)
    assert not d.Heart().at(0.0).linear_velocity.any()


@pytest.mark.parametrize("normal", [(0, 0, 1), (0, 0, -2), (1, 0, 0), (1, -2, 0.5)])
def test_a_circle_is_round_flat_and_turns_the_right_way(normal: tuple[float, ...]) -> None:
    circle = d.Circle(radius=0.3, period=4.0, normal=normal, begin=0.0)
    axis = np.array(normal) / np.linalg.norm(normal)
    targets = circle.sample(TIMES)
    radii = targets.position - circle.at(2.0).position / 2  # half a turn away is a diameter away
    np.testing.assert_allclose(np.linalg.norm(radii, axis=1), 0.3, rtol=1e-12)
    np.testing.assert_allclose(targets.position @ axis, 0.0, atol=1e-15)
    spin = (2 * math.pi / 4.0) * axis
    np.testing.assert_allclose(targets.linear_velocity, np.cross(spin, radii), rtol=0, atol=1e-13)


def test_a_line_goes_there_and_back_and_rests_at_both_ends() -> None:
    line = d.Line(offset=(0.1, 0.2, -0.3), period=8.0)
    expected = np.outer((1 - np.cos(math.pi / 4.0 * TIMES)) / 2, [0.1, 0.2, -0.3])
    np.testing.assert_allclose(line.sample(TIMES).position, expected, rtol=0, atol=1e-15)


def test_lissajous_is_a_sine_on_each_axis() -> None:
    figure = d.Lissajous((0.1, 0.2, 0.3), (1, 2, 3), (0.0, 0.5, -0.5), 5.0, begin=0.0)
    moved = figure.sample(TIMES).position
    for i, (a, k, phi) in enumerate(((0.1, 1, 0.0), (0.2, 2, 0.5), (0.3, 3, -0.5))):
        expected = a * (np.sin(2 * math.pi * k * TIMES / 5.0 + phi) - math.sin(phi))
        np.testing.assert_allclose(moved[:, i], expected, rtol=0, atol=1e-14)


def test_a_cone_keeps_its_angle_and_does_not_spin() -> None:
    targets = d.Cone(0.3, 4.0).anchored(POSE).sample(np.linspace(0.0, 4.0, 50))
    tool = targets.rotation[:, :, 2]
    # The axis that a rotation by -0.3 about the tool's x axis takes the start's to.
    axis = Rotation.from_rotvec(-0.3 * POSE.rotation[:, 0]).apply(tool[0])
    np.testing.assert_allclose(tool @ axis, np.cos(0.3), rtol=0, atol=1e-14)


@pytest.mark.parametrize("reference", [path for path in CLOSED if isinstance(path, d.Tilting)])
def test_a_tilting_tool_tilts_to_both_sides_along_the_same_path(reference: d.Tilting) -> None:
    t = np.linspace(0.0, reference.duration, 9)
    targets = reference.anchored(POSE).sample(t)
    is_soft = isinstance(reference.along, SoftStart)
    plain = replace(reference.along, begin=0.0) if is_soft else reference.along
    along = plain.anchored(POSE).sample(t)
    np.testing.assert_array_equal(targets.position, along.position)
    angles = reference.angle * np.sin(2 * np.pi * t / reference.duration)
    axis = np.array(reference.axis) / np.linalg.norm(reference.axis)
    tilted = Rotation.from_rotvec(angles[:, None] * axis).as_matrix() @ along.rotation
    np.testing.assert_allclose(targets.rotation, tilted, rtol=0, atol=1e-14)


def test_the_rotation_vector_is_the_shortest() -> None:
    random = np.random.default_rng(3)
    for angle in (0.0, 1e-9, 0.5, 3.0, np.pi - 1e-9, 4.0, 6.0):
        for axis in random.standard_normal((20, 3)):
            turn = Rotation.from_rotvec(angle * axis / np.linalg.norm(axis))
            found = np.empty(3)
            rotations.rotation_log(turn.as_matrix(), found)
            np.testing.assert_allclose(found, turn.as_rotvec(), rtol=0, atol=1e-12)


class Nodding(d.Heart):
    """A heart with an orientation of one's own, in Python."""

    def move(self, t: float, target: NDArray[np.float64]) -> None:
        super().move(t, target)
        target.rotation = pin.exp3(np.array([0.2 * np.sin(t), 0.0, 0.0])) @ target.rotation
        target.angular_velocity += [0.2 * np.cos(t), 0.0, 0.0]


def test_a_path_in_python_turns_the_anchors_orientation() -> None:
    target = Nodding().anchored(POSE).at(2.0)
    turned = Rotation.from_rotvec([0.2 * np.sin(2.0), 0, 0]).as_matrix() @ POSE.rotation
    np.testing.assert_allclose(target.rotation, turned, rtol=0, atol=1e-15)
    np.testing.assert_allclose(target.angular_velocity, [0.2 * np.cos(2.0), 0, 0], atol=1e-15)
    np.testing.assert_array_equal(target.linear_velocity, d.Heart().at(2.0).linear_velocity)
    assert Nodding().compiled is None
    assert d.Heart().compiled is d.Heart.path


def test_a_target_is_a_pose_or_a_position() -> None:
    pose = pin.SE3(POSE.rotation, POSE.position)
    np.testing.assert_array_equal(d.Target(pose).data, POSE.data)
    np.testing.assert_array_equal(d.Target(POSE.position).data[:3], POSE.position)
    np.testing.assert_array_equal(d.Target(POSE.position).rotation, np.eye(3))


FLAT = SimpleNamespace(position=[0, 0, 0], rotation=np.eye(2))
TURNED = {"times": range(4), "points": CORNERS, "ends": "closed", "quaternions": QUATERNIONS}
REFUSED = [
    (d.Heart, {"scale": math.nan}, "scale"),
    (d.Heart, {"period": 0}, "period"),
    (d.Circle, {"radius": -0.1}, "radius"),
    (d.Circle, {"normal": (0, 0, 0)}, "normal"),
    (d.Cone, {"angle": 0.0}, "angle"),
    (d.Tilting, {"turns": 0}, "turns"),
    (d.Tilting, {"begin": -1.0}, "begin"),
    (d.Circle, {"radius": None}, "radius"),
    (d.Tilting, {"along": None}, "along"),
    (d.Lissajous, {"begin": math.inf}, "begin"),
    (d.Tilting, {"along": Nodding()}, "along"),
    (d.FixedPose, {"period": 0.0}, "period"),
    (d.Heart().at, {"t": math.nan}, "t"),
    (d.Heart().sample, {"times": 1.0}, "times"),
    (d.Heart().anchored, {"pose": FLAT}, "rotation"),
    (d.Target, {"position": [0, 0, 0], "rotation": np.ones((3, 3))}, "rotation"),
    (d.MovingTarget, {"pose": POSE, "speed": -1.0}, "speed"),
    (d.Waypoints, {"times": [0, 1], "points": [[0, 0, 0]]}, "points"),
    (d.Waypoints, {"times": [0], "points": [[0, 0, 0]]}, "times"),
    (d.Waypoints, {"times": [0, 0], "points": np.eye(3)[:2]}, "times"),
    (d.Waypoints, TURNED | {"ends": "open"}, "ends"),
    (d.Waypoints, TURNED | {"points": np.eye(4)[:, :3]}, "points"),  # not closed
    (d.Waypoints, {"times": [0, 1], "points": np.zeros((2, 3)), "ends": "closed"}, "times"),
    (d.Waypoints, TURNED | {"noise": -1.0}, "noise"),
    (d.Waypoints, TURNED | {"turn_noise": math.nan}, "turn_noise"),
    (d.Waypoints, TURNED | {"noise": 0.2}, "noise"),  # more than the points spread
    (d.Waypoints, TURNED | {"turn_noise": 1.5}, "turn_noise"),
    (d.Waypoints, TURNED | {"quaternions": QUATERNIONS[:3]}, "quaternions"),
    (d.Waypoints, TURNED | {"quaternions": np.eye(4)}, "quaternions"),  # half a turn apart
    (d.Waypoints, TURNED | {"quaternions": QUATERNIONS[[0, 1, 2, 2]]}, "quaternions"),
]


@pytest.mark.parametrize(("call", "arguments", "named"), REFUSED)
def test_a_bad_argument_is_named(call: Any, arguments: dict[str, Any], named: str) -> None:
    with pytest.raises(d.InvalidInputError) as caught:
        call(**arguments)
    assert caught.value.argument == named
