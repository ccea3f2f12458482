"""Draw what happens in singular poses into a folder: docs/images, or the one that is given."""

import sys

import numpy as np
import tyro

from iiwa_dnn.app.command_line import run_script
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.references import Line
from iiwa_dnn.results.metrics import orientation_error, position_error
from iiwa_dnn.results.plots import DOUBLE_COLUMN, legend_above, new_figure, write_figures
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.schemes import DoubleIndicator
from iiwa_dnn.simulation import simulate
from iiwa_dnn.studies.runs import paper_robot

TILT = 0.05
"""Angle between the tool and its desired orientation at the start [rad]."""

STILL = Line(offset=(1e-12, 0.0, 0.0), period=1e3)


def vertical_start():
    """Make a bent arm whose tool points straight down."""
    # In the arm's own plane, joints 2, 4 and 6 turn the tool by q2 - q4 + q6.
    return Configuration(paper_robot(), [0.3, 0.5, 0.0, -1.6, 0.0, np.pi - 2.1, 0.2])


def tilted_run(orientation, mode):
    """Hold the vertical orientation for half a second, from a start tilted by ``TILT``."""
    desired = vertical_start()
    q0 = desired.q.copy()
    q0[5] += TILT
    scheme = DoubleIndicator(orientation=orientation, weight=1.0)
    return simulate(
        paper_robot(),
        scheme,
        STILL.anchored(desired),
        q0,
        dt=1e-4,
        duration=0.5,
        mode=mode,
        check=CrossCheck(()),
    )


def stretched_run(policy, dt=1e-3, duration=4.0):
    """Follow a line of 4 s, 0.3 m beyond the outstretched arm and back, in steps of dt [s]."""
    start = vertical_start()
    outward = start.position * [1.0, 1.0, 0.0]
    stretch = 0.8 - float(np.linalg.norm(outward))
    x, y, z = ((stretch + 0.3) * outward / np.linalg.norm(outward)).tolist()
    line = Line(offset=(x, y, z), period=4.0).anchored(start)
    return simulate(
        paper_robot(),
        DoubleIndicator(orientation="none"),
        line,
        start.q,
        dt=dt,
        duration=duration,
        policy=policy,
        check=CrossCheck(()),
    )


def draw(vertical, stretched):
    """Draw runs of `tilted_run` by rows and mode, and of `stretched_run` by policy."""
    figure = new_figure(DOUBLE_COLUMN, 2.6)
    left, middle, right = figure.subplots(1, 3)
    for name, record in vertical.items():
        left.semilogy(record.t[1:], orientation_error(record)[1:], label=name)
    # Wide and pale under thin and dark: both stay visible where they coincide.
    for (name, record), width, colour in zip(
        stretched.items(), (3.2, 1.0), ("0.72", "0.0"), strict=True
    ):
        line = {"label": name, "linewidth": width, "color": colour, "linestyle": "-"}
        middle.plot(record.t, np.linalg.norm(position_error(record), axis=1), **line)
        right.plot(record.t[1:], np.abs(record.dq).max(axis=1), **line)
    for axes, quantity, about in (
        (left, "Orientation error [rad]", "tool vertical"),
        (middle, "Position error [m]", "arm stretched"),
        (right, "Fastest joint [rad/s]", "arm stretched"),
    ):
        axes.set(xlabel=f"Time [s]\n({about})", ylabel=quantity)
        axes.margins(x=0.0)
        axes.set_xlim(left=0.0)
        legend_above(axes, columns=2)
    return figure


def main(folder: tyro.conf.Positional[str] = "docs/images"):
    """Run and draw them."""
    vertical = {
        f"{form}, {mode}": tilted_run(form, mode)
        for form in ("so3", "block")
        for mode in ("converged", "continuous")
    }
    stretched = {policy: stretched_run(policy) for policy in ("slow", "relax")}
    print(*write_figures({"singular": lambda: draw(vertical, stretched)}, folder), sep="\n")


if __name__ == "__main__":
    sys.exit(run_script(main))
