"""Names of limits: of each bound the kind, found by its own equation; one name for all readers."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_kinematics import PAPER_Q0
from helpers_simulation import paper_robot, paper_start
from iiwa_dnn import (
    AccelerationLimits,
    CollisionAvoidance,
    Controller,
    DoubleIndicator,
    HalfSpace,
    JerkLimits,
    Target,
    simulate,
)
from iiwa_dnn.naming import KINDS
from iiwa_dnn.references import Still, Waypoints
from iiwa_dnn.results.failures import failures
from iiwa_dnn.results.metrics import compute_metrics

A = 4.0
J = 200.0
DT = 1e-3
SIDEWAYS = np.array([0.0, 0.5, 0.0])


def controller(*limits: object, **options: object) -> Controller:
    scheme = DoubleIndicator(orientation="none", extra_limits=limits)  # type: ignore[arg-type]
    return Controller(paper_robot(), scheme, dt=DT, **options)  # type: ignore[arg-type]


def far() -> Target:
    start = paper_start()
    return Target(start.position + SIDEWAYS, start.rotation)


@pytest.mark.filterwarnings("ignore:a gain of 10.2")  # nothing is closed in a loop here
@pytest.mark.parametrize("limits", [(A, None), (None, J), (A, J)], ids=["A", "J", "A and J"])
def test_a_bound_has_the_kind_of_the_limit_that_its_command_reaches(
    limits: tuple[float | None, float | None],
) -> None:
    """Each bound in the way, beside the rates of the command that lies at it."""
    parts = [kind(limit) for kind, limit in zip(PARTS, limits, strict=True) if limit]
    controlled = controller(*parts)
    q = np.array(PAPER_Q0)
    commands = [np.zeros(7), np.zeros(7)]
    seen = set()
    for k in range(400):
        command = controlled.step(q, k * DT, far())
        commands.append(command.dq.copy())
        rates = np.abs(
            [
                command.dq / controlled.robot.dq_max,
                (commands[-1] - commands[-2]) / (DT * (limits[0] or np.inf)),
                np.diff(commands[-3:], 2, axis=0)[0] / (DT**2 * (limits[1] or np.inf)),
            ]
        )
        names = repr(command)
        for joint in np.flatnonzero(command.sides):
            bound = command.bounds[int(command.sides[joint] > 0), joint]
            if abs(command.dq[joint] - bound) > 1e-9:
                continue
            word = names.split(f"joint {joint + 1} ")[1].split()[1]
            assert word != "position", (k, joint, names)  # all joints are far from theirs
            seen.add(word)
            reached = rates[KINDS.index(word) - 1, joint]
            # The way towards the velocity limit ends before it where the jerk is limited.
            assert reached > 1.0 - 1e-6 or (word == "velocity" and limits[1]), (k, joint, names)
        q = q + DT * command.dq
    assert seen >= {kind for kind, limit in zip(KINDS[2:], limits, strict=True) if limit}


PARTS = (AccelerationLimits, JerkLimits)


def test_at_a_position_limit_it_is_that_ones() -> None:
    q = np.array(PAPER_Q0)
    upper = q.copy()
    upper += 3e-5
    robot = paper_robot().with_limits(upper=upper)
    scheme = DoubleIndicator(orientation="none", extra_limits=(AccelerationLimits(A),))
    command = Controller(robot, scheme, dt=DT).step(q, 0.0, far())
    assert "upper position limit" in repr(command)


def test_command_and_report_say_the_same_row() -> None:
    start = paper_start()
    wall = HalfSpace([0.0, -1.0, 0.0], float(-start.position[1] - 0.12))
    avoidance = CollisionAvoidance([wall], distance=0.02, self_collision=False)
    scheme = DoubleIndicator(orientation="none", extra_limits=(avoidance,))
    row = "of CollisionAvoidance (iiwa7_link_7 and HalfSpace 1)"
    command = Controller(paper_robot(), scheme, dt=DT).step(PAPER_Q0, 0.0, far())
    held = Still().anchored(far())
    with pytest.warns(UserWarning, match="0.5 m"):
        record = simulate(paper_robot(), scheme, held, PAPER_Q0, dt=DT, duration=DT)
    assert row in repr(command)
    assert row in " ".join(failures(record))


def test_a_record_tells_the_kinds_of_active_bounds_too() -> None:
    start = paper_start()
    path = Waypoints([0.0, 0.4], [[0.0, 0.0, 0.0], 0.3 * SIDEWAYS]).anchored(start)
    scheme = DoubleIndicator(orientation="none", extra_limits=(AccelerationLimits(A),))
    record = simulate(paper_robot(), scheme, path, PAPER_Q0, dt=DT, duration=0.2)
    incidents = compute_metrics(record)["incidents"]
    said = {limit["limit"] for limit in incidents["blocking"] + incidents["active"]}
    assert said == {"acceleration"}
