"""Shields of many arms: each is a `Shield`, to the last bit given the same kinematics."""

import copy
import multiprocessing
import pickle
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import iiwa_dnn as d
from iiwa_dnn.control.requests import REASONS
from iiwa_dnn.step.requests import Reason

DT = 1e-3
START = np.array([-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0])
PLAIN = d.load_robot("iiwa7")
SMOOTH = PLAIN.with_limits(acceleration=10.0, jerk=500.0)
BALL = d.Sphere([0.36, 0.16, 0.64], 0.05)


def requests(kind: str, steps: int) -> Iterator[dict[str, np.ndarray]]:
    """Requests that are held, jump, are far too large, fall silent, or are not finite."""
    random = np.random.default_rng(0)
    size = 6 if kind == "twist" else 7
    own: dict[str, np.ndarray] = {}
    for k in range(steps):
        if k % 40 == 0:
            large = 1e4 if k % 200 == 0 else 1.0
            own = {kind: random.standard_normal(size) * np.exp(random.standard_normal()) * large}
        elif k % 120 == 1:
            own = {}
        elif k % 250 == 2:
            own = {kind: np.full(size, np.nan)}
        if kind == "position" and kind in own and k % 40 == 0:
            own[kind] = START + 0.3 * own[kind] / large
        yield own


def periods(k: int, longest: float | None) -> dict[str, float]:
    """Periods that are stated now and then; of those that vary, one is too long."""
    if longest is None:
        return {"dt": 0.5 * DT} if k % 7 == 3 else {}
    spread = DT * (0.2 + k * 0.37 % 3.3)
    return [{}, {"dt": min(spread, longest)}, {"elapsed": spread}][k % 3]


@pytest.mark.usefixtures("kernels_kinematics")
@pytest.mark.parametrize(("longest", "delay"), [(None, 0.0), (None, 0.02), (3e-3, 4e-3)])
@pytest.mark.parametrize("kind", ["dq", "twist", "position"])
def test_each_arm_is_a_shield(kind: str, longest: float | None, delay: float) -> None:
    settings: dict[str, Any] = {
        "dt": DT,
        "obstacles": [BALL],
        "timeout": 0.02,
        "longest_period": longest,
        "delay": delay,
        "tracking_error": 0.01,
    }
    shield = d.Shield(SMOOTH, **settings)
    shields = d.Shields(SMOOTH, 3, **settings)
    q = START.copy()
    limited = 0
    for k, own in enumerate(requests(kind, 500)):
        told = periods(k, longest)
        with np.testing.suppress_warnings() as warned:
            warned.filter(UserWarning, "a period of")
            command = shield.step(q, **own, **told)
        rows = {name: np.tile(value, (3, 1)) for name, value in own.items()}
        many = shields.step(np.tile(q, (3, 1)), **rows, **told)
        for i in range(3):
            assert many.dq[i].tobytes() == command.dq.tobytes()
            assert many.next_q[i].tobytes() == command.next_q.tobytes()
        assert many.clipped.tolist() == [command.clipped] * 3
        if k % 10 == 0:
            assert many.active_limits(1) == command.active_limits
            assert shields.stopping_time(2) == command.stopping_time
            assert shields.margin(0) == pytest.approx(command.margin, abs=1e-15)
        limited += bool(command.active_limits)
        q = command.next_q
        if k == 300:
            q = q + 0.05  # farther than the tracking error
        if k == 400:
            shield.halt()
            shields.halt()
    assert limited > 100
    assert many.reason[0] == Reason.HALTED


def stepped(shields: d.Shields, steps: int, seed: int = 0) -> np.ndarray:
    """Let arms follow their commands under random requests; return all commands."""
    random = np.random.default_rng(seed)
    q = np.tile(START, (shields.count, 1))
    found = []
    for _ in range(steps):
        command = shields.step(q, 3.0 * random.standard_normal(q.shape))
        q = command.next_q
        found.append(command.dq)
    return np.array(found)


def test_threads_change_nothing() -> None:
    one, two = (d.Shields(SMOOTH, 200, dt=DT, obstacles=[BALL], threads=k) for k in (1, 3))
    np.testing.assert_array_equal(stepped(one, 20), stepped(two, 20))


def test_an_arm_whose_numbers_are_not_finite_brakes_alone() -> None:
    shields = d.Shields(PLAIN.with_limits(acceleration=10.0), 3, dt=DT)
    request = np.ones((3, 7))
    q = np.tile(START, (3, 1))
    for k in range(160):
        command = shields.step(q, request)
        q = command.next_q.copy()
        if k == 50:
            request[1, 4] = np.inf
        if k >= 50:
            q[2, 0] = np.nan
    assert command.reason.tolist() == [Reason.NONE, Reason.NOT_FINITE, Reason.Q_NOT_FINITE]
    assert command.dq[0] == pytest.approx(1.0)
    assert not command.dq[1:].any()
    assert command.active_limits(2) == ("q not finite",)
    q[2] = shields.step(q, request).next_q[2]
    assert shields.step(q, request).dq[2, 0] > 0.0


