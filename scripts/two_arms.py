"""Two arms whose hands are asked to the same point: a loop of your own, and one shield for both.

The request is a joint velocity by damped least squares, which knows of no limit and no other arm.
"""

import numpy as np

import iiwa_dnn

HANDS = ("left_iiwa7_flange", "right_iiwa7_flange")
GAIN = 2.0  # [1/s]
DAMPING = 0.05  # [m/rad]


def ask(conf, goal):
    """Return the joint velocity (n,) [rad/s] that leads both hands to a point [m]."""
    hands = [conf.frame(name) for name in HANDS]
    J = np.vstack([hand.jacobian[:3] for hand in hands])
    v = np.concatenate([GAIN * (goal - hand.position) for hand in hands])
    return J.T @ np.linalg.solve(J @ J.T + DAMPING**2 * np.eye(6), v)


def run(steps, dt=2e-3):
    """Drive both arms; return their path (N, n) [rad] and the last command."""
    robot = iiwa_dnn.load_robot("iiwa7_dual").with_limits(jerk=500.0)
    shield = iiwa_dnn.Shield(robot, dt, obstacles=[], distance=0.03)
    q = robot.start_posture()
    conf = iiwa_dnn.Configuration(robot, q)
    goal = np.mean([conf.frame(name).position for name in HANDS], axis=0)
    path = [q]
    for _ in range(steps):
        command = shield.step(q, ask(iiwa_dnn.Configuration(robot, q), goal))
        q = q + dt * command.dq  # here each arm's drives take their half of command.dq
        path.append(q)
    return np.array(path), command


if __name__ == "__main__":
    _, command = run(2000)
    print(f"nearest pair {command.margin.distance + 0.03:.3f} m, by {command.active_limits[:2]}")
