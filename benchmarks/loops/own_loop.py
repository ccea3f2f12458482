"""This package's loop as documented: `Controller.step(q, t)`, and the joint positions after it."""

import numpy as np
from serve import Loop, Task, serve

import iiwa_dnn


def make(task: Task, variant: str) -> Loop:
    """Make the loop, which has no variants."""
    q = np.array(task["q0"])
    dt = float(task["dt"])
    robot = iiwa_dnn.load_robot(str(task["urdf"]), tip=str(task["tip"])).with_limits(
        lower=task["lower"], upper=task["upper"], velocity=task["velocity"]
    )
    reference = iiwa_dnn.Heart().anchored(iiwa_dnn.Configuration(robot, q))
    scheme: iiwa_dnn.Scheme = iiwa_dnn.DoubleIndicator()
    if "balls" in task:
        balls = map(iiwa_dnn.Sphere, task["balls"], map(float, task["ball_radii"]))
        distance = float(task["distance"])
        avoid = iiwa_dnn.CollisionAvoidance(list(balls), self_collision=False, distance=distance)
        scheme = iiwa_dnn.Scheme(scheme.costs, scheme.tasks, [*scheme.limits, avoid])
    controller = iiwa_dnn.Controller(robot, scheme, reference, dt=dt)
    controller.warm_up(q)

    def step(k: int) -> None:
        nonlocal q
        q = controller.step(q, k * dt).next_q

    return step, lambda: q


if __name__ == "__main__":
    serve(make)
