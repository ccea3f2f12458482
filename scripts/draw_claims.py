"""Figures of the atlas: each network's residual, and the tool's error against the work.

    python scripts/draw_claims.py runs/atlas/atlas.json docs/images

The first file is what `iiwa-dnn atlas` leaves behind.
"""

import json
import sys
from functools import partial
from pathlib import Path

from iiwa_dnn.results.plots import COLUMN, new_figure, write_figures
from iiwa_dnn.studies.atlas import SOLVED
from iiwa_dnn.studies.atlas_report import of_every_disturbance, places

KINDS = {"none": ("o", "0.0"), "constant": ("s", "tab:red"), "white": ("^", "tab:blue")}
"""Marker and color of each disturbance."""


MARKERS = "os^vD*P"


def claims_figure(rows):
    """Draw a line for each network, the best at the top, and a marker for each disturbance."""
    names = [name for name in places(rows) if _finished(rows, name)][::-1]
    drawn = new_figure(COLUMN, 0.6 + 0.2 * len(names))
    axis = drawn.subplots()
    for height, name in enumerate(names):
        for row in of_every_disturbance(rows, name):
            value = row["mean"]["residual"]
            if row["disturbance"] in KINDS and value is not None:
                marker, color = KINDS[row["disturbance"]]
                label = row["disturbance"] if height == 0 else None
                axis.semilogx(max(value, SOLVED), height, marker, color=color, label=label)
    axis.set_yticks(range(len(names)), names)
    axis.set_xlabel("RMS KKT residual")
    axis.legend(loc="lower left", fontsize=6)
    return drawn


def _finished(rows, name):
    """Test whether any run of a network was carried out."""
    return any(row["mean"]["residual"] is not None for row in of_every_disturbance(rows, name))


if __name__ == "__main__":
    cells = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    figures = {"claims": partial(claims_figure, cells)}
    print(*write_figures(figures, Path(sys.argv[2])), sep="\n")
