"""Objects of a wrong kind: each call is refused by the package's own error, naming the argument."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import iiwa_dnn as d
from helpers_kinematics import PAPER_Q0
from helpers_simulation import heart, paper_robot, paper_start

EYE = np.eye(3)
SCHEME = d.DoubleIndicator()


def drive(scheme: Any = SCHEME, reference: Any = None, **options: Any) -> Any:
    reference = heart() if reference is None else reference
    return d.simulate(paper_robot(), scheme, reference, PAPER_Q0, dt=1e-3, **options)


def step(target: Any) -> Any:
    return d.Controller(paper_robot(), SCHEME).step(PAPER_Q0, 0.0, target)


class Builder(d.Scheme):
    def build_qp(self, *given: Any, **options: Any) -> d.QP:
        return SCHEME.build_qp(*given, **options)


class Distant(d.Cost):
    def quadratic(self, step: d.Step) -> Any:
        return EYE, step.target("x").position


class Overwriting(d.Cost):
    def quadratic(self, step: d.Step) -> Any:
        step.q[:] = 0.0


CALLS: list[tuple[Callable[[], Any], str]] = [
    (lambda: drive(reference=d.Heart), "reference: must be an iiwa_dnn.Ref"),
    (lambda: drive(reference=EYE[0]), "reference: must be an iiwa_dnn.Ref"),
    (lambda: drive(reference={}), "reference: is missing"),
    (lambda: drive(reference={"x": d.Heart}), "reference: must be"),
    (lambda: drive(d.DoubleIndicator), "scheme: must be an iiwa_dnn.Scheme"),
    (lambda: drive(plant=d.MujocoPlant), "plant: must be an object with start"),
    (lambda: drive(estimator=3), "estimator: must be an iiwa_dnn.NoiseModel"),
    (lambda: drive(noise=EYE[0]), "noise: must have shape"),
    (lambda: d.Controller(paper_robot(), SCHEME, EYE), "reference: must be"),
    (lambda: step(np.zeros(3)), "target: must be an iiwa_dnn.Target"),
    (lambda: step(paper_start()), "target: must be an iiwa_dnn.Target"),
    (lambda: step({"x": 1}), "target: is missing for frame 'iiwa7_fl"),
    (lambda: SCHEME.build_qp(paper_start(), np.zeros(18)), "target: must be"),
    (lambda: SCHEME.build_qp(list(PAPER_Q0), None), "conf: must be"),
    (lambda: d.Circle().anchored([0, 0, 0]), "pose: must be an object with position"),
    (lambda: d.MovingTarget(EYE), "pose: must be an object with position"),
    (lambda: d.Target(EYE[0], 2.0 * EYE), "rotation: is not a rotation matrix"),
    (lambda: d.Tilting(d.Circle), "along: must be one of FixedPose"),
    (lambda: d.Scheme(3), "costs: must be a list of parts"),
    (lambda: d.CollisionAvoidance(3), "obstacles: must be an iiwa_dnn.Obst"),
    (lambda: d.MujocoPlant(3), "disturbances: must be an iiwa_dnn.Disturbances"),
    (lambda: paper_robot().frame_id(None), "no frame 'None'"),
    (lambda: d.compute_metrics({}), "record: must be an iiwa_dnn.Record"),
    (lambda: d.Record.load(3), "3: "),
    (
        lambda: d.prove(d.QP(EYE, PAPER_Q0[:3]), [1.0, 1.0, 1.0]),
        "solution: must be an object with x",
    ),
    (lambda: d.CrossCheck().check(d.QP(EYE, PAPER_Q0[:3]), EYE[:2, 0]), "answer: has shape (2,)"),
    (lambda: d.DNNSolver(d.Network()).solve(d.QP(EYE, PAPER_Q0[:3])), "Network: has neither"),
    (lambda: d.DoubleIndicator(extra_limits=None), "extra_limits: must be a list"),
    (lambda: d.Waypoints([0, 1], [[0, 0, 0], [1, 1]]), "points: must be numbers"),
    (lambda: d.Waypoints.from_csv(None), "None: "),
    (lambda: d.load_robot("none.urdf"), "none.urdf: No such file"),
    (lambda: d.load_robot("a.xacro"), "a.xacro: make a URDF of it: xacro a.xacro -o a.urdf"),
    (
        lambda: d.load_robot("a.urdf.xacro"),
        "a.urdf.xacro: make a URDF of it: xacro a.urdf.xacro -o a.urdf",
    ),
    (lambda: d.failures(None), "record: must be an iiwa_dnn.Record"),
    (lambda: drive(Builder()), "scheme: Builder overrides build_qp"),
    (lambda: drive(d.Scheme([Distant()], [d.PositionTask()])), "no target of frame 'x'"),
]


@pytest.mark.parametrize(("call", "said"), CALLS)
def test_a_wrong_object_is_refused_by_name(call: Callable[[], Any], said: str) -> None:
    with pytest.raises(d.IiwaDnnError) as refused:
        call()
    assert str(refused.value).startswith(said)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(("name", "value"), [("dt", -1.0), ("scheme", None), ("policy", None)])
def test_an_attribute_of_a_controller_is_checked_as_its_argument_is(name: str, value: Any) -> None:
    controller = d.Controller(paper_robot(), SCHEME, heart())
    with pytest.raises(d.InvalidInputError, match=f"^{name}: must be"):
        setattr(controller, name, value)
    assert controller.step(PAPER_Q0, 0.0).ok


def test_a_part_cannot_move_the_robot_that_it_is_asked_about() -> None:
    with pytest.raises(ValueError, match="read-only"):
        drive(d.Scheme([Overwriting()], [d.PositionTask()]))
