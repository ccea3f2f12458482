"""A step that is refused is the next command of a motion to rest, with its reason, never 0."""

from typing import Any

import numpy as np
import pytest

import iiwa_dnn as d
from iiwa_dnn.compiling.trigonometry import LARGEST
from iiwa_dnn.control.requests import REASONS
from iiwa_dnn.step.arms import step_arm
from iiwa_dnn.step.memory import ArmInput, motion_of, place_arm
from iiwa_dnn.step.requests import Reason, Request
from judge_limits import breaches

DT = 2e-3
ROBOT = d.load_robot("iiwa7").with_limits(acceleration=10.0, jerk=500.0)
START = np.array(ROBOT.start_posture())
BALL = d.Sphere([0.36, 0.16, 0.64], 0.05)


class Arm:
    """An arm that follows the commands of `step_arm`, as it does in C."""

    def __init__(self, **settings: Any) -> None:
        layout = d.Shield(ROBOT, DT, [BALL], **settings).layout(ROBOT.tip)
        self.plan = layout.plan
        self.memory = layout.memory.copy()
        self.state = layout.state(self.memory)
        self.path = [START]
        self.motion = motion_of(self.plan, self.state)

    def step(self, **wrong: Any) -> int:
        own: dict[str, Any] = {
            "q": self.path[-1],
            "kind": Request.VELOCITY,
            "request": np.full(7, 0.5),
            "dt": 0.0,
            "elapsed": 0.0,
            "t": 0.0,
        }
        reason = step_arm(self.plan, self.memory, ArmInput(**own | wrong))
        self.path.append(self.path[-1] + self.state.period * self.motion.last)
        return int(reason)


PERIODS: list[dict[str, Any]] = [
    {"dt": np.nan},
    {"dt": np.inf},
    {"dt": -DT},
    {"elapsed": np.nan},
    {"elapsed": -np.inf},
    {"dt": DT, "elapsed": DT},
]
OF_CONSTANT: list[dict[str, Any]] = [{"elapsed": DT}, {"dt": 1.5 * DT}]
OTHERS: list[tuple[Reason, dict[str, Any]]] = [
    (Reason.UNKNOWN_KIND, {"kind": 7}),
    (Reason.UNKNOWN_KIND, {"kind": -3}),
    (Reason.NOT_FINITE, {"request": np.full(7, np.inf)}),
    (Reason.Q_NOT_FINITE, {"q": np.full(7, np.nan)}),
    (Reason.Q_NOT_FINITE, {"q": np.full(7, 2.0 * LARGEST)}),
]
REFUSED = [(Reason.PERIOD_REFUSED, own) for own in PERIODS + OF_CONSTANT] + OTHERS


@pytest.mark.parametrize(("reason", "wrong"), REFUSED)
def test_a_refused_step_brakes_within_the_limits_and_names_its_reason(
    reason: Reason, wrong: dict[str, Any]
) -> None:
    """It was a jump to 0, 50 times the acceleration limit, or a request by another name."""
    arm = Arm()
    random = np.random.default_rng(0)
    for k in range(400):
        speed = np.abs(arm.motion.last).max()
        is_wrong = k > 100 and random.random() < 0.5
        found = arm.step(**wrong) if is_wrong else arm.step()
        if is_wrong:
            assert found == reason
            assert REASONS[reason] in d.control.arm_layout.reasons_of(arm.state)
        if k == 101:
            assert 0.9 * speed < np.abs(arm.motion.last).max()
    for _ in range(200):
        arm.step(**wrong)
    assert np.abs(arm.motion.last).max() < 1e-9
    path = np.array(arm.path)
    assert breaches(path, DT, *ROBOT.limits) == []
    assert np.ptp(path, axis=0).min() > 0.05
    for _ in range(100):
        arm.step()
    assert np.abs(arm.motion.last).max() > 0.1  # it goes on


