"""The figures of a record for print: readable in grey, as PNG and PDF, styled by style.mplstyle.

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
    draw_error,
    draw_joints,
    draw_log,
    draw_path,
    plane_of,
    time_axis,
)
from iiwa_dnn.results.record import Record

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLUMN, DOUBLE_COLUMN = 3.5, 7.0  # widths in a two-column journal [in]
STYLE = Path(__file__).with_name("style.mplstyle")


def save_figures(record: Record, folder: str | os.PathLike[str]) -> list[Path]:
    """Draw all figures of a run and write them with `write_figures`.

    The figures are ``overview`` (the paper's Fig. 1 (a)–(d) together), ``path``, ``joint_angles``,
    ``joint_velocities``, ``position_error``, ``convergence`` (KKT residual and cross-check gap),
    and of a run in physics ``torques``. The same record gives the same bytes.
    """
    figures = {name: partial(draw, record) for name, draw in FIGURES.items()}
    if record.torque is not None:
        figures["torques"] = partial(_single, draw_joints, record, name="torque")
    return write_figures(figures, folder)


def write_figures(
    figures: Mapping[str, Callable[[], Figure]], folder: str | os.PathLike[str]
) -> list[Path]:
    """Draw figures in the style of the package and write each as PNG and PDF, atomically.

    Args:
        figures: Functions that draw them, by the names of the files.
        folder: The folder; made if need be.

    Returns:
        The files written, each PNG followed by its PDF.

    Raises:
        FileError: If the folder cannot be written.
    """
    import matplotlib.style

    folder = prepare_folder(folder)
    written = []
    # From Matplotlib's own defaults, so that a personal matplotlibrc changes nothing.
    with matplotlib.style.context(["default", STYLE]):
        for name, draw in figures.items():
            figure = draw()
            for suffix in ("png", "pdf"):
                metadata = {"CreationDate": None} if suffix == "pdf" else None
                written.append(folder / f"{name}.{suffix}")
                save = partial(figure.savefig, format=suffix, metadata=metadata)
                write_atomically(written[-1], save)
                # Both files share one layout; finding it is the slow part.
                figure.set_layout_engine("none")
    return written


def overview_figure(record: Record) -> Figure:
    """Draw path, joint angles, joint velocities and position error: the paper's Fig. 1 (a)–(d)."""
    figure = new_figure(DOUBLE_COLUMN, 5.6)
    draw_path(figure.add_subplot(2, 2, 1, **_projection(record)), record)
    draw_joints(figure.add_subplot(2, 2, 2), record, "q")
    draw_joints(figure.add_subplot(2, 2, 3), record, "dq")
    draw_error(figure.add_subplot(2, 2, 4), record)
    for axes, letter in zip(figure.axes, "abcd", strict=True):
        if hasattr(axes, "text2D"):  # a spatial axis turns its label with itself
            axes.text2D(0.5, -0.1, f"({letter})", transform=axes.transAxes, ha="center")
        else:
            axes.set_xlabel(f"{axes.get_xlabel()}\n({letter})")
    return figure


def path_figure(record: Record) -> Figure:
    """Draw the desired and actual path: in its plane if it lies in one of the world's."""
    figure = new_figure(COLUMN, 3.2)
    draw_path(figure.add_subplot(**_projection(record)), record)
    return figure


def convergence_figure(record: Record) -> Figure:
    """Draw KKT residual and, if there were references, the gap to each; with their tolerances."""
    rows = 2 if record.references else 1
    figure = new_figure(COLUMN, 1.9 * rows)
    panels = figure.subplots(rows, 1, sharex=True, squeeze=False)[:, 0]
    check, t = record.settings["check"], record.t[:-1]
    # In continuous mode both are a lag, which no tolerance is meant for.
    judged = record.settings["mode"] == "converged"
    tolerances = judged * record.settings["tol"], judged * check["tolerance"]
    draw_log(panels[0], t, record.kkt_residual[:, None], ["network"], tolerances[0])
    panels[0].set_ylabel("KKT residual")
    if record.references:
        draw_log(panels[1], t, record.solution_gap, check["solvers"], tolerances[1])
        panels[1].set_ylabel("Gap to reference [rad/s]")
    time_axis(panels[-1], record)
    return figure


def new_figure(width: float, height: float) -> Figure:
    """Make an empty figure of this size [in] that keeps its parts from overlapping."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def _projection(record: Record) -> dict[str, Any]:
    return {"projection": "3d"} if plane_of(record.position_desired) is None else {}


def _single(draw: Callable[..., None], record: Record, **options: Any) -> Figure:
    figure = new_figure(COLUMN, 2.6)
    draw(figure.add_subplot(), record, **options)
    return figure


FIGURES: dict[str, Callable[[Record], Figure]] = {
    "overview": overview_figure,
    "path": path_figure,
    "joint_angles": partial(_single, draw_joints, name="q"),
    "joint_velocities": partial(_single, draw_joints, name="dq"),
    "position_error": partial(_single, draw_error),
    "convergence": convergence_figure,
}
