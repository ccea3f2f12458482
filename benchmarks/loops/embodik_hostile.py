"""Hostile twists through EmbodiK's velocity solver: ``python embodik_hostile.py URDF [STEPS]``.

In an environment of its own: ``pip install embodik==0.23.2``. Six runs at 2 ms, each among twists
that jump every 0.1 s; finite differences judge position, velocity and acceleration, as
tests/judge_limits.py does. A step without an answer holds the arm still.
"""

import json
import sys
from collections import Counter

import embodik
import numpy as np

DT = 2e-3
RUNS = 6
ACCELERATION = 10.0
START = np.array([-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0])


def run(urdf: str, steps: int, seed: int) -> Counter[str]:
    """Drive one run; count broken limits, and answers by their status."""
    random = np.random.default_rng(seed)
    robot = embodik.RobotModel(urdf)
    n = robot.nv
    robot.set_acceleration_limits(np.full(n, ACCELERATION))
    lower, upper = (np.array(limit) for limit in robot.get_joint_limits())
    speed = np.array(robot.get_velocity_limits())
    solver = embodik.KinematicsSolver(robot)
    solver.dt = DT
    solver.enable_position_limits(True)
    solver.enable_velocity_limits(True)
    solver.enable_acceleration_limits(True)
    solver.set_acceleration_limits(np.full(n, ACCELERATION))
    tip = [name for name in robot.get_frame_names() if "flange" in name or "link_7" in name][-1]
    task = solver.add_frame_task("tip", tip)
    q, dq = START.copy(), np.zeros(n)
    path = [q]
    found: Counter[str] = Counter()
    twist = np.zeros(6)
    for k in range(steps):
        if k % 50 == 0:
            twist = random.choice([0.1, 1.0, 5.0]) * random.standard_normal(6)
        task.set_target_velocity(twist)
        solver.set_previous_joint_velocities(dq)
        answer = solver.solve_velocity(q, True)
        found[answer.status.name] += 1
        done = answer.status == embodik.SolverStatus.SUCCESS
        dq = np.array(answer.joint_velocities) if done else np.zeros(n)
        q = q + DT * dq
        path.append(q)
    driven = np.vstack([path[:1], path[:1], path])
    excess = {
        "position": np.maximum(driven - upper, lower - driven).max(),
        "velocity": (np.abs(np.diff(driven, axis=0)) / DT - speed).max(),
        "acceleration": (np.abs(np.diff(driven, 2, axis=0)) / DT**2 - ACCELERATION).max(),
    }
    found.update({f"{name} broken": 1 for name, most in excess.items() if most > 1e-6})
    jerk = np.abs(np.diff(driven, 3, axis=0)).max() / DT**3
    found["largest jerk rad/s^3"] = round(jerk)
    return found


if __name__ == "__main__":
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 1000
    for number in range(RUNS):
        print(json.dumps(run(sys.argv[1], count, number)), flush=True)
