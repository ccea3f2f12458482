"""The settings that the paper leaves out, sought in a grid by the paper's numbers.

Every run draws the paper's heart at the paper's control period. The grid is walked without noise
and with the weight of Table II: from the setting that was inferred, every one that differs in at
most two entries of `GRID`; then, from the nearest so far, those that differ in one, until none is
nearer. The nearest runs in full: all weights, and Table II by the entry of the noise.

A row of the paper is compared with ours by the root mean square, over its numbers, of the decimal
logarithm of ours over the paper's. The distance of a setting is the root mean square over the rows.
What needs no run is read from the results in each of `READINGS`: the definitions of the largest
error and of the mean square, and whether the index was multiplied by the control period.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, replace
from functools import partial
from itertools import combinations, product
from operator import itemgetter
from pathlib import Path
from typing import Any

import numpy as np

from iiwa_dnn.files import plain, write_json, write_text
from iiwa_dnn.results.plots import COLUMN, new_figure, write_figures
from iiwa_dnn.results.report import markdown_table
from iiwa_dnn.simulation import NOISE_ENTRIES
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.paper_report import short
from iiwa_dnn.studies.runs import HeartRun, Scope

Fit = dict[str, Any]

GRID: dict[str, tuple[Any, ...]] = {
    "scale": (3.45e-3, 1e-3, 2e-3, 1e-2, 4e-2),
    "period": (10.0, 5.0, 2.0 * np.pi, 20.0),
    "phase": (0.0, 0.25, 0.5, 0.75),
    "start": (0.0, 0.1, 0.5),
    "substeps": (8, 1, 7, "implicit"),
    "mode": ("continuous", "converged"),
    "orientation": ("block", "so3", "none"),
    "limit_gain": (20.0, 1.0, 0.3, 0.24, 0.1),
    "orientation_gain": (10.2, 0.0, 100.0),
    "velocity": (np.inf, 0.3),
}
"""Values of the entries of `HeartRun` that the paper leaves out; the first is the inferred one."""

INFERRED = HeartRun(substeps=8)
SEEDS = 3
"""Seeds of each noise, at most; its unit needs no run, since what it adds to the mean square error
goes with its square."""

READINGS: dict[str, dict[str, tuple[str, float]]] = {
    "error": {"norm": ("max_position_error_m", 1.0), "largest axis": ("max_axis_error_m", 1.0)},
    "square": {
        "mean over the axes": ("mse_position_error_m2", 1.0),
        "sum over the axes": ("mse_position_error_m2", 3.0),
    },
    "index": {
        "index times the period": ("max_kinetic_index_times_dt", 1.0),
        "index as defined": ("max_kinetic_index_times_dt", 1.0 / paper.DT),
    },
    "drift": {"": ("joint_drift_rad", 1.0)},
    "time": {"": ("time_of_max_error_s", 1.0)},
}
"""Numbers of `measure`, and factors on them, by what the paper prints and how it may be read."""

ROWS: dict[str, tuple[str, dict[float, float | None]]] = {
    "Table I, MAX E": (
        "error",
        dict(zip(paper.WEIGHTS, paper.TABLE1["max_position_error_m"], strict=True)),
    ),
    "Table I, drift": (
        "drift",
        dict(zip(paper.WEIGHTS, paper.TABLE1["joint_drift_rad"], strict=True)),
    ),
    "Table I, index": (
        "index",
        dict(zip(paper.WEIGHTS, paper.TABLE1["max_kinetic_index_times_dt"], strict=True)),
    ),
    "Table II, MAX E": ("error", {paper.WEIGHT: paper.TABLE2["max_position_error_m"][0]}),
    "Table II, MSE": ("square", {paper.WEIGHT: paper.TABLE2["mse_position_error_m2"][0]}),
    "Fig. 1, at most": ("error", {paper.WEIGHT: 1e-4}),
    "time of MAX E, at most": ("time", {paper.WEIGHT: 1.0}),
}
"""Rows of the paper without noise: what they hold, by `READINGS`, and their numbers by the weight.

