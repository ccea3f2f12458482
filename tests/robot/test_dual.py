"""Two arms in one URDF."""

from __future__ import annotations

import itertools

import numpy as np
import pinocchio as pin

from helpers_kinematics import dh_pose
from iiwa_dnn.references import Line
from iiwa_dnn.robot import Configuration, load_robot
from iiwa_dnn.robot.mujoco_model import compile_model
from iiwa_dnn.schemes import (
    CollisionAvoidance,
    CyclicMotion,
    JointLimits,
    KineticEnergy,
    PositionTask,
    Scheme,
)
from iiwa_dnn.simulation import simulate

LEFT, RIGHT = "left_iiwa7_flange", "right_iiwa7_flange"
COSTS = [KineticEnergy(weight=0.2), CyclicMotion(weight=0.8)]


def test_each_arm_is_the_single_one_moved_aside() -> None:
    robot, single = load_robot("iiwa7_dual"), load_robot("iiwa7")
    assert robot.dof == 14
    np.testing.assert_array_equal(robot.q_upper, np.tile(single.q_upper, 2))
    q = np.random.default_rng(5).uniform(-1.0, 1.0, 14)
    conf = Configuration(robot, q)
    for frame, part, side in ((LEFT, q[:7], 0.3), (RIGHT, q[7:], -0.3)):
        position, rotation = dh_pose(part)
        np.testing.assert_allclose(conf.frame(frame).position, position + [0, side, 0], atol=1e-12)
        np.testing.assert_allclose(conf.frame(frame).rotation, rotation, atol=1e-12)
    assert compile_model(robot, 1e-3).nq == 14


def test_two_arms_that_are_driven_into_each_other_do_not_touch() -> None:
    robot = load_robot("iiwa7_dual")
    start = Configuration(robot, robot.start_posture())
    ways = {LEFT: [0.0, -0.28, 0.0], RIGHT: [0.0, 0.28, 0.0]}
    paths = {name: Line(way, 2.0).anchored(start.frame(name)) for name, way in ways.items()}
    tasks = [PositionTask(frame=name) for name in paths]
    scheme = Scheme(COSTS, tasks, [JointLimits(), CollisionAvoidance(self_collision=True)])
    record = simulate(robot, scheme, paths, start.q, dt=2e-3, duration=1.2)
    assert record.path_completed < 0.9  # the paths yield
    bodies = pin.buildGeomFromUrdfString(robot.model, robot.urdf, pin.GeometryType.COLLISION)
    names = [body.name for body in bodies.geometryObjects]
    left = [i for i, name in enumerate(names) if name.startswith("left")]
    right = [i for i, name in enumerate(names) if name.startswith("right")]
    for i, j in itertools.product(left, right):
        bodies.addCollisionPair(pin.CollisionPair(i, j))
    data, judge = robot.model.createData(), pin.GeometryData(bodies)
    for q in record.q[::20]:
        pin.computeDistances(robot.model, data, bodies, judge, q)
        assert min(result.min_distance for result in judge.distanceResults) > 0.0199
