"""The heart around an obstacle: the arm avoids a ball where its elbow moves, and itself.

The elbow gives way to the ball by the arm's redundancy, and the tip draws the heart as exactly as
without it.
"""

import sys
from pathlib import Path

import tyro

import iiwa_dnn
from iiwa_dnn.app.command_line import run_script
from iiwa_dnn.results.pictures import draw_arm
from iiwa_dnn.results.plots import new_figure, write_figures

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


def draw(robot, records, names, distances):
    """Draw the arm of each record as it is nearest to the ball, and the distances over time."""
    figure = new_figure(7.0, 2.4)
    panels = figure.subplots(1, 3, width_ratios=(1.0, 1.0, 1.1))
    near = int(distances[0].argmin())
    for panel, record, name in zip(panels, records, names, strict=False):
        (image,) = draw_arm(robot, record, [near], (700, 700))
        panel.imshow(image, interpolation="lanczos")
        panel.set_title(name, fontsize=8, pad=3)
        panel.set_axis_off()
    for record, distance, style, name in zip(records, distances, ("--", "-"), names, strict=True):
        panels[2].plot(record.t, 1e3 * distance, style, color="0.0", label=name)
    panels[2].axhline(1e3 * DISTANCE, color="0.5", linewidth=0.8)
    panels[2].set(xlabel="Time [s]", ylabel="Least distance [mm]", xlim=(0.0, records[0].t[-1]))
    panels[2].legend(loc="upper right")
    return figure


def main(
    folder: tyro.conf.Positional[str] = "runs/avoid_obstacle",
    dt: tyro.conf.Positional[float] = 1e-3,
):
    """Run both, draw them into a folder; 1 where a check failed or something came too near."""
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(lower=-2.5, upper=2.5)
    avoid = iiwa_dnn.CollisionAvoidance([BALL, FLOOR], distance=DISTANCE)
    records = [run(None, dt, robot), run(avoid, dt, robot)]
    distances = [avoid.scene(robot).nearest(r.q, r.t)[0] for r in records]
    for name, record, distance in zip(("without", "with"), records, distances, strict=True):
        error = iiwa_dnn.compute_metrics(record)["max_position_error_m"]
        print(f"{name} rows: error {error:.3g} m, least distance {distance.min():.5f} m")
    # Two pictures of one scene: the first run knows of no obstacle.
    records[0].settings["collisions"] = records[1].settings["collisions"]
    names = ("without", "with collision avoidance")
    figures = {"obstacle": lambda: draw(robot, records, names, distances)}
    print(*write_figures(figures, Path(folder)), sep="\n")
    failures = iiwa_dnn.failures(records[1])
    print(f"failures {failures}")
    return int(bool(failures))


if __name__ == "__main__":
    sys.exit(run_script(main))
