"""Pink's loop: a frame task and a weak posture task in one cost, as in its examples.

With ``ahead``, the frame task's target is that of the step's end; without, as in the examples, that
of its beginning.
"""

from typing import Any

import coal
import numpy as np
import pink
import pinocchio as pin
from pink.barriers import SelfCollisionBarrier
from serve import Loop, Task, serve


def make(task: Task, variant: str) -> Loop:
    """Make the loop; a variant names a solver of qpsolvers, then ``ahead``."""
    solver, *words = variant.split(", ")
    later = len(words)
    options = {"eps_abs": 1e-9, "eps_rel": 0.0} if solver == "proxqp" else {}
    model = pin.buildModelFromUrdf(str(task["urdf"]))
    dt = float(task["dt"])
    model.lowerPositionLimit = task["lower"]
    model.upperPositionLimit = task["upper"]
    model.velocityLimit = task["velocity"]
    q0 = task["q0"].copy()
    barriers = []
    scene: dict[str, Any] = {}
    if "balls" in task:
        geometry = collision_geometry(model, task)
        count = len(geometry.collisionPairs)
        distance = float(task["distance"])
        barriers = [SelfCollisionBarrier(count, gain=20.0, d_min=distance)]
        scene = {"collision_model": geometry, "collision_data": geometry.createData()}
    configuration = pink.Configuration(model, model.createData(), q0, **scene)
    frame = pink.FrameTask(str(task["tip"]), position_cost=1.0, orientation_cost=1.0)
    posture = pink.PostureTask(cost=1e-3)
    posture.set_target(task["q0"])
    tasks = [frame, posture]
    wanted = [pin.SE3(pose) for pose in task["poses"]]

    def step(k: int) -> None:
        frame.set_target(wanted[k + later])
        velocity = pink.solve_ik(
            configuration, tasks, dt, solver=solver, barriers=barriers, **options
        )
        configuration.integrate_inplace(velocity, dt)

    return step, lambda: configuration.q


def collision_geometry(model: pin.Model, task: Task) -> pin.GeometryModel:
    """Describe the capsules and the balls to Pinocchio, with a pair of each and each."""
    geometry = pin.GeometryModel()
    for center, radius in zip(task["balls"], task["ball_radii"], strict=True):
        place = pin.SE3(np.eye(3), center)
        name = f"ball_{geometry.ngeoms}"
        geometry.addGeometryObject(pin.GeometryObject(name, 0, place, coal.Sphere(radius)))
    balls = geometry.ngeoms
    capsules = zip(task["links"], task["a"], task["b"], task["radii"], strict=True)
    for link, a, b, radius in capsules:
        frame = model.frames[model.getFrameId(str(link), pin.FrameType.BODY)]
        along = b - a
        turn = pin.Quaternion.FromTwoVectors(np.array([0.0, 0.0, 1.0]), along + [0, 0, 1e-9])
        place = frame.placement * pin.SE3(turn.matrix(), 0.5 * (a + b))
        shape = coal.Capsule(radius, float(np.linalg.norm(along)))
        index = geometry.addGeometryObject(
            pin.GeometryObject(str(link), frame.parentJoint, place, shape)
        )
        for k in range(balls):
            geometry.addCollisionPair(pin.CollisionPair(index, k))
    return geometry


if __name__ == "__main__":
    serve(make)
