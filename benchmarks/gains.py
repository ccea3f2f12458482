"""A circle in physics at rising gains, with acceleration and jerk limits and without.

``python -m benchmarks.gains`` prints the largest distance of the tip from the circle in the second
half of the run, the reference's clock as the policy has left it. MuJoCo's arm has noisy encoders.
"""

import sys
import warnings

import numpy as np

import iiwa_dnn
from iiwa_dnn.results.markdown import markdown_table
from iiwa_dnn.schemes.motion_limits import MotionLimits, largest_gain
from iiwa_dnn.simulation.disturbances import Disturbances
from iiwa_dnn.simulation.plants import MujocoPlant

GAINS = (10.0, 20.0, 30.0, 45.0, 60.0)
JERK = 500.0
NOISE = 1e-4
DT = 1e-3


def stray(limits: tuple[iiwa_dnn.Limit, ...], gain: float) -> float:
    """Return the tip's largest distance from the circle, with a gain [1/s] and limits [m]."""
    robot = iiwa_dnn.load_robot("iiwa7")
    start = iiwa_dnn.Configuration(robot, robot.start_posture())
    scheme = iiwa_dnn.DoubleIndicator(
        position_gain=gain, orientation_gain=gain, extra_limits=limits
    )
    circle = iiwa_dnn.Circle(period=4.0).anchored(start)
    record = iiwa_dnn.simulate(
        robot,
        scheme,
        circle,
        start.q,
        dt=DT,
        duration=4.0,
        plant=MujocoPlant(Disturbances(encoder_noise=NOISE)),
        check=iiwa_dnn.CrossCheck(()),
    )
    behind = np.zeros(len(record.q))
    if record.fraction is not None:
        behind[1:] = np.cumsum(DT * (1.0 - record.fraction))
    errors = [
        np.linalg.norm(iiwa_dnn.Configuration(robot, q).position - circle.at(t).position)
        for q, t in zip(record.q, record.t - behind, strict=True)
    ]
    return float(max(errors[len(errors) // 2 :]))


def main() -> int:
    """Print the table."""
    acceleration = iiwa_dnn.AccelerationLimits()
    kinds = {
        "none": (),
        "acceleration": (acceleration,),
        "acceleration and jerk": (acceleration, iiwa_dnn.JerkLimits(JERK)),
    }
    warnings.simplefilter("ignore")
    rows = []
    for name, limits in kinds.items():
        rows.append([name, *(f"{1e3 * stray(limits, gain):.2f}" for gain in GAINS)])
    print(markdown_table(["limits", *(f"{gain:g} 1/s" for gain in GAINS)], rows))
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(jerk=JERK)
    limits = MotionLimits((iiwa_dnn.AccelerationLimits(), iiwa_dnn.JerkLimits()))
    print(f"largest stable gain {largest_gain(limits.constants(robot), 1.0 / DT):.1f} 1/s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
