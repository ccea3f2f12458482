"""Bodies of bounded speed: at rest before contact, whatever the sensor says later."""

from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import iiwa_dnn
from helpers_export import in_armstep
from iiwa_dnn import Capsule, CollisionAvoidance, InvalidInputError, Shield, Shields, Sphere
from iiwa_dnn.schemes.rest import Motion, velocity_at
from iiwa_dnn.schemes.scene import Pair
from iiwa_dnn.schemes.separation import (
    FREE_BODY,
    SHARE,
    FreeBody,
    Separation,
    WatchedLink,
    quick_periods,
    separation_views,
)

judge_people = pytest.importorskip("judge_people", reason="numba compiles the judge")

ROBOT = iiwa_dnn.load_robot("iiwa7").with_limits(acceleration=10.0)
REQUEST = np.full(7, 0.3)
FAR = [([1.8, 0.0, 0.2], [1.8, 0.0, 1.6], 0.2)]
NEAR = [([0.5, 0.0, 0.2], [0.5, 0.0, 1.6], 0.2)]


def made(**own: Any) -> Shield:
    return Shield(ROBOT, **({"people": 3, "field": 2.5, "obstacles": []} | own))


def driven(shield: Any, steps: int, q: Any = None, **own: Any) -> Any:
    """Drive for a number of steps, the last one with `own` too; return the last command."""
    q = ROBOT.start_posture() if q is None else q
    for k in range(steps):
        command = shield.step(
            q, REQUEST, **(own if k == steps - 1 else {"people": FAR, "age": 0.1})
        )
        q = command.next_q
    return command


def hostile(**own: Any) -> Any:
    made = {"robot": ROBOT, "count": 9, "error": 0.0, "modes": (0, 1, 3)}
    return judge_people.Scene(**(made | own))


def test_no_link_in_motion_is_touched() -> None:
    scene = hostile(error=0.03, modes=tuple(range(9)), lost=0.3, people=2)
    found = judge_people.run(scene, 1500, 1, judge_people.told(scene))
    assert found.contacts == 0
    assert found.least > scene.distance - 1e-9
    assert found.moving > 0.5
    assert max(found.rates) < 1.0 + 1e-9


def test_the_shield_of_moving_obstacles_alone_is_touched() -> None:
    scene = hostile(modes=(0,), count=4)
    assert judge_people.run(scene, 1500, 0, judge_people.today(scene)).contacts > 0


@pytest.mark.parametrize("lie", ["age", "error", "speed", "still", "missing", "field"])
def test_what_is_not_told_is_missed_and_what_is_told_is_just_enough(lie: str) -> None:
    """The test of the motion to rest alone, whose least distance is within a millimetre."""
    own: Any = {"count": 6, "error": 0.03 if lie == "error" else 0.0}
    if lie == "field":
        slow = ROBOT.with_limits(acceleration=4.0)
        own |= {"robot": slow, "speed": 2.0, "reach": 1.6}
    for told in (lie, ""):
        scene = hostile(**own, lies={told})
        found = judge_people.run(scene, 2500, 2, judge_people.told(scene))
        assert (found.contacts > 0) == (told == lie)
    if lie != "error":  # of 30 mm, in any direction
        assert scene.distance - 1e-9 <= found.least < scene.distance + 1e-3


@pytest.mark.parametrize("lost", [0.3, 0.97])
def test_arms_go_on_when_a_frame_says_that_all_have_left(lost: float) -> None:
    """Of arms that never come to know it, those at rest are no traps: people grow older."""
    robot = ROBOT.with_limits(jerk=500.0)
    scene = hostile(robot=robot, count=14, modes=(judge_people.LEAVE,), lost=lost, error=0.03)
    found = judge_people.run(scene, 6000, 3, judge_people.told(scene))
    assert found.contacts == found.trapped == 0
    assert (found.tail == 0.0).any() == (lost > 0.9)
    assert found.tail.mean() > (0.4 if lost > 0.9 else 0.95)


