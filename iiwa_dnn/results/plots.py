"""The figures of a record for print: readable in grey, as PNG and PDF, styled by style.mplstyle.

Each ``draw_*`` draws one panel into Axes of one's own. Matplotlib is imported only when a figure is
drawn, and without pyplot: no global state, no window.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from functools import partial
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from iiwa_dnn.files import prepare_folder, write_atomically
from iiwa_dnn.naming import describe, short_names
from iiwa_dnn.results.metrics import (
    blocking_limits,
    frame_errors,
    limits,
    orientation_error,
    position_error,
)
from iiwa_dnn.results.record import FloatArray, Record

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLUMN = 3.5  # width in a two-column journal [in]
DOUBLE_COLUMN = 7.0
BUCKETS = 700  # stretches of a curve: one for each pixel across a column at 200 dots an inch
STYLE = Path(__file__).with_name("style.mplstyle")
CAPTIONS = {
    "overview": "Path, joint angles and velocities with the joints' limits near them, errors and "
    "kinetic index, and what else the run has. A line is the mean or the largest value, a band the "
    "range, of each short stretch of time.",
    "convergence": "KKT residual of the network, and gap to the reference.",
    "torques": "Joint torques: of each step the largest.",
    "moments": "The arm, and below it the path so far, face on.",
}

_TAG_HEIGHT = 0.05  # of a limit's name, over the height of the axes
_MOST_BARS = 6  # limits below the path's time
_JOINTS = {
    "q": (r"$q_{{{}}}$", "Joint angle [rad]"),
    "dq": (r"$\dot{{q}}_{{{}}}$", "Joint velocity [rad/s]"),
    "torque": (r"$\tau_{{{}}}$", "Joint torque [% of its limit]"),
}
_COMPONENTS = (("$e_x$", "0.35", "--"), ("$e_y$", "0.5", "-."), ("$e_z$", "0.65", ":"))
_LIMIT_LINE: dict[str, Any] = {"linewidth": 0.8, "linestyle": (0, (8, 3))}
_DASHES = ("-", "--", "-.", ":")
_MARKERS = "os^Dv<>PXd"
_LENGTH_UNITS = (("m", 1.0), ("mm", 1e-3), ("µm", 1e-6), ("nm", 1e-9), ("pm", 1e-12))


def save_figures(record: Record, folder: str | os.PathLike[str]) -> list[Path]:
    """Draw the figures of a run and write them with `write_figures`.

    They are ``overview``, ``convergence`` and, of a run in physics, ``torques``. The same record
    gives the same bytes.
    """
    names = [name for name in FIGURES if name != "torques" or len(record.torque)]
    return write_figures({name: partial(FIGURES[name], record) for name in names}, folder)


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
            # Both files share one layout. With an engine, each would be drawn twice.
            if layout := figure.get_layout_engine():
                layout.execute(figure)
                figure.set_layout_engine(None)
            for suffix in ("png", "pdf"):
                metadata = {"CreationDate": None} if suffix == "pdf" else None
                written.append(folder / f"{name}.{suffix}")
                save = partial(figure.savefig, format=suffix, metadata=metadata)
                write_atomically(written[-1], save)
    return written


def new_figure(width: float, height: float) -> Figure:
    """Make an empty figure of this size [in] that keeps its parts from overlapping."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def envelope(
    t: FloatArray, curve: FloatArray, buckets: int = BUCKETS
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Sum up a curve (M,) over times [s] (M,) in stretches of equal length; no spike is lost.

    Returns:
        Mean time, and mean, least and greatest value of each stretch, (min(M, buckets),) each.
    """
    if len(curve) <= buckets:
        return t, curve, curve, curve
    starts = np.linspace(0, len(curve), buckets, endpoint=False).astype(int)
    counts = np.diff(starts, append=len(curve))
    times, mean = (np.add.reduceat(values, starts) / counts for values in (t, curve))
    return times, mean, np.minimum.reduceat(curve, starts), np.maximum.reduceat(curve, starts)


def overview_figure(record: Record) -> Figure:
    """Draw path, joints, errors and kinetic index; (a)-(d) are the panels of the paper's Fig. 1.

    A run that was slowed, one that avoids collisions and one that tracks several frames have
    further panels.
    """
    panels: list[Callable[[Any, Record], None]] = [
        draw_path,
        partial(draw_joints, name="q"),
        partial(draw_joints, name="dq"),
        draw_error,
        draw_orientation_error,
        draw_kinetic_index,
    ]
    if len(record.frame_position):
        panels += [partial(draw_frames, name=name) for name in _FRAMES]
    if (record.fraction < 1.0).any():
        panels += [draw_path_time, draw_blocking]
    if len(record.distance):
        panels.append(draw_distance)
    rows = (len(panels) + 1) // 2
    figure = new_figure(DOUBLE_COLUMN, 2.7 * rows)
    for number, draw in enumerate(panels):
        spatial = number == 0 and plane_of(record.position_desired) is None
        axes: Any = figure.add_subplot(rows, 2, number + 1, projection="3d" if spatial else None)
        draw(axes, record)
        letter = f"({chr(ord('a') + number)})"
        if spatial:  # its label would turn with the axis
            axes.text2D(0.5, -0.1, letter, transform=axes.transAxes, ha="center")
        else:
            axes.set_xlabel(f"{axes.get_xlabel()}\n{letter}")
    return figure


def convergence_figure(record: Record) -> Figure:
    """Draw KKT residual and, if there were references, the gap to each; with their tolerances."""
    rows = 2 if record.references else 1
    figure = new_figure(COLUMN, 1.9 * rows)
    panels = figure.subplots(rows, 1, sharex=True, squeeze=False)[:, 0]
    for axes, draw in zip(panels, (draw_residual, draw_gap), strict=False):
        draw(axes, record)
        axes.label_outer()
    return figure


def torques_figure(record: Record) -> Figure:
    """Draw the joint torques of a run in physics."""
    figure = new_figure(COLUMN, 2.8)
    draw_joints(figure.add_subplot(), record, "torque")
    return figure


def plane_of(position: FloatArray) -> tuple[int, int] | None:
    """Return the two axes that a path (N, 3) [m] spans, None for three or for a single point."""
    spread = np.ptp(position, axis=0)
    flat = int(spread.argmin())
    if not spread[flat] <= 1e-3 * spread.max():
        return None
    first, second = (axis for axis in range(3) if axis != flat)
    return first, second


def draw_path(axes: Any, record: Record) -> None:
    """Draw the desired and the actual path [m], in spatial axes where `plane_of` finds no plane."""
    plane = plane_of(record.position_desired)
    columns = list(plane or (0, 1, 2))
    actual = record.position[:, columns].T
    # Wide and pale under thin and dark: both stay visible where they coincide.
    desired = record.position_desired[:, columns].T
    axes.plot(*desired, color="0.72", linewidth=3.2, label="desired")
    axes.plot(*actual, color="0.0", linestyle="--", label="actual")
    axes.plot(*actual[:, :1], color="0.0", marker="o", linestyle="", markersize=4, label="start")
    names = ("xlabel", "ylabel", "zlabel")
    axes.set(**{name: f"${'xyz'[i]}$ [m]" for name, i in zip(names, columns, strict=False)})
    if plane is None:
        spans = [np.ptp(limits) for limits in (axes.get_xlim(), axes.get_ylim(), axes.get_zlim())]
        axes.set_box_aspect(spans, zoom=0.8)
        for axis, span in zip("xyz", spans, strict=True):  # a short edge has room for few numbers
            axes.locator_params(axis=axis, nbins=max(2, round(4.0 * span / max(spans))))
    else:
        axes.set_aspect("equal", adjustable="datalim")
        axes.locator_params(nbins=5)
    legend_above(axes, columns=3)


def draw_joints(axes: Axes, record: Record, name: str) -> None:
    """Draw one curve a joint over time, told apart by luminance, dashes and markers.

    The name is ``"q"``, ``"dq"`` or ``"torque"``; the first two come with the limits near them, the
    third as a fraction of each joint's limit, linear up to 1 % and logarithmic beyond.
    """
    import matplotlib

    symbol, quantity = _JOINTS[name]
    values = getattr(record, name)
    if name == "torque":
        values = 100.0 * values / limits(record, "torque_max")
        axes.set_yscale("symlog", linthresh=1.0, subs=(2.0, 5.0))
        axes.yaxis.set_major_formatter("{x:g}")
    colors = matplotlib.colormaps["viridis"](np.linspace(0.0, 0.85, record.dof))
    names = short_names(record.settings, record.dof)
    labels = [symbol.format(text) if text.isdigit() else text for text in names]
    every = max(min(len(values), BUCKETS) // 7, 1)
    for joint, curve in enumerate(values.T):
        style = {
            "color": colors[joint],
            "linestyle": _DASHES[joint % len(_DASHES)],
            "marker": _MARKERS[joint % len(_MARKERS)],
            # Each joint's markers start elsewhere, lest they lie on top of each other.
            "markevery": (every * joint // record.dof, every),
            "label": labels[joint],
        }
        _draw_curve(axes, record.t[: len(values)], curve, **style)
    _label(axes, record, quantity)
    if name == "q":
        _draw_limits(axes, limits(record, "q_lower", -np.inf), limits(record, "q_upper"), labels)
    elif name == "dq":
        _draw_limits(axes, -limits(record, "dq_max"), limits(record, "dq_max"), labels)
    legend_above(axes, columns=4 if max(map(len, names)) < 8 else 2)


def _draw_curve(
    axes: Axes, t: FloatArray, curve: FloatArray, buckets: int = BUCKETS, **line: Any
) -> None:
    """Draw the mean of each stretch as a line, and in a pale band its extremes.

    A band thinner than the line is left out; a noisy curve stays readable among others.
    """
    curve = np.where(np.isfinite(curve), curve, np.nan)  # a gap in the line
    times, mean, least, greatest = envelope(t, curve, buckets)
    axes.plot(times, mean, **line)
    if len(times) < len(t) and not np.max(greatest - least) <= 0.01 * np.ptp(curve):
        axes.fill_between(times, least, greatest, color=line["color"], alpha=0.25, linewidth=0.3)


def _draw_limits(axes: Axes, lower: FloatArray, upper: FloatArray, labels: list[str]) -> None:
    """Draw the limits near the curves, beside each the joints that it belongs to.

    A limit far off would only flatten the curves. Limits too near each other share their names.
    """
    low, high = axes.get_ylim()
    margin = 0.15 * (high - low)
    values = np.concatenate([lower, upper])
    near = (low - margin <= values) & (values <= high + margin)
    label: str | None = "limit"
    for value in np.unique(values[near]):
        axes.axhline(value, color="0.0", label=label, **_LIMIT_LINE)
        label = None
    apart = _TAG_HEIGHT * (high - low)
    while near.any():
        tag = np.abs(values - values[near].min()) <= apart
        joints = np.unique(np.flatnonzero(tag) % len(labels))
        names = ", ".join(labels[joint] for joint in joints)
        text = "all" if joints.size == len(labels) else names
        at = (1.01, float(values[tag].mean()))
        axes.annotate(text, at, xycoords=axes.get_yaxis_transform(), va="center", fontsize=6)
        near &= ~tag


def draw_error(axes: Axes, record: Record, largest: float | None = None) -> None:
    """Draw the position error's components and norm over time, in the unit that suits its size.

    With `largest` [m] the unit and the axis suit that size instead: panels to be compared.
    """
    error = position_error(record)
    norm = np.linalg.norm(error, axis=1)
    size = float(np.nanmax(norm, initial=0.0)) if largest is None else largest
    fitting = (pair for pair in _LENGTH_UNITS if size >= pair[1])
    unit, scale = next(fitting, _LENGTH_UNITS[0] if size == 0.0 else _LENGTH_UNITS[-1])
    for (label, color, dashes), curve in zip(_COMPONENTS, error.T / scale, strict=True):
        curve = np.where(np.isfinite(curve), curve, np.nan)
        # Means alone: four bands would hide each other.
        times, mean, _, _ = envelope(record.t, curve, BUCKETS // 4)
        axes.plot(times, mean, color=color, linestyle=dashes, label=label)
    _draw_curve(axes, record.t, norm / scale, color="0.0", label=r"$\|e\|$")
    _label(axes, record, f"Position error [{unit}]")
    if largest:
        axes.set_ylim(-1.05 * largest / scale, 1.05 * largest / scale)
    legend_above(axes, columns=4)


def draw_orientation_error(axes: Axes, record: Record) -> None:
    """Draw the angle between the tool's orientation and the desired one over time."""
    error = orientation_error(record)
    draw_log(axes, record.t, error[:, np.newaxis], ["angle to the target"])
    if error.any():  # without the start, where it is rounding
        axes.set_ylim(bottom=max(axes.get_ylim()[0], 1e-5 * np.nanmax(error)))
    _label(axes, record, "Orientation error [rad]")


