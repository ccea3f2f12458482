"""An arm out of an MJCF file: the shield reads it, and MuJoCo moves it: mjcf_arm.py arm.xml [TIP].

Its actuators take joint positions, as those of MuJoCo Menagerie's arms do. MJCF has no limits of
velocity, acceleration and jerk: state your arm's.
"""

import argparse

import mujoco
import numpy as np

import iiwa_dnn

DT = 2e-3  # [s]
SPEED = 0.1  # of the tip [m/s]


def run(path, seconds, tip=None):
    """Push the tip around; return the robot, its path (N, n) [rad] and the goals (N, n) [rad]."""
    robot = iiwa_dnn.load_robot(path, tip=tip)
    robot = robot.with_limits(velocity=2.0, acceleration=10.0, jerk=500.0)
    shield = iiwa_dnn.Shield(robot, DT, obstacles=[])
    model = mujoco.MjModel.from_xml_path(str(path))
    model.opt.timestep = DT
    data = mujoco.MjData(model)
    joints = [model.joint(name) for name in robot.joint_names]
    drives = [list(model.actuator_trnid[:, 0]).index(joint.id) for joint in joints]
    places = [joint.qposadr[0] for joint in joints]
    goal = data.qpos[places] = data.ctrl[drives] = robot.start_posture()
    path, goals = [], []
    for k in range(round(seconds / DT)):
        turn = 2.0 * k * DT
        twist = [SPEED * np.cos(turn), SPEED * np.sin(turn), 0.0, 0.0, 0.0, 0.0]
        goal = shield.step(goal, twist=twist).next_q
        data.ctrl[drives] = goal
        mujoco.mj_step(model, data)
        path.append(data.qpos[places])
        goals.append(goal)
    return robot, np.array(path), np.array(goals)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("path", help="the MJCF file")
    parser.add_argument("tip", nargs="?", help="the frame that is pushed")
    options = parser.parse_args()
    robot, found, goals = run(options.path, 3.0, options.tip)
    print(f"{robot}\nat most {np.abs(found - goals).max():.3f} rad behind its goals")
