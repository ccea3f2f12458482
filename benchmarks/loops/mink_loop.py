"""mink's loop on MuJoCo: a frame task and a weak posture task in one cost, with limits."""

from pathlib import Path

import mink
import mujoco
from serve import Loop, Task, serve

# MuJoCo merges bodies without a joint, the tip among them, unless told not to.
_COMPILER = '<mujoco><compiler fusestatic="false" discardvisual="true"/></mujoco></robot>'


def make(task: Task, variant: str) -> Loop:
    """Make the loop."""
    urdf = Path(str(task["urdf"])).read_text(encoding="utf-8")
    model = mujoco.MjModel.from_xml_string(urdf.replace("</robot>", _COMPILER))
    model.jnt_range[:, 0] = task["lower"]
    model.jnt_range[:, 1] = task["upper"]
    configuration = mink.Configuration(model, q=task["q0"].copy())
    dt = float(task["dt"])
    frame = mink.FrameTask(str(task["tip"]), "body", position_cost=1.0, orientation_cost=1.0)
    posture = mink.PostureTask(model, cost=1e-3)
    posture.set_target(task["q0"])
    names = [str(name) for name in task["names"]]
    velocities = dict(zip(names, task["velocity"].tolist(), strict=True))
    limits = [mink.ConfigurationLimit(model), mink.VelocityLimit(model, velocities)]
    tasks = [frame, posture]
    wanted = [mink.SE3.from_matrix(pose) for pose in task["poses"]]

    def step(k: int) -> None:
        frame.set_target(wanted[k + 1])
        velocity = mink.solve_ik(configuration, tasks, dt, solver="daqp", limits=limits)
        configuration.integrate_inplace(velocity, dt)

    return step, lambda: configuration.q


if __name__ == "__main__":
    serve(make)