def test_shields_answer_as_a_shield_does() -> None:
    one = made()
    many = Shields(made(), 2)
    q = np.tile(ROBOT.start_posture(), (2, 1))
    people = ([0.9, 0.0, 0.4], [0.9, 0.3, 0.9], 0.1)
    for k in range(60):
        own = {} if k % 7 else {"people": [people], "age": 0.05}
        alone = one.step(q[0], REQUEST, **own)
        both = many.step(q, np.tile(REQUEST, (2, 1)), **own)
        np.testing.assert_allclose(both.dq, np.tile(alone.dq, (2, 1)), atol=1e-9)
        q = both.next_q
    assert many.margin().separation[1] == pytest.approx(alone.margin.separation, abs=1e-9)
    many.step(q, np.tile(REQUEST, (2, 1)), people=[[people], None], age=0.0)
    one, other = many.margin().separation  # of the second arm the frame is older
    assert one > other + 0.05


def test_the_core_knows_the_separation_of_a_controller_too(tmp_path: Path) -> None:
    shield = made(longest_period=None)
    scheme = iiwa_dnn.DoubleIndicator()
    limits = [*scheme.limits, *shield.limits[-1:]]
    path = iiwa_dnn.Heart(period=10.0)
    q = ROBOT.start_posture()
    reference = path.anchored(iiwa_dnn.Configuration(ROBOT, q))
    controller = iiwa_dnn.Controller(
        ROBOT, iiwa_dnn.Scheme(scheme.costs, scheme.tasks, limits), reference
    )
    found = []
    for own, asked in ((shield, np.zeros(7)), (controller, 0.0)):
        arm = in_armstep(own, tmp_path)
        core = import_module("armstep._library").ONE
        given = (arm.tables.arm, arm._memory.ctypes, np.empty(arm.tables.scratch).ctypes)
        assert np.isnan(core.armstep_separation(*given))
        arm.see(np.array([[0.9, 0.0, 0.4, 0.9, 0.3, 0.9, 0.1]]), 0.0)
        arm.step(q, asked)
        found.append(core.armstep_separation(*given))
    assert 0.0 < found[0] < 1.0
    assert found[0] == found[1]


def test_the_core_answers_to_the_bit(tmp_path: Path) -> None:
    shield = made(longest_period=None)
    many = Shields(shield, 1)
    arm = in_armstep(shield, tmp_path)
    q = ROBOT.start_posture()
    frame = np.array([[0.9, 0.0, 0.4, 0.9, 0.3, 0.9, 0.1]])
    for k in range(80):
        own: Any = {} if k % 7 else {"people": frame[: k % 3], "age": 0.05}
        if own:
            arm.see(**own)
        there = arm.step(q, REQUEST)
        here = many.step([q], [REQUEST], **own)
        assert there.dq.tobytes() == here.dq[0].tobytes()
        assert there.margin.separation == many.margin(0).separation
        q = here.next_q[0]
    arm.see(np.full((1, 7), np.nan), age=0.05)
    assert arm.step(q, REQUEST).reason.name == "FRAME_REFUSED"


@pytest.mark.parametrize(
    ("frame", "age"),
    [
        ([([np.nan, 0, 0], [0, 0, 1], 0.1)], 0.1),
        ([([2.0, 0, 0], [2.0, 0, 1], -0.1)], 0.1),
        (FAR * 4, 0.1),
        (FAR, -0.01),
        (FAR, np.nan),
        (FAR, np.inf),
        (FAR, 0.2),
    ],
)
def test_what_has_no_meaning_is_no_frame(frame: Any, age: float) -> None:
    shield = made()
    command = driven(shield, 300, people=frame, age=age)
    assert command.reasons == ("frame of bodies refused",)
    before = command.margin.separation
    later = driven(shield, 2, command.next_q)  # accepted again
    assert later.reasons == ()
    assert later.margin.separation > before - 0.01


