"""Waypoints: the splines' properties, and CSV files good and bad."""

import warnings
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from iiwa_dnn import FileError, InvalidInputError, Waypoints

TIMES = np.array([2.0, 3.0, 5.0, 6.0, 8.5])
POINTS = np.array([[0.4, 0, 0.5], [0.5, 0.1, 0.5], [0.5, 0.2, 0.6], [0.4, 0.2, 0.5], [0.4, 0, 0.5]])
TURNS = Rotation.from_rotvec(
    [[3.0, 0.2, 0], [2.8, 0.9, 0.3], [2.4, 0.2, -0.8], [3.0, -0.5, 0.4], [3.0, 0.2, 0]]
)
QUATERNIONS = TURNS.as_quat()[:, [3, 0, 1, 2]] * [[1], [-1], [1], [1], [-1]]
GOOD = "t,x,y,z\n0,0,0,0\n1,1,2,3\n"
POSE_HEADER = "x,y,z,qw,qx,qy,qz"


def acceleration(path: Waypoints, t: float, side: int) -> NDArray[np.float64]:
    """Derivative of the twist just before (-1) or after (1) a time, to the third order."""
    h = side * 1e-4
    twists = path.sample(t + h * np.arange(4)).data[:, 12:]
    return np.array([-11.0, 18.0, -9.0, 2.0]) @ twists / (6.0 * h)


@pytest.mark.parametrize("ends", ["clamped", "closed"])
def test_poses_are_met_without_a_jump_of_the_acceleration(ends: str) -> None:
    knots = np.arange(13.0)
    angle = (
        np.pi / 6.0 * knots if ends == "closed" else np.pi * (1.0 - np.cos(np.pi / 12.0 * knots))
    )
    points = 0.1 * np.stack([np.cos(angle), np.sin(angle), np.sin(2.0 * angle)], axis=1)
    turns = Rotation.from_rotvec(8.0 * points[:, [2, 0, 1]])
    signs = np.where(knots % 3, 1.0, -1.0)[:, np.newaxis]
    path = Waypoints(knots + 2.0, points, ends, signs * turns.as_quat()[:, [3, 0, 1, 2]])
    targets = path.sample(knots)
    np.testing.assert_allclose(targets.position, points, rtol=0, atol=1e-14)
    np.testing.assert_allclose(targets.rotation, turns.as_matrix(), rtol=0, atol=1e-14)
    assert not path.jumps.size
    for t in knots if ends == "closed" else knots[1:-1]:
        before = acceleration(path, t - 1e-12, -1)
        np.testing.assert_allclose(before, acceleration(path, t + 1e-12, 1), rtol=0, atol=1e-6)
    if ends == "clamped":
        assert np.abs(path.sample([0.0, 12.0]).data[:, 12:]).max() < 1e-9
        assert (path.duration, path.period) == (12.0, np.inf)
        outside = path.sample([-1.0, -1e-9, 12.0 + 1e-9, 100.0])
        expected = turns.as_matrix()[[0, 0, -1, -1]]
        np.testing.assert_allclose(outside.rotation, expected, rtol=0, atol=1e-14)
        assert not outside.data[:, 12:].any()


def write(folder: Path, header: str, rows: NDArray[np.float64]) -> Path:
    path = folder / "path.csv"
    path.write_text("\n".join([header, *(",".join(map(repr, row)) for row in rows.tolist())]))
    return path


@pytest.mark.filterwarnings("ignore:.*the acceleration jumps")
def test_poses_of_a_file_are_in_the_base_frame(tmp_path: Path) -> None:
    poses = np.hstack([POINTS, QUATERNIONS])
    timed = write(tmp_path, f"t,{POSE_HEADER}", np.hstack([TIMES[:, None], poses]))
    read = Waypoints.from_csv(timed, ends="closed")
    assert read.settings() == Waypoints(TIMES, POINTS, "closed", QUATERNIONS).settings()
    np.testing.assert_array_equal(read.at(0.0).position, POINTS[0])


