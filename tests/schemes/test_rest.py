"""Motions to rest: displacements beside sums of velocities, and what limits say of them."""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from helpers_simulation import limits_of_joints
from iiwa_dnn.schemes import rest
from iiwa_dnn.schemes.joint_limits import keeps_joint_limits
from iiwa_dnn.schemes.rest import Motion
from iiwa_dnn.schemes.step import StepViews

ALONE = StepViews(0.0, 1.0, *np.zeros((3, 1)), *np.zeros((5, 1, 1)), *np.zeros((6, 1)))
"""An instant of one joint at 0."""


@pytest.mark.parametrize("periods", [2.0, 3.0, 7.0, 40.0, 300.0])
def test_what_sets_off_away_has_gone_the_square_of_the_joints_part(periods: float) -> None:
    motion = Motion(np.ones(1), np.ones(1), periods, 1.0, True, False, False)
    part, away = (
        np.array([rest.displacement_after(motion, x, b, k) for k in range(int(periods) + 1)])
        for x, b in ((1.0, 0.0), (1.0 / (3.0 * periods), 1.0))
    )
    assert (away / away[-1] >= (part / part[-1]) ** 2 - 1e-12).all()


@pytest.mark.parametrize("cubic", [False, True])
def test_the_displacement_along_a_motion_is_the_sum_of_its_velocities(cubic: bool) -> None:
    random = np.random.default_rng(4)
    for _ in range(300):
        M = float(random.integers(1, 40))
        x, before = random.standard_normal(2)
        b = rest.cubic_coefficient(x, before, M, False) if cubic else 0.0
        motion = Motion(np.array([x]), np.array([b]), M, 1e-3, cubic, False, False)
        velocities = [rest.velocity_at(x, b, u, cubic) for u in np.arange(M) / M]
        displacements = np.append(0.0, np.cumsum(velocities)) * 1e-3
        assert rest.least_displacement(motion, x, b) == pytest.approx(
            displacements.min(), abs=1e-12
        )
        assert rest.displacement_after(motion, x, b, M) == pytest.approx(
            displacements[-1], abs=1e-12
        )


def gone(
    periods: np.ndarray, x: Any, a: Any, time: float, says: bool
) -> tuple[np.ndarray, np.ndarray]:
    """Ways and velocities of joints at x with accelerations a that come to rest in `time` [s].

    They brake along the cubics through their last two velocities that end there, solved for here.
    """
    displacement = periods[0] * x
    displacements = [0.0 * x, displacement]
    velocities = [x]
    for last, period in pairwise(periods):
        r = period if says else last
        next_motion_state = 0.0 * x
        if r < time:
            # v(t) = (t - time)^2 (c + k t), with v(0) = x and v(-r) = x - r a
            c = x / time**2
            k = (c - (x - r * a) / (r + time) ** 2) / r
            next_motion_state = (r - time) ** 2 * (c + k * r)
        a = (next_motion_state - x) / r
        x = next_motion_state
        time = max(time - r, 0.0)
        displacement = displacement + period * x
        displacements.append(displacement)
        velocities.append(x)
    return np.array(displacements), np.array(velocities)


def blocks_of(random: np.random.Generator) -> np.ndarray:
    """Periods up to 1 that stay the same for a while."""
    choices = np.array([1.0, 0.02, 0.1, 0.3, 0.6])
    blocks = [np.full(random.integers(1, 60), random.choice(choices)) for _ in range(30)]
    return np.concatenate([*blocks, np.ones(25)])


