"""Strict priorities: the heart first, then the tool's direction, then three joints.

Eight rows for seven joints. Each level is a program of its own, which may not change what the
levels above it have attained.

Source: O. Kanoun, F. Lamiraux, P.-B. Wieber, "Kinematic control of redundant manipulators:
generalizing the task-priority framework to inequality task", IEEE Trans. Robotics 27 (2011).
"""

import sys

import numpy as np
import tyro
from qpsolvers import Problem

import iiwa_dnn
from iiwa_dnn.app.command_line import run_script

START = [-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0]  # [rad]
HELD = ("iiwa7_joint_3", "iiwa7_joint_5", "iiwa7_joint_7")


def resolve(programs):
    """Solve one program after the other; return the last answer and each level's residual."""
    n = programs[0].q.size
    A = np.zeros((0, n))  # rows of the levels above, and what they have attained
    b = np.zeros(0)
    residuals = []
    for qp in programs:
        P = qp.A.T @ qp.A
        x = iiwa_dnn.solve_problem(Problem(P, -qp.A.T @ qp.b, A=A, b=b, lb=qp.lb, ub=qp.ub)).x
        residuals.append(np.abs(qp.A @ x - qp.b).max())
        A = np.vstack([A, qp.A])
        b = A @ x
    return x, residuals


def main(duration: tyro.conf.Positional[float] = 4.0, dt: tyro.conf.Positional[float] = 1e-3):
    """Draw the heart in `duration` seconds; 1 where a level that has room does not hold."""
    robot = iiwa_dnn.load_robot("iiwa7")
    start = iiwa_dnn.Configuration(robot, START)
    levels = {
        "position": iiwa_dnn.PositionTask(),
        "direction": iiwa_dnn.AxisTask(direction=start.rotation[:, 2]),
        "joints": iiwa_dnn.PostureTask(dict.fromkeys(HELD, 0.3), gain=1.0),
    }
    schemes = [iiwa_dnn.Scheme([], [task], [iiwa_dnn.JointLimits()]) for task in levels.values()]
    heart = iiwa_dnn.Heart(period=duration).anchored(start)
    q = np.array(START)
    found = []
    for k in range(round(duration / dt)):
        conf = iiwa_dnn.Configuration(robot, q)
        target = heart.at(k * dt)
        dq, residuals = resolve([scheme.build_qp(conf, target, dt) for scheme in schemes])
        found.append(residuals)
        q = q + dt * dq
    largest = np.max(found, axis=0)
    for level, name in enumerate(levels):
        print(f"level {level + 1}, {name}: residual at most {largest[level]:.3g}")
    return int(largest[:2].max() > 1e-8)


if __name__ == "__main__":
    sys.exit(run_script(main))
