"""The four programs of the TII paper on a six-joint Kinova, beside the authors' own runs.

One sees the table of docs/posture_obstacle.md and its figure. With the folder of the authors' files
QALL1.mat to QALL4.mat as fourth argument, their joint angles are compared one by one as well.

    python scripts/posture_obstacle.py [FOLDER [DT [SECONDS [AUTHORS]]]]
"""

import sys
from pathlib import Path

import numpy as np
from scipy.io import loadmat

from iiwa_dnn.results.plots import DOUBLE_COLUMN, new_figure, write_figures
from iiwa_dnn.studies import posture_obstacle as study


def compare(record, path, number):
    """Return the largest difference of the joint angles and when it first exceeds 0.01 rad."""
    file = loadmat(path / f"QALL{number}.mat")
    t, q = file[f"t{number}"][:, 0], file[f"qAll{number}"]
    ours = np.column_stack([np.interp(t, record.t, angles) for angles in record.q.T])
    gap = np.abs(ours - q).max(axis=1)
    return gap.max(), t[np.argmax(gap > 0.01)] if gap.max() > 0.01 else np.inf


def draw(curves):
    """Draw distance from the point and posture error over time."""
    figure = new_figure(DOUBLE_COLUMN, 2.8)
    left, right = figure.subplots(1, 2)
    dashes = ("-", "--", "-.", ":")
    for (variant, (t, distance, posture)), dash in zip(curves.items(), dashes, strict=True):
        left.plot(t, distance, dash, label=variant)
        right.semilogy(t[1:], np.maximum(posture[1:], 1e-7), dash, label=variant)
    for bound, label in ((study.OUTER, "$d_2$"), (study.INNER, "$d_1$")):
        left.axhline(bound, color="0.6", linewidth=0.8)
        left.annotate(label, (0.0, bound), va="bottom")
    left.set(xlabel="Time [s]", ylabel="Distance from the point [m]")
    right.set(xlabel="Time [s]", ylabel="Posture error [rad]")
    left.legend()
    return figure


def main(folder="runs/posture_obstacle", dt=1e-3, duration=10.0, authors=None):
    """Run the four variants, print the table and draw the figure."""
    found, curves = {}, {}
    for number, variant in enumerate(study.VARIANTS, 1):
        record = study.run(variant, dt, duration)
        every = slice(None, None, max(1, round(1e-3 / dt)))
        t, q = record.t[every], record.q[every]
        found[variant], curves[variant] = study.measure(t, q), (t, *study.over_time(q))
        if authors is not None:
            gap, when = compare(record, Path(authors), number)
            print(f"{variant}: largest difference {gap:.3g} rad, above 0.01 rad at {when:.4g} s")
    print(study.table(found))
    write_figures({"posture_obstacle": lambda: draw(curves)}, folder)


if __name__ == "__main__":
    main(*sys.argv[1:2], *map(float, sys.argv[2:4]), *sys.argv[4:5])
