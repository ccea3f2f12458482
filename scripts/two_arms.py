"""Two iiwa 7 on one base: each draws a heart, then both carry one object along a heart.

One sees the errors of both tools, and the largest change of the grasp: the pose of the right tool
as seen from the left one, which hard rows of the program keep.
"""

import sys

import numpy as np
import tyro

import iiwa_dnn
from iiwa_dnn.app.command_line import run_script

LEFT = "left_iiwa7_flange"
RIGHT = "right_iiwa7_flange"


def scheme(*tasks):
    """Compose the paper's cost with tasks of both arms."""
    costs = [iiwa_dnn.KineticEnergy(weight=0.2), iiwa_dnn.CyclicMotion(weight=0.8)]
    return iiwa_dnn.Scheme(costs, tasks, [iiwa_dnn.JointLimits()])


def main(duration: tyro.conf.Positional[float] = 10.0, dt: tyro.conf.Positional[float] = 1e-3):
    """Run both scenes for `duration` seconds; 1 where a check failed."""
    robot = iiwa_dnn.load_robot("iiwa7_dual")
    q0 = robot.start_posture()
    start = iiwa_dnn.Configuration(robot, q0)
    heart = iiwa_dnn.Heart(scale=3e-3)
    hearts = {name: heart.anchored(start.frame(name)).ahead(dt) for name in (LEFT, RIGHT)}

    poses = [
        task(frame=name, gain=np.inf)
        for name in hearts
        for task in (iiwa_dnn.PositionTask, iiwa_dnn.OrientationTask)
    ]
    two = iiwa_dnn.simulate(robot, scheme(*poses), hearts, q0, dt=dt, duration=duration)
    metrics = iiwa_dnn.compute_metrics(two)
    right = metrics["frames"][RIGHT]["max_position_error_m"]
    print(f"two hearts: left {metrics['max_position_error_m']:.3g} m, right {right:.3g} m")

    grasp = iiwa_dnn.RelativePoseTask(RIGHT, base=LEFT, gain=np.inf)
    carry = scheme(iiwa_dnn.PoseTask(gain=np.inf), grasp)
    one = iiwa_dnn.simulate(robot, carry, hearts[LEFT], q0, dt=dt, duration=duration)
    postures = [iiwa_dnn.Configuration(robot, q) for q in one.q[::10]]
    seen = [np.linalg.inv(at.frame(LEFT).pose) @ at.frame(RIGHT).pose for at in postures]
    moved = np.abs(np.array(seen)[:, :3, 3] - seen[0][:3, 3]).max()
    turned = np.abs(np.array(seen)[:, :3, :3] - seen[0][:3, :3]).max()
    print(f"one object: the grasp changes by {moved:.3g} m and {turned:.3g} rad")

    failures = iiwa_dnn.failures(two) + iiwa_dnn.failures(one)
    print(f"failures {failures}")
    return int(bool(failures))


if __name__ == "__main__":
    sys.exit(run_script(main))
