"""A limit and a task of one's own beside built-in parts, both of the elbow.

First the elbow keeps 0.20 m from a point while the tip draws the heart: one sees that it comes as
near as it may and that ProxQP agrees. Then it swings by half a radian while the tool rests. The
limit is a velocity damper: with the distance d of the elbow from the point and the unit vector n
away from it, d shrinks no faster than gain (d - distance), which is one row of G x <= h:
-n^T J dq <= gain (d - distance).

Source of the task: K. Kreutz-Delgado, M. Long, H. Seraji, "Kinematic analysis of 7-DOF
manipulators", Int. J. Robotics Research 11 (1992).
"""

import sys

import numpy as np
import tyro

import iiwa_dnn
from iiwa_dnn.app.command_line import run_script

START = [-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0]  # [rad]
ELBOW = "iiwa7_link_4"
JOINTS = ("iiwa7_joint_2", "iiwa7_joint_4", "iiwa7_joint_6")
UP = np.array([0.0, 0.0, 1.0])
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


class ElbowAngle(iiwa_dnn.Task):
    """Angle [rad] of the plane of shoulder, elbow and wrist about its long side, from upwards."""

    rows = 1
    tracks = False

    def __init__(self, angle, gain=1.0):
        self.angle = angle
        self.gain = gain

    def equations(self, step):
        """Return A (1, n) and b (1,)."""
        shoulder, elbow, wrist = (step.frame(name) for name in JOINTS)
        angle, by_elbow, by_wrist = swivel(
            elbow.position - shoulder.position, wrist.position - shoulder.position
        )
        A = by_elbow @ (elbow.jacobian - shoulder.jacobian)[:3]
        A += by_wrist @ (wrist.jacobian - shoulder.jacobian)[:3]
        missing = np.remainder(self.angle - angle + np.pi, 2.0 * np.pi) - np.pi
        return A[np.newaxis], np.array([self.gain * missing])


def swivel(u, d):
    """Compute the angle about d (3,) from upwards to u (3,), and its gradients to u and d."""
    length = np.linalg.norm(d)
    w = d / length
    across = u - (w @ u) * w
    zero = UP - (w @ UP) * w
    angle = np.arctan2(w @ np.cross(zero, across), zero @ across)
    by_u = np.cross(w, across) / (across @ across)
    by_w = (w @ UP) / (zero @ zero) * np.cross(w, zero) - (w @ u) * by_u
    return angle, by_u, (by_w - (by_w @ w) * w) / length


def elbow_angle(robot, q):
    """Compute the elbow's angle [rad] at joint positions q (n,) [rad]."""
    conf = iiwa_dnn.Configuration(robot, q)
    shoulder, elbow, wrist = (conf.frame(name).position for name in JOINTS)
    return swivel(elbow - shoulder, wrist - shoulder)[0]


def swing(dt):
    """Turn the elbow by half a radian while the tool rests; return the record and the turn."""
    robot = iiwa_dnn.load_robot("iiwa7")
    start = robot.start_posture()
    still = iiwa_dnn.Still(period=8.0).anchored(iiwa_dnn.Configuration(robot, start))
    first = elbow_angle(robot, start)
    tasks = [iiwa_dnn.PoseTask(), ElbowAngle(first + 0.5)]
    turning = iiwa_dnn.Scheme([iiwa_dnn.KineticEnergy()], tasks, [iiwa_dnn.JointLimits()])
    record = iiwa_dnn.simulate(robot, turning, still, start, dt=dt)
    return record, elbow_angle(robot, record.q[-1]) - first


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
    swung, turned = swing(dt)
    failures = iiwa_dnn.failures(record) + iiwa_dnn.failures(swung)
    active = int((record.row_multiplier[:, 0] > 0.0).sum())
    print(f"smallest distance {nearest:.6f} m, limit active in {active} of {record.steps} steps")
    print(f"elbow turned by {turned:.4f} rad, failures {failures}")
    return int(bool(failures) or nearest < 0.1999)


if __name__ == "__main__":
    sys.exit(run_script(main))
