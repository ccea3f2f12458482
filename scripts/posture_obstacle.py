"""A second paper: a six-joint arm keeps its tool's tilt and avoids a point, four programs.

    python scripts/posture_obstacle.py [DT [SECONDS]]

Source: "End-Effector Posture-Maintaining and Obstacle-Limits Avoidance Schemes for Redundant Robot
Manipulators", IEEE Transactions on Industrial Informatics, document 8737741, and its authors'
files, which docs/papers.md names. The programs have no cost: the network moves x within the range
of the rows alone, and so takes the velocity nearest to the last one.
"""

import sys
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import tyro

import iiwa_dnn
from iiwa_dnn.app.command_line import run_script
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.configuration import FrameState

START = tuple(np.deg2rad([-262.6, 170.0, 176.0, 228.0, -76.0, 238.0]).tolist())  # kinova1.m
CIRCLE = iiwa_dnn.Circle(radius=0.12, period=10.0, begin=0.0)  # kinovaNet.m
OBSTACLE = (-0.05, -0.4, 0.28)  # the point [m]
OUTER = 0.10  # distance d2 at which its rows begin [m]
INNER = 0.05  # distance d1 where approach ends [m]

VARIANTS = {"UOA-UPF": (0, False), "AOA-UPF": (0, True), "AOA-2PF": (2, True), "AOA-3PF": (3, True)}
"""Rows of posture and whether the point is avoided, in the order of QALL1.mat to QALL4.mat."""

RECORDED = {
    "UOA-UPF": (0.461384, 0.00295465),
    "AOA-UPF": (2.06033, 0.0759833),
    "AOA-2PF": (0.0144952, 0.0839312),
    "AOA-3PF": (2.45492e-4, 0.0689699),
}
"""Largest posture error [rad] and least distance [m] of the authors, QALL1.mat to QALL4.mat."""

_FOREARM = 0.2073
_WRIST = 0.0741
_BEND = 0.5 / np.cos(np.pi / 6.0)
_LINKS = ("base", *(f"link_{i}" for i in range(1, 7)))
_ALONG = (0.0, 0.0, 0.0, -_FOREARM, -0.07433 * _BEND, -0.07433 * _BEND, 0.0)  # positionN.m


def arm() -> Robot:
    """Build the arm, a Kinova, from the Denavit-Hartenberg parameters of kinova1.m."""
    turn = np.pi
    table = [
        (0.0, turn / 2, 0.2755, 0.0),
        (0.41, turn, 0.0, 0.0),
        (0.0, turn / 2, -0.0098, 0.0),
        (0.0, turn / 3, -_FOREARM - _BEND * _WRIST, 0.0),
        (0.0, turn / 3, -2.0 * _BEND * _WRIST, 0.0),
        (0.0, turn, -_BEND * _WRIST - 0.1425, 0.0),
    ]
    lower = np.full(6, -np.inf)
    lower[1:3] = np.deg2rad([-43.0, 109.0])
    upper = np.full(6, np.inf)
    upper[1:3] = np.deg2rad([223.0, 431.0])
    return iiwa_dnn.robot_from_dh(table, lower=lower, upper=upper, velocity=1.5, name="kinova_tii")


@dataclass(frozen=True)
class Posture(iiwa_dnn.Task):
    r"""Tilt of the tool kept: the vertical, seen from the tool, does not move.

    With the columns :math:`c_k` of the tip's rotation, row k of 2 or 3 says
    :math:`(c_k \times e_z)^T J_\omega \dot q = 0` (JacobN.m). Three rows have rank two.
    """

    rows: int = 3

    def equations(self, step: iiwa_dnn.Step) -> tuple[Matrix, Vector]:
        """Return A (rows, n) and b (rows,)."""
        tip = step.frame()
        x, y, _ = tip.rotation  # its rows: entries of the three columns
        A = np.column_stack([y, -x, np.zeros(3)]) @ tip.jacobian[3:]
        return A[: self.rows], np.zeros(self.rows)


