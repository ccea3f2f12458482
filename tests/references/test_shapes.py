"""The shapes themselves, each against its formula or geometry written a second time."""

from __future__ import annotations

import math

import numpy as np
import pytest

from iiwa_dnn.references import Circle, Heart, Line, Lissajous

TIMES = np.random.default_rng(4).uniform(-5.0, 25.0, 300)


def test_heart_is_the_papers_formula() -> None:
    a, period = 3.45e-3, 10.0  # the defaults
    expected = []
    for t in TIMES:
        wt = 2 * math.pi / period * t
        x = a * 16 * math.sin(wt) ** 3
        y = a * (13 * math.cos(wt) - 5 * math.cos(2 * wt) - 2 * math.cos(3 * wt) - math.cos(4 * wt))
        expected.append((x, y - 5 * a, 0.0))
    np.testing.assert_allclose(Heart().displacement(TIMES), expected, rtol=0, atol=1e-16)


def test_heart_velocity_by_complex_exponentials() -> None:
    # sin^3 = (3 sin - sin 3) / 4 makes both axes Fourier sums, whose derivative is term by term.
    a, period = 2e-3, 6.0
    x = {1: -12j, 3: 4j}  # coefficients c of Re(c exp(i k w t))
    y = {1: 13, 2: -5, 3: -2, 4: -1}
    w = 2 * math.pi / period
    expected = [
        [sum((c * 1j * k * w * np.exp(1j * k * w * t)).real for k, c in f.items()) for f in (x, y)]
        for t in TIMES
    ]
    velocity = Heart(a, period).velocity(TIMES)
    np.testing.assert_allclose(velocity[:, :2], a * np.array(expected), rtol=0, atol=1e-15)
    assert not velocity[:, 2].any()


def test_heart_starts_at_rest_and_has_its_size() -> None:
    heart = Heart()
    assert not heart.velocity(0.0).any()
    path = heart.displacement(np.linspace(0.0, 10.0, 100_001))
    assert np.ptp(path[:, 0]) == pytest.approx(32 * heart.scale, rel=1e-9)
    np.testing.assert_allclose(heart.displacement(5.0), [0, -22 * heart.scale, 0], atol=1e-17)


@pytest.mark.parametrize("normal", [(0, 0, 1), (0, 0, -2), (1, 0, 0), (1, -2, 0.5), (1e-200, 0, 0)])
def test_circle_is_round_flat_and_turns_the_right_way(normal: tuple[float, ...]) -> None:
    circle = Circle(radius=0.3, period=4.0, normal=normal)
    axis = np.array(normal) / max(map(abs, normal))
    axis /= np.linalg.norm(axis)
    path, velocity = circle.displacement(TIMES), circle.velocity(TIMES)
    centre = circle.displacement(2.0) / 2  # half a turn away is a diameter away
    radii = path - centre
    np.testing.assert_allclose(np.linalg.norm(radii, axis=1), 0.3, rtol=1e-12)
    np.testing.assert_allclose(path @ axis, 0.0, atol=1e-15)
    # v = w x r, with w along the normal.
    spin = (2 * math.pi / 4.0) * axis
    np.testing.assert_allclose(velocity, np.cross(spin, radii), rtol=0, atol=1e-13)


def test_line_goes_there_and_back_and_rests_at_both_ends() -> None:
    line = Line(offset=(0.1, 0.2, -0.3), period=8.0)
    np.testing.assert_allclose(line.displacement(4.0), [0.1, 0.2, -0.3], rtol=1e-15)
    np.testing.assert_allclose(line.displacement(2.0), [0.05, 0.1, -0.15], rtol=1e-15)
    for t in (0.0, 4.0, 8.0):
        np.testing.assert_allclose(line.velocity(t), 0.0, atol=1e-16)
    w = 2 * math.pi / 8.0
    expected = np.outer((1 - np.cos(w * TIMES)) / 2, [0.1, 0.2, -0.3])
    np.testing.assert_allclose(line.displacement(TIMES), expected, rtol=0, atol=1e-15)


def test_lissajous_is_a_sine_on_each_axis() -> None:
    figure = Lissajous((0.1, 0.2, 0.3), (1, 2, 3), (0.0, 0.5, -0.5), 5.0)
    for t, moved in zip(TIMES, figure.displacement(TIMES), strict=True):
        for i, (a, k, phi) in enumerate(((0.1, 1, 0.0), (0.2, 2, 0.5), (0.3, 3, -0.5))):
            expected = a * (math.sin(2 * math.pi * k * t / 5.0 + phi) - math.sin(phi))
            assert moved[i] == pytest.approx(expected, abs=1e-14)
