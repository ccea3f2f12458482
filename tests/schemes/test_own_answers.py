"""Answers of parts of one's own that are none: each is refused, or blamed, by the part's name."""

from typing import Any

import numpy as np
import pytest

from helpers_simulation import run
from iiwa_dnn import (
    CrossCheck,
    InvalidInputError,
    JointLimits,
    KineticEnergy,
    Limit,
    PositionTask,
    Record,
    Scheme,
    Step,
    Task,
    compute_metrics,
    failures,
)
from iiwa_dnn.schemes import Cost

EYE, ZEROS, ROW = np.eye(7), np.zeros(7), np.ones((1, 7))


class OwnCost(Cost):
    def __init__(self, answer: Any) -> None:
        self.answer = answer

    def quadratic(self, step: Step) -> Any:
        return self.answer


class OwnTask(Task):
    rows, tracks = 1, False

    def __init__(self, answer: Any) -> None:
        self.answer = answer

    def equations(self, step: Step) -> Any:
        return self.answer


class OwnRows(Limit):
    rows = 1

    def __init__(self, answer: Any) -> None:
        self.answer = answer

    def inequalities(self, step: Step) -> Any:
        return self.answer


class Rowless(OwnRows):
    """Without `rows` its inequalities would not be asked for, and the limit not be kept."""

    rows = 0


class OwnBounds(Limit):
    def __init__(self, answer: Any) -> None:
        self.answer = answer

    def bounds(self, step: Step) -> Any:
        return self.answer


def beside(part: Any, **options: Any) -> Record:
    """The record of ten steps with one more part."""
    lists: dict[type, list[Any]] = {
        Cost: [KineticEnergy()], Task: [PositionTask()], Limit: [JointLimits()]
    }  # fmt: skip
    for kind, parts in lists.items():
        parts += [part] if isinstance(part, kind) else []
    return run(Scheme(*lists.values()), duration=0.01, check=CrossCheck(("osqp",)), **options)


@pytest.mark.parametrize(
    ("part", "problem"),
    [
        (OwnCost((-EYE, ZEROS)), "P is not convex, its least eigenvalue is -1"),
        (OwnCost((np.triu(np.ones((7, 7))), ZEROS)), "P is not symmetric"),
        (OwnCost((EYE, ZEROS + np.inf)), "q holds an infinite number"),
        (OwnCost((EYE, ZEROS + np.nan)), "q holds NaN"),
        (OwnRows((EYE[:2], ZEROS[:2])), "G has shape (2, 7), not (1, 7)"),
        (Rowless((ROW, [0.0])), "G has shape (1, 7), not (0, 7)"),
        (OwnCost(None), "must return two arrays, P and q, not None"),
        (OwnCost((EYE, ZEROS, 1)), "must return two arrays, P and q"),
        (OwnTask("text"), "must return two arrays, A and b, not 'text'"),
        (OwnTask((ROW, [np.inf])), "b holds an infinite number"),
        (OwnRows((ROW, [-np.inf])), "h holds an infinite number"),
        (OwnRows((ROW * np.inf, [1.0])), "G holds an infinite number"),
        (OwnBounds((ZEROS + np.inf, ZEROS + np.inf)), "lb holds an infinite number"),
        (OwnBounds(3.0), "must return two arrays, lb and ub, not 3.0"),
    ],
)
def test_an_answer_that_is_none_is_refused_by_name(part: Any, problem: str) -> None:
    with pytest.raises(InvalidInputError) as refused:
        beside(part)
    assert str(refused.value).startswith(f"{type(part).__name__}: {problem}")


@pytest.mark.parametrize("policy", ["slow", "relax", "stop"])
@pytest.mark.parametrize(
    ("part", "blamed"),
    [
        (OwnRows((ROW, [-20.0])), "row 1 of OwnRows, iiwa7_joint_2 lower velocity limit"),
        (OwnRows((0.0 * ROW, [-1.0])), "row 1 of OwnRows"),
        (OwnBounds((ZEROS + 5.0, ZEROS + np.inf)), "iiwa7_joint_1 lower position limit or bound"),
        (OwnTask((0.0 * ROW, [1.0])), "no bound, a singular pose or tasks against each other"),
    ],
)
def test_a_part_that_nothing_fulfils_is_named(
    part: Any, blamed: str, policy: str, capfd: pytest.CaptureFixture[str]
) -> None:
    record = beside(part, policy=policy)
    assert any(f"in the way: {blamed}" in reason for reason in failures(record))
    assert capfd.readouterr().out == ""  # OSQP has its own words for such programs
    # A row that asks for motion is followed as far as the joints can; bounds that contradict each
    # other stop the arm.
    if isinstance(part, OwnBounds) or policy == "stop":
        assert record.dq.shape == (1, 7)
        assert not record.dq.any()
    else:
        assert record.steps == 10


def test_an_active_bound_of_ones_own_is_no_position_limit() -> None:
    record = run(
        Scheme([KineticEnergy()], [], [JointLimits(), OwnBounds((ZEROS + 0.1, ZEROS + 0.2))]),
        duration=0.01,
    )  # fmt: skip
    np.testing.assert_allclose(record.dq, 0.1, rtol=1e-9)
    active = compute_metrics(record)["incidents"]["active"]
    assert {bound["limit"] for bound in active} == {"position limit or bound of OwnBounds"}


@pytest.mark.parametrize("weight", [None, 1.0])
def test_without_a_cost_answers_agree_in_what_is_weighed(weight: float | None) -> None:
    # Four directions of seven are free: references choose other points of the same cost.
    scheme = Scheme([], [PositionTask(weight=weight)], [JointLimits()])
    record = run(scheme, duration=0.02, check=CrossCheck(("proxqp", "osqp")))
    assert failures(record) == []