@pytest.mark.parametrize("share", [SHARE, judge_people.NO_SHARE])
def test_who_is_beyond_the_field_comes_nearer_while_there_is_no_news(share: float) -> None:
    """Nobody was in the field; without a share the test of the motion to rest stands alone."""
    shield = made(people=1)
    shield.limits = (*shield.limits[:-1], replace(shield.limits[-1], share=share))
    skeleton = judge_people.skeleton_of(ROBOT)
    ends = np.empty(skeleton.ends.shape)
    command = shield.step(ROBOT.start_posture(), REQUEST, people=[], age=0.05)
    least, separations = np.inf, []
    for k in range(2, 1000):
        command = shield.step(command.next_q, REQUEST)
        separations.append(command.margin.separation)
        judge_people.place(skeleton, command.next_q, ends)
        out = np.linalg.norm(ends, axis=2).max(axis=1) + skeleton.radii
        if np.abs(command.dq).max() > 1e-12:
            least = min(least, 2.5 - out.max() - 0.02 - 2.0 * (0.05 + k * shield.dt))
    assert not command.dq.any()
    assert -1e-9 <= least < (2e-3 if share > SHARE else 0.1)
    assert np.diff(separations[-9:]) == pytest.approx(-2.0 * shield.dt)


def test_without_news_the_arm_comes_to_rest_and_says_so() -> None:
    shield = made()
    assert not driven(shield, 1, people=None).dq.any()
    command = shield.step(ROBOT.start_posture(), REQUEST)
    assert command.active_limits[0] == "no frame of people yet"
    command = driven(shield, 400)
    assert command.dq.any()
    for _ in range(1500):
        command = shield.step(command.next_q, REQUEST)
    assert not command.dq.any()
    assert command.active_limits[0] == "age of people 1.60 s"
    command = shield.step(command.next_q, REQUEST, people=NEAR, age=0.1)
    assert command.active_limits[0].startswith("separation of iiwa7_link_")
    assert command.active_limits[0].endswith(" from person 1")
    assert command.margin.separation < 0.0
    shield = made(field=0.8)
    assert "edge of the field" in driven(shield, 300, people=[], age=0.1).active_limits[0]


def test_a_body_is_seen_by_its_name_and_others_grow_older() -> None:
    hand = Sphere([1.5, 0.0, 0.5], 0.06, speed=1.6, error=0.03, name="hand")
    arm = Capsule([2.0, 0.0, 0.0], [2.0, 0.0, 1.0], 0.1, speed=1.6)
    table = iiwa_dnn.Box([0.0, 0.0, -0.3], [0.5, 0.5, 0.1])
    shield = Shield(ROBOT, obstacles=[table, hand, arm])
    q = ROBOT.start_posture()
    both = {"hand": [1.5, 0.0, 0.5], "Capsule 2": ([2.0, 0.0, 0.0], [2.0, 0.0, 1.0])}
    assert not shield.step(q, REQUEST, obstacles={"hand": both["hand"]}, age=0.0).dq.any()
    for _ in range(300):
        command = shield.step(q, REQUEST, obstacles=both, age=0.0)
        q = command.next_q
    assert command.dq.any()
    for _ in range(1500):
        command = shield.step(q, REQUEST, obstacles={"hand": both["hand"]}, age=0.0)
        q = command.next_q
    assert not command.dq.any()
    assert command.active_limits[0] == "age of Capsule 2 1.50 s"
    with pytest.raises(iiwa_dnn.NotFoundError, match="foot"):
        shield.step(q, REQUEST, obstacles={"foot": [0, 0, 0]})
    assert Shield(ROBOT, obstacles=[table]).step(q, REQUEST).margin.separation == np.inf


