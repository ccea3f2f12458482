"""Paths on which the tool turns, against finite differences, scipy and closed forms."""

from __future__ import annotations

import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

from iiwa_dnn.errors import FileError, InvalidInputError
from iiwa_dnn.references import (
    Circle,
    Cone,
    Heart,
    Lissajous,
    OnSurface,
    Reference,
    Tilting,
    Waypoints,
    rotations,
)

TIMES = [2.0, 3.0, 5.0, 6.0, 8.5]
POINTS = [[0.4, 0, 0.5], [0.5, 0.1, 0.5], [0.5, 0.2, 0.6], [0.4, 0.2, 0.5], [0.4, 0, 0.5]]
TURNS = Rotation.from_rotvec(
    [[3.0, 0.2, 0], [2.8, 0.9, 0.3], [2.4, 0.2, -0.8], [3.0, -0.5, 0.4], [3.0, 0.2, 0]]
)
QUATERNIONS = TURNS.as_quat()[:, [3, 0, 1, 2]] * [[1], [-1], [1], [1], [-1]]
TILTED = SimpleNamespace(
    position=np.array([0.4, 0.1, 0.5]), rotation=Rotation.from_rotvec([2.9, 0.4, -0.2]).as_matrix()
)
POSES = [Waypoints(TIMES, POINTS, ends, QUATERNIONS) for ends in ("clamped", "natural", "closed")]
TURNING = [
    *POSES,
    Cone(0.3, 4.0),
    Tilting(),
    Tilting(Lissajous(period=5.0), 0.2, (1.0, 2.0, -1.0), 3),
    Tilting(Cone(0.3, 4.0), 0.2, (0.0, 1.0, 0.0)),
    OnSurface(),
    OnSurface(Circle(0.1, 4.0), radius=0.25),
    OnSurface(Heart(5e-3, 6.0), 0.2, (0.3, -0.2, 1.0), 1.5),
    OnSurface(Heart(5e-3, 6.0), None, (0.0, 0.0, -1.0), 1.5),
]


@pytest.mark.parametrize("reference", TURNING, ids=repr)
def test_the_twist_is_the_derivative_of_the_pose(reference: Reference) -> None:
    anchored = reference.anchored(TILTED)
    t, h = np.random.default_rng(5).uniform(0.05, anchored.duration - 0.05, 100), 1e-5
    before, after, now = (anchored.sample(t + step) for step in (-h, h, 0.0))
    turned = Rotation.from_matrix(after.rotation @ before.rotation.swapaxes(1, 2)).as_rotvec()
    np.testing.assert_allclose(now.angular_velocity, turned / (2 * h), rtol=0, atol=2e-8)
    moved = (after.position - before.position) / (2 * h)
    np.testing.assert_allclose(now.linear_velocity, moved, rtol=0, atol=2e-8)
    np.testing.assert_allclose(
        now.rotation @ now.rotation.swapaxes(1, 2)[:], [np.eye(3)] * 100, atol=1e-13
    )


@pytest.mark.parametrize("reference", TURNING, ids=repr)
def test_it_starts_at_its_anchor_and_methods_agree_with_targets(reference: Reference) -> None:
    start = reference.anchored(TILTED).at(0.0)
    np.testing.assert_allclose(start.position, TILTED.position, rtol=0, atol=1e-15)
    np.testing.assert_allclose(start.rotation, TILTED.rotation, rtol=0, atol=1e-15)
    free = reference.at_rest()
    t = np.linspace(0.0, free.duration, 7)
    np.testing.assert_array_equal(free.turn(t), free.sample(t).rotation)
    np.testing.assert_array_equal(free.angular_velocity(t), free.sample(t).angular_velocity)
    assert free.turn(0.5).shape == (3, 3)


@pytest.mark.parametrize("poses", POSES, ids=lambda poses: poses.ends)
def test_poses_are_met_with_continuous_exact_accelerations(poses: Waypoints) -> None:
    at = poses.sample(np.array(TIMES) - TIMES[0])
    np.testing.assert_allclose(at.position, POINTS, rtol=0, atol=1e-14)
    np.testing.assert_allclose(at.rotation, TURNS.as_matrix(), rtol=0, atol=1e-14)
    knots = np.array(TIMES[1:-1]) - TIMES[0]
    before, after = poses.acceleration(knots - 1e-9), poses.acceleration(knots + 1e-9)
    np.testing.assert_allclose(before, after, rtol=0, atol=2e-7)
    t, h = np.random.default_rng(6).uniform(0.01, 6.49, 200), 1e-5
    t = t[np.abs(t[:, None] - knots).min(axis=1) > 2 * h]
    lead, lag = poses.sample(t + h), poses.sample(t - h)
    slope = (lead.data[:, 12:] - lag.data[:, 12:]) / (2 * h)
    np.testing.assert_allclose(poses.acceleration(t), slope, rtol=0, atol=2e-7)
    ends = poses.sample([0.0, poses.duration])
    if poses.ends == "clamped":
        np.testing.assert_array_less(np.abs(ends.data[:, 12:]), 1e-13)
    elif poses.ends == "natural":
        np.testing.assert_array_less(np.abs(poses.acceleration([0.0, poses.duration])), 1e-12)
    else:
        np.testing.assert_allclose(ends[0].data, ends[1].data, rtol=0, atol=1e-12)
        np.testing.assert_allclose(
            poses.acceleration(1e-9), poses.acceleration(poses.duration - 1e-9), atol=2e-7
        )


