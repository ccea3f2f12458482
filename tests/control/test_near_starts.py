"""Pairs that begin nearer than they have to be, or that no joint moves, hold no arm."""

import copy
import pickle
from typing import Any

import numpy as np
import pytest

import iiwa_dnn as d
from helpers_simulation import driven
from iiwa_dnn.schemes.collisions import CLEARANCE
from iiwa_dnn.step.policies import ProgramKind
from judge_distances import SLACK, Judge

ROBOT = d.load_robot("iiwa7").with_limits(acceleration=10.0)
START = d.Configuration(ROBOT, ROBOT.start_posture())
LEAST = 0.02
DT = 5e-3
AWAY = np.array([0.4, 0.0, 0.0])

pytestmark = pytest.mark.filterwarnings("ignore")


def judged(robot: d.Robot, avoidance: d.CollisionAvoidance, path: np.ndarray) -> np.ndarray:
    """Distances of all pairs by coal [m], (k, pairs)."""
    judge = Judge(robot, avoidance)
    return np.array([judge.distances(q) for q in path])


def beside(nearer: float, **options: Any) -> tuple[d.CollisionAvoidance, d.Scheme]:
    """A ball that the hand begins so much nearer to than `LEAST`, and a scheme beside it."""
    off = d.CollisionAvoidance([d.Sphere(START.position + AWAY, 0.1)], self_collision=False)
    radius = 0.1 + off.scene(ROBOT).nearest(START.q[None], np.zeros(1))[0][0] - LEAST + nearer
    ball = d.Sphere(START.position + AWAY, radius)
    avoidance = d.CollisionAvoidance([ball], self_collision=False, distance=LEAST, **options)
    return avoidance, d.DoubleIndicator(
        orientation="none", extra_limits=(d.AccelerationLimits(), avoidance)
    )


def at(x: float, y: float = 0.0) -> d.Target:
    return d.Target(START.position + [x, y, 0.0], START.rotation)


@pytest.mark.parametrize("name", ["ur3", "ur5", "ur10", "iiwa7", "panda", "xarm7", "z1", "kinova"])
def test_an_arm_on_a_table_moves(name: str) -> None:
    # A pair that no joint moves forbade every motion of a UR5: its base stands in the table.
    robot = d.load_robot(name)
    table = d.HalfSpace([0.0, 0.0, 1.0], 0.0)
    avoidance = d.CollisionAvoidance([table], self_collision=False, distance=0.01)
    for request in (0.3, -0.3):
        shield = d.Shield(robot, 0.01, [table], 0.01)
        path = [robot.start_posture()]
        for _ in range(100):
            path.append(path[-1] + 0.01 * shield.step(path[-1], np.full(robot.dof, request)).dq)
        assert np.ptp(path, axis=0).max() > 0.1
        found = judged(robot, avoidance, np.array(path))
        assert (found >= np.minimum(found[0], 0.01) - SLACK).all()


@pytest.mark.parametrize("name", ["ur5", "iiwa7", "panda"])
def test_pairs_that_no_joint_moves_are_left_out_and_named(name: str) -> None:
    """By coal, over random postures: their distance is the same in all of them."""
    robot = d.load_robot(name)
    table = d.HalfSpace([0.0, 0.0, 1.0], -0.2)
    avoidance = d.CollisionAvoidance([table], self_collision=False)
    apart = judged(robot, avoidance, robot.draw(np.random.default_rng(3), 200))
    still = int((np.ptp(apart, axis=0) < 1e-6).sum())
    named = list(avoidance.overview(robot)["left_out"])
    assert len(named) == still > 0
    assert {(first, why) for first, _, why in named} == {("HalfSpace 1", "no joint moves it")}
    assert not {pair[:2] for pair in named} & set(avoidance.scene(robot).pairs)


