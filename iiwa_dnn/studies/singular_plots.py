"""The figure of the singular poses: a vertical tool and a stretched arm."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from iiwa_dnn.results.metrics import orientation_error, position_error
from iiwa_dnn.results.plots import DOUBLE_COLUMN, new_figure, write_figures
from iiwa_dnn.results.record import Record


def save_singular_figure(
    vertical: Mapping[str, Record], stretched: Mapping[str, Record], folder: str | os.PathLike[str]
) -> list[Path]:
    """Draw ``singular`` as PNG and PDF.

    Args:
        vertical: Runs with a tool that is to be vertical, by rows and mode.
        stretched: Runs beyond the arm's reach, by policy.
        folder: Where to; made if need be.

    Returns:
        The files written.

    Raises:
        FileError: If the folder cannot be written.
    """
    return write_figures({"singular": lambda: _figure(vertical, stretched)}, folder)


def _figure(vertical: Mapping[str, Record], stretched: Mapping[str, Record]) -> Figure:
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