def draw_kinetic_index(axes: Axes, record: Record) -> None:
    """Draw the kinetic index over time."""
    _draw_curve(axes, record.t[:-1], record.kinetic_index, color="0.0", label="kinetic index")
    _label(axes, record, r"$\dot{q}^T G \dot{q}$")
    legend_above(axes, columns=1)


def draw_residual(axes: Axes, record: Record) -> None:
    """Draw the KKT residual of the network's answers over time, and its tolerance."""
    # In continuous mode it is a lag, which no tolerance is meant for.
    judged = record.settings["mode"] == "converged"
    residual = record.kkt_residual[:, np.newaxis]
    draw_log(axes, record.t[:-1], residual, ["network"], judged * record.settings["tol"])
    _label(axes, record, "KKT residual")


def draw_gap(axes: Axes, record: Record) -> None:
    """Draw the gap to each reference over time, and its tolerance."""
    check = record.settings["check"]
    judged = record.settings["mode"] == "converged"
    tolerance = judged * check["tolerance"]
    draw_log(axes, record.t[:-1], record.solution_gap, check["solvers"], tolerance)
    _label(axes, record, "Gap to reference [rad/s]")


def draw_frames(axes: Axes, record: Record, name: str) -> None:
    """Draw the error of each tracked frame over time; the name is ``position`` or ``angle``."""
    distance, angle = frame_errors(record)
    first = np.linalg.norm(position_error(record), axis=1)
    errors = [first, distance] if name == "position" else [orientation_error(record), angle]
    names = [record.settings["tip"], *record.settings["frames"]]
    draw_log(axes, record.t, np.column_stack(errors), names)
    _label(axes, record, _FRAMES[name])