@pytest.mark.parametrize(
    ("ends", "scipys"), [("natural",) * 2, ("clamped",) * 2, ("closed", "periodic")]
)
def test_about_one_axis_it_is_the_cubic_spline_of_the_angle(ends: str, scipys: str) -> None:
    axis, angles = np.array([0.6, 0.0, 0.8]), np.array([0.1, 1.4, -0.9, 0.3, 0.1])
    turns = Rotation.from_rotvec(angles[:, None] * axis)
    path = Waypoints(TIMES, POINTS, ends, turns.as_quat()[:, [3, 0, 1, 2]])
    spline, t = CubicSpline(TIMES, angles, bc_type=scipys), np.linspace(0.0, 6.5, 301)
    targets = path.sample(t)
    wanted = Rotation.from_rotvec(spline(t + 2.0)[:, None] * axis).as_matrix()
    np.testing.assert_allclose(targets.rotation, wanted, rtol=0, atol=1e-13)
    rates = spline(t + 2.0, 1)[:, None] * axis
    np.testing.assert_allclose(targets.angular_velocity, rates, rtol=0, atol=1e-12)
    np.testing.assert_allclose(
        path.acceleration(t)[:, 3:], spline(t + 2.0, 2)[:, None] * axis, rtol=0, atol=1e-11
    )


def test_a_cone_keeps_its_angle_and_does_not_spin() -> None:
    cone = Cone(0.3, 4.0).anchored(TILTED)
    targets = cone.sample(np.linspace(0.0, 4.0, 50))
    tool = targets.rotation[:, :, 2]
    # The axis that a rotation by -0.3 about the tool's x axis takes the start's to.
    axis = Rotation.from_rotvec(-0.3 * TILTED.rotation[:, 0]).apply(tool[0])
    np.testing.assert_allclose(tool @ axis, np.cos(0.3), rtol=0, atol=1e-14)
    np.testing.assert_array_equal(targets.position, np.tile(TILTED.position, (50, 1)))
    np.testing.assert_allclose(targets.rotation[-1], TILTED.rotation, atol=1e-14)


def test_a_tilting_circle_tilts_by_its_angle_to_both_sides() -> None:
    path = Tilting(Circle(0.1, 4.0), math.radians(20.0), (0.0, 2.0, 0.0))
    t = np.linspace(0.0, 4.0, 9)
    tilts = Rotation.from_matrix(path.turn(t)).as_rotvec()[:, 1]
    np.testing.assert_allclose(tilts, math.radians(20) * np.sin(np.pi * t / 2), rtol=0, atol=1e-15)
    np.testing.assert_array_equal(path.displacement(t), Circle(0.1, 4.0).displacement(t))


def directions(path: Reference, t: NDArray[np.float64]) -> tuple[NDArray[np.float64], ...]:
    """Positions, and the tool's axis out of the surface."""
    targets = path.sample(t)
    return targets.position, -targets.rotation[:, :, 2]


def test_on_a_sphere_the_tool_points_to_its_centre_and_lengths_from_the_start_are_kept() -> None:
    path = OnSurface(Heart(5e-3, 6.0), 0.2).anchored(TILTED)
    t = np.linspace(0.0, 6.0, 100)
    position, normal = directions(path, t)
    np.testing.assert_allclose(
        position - 0.2 * normal, np.tile(position[0] - 0.2 * normal[0], (100, 1)), atol=1e-14
    )
    flat = np.linalg.norm(Heart(5e-3, 6.0).displacement(t), axis=1)
    np.testing.assert_allclose(0.2 * np.arccos(np.clip(normal @ normal[0], -1, 1)), flat, atol=1e-8)


@pytest.mark.parametrize("normal", [None, (0.3, -0.2, 1.0), (0.0, 0.0, -1.0)])
def test_on_a_plane_the_tool_stays_normal(normal: tuple[float, float, float] | None) -> None:
    path = OnSurface(Heart(5e-3, 6.0), None, normal).anchored(TILTED)
    lead = 0.0 if normal is None else 2.0
    t = np.linspace(lead, lead + 6.0, 100)
    position, out = directions(path, t)
    wanted = -TILTED.rotation[:, 2] if normal is None else np.array(normal)
    np.testing.assert_allclose(out, np.tile(wanted / np.linalg.norm(wanted), (100, 1)), atol=1e-14)
    np.testing.assert_allclose((position - TILTED.position) @ wanted, 0.0, atol=1e-15)
    flat = Heart(5e-3, 6.0).displacement(t - lead)
    distances = [np.linalg.norm(at[:, None] - at, axis=2) for at in (position, flat)]
    np.testing.assert_allclose(*distances, atol=1e-14)
    assert path.duration == lead + 6.0


