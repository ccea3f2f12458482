"""This package's loop as documented: `Controller.step(q, t)`, with and without integration.

A task with a `scene` is one of ``scripts/arm_scenes.py``.
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np
from serve import Loop, Task, serve

import iiwa_dnn
from iiwa_dnn.simulation import MOTIONS

sys.path.insert(0, str(Path(__file__).parents[2]))
from scripts import arm_scenes


def make(task: Task, variant: str) -> Loop:
    """Make the loop; the variants are ``command``, ``euler`` and ``midpoint``."""
    q = np.array(task["q0"])
    dt = float(task["dt"])
    reference: Any
    if "scene" in task:
        robot, scheme, reference, _ = arm_scenes.scene(str(task["scene"]), dt)
    else:
        robot = iiwa_dnn.load_robot(str(task["urdf"]), tip=str(task["tip"])).with_limits(
            lower=task["lower"], upper=task["upper"], velocity=task["velocity"]
        )
        reference = iiwa_dnn.Heart().anchored(iiwa_dnn.Configuration(robot, q))
        scheme = iiwa_dnn.DoubleIndicator()
    if "balls" in task:
        balls = map(iiwa_dnn.Sphere, task["balls"], map(float, task["ball_radii"]))
        distance = float(task["distance"])
        avoid = iiwa_dnn.CollisionAvoidance(list(balls), self_collision=False, distance=distance)
        scheme = iiwa_dnn.Scheme(scheme.costs, scheme.tasks, [*scheme.limits, avoid])
    controller = iiwa_dnn.Controller(robot, scheme, reference, dt=dt)
    controller.warm_up(q)
    command: Any = None

    def only_command(k: int) -> None:
        nonlocal command
        command = controller.step(q, k * dt)

    def integrated() -> Any:
        nonlocal q
        q = q + dt * command.dq
        return q

    def euler(k: int) -> None:
        nonlocal q
        q = q + dt * controller.step(q, k * dt).dq

    def midpoint(k: int) -> None:
        nonlocal q
        q = q + dt * motion(lambda at, t: controller.step(at, t).dq, q, k * dt, dt)

    motion = MOTIONS["midpoint"].step
    if variant == "command":
        return only_command, integrated
    return {"euler": euler, "midpoint": midpoint}[variant], lambda: q


if __name__ == "__main__":
    serve(make)
