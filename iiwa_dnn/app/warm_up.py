"""``warm-up``: every compiled function that a run needs, compiled once and kept on disk."""

import gc
import time
from itertools import product
from typing import Literal, get_args

import numpy as np

from iiwa_dnn.app.command_line import progress_bar
from iiwa_dnn.app.options import WarmUpOptions
from iiwa_dnn.control.controller import Mode
from iiwa_dnn.networks.batch import solve_batch
from iiwa_dnn.networks.problems import solve_problem
from iiwa_dnn.qp import QP
from iiwa_dnn.qp.compiling import WATCH
from iiwa_dnn.qp.proof import prove
from iiwa_dnn.references import (
    Circle,
    Cone,
    Heart,
    Line,
    Lissajous,
    Still,
    Tilting,
    Waypoints,
)
from iiwa_dnn.robot import Configuration, load_robot
from iiwa_dnn.schemes import AccelerationLimits, CollisionAvoidance, DoubleIndicator
from iiwa_dnn.schemes.tasks import Orientation
from iiwa_dnn.simulation import simulate
from iiwa_dnn.studies.runs import HeartRun, measure

_FOLLOWERS: tuple[Literal["computed", "implicit"], ...] = ("computed", "implicit")

PATHS = (
    Circle(),
    Line(),
    Lissajous(),
    Waypoints(np.array([0.0, 1.0]), np.eye(2, 3)),
    Still(),
    Cone(),
    Tilting(Circle()),
)


def run(options: WarmUpOptions) -> int:
    """Take a few steps of every kind of run, solve a program and a batch; return 0."""
    began = time.perf_counter()
    gc.set_threshold(100_000)  # what numba makes mostly stays; looking through it takes a twentieth
    WATCH.quiet = True
    robot = load_robot("iiwa7")
    q0 = robot.start_posture()
    reference = Heart().anchored(Configuration(robot, q0))
    kinds = list(product(get_args(Orientation), get_args(Mode)))
    with progress_bar(len(kinds) + 3, "program", options.quiet) as bar:
        for orientation, mode in kinds:
            scheme = DoubleIndicator(orientation=orientation)
            simulate(
                robot, scheme, reference, q0, duration=1e-3, mode=mode, noise=1e-3, filter_window=2
            )
            bar.update()
        for path in PATHS:
            path.at(0.0)
        # Joints too slow for the path: steps without a solution, with certificate and policy.
        slow = robot.with_limits(velocity=1e-3 * robot.dq_max)
        for limits in ((), (AccelerationLimits(10.0), CollisionAvoidance())):
            scheme = DoubleIndicator(extra_limits=limits)
            simulate(slow, scheme, reference, q0, dt=1e-2, duration=0.1)
        bar.update()
        for substeps in _FOLLOWERS:
            measure(HeartRun(duration=1e-3, substeps=substeps).settings())
        bar.update()
        qp = QP(np.eye(2), np.zeros(2), A=np.ones((1, 2)), b=np.ones(1))
        prove(qp, solve_problem(qp, sharpen=True))
        solve_batch(qp.P, qp.q, A=qp.A, b=qp.b)
        bar.update()
    if not options.quiet:
        print(f"compiled in {time.perf_counter() - began:.0f} s")
    return 0