class Nodding(Heart):
    """A heart with an orientation of one's own."""

    def turn(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        angle = 0.2 * np.sin(np.asarray(t))[..., None] * [1.0, 0.0, 0.0]
        return Rotation.from_rotvec(angle.reshape(-1, 3)).as_matrix().reshape(*np.shape(t), 3, 3)

    def angular_velocity(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        return 0.2 * np.cos(np.asarray(t))[..., None] * [1.0, 0.0, 0.0]


def test_an_orientation_of_ones_own_turns_the_anchors() -> None:
    target = Nodding().anchored(TILTED).at(2.0)
    turned = Rotation.from_rotvec([0.2 * np.sin(2.0), 0, 0]).as_matrix() @ TILTED.rotation
    np.testing.assert_allclose(target.rotation, turned, rtol=0, atol=1e-15)
    np.testing.assert_allclose(target.angular_velocity, [0.2 * np.cos(2.0), 0, 0], atol=1e-15)
    np.testing.assert_array_equal(target.linear_velocity, Heart().velocity(2.0))
    with pytest.raises(TypeError, match="both turn and angular_velocity"):
        type("Half", (Heart,), {"turn": Nodding.turn})


@pytest.mark.parametrize(
    ("make", "argument"),
    [
        (lambda: Cone(angle=1.6), "angle"),
        (lambda: Cone(period=0.0), "period"),
        (lambda: Tilting(axis=(0.0, 0.0, 0.0)), "axis"),
        (lambda: Tilting(turns=0), "turns"),
        (lambda: OnSurface(radius=-1.0), "radius"),
        (lambda: OnSurface(normal=(0.0, 0.0, 0.0)), "normal"),
        (lambda: Waypoints(TIMES, POINTS, "clamped", QUATERNIONS[:4]), "quaternions"),
        (lambda: Waypoints(TIMES, POINTS, "clamped", 1.1 * QUATERNIONS), "quaternions"),
        (lambda: Waypoints(TIMES[:3], POINTS[:3], "clamped", np.eye(4)[:3]), "quaternions"),
        (lambda: Waypoints(TIMES[:4], [*POINTS[:3], POINTS[0]], "closed", QUATERNIONS[:4]), "quat"),
    ],
)
def test_a_bad_parameter_is_named(make: object, argument: str) -> None:
    with pytest.raises(InvalidInputError, match=rf"^{argument}"):
        make()


# Poses out of a file


def write(folder: Path, header: str, rows: NDArray[np.float64]) -> Path:
    path = folder / "poses.csv"
    path.write_text("\n".join([header, *(",".join(map(repr, row)) for row in rows.tolist())]))
    return path


def test_poses_of_a_file_are_in_the_base_frame_with_or_without_times(tmp_path: Path) -> None:
    poses = np.hstack([POINTS, QUATERNIONS])
    timed = np.hstack([np.array(TIMES)[:, None], poses])
    read = Waypoints.from_csv(write(tmp_path, "t,x,y,z,qw,qx,qy,qz", timed))
    t = np.linspace(0.0, read.duration, 20)
    np.testing.assert_array_equal(read.sample(t).data, POSES[0].sample(t).data)
    np.testing.assert_array_equal(read.at(0.0).position, POINTS[0])
    path = write(tmp_path, "x,y,z,qw,qx,qy,qz", poses)
    untimed = Waypoints.from_csv(path, speed=0.1, rate=0.7)
    lengths = np.linalg.norm(np.diff(POINTS, axis=0), axis=1)
    angles = (TURNS[1:] * TURNS[:-1].inv()).magnitude()
    np.testing.assert_allclose(np.diff(untimed.times), np.maximum(lengths / 0.1, angles / 0.7))


@pytest.mark.parametrize(
    ("header", "rows", "problem"),
    [
        ("x,y,z,qw", [[0, 0, 0, 1]] * 2, "header"),
        ("x,y,z,qw,qx,qy,qz", [[0, 0, 0, 1, 0, 0, 0]] * 2, "increase"),
        ("x,y,z", [[0, 0, 0], [1, 0, 0]], "header"),
        ("x,y,z,qw,qx,qy,qz", [[0, 0, 0, 1, 0, 0, 0], [1, 0, 0, 2, 0, 0, 0]], "length 1"),
    ],
)
def test_a_bad_file_of_poses_is_told(
    header: str, rows: list[list[float]], problem: str, tmp_path: Path
) -> None:
    with pytest.raises(FileError, match=problem):
        Waypoints.from_csv(write(tmp_path, header, np.array(rows)))


def test_what_task_rows_call_too_states_its_arithmetic() -> None:
    for function in (rotations.coefficients, rotations.cross, rotations.rotated):
        # Unstated, it would be the first caller's, and bytes a matter of what was compiled first.
        assert function.targetoptions["fastmath"] == {"contract"}