def test_arms_without_a_new_request_go_on_until_theirs_is_too_old() -> None:
    shields = d.Shields(PLAIN, 2, dt=DT, timeout=0.01)
    single = d.Shields(PLAIN, 1, dt=DT, timeout=0.01)
    q = np.tile(START, (2, 1))
    shields.step(q, np.full((2, 7), 0.1))
    single.step(q[:1], np.full((1, 7), 0.1))
    for _ in range(12):
        command = shields.step(q, np.full((2, 7), 0.2), given=[True, False])
        alone = single.step(q[:1])
    assert (command.dq[0] > 0.07).all()
    np.testing.assert_array_equal(command.dq[1], alone.dq[0])
    assert command.reason[1] == alone.reason[0] == Reason.TIMED_OUT


def test_an_episode_that_begins_anew_repeats() -> None:
    shields = d.Shields(SMOOTH, 4, dt=DT, obstacles=[BALL])
    done = np.array([False, True, False, True])
    first = stepped(shields, 30)
    shields.reset(done)
    second = stepped(shields, 30)
    np.testing.assert_array_equal(first[:, done], second[:, done])
    assert (first[:, ~done] != second[:, ~done]).any()
    shields.reset(q=np.tile(START, (4, 1)))
    np.testing.assert_array_equal(stepped(shields, 30), first)


def test_obstacles_may_differ_from_arm_to_arm() -> None:
    balls = [[0.36, 0.16, 0.64], [0.4, 0.0, 0.7], [2.0, 2.0, 2.0]]
    among = [d.CollisionAvoidance([d.Sphere(ball, 0.05)], self_collision=False) for ball in balls]
    shields = d.Shields(SMOOTH, 3, dt=DT, obstacles=among[0])
    places = np.array(balls)[:, np.newaxis]
    q = np.tile(START, (3, 1))
    singles = [d.Shields(SMOOTH, 1, dt=DT, obstacles=each) for each in among]
    for k in range(150):
        command = shields.step(q, np.full((3, 7), 0.5), obstacles=places if k == 0 else None)
        for i, own in enumerate(singles):
            alone = own.step(q[i : i + 1], np.full((1, 7), 0.5))
            np.testing.assert_array_equal(command.dq[i], alone.dq[0])
        q = command.next_q
    assert len({shields.margin(i).distance for i in range(3)}) == 3


def test_a_wrong_input_changes_no_arm() -> None:
    shields = d.Shields(SMOOTH, 3, dt=DT, obstacles=[BALL])
    expected = stepped(copy.deepcopy(shields), 10)
    q = np.tile(START, (3, 1))
    wrong: list[dict[str, Any]] = [
        {"dq": np.ones((2, 7))},
        {"dq": np.ones(7)},
        {"twist": np.ones((3, 7))},
        {"dq": np.ones((3, 7)), "position": q},
        {"dq": np.ones((3, 7)), "given": np.ones(3)},
        {"dq": np.ones((3, 7)), "obstacles": np.zeros((2, 3))},
        {"dq": np.ones((3, 7)), "obstacles": [[0.0, np.nan, 0.0]]},
        {"dq": np.ones((3, 7)), "elapsed": 1e-3},
        {"dq": np.ones((3, 7)), "dt": -1.0},
        {"dq": np.ones((3, 7)), "dt": "1e-3"},
        {"dq": [["a"] * 7] * 3},
    ]
    for own in wrong:
        with pytest.raises(d.InvalidInputError):
            shields.step(q, **own)
    np.testing.assert_array_equal(stepped(shields, 10), expected)


def test_numbers_of_other_types_and_with_gaps_are_taken_and_commands_stay() -> None:
    shields = d.Shields(PLAIN, 2, dt=DT)
    q = np.tile(START, (2, 1)).astype(np.float32)
    first = shields.step(q[::-1], np.full((2, 7), 0.001))
    kept = copy.deepcopy(first[:4])
    shields.step(q, np.full((7, 2), 0.003).T)
    for found, expected in zip(first, kept, strict=False):
        np.testing.assert_array_equal(found, expected)
    twin = d.Shields(PLAIN, 2, dt=DT)
    np.testing.assert_array_equal(twin.step(q.astype(float), [[0.001] * 7] * 2).dq, first.dq)


def test_the_reason_of_an_arm_is_the_first_of_its_active_limits() -> None:
    shields = d.Shields(PLAIN.with_limits(acceleration=10.0), 3, dt=DT)
    q = np.tile(START, (3, 1))
    shields.step(q, np.ones((3, 7)))
    q[0, 0] = np.nan
    shields.halt(np.array([False, True, False]))
    command = shields.step(q, np.full((3, 7), np.nan))
    assert command.reason.tolist() == [Reason.NOT_FINITE, Reason.HALTED, Reason.NOT_FINITE]
    for i, reason in enumerate(command.reason):
        assert command.active_limits(i)[0] == REASONS[reason]
    assert command.active_limits(0)[:2] == ("request not finite", "q not finite")