def draw_distance(axes: Axes, record: Record) -> None:
    """Draw the distance of the nearest pair [m] over time, and the least that is allowed."""
    # Of each stretch the smallest: that is what counts.
    times, _, least, _ = envelope(record.t, record.distance)
    axes.plot(times, least, color="0.0", label="nearest pair")
    allowed = record.settings["collisions"]["distance"]
    axes.axhline(allowed, color="0.0", label="least allowed", **_LIMIT_LINE)
    axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]))
    _label(axes, record, "Distance [m]")
    legend_above(axes, columns=2)


def draw_path_time(axes: Axes, record: Record) -> None:
    """Draw the path's time over time, as planned and as a slowed run reached it."""
    reached = np.append(0.0, np.cumsum(record.settings["dt"] * record.filled("fraction")))
    span = record.t[[0, -1]]
    axes.plot(span, span - span[0], color="0.55", linestyle="--", label="as planned")
    axes.plot(*envelope(record.t, reached)[:2], color="0.0", label="reached")
    _label(axes, record, "Path time [s]")
    legend_above(axes, columns=2)


def draw_blocking(axes: Axes, record: Record) -> None:
    """Draw a bar where the path was slowed, and for each limit in its way; the longest first."""
    found = [(describe(name), steps > 0) for name, steps in blocking_limits(record)]
    longest = sorted(found, key=lambda bar: -bar[1].sum())[:_MOST_BARS]
    bars = [("slowed", record.filled("fraction") < 1.0), *longest]
    bars = [bar for bar in bars if bar[1].any()]
    for row, (name, acts) in enumerate(bars):
        times, _, _, acted = envelope(record.t[:-1], acts.astype(float))
        at = times[acted > 0.0]
        axes.plot(at, np.full_like(at, row + 0.2), color="0.35", linestyle="", marker="|")
        axes.text(0.01, row - 0.1, name, transform=axes.get_yaxis_transform(), fontsize=7)
    axes.set(ylim=(len(bars) - 0.5, -0.75), yticks=[])
    _label(axes, record, "Limits in the way")


