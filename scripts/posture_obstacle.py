r"""A second paper: a six-joint arm keeps its tool's tilt and avoids a point, four programs.

One sees the table of docs/papers.md and its figure, the programs beside the authors' own
runs. With the folder of the authors' files QALL1.mat to QALL4.mat as fourth argument, their joint
angles are compared one by one as well.

    python scripts/posture_obstacle.py [FOLDER [DT [SECONDS [AUTHORS]]]]

Source: "End-Effector Posture-Maintaining and Obstacle-Limits Avoidance Schemes for Redundant Robot
Manipulators", IEEE Transactions on Industrial Informatics, document 8737741, and its authors'
files, which docs/papers.md names. The programs have no cost: the network moves x within
the range of the rows alone, and so takes the velocity nearest to the last one.
"""

import sys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import tyro
from scipy.io import loadmat

from iiwa_dnn.app.command_line import run_script
from iiwa_dnn.networks import PrimalDualNetwork
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.references import Circle
from iiwa_dnn.results.markdown import markdown_table
from iiwa_dnn.results.plots import DOUBLE_COLUMN, new_figure, write_figures
from iiwa_dnn.results.record import Record
from iiwa_dnn.robot import Configuration, Robot, robot_from_dh
from iiwa_dnn.robot.configuration import FrameState
from iiwa_dnn.schemes import JointLimits, Limit, PositionTask, Scheme, Step, Task
from iiwa_dnn.simulation import simulate

START = tuple(np.deg2rad([-262.6, 170.0, 176.0, 228.0, -76.0, 238.0]).tolist())
"""theta(0) [rad], kinova1.m."""

CIRCLE = Circle(radius=0.12, period=10.0)
"""The path, kinovaNet.m."""

OBSTACLE = (-0.05, -0.4, 0.28)
"""The point [m]."""

OUTER = 0.10
"""The distance d2 [m] at which its rows begin."""

INNER = 0.05
"""The distance d1 [m] where approach ends."""

VARIANTS = {"UOA-UPF": (0, False), "AOA-UPF": (0, True), "AOA-2PF": (2, True), "AOA-3PF": (3, True)}
"""Rows of posture and whether the point is avoided, in the order of QALL1.mat to QALL4.mat."""

RECORDED = {
    "UOA-UPF": (2.90564, 3.15811, 2.59558, 3.07178, 1.6854e-4, 0.461384, 0.00295465),
    "AOA-UPF": (2.59698, 3.00789, 2.82890, 3.71595, 2.4755e-4, 2.06033, 0.0759833),
    "AOA-2PF": (2.95442, 2.99309, 2.53555, 3.46471, 1.8271e-4, 0.0144952, 0.0839312),
    "AOA-3PF": (2.95467, 2.99202, 2.50800, 3.52365, 2.1562e-4, 2.45492e-4, 0.0689699),
}
"""What `measure` finds in the authors' joint angles, QALL1.mat to QALL4.mat."""

ANGLE = 0.05
"""Largest difference of angles that `judge` calls reproduced [rad]."""

FACTOR = 2.0
"""Largest factor between other numbers that it calls reproduced."""

PATH = 1e-3
"""Path error below which the path is kept [m]."""

POSTURE = np.deg2rad(1.0)
"""Posture error below which the posture is kept [rad]."""

_UPPER_ARM = 0.41
_FOREARM = 0.2073
_WRIST = 0.0741
_HAND = 0.1425
_SHIFT = 0.0098
_BEND = 0.5 / np.cos(np.pi / 6.0)
_LINKS = ("base", *(f"link_{i}" for i in range(1, 7)))
_ALONG = (0.0, 0.0, 0.0, -_FOREARM, -0.07433 * _BEND, -0.07433 * _BEND, 0.0)  # positionN.m


def arm() -> Robot:
    """Build the arm, a Kinova, from the Denavit-Hartenberg parameters of kinova1.m."""
    turn = np.pi
    table = [
        (0.0, turn / 2, 0.2755, 0.0),
        (_UPPER_ARM, turn, 0.0, 0.0),
        (0.0, turn / 2, -_SHIFT, 0.0),
        (0.0, turn / 3, -_FOREARM - _BEND * _WRIST, 0.0),
        (0.0, turn / 3, -2.0 * _BEND * _WRIST, 0.0),
        (0.0, turn, -_BEND * _WRIST - _HAND, 0.0),
    ]
    lower = np.full(6, -np.inf)
    lower[1:3] = np.deg2rad([-43.0, 109.0])
    upper = np.full(6, np.inf)
    upper[1:3] = np.deg2rad([223.0, 431.0])
    return robot_from_dh(table, lower=lower, upper=upper, velocity=1.5, name="kinova_tii")


