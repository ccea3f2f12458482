"""Two arms in one URDF."""

import itertools

import pinocchio as pin

import iiwa_dnn as d

LEFT, RIGHT = "left_iiwa7_flange", "right_iiwa7_flange"
COSTS = [d.KineticEnergy(weight=0.2), d.CyclicMotion(weight=0.8)]


def test_each_of_two_arms_has_the_accelerations_of_one() -> None:
    one = d.load_robot("iiwa7")
    both = d.load_robot("iiwa7_dual")
    assert both.ddq_max.tolist() == [*one.ddq_max, *one.ddq_max]
    assert both.dddq_max.tolist() == [*one.dddq_max, *one.dddq_max]


def test_two_arms_that_are_driven_into_each_other_do_not_touch() -> None:
    robot = d.load_robot("iiwa7_dual")
    start = d.Configuration(robot, robot.start_posture())
    ways = {LEFT: [0.0, -0.28, 0.0], RIGHT: [0.0, 0.28, 0.0]}
    paths = {name: d.Line(way, 2.0).anchored(start.frame(name)) for name, way in ways.items()}
    tasks = [d.PositionTask(frame=name) for name in paths]
    scheme = d.Scheme(COSTS, tasks, [d.JointLimits(), d.CollisionAvoidance(self_collision=True)])
    record = d.simulate(robot, scheme, paths, start.q, dt=2e-3, duration=1.2)
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
