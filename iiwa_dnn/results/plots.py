"""The figures of a record for print: readable in grey, as PNG and PDF, styled by style.mplstyle.

Each ``draw_*`` draws one panel into Axes of one's own. Matplotlib is imported only when a figure is
drawn, and without pyplot: no global state, no window.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from iiwa_dnn.checks import Array
from iiwa_dnn.files import prepare_folder, write_atomically
from iiwa_dnn.naming import short_names
from iiwa_dnn.results.metrics import (
    beyond_robot,
    frame_errors,
    joint_rates,
    limits,
    orientation_error,
    position_error,
)
from iiwa_dnn.results.record import RATES, Record

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    Panel = Callable[[Axes, Record], None]

COLUMN = 3.5  # width in a two-column journal [in]
BUCKETS = 700  # stretches of a curve: one for each pixel across a column at 200 dots an inch
STYLE = Path(__file__).with_name("style.mplstyle")
CAPTIONS = {
    "overview": "Path, joint angles and velocities with the joints' limits near them, errors and "
    "kinetic index, and further quantities of the run. A line is the mean or the largest value, a "
    "band the range, of each short stretch of time.",
    "convergence": "KKT residual of the network, and gap to the reference.",
    "moments": "The arm after each fifth of the run.",
}

_JOINTS = {
    "q": (r"$q_{{{}}}$", "Joint angle [rad]", "q_upper"),
    "dq": (r"$\dot{{q}}_{{{}}}$", "Joint velocity [rad/s]", "dq_max"),
    "acceleration": (r"$\ddot{{q}}_{{{}}}$", "Joint acceleration [rad/s²]", "robot_ddq_max"),
    "jerk": (r"$\dddot{{q}}_{{{}}}$", "Joint jerk [rad/s³]", "robot_dddq_max"),
    "torque": (r"$\tau_{{{}}}$", "Joint torque [N m]", "torque_max"),
    "demand": (r"$\tau_{{{}}}$", "Torque for the commands [N m]", "demand_max"),
}
_ERRORS = (
    ("$e_x$", "0.35", "--"),
    ("$e_y$", "0.5", "-."),
    ("$e_z$", "0.65", ":"),
    (r"$\|e\|$", "0.0", "-"),
)
_DASHES = ("-", "--", "-.", ":")
_UNITS = (("m", 1.0), ("mm", 1e-3), ("µm", 1e-6), ("nm", 1e-9))


def save_figures(record: Record, folder: str | os.PathLike[str]) -> list[Path]:
    """Draw ``overview`` and ``convergence`` of a run and write them with `write_figures`.

    The same record gives the same bytes.
    """
    return write_figures({name: partial(draw, record) for name, draw in FIGURES.items()}, folder)


def write_figures(
    figures: Mapping[str, Callable[[], Figure]], folder: str | os.PathLike[str]
) -> list[Path]:
    """Draw figures in the style of the package and write each as PNG and PDF, atomically.

    The functions that draw them go by the names of the files; the folder is made if need be.
    Returns the files, each PNG followed by its PDF.

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
            for suffix, metadata in (("png", {}), ("pdf", {"CreationDate": None})):
                written.append(folder / f"{name}.{suffix}")
                save = partial(figure.savefig, format=suffix, metadata=metadata)
                write_atomically(written[-1], save)
                figure.set_layout_engine("none")  # both files share one layout
    return written


