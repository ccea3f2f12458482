"""Chunks of a policy, 16 postures at 30 Hz, a new one after each 8: chunks.py [so101|fr3].

`policy` and the last line of the loop stand for yours. The arm passes through the postures without
lag, and a chunk that does not begin where the last one led makes no jump: docs/policies.md.
"""

import sys

import numpy as np

import iiwa_dnn

SAMPLING = 1.0 / 30.0  # [s]
USED = 8  # samples of a chunk that are followed before the next one comes
SEAM = 0.03  # by which chunks do not meet [rad]
PERIODS = {"so101": 0.01, "fr3": 1e-3}  # [s]


def policy(t, start, random):
    """Return times (16,) [s] of the shield's clock and postures (16, n) [rad] from a time on."""
    times = t + SAMPLING * np.arange(16)
    waves = 0.3 * np.sin(times[:, np.newaxis] * np.linspace(1.0, 1.5, start.size))
    return times, start + waves + SEAM * random.uniform(-1.0, 1.0, start.size)


def run(name, duration):
    """Drive a simulated arm; return its path (N, n) [rad], largest lag [s] and distance [rad]."""
    robot = iiwa_dnn.load_robot(name)
    if name == "so101":  # whose maker publishes none
        robot = robot.with_limits(acceleration=10.0, jerk=200.0)
    shield = iiwa_dnn.Shield(robot, dt=PERIODS[name], obstacles=[])
    random = np.random.default_rng(0)
    start = q = robot.start_posture()
    shield.step(q, np.zeros(robot.dof))
    path = [q]
    found = []
    due = shield.time
    while shield.time < duration:
        if shield.time >= due:
            shield.follow(*policy(shield.time, start, random))
            due += USED * SAMPLING
        command = shield.step(q)  # encoders in
        found.append((command.late, command.off))
        q = q + shield.dt * command.dq  # here the drives take command.dq, or command.next_q
        path.append(q)
    return np.array(path), *np.max(found, axis=0)


if __name__ == "__main__":
    path, late, off = run(*(sys.argv[1:] or ["so101"]), duration=10.0)
    print(f"{len(path) - 1} periods, lag at most {late:.3f} s, off by at most {off:.3f} rad")
