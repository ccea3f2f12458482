"""The heart around an obstacle: the arm avoids a ball where its elbow moves, and itself.

The elbow gives way to the ball by the arm's redundancy, and the tip draws the heart as exactly as
without it.
"""

import sys
from pathlib import Path

import tyro

import iiwa_dnn
from iiwa_dnn.app.command_line import run_script

START = [-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0]  # [rad]
BALL = iiwa_dnn.Sphere([0.12, -0.04, 0.775], 0.07)  # without the rows the elbow goes through it
FLOOR = iiwa_dnn.HalfSpace([0.0, 0.0, 1.0], -0.05)
DISTANCE = 0.02  # [m]
QUICK = iiwa_dnn.AccelerationLimits(float("inf"))  # the elbow evades at 27 rad/s^2


def run(avoid, dt, robot):
    """Draw the heart, with or without rows that avoid collisions; returns the record."""
    heart = iiwa_dnn.Heart(scale=6.5e-3).anchored(iiwa_dnn.Configuration(robot, START))
    scheme = iiwa_dnn.DoubleIndicator(extra_limits=(QUICK, avoid) if avoid else ())
    return iiwa_dnn.simulate(robot, scheme, heart, START, dt=dt)


def main(
    folder: tyro.conf.Positional[str] = "runs/avoid_obstacle",
    dt: tyro.conf.Positional[float] = 1e-3,
):
    """Run both, save them in a folder; 1 where a check failed or something came too near."""
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(lower=-2.5, upper=2.5)
    avoid = iiwa_dnn.CollisionAvoidance([BALL, FLOOR], distance=DISTANCE)
    Path(folder).mkdir(parents=True, exist_ok=True)
    records = [run(None, dt, robot), run(avoid, dt, robot)]
    distances = [avoid.scene(robot).nearest(r.q, r.t)[0] for r in records]
    for name, record, distance in zip(("without", "with"), records, distances, strict=True):
        error = iiwa_dnn.compute_metrics(record)["max_position_error_m"]
        record.save(Path(folder) / f"{name}.npz")
        print(f"{name} rows: error {error:.3g} m, least distance {distance.min():.5f} m")
    failures = iiwa_dnn.failures(records[1])
    print(f"failures {failures}")
    return int(bool(failures))


if __name__ == "__main__":
    sys.exit(run_script(main))
