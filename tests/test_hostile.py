"""The judges of tests/hostile.py: what a few runs show, and what they find in one that is wrong."""

import numpy as np
import pytest

pytest.importorskip("coal")

import hostile
import iiwa_dnn
from iiwa_dnn import HalfSpace, Sphere
from judge_distances import Judge
from judge_limits import breaches

WHOLE = iiwa_dnn.load_robot("iiwa7").with_limits(jerk=1000.0)
START = WHOLE.start_posture()
ROBOT = WHOLE.with_limits(lower=START - 0.7, upper=START + 0.7)
FAR = iiwa_dnn.CollisionAvoidance([Sphere([0.8, 0.8, 0.1], 0.1)])
CASE = hostile.Case(ROBOT, FAR, 5e-3, 1200, False, "so3", "slow")


@pytest.mark.parametrize("driven", [hostile.controller, hostile.shield])
@pytest.mark.parametrize("seed", [5, 16, 24, 29, 49, 54])
def test_hostile_motion_breaks_no_promise(driven, seed: int) -> None:
    """Still and moving obstacles, no rate limited, the acceleration, and the jerk too."""
    case = hostile.draw_case(seed)._replace(steps=1500)
    found = hostile.judged(case, driven(case, seed))
    assert found.limits == []
    assert found.distances == 0
    # The package's own distances are those of coal.
    picked = found.path[::20]
    clock = case.dt * np.arange(len(found.path))[::20]
    judge = Judge(case.robot, case.avoidance)
    coals = [judge.distance(q, t) for q, t in zip(picked, clock, strict=True)]
    own, _ = case.avoidance.scene(case.robot).nearest(picked, clock)
    np.testing.assert_allclose(own, coals, atol=2e-6)
    assert np.ptp(found.path, axis=0).max() > 0.05


@pytest.mark.parametrize(
    ("quantity", "looser"),
    [
        ("position", {"lower": ROBOT.q_lower - 0.01, "upper": ROBOT.q_upper + 0.01}),
        ("velocity", {"velocity": 1.01 * ROBOT.dq_max}),
        ("acceleration", {"acceleration": 1.01 * ROBOT.ddq_max}),
        ("jerk", {"jerk": 1010.0}),
    ],
)
def test_a_limit_that_is_looser_by_a_hundredth_is_found(quantity: str, looser: dict) -> None:
    case = CASE._replace(robot=ROBOT.with_limits(**looser))
    path = hostile.judged(case, hostile.shield(case, 6)).path
    found = breaches(path, case.dt, *ROBOT.limits)
    assert quantity in [breach.quantity for breach in found]


def test_an_obstacle_that_is_not_kept_away_from_is_found() -> None:
    at = CASE.start.position
    ball = iiwa_dnn.CollisionAvoidance([Sphere(at + [0.0, 0.2, 0.1], 0.05)])
    case = CASE._replace(avoidance=ball)
    for driven in (hostile.controller, hostile.shield):
        blind = driven(case._replace(avoidance=iiwa_dnn.CollisionAvoidance([])), 3)
        requests = driven(case, 3).requests
        assert hostile.judged(case, blind._replace(requests=requests)).distances > 0


def test_an_arm_between_walls_is_in_a_trap_and_one_beside_a_wall_is_not() -> None:
    at = CASE.start.position[2]
    free = iiwa_dnn.CollisionAvoidance([HalfSpace([0.0, 0.0, 1.0], at - 0.4)])
    path = START + np.linspace(0.0, 1.0, 50)[:, np.newaxis] * [0.3, 0.1, 0.0, 0.0, 0.0, 0.0, 0.0]
    assert hostile.name_stop(CASE._replace(avoidance=free), path) == "minima"
    frozen = CASE._replace(robot=ROBOT.with_limits(velocity=1e-4), dt=0.02)
    assert hostile.name_stop(frozen, path) == "traps"