def test_pairs_are_left_out_by_name() -> None:
    avoidance, scheme = beside(0.005, may_touch=[("Sphere 1", "iiwa7_link_7")])
    assert ("Sphere 1", "iiwa7_link_7", "may touch") in avoidance.overview(ROBOT)["left_out"]
    path, _ = driven(d.Controller(ROBOT, scheme, dt=DT), START.q, 200, at(0.1))
    assert judged(ROBOT, avoidance, path[-1:]).min() < 0.0
    with pytest.raises(
        d.IiwaDnnError, match="no link or obstacle 'Sphere 2'; did you mean: Sphere 1"
    ):
        beside(0.005, may_touch=[("iiwa7_link_7", "Sphere 2")])[0].scene(ROBOT)
    for wrong in ("iiwa7_link_7", [("iiwa7_link_7",)], [1], 2):
        with pytest.raises(d.InvalidInputError, match="may_touch: must be pairs of names"):
            beside(0.005, may_touch=wrong)


@pytest.mark.parametrize("nearer", [0.005, 0.025])
def test_a_pair_that_begins_nearer_comes_no_nearer_and_then_keeps_its_distance(
    nearer: float,
) -> None:
    avoidance, scheme = beside(nearer)
    controller = d.Controller(ROBOT, scheme, dt=DT)
    _, first = driven(controller, START.q, 1, at(0.0))
    own = controller._motion.least.copy()
    pressed, _ = driven(controller, START.q, 100, at(0.2))
    begun = judged(ROBOT, avoidance, pressed[:1]).min()
    assert own.min() == pytest.approx(LEAST - nearer - CLEARANCE, abs=2e-6)
    assert sum(words.endswith(f"keep {own.min():.3g} m") for words in first[0].active_limits) == 1
    assert judged(ROBOT, avoidance, pressed).min() > begun - SLACK
    left, _ = driven(controller, pressed[-1], 300, at(-0.2))
    assert judged(ROBOT, avoidance, left[-1:]).min() > LEAST
    again, last = driven(controller, left[-1], 400, at(0.2, 0.1))
    assert (controller._motion.least[: len(avoidance.scene(ROBOT).pairs)] == LEAST).all()
    assert judged(ROBOT, avoidance, again).min() > LEAST - SLACK
    assert not any("nearer" in words for words in last[-1].active_limits)


def test_fast_requests_beside_a_pair_that_began_nearer_move_the_arm() -> None:
    # There is a micrometre for a motion's curve: an eighth of the way was still too fast.
    robot = d.load_robot("panda").with_limits(acceleration=np.inf, jerk=np.inf)
    box = d.Box([0.42902, -0.05781, 0.52525], [0.08, 0.1, 0.06])
    shield = d.Shield(robot, 0.01, [box])
    q0 = robot.start_posture()
    q = q0
    for _ in range(50):
        q = q + 0.01 * shield.step(q, [-0.14, 0.65, 0.5, -1.36, -0.94, -0.09, -0.21]).dq
    assert np.abs(q - q0).max() > 0.01


def test_a_pair_that_begins_nearer_is_not_asked_to_retreat() -> None:
    # It went away at 20 times what was left of the distance, whatever the task asked for.
    _, scheme = beside(0.005)
    path, commands = driven(d.Controller(ROBOT, scheme, dt=DT), START.q, 50, at(0.0))
    assert np.abs(path - START.q).max() < 1e-9
    assert {command.kind for command in commands} == {ProgramKind.NOMINAL}
    assert all((command.qp.h >= 0.0).all() for command in commands)


@pytest.mark.parametrize("copied", [copy.copy, lambda each: pickle.loads(pickle.dumps(each))])
def test_what_pairs_keep_is_copied_and_begins_anew_after_a_reset(copied: Any) -> None:
    _, scheme = beside(0.005)
    controller = d.Controller(ROBOT, scheme, dt=DT)
    path, _ = driven(controller, START.q, 60, at(-0.003))
    own = controller._motion.least.min()
    twin = copied(controller)
    twin.step(path[-1], 0.3, at(0.0))
    assert twin._motion.least.min() == own
    twin.reset()
    twin.step(path[-1], 0.3, at(0.0))
    assert own + 1e-3 < twin._motion.least.min() < LEAST


