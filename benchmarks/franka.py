"""Hostile targets on a Franka arm, or on a server that speaks its protocol: reflexes, lost cycles.

A target jumps by up to 0.35 m and 1 rad every second, within the arm's reach or beyond it. A loop
that sends nothing but zero, for 2 s before each run, shows what the machine loses by itself.
"""

import os
import sys
from collections.abc import Sequence
from contextlib import suppress
from datetime import datetime
from typing import Any

import numpy as np
import pinocchio as pin

import iiwa_dnn
from iiwa_dnn.references.base import Motion
from iiwa_dnn.results.markdown import markdown_table

JUMP = 0.35
"""Largest jump of the target [m]."""

TURN = 1.0
"""Largest turn of the target between two jumps [rad]."""

RUN = 20.0
"""Length of one run [s]."""

PRIORITY = 5
"""Real-time priority of a motion; a server of the robot's protocol needs a higher one."""


class Jumps(iiwa_dnn.Reference):
    """A pose that jumps every second, from that of a start."""

    name = "jumps"
    period = np.inf
    duration = np.inf

    def __init__(self, rng: np.random.Generator) -> None:
        count = round(RUN) + 2
        direction = rng.normal(size=(count, 3))
        direction /= np.linalg.norm(direction, axis=1, keepdims=True)
        self.shifts = direction * rng.uniform(0.0, JUMP, (count, 1))
        self.turns = [pin.exp3(rng.uniform(-TURN, TURN, 3)) for _ in range(count)]
        self.shifts[0] = 0.0
        self.turns[0] = np.eye(3)

    def motion(self, t: float) -> Motion:
        """Compute displacement and turn at time t [s]."""
        k = int(t)
        return Motion(self.shifts[k], np.zeros(3), self.turns[k])


def hurry(priority: int, task: int = 0) -> None:
    """Let a thread, this one by default, come first, where that is allowed; 0: no longer.

    Linux pauses what does so for 0.95 s of a second: it is for a motion, not for a preparation.
    """
    policy = os.SCHED_RR if priority else os.SCHED_OTHER
    with suppress(PermissionError, ProcessLookupError):
        os.sched_setscheduler(task, policy, os.sched_param(priority))


class FirstPlant(iiwa_dnn.FrankaPlant):
    """A plant that comes first while it moves."""

    def read(self) -> Any:
        """Come first, and return the joint angles [rad], (7,)."""
        hurry(PRIORITY)
        return super().read()

    def stop(self) -> None:
        """End the motion, and come first no longer."""
        super().stop()
        hurry(0)


def bench_franka(arguments: Sequence[str], prog: str) -> int:
    """Drive the arm at a host for so many seconds: HOST SECONDS."""
    host = arguments[0] if arguments else "127.0.0.1"
    seconds = float(arguments[1]) if len(arguments) > 1 else 600.0
    rows = []
    driven = 0.0
    rng = np.random.default_rng(0)
    robot = iiwa_dnn.load_robot("fr3")
    while driven < seconds:
        policy = ("slow", "relax")[len(rows) % 2]
        row = [len(rows), policy]
        for reference in (None, Jumps(rng)):
            plant = FirstPlant(host)
            record, figures = drive(plant, plant.with_room(robot), reference, policy)
            row += figures
        driven += record.t[-1]
        rows.append([*row, datetime.now().isoformat(" ", "milliseconds")])
        print(*rows[-1], file=sys.stderr, flush=True)
    head = ["run", "policy", "lost at rest", "end", "lost", "largest rate", "end", "at"]
    print(markdown_table(head, [[str(cell) for cell in row] for row in rows]))
    print(f"{driven:.0f} s in {len(rows)} runs")
    return 0


def drive(plant: Any, robot: Any, reference: Any, policy: Any) -> tuple[iiwa_dnn.Record, list[Any]]:
    """Return a run, and its late commands, ratio to the limits if it moves, and end."""
    start = iiwa_dnn.Configuration(robot, plant.posture)
    path = iiwa_dnn.Still() if reference is None else reference
    tip_speed = iiwa_dnn.TipSpeedLimit(plant.tip_speed, "link8")
    limits = (iiwa_dnn.AccelerationLimits(), iiwa_dnn.JerkLimits(), tip_speed)
    scheme = iiwa_dnn.DoubleIndicator(tracking="next", next_gain=100.0, extra_limits=limits)
    record = iiwa_dnn.simulate(
        robot,
        scheme,
        path.anchored(start),
        start.q,
        plant=plant,
        dt=1e-3,
        duration=2.0 if reference is None else RUN,
        policy=policy,
        check=iiwa_dnn.CrossCheck(()),
    )
    late = len(record.settings["plant"]["late_s"])
    end = record.settings["status"]
    if reference is None:
        return record, [late, end]
    rate = np.abs(record.dq_solver / robot.dq_max).max()
    return record, [late, f"{rate:.2f}", end]
