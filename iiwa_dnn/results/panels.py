"""The contents of one pair of axes; `plots` puts them together into figures."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np

from iiwa_dnn.results.metrics import position_error
from iiwa_dnn.results.record import FloatArray, Record

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BUCKETS = 700
"""Stretches that a curve is cut into: one for each pixel across a column at 200 dots an inch."""

_JOINTS = {
    "q": (r"$q_{}$", "Joint angle [rad]"),
    "dq": (r"$\dot{{q}}_{}$", "Joint velocity [rad/s]"),
    "torque": (r"$\tau_{}$", "Joint torque [N m]"),
}
_DASHES = ("-", "--", "-.", ":")
_MARKERS = "os^Dv<>PXd"
_LENGTH_UNITS = (("m", 1.0), ("mm", 1e-3), ("µm", 1e-6), ("nm", 1e-9), ("pm", 1e-12))


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
    desired, actual = record.position_desired[:, columns].T, record.position[:, columns].T
    # Wide and pale under thin and dark: both stay visible where they coincide.
    axes.plot(*desired, color="0.72", linewidth=3.2, label="desired")
    axes.plot(*actual, color="0.0", linestyle="--", label="actual")
    axes.plot(*actual[:, :1], color="0.0", marker="o", linestyle="", markersize=4, label="start")
    labels = [f"${'xyz'[column]}$ [m]" for column in columns]
    axes.set_xlabel(labels[0])
    axes.set_ylabel(labels[1])
    if plane is None:
        axes.set_zlabel(labels[2])
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

    The name is ``"q"``, ``"dq"`` or ``"torque"``; the first two come with the limits near them.
    """
    import matplotlib

    values, (label, quantity) = getattr(record, name), _JOINTS[name]
    t, joints = record.t[: len(values)], record.dof
    colours = matplotlib.colormaps["viridis"](np.linspace(0.0, 0.85, joints))
    every = max(min(len(t), BUCKETS) // 7, 1)
    for joint, curve in enumerate(values.T):
        _draw_curve(
            axes, t, curve, color=colours[joint], linestyle=_DASHES[joint % len(_DASHES)],
            marker=_MARKERS[joint % len(_MARKERS)],
            # Each joint's markers start elsewhere, lest they lie on top of each other.
            markevery=(every * joint // joints, every), label=label.format(joint + 1),
        )  # fmt: skip
    time_axis(axes, record)
    if name == "q":
        _draw_limits(axes, record.settings["q_lower"] + record.settings["q_upper"])
    elif name == "dq":
        speeds = [speed for speed in record.settings["dq_max"] if speed is not None]
        _draw_limits(axes, [*speeds, *(-speed for speed in speeds)])
    axes.set_ylabel(quantity)
    legend_above(axes, columns=4)


def _draw_curve(axes: Axes, t: FloatArray, curve: FloatArray, **line: Any) -> None:
    """Draw the mean of each stretch as a line in a pale band of its extremes.

    A smooth curve's band is as thin as its line; a noisy one stays readable among others.
    """
    curve = np.where(np.isfinite(curve), curve, np.nan)  # a gap in the line
    times, mean, least, greatest = envelope(t, curve)
    axes.plot(times, mean, **line)
    # A band thinner than the line would only make the PDF larger.
    if len(times) < len(t) and not np.max(greatest - least) <= 0.01 * np.ptp(curve):
        colour = line["color"]
        axes.fill_between(times, least, greatest, color=colour, alpha=0.25, linewidth=0.3)


def _draw_limits(axes: Axes, limits: list[float | None]) -> None:
    """Draw the limits near the curves; one far off would only flatten them."""
    low, high = axes.get_ylim()
    margin = 0.15 * (high - low)
    near = {x for x in limits if x is not None and low - margin <= x <= high + margin}
    for number, limit in enumerate(sorted(near)):
        label = None if number else "limit"
        axes.axhline(limit, color="0.0", linewidth=0.8, linestyle=(0, (8, 3)), label=label)


def draw_error(axes: Axes, record: Record, largest: float | None = None) -> None:
    """Draw the position error's components and norm over time, in the unit that suits its size.

    With `largest` [m] the unit and the axis suit that size instead: panels to be compared.
    """
    error = position_error(record)
    norm = np.linalg.norm(error, axis=1)
    size = float(np.nanmax(norm, initial=0.0)) if largest is None else largest
    fits = (pair for pair in _LENGTH_UNITS if size >= pair[1])
    unit, scale = next(fits, _LENGTH_UNITS[0] if size == 0.0 else _LENGTH_UNITS[-1])
    styles = (("$e_x$", "0.35", "--"), ("$e_y$", "0.5", "-."), ("$e_z$", "0.65", ":"))
    for (label, colour, dashes), curve in zip(styles, error.T, strict=True):
        _draw_curve(axes, record.t, curve / scale, color=colour, linestyle=dashes, label=label)
    _draw_curve(axes, record.t, norm / scale, color="0.0", linestyle="-", label=r"$\|e\|$")
    time_axis(axes, record)
    if largest:
        axes.set_ylim(-1.05 * largest / scale, 1.05 * largest / scale)
    axes.set_ylabel(f"Position error [{unit}]")
    legend_above(axes, columns=4)


def draw_log(
    axes: Axes, t: FloatArray, values: FloatArray, names: list[str], tolerance: float = 0.0
) -> None:
    """Draw positive values on a log scale: each stretch's largest as a line, its range as a band.

    The times (N,) are in [s], the values (N, k) have k names. Answers that never came (inf) are
    crosses at the top, a tolerance above zero is a dashed line.
    """
    axes.set_yscale("log")
    for name, curve, colour in zip(names, values.T, cycle(("0.15", "0.55", "0.35"))):
        missing = np.isinf(curve)
        # A log scale has no place for zero; a residual may well be zero.
        shown = (curve > 0.0) & ~missing
        times, _, least, greatest = envelope(t[shown], curve[shown])
        if times.size:
            axes.fill_between(times, least, greatest, color=colour, alpha=0.25, linewidth=0.3)
            _make_room(axes, least.min(), greatest.max())
        alone = "." if len(times) == 1 else ""
        axes.plot(times, greatest, color=colour, linewidth=0.8, marker=alone, label=name)
        if missing.any():
            times = t[missing][:: max(int(missing.sum()) // 100, 1)]
            top = axes.get_xaxis_transform()
            height = np.full_like(times, 0.96)
            axes.plot(times, height, "x", color="0.0", transform=top, label=f"{name} failed")
    if tolerance > 0.0:
        axes.axhline(tolerance, color="0.0", linestyle="--", label="tolerance")
        _make_room(axes, tolerance, tolerance)
    legend_above(axes, columns=3)


def _make_room(axes: Axes, low: float, high: float) -> None:
    """Leave half a decade around these values, that a single one too has an axis to stand on."""
    axes.update_datalim([(0.0, low / 3.0), (0.0, high * 3.0)], updatex=False)


def time_axis(axes: Axes, record: Record) -> None:
    """Label the time axis and let it span the run."""
    axes.set_xlabel("Time [s]")
    if record.steps:
        axes.set_xlim(record.t[0], record.t[-1])


def legend_above(axes: Axes, columns: int) -> None:
    """Put the legend above the axes, where it covers no data."""
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=columns, borderaxespad=0.2)
