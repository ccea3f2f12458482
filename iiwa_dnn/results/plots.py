"""The figures of a record for print: readable in grey, as PNG and PDF, styled by style.mplstyle.

Matplotlib is imported only when a figure is drawn, and without pyplot: no global state, no window.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from functools import partial
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.files import prepare_folder, write_atomically
from iiwa_dnn.naming import describe, short_names
from iiwa_dnn.results.envelope import BUCKETS, envelope, stretches
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
STYLE = Path(__file__).with_name("style.mplstyle")

_ROUGH = 40.0  # sum of the ups and downs of a rough curve, over its largest value
_COARSE = 60  # stretches that a rough curve is drawn in
_TAG_HEIGHT = 0.05  # of a limit's name, over the height of the axes
_MOST_BARS = 6  # limits below the path's time

_JOINTS = {
    "q": (r"$q_{{{}}}$", "Joint angle [rad]"),
    "dq": (r"$\dot{{q}}_{{{}}}$", "Joint velocity [rad/s]"),
    "torque": (r"$\tau_{{{}}}$", "Joint torque [% of its limit]"),
}
_COMPONENTS = (("$e_x$", "0.35", "--"), ("$e_y$", "0.5", "-."), ("$e_z$", "0.65", ":"))
_LIMIT_LINE: dict[str, Any] = {"color": "0.0", "linewidth": 0.8, "linestyle": (0, (8, 3))}
_DASHES = ("-", "--", "-.", ":")
_MARKERS = "os^Dv<>PXd"
_TURNS = 1e-9  # change of a desired rotation's entries from which on it is drawn as turning
_LENGTH_UNITS = (("m", 1.0), ("mm", 1e-3), ("µm", 1e-6), ("nm", 1e-9), ("pm", 1e-12))


def save_figures(record: Record, folder: str | os.PathLike[str]) -> list[Path]:
    """Draw all figures of a run and write them with `write_figures`.

    The figures are ``overview`` (the paper's Fig. 1 (a)–(d) together), ``path``, ``joint_angles``,
    ``joint_velocities``, ``position_error``, ``convergence`` (KKT residual and cross-check gap),
    of a run in physics ``torques``, of one that avoids collisions ``distance``, of one that tracks
    several frames ``frames`` and of one that was slowed ``path_time``. The same record gives the
    same bytes.
    """
    drawable = {
        name: partial(draw, record)
        for name, draw in FIGURES.items()
        if name not in _DRAWN_IF or _DRAWN_IF[name](record)
    }
    return write_figures(drawable, folder)


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


def overview_figure(record: Record) -> Figure:
    """Draw path, joint angles, joint velocities and position error: the paper's Fig. 1 (a)–(d).

    If the target turns, (e) is the orientation error against it.
    """
    turns = bool(np.ptp(record.rotation_desired, axis=0).max() > _TURNS)
    rows = 3 if turns else 2
    figure = new_figure(DOUBLE_COLUMN, 2.8 * rows)
    grid = figure.add_gridspec(rows, 2)
    draw_path(figure.add_subplot(grid[0, 0], **_projection(record)), record)
    draw_joints(figure.add_subplot(grid[0, 1]), record, "q")
    draw_joints(figure.add_subplot(grid[1, 0]), record, "dq")
    draw_error(figure.add_subplot(grid[1, 1]), record)
    if turns:
        axes = figure.add_subplot(grid[2, :])
        draw_log(axes, record.t, orientation_error(record)[:, None], ["angle to the target"])
        axes.set_ylabel("Orientation error [rad]")
        time_axis(axes, record)
    for axes, letter in zip(figure.axes, "abcde", strict=False):
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
    check = record.settings["check"]
    # In continuous mode both are a lag, which no tolerance is meant for.
    judged = record.settings["mode"] == "converged"
    t = record.t[:-1]
    tolerance = judged * record.settings["tol"]
    draw_log(panels[0], t, record.kkt_residual[:, None], ["network"], tolerance)
    panels[0].set_ylabel("KKT residual")
    if record.references:
        draw_log(panels[1], t, record.solution_gap, check["solvers"], judged * check["tolerance"])
        panels[1].set_ylabel("Gap to reference [rad/s]")
    time_axis(panels[-1], record)
    return figure


def frames_figure(record: Record) -> Figure:
    """Draw distance and angle of each tracked frame to its target over time."""
    figure = new_figure(COLUMN, 3.8)
    panels = figure.subplots(2, 1, sharex=True)
    distance, angle = frame_errors(record)
    tip_distance = np.linalg.norm(position_error(record), axis=1)
    names = [record.settings["tip"], *record.settings["frames"]]
    draw_log(panels[0], record.t, np.column_stack([tip_distance, distance]), names)
    draw_log(panels[1], record.t, np.column_stack([orientation_error(record), angle]), names)
    panels[0].set_ylabel("Position error [m]")
    panels[1].set_ylabel("Orientation error [rad]")
    panels[1].get_legend().remove()
    time_axis(panels[1], record)
    return figure


def path_time_figure(record: Record) -> Figure:
    """Draw the path's time over time, slowed stretches shaded, and the limits that slowed it.

    Each limit has a bar where it was in the way, the longest of `_MOST_BARS` first.
    """
    slowed = is_slowed(record)
    bars = [(describe(name), steps > 0) for name, steps in blocking_limits(record)]
    bars = sorted(bars, key=lambda bar: -bar[1].sum())[:_MOST_BARS]
    bars = [bar for bar in bars if bar[1].any()] or [("no limit: a singular pose", slowed)]
    figure = new_figure(COLUMN, 2.4 + 0.25 * len(bars))
    heights = (1.9, 0.25 * len(bars))
    clock, limit = figure.subplots(2, 1, sharex=True, height_ratios=heights)
    start = record.t[0]
    reached = np.append(0.0, np.cumsum(record.settings["dt"] * record.filled("fraction")))
    times, reached, _, _ = envelope(record.t, reached)
    span = record.t[[0, -1]]
    clock.plot(span, span - start, color="0.55", linestyle="--", label="as planned")
    clock.plot(times, reached, color="0.0", label="reached")
    for number, (begin, end) in enumerate(start + np.ptp(span) * stretches(slowed)):
        clock.axvspan(begin, end, color="0.88", label="" if number else "slowed")
    clock.set_ylabel("Path time [s]")
    legend_above(clock, columns=3)
    for row, (name, steps) in enumerate(bars):
        begin, end = (start + np.ptp(span) * stretches(steps)).T
        limit.broken_barh(list(zip(begin, end - begin, strict=True)), (row, 0.35), color="0.35")
        limit.text(0.01, row - 0.15, name, transform=limit.get_yaxis_transform(), fontsize=7)
    limit.set(ylim=(len(bars) - 0.5, -0.75), yticks=[])
    time_axis(limit, record)
    return figure


def is_slowed(record: Record) -> NDArray[np.bool_]:
    """Test for each step whether the path's time went slower than time, (N,)."""
    return np.asarray(record.filled("fraction") < 1.0)


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


def plane_of(position: FloatArray) -> tuple[int, int] | None:
    """Return the two axes that a path (N, 3) [m] spans, None for three or for a single point."""
    spread = np.ptp(position, axis=0)
    flat = int(spread.argmin())
    if not spread[flat] <= 1e-3 * spread.max():
        return None
    first, second = (axis for axis in range(3) if axis != flat)
    return first, second


def draw_path(axes: Any, record: Record) -> None:
    """Draw the desired and the actual path [m], in axes made for the answer of `plane_of`."""
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

    label, quantity = _JOINTS[name]
    values = getattr(record, name)
    if name == "torque":
        values = 100.0 * values / limits(record, "torque_max")
        axes.set_yscale("symlog", linthresh=1.0, subs=(2.0, 5.0))
        axes.yaxis.set_major_formatter("{x:g}")
    t = record.t[: len(values)]
    colors = matplotlib.colormaps["viridis"](np.linspace(0.0, 0.85, record.dof))
    every = max(min(len(t), BUCKETS) // 7, 1)
    names = short_names(record.settings, record.dof)
    labels = [label.format(name) if name.isdigit() else name for name in names]
    for joint, curve in enumerate(values.T):
        style = {
            "color": colors[joint],
            "linestyle": _DASHES[joint % len(_DASHES)],
            "marker": _MARKERS[joint % len(_MARKERS)],
            # Each joint's markers start elsewhere, lest they lie on top of each other.
            "markevery": (every * joint // record.dof, every),
            "label": labels[joint],
        }
        _draw_curve(axes, t, curve, **style)
    time_axis(axes, record)
    if name == "q":
        bounds = [limits(record, "q_lower", -np.inf), limits(record, "q_upper")]
        _draw_limits(axes, bounds, labels, colors)
    elif name == "dq":
        bounds = [-limits(record, "dq_max"), limits(record, "dq_max")]
        _draw_limits(axes, bounds, labels, colors)
    axes.set_ylabel(quantity)
    legend_above(axes, columns=4 if max(map(len, names)) < 8 else 2)


def _draw_curve(
    axes: Axes,
    t: FloatArray,
    curve: FloatArray,
    buckets: int = BUCKETS,
    band: bool = True,
    **line: Any,
) -> None:
    """Draw the mean of each stretch as a line in a pale band of its extremes.

    A band thinner than the line is left out; a noisy curve stays readable among others.
    """
    curve = np.where(np.isfinite(curve), curve, np.nan)  # a gap in the line
    times, mean, least, greatest = envelope(t, curve, buckets)
    axes.plot(times, mean, **line)
    if band and len(times) < len(t) and not np.max(greatest - least) <= 0.01 * np.ptp(curve):
        axes.fill_between(times, least, greatest, color=line["color"], alpha=0.25, linewidth=0.3)


def _draw_limits(axes: Axes, bounds: list[FloatArray], labels: list[str], colors: Any) -> None:
    """Draw the limits near the curves, beside each the joints that it belongs to.

    A limit far off would only flatten the curves. Limits too near each other share their names.
    """
    low, high = axes.get_ylim()
    margin = 0.15 * (high - low)
    values = np.concatenate(bounds)
    tags: list[list[int]] = []
    for i in np.argsort(values):
        if not low - margin <= values[i] <= high + margin:
            continue
        if not tags or values[i] - values[tags[-1][0]] > _TAG_HEIGHT * (high - low):
            tags.append([])
        tags[-1].append(int(i))
    for number, tag in enumerate(tags):
        joints = sorted({i % len(labels) for i in tag})
        color = colors[joints[0]] if len(joints) == 1 else "0.0"
        style = _LIMIT_LINE | {"color": color}
        for value in np.unique(values[tag]):
            axes.axhline(value, label=None if number else "limit", **style)
            number += 1
        names = ", ".join(labels[joint] for joint in joints)
        axes.annotate(
            "all" if len(joints) == len(labels) else names,
            (1.01, float(values[tag].mean())),
            xycoords=axes.get_yaxis_transform(),
            va="center",
            fontsize=6,
            color=color,
        )


def draw_error(axes: Axes, record: Record, largest: float | None = None) -> None:
    """Draw the position error's components and norm over time, in the unit that suits its size.

    With `largest` [m] the unit and the axis suit that size instead: panels to be compared. A rough
    error, as under noise, is shown by the means of longer stretches, and the norm's range.
    """
    error = position_error(record)
    norm = np.linalg.norm(error, axis=1)
    size = float(np.nanmax(norm, initial=0.0)) if largest is None else largest
    fitting = (pair for pair in _LENGTH_UNITS if size >= pair[1])
    unit, scale = next(fitting, _LENGTH_UNITS[0] if size == 0.0 else _LENGTH_UNITS[-1])
    rough = _is_rough(record.t, norm)
    buckets = _COARSE if rough else BUCKETS
    for (label, color, dashes), curve in zip(_COMPONENTS, error.T, strict=True):
        style = {"color": color, "linestyle": dashes, "label": label}
        # Without bands if rough: four of them would hide each other.
        _draw_curve(axes, record.t, curve / scale, buckets, band=not rough, **style)
    _draw_curve(axes, record.t, norm / scale, buckets, color="0.0", label=r"$\|e\|$")
    time_axis(axes, record)
    if largest:
        axes.set_ylim(-1.05 * largest / scale, 1.05 * largest / scale)
    axes.set_ylabel(f"Position error [{unit}]")
    legend_above(axes, columns=4)


def _is_rough(t: FloatArray, curve: FloatArray) -> bool:
    """Test whether the ups and downs of a curve, means of short stretches, dwarf its height."""
    mean = envelope(t, curve)[1]
    mean = mean[np.isfinite(mean)]
    return bool(np.abs(np.diff(mean)).sum() > _ROUGH * mean.max(initial=0.0))


def draw_distance(axes: Axes, record: Record) -> None:
    """Draw the distance of the nearest pair [m] over time, and the least that is allowed."""
    # Of each stretch the smallest: that is what counts.
    times, _, least, _ = envelope(record.t, record.filled("distance"))
    axes.plot(times, least, color="0.0", label="nearest pair")
    allowed = record.settings["collisions"]["distance"]
    axes.axhline(allowed, label="least allowed", **_LIMIT_LINE)
    axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]))
    time_axis(axes, record)
    axes.set_ylabel("Distance [m]")
    legend_above(axes, columns=2)


