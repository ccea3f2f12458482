"""What is wrong with costs, tasks, limits, schemes and answers is said in one line, by its name."""

from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest

import iiwa_dnn as d
from helpers_kinematics import PAPER_Q0
from helpers_simulation import beside, near_target, own, paper_robot, paper_start, run
from iiwa_dnn.schemes.literature import bi_criteria

ROBOT = paper_robot()
COARSE = d.Scheme(limits=[d.AccelerationLimits(30.0), d.JerkLimits(375.0)])
NEAR = near_target(PAPER_Q0, 1)
EYE, ZEROS, ROW = np.eye(7), np.zeros(7), np.ones((1, 7))
NUMBER = "must be a finite number above 0"


def build(**lists: Any) -> d.QP:
    return d.Scheme(**lists).build_qp(paper_start(), NEAR)


def lay_out(*limits: d.Limit) -> Any:
    return d.Scheme(limits=limits).program(ROBOT)


def read(text: str) -> d.CollisionAvoidance:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "obstacles.toml"
        path.write_text(text, encoding="utf-8")
        return d.CollisionAvoidance.from_toml(path)


CALLS: list[tuple[Callable[[], Any], str]] = [
    (lambda: d.AxisTask(axis=(0.0, 0.0, 0.0)), "axis"),
    (lambda: d.PoseTask(gain=-1.0), "gain"),
    (lambda: d.PoseTask(weight=-1.0), "weight"),
    (lambda: d.RelativePoseTask("a", "b", ((1.0,),)), "pose"),
    (lambda: d.RemoteCenterTask((0.0, 1.0)), "point"),
    (lambda: d.PostureTask({"a": np.nan}), "joints"),
    (lambda: d.PostureTask([0.0] * 7), "joints"),  # type: ignore[arg-type]
    (lambda: d.JointCouplingTask({"a": 1.0}, np.inf), "offset"),
    (lambda: d.OrientationTask(form="euler"), "form"),  # type: ignore[arg-type]
    (lambda: d.Manipulability(weight=-1.0), "weight"),
    (lambda: bi_criteria(ROBOT, 1.5), "weight"),
    (lambda: d.PseudoInverse(orientation="euler"), "orientation"),  # type: ignore[arg-type]
    (lambda: d.DoubleIndicator(sample="last"), "sample"),  # type: ignore[arg-type]
    (lambda: d.DoubleIndicator(home=(0.0, np.nan)), "home"),
    (lambda: d.DoubleIndicator(limit_gain=0.0), "gain"),  # nothing would move
    (lambda: d.DoubleIndicator(kinetic="mass"), "kinetic"),  # type: ignore[arg-type]
    (lambda: build(costs=[d.CyclicMotion(home=(0.0, 0.0, 0.0))]), "home: has 3 values for 7"),
    (lambda: build(tasks=[d.PositionTask(frame="iiwa7_link_44")]), "no frame 'iiwa7_link_44'"),
    (lambda: build(tasks=[d.PositionTask(frame="iiwa7_link_4")]), "target: is missing for frame"),
    (lambda: build(tasks=[d.PostureTask({"iiwa7_joint_33": 0.0})]), "no joint 'iiwa7_joint_33'"),
    (lambda: build(tasks=[d.PoseTask(gain=np.inf)]), "dt"),
    (lambda: d.Scheme(tasks=[d.JointLimits()]), "tasks: must be an iiwa_dnn.Task"),
    (lambda: d.Scheme(limits=d.JointLimits()), "limits: must be a list of parts"),
    (lambda: d.Scheme(slack=-1), "slack"),
    *[
        (lambda limit=limit: d.AccelerationLimits(limit), f"limit: {NUMBER}")
        for limit in (0.0, -1.0, np.nan, "fast", [1.0, -2.0])
    ],
    (
        lambda: lay_out(d.AccelerationLimits([1.0, 2.0])),
        r"acceleration: must have shape \(7,\), not \(2,\)",
    ),
    (lambda: lay_out(d.JerkLimits()), "jerk: is needed: robot iiwa7"),
    (lambda: lay_out(d.AccelerationLimits(), d.JerkLimits(1.0)), "jerk: joint 1: 1 rad/s.3 is too"),
    # 375 rad/s^3 is enough, but at 80 ms a step braking cannot make use of so much.
    (
        lambda: d.Controller(ROBOT.with_limits(velocity=9.0), COARSE, dt=0.08).step(
            PAPER_Q0, 0.0, NEAR
        ),
        "jerk: joint 1: .* at 0.08 s a step",
    ),
    (lambda: d.TipSpeedLimit(0.0), "limit"),
    (lambda: d.TipSpeedLimit(1.0, gain=-1.0), "gain"),
    (lambda: d.CollisionAvoidance(["ball"]), "obstacles"),  # type: ignore[list-item]
    (lambda: d.CollisionAvoidance(nearest=0), "nearest"),
    (
        lambda: d.CollisionAvoidance(self_collision=False).scene(ROBOT),
        "obstacles: leave them out, there is no pair",
    ),
    (lambda: d.CollisionAvoidance().scene(ROBOT.with_limits(velocity=np.inf)), "robot"),
    (lambda: run(d.DoubleIndicator(sample="end"), motion="rk4"), "motion: .*next target"),
    *[
        (lambda text=text: read(text), rf".*toml: .*{problem}")
        for text, problem in (
            ("[[obstacle]]\nshape = 'ball'", "shape: must be one of sphere"),
            ("[[obstacle]]\nshape = 'sphere'\nradius = 1", "missing 1 required"),
            ("[[obstacle]]\nshape = 'sphere'\ncenter = [0, 0]\nradius = 1", "center"),
            ("[[obstacle]]\nshape = 'Sphere'\nradus = 1", "unexpected keyword argument 'radus'"),
            ("[[obstacle]]\nshape = 'Box'\ncenter = [0,0,0]\nhalf_extents = [1,1,-1]", "half_ext"),
            ("distance = -1", f"distance: {NUMBER}"),
            ("self_collision = 'no'", "self_collision: must be one of True, False, not 'no'"),
            ("distanz = 1", "no key 'distanz'; did you mean: distance"),
            ("[[obstacles]]\nshape = 'Box'", "no key 'obstacles'; did you mean: obstacle$"),
            ("obstacle = 3", "obstacle: must be tables"),
            ("x = [", "cannot be read as TOML"),
        )
    ],
    *[
        (lambda part=part: beside(part).build_qp(paper_start(), NEAR), f"Own: {problem}")
        for part, problem in (
            (own(d.Cost, quadratic=(-EYE, ZEROS)), "P is not convex, its least eigenvalue is -1"),
            (own(d.Cost, quadratic=(np.triu(EYE + 1.0), ZEROS)), "P is not symmetric"),
            (own(d.Cost, quadratic=(EYE, ZEROS + np.nan)), "q holds NaN"),
            (own(d.Cost, quadratic=(EYE, ZEROS, 1)), "must return two arrays, P and q"),
            (own(d.Cost, quadratic=(1j * EYE, ZEROS)), "must return two arrays, P and q"),
            (own(d.Task, 1, equations=None), "must return two arrays, A and b, not None"),
            (own(d.Task, 1, equations=(ROW, [np.inf])), "b holds an infinite number"),
            (own(d.Limit, 1, inequalities=(EYE[:2], ZEROS[:2])), r"G has shape \(2, 7\), not \(1"),
            # Without `rows` its inequalities would not be asked for, and the limit not be kept.
            (own(d.Limit, 0, inequalities=(ROW, [0.0])), r"G has shape \(1, 7\), not \(0, 7\)"),
            (own(d.Limit, 1, inequalities=(ROW * np.inf, [1.0])), "G holds an infinite number"),
            (own(d.Limit, bounds=(ZEROS + np.inf, ZEROS)), "lb holds an infinite number"),
        )
    ],
    *[
        (lambda name=name, bad=bad: d.DoubleIndicator(**{name: bad}), rf"({name}|gain)\b")
        for name in ("weight", "drift_gain", "position_gain", "orientation_gain", "limit_gain")
        for bad in (-1.0, np.nan, "high")
    ],
]


@pytest.mark.parametrize(("call", "said"), CALLS)
def test_what_is_wrong_is_refused_by_name(call: Callable[[], Any], said: str) -> None:
    with pytest.raises(d.IiwaDnnError, match=rf"^{said}") as refused:
        call()
    assert "\n" not in str(refused.value)


def test_a_jerk_limit_that_suffices_is_taken() -> None:
    assert d.Controller(ROBOT, COARSE, dt=1e-3).program.joint_limits.cubic
