"""Periods that vary: no limit is passed, whatever period comes, however it is stated."""

import copy
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import iiwa_dnn as d

DT = 2e-3
LONGEST = 6e-3
PLAIN = d.load_robot("iiwa7")


def controller(jerk: bool, **settings: Any) -> d.Controller:
    """A controller of an iiwa 7 whose targets may lie anywhere."""
    robot = PLAIN.with_limits(acceleration=10.0, jerk=500.0 if jerk else np.inf)
    limits: list[d.Limit] = [d.AccelerationLimits()]
    scheme = d.DoubleIndicator(
        orientation="none", extra_limits=limits + [d.JerkLimits()] * jerk, home=np.zeros(7)
    )
    return d.Controller(robot, scheme, dt=DT, **settings)


def driven(made: d.Controller, said: str, periods: np.ndarray, seed: int) -> tuple[Any, Any]:
    """Joint positions and commands of an arm that is asked far beyond its limits."""
    random = np.random.default_rng(seed)
    q = PLAIN.start_posture()
    tip = d.Configuration(PLAIN, q).position
    path, commands, t, target = [q], [], 0.0, d.Target(tip)
    for k, period in enumerate(periods):
        if k % 150 == 0:
            target = d.Target(tip + 2.0 * random.standard_normal(3))
        before = periods[k - 1] if k else DT
        stated = {"dt": {"dt": period}, "elapsed": {"elapsed": before}, "neither": {}}[said]
        commands.append(made.step(path[-1], t, target, **stated).dq)
        path.append(path[-1] + period * commands[-1])
        t += period
    return np.array(path), np.array(commands)


@pytest.mark.parametrize("jerk", [False, True])
@pytest.mark.parametrize("said", ["dt", "elapsed", "neither"])
def test_no_limit_is_passed_whatever_period_comes(said: str, jerk: bool) -> None:
    """Today's loop passed position limits by 2 mrad where periods were said, by 0.42 rad else."""
    for seed in range(3):
        random = np.random.default_rng(seed)
        periods = random.uniform(0.05, 1.0, 600) * LONGEST
        made = controller(jerk, longest_period=LONGEST)
        q, dq = driven(made, said, periods, seed)
        assert (q <= PLAIN.q_upper).all()
        assert (q >= PLAIN.q_lower).all()
        rates = {"dt": periods, "elapsed": np.r_[DT, periods[:-1]], "neither": np.full(600, DT)}
        period = rates[said][:, np.newaxis]
        acceleration = np.diff(dq, axis=0, prepend=0.0) / period
        assert np.abs(acceleration).max() <= 10.0 + 1e-7
        if jerk:
            assert np.abs(np.diff(acceleration, axis=0, prepend=0.0) / period).max() <= 500.1
        assert np.abs(q - q[0]).max() > 0.3


SLIDES = """<robot name="slides"><link name="base"/>
<joint name="one" type="prismatic"><parent link="base"/><child link="cart"/><axis xyz="1 0 0"/>
<limit lower="-5" upper="5" velocity="2" effort="1"/></joint><link name="cart"/>
<joint name="two" type="prismatic"><parent link="cart"/><child link="ball"/><axis xyz="0.8 0.6 0"/>
<limit lower="-{0}" upper="{0}" velocity="2" effort="1"/></joint>
<link name="ball"><collision><geometry><sphere radius="0.05"/></geometry></collision></link>
</robot>"""


def slides(folder: Path, acceleration: float, jerk: float = 60.0, most: float = 5.0) -> d.Shield:
    """A ball on two slides, the second of +- `most` [m], 0.53 - x away from a wall."""
    (folder / "slides.urdf").write_text(SLIDES.format(most))
    robot = d.load_robot(folder / "slides.urdf", tip="ball")
    robot = robot.with_limits(acceleration=acceleration, jerk=jerk)
    wall = d.HalfSpace(normal=(-1.0, 0.0, 0.0), offset=-0.6)
    return d.Shield(robot, 6e-3, [wall], 0.02, timeout=np.inf, longest_period=0.037)


Draw = Callable[[np.random.Generator], Any]


