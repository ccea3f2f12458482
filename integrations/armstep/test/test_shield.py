"""A shield of armstep: the commands of `Shields`, from a file of tables."""

import copy
import functools
import multiprocessing
import pickle
import threading
from types import SimpleNamespace
from typing import Any

import armstep
import numpy as np
import pytest
from armstep.shield import rotation_vector

from iiwa_dnn import Configuration, Shield, Shields, Sphere, export, load_robot

DT = 1e-3
LONGEST = 3e-3
SMOOTH = load_robot("iiwa7").with_limits(acceleration=10.0, jerk=500.0)
START = np.array([-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0])
BALL = Sphere([0.36, 0.16, 0.64], 0.05)
SETTINGS: dict[str, Any] = {
    "dt": DT,
    "obstacles": [BALL],
    "timeout": 0.02,
    "longest_period": LONGEST,
    "delay": 4.3e-3,
}


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Classes that begin with the tables of one shield."""
    path = tmp_path_factory.mktemp("tables") / "a_shield.json"
    export.tables(Shield(SMOOTH, **SETTINGS), path, q0=START)
    kinds = {
        kind.__name__: functools.partial(kind, path) for kind in (armstep.Shield, armstep.Shields)
    }
    return SimpleNamespace(**kinds)


def tiled(own: dict[str, np.ndarray], count: int) -> dict[str, np.ndarray]:
    return {name: np.tile(value, (count, 1)) for name, value in own.items()}


def test_chunks_and_streams_have_the_bits_of_shields(package: Any) -> None:
    random = np.random.default_rng(1)
    here = Shields(SMOOTH, 1, samples=64, **SETTINGS)
    there = package.Shield()
    many = package.Shields(2)
    assert there.time == 0.0
    q = START.copy()
    seen = set()
    for k in range(1500):
        own: dict[str, Any] = {}
        if k % 250 == 40:
            times = k * DT - 0.02 + np.cumsum(random.uniform(0.01, 0.05, 8))
            points = q + 0.1 * np.cumsum(random.standard_normal((8, 7)), axis=0)
            points[0] *= np.nan if k > 1200 else 1.0
            keep = ["time", "path"][k // 250 % 2]
            there.follow(times, points, keep, now=k * DT)
            for arms, count in ((here, 1), (many, 2)):
                arms.follow(times, np.tile(points, (count, 1, 1)), keep, now=k * DT)
        elif 600 < k < 900 and k % 20 == 0:
            goal = START + 0.2 * np.sin(k * DT * np.arange(1.0, 8.0))
            own = {"position": goal, "lead": k // 100 % 3}
        wide = {
            name: value[np.newaxis] if name == "position" else value for name, value in own.items()
        }
        command = there.step(q, **own)
        same = here.step(q[np.newaxis], **wide)
        twice = many.step(
            np.tile(q, (2, 1)),
            **{n: np.tile(v, (2, 1)) if n == "position" else v for n, v in own.items()},
        )
        np.testing.assert_array_equal(command.dq, same.dq[0])
        np.testing.assert_array_equal(twice.dq, np.tile(command.dq, (2, 1)))
        assert command.reason == same.reason[0]
        assert (command.off > 0.0) <= (command.followed is not None)
        seen.add(command.reason.name)
        q = command.next_q
    assert {"NONE", "TIMED_OUT", "NOT_FINITE"} <= seen
    assert np.abs(q - START).max() > 0.05


def test_a_preview_is_that_of_python_and_changes_nothing(tmp_path: Any) -> None:
    about: dict[str, Any] = {"dt": 4e-3, "obstacles": [BALL]}
    shield = Shield(SMOOTH, **about)
    there = armstep.Shield(export.tables(shield, tmp_path / "arm.json", q0=START))
    with pytest.raises(armstep.InputError, match="needs a step before"):
        there.preview([0.1], [START])
    with pytest.raises(armstep.InputError, match="state now= for another clock"):
        there.follow([1.7e9], [START])
    with pytest.raises(armstep.InputError, match="time: must be finite"):
        there.step(START, position=START, time=np.nan)
    for made in (shield, there):
        made.step(START, np.zeros(7))
    times = 0.01 + np.arange(20) / 30.0
    way = (1.0 - np.cos(np.pi * np.arange(20) / 19.0))[:, np.newaxis]
    beyond = np.where(np.arange(7) == 1, -1.0, 0.2)  # joint 2 beyond its range
    for most, keep in ((0.02, "time"), (0.4, "time"), (0.4, "path"), (0.8 * beyond, "time")):
        points = START + most * way
        kept = there.save()
        here = shield.preview(times, points, keep)
        found = there.preview(times, points, keep)
        np.testing.assert_array_equal(there.save(), kept)
        np.testing.assert_allclose(found.off, here.off, atol=1e-9)
        assert found.late == pytest.approx(here.late, abs=1e-9)
        assert (found.sample, found.active_limits) == (here.sample, here.active_limits)
    assert there.preview([-1.0], [START])[:2] == (0, ("samples stale",))


def test_postures_of_poses(tmp_path: Any) -> None:
    shield = Shield(SMOOTH, DT)
    there = armstep.Shield(export.tables(shield, tmp_path / "arm.json", q0=START))
    random = np.random.default_rng(0)
    for _ in range(50):
        q = random.uniform(0.8 * SMOOTH.q_lower, 0.8 * SMOOTH.q_upper)
        own = Configuration(SMOOTH, q)
        for found, expected in zip(
            there.frame_at(q), (own.position, own.rotation, own.jacobian), strict=True
        ):
            np.testing.assert_allclose(found, expected, atol=1e-12)
        begin = q + 0.1 * random.standard_normal(7)
        posture = there.solve_pose(own.position, own.rotation, begin)
        end = Configuration(SMOOTH, posture)
        np.testing.assert_allclose(end.position, own.position, atol=1e-4)
        np.testing.assert_allclose(end.rotation, own.rotation, atol=2e-4)
        assert np.abs(posture - begin).max() < 1.0
    assert there.solve_pose([2.0, 0.0, 0.0], np.eye(3), START) is None
    turned = np.diag([1.0, -1.0, -1.0])  # half a turn
    np.testing.assert_allclose(rotation_vector(turned), [np.pi, 0.0, 0.0])


def test_samples_without_a_meaning_are_refused(package: Any) -> None:
    made = package.Shield()
    for times, positions, keep in (
        ([0.0, 0.0], np.tile(START, (2, 1)), "time"),
        (np.arange(65.0), np.tile(START, (65, 1)), "time"),
        ([], np.zeros((0, 7)), "time"),
        ([0.0], [START], "neither"),
        ([0.0], [START[:6]], "path"),
    ):
        with pytest.raises(armstep.InputError):
            made.follow(times, positions, keep)
    for own in ({"dq": START, "lead": 1}, {"position": START, "lead": 3}, {"time": 0.0}):
        with pytest.raises(armstep.InputError, match="belong to a position"):
            made.step(START, **own)
    made.follow([-1.0], [START])
    assert made.step(START).reason in (armstep.Reason.NO_REQUEST, armstep.Reason.STALE)


def test_each_kind_of_request_has_the_bits_of_shields(package: Any) -> None:
    random = np.random.default_rng(0)
    here = Shields(SMOOTH, 1, **SETTINGS)
    there = package.Shield()
    many = package.Shields(65, threads=2)
    q = START.copy()
    seen = set()
    for k in range(1200):
        if k % 30 == 0:
            kind = ["dq", "twist", "position"][k // 30 % 3]
            own = {kind: random.standard_normal(6 if kind == "twist" else 7)}
            if kind == "position":
                own = {kind: q + 0.3 * own[kind]}
        told: dict[str, float] = [{}, {"dt": 2.0 * DT}, {"elapsed": 0.7 * DT}][k % 3]
        given = own if k % 120 < 60 else {}
        expected = here.step(q[np.newaxis], **tiled(given, 1), **told)
        found = there.step(q, **given, **told)
        batch = many.step(np.tile(q, (65, 1)), **tiled(given, 65), **told)
        assert found.dq.tobytes() == expected.dq[0].tobytes()
        assert found.next_q.tobytes() == expected.next_q[0].tobytes()
        assert (found.clipped, found.reason) == (expected.clipped[0], expected.reason[0])
        assert batch.dq.tobytes() == 65 * found.dq.tobytes()
        assert found.active_limits == expected.active_limits(0)
        assert found.margin == here.margin(0)
        assert found.stopping_time == here.stopping_time(0)
        seen.update(found.active_limits)
        q = found.next_q + (0.05 if k == 500 else 0.0)
    assert len(seen) > 15


def test_halt_reset_and_send(package: Any) -> None:
    shield = package.Shield()
    first = [shield.step(START, dq=np.full(7, 0.2)).dq for _ in range(50)]
    shield.halt()
    for _ in range(300):
        command = shield.step(START, dq=np.full(7, 0.2))
    assert not command.dq.any()
    assert command.active_limits[0] == "halted"
    shield.reset()
    again = [shield.step(START, dq=np.full(7, 0.2)).dq for _ in range(50)]
    np.testing.assert_array_equal(first, again)
    shield.reset(START)
    assert shield.step(START + 0.01, dq=np.zeros(7), dt=DT).next_q == pytest.approx(START)
    # Somebody else sends what the shield would have: the next command is the same.
    other = package.Shield()
    shield.reset()
    shield.step(START, dq=np.full(7, 0.2))
    other.step(START, dq=np.full(7, 0.2))
    sent = shield.step(START).dq
    other.send(sent)
    assert shield.step(START).dq.tobytes() == other.step(START).dq.tobytes()


def test_obstacles_are_where_they_are_said_to_be(package: Any) -> None:
    far = package.Shield().step(START, obstacles=[[3.0, 3.0, 3.0]])
    beside = [[0.36, 0.18, 0.64]]  # nearer than the links of the wrist are to each other
    near = package.Shield().step(START, obstacles=beside)
    assert far.margin.distance > near.margin.distance
    places = np.array([[[3.0, 3.0, 3.0]], beside])
    shields = package.Shields(2)
    shields.step(np.tile(START, (2, 1)), obstacles=places)
    assert [shields.margin(i) for i in range(2)] == [far.margin, near.margin]


def test_other_types_of_numbers_are_computed_in_float64(package: Any) -> None:
    wide = np.zeros((7, 3), np.float32)
    wide[:, 1] = START
    command = package.Shield().step(wide[:, 1], [0] * 7)
    same = package.Shield().step(START.astype(np.float32).astype(float), np.zeros(7))
    assert command.dq.dtype == np.float64
    assert command.next_q.tobytes() == same.next_q.tobytes()


@pytest.mark.parametrize(
    "own",
    [
        {"q": START[:6]},
        {"q": np.full(7, np.nan)},
        {"q": np.full(7, 1e300)},
        {"dq": np.zeros((1, 7))},
        {"dq": ["a"] * 7},
        {"dq": START, "twist": np.zeros(6)},
        {"dt": 0.0},
        {"dt": "1e-3"},
        {"dt": DT, "elapsed": DT},
        {"position": START, "lead": 5, "obstacles": [[0.5, 0.5, 0.5]]},
        {"obstacles": [[0.0, 0.0, np.inf]]},
        {"obstacles": np.zeros((2, 3))},
    ],
)
def test_wrong_input_is_an_error_and_changes_nothing(package: Any, own: dict[str, Any]) -> None:
    shield = package.Shield()
    shield.step(START, dq=np.ones(7))
    before = shield.save().tobytes()
    with pytest.raises(armstep.InputError, match=r"must|pass|lead"):
        shield.step(**{"q": START, **own})
    assert shield.save().tobytes() == before


def _run(shield: Any) -> bytes:
    q = START
    for _ in range(30):
        command = shield.step(q, twist=np.array([0.0, 0.1, 0.1, 0.0, 0.2, 0.0]))
        q = command.next_q
    return bytes(command.dq.tobytes())


def test_copies_pickles_forks_and_threads_carry_the_state(package: Any) -> None:
    shield = package.Shield()
    _run(shield)
    others = [copy.copy(shield), copy.deepcopy(shield), pickle.loads(pickle.dumps(shield))]
    with multiprocessing.get_context("fork").Pool(1) as pool:
        forked = pool.apply(_run, [shield])
    expected = _run(shield)
    assert [*map(_run, others), forked] == [expected] * 4
    errors: list[bool] = []

    def ask() -> None:
        errors.extend(bool(np.abs(shield.step(START).dq).max() > 10.0) for _ in range(200))

    threads = [threading.Thread(target=ask) for _ in range(4)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert len(errors) == 800
    assert not any(errors)


def test_it_says_what_it_is(package: Any) -> None:
    shield = package.Shield()
    own = shield.tables
    assert own.joint_names == tuple(SMOOTH.joint_names)
    assert own.frame_names == (SMOOTH.tip,)
    np.testing.assert_array_equal(own.limits["jerk"], SMOOTH.dddq_max)
    assert (shield.dt, own.longest_period, own.delay) == (DT, LONGEST, SETTINGS["delay"])
    assert (own.name, own.kind, own.obstacle_names) == ("a_shield", "shield", ("Sphere 1",))
    command = shield.step(START, dq=np.ones(7))
    assert command.active_limits
    assert command.active_limits[0] in repr(command)
    assert command.reason is armstep.Reason.NONE
    with pytest.raises(armstep.InputError, match="dt: is fixed"):
        shield.dt = 0.1
    with pytest.raises(armstep.InputError, match="dt: cannot be deleted"):
        del own.dt
    with pytest.raises(TypeError, match="does not support item assignment"):
        own.limits["upper"] = np.full(7, 9.0)
    with pytest.raises(armstep.InputError, match="scratch: is fixed"):
        own.scratch = 1
    with pytest.raises(AttributeError):
        command.memory = np.zeros(1)
    with pytest.raises(ValueError, match="read-only"):
        own.limits["upper"][0] = 9.0


def test_a_saved_state_goes_on_as_if_nothing_was(package: Any) -> None:
    shield, shields = package.Shield(), package.Shields(3)
    _run(shield)
    saved = shield.save()
    expected = _run(shield)
    shield.load(saved)
    assert _run(shield) == expected
    many = np.repeat(saved, 3, axis=0)
    shields.load(many)
    np.testing.assert_array_equal(shields.save(), many)
    bent = many.copy()
    bent[2, 40] = np.nextafter(bent[2, 40], 1.0)
    with pytest.raises(armstep.TablesError, match="saved: is damaged, or of other tables"):
        shields.load(bent)
    np.testing.assert_array_equal(shields.save(), many)


def test_rows_of_masks_are_those_of_their_arms(package: Any) -> None:
    shields, alone = package.Shields(4), package.Shield()
    mask = np.array([False, False, True, False])
    q = START + np.arange(4)[:, np.newaxis] * 1e-3
    dq = np.full((4, 7), 0.2)
    shields.step(START + 0.0 * q, dq)
    shields.halt(mask)
    assert (shields.step(START + 0.0 * q, dq).reason == mask * armstep.Reason.HALTED).all()
    shields.reset(mask, q)
    alone.reset(q[2])
    expected = alone.step(q[2], dq[2]).next_q
    assert shields.step(q, dq).next_q[2].tobytes() == expected.tobytes()
    with pytest.raises(armstep.InputError, match=r"mask: must be booleans of shape \(4,\)"):
        shields.halt(mask[:3])
    with pytest.raises(armstep.InputError, match="count: must be at least 1"):
        package.Shields(0)
