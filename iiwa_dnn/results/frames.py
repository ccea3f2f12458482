"""A figure of the errors of several tracked frames."""

from __future__ import annotations

import os
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from iiwa_dnn.results.metrics import frame_errors, orientation_error, position_error
from iiwa_dnn.results.plots import COLUMN, draw_log, new_figure, time_axis, write_figures
from iiwa_dnn.results.record import Record

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def save_frames(record: Record, folder: str | os.PathLike[str]) -> list[Path]:
    """Draw the figure ``frames`` of a run that tracks several; see `write_figures`."""
    if record.frame_position is None:
        return []
    return write_figures({"frames": partial(frames_figure, record)}, folder)


def frames_figure(record: Record) -> Figure:
    """Draw distance and angle of each tracked frame to its target over time."""
    figure = new_figure(COLUMN, 3.8)
    panels = figure.subplots(2, 1, sharex=True)
    distance, angle = frame_errors(record)
    first = np.linalg.norm(position_error(record), axis=1), orientation_error(record)
    names = [record.settings["tip"], *record.settings["frames"]]
    labels = ("Position error [m]", "Orientation error [rad]")
    for axes, tip, others, label in zip(panels, first, (distance, angle), labels, strict=True):
        draw_log(axes, record.t, np.column_stack([tip, others]), names)
        axes.set_ylabel(label)
    panels[1].get_legend().remove()
    time_axis(panels[-1], record)
    return figure