@pytest.mark.parametrize("wrong", PERIODS)
def test_an_arm_whose_periods_vary_takes_a_refused_one_as_not_stated(wrong: dict[str, Any]) -> None:
    twin, arm = (Arm(longest_period=3.0 * DT) for _ in range(2))
    for each in (arm, twin):
        for _ in range(100):
            each.step(dt=DT)
    for _ in range(20):
        assert arm.step(**wrong) == Reason.PERIOD_REFUSED
        twin.step(request=np.zeros(7))
        np.testing.assert_allclose(arm.motion.last, twin.motion.last, atol=1e-12)


def test_an_obstacle_that_is_nowhere_brakes_the_arm_until_it_is_somewhere() -> None:
    arm = Arm()
    for _ in range(50):
        arm.step()
    place = np.array([[0.36, 0.16, 0.64]])
    for centers in (np.full((1, 3), np.nan), place):
        place_arm(arm.plan, arm.memory, centers)
        reasons = [arm.step() for _ in range(100)]
        assert set(reasons) == {Reason.NONE if centers is place else Reason.PLACE_NOT_FINITE}
        assert (np.abs(arm.motion.last).max() > 0.1) == (centers is place)
        assert np.isfinite(arm.motion.least).all()
    assert breaches(np.array(arm.path), DT, *ROBOT.limits) == []


def test_an_arm_beyond_the_range_of_sines_brakes_within_its_rates() -> None:
    arm = Arm()
    for _ in range(60):
        arm.step()
    arm.state.positions[:] += 2.0 * LARGEST
    found = [arm.motion.last.copy()]
    for _ in range(300):
        assert arm.step(q=arm.state.positions.copy()) == Reason.Q_NOT_FINITE
        found.append(arm.motion.last.copy())
    rates = np.diff(found, axis=0) / DT
    assert np.abs(rates).max() <= 10.0 + 1e-6
    assert np.abs(np.diff(rates, axis=0)).max() / DT <= 500.0 + 1e-3
    assert np.abs(found[1]).min() > 0.0 == np.abs(found[-1]).max()


@pytest.mark.parametrize("name", ["plain", "obstacles"])
def test_a_shield_without_positions_brakes_as_an_arm_of_shields_does(name: str) -> None:
    settings: dict[str, Any] = {"obstacles": [BALL]} if name == "obstacles" else {}
    shield = d.Shield(ROBOT, DT, **settings)
    shields = d.Shields(ROBOT, 1, dt=DT, **settings)
    with pytest.raises(d.InvalidInputError, match="q: is needed at the first step"):
        shield.step(None)
    q = START
    for k in range(200):
        blind = 80 < k < 140
        one = shield.step(None if blind else q, np.full(7, 0.5))
        measured = np.full((1, 7), np.nan) if blind else q[None]
        many = shields.step(measured, np.full((1, 7), 0.5))
        np.testing.assert_allclose(many.dq[0], one.dq, atol=1e-9)
        assert ("q not finite" in one.reasons) == blind
        q = one.next_q
    assert np.isnan(d.Shields(ROBOT, 1, dt=DT).step(np.full((1, 7), np.nan)).next_q).all()


class Blind(d.Limit):
    """A limit in numpy whose sensor fails."""

    fails = False

    def bounds(self, step: Any) -> tuple[np.ndarray, np.ndarray]:
        if self.fails:
            raise RuntimeError("no sensor")
        return np.full(7, -9.0), np.full(7, 9.0)


def test_without_positions_an_arm_comes_to_rest_though_a_limit_in_numpy_fails() -> None:
    limit = Blind()
    shield = d.Shield(ROBOT, DT)
    shield.limits += (limit,)
    path = [START, START]
    for _ in range(100):
        path.append(shield.step(path[-1], np.ones(7)).next_q)
    object.__setattr__(limit, "fails", True)
    with pytest.raises(RuntimeError, match="no sensor"):
        shield.step(path[-1], np.ones(7))
    for _ in range(600):
        path.append(path[-1] + DT * shield.step(None).dq)
    assert not np.ptp(path[-2:], axis=0).any()
    assert breaches(np.array(path), DT, *ROBOT.limits) == []
