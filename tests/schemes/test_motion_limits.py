"""Acceleration and jerk limits: exact, never empty, viable, and kept by every command."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings, strategies as st

import iiwa_dnn as d
from helpers_kinematics import PAPER_Q0, Array
from helpers_simulation import heart, limits_of_joints, paper_robot, paper_start
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.schemes.joint_limits import (
    check_ranges,
    largest_gain,
    own_rate_limits,
)
from iiwa_dnn.schemes.periods import constant_periods, stated_periods
from iiwa_dnn.schemes.profiles import Rates, braking, usable_jerk
from iiwa_dnn.schemes.viability import LEVELS, LOWER, joint_bounds
from judge_limits import Breach, breaches

INF = math.inf
Limits = tuple[float, float, float]


@compiled
def adversary(q: float, upper: float, limits: Any, dt: float, draws: Any, out: Any) -> float:
    """Drive a joint in [-upper, upper] by hostile choices; returns the least room of its bounds."""
    V, A, J = limits
    periods = constant_periods(dt)
    last = before = room = request = 0.0
    mode, left = 0, 0
    for k in range(len(out)):
        lb, ub, *_ = joint_bounds(
            last, before, upper - q, q + upper, (V, A, J, A, INF, 0.0), periods
        )
        room = min(room, ub - lb)
        if left == 0:
            mode, left = int(4.0 * draws[k, 0]), 1 + int(400.0 * draws[k, 1])
            request = (2.0 * draws[k, 2] - 1.0) * min(V, 10.0)
        left -= 1
        v = ub
        if mode == 1:
            v = lb
        elif mode == 2:
            v = lb + (ub - lb) * draws[k, 3]
        elif mode == 3:
            v = min(max(request, lb), ub)
        q += dt * v
        before, last = last, v
        out[k] = q
    return room


def broken(q: Array, dt: float, upper: float, limits: Limits) -> list[Breach]:
    """The limits that are broken by more than the rounding of a thousand periods of jerk."""
    return breaches(q, dt, -upper, upper, *[limit * (1.0 + 1e-10) for limit in limits])


def driven(start: float, upper: float, limits: Limits, dt: float, seed: int) -> Array:
    """The positions of a joint that begins somewhere at rest, (3001, 1)."""
    out = np.empty(3000)
    draws = np.random.default_rng(seed).random((3000, 4))
    assert adversary(start, upper, limits, dt, draws, out) >= -1e-12
    return np.concatenate([[start], out])[:, np.newaxis]


@settings(max_examples=60)
@given(
    speed=st.floats(0.1, 10.0),
    acceleration=st.floats(0.5, 30.0),
    jerk=st.one_of(st.just(INF), st.floats(1.0, 1e4)),
    dt=st.sampled_from([1e-3, 4e-3, 1e-2]),
    seed=st.integers(0, 1000),
)
@example(speed=1.0, acceleration=1.5, jerk=INF, dt=1e-3, seed=0)
def test_hostile_choices_break_no_limit(speed, acceleration, jerk, dt, seed) -> None:
    upper = 0.2 + 2.0 * acceleration**3 / min(jerk, 1e9) ** 2
    limits = (speed, acceleration, jerk)
    assert broken(driven(0.0, upper, limits, dt, seed), dt, upper, limits) == []


@pytest.mark.parametrize(
    ("limits", "dt"),
    [((1.71, 8.65, INF), 1e-3), ((2.0, 300.0, INF), 2e-2), ((2.0, 15.0, 500.0), 1e-2)],
)
@pytest.mark.parametrize("start", [-1.6, 1.6])
def test_outside_a_position_limit_the_velocity_limit_holds(limits, dt, start) -> None:
    # Crossed bounds were averaged: 4.4 times the velocity limit at 300 rad/s^2 and 20 ms.
    for seed in range(5):
        q = driven(start, 1.0, limits, dt, seed)
        assert broken(q, dt, 1.6, limits) == []
        inside = np.flatnonzero(np.abs(q[:, 0]) <= 1.0)
        assert breaches(q[inside[0] :], dt, -1.0, 1.0) == []  # once back, it stays


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_outside_its_range_a_joint_without_rates_keeps_its_velocity_limit(side: float) -> None:
    """Beside joints with an acceleration limit its bound was infinite."""
    robot = d.load_robot("iiwa7").with_limits(acceleration=[*[10.0] * 6, INF])
    q = robot.start_posture()
    q[6] = side * (robot.q_upper[6] + 0.1)
    start = d.Configuration(robot, q)
    target = d.Target(start.position, start.rotation)
    scheme = d.DoubleIndicator(extra_limits=[d.AccelerationLimits()])
    qp = scheme.build_qp(start, target, 1e-3)
    bounds = sorted(-side * np.array([qp.lb[6], qp.ub[6]]))
    np.testing.assert_allclose(bounds, [0.1 * 20.0, robot.dq_max[6]], rtol=1e-9)


def test_outside_a_short_range_a_joint_does_not_come_back_beyond_its_other_side() -> None:
    dt, limits = 1e-2, (2.0, 5.0, INF)
    q, last = 0.3, 0.0  # above a range of 1 mrad
    for _ in range(300):
        lb, ub, *_ = joint_bounds(
            last, 0.0, -q, q + 1e-3, (*limits, limits[1], INF, 0.0), constant_periods(dt)
        )
        assert lb <= ub
        last = lb
        q += dt * last
        assert abs(last) <= 2.0
        assert q >= -1e-3 - 1e-12
    assert q <= 0.0


@settings(max_examples=30)
@given(
    speed=st.floats(0.5, 5.0),
    acceleration=st.floats(1.0, 100.0),
    jerk=st.floats(100.0, 1e6),
    dt=st.sampled_from([1e-3, 1e-2, 2e-2]),
    upper=st.floats(1e-6, 1.0),
    seed=st.integers(0, 1000),
)
@example(speed=2.0, acceleration=20.0, jerk=1e5, dt=1e-2, upper=5.5e-5, seed=0)
def test_a_range_that_is_taken_is_long_enough(speed, acceleration, jerk, dt, upper, seed) -> None:
    # 1.1e-4 rad were accepted at 20 rad/s^2, 1e5 rad/s^3 and 10 ms, and left by 1.5e-4 rad.
    limits = (speed, acceleration, jerk)
    while True:
        try:
            check_ranges(limits_of_joints(-upper, upper, *limits), 1.0 / dt)
            break
        except d.InvalidInputError:
            upper *= 1.02
    assert broken(driven(0.0, upper, limits, dt, seed), dt, upper, limits) == []


def hostile_periods(meaning: str, random: Any, steps: int) -> tuple[float, float]:
    """How far a joint is beyond its range, and how far its rates are beyond their limits.

    Periods are drawn, the longest and the shortest by turns, or the worst of three by the room that
    they leave to brake.
    """
    longest = 10.0 ** random.uniform(-3.0, -1.5)
    nominal = longest * random.choice([1.0, 0.3])
    V, A = 10.0 ** random.uniform(-0.5, 1.0), 10.0 ** random.uniform(0.0, 2.0)
    J = 10.0 ** random.uniform(2.0, 4.5) if random.random() < 0.5 else INF
    braking_at = A * random.choice([1.0, 0.5])
    rates = (V, A, J, braking_at, INF, 0.0)
    upper = 0.2 + 2.0 * A**3 / min(J, 1e9) ** 2
    mode = random.integers(3)
    q = last = before = slope = 0.0
    passed = stated = nominal
    beyond = rate = 0.0
    push = 1
    for k in range(steps):
        push = random.choice([-1, 1]) if k % 60 == 0 else push
        draws = longest * (random.choice([1e-3, 1.0], 3) if mode else random.uniform(1e-3, 1.0, 3))
        found = []
        for period in draws if mode == 2 else draws[:1]:
            own = {"dt": period, "elapsed": passed, "neither": nominal}[meaning]
            first = last - own / stated * (last - before)
            said = (period if meaning == "dt" else None, passed if meaning == "elapsed" else None)
            periods = stated_periods(nominal, longest, *said)
            v = joint_bounds(last, first, upper - q, q + upper, rates, periods)[int(push > 0)]
            room = upper - push * (q + period * v) - v * v / (2.0 * braking_at)
            found.append((room, period, own, v))
        _, passed, stated, v = min(found)
        turn = (v - last) / stated - slope
        slope += turn
        rate = max(rate, abs(v) - V, abs(slope) - A)
        if J < INF and k:
            rate = max(rate, abs(turn) / stated - J * (1.0 + 1e-3))
        q += passed * v
        before, last = last, v
        beyond = max(beyond, abs(q) - upper)
    return beyond, rate


@pytest.mark.parametrize("meaning", ["constant", "dt", "elapsed", "neither"])
@pytest.mark.parametrize("jerk", [INF, 3e3])
def test_a_limit_that_shrinks_is_kept_whatever_period_comes(meaning: str, jerk: float) -> None:
    """At the position at which a command begins, and at the one where it ends."""
    random = np.random.default_rng(4)
    for _ in range(12):
        longest = 10.0 ** random.uniform(-3.0, -1.6)
        V, A = 10.0 ** random.uniform(0.0, 0.5), 10.0 ** random.uniform(0.7, 1.3)
        offset, steepness = random.uniform(0.1, 0.5), 10.0 ** random.uniform(0.3, 1.3)
        lag, room = offset / steepness, offset**2 / (2.0 * steepness)
        rates = (V, A, jerk, min(A, steepness * V / (V + offset)), steepness, lag)
        q = last = before = 0.0
        stated = passed = longest
        push, worst = 1, 0.0
        for k in range(400):
            push = random.choice([-1, 1, 1]) if k % 80 == 0 else push
            period = longest * random.choice([1e-2, random.random() + 1e-3, 1.0])
            if meaning == "constant":
                period = longest
            own = passed if meaning == "elapsed" else period if meaning == "dt" else longest
            before = last - own / stated * (last - before)
            said = (period if meaning == "dt" else None, passed if meaning == "elapsed" else None)
            periods = stated_periods(longest, None if meaning == "constant" else longest, *said)
            v = joint_bounds(last, before, 1.5 - q, 1.5 + q, rates, periods)[int(push > 0)]
            for at in (q, q + period * v):
                most = np.sqrt(2.0 * steepness * max(1.5 - np.sign(v) * at + room, 0.0)) - offset
                worst = max(worst, abs(v) - max(most, 0.0))
            stated, passed = own, period
            q += period * v
            before, last = last, v
        assert worst < 1e-9
        assert abs(q) <= 1.5


def test_a_joint_that_retreats_from_a_limit_that_shrinks_may_stop() -> None:
    """It needs the room of a motion whose acceleration goes to zero at the jerk limit, no more.

    It was kept retreating at a jerk that shrank with the distance, and went nearer to obstacles.
    """
    random = np.random.default_rng(0)
    for _ in range(300):
        longest = 10.0 ** random.uniform(-3.0, -1.4)
        dt = longest * random.uniform(0.2, 1.0)
        V, A, jerk = 10.0 ** random.uniform([-0.5, 0.0, 2.5], [1.0, 2.0, 4.5])
        steepness = A * 10.0 ** random.uniform(0.05, 1.0)
        offset = V * 10.0 ** random.uniform(-1.5, -0.3)
        deceleration = min(A, steepness * V / (V + offset))
        rates = Rates(V, A, jerk, deceleration, steepness, offset / steepness)
        periods = stated_periods(dt, longest, dt, None)
        nearest, room = 0.0, 1.0  # at which it may rest
        while room - nearest > 1e-15:
            middle = 0.5 * (nearest + room)
            rests = joint_bounds(0.0, 0.0, middle, 5.0, rates, periods)[1] >= 0.0
            nearest, room = (nearest, middle) if rests else (middle, room)
        J = usable_jerk(rates, longest)
        last = -min(0.1 * A, 0.5 * J * dt) * dt
        a = -last / dt
        v = a * a / (2.0 * J)
        B = deceleration * LOWER ** (LEVELS - 1)
        room += a**3 / (3.0 * J**2) + v * (v / B + B / J)
        assert joint_bounds(last, last, room, 5.0, rates, periods)[1] >= -1e-9 * V


@pytest.mark.parametrize("meaning", ["dt", "elapsed", "neither"])
def test_no_limit_is_passed_whatever_period_comes(meaning: str) -> None:
    random = np.random.default_rng(2)
    for _ in range(60):
        beyond, rate = hostile_periods(meaning, random, 300)
        assert beyond <= 0.0
        assert rate <= 1e-6


def stopping_room(v: float, step: float) -> float:
    """Way of v and all later velocities under full braking, in units of dt."""
    way = 0.0
    while v > 0.0:
        way, v = way + v, v - step
    return way


@given(above=st.floats(0.0, 1.0), last=st.floats(-1.0, 1.0))
def test_acceleration_bounds_are_the_exact_kernel(above: float, last: float) -> None:
    dt, A, V = 1e-2, 5.0, 2.0
    lb, ub, *_ = joint_bounds(last, 0.0, above, INF, (V, A, INF, A, INF, 0.0), constant_periods(dt))
    at_most = min(V, last + A * dt)
    assert lb == pytest.approx(max(-V, last - A * dt))
    if stopping_room(last - A * dt, A * dt) * dt > above:
        assert ub == lb  # too fast already: brake
        return
    assert stopping_room(ub, A * dt) * dt <= above + 1e-12
    if ub < at_most - 1e-12:
        assert stopping_room(ub + 1e-9, A * dt) * dt > above


@pytest.mark.parametrize("speed", [1e-5, 1e-2, 1.0])
@pytest.mark.parametrize(("jerk", "dt"), [(INF, 1e-3), (500.0, 1e-3), (20.0, 1e-2)])
def test_a_joint_pressed_against_its_limit_comes_to_rest(speed, jerk, dt) -> None:
    last = before = 0.0
    q = -5.0 * speed
    commands = []
    for _ in range(int(9.0 / dt)):
        lb, ub, *_ = joint_bounds(
            last, before, -q, INF, (speed, 10.0, jerk, 10.0, INF, 0.0), constant_periods(dt)
        )
        before = last
        last = min(max(speed, lb), ub)
        q += dt * last
        commands.append(last)
    assert -1e-5 < q <= 0.0
    assert np.abs(commands[-50:]).max() < 1e-12


@compiled
def swing(gain: float, q: float, limits: Any, dt: float, noise: Any) -> float:
    """Feed a joint's position back, with noise; returns its largest excursion in the last part."""
    V, A, J = limits
    periods = constant_periods(dt)
    last = before = requested = largest = 0.0
    for k in range(len(noise)):
        request = min(max(-gain * (q + noise[k]), -V), V)
        change = min(max(request - requested, -A * dt), A * dt)
        requested = request
        lb, ub, *_ = joint_bounds(last, before, 1e3, 1e3, (V, A, J, A, INF, 0.0), periods)
        v = request + braking(last - request + change, lb - request, ub - request, J, periods)
        before, last = last, min(max(v, lb), ub)
        q += dt * last
        if k > 3 * len(noise) // 4:
            largest = max(largest, abs(q))
    return largest


