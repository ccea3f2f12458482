"""PlaCo's loop: a hard frame task, a weak joints task, joint and velocity limits."""

import tempfile
from pathlib import Path

import placo
from balls import write_scene
from serve import Loop, Task, serve


def make(task: Task, variant: str) -> Loop:
    """Make the loop."""
    urdf = Path(str(task["urdf"]))
    if "balls" in task:
        folder = tempfile.TemporaryDirectory()
        urdf, pairs = write_scene(task, Path(folder.name))
    robot = placo.RobotWrapper(str(urdf))
    if "balls" in task:
        robot.load_collision_pairs(str(pairs))
    names = [str(name) for name in task["names"]]
    for i, name in enumerate(names):
        robot.set_joint(name, float(task["q0"][i]))
        robot.set_joint_limits(name, float(task["lower"][i]), float(task["upper"][i]))
        robot.set_velocity_limit(name, float(task["velocity"][i]))
    robot.update_kinematics()
    solver = placo.KinematicsSolver(robot)
    solver.mask_fbase(True)
    tip = str(task["tip"])
    frame = solver.add_frame_task(tip, task["poses"][0])
    frame.configure(tip, "hard", 1.0, 1.0)
    joints = solver.add_joints_task()
    joints.set_joints(dict(zip(names, task["q0"].tolist(), strict=True)))
    joints.configure("posture", "soft", 1e-3)
    solver.enable_joint_limits(True)
    solver.enable_velocity_limits(True)
    if "balls" in task:
        avoid = solver.add_avoid_self_collisions_constraint()
        avoid.self_collisions_margin = float(task["distance"])
        avoid.self_collisions_trigger = float(task["distance"]) + 0.2
        avoid.configure("balls", "hard", 1.0)
    solver.dt = float(task["dt"])

    def step(k: int) -> None:
        frame.T_world_frame = task["poses"][k + 1]
        solver.solve(True)
        robot.update_kinematics()

    return step, lambda: robot.state.q[7:]  # after the pose of the floating base


if __name__ == "__main__":
    serve(make)
