"""A control loop at 1 kHz: encoders in, joint velocities out.

A real robot takes the places of `read_encoders` and `send`. With noise of the encoders or drives
that are late, an estimator knows where the arm is when the command begins; with a jerk limit the
arm takes a while to reach the speed of the path.
"""

import math
import sys
import time

import numpy as np
import tyro

import iiwa_dnn
from iiwa_dnn import checks
from iiwa_dnn.app.command_line import run_script
from iiwa_dnn.simulation.estimation import JointEstimator, NoiseModel

DT = 1e-3  # control period [s]
ACCELERATION = 10.0  # limit of every joint beside a jerk limit [rad/s^2]


class Arm:
    """A simulated arm that moves as commanded; replace it by the driver of a real one."""

    def __init__(self, q, noise, delay_periods):
        self.q = np.array(q, dtype=float)
        self.noise = noise
        self.late = [np.zeros(self.q.size)] * delay_periods  # commands on their way to the drives
        self.random = np.random.default_rng(0)

    def read_encoders(self):
        """Return the joint positions [rad], (n,)."""
        return self.q + self.noise * self.random.standard_normal(self.q.size)

    def send(self, dq):
        """Command the joint velocities [rad/s], (n,), for one period."""
        self.late.append(dq)
        self.q += DT * self.late.pop(0)


def main(
    steps: tyro.conf.Positional[int] = 1000,
    noise: float = 0.0,
    jerk: float = math.inf,
    delay_periods: int = 0,
):
    """Draw the heart's first steps in real time; 1 where the arm cannot follow.

    Args:
        steps: number of steps
        noise: standard deviation of the encoders' noise [rad]
        jerk: jerk limit of every joint [rad/s^3], beside an acceleration limit of 10 rad/s^2
        delay_periods: number of periods by which the drives are late
    """
    checks.integer("steps", steps, 1)
    checks.not_negative("noise", noise)
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(lower=-2.5, upper=2.5)
    limits = ()
    gain = 10.2  # [1/s]
    if jerk < math.inf:
        robot = robot.with_limits(acceleration=ACCELERATION, jerk=jerk)
        limits = (iiwa_dnn.AccelerationLimits(), iiwa_dnn.JerkLimits())
        # A loop with these limits is stable below 1 / (acceleration / jerk + dt): docs/limits.md
        gain = min(gain, 0.9 / (ACCELERATION / jerk + DT))
    model = NoiseModel(velocity=1e-3, measurement=noise or 1e-6, delay_periods=delay_periods)
    estimator = JointEstimator(model, DT)
    arm = Arm([-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0], noise, delay_periods)
    start = iiwa_dnn.Configuration(robot, arm.q)
    heart = iiwa_dnn.Heart(period=10.0).anchored(start)
    scheme = iiwa_dnn.DoubleIndicator(
        position_gain=gain, orientation_gain=gain, extra_limits=limits
    )
    controller = iiwa_dnn.Controller(robot, scheme, heart, dt=DT)
    controller.warm_up(arm.q)  # lays the step out, so that the first one is as quick as the others
    times = []
    errors = []
    began = time.perf_counter()
    for k in range(steps):
        time.sleep(max(0.0, began + k * DT - time.perf_counter()))
        q = arm.read_encoders()
        asked = time.perf_counter()
        if noise or delay_periods:
            q = estimator.update(q)
        command = controller.step(q, (k + delay_periods) * DT)  # when the drives begin it
        times.append(1e6 * (time.perf_counter() - asked))
        if not (command.ok or command.limited):
            print(f"step {k}: {command}")
            return 1
        if noise or delay_periods:
            estimator.predict(command.dq)
        arm.send(command.dq)
        tip = iiwa_dnn.Configuration(robot, arm.q).position
        errors.append(np.linalg.norm(tip - heart.at((k + 1) * DT).position))
    print(f"step: median {np.median(times):.1f} us, p99 {np.percentile(times, 99):.1f} us")
    print(f"tracking error: largest {max(errors):.2e} m")
    return 0


if __name__ == "__main__":
    sys.exit(run_script(main))