def test_shields_of_a_shield_have_its_limits() -> None:
    """The speed of the tips is that of finite differences of Pinocchio's placements."""
    shield = d.Shield(PLAIN.with_limits(acceleration=10.0), DT)
    shield.limits += (d.TipSpeedLimit(0.2),)
    shields = d.Shields(shield, 2)
    path = [np.tile(START, (2, 1))]
    for _ in range(200):
        path.append(shields.step(path[-1], np.ones((2, 7))).next_q)
    tips = np.array([d.Configuration(PLAIN, q[1]).position for q in path])
    speeds = np.linalg.norm(np.diff(tips, axis=0), axis=1) / DT
    assert 0.19 < speeds.max() < 0.2 + 1e-4


def _commands(shields: d.Shields) -> np.ndarray:
    return stepped(shields, 20, seed=3)


def test_copies_pickles_and_forks_carry_the_state() -> None:
    shields = d.Shields(SMOOTH, 130, dt=DT, obstacles=[BALL], threads=2)
    stepped(shields, 10)
    copies = [copy.deepcopy(shields), pickle.loads(pickle.dumps(shields))]
    with multiprocessing.get_context("fork").Pool(1) as pool:
        forked = pool.apply(_commands, [shields])
    expected = _commands(shields)
    for found in [*map(_commands, copies), forked]:
        np.testing.assert_array_equal(found, expected)


def test_an_arm_with_a_ball_takes_at_most_8000_bytes() -> None:
    assert d.Shields(SMOOTH, 1, dt=DT, obstacles=[BALL])._memories.nbytes <= 8000


def test_a_frame_that_is_none_is_refused() -> None:
    with pytest.raises(d.NotFoundError):
        d.Shields(PLAIN, 2, frame="elbow")


@pytest.mark.usefixtures("kernels_kinematics")
def test_obstacles_that_move_do_so_for_many_arms_too() -> None:
    """They stood still in the step of many arms; a place that is given is where they are now."""
    ball = d.Sphere([0.36, 0.35, 0.64], 0.05, velocity=[0.0, -0.3, 0.0])
    shield = d.Shield(SMOOTH, DT, [ball])
    arms = d.Shields(SMOOTH, 2, dt=DT, obstacles=[ball])
    q = START
    for k in range(400):
        request = np.full(7, 0.5 * (-1) ** (k // 50))
        now = np.array([ball.center]) + k * DT * np.array([ball.velocity])
        told = {"obstacles": now} if k == 200 else {}
        many = arms.step(np.tile(q, (2, 1)), np.tile(request, (2, 1)), **told)
        command = shield.step(q, request)
        np.testing.assert_allclose(
            many.dq, np.tile(command.dq, (2, 1)), atol=0.0 if k < 200 else 1e-9
        )
        q = command.next_q
    assert arms.margin(0).distance == pytest.approx(command.margin.distance, abs=1e-9)


class Pendulum(d.Sphere):
    """A ball that swings in a way of its own."""

    def shift(self, t: float) -> np.ndarray:
        return np.array([0.1 * np.sin(t), 0.0, 0.0])


@pytest.mark.usefixtures("kernels_kinematics")
def test_a_shield_takes_places_of_obstacles_as_many_do() -> None:
    """To the bit; what cannot be taken changes nothing."""
    shield = d.Shield(SMOOTH, DT, [BALL])
    arms = d.Shields(SMOOTH, 1, dt=DT, obstacles=[BALL])
    q = START
    for k in range(400):
        request = np.full(7, 0.5 * (-1) ** (k // 100))
        places = np.array([BALL.center]) + [0.0, 3e-4 * k, 0.0]
        if k % 50 == 10:
            for wrong in (places[0], [*places, *places], [[0.0, np.inf, 0.0]]):
                with pytest.raises(d.InvalidInputError, match=r"^obstacles"):
                    shield.step(q, request, obstacles=wrong)
        many = arms.step([q], [request], obstacles=places)
        command = shield.step(q, request, obstacles=places)
        np.testing.assert_array_equal(command.dq, many.dq[0])
        assert command.margin == arms.margin(0)
        if k < 399:
            q = command.next_q
    there = d.Shield(SMOOTH, DT, [d.Sphere(places[0], BALL.radius)])
    assert there.step(q).margin.distance == pytest.approx(command.margin.distance, abs=1e-12)
    with pytest.raises(d.InvalidInputError, match=r"^obstacles: move in a way of their own: Pend"):
        d.Shield(SMOOTH, DT, [Pendulum(BALL.center, BALL.radius)]).step(q, obstacles=places)
