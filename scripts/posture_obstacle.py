"""The four programs of the TII paper on a six-joint Kinova, beside the authors' own runs.

One sees the table of docs/posture_obstacle.md and its figure. With the folder of the authors' files
QALL1.mat to QALL4.mat as fourth argument, their joint angles are compared one by one as well.

    python scripts/posture_obstacle.py [FOLDER [DT [SECONDS [AUTHORS]]]]
"""

import sys
from pathlib import Path

import numpy as np
import tyro
from scipy.io import loadmat

from iiwa_dnn.app.command_line import run_script
from iiwa_dnn.results.plots import DOUBLE_COLUMN, new_figure, write_figures
from iiwa_dnn.studies import posture_obstacle as study


def compare(record, t, q):
    """Return the largest difference of the joint angles and when it first exceeds 0.01 rad."""
    ours = np.column_stack([np.interp(t, record.t, angles) for angles in record.q.T])
    gap = np.abs(ours - q).max(axis=1)
    return gap.max(), t[np.argmax(gap > 0.01)] if gap.max() > 0.01 else np.inf


def draw(curves):
    """Draw distance from the point over time: ours thin and dark, the authors' wide and pale."""
    figure = new_figure(DOUBLE_COLUMN, 3.6)
    panels = figure.subplots(2, 2, sharex=True, sharey=True).ravel()
    for axes, (variant, runs) in zip(panels, curves.items(), strict=True):
        for label, (t, q) in runs.items():
            wide = {"color": "0.7", "linewidth": 4.0, "zorder": 1} if label != "ours" else {}
            axes.plot(t, study.over_time(q)[0], label=label, **({"color": "0.0"} | wide))
        for bound, name in ((study.OUTER, "$d_2$"), (study.INNER, "$d_1$")):
            axes.axhline(bound, color="0.4", linewidth=0.6, linestyle="--")
            axes.annotate(name, (10.1, bound), va="center")
        axes.set(title=variant)
    panels[0].legend(loc="upper right")
    figure.supxlabel("Time [s]")
    figure.supylabel("Distance from the point [m]")
    return figure


def main(
    folder: tyro.conf.Positional[str] = "runs/posture_obstacle",
    dt: tyro.conf.Positional[float] = 5e-4,
    duration: tyro.conf.Positional[float] = 10.0,
    authors: tyro.conf.Positional[str | None] = None,
):
    """Run the four variants, print the table and draw the figure."""
    found = {}
    curves = {}
    for number, variant in enumerate(study.VARIANTS, 1):
        record = study.run(variant, dt, duration)
        every = slice(None, None, max(1, round(1e-3 / dt)))
        t = record.t[every]
        q = record.q[every]
        found[variant] = study.measure(t, q)
        curves[variant] = {"ours": (t, q)}
        if authors is not None:
            file = loadmat(Path(authors) / f"QALL{number}.mat")
            curves[variant]["authors"] = file[f"t{number}"][:, 0], file[f"qAll{number}"]
            gap, when = compare(record, *curves[variant]["authors"])
            print(f"{variant}: largest difference {gap:.3g} rad, above 0.01 rad at {when:.4g} s")
    print(study.table(found))
    write_figures({"posture_obstacle": lambda: draw(curves)}, folder)


if __name__ == "__main__":
    sys.exit(run_script(main))
