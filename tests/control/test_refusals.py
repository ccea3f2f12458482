"""Arguments that make no sense are named in one line, and change nothing."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import iiwa_dnn as d
from helpers_kinematics import PAPER_Q0
from helpers_simulation import heart, paper_robot, paper_start
from iiwa_dnn.simulation import MovingAverage
from iiwa_dnn.simulation.estimation import JointEstimator, NoiseModel

POSE = d.Target(paper_start().position, paper_start().rotation)


def controller(**options: Any) -> d.Controller:
    return d.Controller(paper_robot(), d.DoubleIndicator(), heart(), **options)


OF_THREE_JOINTS = d.DoubleIndicator(extra_limits=(d.AccelerationLimits([1, 2, 3]),))

REFUSED: list[tuple[str, Callable[[], object]]] = [
    ("mode: must be one of converged, continuous, not", lambda: controller(mode="discrete")),
    ("policy", lambda: controller(policy="raise")),
    ("scheme", lambda: d.Controller(paper_robot(), object())),  # type: ignore[arg-type]
    ("dt", lambda: controller(dt=0.0)),
    ("reference", lambda: d.Controller(paper_robot(), d.DoubleIndicator()).step(PAPER_Q0, 0.0)),
    ("dt", lambda: controller().step(PAPER_Q0, 0.0, dt=0.0)),
    ("measurement", lambda: NoiseModel(measurement=0.0)),
    ("velocity", lambda: NoiseModel(velocity=-1.0)),
    ("bias_walk", lambda: NoiseModel(bias_walk=np.nan)),
    ("bias", lambda: NoiseModel(bias=np.inf)),
    ("delay_periods", lambda: NoiseModel(delay_periods=-1)),
    ("dt", lambda: JointEstimator(NoiseModel(), 0.0)),
    ("filter_window", lambda: MovingAverage(0)),
    ("filter_window", lambda: MovingAverage(2.5)),  # type: ignore[arg-type]
    ("dt", lambda: d.Shield(paper_robot(), dt=0.0)),
    ("dt", lambda: d.Shield(paper_robot()).step(PAPER_Q0, dt="1 ms")),
    ("timeout", lambda: d.Shield(paper_robot(), timeout=-1.0)),
    ("distance", lambda: d.Shield(paper_robot(), distance=-0.1)),
    ("distance", lambda: d.Shield(paper_robot(), 1e-3, d.CollisionAvoidance(), distance=0.05)),
    ("robot", lambda: d.Shield("64")),  # type: ignore[arg-type]
    ("robot", lambda: d.Shields(64)),  # type: ignore[arg-type]
    ("robot", lambda: d.Shields(d.Shield(paper_robot()), 2, dt=1e-3)),
    ("count", lambda: d.Shields(paper_robot(), 0)),
    ("tracking_error", lambda: d.Shield(paper_robot(), tracking_error=np.nan)),
    ("starts", lambda: d.solve_pose(paper_robot(), POSE, starts=0)),
    ("target", lambda: d.solve_pose(paper_robot(), np.eye(4))),  # type: ignore[arg-type]
    ("q0", lambda: d.solve_pose(paper_robot(), POSE, [0.0, 1.0])),
    ("orientation", lambda: d.solve_pose(paper_robot(), POSE, orientation="block")),  # type: ignore[arg-type]
    ("acceleration: must have shape", lambda: d.Controller(paper_robot(), OF_THREE_JOINTS)),
    ("fraction", lambda: controller().send(np.zeros(7), fraction="a")),  # type: ignore[arg-type]
    ("fraction", lambda: controller().send(np.zeros(7), fraction=np.nan)),
]


@pytest.mark.parametrize(("name", "call"), REFUSED, ids=[name for name, _ in REFUSED])
def test_an_argument_that_makes_no_sense_is_named(name: str, call: Callable[[], object]) -> None:
    with pytest.raises(d.InvalidInputError, match=rf"^{name}\b"):
        call()


def test_a_setting_of_shields_that_is_misspelt_is_named() -> None:
    with pytest.raises(d.NotFoundError, match="no setting of a shield 'timeuot'; did you mean"):
        d.Shields(paper_robot(), 2, timeuot=0.1)


@pytest.mark.parametrize("settings", [{"dt": 0.5}, {"longest_period": 1.5e-3}])
def test_a_warning_names_the_line_that_called(settings: dict[str, Any]) -> None:
    """Those of `Shield.step` named the line `sys:1`."""
    robot = paper_robot()
    loop = controller(policy="stop", **settings)
    shield, warm = (d.Shield(robot, **{"dt": 1e-3} | settings) for _ in range(2))
    calls: list[Callable[[], object]] = [
        lambda: loop.step(PAPER_Q0, 0.0, **elapsed),
        lambda: shield.step(PAPER_Q0, **elapsed),
        lambda: warm.warm_up(PAPER_Q0),
        lambda: d.simulate(robot, d.DoubleIndicator(), heart(), PAPER_Q0, dt=0.5, duration=0.5),
    ]
    elapsed = {} if "dt" in settings else {"elapsed": 2e-3}
    for call in calls[: 2 if elapsed else 4]:
        with pytest.warns(UserWarning, match="period") as caught:
            call()
        assert {each.filename for each in caught} == {__file__}


READINGS: dict[str, Any] = {
    "complex": np.array(PAPER_Q0) + 0j,
    "masked": np.ma.masked_array(PAPER_Q0, mask=[True, False, False, False, False, False, False]),
    "short": np.array(PAPER_Q0)[:6],
    "nan": np.full(7, np.nan),
    "text": ["a"] * 7,
}


@pytest.mark.parametrize("q", READINGS.values(), ids=READINGS.keys())
@pytest.mark.parametrize("begun", [False, True])
def test_joint_positions_that_are_none_are_refused(q: Any, begun: bool) -> None:
    loop = controller()
    if begun:
        loop.step(PAPER_Q0, 0.0)
    with pytest.raises(d.InvalidInputError, match=r"^q\b"):
        loop.step(q, 1e-3)


def test_joint_positions_of_other_types_and_with_gaps_are_the_numbers_that_they_hold() -> None:
    q = np.array(PAPER_Q0, "f4").astype(float)
    expected = controller().step(q, 0.0).dq
    others = [q.astype(kind) for kind in ("f4", ">f8", "g")]
    others += [np.stack([q, q], axis=1)[:, 0], q[::-1].copy()[::-1]]
    for other in others:
        np.testing.assert_array_equal(controller().step(other, 0.0).dq, expected)


def test_a_scheme_that_does_not_fit_changes_nothing() -> None:
    loop = controller()
    before = loop.scheme
    with pytest.raises(d.InvalidInputError, match=r"^acceleration"):
        loop.scheme = OF_THREE_JOINTS
    assert loop.scheme is before


@pytest.mark.parametrize("t", [np.nan, "a", None])
def test_a_time_that_is_no_number_is_refused_and_nothing_is_lost(t: Any) -> None:
    loop = controller()
    for _ in range(2):
        with pytest.raises(d.InvalidInputError, match=r"^t\b"):
            loop.step(PAPER_Q0, t)
        command = loop.step(PAPER_Q0, 0.0)
    expected = controller().step(PAPER_Q0, 0.0).dq
    np.testing.assert_allclose(command.dq, expected, rtol=0, atol=1e-9)
