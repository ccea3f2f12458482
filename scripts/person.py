"""A person walks through the cell of an arm that swings to and fro: it rests before it is touched.

A camera at 30 Hz tells where people are, 0.1 s late; `camera` stands for yours. No certified safety
function: docs/people.md.
"""

import numpy as np

import iiwa_dnn

DT = 4e-3  # [s]
AGE = 0.1  # of what the camera has seen [s]
FRAMES = 8  # periods between two of them
FIELD = 2.5  # [m]
RADIUS = 0.3  # of a person's trunk with the error [m]


def person(t):
    """Return both ends [m] of somebody who comes to the arm at 1.2 m/s, stands, and goes back."""
    x = np.interp(t, [0.0, 2.2, 4.0, 6.2], [3.0, 0.4, 0.4, 3.0])
    return np.array([x, 0.0, 0.2]), np.array([x, 0.0, 1.6])


def camera(t):
    """Return everybody in the field as step(people=) takes them."""
    a, b = person(t - AGE)
    return [(a, b, RADIUS)] if a[0] - RADIUS < FIELD else []


def run(duration):
    """Drive a simulated arm; return its path (N, n) [rad]."""
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(jerk=500.0)
    shield = iiwa_dnn.Shield(robot, DT, obstacles=[], people=1, field=FIELD)
    start = q = np.array([0.0, 0.5, 0.0, -1.2, 0.0, 1.0, 0.0])  # [rad]
    path = [q]
    for k in range(round(duration / DT)):
        t = k * DT
        goal = start + [0.6 * np.sign(np.sin(2.0 * t)), 0, 0, 0, 0, 0, 0]
        seen = {"people": camera(t), "age": AGE} if k % FRAMES == 0 else {}
        command = shield.step(q, position=goal, **seen)
        q = q + DT * command.dq  # here the drives take command.dq
        path.append(q)
    return np.array(path)


if __name__ == "__main__":
    speed = np.abs(np.diff(run(8.0), axis=0)).max(axis=1) / DT
    print(f"at rest for {DT * (speed < 1e-3).sum():.1f} of 8 s, the person nearest from 2.2 to 4 s")