Fig. 1 is said to stay below 1e-4 m; "at the beginning" is taken as the first second.
"""


def neighbours(run: HeartRun, apart: int) -> list[HeartRun]:
    """List a setting and all that differ from it in at most `apart` entries of the grid."""
    found = {
        replace(run, **dict(zip(names, values, strict=True))): None
        for names in combinations(GRID, apart)
        for values in product(*(GRID[name] for name in names))
    }
    return list({run: None} | found)


def identify(folder: Path, compute: Callable[[list[HeartRun]], list[Any]], scope: Scope) -> str:
    """Walk the grid, run the nearest setting in full, and write the results into a folder.

    Args:
        folder: The folder.
        compute: Returns the results of `measure` for a list of runs.
        scope: Period, length and seeds of the runs.

    Returns:
        The report.
    """
    fits = search(compute, replace(INFERRED, dt=scope.dt, duration=scope.duration))
    nearest = HeartRun(**fits[0]["run"])
    return report(folder, fits, *in_full(compute, nearest, min(scope.seeds, SEEDS)))


def search(
    compute: Callable[[list[HeartRun]], list[Any]], centre: HeartRun, apart: int = 2
) -> list[Fit]:
    """Walk the grid; return the settings, the nearest first.

    Args:
        compute: Returns the results of `measure` for a list of runs.
        centre: Setting to begin with.
        apart: Number of entries in which the first settings differ from it at most.
    """
    fits: dict[HeartRun, Fit] = {}
    new = neighbours(centre, apart)
    while new:
        for run, values in zip(new, compute(new), strict=True):
            fits[run] = fit(run, {paper.WEIGHT: values})
        nearest = min(fits, key=lambda run: fits[run]["distance"])
        new = [run for run in neighbours(nearest, 1) if run not in fits]
    return sorted(fits.values(), key=itemgetter("distance"))


def fit(run: HeartRun, ours: Mapping[float, Mapping[str, Any]]) -> Fit:
    """Compare a setting with the paper, in the reading in which it is nearest.

    Args:
        run: The setting.
        ours: Its results by the weight.

    Returns:
        In JSON types: ``run``; ``changes``, the entries of the grid that are not the inferred ones;
        ``distance``; ``rows``, the distance of each row; ``ours``, our numbers of each row;
        ``readings``.
    """
    values = {name: getattr(run, name) for name in GRID}
    changed = [f"{name} {_text(values[name])}" for name in GRID if values[name] != GRID[name][0]]
    fits = []
    for names in product(*READINGS.values()):
        readings = dict(zip(READINGS, names, strict=True))
        numbers = {}
        rows = {}
        for title, (read, printed) in ROWS.items():
            key, factor = READINGS[read][readings[read]]
            known = {weight: value for weight, value in printed.items() if value and weight in ours}
            numbers[title] = [factor * ours[weight][key] for weight in known]
            # A time may be zero: its logarithm is to be finite.
            ratios = np.log10(np.maximum(numbers[title], 1e-30) / [*known.values()])
            rows[title] = _rms(np.maximum(ratios, 0.0) if "at most" in title else ratios)
        fits.append(
            {
                "distance": _rms([*rows.values()]),
                "rows": rows,
                "ours": numbers,
                "readings": readings,
            }
        )
    nearest = min(fits, key=itemgetter("distance"))
    return {"run": asdict(run), "changes": ", ".join(changed) or "none", **nearest}


def in_full(
    compute: Callable[[list[HeartRun]], list[Any]], run: HeartRun, seeds: int
) -> tuple[Fit, dict[str, list[Any]]]:
    """Run a setting with every weight, and Table II with every entry of the noise.

    Returns:
        The fit with all weights; and by the noise's entry, for each column of Table II, the means
        over the seeds, without and with the filter.
    """
    quiet = compute([replace(run, weight=weight) for weight in paper.WEIGHTS])
    noise = replace(run, weight=paper.WEIGHT, noise=paper.NOISE)
    cases = product(NOISE_ENTRIES, (1, paper.WINDOW), range(seeds))
    found = compute([replace(noise, noise_at=n, filter_window=w, seed=k) for n, w, k in cases])
    values = np.reshape([[each[key] for key in paper.TABLE2] for each in found], (-1, 2, seeds, 2))
    means = values.mean(axis=2).swapaxes(1, 2).tolist()
    noisy = dict(zip(NOISE_ENTRIES, means, strict=True))
    return fit(run, dict(zip(paper.WEIGHTS, quiet, strict=True))), noisy


def report(folder: Path, fits: Sequence[Fit], full: Fit, noisy: Mapping[str, list[Any]]) -> str:
    """Write ``identify.json``, ``identify.md`` and the picture into a folder; return the report.

    Args:
        folder: The folder.
        fits: The settings of the grid, the nearest first.
        full: The nearest, with all weights.
        noisy: Its Table II by the entry of the noise.
    """
    write_json(folder / "identify.json", plain({"full": full, "noise": noisy, "settings": fits}))
    (inferred,) = (each for each in fits if each["changes"] == "none")
    write_figures({"identify": partial(draw, fits, inferred)}, folder)
    rows = []
    pairs = []
    for title, (_, printed) in ROWS.items():
        least = min(fits, key=lambda each: each["rows"][title])
        ours = [_text(each["ours"][title]) for each in (inferred, full)]
        reached = f"{least['rows'][title]:.2f}: {least['changes']}"
        rows.append([title, _text([*printed.values()]), *ours, reached])
        apart = [[max(each["rows"][title], each["rows"][other]) for each in fits] for other in ROWS]
        pairs.append([title, *(short(min(distances)) for distances in apart)])
    nearest = [
        [short(each["distance"]), each["changes"], *map(short, each["rows"].values())]
        for each in (*fits[:10], inferred)
    ]
    table2 = {"paper": [values[2:] for values in paper.TABLE2.values()], **noisy}
    noise = [[name, *map(_text, columns)] for name, columns in table2.items()]
    readings = ", ".join(filter(None, full["readings"].values()))
    parts = [
        "# The paper, identified",
        f"{len(fits)} settings without noise. A distance is in decades; 0.30 is a factor of 2. "
        f"Nearest: {full['changes']}; read as: {readings}.",
        "![Distance of the settings from the printed numbers](identify.png)",
        markdown_table(("", "paper", "inferred", "nearest", "least distance of any"), rows),
        markdown_table(("distance", "changes", *ROWS), nearest),
        "The least distance that one setting has from both rows:",
        markdown_table(("", *ROWS), pairs),
        "The nearest with noise, by its entry, without and with the filter:",
        markdown_table(("noise", "MAX E [m]", "MSE [m²]"), noise),
    ]
    text = "\n\n".join(parts) + "\n"
    write_text(folder / "identify.md", text)
    return text


def draw(fits: Sequence[Fit], inferred: Fit) -> Any:
    """Draw the distance of every setting from each row of the paper, as a Matplotlib figure."""
    figure = new_figure(2 * COLUMN, 3.2)
    axes = figure.subplots()
    shifts = np.linspace(-0.3, 0.3, len(fits))
    for place, title in enumerate(ROWS):
        axes.plot([each["rows"][title] for each in fits], place + shifts, ".", color="0.7", ms=2)
    for each, mark, name in ((inferred, "s", "inferred"), (fits[0], "o", "nearest")):
        axes.plot([*each["rows"].values()], range(len(ROWS)), mark, label=name)
    axes.axvline(np.log10(2.0), color="0.4", linestyle="--", label="a factor of 2")
    axes.set(xscale="symlog", xlim=(0.0, None), yticks=range(len(ROWS)), yticklabels=ROWS)
    axes.set_xticks((0.0, 0.3, 1.0, 3.0), ("0", "0.3", "1", "3"))
    axes.set(xlabel="distance from the printed numbers [decades]", ylim=(len(ROWS) - 0.5, -0.5))
    axes.legend(ncols=3, loc="lower left", bbox_to_anchor=(0.0, 1.0))
    return figure


def _rms(values: Any) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def _text(value: Any) -> str:
    if isinstance(value, list | tuple):
        return ", ".join(map(short, value))
    return short(value) if isinstance(value, float) else str(value)