def new_figure(width: float, height: float) -> Figure:
    """Make an empty figure of this size [in] that keeps its parts from overlapping."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def envelope(t: Array, curve: Array, buckets: int = BUCKETS) -> tuple[Array, Array, Array, Array]:
    """Reduce a curve (M,) over times [s] (M,) to mean and extremes of intervals of equal length.

    Returns:
        Mean time, and mean, least and greatest value of each interval, (min(M, buckets),) each.
    """
    starts = np.linspace(0, len(curve), min(len(curve), buckets), endpoint=False).astype(int)
    counts = np.diff(starts, append=len(curve))
    times, mean = (np.add.reduceat(values, starts) / counts for values in (t, curve))
    return times, mean, np.minimum.reduceat(curve, starts), np.maximum.reduceat(curve, starts)


def overview_figure(record: Record) -> Figure:
    """Draw path, joints, errors and kinetic index; (a)-(d) are the panels of the paper's Fig. 1.

    A run in physics, one with limits of torques, one that avoids collisions, one that tracks
    several frames and one that went beyond the robot's own acceleration or jerk limits have further
    panels.
    """
    further: dict[Panel, Array] = {
        partial(draw_joints, name="torque"): record.torque,
        partial(draw_joints, name="demand"): record.demand,
        draw_frames: record.frame_position,
        draw_distance: record.distance,
    }
    panels: list[Panel] = [
        draw_path,
        partial(draw_joints, name="q"),
        partial(draw_joints, name="dq"),
        draw_error,
        draw_orientation_error,
        draw_kinetic_index,
        *(partial(draw_joints, name=rate) for rate in RATES if rate in beyond_robot(record)),
        *(draw for draw, column in further.items() if len(column)),
    ]
    figure = _draw_panels(record, panels, 2, 2.7)
    figure.suptitle(title_of(record), fontsize=9)
    return figure


def title_of(record: Record) -> str:
    """Name robot, path, and the kinds of joint limits that the run had."""
    settings = record.settings
    rates = [rate for rate, key in RATES.items() if np.isfinite(limits(record, key)).any()]
    kept = ["position", "velocity", *rates]
    path = (settings.get("reference") or {}).get("name", "targets")
    return f"{settings['robot']}, {path}; limits of {', '.join(kept[:-1])} and {kept[-1]}"


def convergence_figure(record: Record) -> Figure:
    """Draw KKT residual and, if there were references, the gap to each; with their tolerances."""
    panels: list[Panel] = [draw_residual, draw_gap]
    return _draw_panels(record, panels[: 1 + min(record.solution_gap.shape[1], 1)], 1, 1.9)


def _draw_panels(record: Record, panels: Sequence[Panel], columns: int, height: float) -> Figure:
    """Draw panels of this height [in] in one or two columns, lettered from the left."""
    rows = -(-len(panels) // columns)
    figure = new_figure(columns * COLUMN, rows * height)
    for number, draw in enumerate(panels):
        axes = figure.add_subplot(rows, columns, number + 1)
        draw(axes, record)
        # Left of the axes, above which a legend may be as wide as they are.
        axes.set_title(f"({chr(ord('a') + number)})", loc="left", x=-0.12, fontsize=8)
    return figure


def draw_path(axes: Axes, record: Record) -> None:
    """Draw the desired and the actual path [m], seen along the axis of its least extent."""
    across, up = np.sort(np.ptp(record.position_desired, axis=0).argsort(kind="stable")[1:])
    # Wide and pale under thin and dark: both stay visible where they coincide.
    for path, style in (
        (record.position_desired, {"color": "0.72", "linewidth": 3.2, "label": "desired"}),
        (record.position, {"color": "0.0", "linestyle": "--", "label": "actual"}),
        (record.position[:1], {"color": "0.0", "marker": "o", "linestyle": "", "label": "start"}),
    ):
        axes.plot(path[:, across], path[:, up], **style)
    axes.set(xlabel=f"${'xyz'[across]}$ [m]", ylabel=f"${'xyz'[up]}$ [m]")
    axes.set_aspect("equal", adjustable="datalim")
    axes.locator_params(nbins=4)
    legend_above(axes, columns=3)


def draw_joints(axes: Axes, record: Record, name: str) -> None:
    """Draw one curve a joint over time, distinguished by luminance and dashes.

    The name is ``"q"``, ``"dq"``, ``"acceleration"``, ``"jerk"``, ``"torque"`` or ``"demand"``. If
    the limits of the joints differ, all but positions are drawn as fractions of them; a position
    limit near the curves is a mark of its joint's color at the end of the time axis.
    """
    import matplotlib

    symbol, quantity, limit = _JOINTS[name]
    upper = limits(record, limit)
    lower = limits(record, "q_lower", -np.inf) if name == "q" else -upper
    curves = joint_rates(record, name)[0] if name in RATES else getattr(record, name)
    if name != "q" and np.isfinite(upper).all() and np.ptp(upper):
        curves = 100.0 * curves / upper
        quantity = f"{quantity.partition(' [')[0]} [% of limit]"
        lower = np.full(record.dof, -100.0)
        upper = -lower
    colors = matplotlib.colormaps["viridis"](np.linspace(0.0, 0.85, record.dof))
    names = short_names(record.settings)
    labels = [symbol.format(name) if name.isdigit() else name for name in names]
    for joint, curve in enumerate(curves.T):
        dashes = _DASHES[joint % len(_DASHES)]
        style = {"color": colors[joint], "linestyle": dashes, "label": labels[joint]}
        _draw_curve(axes, record.t[: len(curve)], curve, **style)
    reach = np.array(axes.get_ylim())  # as both kinds of limits move it
    for bound in (lower, upper):
        _draw_limits(axes, bound, reach, colors)
    label_time(axes, record, quantity, columns=4 if max(map(len, names)) < 8 else 2)


def _draw_limits(axes: Axes, bound: Array, reach: Array, colors: Array) -> None:
    """Draw the limits (n,) near the range of an axis: a common one as a line, others as marks."""
    margin = 0.15 * np.ptp(reach)  # a limit farther off would only flatten the curves
    near = np.flatnonzero((reach[0] - margin <= bound) & (bound <= reach[1] + margin))
    dashed = {"linestyle": (0, (8, 3)), "linewidth": 0.8, "color": "0.0"}
    common = not np.ptp(bound)
    for joint in near[:1] if common else near:
        marked = {"xmin": 0.94, "linewidth": 2.0, "color": colors[joint]}
        line = axes.axhline(bound[joint], **(dashed if common else marked))
        line.set_label("_" if "limit" in axes.get_legend_handles_labels()[1] else "limit")


def _draw_curve(axes: Axes, t: Array, curve: Array, **line: Any) -> None:
    """Draw the means of intervals (`envelope`) as a line, and their extremes as a pale band."""
    times, mean, least, greatest = envelope(t, curve)
    axes.plot(times, mean, **line)
    axes.fill_between(times, least, greatest, color=line["color"], alpha=0.25, linewidth=0.0)


def draw_error(axes: Axes, record: Record) -> None:
    """Draw the position error's components and norm over time, in the unit that suits its size."""
    error = position_error(record)
    largest = np.abs(error[np.isfinite(error)]).max(initial=0.0)
    unit, size = next((each for each in _UNITS if largest >= each[1]), _UNITS[-1])
    error = error / size
    curves = [*error.T, np.linalg.norm(error, axis=1)]
    for (label, color, dashes), curve in zip(_ERRORS, curves, strict=True):
        _draw_curve(axes, record.t, curve, color=color, linestyle=dashes, label=label)
    label_time(axes, record, f"Position error [{unit}]")