def path_at_the_wall(made: d.Shield, said: str, seed: int, steps: int, draw: Draw) -> np.ndarray:
    """Return positions (steps, 2) after periods, stated as `said`, that vary at random."""
    random = np.random.default_rng(seed)
    q = np.zeros(2)
    wanted = np.zeros(2)
    last = 6e-3
    path = []
    for _ in range(steps):
        long = random.random() < 0.5
        period = 0.037 * (1.0 if long else random.choice([0.01, 0.1, 0.3]))
        if random.random() < 0.1:
            wanted = draw(random)
        q = q + period * made.step(q, wanted, **{said: period if said == "dt" else last}).dq
        last = period
        path.append(q)
    return np.array(path)


@pytest.mark.parametrize(("said", "seed"), [("dt", 22), ("elapsed", 4), ("elapsed", 10)])
def test_no_wall_comes_too_near_beside_a_jerk_limit_whatever_period_comes(
    tmp_path: Path, said: str, seed: int
) -> None:
    """The ball came 17 to 243 micrometres too near."""

    def draw(random: np.random.Generator) -> Any:
        return random.uniform(-1.0, 1.0, 2) * 2.0 * random.choice([1.0, 0.1])

    path = path_at_the_wall(slides(tmp_path, 5.0), said, seed, 700, draw)
    assert (0.53 - path @ [1.0, 0.8]).min() >= 0.0


@pytest.mark.parametrize(("said", "seed"), [("dt", 23), ("elapsed", 32)])
def test_a_slide_that_its_own_limit_stops_leaves_the_other_no_nearer_to_a_wall(
    tmp_path: Path, said: str, seed: int
) -> None:
    """The slide that led away was braked before the other: 0.25 and 0.16 mm too near."""

    def draw(random: np.random.Generator) -> Any:
        wanted = random.uniform(-1.0, 1.0, 2) * [2.0, 1.0] * random.choice([1.0, -1.0])
        return np.abs(wanted) * [1.0, -2.0] if random.random() < 0.7 else wanted

    path = path_at_the_wall(slides(tmp_path, 5.0, 200.0, 0.3), said, seed, 450, draw)
    assert (np.abs(path[:, 1]) <= 0.3).all()
    assert (0.53 - path @ [1.0, 0.8]).min() >= 0.0


@pytest.mark.parametrize("seed", [1, 3, 9])
def test_no_wall_comes_too_near_if_steps_towards_it_alone_are_long(
    tmp_path: Path, seed: int
) -> None:
    """Periods that nobody states: the ball came 54 to 104 mm too near."""
    made = slides(tmp_path, 20.0)
    random = np.random.default_rng(seed)
    q = np.array([0.5, 0.0])
    wanted = np.zeros(2)
    nearest = np.inf
    for _ in range(600):
        if random.random() < 0.1:
            wanted = random.uniform(-1.0, 1.0, 2) * 2.0 * random.choice([1.0, 0.1])
        dq = made.step(q, wanted).dq
        q = q + (0.037 if dq @ [1.0, 0.8] > 0.0 else 0.00037) * dq
        nearest = min(nearest, 0.53 - q @ [1.0, 0.8])
    assert nearest >= 0.0


def test_without_a_longest_period_a_position_limit_is_passed() -> None:
    """The numbers above can fail."""
    random = np.random.default_rng(0)
    periods = random.uniform(0.05, 1.0, 1200) * LONGEST
    q, _ = driven(controller(False), "neither", periods, 0)
    assert max((q - PLAIN.q_upper).max(), (PLAIN.q_lower - q).max()) > 1e-2


@pytest.mark.parametrize(
    ("periods", "words"),
    [
        ({"dt": 0.0}, "dt: must be a finite number above 0"),
        ({"elapsed": -1e-3}, "elapsed: must be a finite number above 0"),
        ({"elapsed": np.nan}, "elapsed: must be a finite number above 0"),
        ({"dt": 1e-3, "elapsed": 1e-3}, "dt and elapsed: are two periods"),
    ],
)
def test_a_wrong_period_is_refused_and_changes_nothing(periods: Any, words: str) -> None:
    target = d.Target(np.array([0.2, 0.3, 0.9]))
    made = controller(True, longest_period=LONGEST)
    q = PLAIN.start_posture()
    for k in range(5):
        q = made.step(q, k * DT, target, elapsed=3e-3).next_q
    twin = copy.copy(made)
    with pytest.raises(d.InvalidInputError, match=words):
        made.step(q, 5 * DT, target, **periods)
    found = made.step(q, 5 * DT, target, elapsed=1e-3)
    expected = twin.step(q, 5 * DT, target, elapsed=1e-3).dq
    np.testing.assert_allclose(found.dq, expected, atol=1e-12)


