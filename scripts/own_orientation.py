"""An orientation of one's own: the heart, the tool nodding to and fro while it is drawn.

The path is the heart's own, and a turn about the world's axes with its exact rate. One sees that
the tool follows the turning target, and that ProxQP agrees.
"""

import sys

import numpy as np
import tyro

import iiwa_dnn
from iiwa_dnn.app.command_line import run_script
from iiwa_dnn.references.rotations import turn_target
from iiwa_dnn.results.metrics import orientation_error

LARGEST = 0.2  # [rad]
RATE = 2.0  # [rad/s]


class Nodding(iiwa_dnn.Heart):
    """The heart with a tool that nods."""

    def move(self, t, target):
        """Take a target to time t [s]; see `Reference.move`."""
        super().move(t, target)
        angle = LARGEST * np.sin(RATE * t)
        rate = LARGEST * RATE * np.cos(RATE * t)
        turn_target(target, (angle, 0.0, 0.0), (rate, 0.0, 0.0))


def main(duration: tyro.conf.Positional[float] = 10.0):
    """Draw it; the duration is in seconds."""
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(lower=-2.5, upper=2.5)
    start = iiwa_dnn.Configuration(robot, robot.start_posture())
    scheme = iiwa_dnn.DoubleIndicator(tracking="next")
    record = iiwa_dnn.simulate(
        robot, scheme, Nodding().anchored(start), start.q, dt=1e-3, duration=duration
    )
    turned = orientation_error(record).max()
    moved = iiwa_dnn.compute_metrics(record)["max_position_error_m"]
    print(f"largest error {moved:.2e} m, {turned:.2e} rad, failures {iiwa_dnn.failures(record)}")


if __name__ == "__main__":
    sys.exit(run_script(main))
