"""PlaCo's loop: hard or soft frame tasks, a weak joints task, joint and velocity limits."""

import tempfile
from pathlib import Path

import placo
from balls import write_scene
from serve import Loop, Task, by_frame, serve


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
    (tips, poses) = by_frame(task)
    solver.mask_fbase(True)
    frames = [solver.add_frame_task(tip, pose) for tip, pose in zip(tips, poses[0], strict=True)]
    for tip, frame in zip(tips, frames, strict=True):
        frame.configure(tip, "soft" if "soft" in task else "hard", 1.0, 1.0)
    joints = solver.add_joints_task()
    joints.set_joints(dict(zip(names, task["q0"].tolist(), strict=True)))
    joints.configure("posture", "soft", 1e-6 if "soft" in task else 1e-3)
    solver.enable_joint_limits(True)
    solver.enable_velocity_limits(True)
    if "balls" in task:
        avoid = solver.add_avoid_self_collisions_constraint()
        avoid.self_collisions_margin = float(task["distance"])
        avoid.self_collisions_trigger = float(task["distance"]) + 0.2
        avoid.configure("balls", "hard", 1.0)
    solver.dt = float(task["dt"])

    def step(k: int) -> None:
        for frame, pose in zip(frames, poses[k + 1], strict=True):
            frame.T_world_frame = pose
        solver.solve(True)
        robot.update_kinematics()

    return step, lambda: robot.state.q[7:]  # after the pose of the floating base


if __name__ == "__main__":
    serve(make)
