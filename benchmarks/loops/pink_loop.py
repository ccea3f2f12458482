"""Pink's loop: a frame task and a weak posture task in one cost, as in its examples.

With ``ahead``, the frame task's target is that of the step's end; without, as in the examples, that
of its beginning.
"""

from __future__ import annotations

import pink
import pinocchio as pin
from pink.limits import AccelerationLimit, ConfigurationLimit, VelocityLimit
from serve import Loop, Task, serve


def make(task: Task, variant: str) -> Loop:
    """Make the loop; a variant names a solver of qpsolvers, then ``ahead``, ``acceleration``."""
    solver, *words = variant.split(", ")
    ahead, limited = "ahead" in words, "acceleration" in words
    options = {"eps_abs": 1e-9, "eps_rel": 0.0} if solver == "proxqp" else {}
    model, dt = pin.buildModelFromUrdf(str(task["urdf"])), float(task["dt"])
    model.lowerPositionLimit, model.upperPositionLimit = task["lower"], task["upper"]
    model.velocityLimit = task["velocity"]
    configuration = pink.Configuration(model, model.createData(), task["q0"].copy())
    frame = pink.FrameTask(str(task["tip"]), position_cost=1.0, orientation_cost=1.0)
    posture = pink.PostureTask(cost=1e-3)
    posture.set_target(task["q0"])
    tasks, poses, later = [frame, posture], [pin.SE3(pose) for pose in task["poses"]], bool(ahead)

    limits = None
    if limited:
        rates = AccelerationLimit(model, task["acceleration"])
        limits = [ConfigurationLimit(model), VelocityLimit(model), rates]

    def step(k: int) -> None:
        frame.set_target(poses[k + later])
        velocity = pink.solve_ik(configuration, tasks, dt, solver=solver, limits=limits, **options)
        if limited:
            rates.set_last_integration(velocity, dt)
        configuration.integrate_inplace(velocity, dt)

    return step, lambda: configuration.q


if __name__ == "__main__":
    serve(make)