@dataclass(frozen=True)
class Posture(Task):
    r"""Tilt of the tool kept: the vertical, seen from the tool, does not move.

    With the columns :math:`c_k` of the tip's rotation, row k says
    :math:`(c_k \times e_z)^T J_\omega \dot q = 0`. Three rows have rank two: a turn about the
    vertical stays free, and two rows ask the same as three unless :math:`e_z^T c_3 = 0`.

    Source: JacobN.m, which takes the third row of the rotation, not its third column.

    Attributes:
        rows: 2 or 3.
    """

    rows: int = 3

    def equations(self, step: Step) -> tuple[Matrix, Vector]:
        """Return A (rows, n) and b (rows,)."""
        tip = step.frame()
        x, y, _ = tip.rotation  # its rows: entries of the three columns
        A = np.column_stack([y, -x, np.zeros(3)]) @ tip.jacobian[3:]
        return A[: self.rows], np.zeros(self.rows)


@dataclass(frozen=True)
class PointAvoidance(Limit):
    r"""Three rows for each link that is nearer to the point than d2, as the authors wrote them.

    With the nearest point c of the link, its Jacobian J and :math:`S = \mathrm{diag}\,
    \mathrm{sign}(c - o)`, the rows are

    .. math::

        -S J \dot q \le \frac{d - d_1}{d_2 - d_1}\, a, \qquad a = \max(-S J \dot q, 0)
        \text{ when } |d - d_2| \le 10^{-3} d_2 \text{ was last true.}

    a is 0 where no step met that shell, and is kept between steps: one object serves one run.
    Idle rows are 0 <= 0 and stand last, so that a link's rows move when another one comes near.

    Source: JObstacleN.m. Its J of links 3 to 6 is wrong: that of a point on the axis of their own
    joint, which therefore does not move it (docs/papers.md).
    """

    rows: int = field(default=18, init=False)
    approach: Any = field(default_factory=lambda: np.zeros((6, 3)), init=False, repr=False)

    def inequalities(self, step: Step) -> tuple[Matrix, Vector]:
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
        result: Matrix = frame.jacobian[:3] - spin
        return result


def nearest_points(frames: Iterable[FrameState]) -> tuple[Matrix, Vector]:
    """Find the point of each link nearest to the obstacle, (6, 3) [m], and its distance, (6,)."""
    ends = zip(frames, _ALONG, strict=True)
    joints = np.array([f.position + along * f.rotation[:, 2] for f, along in ends])
    span = np.diff(joints, axis=0)
    offset = OBSTACLE - joints[:-1]
    along = np.clip((offset * span).sum(axis=1) / (span * span).sum(axis=1), 0.0, 1.0)
    points = joints[:-1] + along[:, None] * span
    return points, np.linalg.norm(points - OBSTACLE, axis=1)


def run(variant: str, dt: float = 5e-4, duration: float = 10.0) -> Record:
    """Run one of `VARIANTS` through the authors' network, mu = 1e4, never settled.

    A program is held for dt [s]; the authors' solver has no such period.
    """
    rows, avoids = VARIANTS[variant]
    tasks: list[Task] = [PositionTask(gain=0.0), *([Posture(rows)] if rows else [])]
    limits: list[Limit] = [JointLimits(gain=0.25), *([PointAvoidance()] if avoids else [])]
    robot = arm()
    return simulate(
        robot,
        Scheme([], tasks, limits),
        CIRCLE.anchored(Configuration(robot, START)),
        START,
        dt=dt,
        duration=duration,
        mode="continuous",
        check=CrossCheck(()),
        solver=DNNSolver(PrimalDualNetwork(rho=1e-4)),
    )


def over_time(q: Matrix) -> tuple[Vector, Vector]:
    """Compute distance from the point [m] and posture error [rad], (N,) each, of angles (N, 6).

    The posture error is the angle by which the vertical has moved, seen from the tool.
    """
    robot = arm()
    at = [Configuration(robot, row) for row in q]
    distance = [nearest_points(map(conf.frame, _LINKS))[1].min() for conf in at]
    chord = np.linalg.norm([conf.rotation[2] - at[0].rotation[2] for conf in at], axis=1)
    return np.array(distance), 2.0 * np.arcsin(0.5 * chord)


def measure(t: Vector, q: Matrix) -> tuple[float, ...]:
    """Measure joint angles (N, 6) [rad] at times (N,) [s], from which the circle begins.

    Returns:
        Least and largest theta2, least and largest theta3 [rad], the largest error of the position
        [m] and of the posture [rad], and the nearest distance from the point [m].
    """
    start = Configuration(arm(), q[0])
    position = [Configuration(start.robot, row).position for row in q]
    error = CIRCLE.anchored(start).sample(t).position - position
    distance, posture = over_time(q)
    ranges = np.transpose([q[:, 1:3].min(axis=0), q[:, 1:3].max(axis=0)])
    path = np.linalg.norm(error, axis=1).max()
    return tuple(map(float, (*ranges.ravel(), path, posture.max(), distance.min())))


