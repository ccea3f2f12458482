"""Names of limits: of each bound the kind, found by its own equation; one name for all readers."""

from typing import Any

import numpy as np
import pytest

import iiwa_dnn as d
from helpers_kinematics import PAPER_Q0, Array
from helpers_simulation import driven, paper_robot, paper_start, run
from iiwa_dnn.naming import KINDS, LimitKind
from iiwa_dnn.schemes.periods import constant_periods
from iiwa_dnn.schemes.profiles import Rates
from iiwa_dnn.schemes.viability import joint_bounds

A = 4.0
J = 200.0
DT = 1e-3
SIDEWAYS = np.array([0.0, 0.5, 0.0])
FAR = d.Target(paper_start().position + SIDEWAYS, paper_start().rotation)


def scheme(*limits: Any) -> d.DoubleIndicator:
    return d.DoubleIndicator(orientation="none", extra_limits=limits)


@pytest.mark.filterwarnings("ignore:a gain of 10.2")  # nothing is closed in a loop here
@pytest.mark.parametrize("limits", [(A, None), (None, J), (A, J)], ids=["A", "J", "A and J"])
def test_a_bound_has_the_kind_of_the_limit_that_its_command_reaches(limits) -> None:
    """Each limiting bound, beside the rates of the command that lies at it."""
    kinds = zip((d.AccelerationLimits, d.JerkLimits), limits, strict=True)
    robot = paper_robot()
    controlled = d.Controller(
        robot, scheme(*(kind(limit) for kind, limit in kinds if limit)), dt=DT
    )
    seen = set()
    _, commands = driven(controlled, PAPER_Q0, 400, FAR)
    for k, command in enumerate(commands):
        last, before = command.log.last, command.log.before
        rates = np.abs(
            [
                command.dq / robot.dq_max,
                (command.dq - last) / (DT * (limits[0] or np.inf)),
                (command.dq - 2.0 * last + before) / (DT**2 * (limits[1] or np.inf)),
            ]
        )
        names = repr(command)
        for joint in np.flatnonzero(command.log.limiting[: command.dq.size]):
            bound = command.bounds[int(command.log.limiting[joint] > 0), joint]
            if abs(command.dq[joint] - bound) > 1e-9:
                continue
            word = names.split(f"joint {joint + 1} ")[1].split()[1]
            assert word != "position", (k, joint, names)  # all joints are far from theirs
            seen.add(word)
            reached = rates[KINDS.index(word) - 1, joint]
            # The way towards the velocity limit ends before it where the jerk is limited.
            assert reached > 1.0 - 1e-6 or (word == "velocity" and limits[1]), (k, joint, names)
    assert seen >= {kind for kind, limit in zip(KINDS[2:4], limits, strict=True) if limit}


def rates(velocity: float, acceleration: float, jerk: float) -> Rates:
    return Rates(velocity, acceleration, jerk, acceleration, np.inf, 0.0)


@pytest.mark.parametrize("jerk", [J, np.inf])
def test_a_bound_moves_outwards_if_the_limit_that_it_names_is_wider(jerk: float) -> None:
    """Of random states, whose named limit alone becomes wider by a thousandth."""
    random = np.random.default_rng(3)
    periods = constant_periods(DT)
    seen = set()
    for _ in range(2000):
        last = random.uniform(-1.0, 1.0)
        before = last - random.uniform(-1.0, 1.0) * DT * A
        margins = np.where(random.random(2) < 0.4, random.uniform(0.1, 0.6, 2), 2.0)
        own = joint_bounds(last, before, *margins, rates(1.0, A, jerk), periods)
        if own[0] == own[1]:
            continue
        for side, kind in enumerate(own[2:]):
            position, *wider = [1.001 if other == kind else 1.0 for other in list(LimitKind)[:4]]
            limits = rates(*np.array([1.0, A, jerk]) * wider)
            other = joint_bounds(last, before, *(margins * position), limits, periods)
            moved = other[side] - own[side]
            assert moved > 0.0 if side else moved < 0.0, (last, before, margins, kind, moved)
            seen.add(kind)
    assert seen == {1, 2, 3, 4} if jerk < np.inf else {1, 2, 3}


