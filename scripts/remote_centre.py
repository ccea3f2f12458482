"""A shaft through a point: the tip draws the heart while the tool's axis pivots about a trocar.

One sees how far the axis passes from the point, and that the orientation is free otherwise.
"""

import sys

import numpy as np
import tyro

import iiwa_dnn
from iiwa_dnn.app.command_line import run_script

START = [-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0]  # [rad]


def main(duration: tyro.conf.Positional[float] = 10.0, dt: tyro.conf.Positional[float] = 1e-3):
    """Draw the heart in `duration` seconds; 1 where a check failed."""
    robot = iiwa_dnn.load_robot("iiwa7")
    start = iiwa_dnn.Configuration(robot, START)
    point = start.position + 0.15 * start.rotation[:, 2]  # on the axis, 15 cm before the flange
    scheme = iiwa_dnn.Scheme(
        costs=[iiwa_dnn.KineticEnergy(weight=0.2), iiwa_dnn.CyclicMotion(weight=0.8)],
        tasks=[
            iiwa_dnn.PositionTask(gain=np.inf),
            iiwa_dnn.RemoteCenterTask(point, gain=np.inf),
        ],
        limits=[iiwa_dnn.JointLimits()],
    )
    heart = iiwa_dnn.Heart(scale=2e-3, period=duration).anchored(start).ahead(dt)
    record = iiwa_dnn.simulate(robot, scheme, heart, START, dt=dt)
    axes = record.rotation[:, :, 2]
    apart = point - record.position
    off = np.linalg.norm(np.cross(axes, apart), axis=1).max()
    tilt = np.degrees(np.arccos(np.clip(axes @ axes[0], -1.0, 1.0)).max())
    error = iiwa_dnn.compute_metrics(record)["max_position_error_m"]
    failures = iiwa_dnn.failures(record)
    print(
        f"axis at most {off:.3g} m from the point, tilted by {tilt:.1f} deg, tip {error:.3g} m off"
    )
    print(f"failures {failures}")
    return int(bool(failures))


if __name__ == "__main__":
    sys.exit(run_script(main))
