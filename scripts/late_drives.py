"""Hostile requests to an iiwa 7 whose drives are late: `delay` right, 20 % wrong, and absent.

Printed for each: farthest beyond a position limit [rad], and the steps in which the shield was
resynchronised to measured positions. Its kernels are those of an exported shield.
"""

import sys

import numpy as np
import tyro
from tabulate import tabulate

import iiwa_dnn
from iiwa_dnn.step.requests import Reason

DT = 1e-3  # [s]
STATED = {"`delay` right": 1.0, "20 % less": 0.8, "20 % more": 1.2, "none": 0.0}
ROBOT = iiwa_dnn.load_robot("iiwa7").with_limits(acceleration=10.0, jerk=500.0)


def run(late, stated, steps):
    """Return the excess [rad] and the number of resynchronisations of a run.

    Drives are late by a number of periods; the shield is told `stated` [s].
    """
    shield = iiwa_dnn.Shields(ROBOT, 1, dt=DT, delay=stated)
    random = np.random.default_rng(0)
    path = [np.zeros(ROBOT.dof)] * (1 + late)
    sent = [np.zeros(ROBOT.dof)] * 3
    resynchronised = 0
    for k in range(steps):
        if k % 200 == 0:
            request = 3.0 * random.normal(size=(1, ROBOT.dof)) * ROBOT.dq_max
        command = shield.step(path[k][np.newaxis], request)
        resynchronised += command.reason[0] == Reason.RESYNCHRONISED
        sent.append(command.dq[0].copy())
        path.append(path[-1] + DT * sent[-1])
    for order, limit in enumerate((ROBOT.dq_max, ROBOT.ddq_max, ROBOT.dddq_max)):
        rates = np.abs(np.diff(sent, order, axis=0)) / DT**order
        assert (rates <= limit + 1e-9 / DT**order).all(), "a rate limit is broken"
    q = np.array(path)
    return max(0.0, (q - ROBOT.q_upper).max(), (ROBOT.q_lower - q).max()), resynchronised


def main(steps: tyro.conf.Positional[int] = 15000):
    """Print the table of drives that are late by 10, 20 and 40 ms."""
    rows = []
    for late in (10, 20, 40):
        found = [run(late, ratio * late * DT, steps) for ratio in STATED.values()]
        rows.append([f"{late} ms", *(f"{excess:.2g}, {count}" for excess, count in found)])
    print(tabulate(rows, ["drives are late by", *STATED], "pipe", disable_numparse=True))


if __name__ == "__main__":
    sys.exit(tyro.cli(main))