def test_settings_that_have_no_meaning_are_refused() -> None:
    with pytest.raises(InvalidInputError, match="field"):
        Shield(ROBOT, people=2)
    with pytest.raises(InvalidInputError, match="contact_speed"):
        made(contact_speed=0.25, longest_period=0.002)
    # Stops took up to 1.4 times as long as their test counts on, and hands met links at 3 mm/s.
    jerky = ROBOT.with_limits(jerk=500.0)
    with pytest.raises(InvalidInputError, match="longest_period: with jerk limits"):
        Shield(jerky, people=1, field=2.5, longest_period=0.002)
    with pytest.raises(InvalidInputError, match="velocity"):
        Sphere([1, 0, 0], 0.1, speed=1.0, velocity=[2.0, 0, 0])
    with pytest.raises(InvalidInputError, match="error"):
        Sphere([1, 0, 0], 0.1, error=0.1)
    with pytest.raises(InvalidInputError, match="not known"):
        CollisionAvoidance([Sphere([1, 0, 0], 0.1, speed=1.0)])
    with pytest.raises(InvalidInputError, match="people"):
        Shield(ROBOT).step(ROBOT.start_posture(), REQUEST, people=[])
    with pytest.raises(InvalidInputError, match="people"):
        made().step(ROBOT.start_posture(), REQUEST, people=[([0, 0, 1], 0.1)])
    for people in (5, [3.0], [([0, 0, 1], [0, 0, 2])]):
        with pytest.raises(InvalidInputError, match="must be tuples"):
            made().step(ROBOT.start_posture(), REQUEST, people=people)
    with pytest.raises(InvalidInputError, match="Box with a speed"):
        Separation((Sphere([1, 0, 0], 0.1),))


@pytest.mark.parametrize(
    ("names", "words"),
    [
        (("cup", "cup"), "two go by the name 'cup'"),
        (("iiwa7_link_5", "cup"), "one goes by the link's name 'iiwa7_link_5'"),
    ],
)
def test_a_name_is_that_of_one_body_whether_it_has_a_speed_or_not(
    names: tuple[str, str], words: str
) -> None:
    bodies = [Sphere([2.0, k, 1.0], 0.1, name=name) for k, name in enumerate(names)]
    with pytest.raises(InvalidInputError, match=words):
        made(people=0, field=None, obstacles=[replace(bodies[0], speed=1.0), bodies[1]])


def test_a_link_is_slow_after_the_periods_that_are_counted() -> None:
    part = Separation(people=1, field=2.0)
    own = separation_views(part.constants(ROBOT))
    assert FreeBody.width() == FREE_BODY
    random = np.random.default_rng(0)
    for _ in range(200):
        link = WatchedLink.of(own.links[random.integers(own.head.links)])
        pair = Pair.of(link.reach)
        M = float(random.integers(1, 200))
        cubic = bool(random.random() < 0.7)
        x = random.normal(size=7)
        b = random.normal(size=7) * cubic
        motion = Motion(x, b, M, 1e-3, cubic, False, False)
        limit = float(10.0 ** random.uniform(-2, 0.5))
        quick = quick_periods(motion, link, limit)
        u = np.arange(M) / M
        rates = np.array(
            [[abs(velocity_at(*xb, at, cubic)) for xb in zip(x, b, strict=True)] for at in u]
        )
        speeds = rates @ np.where(pair.support > 0, pair.radii + link.radius, 0.0)
        assert not (speeds[int(quick) :] > limit).any()
        assert quick_periods(motion, link, 0.0) == (M if speeds.any() else 0.0)


def test_a_link_may_be_touched_at_the_contact_speed_and_no_quicker() -> None:
    scene = hostile(contact_speed=0.25, modes=(0, 3), people=1)
    found = judge_people.run(scene, 1500, 3, judge_people.told(scene))
    assert found.contacts == 0
    assert 0.0 < found.quickest <= 0.25


RULE = Separation(people=2, people_speed=1.6, field=1e3, latency=0.14)