@pytest.mark.parametrize(
    "limits", [(2.0, 10.0, 500.0), (2.0, 15.0, 100.0), (1.7, 13.8, 500.0), (2.0, 10.0, INF)]
)
@pytest.mark.parametrize("dt", [1e-3, 4e-3])
def test_a_loop_is_stable_up_to_the_largest_gain(limits: Any, dt: float) -> None:
    gain = largest_gain(limits_of_joints(-1.0, 1.0, *limits), 1.0 / dt)
    calm = np.zeros(int(30.0 / dt))
    noise = 1e-4 * np.random.default_rng(0).standard_normal(calm.size)
    for start in (1e-3, 0.1, 2.0):
        assert swing(0.8 * gain, start, limits, dt, calm) < 1e-9
        assert swing(0.8 * gain, start, limits, dt, noise) < 0.02
    assert swing(2.5 * gain, 2.0, limits, dt, noise) > 0.1


def test_a_gain_that_is_too_high_is_warned_of_once() -> None:
    limits = (d.AccelerationLimits(), d.JerkLimits(500.0))
    here = d.Target(paper_start().position, paper_start().rotation)
    controller = d.Controller(
        paper_robot(), d.DoubleIndicator(position_gain=60.0, extra_limits=limits)
    )
    with pytest.warns(UserWarning, match=r"gain of 60 1/s is above 35\.1 1/s"):
        controller.step(PAPER_Q0, 0.0, here)
    controller.step(PAPER_Q0, 1e-3, here)  # a second warning would be an error
    d.Controller(paper_robot(), d.DoubleIndicator(extra_limits=limits)).step(PAPER_Q0, 0.0, here)


