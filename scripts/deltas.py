"""Actions of a vision-language-action model (VLA) at 10 Hz: a step of the hand, and its gripper.

An action is dx, dy, dz [m] and a rotation vector [rad] along the base's axes, and the gripper's
opening from 0 to 1. Steps add up to a goal, so none is lost where the arm is slower for a while; a
limit that stops the arm does not let the goal run away. `policy` stands for yours.
"""

import numpy as np
import pinocchio as pin

import iiwa_dnn

DT = 1e-3  # [s]
RATE = 0.1  # between actions [s]
FARTHEST = 0.05  # of the goal from the hand [m]
GRIPPER_SPEED = 2.0  # [1/s]


def policy(k, random):
    """Return the action of a time step, (7,)."""
    step = np.concatenate([random.uniform(-0.01, 0.01, 3), random.uniform(-0.04, 0.04, 3)])
    return np.append(step, float(k % 20 < 10))


def run(actions):
    """Drive a simulated FR3; return its path (N, n) [rad] and the gripper's (N,)."""
    robot = iiwa_dnn.load_robot("fr3")
    shield = iiwa_dnn.Shield(robot, DT, obstacles=[], timeout=2.5 * RATE)
    q = robot.start_posture()
    hand = iiwa_dnn.Configuration(robot, q)
    position, rotation, gripper = hand.position, hand.rotation, 1.0
    path, opening = [q], [gripper]
    for action in actions:
        away = position - hand.position
        position = hand.position + away * min(1.0, FARTHEST / max(np.linalg.norm(away), 1e-9))
        position = position + action[:3]
        rotation = pin.exp3(action[3:6]) @ rotation
        for _ in range(round(RATE / DT)):
            hand = iiwa_dnn.Configuration(robot, q)
            turn = pin.log3(rotation @ hand.rotation.T)
            twist = np.concatenate([position - hand.position, turn]) / RATE
            command = shield.step(q, twist=twist)
            q = q + DT * command.dq  # here the drives take command.dq
            most = GRIPPER_SPEED * DT
            gripper += np.clip(action[6] - gripper, -most, most)  # and the gripper this
            path.append(q)
            opening.append(gripper)
    return np.array(path), np.array(opening)


if __name__ == "__main__":
    random = np.random.default_rng(0)
    path, opening = run([policy(k, random) for k in range(60)])
    print(f"{len(path) - 1} periods, at the end {path[-1].round(3)} rad, gripper {opening[-1]:.2f}")
