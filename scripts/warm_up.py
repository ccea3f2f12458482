"""Compile all that a run needs, once for all later runs; `make setup` calls it."""

import sys
from itertools import product

import numpy as np

import iiwa_dnn
from iiwa_dnn.app.command_line import run_script
from iiwa_dnn.qp.compiling import WATCH
from iiwa_dnn.studies.runs import HeartRun, measure

PATHS = (
    iiwa_dnn.Circle(),
    iiwa_dnn.Line(),
    iiwa_dnn.Lissajous(),
    iiwa_dnn.Waypoints(np.array([0.0, 1.0]), np.eye(2, 3)),
    iiwa_dnn.Still(),
    iiwa_dnn.Cone(),
    iiwa_dnn.Tilting(iiwa_dnn.Circle()),
)


def main():
    """Take a few steps of every kind of run, solve a program and a batch."""
    WATCH.quiet = True
    robot = iiwa_dnn.load_robot("iiwa7")
    start = iiwa_dnn.Configuration(robot, robot.start_posture())
    heart = iiwa_dnn.Heart().anchored(start)
    for orientation, mode in product(("so3", "block", "none"), ("converged", "continuous")):
        scheme = iiwa_dnn.DoubleIndicator(orientation=orientation)
        noisy = {"noise": 1e-3, "filter_window": 2}
        iiwa_dnn.simulate(robot, scheme, heart, start.q, duration=1e-3, mode=mode, **noisy)
    for path in PATHS:
        path.at(0.0)
    # Joints too slow for the path: steps without a solution, with certificate and policy.
    slow = robot.with_limits(velocity=1e-3 * robot.dq_max)
    for limits in ((), (iiwa_dnn.AccelerationLimits(10.0), iiwa_dnn.CollisionAvoidance())):
        scheme = iiwa_dnn.DoubleIndicator(extra_limits=limits)
        iiwa_dnn.simulate(slow, scheme, heart, start.q, dt=1e-2, duration=0.1)
    for substeps in ("computed", "implicit"):
        measure(HeartRun(duration=1e-3, substeps=substeps))
    qp = iiwa_dnn.QP(np.eye(2), np.zeros(2), A=np.ones((1, 2)), b=np.ones(1))
    iiwa_dnn.prove(qp, iiwa_dnn.solve_problem(qp, sharpen=True))
    iiwa_dnn.solve_batch(qp.P, qp.q, A=qp.A, b=qp.b)


if __name__ == "__main__":
    sys.exit(run_script(main))
