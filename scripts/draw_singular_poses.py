"""Draw what happens in singular poses into a folder: docs/images, or the one that is given."""

import sys

import numpy as np
import tyro

from iiwa_dnn.app.command_line import run_script
from iiwa_dnn.results.metrics import orientation_error, position_error
from iiwa_dnn.results.plots import DOUBLE_COLUMN, legend_above, new_figure, write_figures
from iiwa_dnn.studies.singular import stretched_run, tilted_run


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
