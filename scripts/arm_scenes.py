"""Fixed-base arms of the examples of Pink and mink, with the same tasks, weights and limits.

Soft tasks towards the next target beside a weak posture, as both libraries compose them: one sees
each arm come from its start to a target that swings to and fro by 10 cm, and the largest position
error of the last half. UR3 cannot reach all of it, and Jaco's joints are too slow for it. UR10 goes
to a pose, against a posture that pulls it back; Z1 is told joint velocities instead, and its limits
cut them at times.
"""

import sys
import warnings

import numpy as np
import tyro

import iiwa_dnn
from iiwa_dnn import checks
from iiwa_dnn.app.command_line import run_script

# The libraries' weights are 1 and 1e-6; a tolerance of 1e-9 asks for a posture's above that.
TASK = 1e3
POSTURE = 1e-3
SWING = {"amplitudes": (0.0, 0.1, 0.0), "turns": (1.0, 1.0, 1.0), "period": np.pi}
READY = (0.0, 0.6, 0.0, -1.4, 0.0, 1.1, 0.0)
BENT = (1.0, 1.0, 1.0, 0.0, 0.0, 0.0)
HOME = (0.0, -0.785398, 0.0, -2.35619, 0.0, 1.5708, 0.785398)
ARMS = ("left_iiwa7_flange", "right_iiwa7_flange")
SCENES = {  # robot, start [rad], y and z of the target's centre [m] or where it is, frames or tip
    "pink arm_ur3": ("ur3", BENT, (0.5, 0.2), None),
    "pink arm_ur5": ("ur5", BENT, (0.5, 0.2), None),
    "pink arm_kinova_gen2": ("kinova", (0.0, 1.0, 1.0, 0.0, 1.0, 0.0), (0.8, 0.2), None),
    "pink arm_panda": ("panda", HOME, None, None),
    "pink inverse_kinematics_ur10": ("ur10", (0.0,) * 6, "pose", None),
    "pink arm_z1_joint_velocity_tracking": ("z1", (0.0,) * 6, "velocity", None),
    "mink arm_iiwa": ("iiwa7", READY, None, None),
    "mink dual_iiwa": ("iiwa7_dual", 2 * READY, None, ARMS),
}


class JointVelocity(iiwa_dnn.Cost):
    """The cost 1/2 |dq - 2 sin t|^2."""

    def quadratic(self, step):
        """Return P (n, n) and q (n,)."""
        return np.eye(step.q.size), np.full(step.q.size, -2.0 * np.sin(step.t))


def scene(name, dt):
    """Return robot, scheme, references by frame and start of a scene."""
    arm, q0, centre, frames = SCENES[name]
    robot = iiwa_dnn.load_robot(arm)
    start = iiwa_dnn.Configuration(robot, q0)
    references = {}
    for frame in frames or (robot.tip,):
        position = start.frame(frame).position.copy()
        if centre == "pose":
            goal = np.random.default_rng(0).uniform(-np.pi / 2, np.pi / 2, robot.dof)
            references[frame] = iiwa_dnn.Still().anchored(iiwa_dnn.Configuration(robot, goal))
            continue
        if centre not in (None, "velocity"):
            position[1:] = centre
        place = iiwa_dnn.Target(position, start.frame(frame).rotation)
        references[frame] = iiwa_dnn.Lissajous(**SWING).anchored(place)
    kinds = (iiwa_dnn.PositionTask, iiwa_dnn.OrientationTask)
    tasks = [task(frame=f, weight=TASK, gain=np.inf) for f in references for task in kinds]
    costs = [iiwa_dnn.CyclicMotion(weight=POSTURE, gain=1 / dt)]
    if centre == "velocity":
        costs = [JointVelocity()]
        tasks = []
    return (
        robot,
        iiwa_dnn.Scheme(costs, tasks, [iiwa_dnn.JointLimits(gain=0.5 / dt)]),
        {frame: path.ahead(dt) for frame, path in references.items()},
        q0,
    )


def main(duration: tyro.conf.Positional[float] = 10.0, dt: tyro.conf.Positional[float] = 5e-3):
    """Run all scenes for `duration` seconds; 1 where a check failed."""
    checks.positive("dt", dt)
    warnings.simplefilter("ignore")  # the targets begin away from the tools
    failed = []
    for name in SCENES:
        robot, scheme, references, q0 = scene(name, dt)
        record = iiwa_dnn.simulate(robot, scheme, references, q0, dt=dt, duration=duration)
        failed += iiwa_dnn.failures(record)
        late = slice(record.steps // 2, None)
        text = f"{np.abs(record.dq).max():.2f} rad/s at most"
        if scheme.tasks:
            error = np.linalg.norm(record.position - record.position_desired, axis=1)[late]
            text = f"error {error.max():.2e} m"
        print(f"{name:36} {text}, gap to ProxQP {record.crosscheck_gap.max():.1e} rad/s")
    print(f"failures {failed}")
    return int(bool(failed))


if __name__ == "__main__":
    sys.exit(run_script(main))
