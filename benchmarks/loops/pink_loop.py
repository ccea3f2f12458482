"""Pink's loop: a frame task and a weak posture task in one cost, as in its examples.

With ``ahead``, the frame task's target is that of the step's end; without, as in the examples, that
of its beginning.
"""

import pink
import pinocchio as pin
from serve import Loop, Task, serve


def make(task: Task, variant: str) -> Loop:
    """Make the loop; the variant is ``ahead`` or none."""
    later = int(variant == "ahead")
    model = pin.buildModelFromUrdf(str(task["urdf"]))
    dt = float(task["dt"])
    model.lowerPositionLimit = task["lower"]
    model.upperPositionLimit = task["upper"]
    model.velocityLimit = task["velocity"]
    configuration = pink.Configuration(model, model.createData(), task["q0"].copy())
    frame = pink.FrameTask(str(task["tip"]), position_cost=1.0, orientation_cost=1.0)
    posture = pink.PostureTask(cost=1e-3)
    posture.set_target(task["q0"])
    tasks = [frame, posture]
    wanted = [pin.SE3(pose) for pose in task["poses"]]

    def step(k: int) -> None:
        frame.set_target(wanted[k + later])
        velocity = pink.solve_ik(configuration, tasks, dt, solver="daqp")
        configuration.integrate_inplace(velocity, dt)

    return step, lambda: configuration.q


if __name__ == "__main__":
    serve(make)
