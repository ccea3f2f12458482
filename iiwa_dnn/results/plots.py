"""Figures of a record for print: column width, readable in grey, PNG and PDF.

Matplotlib is imported only when a figure is drawn, and without pyplot: no global state, no window.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from iiwa_dnn.files import prepare_folder, write_atomically
from iiwa_dnn.results.panels import (
    draw_angles,
    draw_error,
    draw_level,
    draw_log,
    draw_path,
    draw_torques,
    draw_velocities,
    legend_above,
    plane_of,
    time_axis,
)
from iiwa_dnn.results.record import Record

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLUMN, DOUBLE_COLUMN = 3.5, 7.0  # widths in a two-column journal [in]
DPI = 200

_STYLE: dict[str, Any] = {
    # Matplotlib's own Times: it suits a paper, and its maths and text match.
    "font.family": "STIXGeneral",
    "mathtext.fontset": "stix",
    "font.size": 8,
    "axes.labelsize": 8,
    "legend.fontsize": 7,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "lines.linewidth": 1.0,
    "lines.markersize": 3.0,
    "axes.linewidth": 0.6,
    "axes.grid": True,
    "grid.linewidth": 0.4,
    "grid.color": "0.88",
    "axes.axisbelow": True,
    "axes.formatter.useoffset": False,  # the offset would stand where the legend is
    "legend.frameon": False,
    "legend.handlelength": 2.6,
    "legend.columnspacing": 1.2,
    "pdf.fonttype": 42,  # TrueType, which publishers accept; Matplotlib's own Type 3 they do not
}


def save_figures(record: Record, folder: str | os.PathLike[str]) -> list[Path]:
    """Draw all figures of a run and write each as PNG and PDF, atomically.

    The figures are ``overview`` (the paper's Fig. 1 (a)–(d) together), ``path``, ``joint_angles``,
    ``joint_velocities``, ``position_error``, ``convergence`` (KKT residual and cross-check gap),
    and of a run in physics ``torques``. The same record gives the same bytes.

    Args:
        record: The run.
        folder: Where to; made if need be.

    Returns:
        The files written, each PNG followed by its PDF.

    Raises:
        FileError: If the folder cannot be written.
    """
    figures = {name: partial(draw, record) for name, draw in FIGURES.items()}
    if record.torque is not None:
        figures["torques"] = partial(_single, draw_torques, record)
    return write_figures(figures, folder)


def write_figures(
    figures: Mapping[str, Callable[[], Figure]], folder: str | os.PathLike[str]
) -> list[Path]:
    """Draw figures in the style of this module and write each as PNG and PDF, atomically.

    Args:
        figures: What draws each figure, by the name of its files.
        folder: Where to; made if need be.

    Returns:
        The files written, each PNG followed by its PDF.

    Raises:
        FileError: If the folder cannot be written.
    """
    import matplotlib.style

    folder = prepare_folder(folder)
    written = []
    # From Matplotlib's own defaults, so that a personal matplotlibrc changes nothing.
    with matplotlib.style.context(["default", _STYLE]):
        for name, draw in figures.items():
            figure = draw()
            for suffix in ("png", "pdf"):
                path = folder / f"{name}.{suffix}"
                metadata = {"CreationDate": None} if suffix == "pdf" else None
                save = partial(figure.savefig, format=suffix, dpi=DPI, metadata=metadata)
                write_atomically(path, save)
                written.append(path)
                # Both files share one layout; finding it is the slow part.
                figure.set_layout_engine("none")
    return written


def overview_figure(record: Record) -> Figure:
    """Path, joint angles, joint velocities and position error: the paper's Fig. 1 (a)–(d)."""
    figure = new_figure(DOUBLE_COLUMN, 5.6)
    plane = plane_of(record.position_desired)
    projection = {"projection": "3d"} if plane is None else {}
    draw_path(figure.add_subplot(2, 2, 1, **projection), record)
    draw_angles(figure.add_subplot(2, 2, 2), record)
    draw_velocities(figure.add_subplot(2, 2, 3), record)
    draw_error(figure.add_subplot(2, 2, 4), record)
    for axes, letter in zip(figure.axes, "abcd", strict=True):
        if hasattr(axes, "text2D"):  # a spatial axis turns its label with itself
            axes.text2D(0.5, -0.1, f"({letter})", transform=axes.transAxes, ha="center")
        else:
            axes.set_xlabel(f"{axes.get_xlabel()}\n({letter})")
    return figure


def path_figure(record: Record) -> Figure:
    """Desired and actual path: in its plane if it lies in one of the world's, else in space."""
    figure = new_figure(COLUMN, 3.2)
    plane = plane_of(record.position_desired)
    draw_path(figure.add_subplot(**({"projection": "3d"} if plane is None else {})), record)
    return figure


def convergence_figure(record: Record) -> Figure:
    """KKT residual and, if there were references, the gap to each; with their tolerances."""
    rows = 2 if record.references else 1
    figure = new_figure(COLUMN, 1.9 * rows)
    panels = figure.subplots(rows, 1, sharex=True, squeeze=False)[:, 0]
    settings, judged = record.settings, record.settings["mode"] == "converged"
    draw_log(panels[0], record.t[:-1], record.kkt_residual[:, None], ["network"])
    panels[0].set_ylabel("KKT residual")
    if record.references:
        names = settings["check"]["solvers"]
        draw_log(panels[1], record.t[:-1], record.solution_gap, names)
        panels[1].set_ylabel("Gap to reference [rad/s]")
    # In continuous mode both are a lag, which no tolerance is meant for.
    if judged:
        draw_level(panels[0], settings["tol"])
        if record.references:
            draw_level(panels[1], settings["check"]["tolerance"])
    for axes in panels:
        legend_above(axes, columns=3)
    time_axis(panels[-1], record)
    return figure


def new_figure(width: float, height: float) -> Figure:
    """An empty figure of this size [in] that keeps its parts from overlapping."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def _single(draw: Callable[[Axes, Record], None], record: Record) -> Figure:
    figure = new_figure(COLUMN, 2.6)
    draw(figure.add_subplot(), record)
    return figure


FIGURES: dict[str, Callable[[Record], Figure]] = {
    "overview": overview_figure,
    "path": path_figure,
    "joint_angles": partial(_single, draw_angles),
    "joint_velocities": partial(_single, draw_velocities),
    "position_error": partial(_single, draw_error),
    "convergence": convergence_figure,
}
