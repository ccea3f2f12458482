"""EmbodiK 0.23: a joint task, with its limits of position, velocity and acceleration."""

import sys
import tempfile
from pathlib import Path

sys.path.pop(0)  # this file has the library's name
import embodik
import numpy as np

from benchmarks.hostile.serve import serve, velocity_of


def make(setup):
    """Return the filter; its certified collisions refuse revolute arms, so it knows no spheres."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "arm.urdf"
        file.write_text(setup["urdf"], encoding="utf-8")
        robot = embodik.RobotModel(str(file))
    solver = embodik.KinematicsSolver(robot)
    acceleration = setup["limits"][3]
    robot.set_acceleration_limits(acceleration)
    solver.enable_position_limits(True)
    solver.enable_velocity_limits(True)
    solver.enable_acceleration_limits(True)
    solver.set_acceleration_limits(acceleration)
    task = solver.add_posture_task("posture")
    velocity = setup["limits"][2]

    def act(state, request, dt):
        dq = np.clip(np.nan_to_num(velocity_of(request, state, dt)), -velocity, velocity)
        solver.dt = dt
        task.set_target_velocity(dq)
        solver.set_previous_joint_velocities(state["last"])
        answer = solver.solve_velocity(state["q"], True)
        done = answer.status == embodik.SolverStatus.SUCCESS
        return np.array(answer.joint_velocities) if done else np.zeros_like(state["q"])

    return act


serve(make)
