"""Strict priorities: the heart first, then the tool's direction, then three joints.

Eight rows for seven joints: the first two levels hold to rounding, and the third gets as near as
they let it.
"""

import sys

import tyro

import iiwa_dnn
from iiwa_dnn.app.command_line import run_script

START = [-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0]  # [rad]
HELD = ("iiwa7_joint_3", "iiwa7_joint_5", "iiwa7_joint_7")


def main(duration: tyro.conf.Positional[float] = 4.0, dt: tyro.conf.Positional[float] = 1e-3):
    """Draw the heart in `duration` seconds; 1 where a check failed."""
    robot = iiwa_dnn.load_robot("iiwa7")
    start = iiwa_dnn.Configuration(robot, START)
    scheme = iiwa_dnn.Scheme(
        costs=[iiwa_dnn.KineticEnergy()],
        tasks=[
            iiwa_dnn.PositionTask(priority=1),
            iiwa_dnn.AxisTask(direction=start.rotation[:, 2], priority=2),
            iiwa_dnn.PostureTask(dict.fromkeys(HELD, 0.3), gain=1.0, priority=3),
        ],
        limits=[iiwa_dnn.JointLimits()],
    )
    heart = iiwa_dnn.Heart(period=duration).anchored(start)
    record = iiwa_dnn.simulate(robot, scheme, heart, START, dt=dt)
    for level, name in enumerate(("position", "direction", "joints")):
        missing = record.level_residual[:, level]
        print(f"level {level + 1}, {name}: residual at most {missing.max():.3g}")
    failures = iiwa_dnn.failures(record)
    print(f"failures {failures}")
    return int(bool(failures))


if __name__ == "__main__":
    sys.exit(run_script(main))
