"""A control loop at 1 kHz: encoders in, joint velocities out.

One sees the time of a step, which has to be far below the period, and the tracking error. A real
robot takes the places of `read_encoders` and `send`; everything else stays as it is.
"""

import sys
import time

import numpy as np
import tyro

import iiwa_dnn
from iiwa_dnn import checks
from iiwa_dnn.app.command_line import run_script

DT = 1e-3  # control period [s]


class Arm:
    """A simulated arm that moves as it is told; replace it by the driver of a real one."""

    def __init__(self, q):
        self.q = np.array(q, dtype=float)

    def read_encoders(self):
        """Return the joint positions [rad], (n,)."""
        return self.q.copy()

    def send(self, dq):
        """Command the joint velocities [rad/s], (n,), for one period."""
        self.q += DT * dq


def main(steps: tyro.conf.Positional[int] = 1000):
    """Draw the heart's first steps in real time; 1 where a command was not a solved one."""
    checks.integer("steps", steps, 1)
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(lower=-2.5, upper=2.5)
    arm = Arm([-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0])
    start = iiwa_dnn.Configuration(robot, arm.q)
    heart = iiwa_dnn.Heart(period=10.0).anchored(start)
    controller = iiwa_dnn.Controller(robot, iiwa_dnn.DoubleIndicator(), heart, dt=DT)
    controller.warm_up()  # compiles, so that the first step is as quick as the others
    times = []
    errors = []
    began = time.perf_counter()
    for k in range(steps):
        time.sleep(max(0.0, began + k * DT - time.perf_counter()))
        q = arm.read_encoders()
        asked = time.perf_counter()
        command = controller.step(q, k * DT)
        times.append(1e6 * (time.perf_counter() - asked))
        if not command.ok:
            print(f"step {k}: {command}")
            return 1
        arm.send(command.dq)
        tip = iiwa_dnn.Configuration(robot, arm.q).position
        errors.append(np.linalg.norm(tip - heart.at((k + 1) * DT).position))
    print(f"step: median {np.median(times):.1f} us, p99 {np.percentile(times, 99):.1f} us")
    print(f"tracking error: largest {max(errors):.2e} m")
    return 0


if __name__ == "__main__":
    sys.exit(run_script(main))
