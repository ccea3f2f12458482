"""Waypoints: the spline's properties, and CSV files good and bad."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from iiwa_dnn.errors import FileError, InvalidInputError
from iiwa_dnn.references import Waypoints

TIMES = np.array([2.0, 2.5, 4.0, 4.2, 6.0])
POINTS = np.random.default_rng(9).uniform(-0.3, 0.3, (5, 3))
LOOP = np.vstack([POINTS[:-1], POINTS[0]])
GOOD = "t,x,y,z\n0,0,0,0\n1,1,2,3\n"


def acceleration(path: Waypoints, t: float, side: int) -> NDArray[np.float64]:
    """Second derivative just before (-1) or after (1) a time; the velocity is quadratic there."""
    h = side * 1e-3
    v0, v1, v2 = path.velocity(np.array([t, t + h, t + 2 * h]))
    return (-3 * v0 + 4 * v1 - v2) / (2 * h)


@pytest.mark.parametrize("ends", ["clamped", "natural", "closed"])
def test_meets_its_points_smoothly(ends: str) -> None:
    points = LOOP if ends == "closed" else POINTS
    path = Waypoints(TIMES, points, ends)
    knots = TIMES - TIMES[0]
    np.testing.assert_allclose(path.displacement(knots), points - points[0], rtol=0, atol=1e-15)
    smooth = knots if ends == "closed" else knots[1:-1]
    for t in smooth:
        before, after = path.velocity(np.array([t - 1e-9, t + 1e-9]))
        np.testing.assert_allclose(before, after, rtol=0, atol=1e-6)
        np.testing.assert_allclose(acceleration(path, t, -1), acceleration(path, t, 1), atol=1e-8)


def test_clamped_ends_rest() -> None:
    path = Waypoints(TIMES, POINTS)
    assert np.abs(path.velocity([0.0, 4.0])).max() < 1e-14
    # Between two points that is the one cubic with four known values.
    s = np.linspace(0.0, 1.0, 11)[:, np.newaxis]
    two = Waypoints([1.0, 3.0], [[1, 1, 1], [2, 3, -1]])
    np.testing.assert_allclose(
        two.displacement(2.0 * s[:, 0]), (3 * s**2 - 2 * s**3) * [1, 2, -2], rtol=0, atol=1e-15
    )


def test_natural_ends_do_not_accelerate() -> None:
    path = Waypoints(TIMES, POINTS, "natural")
    assert np.abs(acceleration(path, 0.0, 1)).max() < 1e-9
    assert np.abs(acceleration(path, 4.0, -1)).max() < 1e-9
    assert np.abs(path.velocity([0.0, 4.0])).min() > 1e-3


def test_open_paths_rest_before_and_after() -> None:
    for ends in ("clamped", "natural"):
        path = Waypoints(TIMES, POINTS, ends)
        assert (path.duration, path.period) == (4.0, np.inf)
        outside = np.array([-1.0, -1e-9, 4.0 + 1e-9, 100.0])
        expected = np.array([[0, 0, 0], [0, 0, 0], *[POINTS[-1] - POINTS[0]] * 2])
        np.testing.assert_allclose(path.displacement(outside), expected, rtol=0, atol=1e-15)
        assert not path.velocity(outside).any()


def test_closed_path_approaches_a_circle() -> None:
    angle = np.linspace(0.0, 2 * np.pi, 65)
    points = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=-1)
    points[-1] += 5e-10  # its last point need only nearly be its first
    path = Waypoints(angle, points, "closed")
    assert path.period == pytest.approx(2 * np.pi)
    t = np.random.default_rng(10).uniform(-10, 20, 500)
    circle = np.stack([np.cos(t) - 1, np.sin(t), 0 * t], axis=-1)
    tangent = np.stack([-np.sin(t), np.cos(t), 0 * t], axis=-1)
    assert np.abs(path.displacement(t) - circle).max() < 1e-6
    assert np.abs(path.velocity(t) - tangent).max() < 1e-5


@pytest.mark.parametrize(
    ("arguments", "argument"),
    [
        (([0, 1], [[0, 0, 0]]), "points"),
        (([0, 1], [[0, 0], [1, 1]]), "points"),
        (([0], [[0, 0, 0]]), "times"),
        (([0, 0], [[0, 0, 0], [1, 1, 1]]), "times"),
        (([1, 0], [[0, 0, 0], [1, 1, 1]]), "times"),
        (([0, np.nan], [[0, 0, 0], [1, 1, 1]]), "times"),
        (([0, 1], [[0, 0, 0], [1, np.inf, 1]]), "points"),
        (([0, 1e-320, 1], [[0, 0, 0], [1, 1, 1], [0, 0, 0]]), "times"),
        (([0, 1], [[-1e308, 0, 0], [1e308, 0, 0]]), "times"),
        (([0, 1], [[0, 0, 0], [1, 1, 1]], "open"), "ends"),
        (([0, 1], [[0, 0, 0], [0, 0, 0]], "closed"), "times"),
        (([0, 1, 2], [[0, 0, 0], [1, 1, 1], [0, 0, 1e-6]], "closed"), "points"),
    ],
)
@pytest.mark.filterwarnings("error")
def test_bad_points(arguments: tuple[object, ...], argument: str) -> None:
    with pytest.raises(InvalidInputError) as caught:
        Waypoints(*arguments)
    assert caught.value.argument == argument


def test_csv_round_trip(tmp_path: Path) -> None:
    file = tmp_path / "loop.csv"
    rows = [",".join(map(repr, map(float, (t, *p)))) for t, p in zip(TIMES, LOOP, strict=True)]
    file.write_text("\n".join(["t,x,y,z", *rows]) + "\n", encoding="utf-8")
    path = Waypoints.from_csv(file, ends="closed")
    assert path.settings() == Waypoints(TIMES, LOOP, "closed").settings()
    assert repr(path) == "Waypoints(5 points, 4 s, ends='closed')"


@pytest.mark.parametrize(
    "text",
    [
        "\ufeff" + GOOD,
        GOOD.replace("\n", "\r\n"),
        GOOD.replace(",", " , "),
        "\n T,X,Y,Z\n\n" + GOOD[8:],
    ],
)
def test_csv_dialects(tmp_path: Path, text: str) -> None:
    file = tmp_path / "some.csv"
    file.write_bytes(text.encode())
    np.testing.assert_array_equal(Waypoints.from_csv(str(file)).points, [[0, 0, 0], [1, 2, 3]])


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        ("", "line 1: the header"),
        ("t,x,y\n0,0,0\n", "line 1: the header"),
        ("0,0,0,0\n1,1,2,3\n", "line 1: the header"),
        ("t,x,y,z\n", "at least 2 rows are needed, it has 0"),
        ("t,x,y,z\n0,0,0,0\n", "at least 2 rows are needed, it has 1"),
        (GOOD + "2,1,one,1\n", "line 4: y is 'one', not a finite number"),
        (GOOD + "2,1,,1\n", "line 4: y is '', not a finite number"),
        (GOOD + "\n2,1,1,nan\n", "line 5: z is 'nan', not a finite number"),
        (GOOD + "inf,1,1,1\n", "line 4: t is 'inf', not a finite number"),
        (GOOD + "1,1,1,1\n", "line 4: t does not increase"),
        (GOOD + "0.5,1,1,1\n", "line 4: t does not increase"),
        (GOOD + "2,1,1\n", "line 4: 4 columns are needed, it has 3"),
        (GOOD + "2,1,1,1,1\n", "line 4: 4 columns are needed, it has 5"),
        (GOOD.encode() + b"\xff\xfe", "not UTF-8"),
        (GOOD + "1.0000000000000002,1e300,1,1\n", "no spline fits"),
    ],
)
@pytest.mark.filterwarnings("error")
def test_bad_csv(tmp_path: Path, content: str | bytes, reason: str) -> None:
    file = tmp_path / "bad.csv"
    file.write_bytes(content.encode() if isinstance(content, str) else content)
    with pytest.raises(FileError, match=reason) as caught:
        Waypoints.from_csv(file)
    assert caught.value.path == str(file)
    assert "\n" not in str(caught.value)


def test_csv_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="No such file"):
        Waypoints.from_csv(tmp_path / "none.csv")
    with pytest.raises(FileError, match="directory"):
        Waypoints.from_csv(tmp_path)
    with pytest.raises(FileError, match="null byte"):
        Waypoints.from_csv("a\0.csv")


def test_csv_with_unknown_ends(tmp_path: Path) -> None:
    (tmp_path / "good.csv").write_text(GOOD)
    with pytest.raises(InvalidInputError, match=r"^ends: "):
        Waypoints.from_csv(tmp_path / "good.csv", ends="open")


def test_a_stretched_file_is_the_same_path_more_slowly(tmp_path: Path) -> None:
    file = tmp_path / "path.csv"
    file.write_text("t,x,y,z\n0,0,0,0\n2,0.05,0,-0.02\n4,0.05,0.05,0\n")
    plain = Waypoints.from_csv(file)
    slow = Waypoints.from_csv(file, stretch=1.4)
    assert slow.duration == pytest.approx(5.6, rel=1e-15)
    for t in (0.0, 0.7, 2.0, 3.9):
        before = plain.at(t)
        after = slow.at(1.4 * t)
        np.testing.assert_allclose(after.position, before.position, rtol=0, atol=1e-15)
        velocity = before.linear_velocity / 1.4
        np.testing.assert_allclose(after.linear_velocity, velocity, rtol=0, atol=1e-15)
    file.write_text("x,y,z,qw,qx,qy,qz\n0,0,0,1,0,0,0\n0.05,0,0,1,0,0,0\n")
    with pytest.raises(InvalidInputError, match=r"^stretch: is for a file with times"):
        Waypoints.from_csv(file, stretch=1.4)
    with pytest.raises(InvalidInputError, match=r"^stretch"):
        Waypoints.from_csv(file, stretch=0.0)
