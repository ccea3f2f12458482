"""PlaCo: a posture a step ahead, with its limits of joints and velocities."""

import sys
import tempfile
from pathlib import Path

sys.path.pop(0)  # this file has the library's name
import numpy as np
import placo

from benchmarks.hostile.serve import serve, velocity_of


def make(setup):
    """Return the filter; it knows no spheres."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "arm.urdf"
        file.write_text(setup["urdf"], encoding="utf-8")
        robot = placo.RobotWrapper(str(file), placo.Flags.ignore_collisions)
    solver = placo.KinematicsSolver(robot)
    solver.mask_fbase(True)
    joints = solver.add_joints_task()
    solver.enable_joint_limits(True)
    solver.enable_velocity_limits(True)
    names = [joint["name"] for joint in setup["arm"]["joints"]]
    velocity = setup["limits"][2]

    def act(state, request, dt):
        dq = np.clip(np.nan_to_num(velocity_of(request, state, dt)), -velocity, velocity)
        for name, value, goal in zip(names, state["q"], state["q"] + dt * dq, strict=True):
            robot.set_joint(name, value)
            joints.set_joint(name, goal)
        robot.update_kinematics()
        solver.dt = dt
        try:
            return np.array(solver.solve(False))[-len(names) :] / dt
        except RuntimeError:
            return np.zeros_like(state["q"])

    return act


serve(make)