class Near(d.Limit):
    """A bound of joint 1 that is the robot's own velocity limit but for rounding."""

    def bounds(self, step: d.Step) -> tuple[Array, Array]:
        lower = np.full(7, -np.inf)
        lower[0] = -(1.0 - 1e-12) * step.robot.dq_max[0]
        return lower, -lower


def test_a_limit_of_ones_own_is_named_by_its_class() -> None:
    far = d.Target(paper_start().position + 4.0 * SIDEWAYS, paper_start().rotation)
    controller = d.Controller(paper_robot(), scheme(Near()), dt=0.1, policy="relax")
    command = controller.step(PAPER_Q0, 0.0, far)
    assert command.active_limits[0] == "joint 1 upper bound of Near"
    assert command.log.upper_kind[0] == LimitKind.OTHER
    assert np.isin(command.log.upper_kind[1:], [LimitKind.POSITION, LimitKind.VELOCITY]).all()


def test_a_bound_that_no_limit_writes_has_no_kind(monkeypatch) -> None:
    """Whatever stood in the memory of the log."""
    monkeypatch.setattr(np, "empty", lambda *shape, **type: np.full(*shape, np.nan, **type))
    free = d.Scheme([d.KineticEnergy()], [d.PositionTask()], limits=[])
    command = d.Controller(paper_robot(), free, dt=DT).step(PAPER_Q0, 0.0, FAR)
    np.testing.assert_array_equal([command.log.lower_kind, command.log.upper_kind], 0.0)


def test_at_a_position_limit_it_is_that_ones() -> None:
    robot = paper_robot().with_limits(upper=np.array(PAPER_Q0) + 3e-5)
    command = d.Controller(robot, scheme(d.AccelerationLimits(A)), dt=DT).step(PAPER_Q0, 0.0, FAR)
    assert command.active_limits[0].endswith(" upper position limit")


def test_command_and_report_say_the_same_row() -> None:
    wall = d.HalfSpace([0.0, -1.0, 0.0], float(-paper_start().position[1] - 0.12))
    avoiding = scheme(d.CollisionAvoidance([wall], distance=0.02, self_collision=False))
    row = "of CollisionAvoidance (iiwa7_link_7 and HalfSpace 1)"
    command = d.Controller(paper_robot(), avoiding, dt=DT).step(PAPER_Q0, 0.0, FAR)
    with pytest.warns(UserWarning, match="0.5 m"):
        record = run(avoiding, d.FixedPose().anchored(FAR), duration=DT)
    assert row in repr(command)
    assert row in " ".join(d.failures(record))


def test_a_record_tells_the_kinds_of_active_bounds_too() -> None:
    path = d.Waypoints([0.0, 0.4], [[0.0, 0.0, 0.0], 0.3 * SIDEWAYS]).anchored(paper_start())
    record = run(scheme(d.AccelerationLimits(A)), path, duration=0.2)
    incidents = d.compute_metrics(record)["incidents"]
    said = {limit["limit"] for limit in incidents["limiting"] + incidents["active"]}
    assert said == {"acceleration"}


def test_of_more_pairs_than_rows_each_limit_has_the_names_of_two_bodies() -> None:
    robot = paper_robot()
    sphere = d.Sphere(center=paper_start().position + 0.4 * SIDEWAYS, radius=0.05)
    parts = [d.CollisionAvoidance([sphere], nearest=nearest) for nearest in (4, 200)]
    heard = []
    for part in parts:
        controlled = d.Controller(robot, scheme(d.AccelerationLimits(A), part), dt=DT)
        _, commands = driven(controlled, PAPER_Q0, 600, FAR)
        heard.append([command.active_limits for command in commands])
    few, all_ = ({name for names in each for name in names if "Avoid" in name} for each in heard)
    assert few == {f"CollisionAvoidance ({name.split('(')[1]}" for name in all_} != set()
    assert all(" and " in name for name in few)
    for names in (names for each in heard for names in each):
        is_rate = ["acceleration" in name for name in names]
        assert is_rate == sorted(is_rate)
    assert any("Avoid" in names[0] and "acceleration" in names[-1] for names in heard[0] if names)