def test_settings_of_periods_are_refused_by_name() -> None:
    q = PLAIN.start_posture()
    with pytest.raises(d.InvalidInputError, match="longest_period: must be at least dt"):
        controller(False, longest_period=1e-3).step(q, 0.0, d.Target(np.ones(3)))
    for longest in (1e-3, 0.0, np.nan):
        with pytest.raises(d.InvalidInputError, match="longest_period: must be"):
            d.Shield(PLAIN, DT, longest_period=longest)
    with pytest.raises(d.InvalidInputError, match="elapsed: needs a longest_period"):
        controller(False).step(q, 0.0, d.Target(np.ones(3)), elapsed=1e-3)


def test_a_period_above_the_longest_warns_once_and_is_a_reason() -> None:
    made = controller(False, longest_period=LONGEST)
    q = PLAIN.start_posture()
    target = d.Target(np.array([0.2, 0.3, 0.9]))
    with pytest.warns(UserWarning, match=r"a period of 0\.007 s is above the longest, 0\.006 s"):
        late = made.step(q, 0.0, target, elapsed=7e-3)
    assert late.active_limits[0] == "period exceeded"
    assert made.step(late.next_q, DT, target, dt=8e-3).active_limits[0] == "period exceeded"
    assert "period exceeded" not in made.step(q, 2 * DT, target, dt=LONGEST).active_limits


def test_the_clock_of_a_path_falls_behind_by_what_has_passed() -> None:
    """An arm that stands before a path loses all the time that passes, not the stated periods."""
    robot = PLAIN.with_limits(velocity=1e-3)
    circle = d.Circle(radius=0.1, period=1.0).anchored(
        d.Configuration(robot, robot.start_posture())
    )
    scheme = d.DoubleIndicator(extra_limits=(d.AccelerationLimits(10.0),))
    made = d.Controller(robot, scheme, circle, dt=DT, longest_period=LONGEST)
    q, t, behind = robot.start_posture(), 0.0, []
    for k in range(200):
        command = made.step(q, t, elapsed=5e-3 if k else DT)
        q = q + 5e-3 * command.dq
        behind.append(t - made.path_lag)
        t += 5e-3
    assert np.diff(behind).min() > 0.0
    assert behind[-1] - behind[-2] == pytest.approx(5e-3 * command.fraction)
    assert command.fraction < 0.2


@pytest.mark.parametrize("jerk", [np.inf, 500.0])
@pytest.mark.parametrize("said", ["dt", "elapsed", "neither"])
def test_a_shield_passes_no_limit_whatever_period_comes(said: str, jerk: float) -> None:
    """The arm goes at the commanded velocity for as long as the period lasts."""
    robot = PLAIN.with_limits(acceleration=10.0, jerk=jerk)
    for seed in range(3):
        random = np.random.default_rng(seed)
        shield = d.Shield(robot, DT, longest_period=LONGEST)
        q = np.array(robot.start_posture())
        elapsed, last, slope, most = DT, np.zeros(7), np.zeros(7), 0.0
        for k in range(800):
            if k % 80 == 0:
                request = {"dq": random.choice([-1.0, 1.0], 7) * 2.0 * robot.dq_max}
                if k % 160:
                    request = {"position": random.uniform(robot.q_lower - 0.3, robot.q_upper + 0.3)}
            period = LONGEST * random.choice([random.uniform(0.01, 1.0), 1.0])
            measured = {"dt": period, "elapsed": elapsed, "neither": DT}[said]
            stated = {} if said == "neither" else {said: measured}
            command = shield.step(q, **request, **stated)
            np.testing.assert_allclose(command.log.q, q, atol=1e-12)
            turned = (command.dq - last) / measured - slope
            slope = slope + turned
            assert np.abs(slope).max() <= 10.0 + 1e-6
            most = max(most, (np.abs(turned) / measured).max())
            q, last, elapsed = q + period * command.dq, command.dq, period
            assert (q <= robot.q_upper).all()
            assert (q >= robot.q_lower).all()
        assert most <= jerk * (1.0 + 1e-6)