def test_a_jerk_limit_is_no_reason_to_refuse_a_late_step() -> None:
    limits = (d.AccelerationLimits(10.0), d.JerkLimits(500.0))
    controller = d.Controller(paper_robot(), d.DoubleIndicator(extra_limits=limits), heart())
    first = controller.step(PAPER_Q0, 0.0)
    late = controller.step(first.next_q, 1e-3, dt=0.3)
    assert np.abs(late.dq - first.dq).max() <= 0.3 * 10.0 + 1e-12


def test_a_limit_that_is_none_makes_the_program_without_it() -> None:
    none = (d.AccelerationLimits(np.inf), d.JerkLimits([np.inf] * 7))
    start = paper_start()
    target = d.Target(start.position + [0.0, 0.1, 0.0], start.rotation)
    programs = [
        d.DoubleIndicator(extra_limits=limits).build_qp(start, target, 1e-3)
        for limits in ((), none)
    ]
    np.testing.assert_array_equal(programs[0].data, programs[1].data)
    assert programs[0].sizes == programs[1].sizes


def test_a_robots_own_rates_are_those_that_it_has() -> None:
    kinds = {"iiwa7": (d.AccelerationLimits,), "fr3": (d.AccelerationLimits, d.JerkLimits)}
    for name, expected in kinds.items():
        robot = d.load_robot(name)
        assert tuple(map(type, own_rate_limits(robot))) == expected
        shield = d.Shield(robot)
        motion = shield.layout(robot.tip).step.program.joint_limits
        rates = [motion.acceleration, motion.jerk]
        np.testing.assert_array_equal(rates, [robot.ddq_max, robot.dddq_max])
    assert own_rate_limits(d.load_robot("iiwa7").with_limits(acceleration=np.inf)) == ()


@pytest.mark.parametrize("last", [5e-324, -1e-310, 1e-3])
def test_a_joint_that_brakes_comes_to_rest_itself(last: float) -> None:
    """In units of a step of jerk above 2, 5e-324 rad/s is 0: it was kept for ever."""
    periods = constant_periods(2e-2)
    for _ in range(3):
        last = braking(last, -1.0, 1.0, 1e4, periods)
    assert last == 0.0