def judge(variant: str, ours: Sequence[float]) -> str:
    """Judge a variant's numbers, as `measure` returns them, beside `RECORDED`.

    Returns:
        ``reproduced`` where angles differ by at most `ANGLE`, posture error and distance by a
        factor of at most `FACTOR`, and the path error is at most `FACTOR` times theirs; else ``same
        findings`` where both agree on whether the distance stays above `INNER`, the path error
        below `PATH` and the posture error below `POSTURE`; else ``not reproduced``.
    """
    theirs = RECORDED[variant]
    ratio = np.divide(ours, theirs)[4:]
    alike = np.abs(np.subtract(ours, theirs)[:4]).max() <= ANGLE and ratio.max() <= FACTOR
    if alike and ratio[1:].min() >= 1.0 / FACTOR:
        return "reproduced"
    findings = [(x[6] > INNER, x[4] < PATH, x[5] < POSTURE) for x in (ours, theirs)]
    return "same findings" if findings[0] == findings[1] else "not reproduced"


def table(found: Mapping[str, Sequence[float]]) -> str:
    """Write numbers of `measure` by variant beside the authors', in Markdown."""
    head = ["variant", "run", "theta2 [rad]", "theta3 [rad]", "path error [m]"]
    head += ["posture error [rad]", "distance [m]", "verdict"]
    rows: list[tuple[str, ...]] = []
    for variant, ours in found.items():
        rows.append((variant, "authors", *_cells(RECORDED[variant]), ""))
        rows.append((variant, "ours", *_cells(ours), judge(variant, ours)))
    return markdown_table(head, rows)


def _cells(x: Sequence[float]) -> tuple[str, ...]:
    angles = (f"{x[0]:.3f} to {x[1]:.3f}", f"{x[2]:.3f} to {x[3]:.3f}")
    return (*angles, f"{x[4]:.1e}", f"{x[5]:.1e}", f"{x[6]:.4f}")


def compare(record, t, q):
    """Return the largest difference of the joint angles and when it first exceeds 0.01 rad."""
    ours = np.column_stack([np.interp(t, record.t, angles) for angles in record.q.T])
    gap = np.abs(ours - q).max(axis=1)
    return gap.max(), t[np.argmax(gap > 0.01)] if gap.max() > 0.01 else np.inf


def draw(curves):
    """Draw distance from the point over time: ours thin and dark, the authors' wide and pale."""
    figure = new_figure(DOUBLE_COLUMN, 3.6)
    panels = figure.subplots(2, 2, sharex=True, sharey=True).ravel()
    for axes, (variant, runs) in zip(panels, curves.items(), strict=True):
        for label, (t, q) in runs.items():
            wide = {"color": "0.7", "linewidth": 4.0, "zorder": 1} if label != "ours" else {}
            axes.plot(t, over_time(q)[0], label=label, **({"color": "0.0"} | wide))
        for bound, name in ((OUTER, "$d_2$"), (INNER, "$d_1$")):
            axes.axhline(bound, color="0.4", linewidth=0.6, linestyle="--")
            axes.annotate(name, (10.1, bound), va="center")
        axes.set(title=variant)
    panels[0].legend(loc="upper right")
    figure.supxlabel("Time [s]")
    figure.supylabel("Distance from the point [m]")
    return figure


def main(
    folder: tyro.conf.Positional[str] = "runs/posture_obstacle",
    dt: tyro.conf.Positional[float] = 5e-4,
    duration: tyro.conf.Positional[float] = 10.0,
    authors: tyro.conf.Positional[str | None] = None,
):
    """Run the four variants, print the table and draw the figure."""
    found = {}
    curves = {}
    for number, variant in enumerate(VARIANTS, 1):
        record = run(variant, dt, duration)
        every = slice(None, None, max(1, round(1e-3 / dt)))
        t = record.t[every]
        q = record.q[every]
        found[variant] = measure(t, q)
        curves[variant] = {"ours": (t, q)}
        if authors is not None:
            file = loadmat(Path(authors) / f"QALL{number}.mat")
            curves[variant]["authors"] = file[f"t{number}"][:, 0], file[f"qAll{number}"]
            gap, when = compare(record, *curves[variant]["authors"])
            print(f"{variant}: largest difference {gap:.3g} rad, above 0.01 rad at {when:.4g} s")
    print(table(found))
    write_figures({"posture_obstacle": lambda: draw(curves)}, folder)


if __name__ == "__main__":
    sys.exit(run_script(main))
