"""Objects of a wrong kind: each call is refused by the package's own error, naming the argument."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import iiwa_dnn as d
from helpers_kinematics import PAPER_Q0
from helpers_simulation import heart, paper_robot, paper_start

EYE = np.eye(3)


def drive(*more: Any, scheme: Any = None, reference: Any = None, **options: Any) -> Any:
    scheme = d.DoubleIndicator() if scheme is None else scheme
    reference = heart() if reference is None else reference
    return d.simulate(paper_robot(), scheme, reference, *(more or (PAPER_Q0,)), dt=1e-3, **options)


def step(target: Any) -> Any:
    return d.Controller(paper_robot(), d.DoubleIndicator()).step(PAPER_Q0, 0.0, target)


class Builder(d.Scheme):
    def build_qp(self, *given: Any, **options: Any) -> d.QP:
        return d.DoubleIndicator().build_qp(*given, **options)


class Distant(d.Cost):
    def quadratic(self, step: d.Step) -> Any:
        return EYE, step.target("x").position


class Overwriting(d.Cost):
    def quadratic(self, step: d.Step) -> Any:
        step.q[:] = 0.0


class Plain(d.Reference):
    """A path that is no dataclass."""

    name = "plain"
    period = 1.0

    def move(self, t: float, target: np.ndarray) -> None:
        """Leave the target as it is."""


CALLS: dict[str, tuple[Callable[[], Any], str]] = {
    "reference class": (lambda: drive(reference=d.Heart), "reference: must be an iiwa_dnn.Ref"),
    "reference array": (lambda: drive(reference=EYE[0]), "reference: must be an iiwa_dnn.Ref"),
    "no reference": (lambda: drive(reference={}), "reference: is missing"),
    "reference class of a frame": (lambda: drive(reference={"x": d.Heart}), "reference: must be"),
    "scheme class": (lambda: drive(scheme=d.DoubleIndicator), "scheme: must be an iiwa_dnn.Scheme"),
    "scheme text": (lambda: drive(scheme="paper"), "scheme: must be an iiwa_dnn.Scheme"),
    "plant class": (lambda: drive(plant=d.MujocoPlant), "plant: must be an object with start"),
    "estimator": (lambda: drive(estimator=3), "estimator: must be an iiwa_dnn.NoiseModel"),
    "noise": (lambda: drive(noise=EYE[0]), "noise: must have shape"),
    "reference of a controller": (
        lambda: d.Controller(paper_robot(), d.DoubleIndicator(), EYE), "reference: must be",
    ),
    "target array": (lambda: step(np.zeros(3)), "target: must be an iiwa_dnn.Target"),
    "target configuration": (lambda: step(paper_start()), "target: must be an iiwa_dnn.Target"),
    "target of another frame": (lambda: step({"x": 1}), "target: is missing for frame 'iiwa7_fl"),
    "program of an array": (
        lambda: d.DoubleIndicator().build_qp(paper_start(), np.zeros(18)), "target: must be",
    ),
    "program at a list": (
        lambda: d.DoubleIndicator().build_qp(list(PAPER_Q0), None), "conf: must be",
    ),
    "pose list": (lambda: d.Circle().anchored([0, 0, 0]), "pose: must be an object with position"),
    "pose of a target": (lambda: d.MovingTarget(EYE), "pose: must be an object with position"),
    "no rotation": (lambda: d.Target(EYE[0], 2.0 * EYE), "rotation: is not a rotation matrix"),
    "path that tilts": (lambda: d.Tilting(d.Circle), "along: must be one of Still"),
    "no list of costs": (lambda: d.Scheme(3), "costs: must be a list of parts"),
    "obstacles": (lambda: d.CollisionAvoidance(3), "obstacles: must be an iiwa_dnn.Obst"),
    "solvers": (lambda: d.CrossCheck(3), "solvers: must be a tuple of names, not 3"),
    "disturbances": (lambda: d.MujocoPlant(3), "disturbances: must be an iiwa_dnn.Disturbances"),
    "frame": (lambda: paper_robot().frame_id(None), "no frame 'None'"),
    "locked": (lambda: d.load_robot("iiwa7", locked=3), "locked: must be names of joints"),
    "record": (lambda: d.compute_metrics({}), "record: must be an iiwa_dnn.Record"),
    "run": (lambda: d.failures("runs/heart"), "run: must be a record or its metrics"),
    "file": (lambda: d.Record.load(3), "3: "),
    "own programs": (lambda: drive(scheme=Builder()), "scheme: Builder overrides build_qp"),
    "no such target": (
        lambda: drive(scheme=d.Scheme([Distant()], [d.PositionTask()])), "no target of frame 'x'",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", CALLS)
def test_a_wrong_object_is_refused_by_name(case: str) -> None:
    call, said = CALLS[case]
    with pytest.raises(d.IiwaDnnError) as refused:
        call()
    assert str(refused.value).startswith(said)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("dt", -1.0), ("mode", "x"), ("policy", None), ("scheme", None), ("robot", "iiwa7"),
        ("reference", d.Heart), ("solver", d.ProjectionNetwork()),
    ],
)  # fmt: skip
def test_an_attribute_of_a_controller_is_checked_as_its_argument_is(name: str, value: Any) -> None:
    controller = d.Controller(paper_robot(), d.DoubleIndicator(), heart())
    with pytest.raises(d.InvalidInputError, match=f"^{name}: must be"):
        setattr(controller, name, value)
    assert controller.step(PAPER_Q0, 0.0).ok


def test_a_part_cannot_move_the_robot_that_it_is_asked_about() -> None:
    with pytest.raises(ValueError, match="read-only"):
        drive(scheme=d.Scheme([Overwriting()], [d.PositionTask()]))


def test_a_path_needs_not_be_a_dataclass() -> None:
    record = drive(reference=Plain().anchored(paper_start()), duration=0.01)
    assert record.settings["reference"] == {"name": "plain"}
    assert d.failures(record) == []