def draw_log(
    axes: Axes, t: FloatArray, values: FloatArray, names: list[str], tolerance: float = 0.0
) -> None:
    """Draw positive values on a log scale: each stretch's largest as a line, its range as a band.

    The times (N,) are in [s], the values (N, k) have k names. Answers that never came (inf) are
    crosses at the top, a tolerance above zero is a dashed line.
    """
    axes.set_yscale("log")
    drawn = [tolerance] * (tolerance > 0.0)
    for name, curve, color in zip(names, values.T, cycle(("0.15", "0.55", "0.35"))):
        missing = np.isinf(curve)
        # A log scale has no point for zero; a residual may well be zero.
        shown = (curve > 0.0) & ~missing
        times, _, least, greatest = envelope(t[shown], curve[shown])
        axes.fill_between(times, least, greatest, color=color, alpha=0.25, linewidth=0.3)
        drawn += [*least, *greatest]
        alone = "." if len(times) == 1 else ""
        axes.plot(times, greatest, color=color, linewidth=0.8, marker=alone, label=name)
        if missing.any():
            marks = t[missing][:: max(int(missing.sum()) // 100, 1)]
            top = axes.get_xaxis_transform()
            height = np.full_like(marks, 0.96)
            axes.plot(marks, height, "x", color="0.0", transform=top, label=f"{name} failed")
    if tolerance > 0.0:
        axes.axhline(tolerance, color="0.0", linestyle="--", label="tolerance")
    if drawn:  # half a decade around them: the axis of a single value would have no length
        axes.set_ylim(min(drawn) / 3.0, max(drawn) * 3.0)
    legend_above(axes, columns=3)


def _label(axes: Axes, record: Record, quantity: str) -> None:
    axes.set_ylabel(quantity)
    time_axis(axes, record)


def time_axis(axes: Axes, record: Record) -> None:
    """Label the time axis and let it span the run."""
    axes.set_xlabel("Time [s]")
    if record.steps:
        axes.set_xlim(record.t[0], record.t[-1])


def legend_above(axes: Axes, columns: int) -> None:
    """Put the legend above the axes, where it covers no data."""
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=columns, borderaxespad=0.2)


_FRAMES = {"position": "Position errors [m]", "angle": "Orientation errors [rad]"}

FIGURES: dict[str, Callable[[Record], Figure]] = {
    "overview": overview_figure,
    "convergence": convergence_figure,
    "torques": torques_figure,
}
"""Figures of a run by the names of their files; torques of one in physics alone."""
