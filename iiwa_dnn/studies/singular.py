"""Two singular poses: a vertical tool, whose tilt the paper's block loses, and a stretched arm."""

import numpy as np

from iiwa_dnn.control.controller import Mode
from iiwa_dnn.control.policies import Policy
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.references import Line
from iiwa_dnn.results.record import Record
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.schemes import DoubleIndicator
from iiwa_dnn.schemes.tasks import Orientation
from iiwa_dnn.simulation import simulate
from iiwa_dnn.studies.runs import paper_robot

TILT = 0.05
"""Angle between the tool and its desired orientation at the start [rad]."""

_STILL = Line(offset=(1e-12, 0.0, 0.0), period=1e3)


def vertical_start() -> Configuration:
    """Make a bent arm whose tool points straight down."""
    # In the arm's own plane, joints 2, 4 and 6 turn the tool by q2 - q4 + q6.
    return Configuration(paper_robot(), [0.3, 0.5, 0.0, -1.6, 0.0, np.pi - 2.1, 0.2])


def tilted_run(orientation: Orientation, mode: Mode) -> Record:
    """Hold the vertical orientation for half a second, from a start tilted by ``TILT``."""
    desired = vertical_start()
    q0 = desired.q.copy()
    q0[5] += TILT
    scheme = DoubleIndicator(orientation=orientation, weight=1.0)
    return simulate(
        paper_robot(), scheme, _STILL.anchored(desired), q0,
        dt=1e-4, duration=0.5, mode=mode, check=CrossCheck(()),
    )  # fmt: skip


def stretched_run(policy: Policy, dt: float = 1e-3, duration: float = 4.0) -> Record:
    """Follow a line of 4 s, 0.3 m beyond the arm's reach and back, in steps of dt [s]."""
    start = vertical_start()
    outward = start.position * [1.0, 1.0, 0.0]
    reach = 0.8 - float(np.linalg.norm(outward))
    x, y, z = ((reach + 0.3) * outward / np.linalg.norm(outward)).tolist()
    line = Line(offset=(x, y, z), period=4.0).anchored(start)
    return simulate(
        paper_robot(), DoubleIndicator(orientation="none"), line, start.q,
        dt=dt, duration=duration, policy=policy, check=CrossCheck(()),
    )  # fmt: skip