def test_a_command_that_was_computed_counts_as_the_start_of_what_is_sent() -> None:
    _, scheme = beside(0.005)
    controller, other = (d.Controller(ROBOT, scheme, dt=DT) for _ in range(2))
    frames = {ROBOT.tip: at(0.1)}
    q = START.q
    for k in range(30):
        command = controller.compute(q, k * DT, frames)
        controller.send(command.dq)
        other.step(q, k * DT, frames)
        own = [each._motion.least.min() for each in (controller, other)]
        assert own[0] == own[1]
        q = command.next_q


def test_a_link_that_a_ball_sits_in_is_stopped_and_says_why() -> None:
    """The ball's middle on a link's axis: no direction separates them."""
    capsules = d.robot.collision.collision_model(ROBOT).capsules
    link, capsule = next(each for each in capsules if "link_7" in each.link)
    frame = START.frame(link)
    middle = frame.position + frame.rotation @ np.mean([capsule.a, capsule.b], axis=0)
    avoidance = d.CollisionAvoidance([d.Sphere(middle, 0.05)], self_collision=False)
    limits = (d.AccelerationLimits(), avoidance)
    scheme = d.DoubleIndicator(orientation="none", extra_limits=limits)
    path, commands = driven(d.Controller(ROBOT, scheme, dt=DT), START.q, 20, at(0.1))
    np.testing.assert_array_equal(path, np.tile(START.q, (21, 1)))
    for command in commands:
        assert command.kind is ProgramKind.STOPPED
        assert (
            "iiwa7_link_7 and Sphere 1 meet, and no direction separates them"
            in command.active_limits
        )


def test_an_obstacle_that_a_new_scheme_has_elsewhere_pushes_the_arm_back() -> None:
    """It has moved: only where a loop begins does a pair keep a distance of its own."""
    robot = d.load_robot("iiwa7")
    q = np.array(robot.start_posture())
    start = d.Configuration(robot, q)
    at = start.frame("iiwa7_link_4").position + [0.3, 0.0, 0.0]

    def scheme(center: np.ndarray) -> d.Scheme:
        ball = d.CollisionAvoidance([d.Sphere(center, 0.05)], self_collision=False, distance=0.03)
        return d.DoubleIndicator(home=tuple(q), extra_limits=(ball,))

    made = d.Controller(robot, scheme(at), d.MovingTarget(start), dt=5e-3)
    path = [q]
    for k in range(400):
        if k % 20 == 0 and 0 < k < 240:
            at = at - [0.02, 0.0, 0.0]
            made.scheme = scheme(at)
        path.append(made.step(path[-1], 5e-3 * k).next_q)
    scene = made.scheme.limits[-1].scene(robot)
    left, _ = scene.nearest(np.array(path[-1:]), np.zeros(1))
    assert left[0] > 0.03 - 1e-6
    begun, _ = scene.nearest(np.array(path[:1]), np.zeros(1))
    assert begun[0] < 0.0


def test_an_obstacle_stated_on_the_first_axis_is_kept_away_from_wherever_it_is_placed() -> None:
    """There no joint moves a link that turns about the axis; its pair is watched all the same."""
    robot = d.load_robot("fr3").with_limits(jerk=500.0)
    start = np.array([-2.2298, -0.4013, -0.1437, -1.9628, -2.0947, 2.1525, -0.2847])
    place, radius = np.array([-0.203, -0.028, 0.441]), 0.1058
    judge = Judge(robot, d.CollisionAvoidance([d.Sphere(place, radius)]))
    shield = d.Shield(robot, DT, [d.Sphere([0.0, 0.0, 0.0], radius)])
    path = [start]
    for _ in range(400):
        path.append(shield.step(path[-1], 0.5 * np.eye(7)[0], obstacles=[place]).next_q)
    away = [judge.distance(q, 0.0) for q in path]
    assert away[0] > 0.03
    assert LEAST - SLACK < min(away) < LEAST + 1e-3