@pytest.mark.parametrize("says", [False, True])
@pytest.mark.parametrize("M", [1.0, 2.0, 3.0, 7.0, 20.0])
def test_the_way_to_rest_in_any_periods_is_no_less_than_the_checked_one(
    M: float, says: bool
) -> None:
    """It is up to 0.94 periods of the velocity less than that in the longest periods."""
    random = np.random.default_rng(7)
    angles = np.linspace(0.0, 2.0 * np.pi, 145)
    x = np.cos(angles)
    a = 6.0 / M * np.sin(angles)
    bounds = []
    longest = []
    for own, rate in zip(x, a, strict=True):
        b = rest.cubic_coefficient(own, own - rate, M, True)
        motion = Motion(np.array([own]), np.array([b]), M + 1.0, 1.0, True, True, False)
        bounds.append(min(rest.end_displacement(motion, own, b), 0.0))
        b = rest.cubic_coefficient(own, own - rate, M, False)
        longest.append(rest.least_displacement(motion, own, b))
    least = np.full(x.size, np.inf)
    short = np.full(int(50 * M), 0.02)
    runs = [np.append(short[::step], np.ones(25)) for step in range(1, 7)]
    for periods in [*runs, *(blocks_of(random) for _ in range(40))]:
        least = np.minimum(least, gone(periods, x, a, M, says)[0].min(axis=0))
    assert (bounds <= least + 1e-12).all()
    assert (longest > least + (0.1 if says else 0.8)).any()


@pytest.mark.parametrize("says", [False, True])
@pytest.mark.parametrize("cubic", [False, True])
@pytest.mark.parametrize("lag", [0.0, 3.0])
def test_a_motion_to_rest_keeps_the_limits_of_a_joint_in_any_periods(
    says: bool, cubic: bool, lag: float
) -> None:
    """Its range is the least that passes; above a position-dependent limit it is 0 at the end."""
    random = np.random.default_rng(11)
    slope = 0.3
    for _ in range(20):
        M = float(random.integers(1, 12))
        x = 1.0
        a = random.uniform(-4.0, 6.0) / M if cubic else -x / M
        b = rest.cubic_coefficient(x, x - a, M, True) if cubic else 0.0
        motion = Motion(np.array([x]), np.array([b]), M + 1.0, 1.0, cubic, True, False)
        varying = (slope * lag, slope if lag else np.inf)
        limits = limits_of_joints(-99.0, 0.0, 99.0, 1.0, 1.0, varying)
        lost = 0.5 * slope * lag**2  # before the position limit
        too_short = 0.0
        enough = 99.0
        for _ in range(40):
            end = 0.5 * (too_short + enough)
            limits.upper[0] = end + lost
            if keeps_joint_limits(ALONE, limits, motion):
                enough = end
            else:
                too_short = end
        for _ in range(10):
            periods = blocks_of(random)
            periods = periods[: np.searchsorted(np.cumsum(periods), M + 2.0)]
            times = np.cumsum(periods if says else np.append(0.0, periods[:-1]))
            if cubic:
                way, velocities = gone(periods, x, a, M, says)
            else:
                velocities = np.maximum(1.0 - (times - times[0]) / M, 0.0)
                way = np.append(0.0, np.cumsum(periods * velocities))
            assert way.max() <= enough + 1e-9
            if lag > 0.0:
                needed = velocities**2 / (2.0 * slope) + velocities * lag
                assert (needed <= enough - way[:-1] + 1e-9).all()


@pytest.mark.parametrize("M", [1.0, 2.0, 7.0, 40.0])
def test_the_way_that_may_lead_nearer_is_that_of_the_velocities_which_do(M: float) -> None:
    """Where nobody states the periods, each velocity may be held for the longest, or for none."""
    for angle in np.linspace(0.0, 2.0 * np.pi, 145):
        x, a = np.cos(angle), 6.0 / M * np.sin(angle)
        b = rest.cubic_coefficient(x, x - a, M, True)
        motion = Motion(np.zeros(1), np.zeros(1), M + 1.0, 1.0, True, True, True)
        steps = np.arange(M)
        own = rest.cubic_coefficient(x, x - a, M, False)
        velocities = [rest.velocity_at(x, own, i / M, True) for i in steps]
        bound = min(rest.end_displacement(motion, x, b), 0.0)
        assert bound <= np.minimum(velocities, 0.0).sum() + 1e-12
