"""This package's loop towards a stream of poses, raw or through the filter of a moving target."""

import numpy as np
from serve import Loop, Task, serve

import iiwa_dnn


def make(task: Task, variant: str) -> Loop:
    """Make the loop; the variants are ``raw`` and ``filtered``.

    ``default`` has no limits on acceleration or jerk, ``acceleration`` those on acceleration alone.
    """
    robot = iiwa_dnn.load_robot(str(task["urdf"]), tip=str(task["tip"])).with_limits(
        lower=task["lower"],
        upper=task["upper"],
        velocity=task["velocity"],
        acceleration=task["acceleration"],
    )
    limits: tuple[iiwa_dnn.Limit, ...] = ()
    if variant != "default":
        limits = (iiwa_dnn.AccelerationLimits(),)
    if variant in ("raw", "filtered"):
        limits = (*limits, iiwa_dnn.JerkLimits(float(task["jerk"])))
    scheme = iiwa_dnn.DoubleIndicator(extra_limits=limits)
    q = np.array(task["q0"])
    dt = float(task["dt"])
    start = iiwa_dnn.Configuration(robot, q)
    hand = iiwa_dnn.MovingTarget(start, 0.8, 2.5)
    filtered = variant == "filtered"
    controller = iiwa_dnn.Controller(robot, scheme, hand if filtered else None, dt=dt)
    poses = task["poses"]

    def step(k: int) -> None:
        nonlocal q
        target = None
        if filtered:
            hand.set(poses[k + 1][:3, 3], poses[k + 1][:3, :3])
        else:
            target = iiwa_dnn.Target(poses[k + 1][:3, 3], poses[k + 1][:3, :3])
        q = q + dt * controller.step(q, k * dt, target).dq

    return step, lambda: q


if __name__ == "__main__":
    serve(make)
