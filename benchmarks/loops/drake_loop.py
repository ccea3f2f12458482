"""Drake's loop: `DoDifferentialInverseKinematics` with joint limits and a nominal posture."""

import numpy as np
from pydrake.math import RigidTransform
from pydrake.multibody.inverse_kinematics import (
    DifferentialInverseKinematicsParameters,
    DoDifferentialInverseKinematics,
)
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant
from serve import Loop, Task, serve


def make(task: Task, variant: str) -> Loop:
    """Make the loop."""
    plant = MultibodyPlant(0.0)
    (arm,) = Parser(plant).AddModels(str(task["urdf"]))
    base = plant.get_body(plant.GetBodyIndices(arm)[0])
    plant.WeldFrames(plant.world_frame(), base.body_frame())
    plant.Finalize()
    context = plant.CreateDefaultContext()
    tip = plant.GetFrameByName(str(task["tip"]))
    q = np.array(task["q0"])
    dt = float(task["dt"])
    parameters = DifferentialInverseKinematicsParameters(q.size, q.size)
    parameters.set_time_step(dt)
    parameters.set_nominal_joint_position(q)
    parameters.set_joint_centering_gain(1e-3 * np.eye(q.size))
    parameters.set_joint_position_limits((task["lower"], task["upper"]))
    parameters.set_joint_velocity_limits((-task["velocity"], task["velocity"]))
    poses = [RigidTransform(pose) for pose in task["poses"]]
    plant.SetPositions(context, q)

    def step(k: int) -> None:
        nonlocal q
        result = DoDifferentialInverseKinematics(plant, context, poses[k + 1], tip, parameters)
        q = q + dt * result.joint_velocities
        plant.SetPositions(context, q)

    return step, lambda: q


if __name__ == "__main__":
    serve(make)
