"""PlaCo's iterated inverse kinematics: step k looks for a pose from a start, both by its number.

The task has further `starts` (s, n) [rad], `iterations` and `tol`; step k is pose k // s from start
k % s. A posture is the joint positions and the CPU time of the step [s].
"""

import time

import numpy as np
import placo
from serve import Loop, Task, serve


def make(task: Task, variant: str) -> Loop:
    """Make the loop."""
    robot = placo.RobotWrapper(str(task["urdf"]))
    names = [str(name) for name in task["names"]]
    for i, name in enumerate(names):
        robot.set_joint_limits(name, float(task["lower"][i]), float(task["upper"][i]))
    tip = str(task["tip"])
    poses = task["poses"]
    starts = task["starts"]
    solver = placo.KinematicsSolver(robot)
    solver.mask_fbase(True)
    robot.update_kinematics()
    frame = solver.add_frame_task(tip, poses[0])
    frame.configure(tip, "soft", 1.0, 1.0)
    solver.add_regularization_task(1e-6)
    solver.enable_joint_limits(True)
    spent = [0.0]

    def error(pose: np.ndarray) -> float:
        at = robot.get_T_world_frame(tip)
        turn = at[:3, :3].T @ pose[:3, :3]
        sine = 0.5 * (turn - turn.T)[[2, 0, 1], [1, 2, 0]]
        turned = np.arctan2(np.linalg.norm(sine), 0.5 * (np.trace(turn) - 1.0))
        return float(max(np.linalg.norm(at[:3, 3] - pose[:3, 3]), turned))

    def step(k: int) -> None:
        began = time.process_time()
        number, start = divmod(k, len(starts))
        for name, value in zip(names, starts[start], strict=True):
            robot.set_joint(name, float(value))
        robot.update_kinematics()
        frame.T_world_frame = poses[number]
        for _ in range(int(task["iterations"])):
            if error(poses[number]) <= 0.5 * float(task["tol"]):
                break
            try:
                solver.solve(True)
            except RuntimeError:  # no solution
                break
            robot.update_kinematics()
        spent[0] = time.process_time() - began

    # After the pose of the floating base.
    return step, lambda: np.append(robot.state.q[7:], spent)


if __name__ == "__main__":
    serve(make)