def draw_log(
    axes: Axes, t: FloatArray, values: FloatArray, names: list[str], tolerance: float = 0.0
) -> None:
    """Draw positive values on a log scale: each stretch's largest as a line, its range as a band.

    The times (N,) are in [s], the values (N, k) have k names. Answers that never came (inf) are
    crosses at the top, a tolerance above zero is a dashed line.
    """
    axes.set_yscale("log")
    for name, curve, color in zip(names, values.T, cycle(("0.15", "0.55", "0.35"))):
        missing = np.isinf(curve)
        # A log scale has no point for zero; a residual may well be zero.
        shown = (curve > 0.0) & ~missing
        times, _, least, greatest = envelope(t[shown], curve[shown])
        if times.size:
            axes.fill_between(times, least, greatest, color=color, alpha=0.25, linewidth=0.3)
            _widen(axes, least.min(), greatest.max())
        alone = "." if len(times) == 1 else ""
        axes.plot(times, greatest, color=color, linewidth=0.8, marker=alone, label=name)
        if missing.any():
            marks = t[missing][:: max(int(missing.sum()) // 100, 1)]
            height = np.full_like(marks, 0.96)
            top = axes.get_xaxis_transform()
            axes.plot(marks, height, "x", color="0.0", transform=top, label=f"{name} failed")
    if tolerance > 0.0:
        axes.axhline(tolerance, color="0.0", linestyle="--", label="tolerance")
        _widen(axes, tolerance, tolerance)
    legend_above(axes, columns=3)


def _widen(axes: Axes, low: float, high: float) -> None:
    """Leave half a decade around these values, so that the axis of a single one has a length."""
    axes.update_datalim([(0.0, low / 3.0), (0.0, high * 3.0)], updatex=False)


def time_axis(axes: Axes, record: Record) -> None:
    """Label the time axis and let it span the run."""
    axes.set_xlabel("Time [s]")
    if record.steps:
        axes.set_xlim(record.t[0], record.t[-1])


def legend_above(axes: Axes, columns: int) -> None:
    """Put the legend above the axes, where it covers no data."""
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=columns, borderaxespad=0.2)


FIGURES: dict[str, Callable[[Record], Figure]] = {
    "overview": overview_figure,
    "path": path_figure,
    "joint_angles": partial(_single, draw_joints, name="q"),
    "joint_velocities": partial(_single, draw_joints, name="dq"),
    "position_error": partial(_single, draw_error),
    "convergence": convergence_figure,
    "torques": partial(_single, draw_joints, name="torque"),
    "distance": partial(_single, draw_distance),
    "frames": frames_figure,
    "path_time": path_time_figure,
}
"""Figures of a run by the names of their files."""

_DRAWN_IF: dict[str, Callable[[Record], bool]] = {
    "torques": lambda record: record.torque is not None,
    "distance": lambda record: record.distance is not None,
    "frames": lambda record: record.frame_position is not None,
    "path_time": lambda record: bool(is_slowed(record).any()),
}