def draw_orientation_error(axes: Axes, record: Record) -> None:
    """Draw the angle between the tool's orientation and the desired one over time."""
    error = orientation_error(record)
    # Without the start, where it is rounding.
    shown = np.where(error > 1e-5 * np.nanmax(error), error, 0.0)[:, np.newaxis]
    draw_log(axes, record, shown, ["angle to the target"], "Orientation error [rad]")


def draw_kinetic_index(axes: Axes, record: Record) -> None:
    """Draw the kinetic index over time."""
    _draw_curve(axes, record.t[:-1], record.kinetic_index, color="0.0", label="kinetic index")
    unit = "J" if record.settings["scheme"].get("kinetic") == "inertia" else "rad²/s²"
    label_time(axes, record, rf"$\dot{{q}}^T G \dot{{q}}$ [{unit}]")


def draw_residual(axes: Axes, record: Record) -> None:
    """Draw the KKT residual of the network's answers over time, and its tolerance."""
    draw_log(
        axes,
        record,
        record.kkt_residual[:, np.newaxis],
        ["network"],
        "KKT residual",
        record.settings["tol"],
    )


def draw_gap(axes: Axes, record: Record) -> None:
    """Draw the gap to each reference over time, and its tolerance; missing answers are gaps."""
    check = record.settings["check"]
    draw_log(
        axes,
        record,
        record.solution_gap,
        check["solvers"],
        "Gap to reference [rad/s]",
        check["tolerance"],
    )


def draw_frames(axes: Axes, record: Record) -> None:
    """Draw the position error of each further tracked frame over time."""
    distances = frame_errors(record)[0]
    draw_log(axes, record, distances, record.settings["frames"], "Position error [m]")


def draw_distance(axes: Axes, record: Record) -> None:
    """Draw the distance of the nearest pair [m] over time, and the least that is allowed."""
    _draw_curve(axes, record.t, record.distance, color="0.0", label="nearest pair")
    allowed = record.settings["collisions"]["distance"]
    axes.axhline(allowed, color="0.0", linestyle="--", label="least allowed")
    axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]))
    label_time(axes, record, "Distance [m]")


def draw_log(
    axes: Axes,
    record: Record,
    values: Array,
    names: Sequence[str],
    quantity: str,
    tolerance: float | None = None,
) -> None:
    """Draw the largest value of each interval (`envelope`) over time on a logarithmic scale.

    The values, one a sample or one a step of the record, (N, k), have k names. Zero and infinity
    have no point there. A tolerance is a dashed line, but not in continuous mode: what lags behind
    is not judged by it.
    """
    axes.set_yscale("log", nonpositive="mask")
    for name, curve in zip(names, values.T, strict=True):
        shown = (curve > 0.0) & np.isfinite(curve)
        times, _, _, greatest = envelope(record.t[: len(curve)][shown], curve[shown])
        axes.plot(times, greatest, ".-", markersize=1.0, linewidth=0.8, label=name)
    if tolerance is not None and record.settings["mode"] == "converged":
        axes.axhline(tolerance, color="0.0", linestyle="--", label="tolerance")
    label_time(axes, record, quantity)


def label_time(axes: Axes, record: Record, quantity: str, columns: int = 4) -> None:
    """Label time, quantity and curves, and let the time axis span the run."""
    axes.set(xlabel="Time [s]", ylabel=quantity)
    if record.steps:
        axes.set_xlim(record.t[0], record.t[-1])
    legend_above(axes, columns)


def legend_above(axes: Axes, columns: int) -> None:
    """Put the legend above the axes, where it covers no data."""
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=columns, borderaxespad=0.2)


FIGURES: dict[str, Callable[[Record], Figure]] = {
    "overview": overview_figure,
    "convergence": convergence_figure,
}
"""Figures of a run by the names of their files."""
