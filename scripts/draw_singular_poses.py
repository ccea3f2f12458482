"""Draw what happens in singular poses into a folder: docs/images, or the one that is given."""

import sys

import numpy as np

from iiwa_dnn.results.metrics import orientation_error, position_error
from iiwa_dnn.results.plots import DOUBLE_COLUMN, new_figure, write_figures
from iiwa_dnn.studies.singular import stretched_run, tilted_run


def draw(vertical, stretched):
    """Draw runs of `tilted_run` by rows and mode, and of `stretched_run` by policy."""
    figure = new_figure(DOUBLE_COLUMN, 2.6)
    left, middle, right = figure.subplots(1, 3)
    for name, record in vertical.items():
        left.semilogy(record.t[1:], orientation_error(record)[1:], label=name)
    for name, record in stretched.items():
        middle.plot(record.t, np.linalg.norm(position_error(record), axis=1), label=name)
        right.plot(record.t[1:], np.abs(record.dq).max(axis=1), label=name, linewidth=0.6)
    left.set(title="Tool vertical", xlabel="t [s]", ylabel="orientation error [rad]")
    middle.set(title="Arm stretched", xlabel="t [s]", ylabel="position error [m]")
    right.set(title="Arm stretched", xlabel="t [s]", ylabel="fastest joint [rad/s]")
    for axes in (left, middle, right):
        axes.legend()
    return figure


if __name__ == "__main__":
    vertical = {
        f"{form}, {mode}": tilted_run(form, mode)
        for form in ("so3", "block")
        for mode in ("converged", "continuous")
    }
    stretched = {policy: stretched_run(policy) for policy in ("slow", "relax")}
    folder = sys.argv[1] if len(sys.argv) > 1 else "docs/images"
    print(*write_figures({"singular": lambda: draw(vertical, stretched)}, folder), sep="\n")
