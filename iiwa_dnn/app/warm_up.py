"""``warm-up``: every compiled function that a run needs, compiled once and kept on disk."""

from __future__ import annotations

import time
from itertools import product

import numpy as np

import iiwa_dnn
from iiwa_dnn.app.command_line import progress_bar
from iiwa_dnn.app.options import WarmUpOptions
from iiwa_dnn.app.track import start_posture
from iiwa_dnn.control.controller import Mode
from iiwa_dnn.schemes.tasks import Orientation

FORMS: tuple[Orientation, ...] = ("so3", "block", "none")
MODES: tuple[Mode, ...] = ("converged", "continuous")


def run(options: WarmUpOptions) -> int:
    """Take a few steps of every kind of run, solve a program and a batch; return 0."""
    began = time.perf_counter()
    robot = iiwa_dnn.load_robot("iiwa7")
    q0 = start_posture(robot)
    reference = iiwa_dnn.Heart().anchored(iiwa_dnn.Configuration(robot, q0))
    kinds = list(product(FORMS, MODES))
    with progress_bar(len(kinds) + 2, "program", options.quiet) as bar:
        for orientation, mode in kinds:
            scheme = iiwa_dnn.DoubleIndicator(orientation=orientation)
            iiwa_dnn.simulate(
                robot, scheme, reference, q0, duration=1e-3, mode=mode, noise=1e-3, filter_window=2
            )
            bar.update()
        # Joints too slow for the path: steps without a solution, with certificate and policy.
        slow = robot.with_limits(velocity=1e-3 * robot.dq_max)
        iiwa_dnn.simulate(slow, iiwa_dnn.DoubleIndicator(), reference, q0, dt=1e-2, duration=0.1)
        bar.update()
        qp = iiwa_dnn.QP(np.eye(2), np.zeros(2), A=np.ones((1, 2)), b=np.ones(1))
        iiwa_dnn.solve_problem(qp)
        iiwa_dnn.solve_batch(qp.P, qp.q, A=qp.A, b=qp.b)
        bar.update()
    if not options.quiet:
        print(f"compiled in {time.perf_counter() - began:.0f} s")
    return 0