def test_a_stretched_file_is_the_same_path_more_slowly(tmp_path: Path) -> None:
    file = write(tmp_path, "t,x,y,z", np.hstack([TIMES[:, None], POINTS]))
    with pytest.warns(UserWarning, match="the acceleration jumps"):
        plain, slow = Waypoints.from_csv(file), Waypoints.from_csv(file, stretch=1.4)
    assert slow.duration == pytest.approx(9.1, rel=1e-15)
    for t in (0.0, 0.7, 2.0, 3.9):
        before, after = plain.at(t), slow.at(1.4 * t)
        np.testing.assert_allclose(after.position, before.position, rtol=0, atol=1e-14)
        velocity = before.linear_velocity / 1.4
        np.testing.assert_allclose(after.linear_velocity, velocity, rtol=0, atol=1e-14)


@pytest.mark.parametrize(
    "text",
    [
        "\ufeff" + GOOD,
        GOOD.replace("\n", "\r\n").replace(",", " , "),
        "\n T,X,Y,Z\n\n" + GOOD[8:],
        "t,x,y,z # m; base\n" + GOOD[8:],
    ],
)
def test_csv_dialects(tmp_path: Path, text: str) -> None:
    file = tmp_path / "some.csv"
    file.write_bytes(text.encode())
    np.testing.assert_array_equal(Waypoints.from_csv(str(file)).points, [[0, 0, 0], [1, 2, 3]])


@pytest.mark.parametrize(
    "text",
    [
        "qx,qy,qz,qw,z,y,x,t\n0,0,0,1,3,2,1,0\n0.6,0,0,0.8,3,2,1,1\n",
        "t;x;y;z;qw;qx;qy;qz\n0;1;2;3;1;0;0;0\n1;1;2;3;.8;.6;0;0\n",
        'Of Monday, again\n\n# t,"x","Y",z,qw,qx,qy,qz\n # base\n"0",1,2,3,1,0,0,0 # start\n'
        "1,1,2,3,.8,.6,0,0\n",
    ],
)
@pytest.mark.filterwarnings("error")
def test_columns_are_read_by_their_names(tmp_path: Path, text: str) -> None:
    file = tmp_path / "some.csv"
    file.write_text(text)
    read = Waypoints.from_csv(file)
    np.testing.assert_array_equal(read.times, [0.0, 1.0])
    np.testing.assert_array_equal(read.points, [[1.0, 2.0, 3.0]] * 2)
    np.testing.assert_array_equal(read.quaternions, [[1.0, 0.0, 0.0, 0.0], [0.8, 0.6, 0.0, 0.0]])


def test_columns_that_are_not_read_are_named(tmp_path: Path) -> None:
    file = tmp_path / "some.csv"
    file.write_text('t,x,y,z,grip,note\n0,0,0,0,open,"now, then"\n1,1,2,3,,\n')
    with pytest.warns(UserWarning, match=r"some\.csv: columns that are not read: grip, note$"):
        read = Waypoints.from_csv(file)
    np.testing.assert_array_equal(read.points, [[0, 0, 0], [1, 2, 3]])


def test_repeated_rows_are_a_pause(tmp_path: Path) -> None:
    poses = np.hstack([POINTS, QUATERNIONS])[[0, 0, 1, 1, 1, 2, 2]]
    file = write(tmp_path, f"t,{POSE_HEADER}", np.hstack([np.arange(7.0)[:, None], poses]))
    with pytest.warns(UserWarning, match="the acceleration jumps"):
        path = Waypoints.from_csv(file)
    for start, end, row in ((0.0, 1.0, 0), (2.0, 4.0, 1), (5.0, 6.0, 2)):
        targets = path.sample(np.linspace(start, end, 41))
        np.testing.assert_allclose(targets.position, [POINTS[row]] * 41, rtol=0, atol=1e-14)
        np.testing.assert_allclose(targets.rotation, [TURNS[row].as_matrix()] * 41, atol=1e-12)