def test_a_shield_takes_the_period_of_a_command_without_a_longest_one() -> None:
    """Velocity and acceleration limits hold at a shorter period; others are refused."""
    panda = d.load_robot("panda").with_limits(jerk=np.inf)
    shield, q, last = d.Shield(panda, 1e-3), np.array(panda.start_posture()), np.zeros(7)
    for period in (1e-3, 2e-4, 5e-4, 1e-3):
        command = shield.step(q, np.full(7, 9.0), dt=period)
        assert (np.abs(command.dq - last) <= period * panda.ddq_max + 1e-12).all()
        q, last = q + period * command.dq, command.dq
    with pytest.raises(d.InvalidInputError, match="elapsed: needs a longest_period"):
        shield.step(q, elapsed=1e-3)
    for loop in (shield, d.Shields(shield, 1)):
        with pytest.raises(d.InvalidInputError, match=r"dt: must be at most 0\.001 s"):
            loop.step(q if loop is shield else q[None], dt=2e-3)
    np.testing.assert_array_equal(shield.step(q, dt=1e-3).log.q, q)


def test_the_clock_of_a_shield_counts_the_periods_that_have_passed() -> None:
    robot = d.load_robot("iiwa7")
    shield = d.Shield(robot, 1e-3, [], longest_period=4e-3)
    q = shield.step(robot.start_posture(), np.full(7, 0.1), dt=1e-3).next_q
    passed = 0.0
    for elapsed in np.random.default_rng(0).uniform(5e-4, 4e-3, 20):
        q = shield.step(q, np.full(7, 0.1), elapsed=elapsed).next_q
        passed += elapsed
        assert shield.time == pytest.approx(passed + 1e-3, abs=1e-12)  # and the command's own


@pytest.mark.parametrize("late", [10, 40])
@pytest.mark.parametrize("jitter", [False, True])
def test_drives_that_are_late_pass_no_limit(late: int, jitter: bool) -> None:
    """With the measured positions compared with those of now, limits were passed by 0.126 rad."""
    random = np.random.default_rng(late)
    shield = d.Shield(PLAIN, 1e-3, delay=late * 1e-3, longest_period=2e-3 if jitter else None)
    path = [np.array(PLAIN.start_posture())]  # where the arm has to be at each millisecond
    for k in range(3000):
        if k % 100 == 0:
            request = random.uniform(-1.0, 1.0, 7) * 2.0 * PLAIN.dq_max
        measured = path[max(len(path) - 1 - late, 0)]
        steps = int(random.integers(1, 3)) if jitter else 1
        command = shield.step(measured, request, **({"dt": steps * 1e-3} if jitter else {}))
        assert "resynchronised to measured positions" not in command.reasons
        path += [path[-1] + (i + 1) * 1e-3 * command.dq for i in range(steps)]
        assert (path[-1] <= PLAIN.q_upper).all()
        assert (path[-1] >= PLAIN.q_lower).all()
    assert np.ptp(path, axis=0).min() > 0.3


def test_commands_of_short_periods_cover_the_delay() -> None:
    """The measured positions are those of a plant that is late, to the change within a period."""
    random = np.random.default_rng(0)
    robot = PLAIN.with_limits(acceleration=10.0)
    settings = {"delay": 5.3e-3, "longest_period": LONGEST, "tracking_error": 2e-5}
    shield = d.Shield(robot, DT, **settings)
    times = [0.0]
    path = [np.array(robot.start_posture())]
    elapsed = DT
    for k in range(2000):
        if k % 100 == 0:
            request = random.uniform(-1.0, 1.0, 7)
        late = times[-1] - shield.delay
        measured = np.array([np.interp(late, times, joint) for joint in np.transpose(path)])
        command = shield.step(measured, request, elapsed=elapsed)
        assert "resynchronised to measured positions" not in command.reasons
        elapsed = random.choice([0.02, 0.3, 0.6, 2.0]) * DT
        times.append(times[-1] + elapsed)
        path.append(path[-1] + elapsed * command.dq)
    assert np.ptp(path, axis=0).min() > 0.1