def tracking(*limits: Any) -> iiwa_dnn.Controller:
    start = iiwa_dnn.Configuration(ROBOT, ROBOT.start_posture())
    heart = iiwa_dnn.Heart(scale=7e-3, period=4.0).anchored(start)
    scheme = iiwa_dnn.DoubleIndicator(extra_limits=(iiwa_dnn.AccelerationLimits(), *limits))
    return iiwa_dnn.Controller(ROBOT, scheme, heart)


@pytest.mark.parametrize("is_told", [True, False])
def test_a_controller_rests_before_it_is_touched_and_its_path_waits(is_told: bool) -> None:
    scene = hostile(count=4, error=0.03, modes=(0, 3, 7, 8), lost=0.3, people=2)
    arms = [tracking(*[RULE] * is_told) for _ in range(scene.count)]
    words: set[str] = set()

    def drive(k: int, q: Any, _: Any, frame: Any) -> tuple[Any, Any]:
        commands = []
        for i, arm in enumerate(arms):
            own = {}
            if is_told and frame is not None and frame[3][i]:
                radius = np.full((2, 1), scene.radius + scene.error)
                people = np.hstack([frame[1][i].reshape(-1, 6), radius])[frame[2][i]]
                own = {"people": people, "age": (k - frame[0]) * scene.dt}
            commands.append(arm.step(q[i], k * scene.dt, **own))
            words.update(commands[-1].active_limits)
        return np.array([each.dq for each in commands]), [not each.ok for each in commands]

    found = judge_people.run(scene, 1500, 1, drive)
    assert (found.contacts == 0) == is_told
    if is_told:
        assert found.moving > 0.5
        assert max(found.rates) < 1.0 + 1e-9
        assert any(each.startswith("separation of iiwa7_link_") for each in words)


def test_a_path_waits_for_who_stays_and_the_core_answers_alike(tmp_path: Path) -> None:
    hand = Sphere([1.5, 0.0, 0.5], 0.06, speed=1.6, name="hand")
    controller = tracking(replace(RULE, bodies=(hand,)))
    controller.warm_up(ROBOT.start_posture())
    arm = in_armstep(controller, tmp_path)
    with pytest.raises(ValueError, match="there is no 'foot', but hand"):
        arm.see(bodies={"foot": (np.zeros(3), np.eye(3))})
    q = ROBOT.start_posture()
    tip = iiwa_dnn.Configuration(ROBOT, q).position
    for k in range(900):
        own: Any = {}
        if k % 20 == 0:
            center = tip + ([0.0, 0.0, 0.2] if 300 <= k < 700 else [0.0, 0.0, 1.5])
            people = np.array([[*tip, *tip, 0.1]])[: int(500 <= k < 700)]
            own = {"people": people, "obstacles": {"hand": center}, "age": 0.02}
            arm.see(people, 0.02, {"hand": (center, np.eye(3))})
        here = controller.step(q, 1e-3 * k, **own)
        there = arm.step(q, 1e-3 * k)
        np.testing.assert_allclose(there.dq, here.dq, atol=1e-8)
        q = here.next_q
        if k in (200, 899):
            assert here.dq.any()
        if k == 400:
            assert here.active_limits[0].endswith("from hand")
            lag = controller.path_lag
        if k == 690:
            assert not here.dq.any()
            assert here.active_limits[0].startswith(("age of people", "separation"))
            assert controller.path_lag - lag == pytest.approx(0.29, abs=1e-6)
    controller.step(q, 1.0, people=[([0.0, 0.0, np.nan], [0.0, 0.0, 1.0], 0.1)], age=0.1)
    command = controller.step(q, 1.0, people=[], age=0.5)  # older than the last
    assert command.reasons[0] == "frame of bodies refused"
    with pytest.raises(InvalidInputError, match="no Separation is among the limits"):
        tracking().step(q, 0.0, people=[])
