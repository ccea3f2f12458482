"""A limit of one's own beside built-in parts: the elbow keeps 0.20 m from a point.

One sees that the elbow comes as near as it may while the tip draws the heart and ProxQP agrees. The
limit is a velocity damper: with the distance d of the elbow from the point and the unit vector n
away from it, d shrinks no faster than gain (d - distance), which is one row of G x <= h:
-n^T J dq <= gain (d - distance).
"""

import sys

import numpy as np
import tyro

import iiwa_dnn
from iiwa_dnn.app.command_line import run_script

START = [-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0]  # [rad]
ELBOW = "iiwa7_link_4"
POINT = np.array([0.36, 0.16, 0.64])  # [m]; without the limit the elbow comes 1.5 cm nearer


class Clearance(iiwa_dnn.Limit):
    """A frame's least distance [m] from a point [m]; gain [1/s] of the approach."""

    rows = 1

    def __init__(self, frame, point, distance, gain=20.0):
        self.frame = frame
        self.point = point
        self.distance = distance
        self.gain = gain

    def inequalities(self, step):
        """Return G (1, n) and h (1,)."""
        frame = step.frame(self.frame)
        away = frame.position - self.point
        distance = np.sqrt(away @ away)
        G = -(away / distance)[np.newaxis] @ frame.jacobian[:3]
        return G, np.array([self.gain * (distance - self.distance)])


def scheme(*limits):
    """Compose the paper's scheme of its parts, with further limits."""
    return iiwa_dnn.Scheme(
        costs=[iiwa_dnn.KineticEnergy(weight=0.2), iiwa_dnn.CyclicMotion(weight=0.8)],
        tasks=[iiwa_dnn.PositionTask(), iiwa_dnn.OrientationTask()],
        limits=[iiwa_dnn.JointLimits(), *limits],
    )


def main(duration: tyro.conf.Positional[float] = 10.0, dt: tyro.conf.Positional[float] = 1e-3):
    """Draw the heart in `duration` seconds; 1 where a check failed or the elbow came too near."""
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(lower=-2.5, upper=2.5)
    heart = iiwa_dnn.Heart(period=duration).anchored(iiwa_dnn.Configuration(robot, START))
    clearance = Clearance(ELBOW, POINT, 0.20)
    record = iiwa_dnn.simulate(robot, scheme(clearance), heart, START, dt=dt)
    elbow = [iiwa_dnn.Configuration(robot, q).frame(ELBOW).position for q in record.q]
    nearest = np.linalg.norm(elbow - POINT, axis=1).min()
    failures = iiwa_dnn.failures(record)
    active = int((record.row_multiplier[:, 0] > 0.0).sum())
    print(f"smallest distance {nearest:.6f} m, limit active in {active} of {record.steps} steps")
    print(f"failures {failures}")
    return int(bool(failures) or nearest < 0.1999)


if __name__ == "__main__":
    sys.exit(run_script(main))