def test_a_blocked_arm_is_found_and_goes_on_from_where_it_is_and_what_is_under_way() -> None:
    shield = d.Shield(PLAIN.with_limits(acceleration=np.inf), 1e-3, delay=0.02)
    q = np.array(PLAIN.start_posture())
    for _ in range(20):
        shield.step(q, np.full(7, 0.5))
    blocked = []
    while not blocked or "resynchronised to measured positions" not in blocked[-1].reasons:
        blocked.append(shield.step(q, np.full(7, 0.5)))
    # 20 ms until it should have begun to move, 40 ms until it should be 0.02 rad on.
    assert 38 <= len(blocked) <= 42
    np.testing.assert_allclose(blocked[-1].log.q, q + 0.02 * 0.5, atol=1e-12)
    twin = pickle.loads(pickle.dumps(shield))
    np.testing.assert_array_equal(
        twin.step(q, twist=[0.1] * 6).dq, shield.step(q, twist=[0.1] * 6).dq
    )


@pytest.mark.parametrize("period", [{"dt": 0.0}, {"elapsed": np.nan}, {"elapsed": "now"}])
def test_a_shield_refuses_a_wrong_period_and_loses_nothing(period: Any) -> None:
    shield = d.Shield(PLAIN, DT, longest_period=LONGEST, delay=5e-3)
    q = np.array(PLAIN.start_posture())
    for _ in range(5):
        shield.step(q, np.full(7, 0.1), elapsed=3e-3)
    twin = copy.copy(shield)
    with pytest.raises(d.InvalidInputError, match="must be a finite number above 0"):
        shield.step(q, np.full(7, 0.3), **period)
    found = shield.step(q, elapsed=1e-3)
    expected = twin.step(q, elapsed=1e-3)
    np.testing.assert_allclose(found.dq, expected.dq, atol=1e-12)
    np.testing.assert_allclose(found.next_q, expected.next_q, atol=1e-15)


def test_a_shield_names_a_period_above_the_longest() -> None:
    shield = d.Shield(PLAIN, DT, longest_period=LONGEST)
    q = np.array(PLAIN.start_posture())
    with pytest.warns(UserWarning, match="above the longest"):
        command = shield.step(q, np.zeros(7), elapsed=1.0)
    assert command.active_limits == ("period exceeded",)
    assert shield.step(q, np.zeros(7), elapsed=DT).active_limits == ()


@pytest.mark.parametrize("said", ["dt", "elapsed"])
def test_beside_obstacles_jerk_and_distances_are_kept_in_any_periods(said: str) -> None:
    """A motion to rest that is fitted anew in each period broke jerk limits by up to 340 %."""
    robot = d.load_robot("ur5").with_limits(acceleration=10.0, jerk=1500.0)
    ball = d.Sphere([-0.5, -0.3, 0.3], 0.08)
    shield = d.Shield(robot, 1e-2, [ball], 0.02, longest_period=2e-2)
    scene = d.CollisionAvoidance([ball], distance=0.02).scene(robot)
    random = np.random.default_rng(1)
    q = np.array(robot.start_posture())
    last, slope, elapsed, path = np.zeros(6), np.zeros(6), 1e-2, [q]
    for k in range(1000):
        if k % 40 == 0:
            request = {
                "twist": [*(2.0 * (np.array([-0.5, -0.3, 0.3]) - 0.3 * random.random(3))), 0, 0, 0]
            }
            if k % 80:
                request = {"dq": 3.0 * random.standard_normal(6)}
        period = 2e-2 * random.choice([0.02, 1.0])
        measured = period if said == "dt" else elapsed
        dq = shield.step(q, **request, **{said: measured}).dq
        turned = (dq - last) / measured - slope
        assert np.abs(turned).max() / measured <= 1500.0 * (1.0 + 1e-6)
        slope, last, elapsed = slope + turned, dq, period
        q = q + period * dq
        path.append(q)
    assert scene.nearest(np.array(path), np.zeros(len(path)))[0].min() > 0.02 - 1e-9
    assert np.ptp(path, axis=0).max() > 0.3


def test_a_first_step_that_states_no_period_keeps_where_the_arm_was_put() -> None:
    """As libfranka's, whose first time since the last step is 0; its encoders may be off."""
    start = PLAIN.start_posture()
    shield = d.Shield(PLAIN, DT, longest_period=LONGEST)
    shield.reset(start)
    command = shield.step(start + 8e-3, np.full(PLAIN.dof, 5.0))
    np.testing.assert_allclose(command.next_q - start, DT * command.dq, atol=1e-12)