@dataclass(frozen=True)
class PointAvoidance(iiwa_dnn.Limit):
    r"""Three rows for each link that is nearer to the point than d2, as the authors wrote them.

    With the nearest point c of the link, its Jacobian J and :math:`S = \mathrm{diag}\,
    \mathrm{sign}(c - o)` they are :math:`-S J \dot q \le a (d - d_1) / (d_2 - d_1)`, where a is
    :math:`\max(-S J \dot q, 0)` of the last step that met d2; one object serves one run. Idle
    rows stand last. Source: JObstacleN.m, whose J of links 3 to 6 is that of a point on their own
    joint's axis (docs/papers.md).
    """

    rows: int = field(default=18, init=False)
    approach: Any = field(default_factory=lambda: np.zeros((6, 3)), init=False, repr=False)

    def inequalities(self, step: iiwa_dnn.Step) -> tuple[Matrix, Vector]:
        """Return G (18, n) and h (18,)."""
        G: list[Matrix] = []
        h: list[Vector] = []
        frames = [step.frame(name) for name in _LINKS]
        critical, distance = nearest_points(frames)
        for i, d in enumerate(distance):
            if d > OUTER:
                self.approach[i] = 0.0
                continue
            rows = -np.sign(critical[i] - OBSTACLE)[:, None] * self.jacobian(frames, critical, i)
            scale = 1.0
            if abs(d - OUTER) <= 1e-3 * OUTER:
                self.approach[i] = np.maximum(rows @ step.dq, 0.0)
            else:
                scale = max(d - INNER, 0.0) / (OUTER - INNER)
            G.append(rows)
            h.append(scale * self.approach[i])
        idle = np.zeros((18 - 3 * len(G), step.q.size))
        return np.vstack([*G, idle]), np.concatenate([*h, np.zeros(len(idle))])

    def jacobian(self, frames: list[FrameState], critical: Matrix, i: int) -> Matrix:
        """Return the authors' Jacobian (3, n) of the nearest point of link i + 1."""
        frame = frames[i + 1]
        point = critical[i]
        if i > 1:
            frame = frames[i]
            axis = frame.rotation[:, 2]
            length = np.linalg.norm(point - frame.position - _ALONG[i] * axis)
            point = frame.position + length * axis
        spin = np.cross(point - frame.position, frame.jacobian[3:], axisb=0).T
        return frame.jacobian[:3] - spin


def nearest_points(frames: Iterable[FrameState]) -> tuple[Matrix, Vector]:
    """Find the point of each link nearest to the obstacle, (6, 3) [m], and its distance, (6,)."""
    ends = zip(frames, _ALONG, strict=True)
    joints = np.array([f.position + along * f.rotation[:, 2] for f, along in ends])
    span = np.diff(joints, axis=0)
    offset = OBSTACLE - joints[:-1]
    along = np.clip((offset * span).sum(axis=1) / (span * span).sum(axis=1), 0.0, 1.0)
    points = joints[:-1] + along[:, None] * span
    return points, np.linalg.norm(points - OBSTACLE, axis=1)


def run(variant: str, dt: float = 5e-4, duration: float = 10.0) -> Any:
    """Run one of `VARIANTS` through the authors' network, mu = 1e4, never settled."""
    rows, avoids = VARIANTS[variant]
    tasks = [iiwa_dnn.PositionTask(gain=0.0), *([Posture(rows)] if rows else [])]
    limits = [iiwa_dnn.JointLimits(gain=0.25), *([PointAvoidance()] if avoids else [])]
    robot = arm()
    return iiwa_dnn.simulate(
        robot,
        iiwa_dnn.Scheme([], tasks, limits),
        CIRCLE.anchored(iiwa_dnn.Configuration(robot, START)),
        START,
        dt=dt,
        duration=duration,
        mode="continuous",
        check=iiwa_dnn.CrossCheck(()),
        solver=iiwa_dnn.DNNSolver(iiwa_dnn.PrimalDualNetwork(rho=1e-4)),
    )


def over_time(q: Matrix) -> tuple[Vector, Vector]:
    """Compute distance from the point [m] and tilt of the tool [rad], (N,) each, of q (N, 6)."""
    robot = arm()
    at = [iiwa_dnn.Configuration(robot, row) for row in q]
    distance = [nearest_points(map(conf.frame, _LINKS))[1].min() for conf in at]
    chord = np.linalg.norm([conf.rotation[2] - at[0].rotation[2] for conf in at], axis=1)
    return np.array(distance), 2.0 * np.arcsin(0.5 * chord)


def main(dt: tyro.conf.Positional[float] = 5e-4, duration: tyro.conf.Positional[float] = 10.0):
    """Run the four variants in steps of dt [s]; print distance and posture error beside theirs."""
    for variant, theirs in RECORDED.items():
        record = run(variant, dt, duration)
        distance, posture = over_time(record.q[:: max(1, round(1e-3 / dt))])
        ours = (posture.max(), distance.min())
        for name, (error, nearest) in (("authors", theirs), ("ours", ours)):
            print(f"{variant} {name}: posture error {error:.1e} rad, distance {nearest:.4f} m")


if __name__ == "__main__":
    sys.exit(run_script(main))
