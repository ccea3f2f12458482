"""Soft starts: the same curve by a clock that begins at rest, and an arm that can follow it."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad

import iiwa_dnn as d

POSE = d.Target([0.4, 0.1, 0.5], [[0, 0, 1], [1, 0, 0], [0, 1, 0]])
PATHS: list[Any] = [
    d.Circle(radius=0.2, period=5.0, normal=(1.0, -2.0, 0.5)),
    d.Circle(period=25.0),
    d.Lissajous((0.1, 0.2, 0.3), (3, 2, 5), (0.3, 0.0, -1.0), 6.0, begin=2.5),
    d.Cone(0.05, 0.3),
    d.Tilting(d.Lissajous(period=5.0, begin=0.3), 0.2),
    d.Tilting(d.Heart(5e-3, 6.0), 0.4, (0.0, 1.0, 0.0), begin=4.0),
]


def rate(t: float, begin: float) -> float:
    """The smooth step that a clock's rate is: 0 before 0, 1 from `begin` on."""
    u = min(max(t / begin, 0.0), 1.0)
    return 3.0 * u**2 - 2.0 * u**3


@pytest.mark.parametrize("path", PATHS, ids=lambda path: type(path).__name__)
def test_the_path_is_the_same_at_the_time_that_its_clock_has_run(path: Any) -> None:
    plain = replace(path, begin=0.0).anchored(POSE)
    path = path.anchored(POSE)
    for t in np.linspace(-0.5, path.begin + 1.0, 31):
        clock = quad(rate, 0.0, t, args=(path.begin,), points=[path.begin], epsabs=1e-13)[0]
        found = path.at(t).data
        expected = plain.at(max(clock, 0.0)).data.copy()
        expected[12:] *= rate(t, path.begin)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-11)


@pytest.mark.parametrize("path", PATHS, ids=lambda path: type(path).__name__)
def test_a_run_of_its_duration_ends_where_it_began_at_full_speed(path: Any) -> None:
    anchored = path.anchored(POSE)
    start, end, again = anchored.sample([0.0, path.duration, path.duration + path.period])
    plain = replace(path, begin=0.0).anchored(POSE).at(0.0)
    np.testing.assert_allclose(end.data[:12], start.data[:12], rtol=0, atol=1e-13)
    np.testing.assert_allclose(end.data[12:], plain.data[12:], rtol=0, atol=1e-12)
    np.testing.assert_allclose(again.data, end.data, rtol=0, atol=1e-12)
    if path.begin <= 2.0 * path.period:
        assert path.duration == path.period + path.begin / 2


def test_it_takes_a_second_unless_told_otherwise() -> None:
    for make in (d.Circle, d.Lissajous, d.Cone):
        assert (make(period=2.0).begin, make(period=30.0).begin) == (1.0, 1.0)
    assert d.Tilting(d.Circle(begin=0.25), begin=0.5).begin == 0.5
    assert replace(d.Circle(begin=0.25), radius=0.1).settings()["begin"] == 0.25