@pytest.mark.parametrize(("unit", "asked"), [(1.0, False), (1e3, True), (1e9, True)])
def test_times_in_which_nothing_moves_are_asked_for_their_unit(
    tmp_path: Path, unit: float, asked: bool
) -> None:
    """Also of a path that only turns; a path that only stands is not asked."""
    times = unit * np.array([[0.0], [1.0], [2.0]])
    turning = np.hstack([np.zeros((3, 3)), QUATERNIONS[:3]])
    moving = np.hstack([0.05 * np.eye(3), QUATERNIONS[[0, 0, 0]]])
    for poses in (turning, moving, moving[[0, 0, 0]]):
        file = write(tmp_path, f"t,{POSE_HEADER}", np.hstack([times, poses]))
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            Waypoints.from_csv(file)
        found = [each for each in said if "are the times in seconds?" in str(each.message)]
        assert bool(found) == (asked and bool(np.ptp(poses, axis=0).any()))


def test_quaternions_in_the_place_of_ends_are_refused_by_name() -> None:
    with pytest.raises(InvalidInputError, match=r"^ends: must be one of clamped, closed, not arr"):
        Waypoints(TIMES, POINTS, QUATERNIONS)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        ("", "a header must name t, x, y, z"),
        ("t,x,y,z\n0,0,0,0\n", "at least 2 points"),
        (GOOD + "2,1,one,1\n", "line 4: 4 finite numbers are needed, not '2,1,one,1'"),
        (GOOD + "\n2,1,1,nan\n", "line 5: 4 finite"),
        (GOOD + "\n0.5,1,1,1\n", "times: line 5 must be above 1 s, not at 0.5 s"),
        (GOOD.encode() + b"\xff\xfe", "'utf-8' codec"),
        (f"{POSE_HEADER}\n0,0,0,1,0,0,0\n", "a header must name t, x, y, z"),
        ("t,x,y,z,X\n0,0,0,0,1\n", "a header must name .* once each"),
        ("t;x;y;z\n0;0;0;0\n1;0,1;0;0\n", "line 3: 4 finite numbers are needed, not '1;0,1;0;0'"),
        ("t,x,y,z\n# b\n0,0,0,0,5\n", "line 3: 4 finite"),
        ("t,x,y,z\n0,0,0," + "0" * 140_000, "field larger than field limit"),
        (
            f"t,{POSE_HEADER}\n0,0,0,0,1,0,0,0\n# c\n1,1,0,0,0,0,0,0\n",
            "quaternions: line 4 must have norm 1, not 0",
        ),
        (
            f"t,{POSE_HEADER}\n0,0,0,0,1,0,0,0\n\n1,1,0,0,0,0,1,0\n",
            "quaternions: line 4 is half a turn from the one before",
        ),
        (None, "No such file"),
    ],
)
@pytest.mark.filterwarnings("error")
def test_a_bad_file_is_told_in_one_line(tmp_path, content, reason) -> None:
    file = tmp_path / "bad.csv"
    if content is not None:
        file.write_bytes(content.encode() if isinstance(content, str) else content)
    with pytest.raises(FileError, match=reason) as caught:
        Waypoints.from_csv(file)
    assert caught.value.path == str(file)
    assert "\n" not in str(caught.value)


def test_a_bad_argument_of_a_good_file_is_named(tmp_path: Path) -> None:
    file = tmp_path / "good.csv"
    file.write_text(GOOD)
    with pytest.raises(InvalidInputError, match=r"^stretch"):
        Waypoints.from_csv(file, stretch=0.0)
    for ends, reason in (("open", "ends: must be"), ("closed", "at least 3 points")):
        with pytest.raises(FileError, match=reason):
            Waypoints.from_csv(file, ends=ends)
