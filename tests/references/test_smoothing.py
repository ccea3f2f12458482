"""Smoothed recordings: nearer to the truth than their rows, at rest at the ends, or periodic."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from iiwa_dnn import FileError, InvalidInputError, Waypoints
from iiwa_dnn.references.splines import smoothed

NOISE = 1e-3
T = 10.0

pytestmark = pytest.mark.filterwarnings("ignore:smoothing has")


def recorded(times: NDArray[np.float64], whole: bool) -> tuple[Any, Rotation, Any, Rotation]:
    """Points and orientations of two turns, or of three eased ones, and the same with noise."""
    rng = np.random.default_rng(7)
    fraction = times / T if whole else 3.0 * (times / T) ** 2 - 2.0 * (times / T) ** 3
    angle = 2.0 * np.pi * fraction
    points = 0.1 * np.stack([np.cos(angle), np.sin(2.0 * angle), 0.0 * angle], axis=1)
    turns = Rotation.from_rotvec(np.stack([0.0 * angle, 0.0 * angle, angle], axis=1))
    noisy = points + NOISE * rng.standard_normal(points.shape)
    shaken = Rotation.from_rotvec(NOISE * rng.standard_normal(points.shape)) * turns
    return points, turns, noisy, shaken


def root_mean_square(values: Any) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


@pytest.mark.parametrize("ends", ["clamped", "closed"])
@pytest.mark.parametrize("uneven", [False, True])
def test_noise_goes_and_the_path_stays(ends: str, uneven: bool) -> None:
    times = np.linspace(0.0, T, 301)
    if uneven:
        times = times + 0.3 * np.sin(2.0 * np.pi * times / T)
    points, turns, noisy, shaken = recorded(times, whole=ends == "closed")
    quaternions = shaken.as_quat()[:, [3, 0, 1, 2]]
    quaternions[::3] *= -1.0
    with pytest.warns(UserWarning, match=r"smoothing has (moved|turned) the rows by .* m") as said:
        path = Waypoints(times, noisy, ends, quaternions, noise=NOISE)  # type: ignore[arg-type]
    targets = path.sample(times)
    errors = targets.position - points
    assert root_mean_square(errors) < 0.5 * root_mean_square(noisy - points)
    angles = (Rotation.from_matrix(targets.rotation) * turns.inv()).magnitude()
    assert root_mean_square(angles) < 0.5 * root_mean_square((shaken * turns.inv()).magnitude())
    distances = np.linalg.norm(targets.position - noisy, axis=1)
    turned = (Rotation.from_matrix(targets.rotation) * shaken.inv()).magnitude()
    assert root_mean_square(distances) == pytest.approx(np.sqrt(3.0) * NOISE, rel=0.15)
    assert root_mean_square(turned) == pytest.approx(np.sqrt(3.0) * NOISE, rel=0.2)
    if ends == "clamped":  # of a closed path the last row is the first one
        assert f"at most {1e3 * distances.max():.3g} mm" in str(said[0].message)
        assert f"at most {1e3 * turned.max():.3g} mrad" in str(said[1].message)
    t = np.linspace(0.0, T, 3001)
    rates = np.diff(path.sample(t).data[:, 12:], axis=0) / (t[1] - t[0])
    assert np.abs(rates).max() < 0.5  # 0.16 of the truth, some 20 of the rows
    if ends == "clamped":
        assert np.abs(path.sample([0.0, T - 1e-12]).data[:, 12:]).max() < 1e-8
    else:
        before, after = path.sample([T - 1e-9, T + 1e-9]).data
        np.testing.assert_allclose(before, after, rtol=0, atol=1e-8)


@pytest.mark.parametrize("ends", ["clamped", "closed"])
def test_squared_distances_add_up_to_the_noise_weighted_by_time(ends: Any) -> None:
    """Half of the rows lie in a tenth of the time, where they are four times as noisy."""
    times = np.concatenate([np.linspace(0.0, 1.0, 150, endpoint=False), np.linspace(1.0, T, 151)])
    points, _, noisy, _ = recorded(times, whole=ends == "closed")
    noisy += (times < 1.0)[:, np.newaxis] * 3.0 * (noisy - points)
    noisy[-1] = noisy[0]
    rows = smoothed("points", times, noisy, NOISE, ends == "closed")
    squares = ((rows - noisy) ** 2).mean(axis=1)
    weights = np.gradient(times)
    assert (weights @ squares) / weights.sum() == pytest.approx(NOISE**2, rel=0.1)
    assert squares.mean() > 2.0 * NOISE**2


@pytest.mark.filterwarnings("ignore:the acceleration jumps")
def test_orientations_have_a_noise_of_their_own() -> None:
    times = np.linspace(0.0, T, 101)
    _, _, noisy, shaken = recorded(times, whole=False)
    quaternions = shaken.as_quat()[:, [3, 0, 1, 2]]
    for noise, turn_noise, words in ((0.0, NOISE, "turned"), (NOISE, 0.0, "moved")):
        with pytest.warns(UserWarning, match=f"smoothing has {words}") as said:
            Waypoints(times, noisy, quaternions=quaternions, noise=noise, turn_noise=turn_noise)
        assert len([each for each in said if "smoothing" in str(each.message)]) == 1


def test_a_closed_recording_has_to_close(tmp_path) -> None:
    times = np.linspace(0.0, T, 51)
    _, _, noisy, _ = recorded(times, whole=True)
    noisy[-1] += 7.0 * NOISE
    with pytest.raises(InvalidInputError, match="the last row of a closed path must be"):
        Waypoints(times, noisy, "closed", noise=NOISE)
    file = tmp_path / "path.csv"
    rows = [",".join(map(repr, row)) for row in np.column_stack([times, noisy]).tolist()]
    file.write_text("\n".join(["t,x,y,z", *rows]))
    with pytest.raises(FileError, match="up to the noise"):
        Waypoints.from_csv(file, "closed", noise=NOISE)
    with pytest.warns(UserWarning, match=r"path.csv: smoothing has moved the rows by .* mm"):
        Waypoints.from_csv(file, "closed", noise=2.0 * NOISE)


def test_rows_that_no_spline_of_so_little_noise_fits_stay() -> None:
    """FITPACK gives up where times are uneven and the noise is far too small."""
    for seed in range(40):
        rng = np.random.default_rng(seed)
        times = np.cumsum(np.exp(1.5 * rng.standard_normal(12)))
        points = np.cumsum(rng.standard_normal((12, 3)), axis=0)
        moved = smoothed("points", times - times[0], points, 1e-4, False) - points
        steps = np.pad(np.diff(times), 1)  # a row counts by half of the time to its neighbours
        left = np.average((moved**2).sum(axis=1), weights=steps[:-1] + steps[1:])
        assert left <= 3.0 * 1.2 * 1e-4**2
    assert not np.abs(Waypoints(times[:2], points[:2], noise=0.1).at(0.0).position).any()


@pytest.mark.filterwarnings("ignore:the acceleration jumps")
@pytest.mark.parametrize("axes", [(0.15, 0.15), (0.15, 0.01)])
def test_noise_that_covers_the_path_is_refused(axes: tuple[float, float]) -> None:
    """A circle or an ellipse, turned in space; noise of its width leaves no more than a line."""
    rng = np.random.default_rng(3)
    angle = np.linspace(0.0, 2.0 * np.pi, 101)
    turn = Rotation.random(random_state=4).as_matrix()
    points = np.column_stack([axes[0] * np.cos(angle), axes[1] * np.sin(angle), 0 * angle]) @ turn
    turns = Rotation.from_rotvec(points).as_quat()[:, [3, 0, 1, 2]]
    for noise, kind in ((1.0, "point"), (0.11, "point"), (0.03, "line")):
        if kind == "point" or axes[1] < 0.1:
            with pytest.raises(InvalidInputError, match=f"noise: .* the path to a {kind}"):
                Waypoints(angle, points, noise=noise)
            with pytest.raises(InvalidInputError, match=f"turn_noise: .* to a {kind}"):
                Waypoints(angle, points, quaternions=turns, turn_noise=noise)
    noisy = points + 0.005 * rng.standard_normal(points.shape)
    Waypoints(angle, noisy, noise=0.005)
    line = points * [1.0, 0.0, 0.0]
    for rows in (line, line + 0.005 * rng.standard_normal(line.shape), 0.0 * line):
        Waypoints(angle, rows, noise=0.005)
