"""Texts about a run, from one list of rows: the summary on the terminal, and report.md."""

import os
import platform
import re
import shlex
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from tabulate import tabulate

from iiwa_dnn.files import prepare_folder, write_json, write_text
from iiwa_dnn.naming import DONE, describe, unwatched
from iiwa_dnn.results.failures import (
    completed,
    counted,
    failures,
    qps_checked,
    unlimited,
)
from iiwa_dnn.results.metrics import JOINT_LIMITS, compute_metrics
from iiwa_dnn.results.plots import CAPTIONS, save_figures
from iiwa_dnn.results.record import Record

_PACE = "realtime_factor"

_RESULTS = (
    ("largest position error", "max_position_error_m", "m"),
    ("mean squared position error per axis", "mse_position_error_m2", "m²"),
    ("largest orientation error", "max_orientation_error_rad", "rad"),
    ("joint drift, start to end", "joint_drift_rad", "rad"),
    ("largest kinetic index", "max_kinetic_index", "rad²/s² (J with kinetic = inertia)"),
    ("wall time", "wall_time_s", "s"),
    ("real-time factor", _PACE, ""),
    ("largest KKT residual", "max_kkt_residual", ""),
    ("steps with an active bound or row", "active_limit_steps", ""),
    *((f"{kind} limit violation", name, unit) for name, (kind, unit) in JOINT_LIMITS.items()),
    ("network iterations per step, mean", "network_iterations.mean", ""),
    ("network iterations per step, largest", "network_iterations.max", ""),
    ("largest gap to the reference", "crosscheck.max_solution_gap", "rad/s"),
    ("largest residual of a reference", "crosscheck.max_reference_residual", ""),
    ("largest position error, settled", "physics.max_position_error_settled_m", "m"),
    ("largest torque of each joint", "physics.max_torque_n_m", "N m"),
    ("largest torque, of its limit", "physics.max_torque_fraction", ""),
    ("largest torque for a command, of its limit", "demand.max_fraction", ""),
    ("least distance", "collisions.least_distance_m", "m"),
    ("least distance allowed", "collisions.allowed_m", "m"),
    ("nearest pair, one body", "collisions.first", ""),
    ("nearest pair, other body", "collisions.second", ""),
    ("nearest pair at the first stop", "collisions.at_stop", ""),
    ("steps with a clipped command", "incidents.clipped_steps", ""),
    *((f"steps {word}", f"incidents.{own}_steps", "") for own, word in DONE.items()),
)
"""Rows of results: quantity, key path in the metrics, and unit."""

_MOST = 6
"""Limits of each kind that have a row of their own, and entries of a long list that are shown."""


def save_run(
    record: Record,
    folder: str | os.PathLike[str],
    plots: bool = True,
    more: Callable[[Record, Path], list[Path]] | None = None,
    paper: Mapping[str, float] | None = None,
) -> dict[str, Any]:
    """Write record.npz, metrics.json, figures and report.md into a folder, made if need be.

    Each file is written atomically, the record first; figures only with `plots`. `more` draws
    further figures into the folder and returns their files. `paper` has published numbers by the
    names of the metrics, which the report shows beside the run's.

    Returns:
        The metrics, as in metrics.json.

    Raises:
        FileError: If the folder cannot be written.
    """
    folder = prepare_folder(folder)
    record.save(folder / "record.npz")
    metrics = compute_metrics(record)
    write_json(folder / "metrics.json", metrics)
    figures = save_figures(record, folder) if plots else []
    figures += more(record, folder) if more is not None else []
    write_text(folder / "report.md", report(metrics, figures, paper))
    return metrics


def report(
    metrics: Mapping[str, Any],
    figures: Iterable[Path] = (),
    paper: Mapping[str, float] | None = None,
) -> str:
    """Return a report in Markdown that shows the PNG files among the figures, which lie beside it.

    Every number in it is one of the metrics, or one of the paper's.
    """
    settings = metrics["settings"]
    shown = [(key, _text(value)) for key, value in settings.items() if value not in (None, [], {})]
    parts = [
        f"# {settings['robot']}: {counted(metrics['steps'])}, {settings['mode']}",
        "## Verdict",
        *(f"- {line}" for line in verdict(metrics)),
        "## Results",
        markdown_table(("quantity", "value", "unit"), rows(metrics, paper)),
        "## Settings",
        markdown_table(("setting", "value"), shown),
        "## Made",
        *(f"- {name}: {value}" for name, value in provenance(metrics["versions"]).items()),
        *(f"![{CAPTIONS[path.stem]}]({path.name})" for path in figures if path.suffix == ".png"),
    ]
    return "\n\n".join(parts).replace("\n\n- ", "\n- ") + "\n"


def provenance(versions: Mapping[str, str]) -> dict[str, str]:
    """Return date, machine, versions of packages and command of this process, by name."""
    packages = ", ".join(f"{name} {value}" for name, value in versions.items())
    return {
        "date": datetime.now(timezone.utc).strftime("%Y-%m-%d %H:%M UTC"),
        "machine": f"{platform.system()}, {platform.machine()}, {os.cpu_count()} cores",
        "versions": f"Python {platform.python_version()}, {packages}",
        "command": f"`{shlex.join([Path(sys.argv[0]).name, *sys.argv[1:]])}`",
    }


def summary(metrics: Mapping[str, Any]) -> str:
    """Sum up a run in aligned lines of ASCII, for the terminal, the verdict first."""
    lines = [("verdict", line) for line in verdict(metrics)]
    lines += [(name, f"{value} {unit}") for name, value, unit in rows(metrics)]
    table = tabulate(lines, tablefmt="plain", disable_numparse=True)
    return re.sub(" +$", "", table, flags=re.MULTILINE).replace("²", "^2").replace("³", "^3")


def rows(
    metrics: Mapping[str, Any], paper: Mapping[str, float] | None = None
) -> Iterator[tuple[str, str, str]]:
    """Yield the results of a run: quantity, value in words, and unit.

    Numbers that do not exist are left out, and counts of no steps.
    """
    yield "cross-check", qps_checked(metrics), ""
    yield "path completed", completed(metrics), ""
    for name, key_path, unit in _RESULTS:
        value = _at(metrics, key_path)
        if value is not None and (value or not key_path.startswith("incidents.")):
            beside = (
                f" (the paper's {_text(paper[key_path])})" if paper and key_path in paper else ""
            )
            yield name, _text(value) + beside, unit or _pace(metrics) * (key_path == _PACE)
    for frame, errors in metrics.get("frames", {}).items():
        for name, key_path, unit in _RESULTS:
            if key_path in errors:
                yield f"{name}, {frame}", _text(errors[key_path]), unit
    yield from _limits(metrics["incidents"])


def _pace(metrics: Mapping[str, Any]) -> str:
    """Return the words for a real-time factor: of which rate, and with which check."""
    solver = metrics["crosscheck"]["solver"]
    check = "" if solver == "none" else f", each QP solved again by {solver}"
    return f"simulated time over wall time, at {1.0 / metrics['settings']['dt']:,.0f} Hz{check}"


def _limits(incidents: Mapping[str, Any]) -> Iterator[tuple[str, str, str]]:
    """Yield the active limits, and those that left no solution, as `rows` does."""
    for effect, key in (("active", "active"), ("leaves no solution", "limiting")):
        for limit in incidents[key][:_MOST]:
            since = f"{counted(limit['steps'])}, from {_text(limit['time_s'])} s on"
            yield f"{describe(limit)} {effect}", since, ""


def _at(metrics: Mapping[str, Any], key_path: str) -> Any:
    """Return the metric at a path of keys, as ``crosscheck.tolerance``; None if there is none."""
    found: Any = metrics
    for key in key_path.split("."):
        found = (found or {}).get(key)
    return found


def verdict(metrics: Mapping[str, Any]) -> list[str]:
    """Return the verdict on a run: its failures or its success, then warnings.

    A success claims no more than the check did. Limits of the robot that the run was told not to
    keep, and by how much joints exceeded them, come first.
    """
    check = metrics["crosscheck"]
    beyond = [*unlimited(metrics, named=True)]
    kept = "within all other limits" if beyond else "within all limits"
    success = f"completed {kept}; not judged by a reference"
    if check["judged"]:
        solved = f"all {counted(metrics['steps'])} solved, {kept}"
        success = f"{solved} and in agreement with {' or '.join(check['judged_by'])}"
    said = beyond + (failures(metrics) or [success])
    links = (metrics["settings"].get("collisions") or {}).get("unwatched")
    return [*said, f"Beware: {unwatched(links)}."] if links else said


def _text(value: object) -> str:
    """Format a value for a reader, numbers in four digits."""
    if isinstance(value, Mapping):
        items = value.items()
        return ", ".join(f"{key} = {_text(item)}" for key, item in items if item is not None)
    if isinstance(value, list):
        return _listed(value)
    if isinstance(value, float):
        return f"{value:.4g}"
    return f"{value:,}" if type(value) is int else str(value)


def _listed(values: Sequence[Any]) -> str:
    """Format a list for a reader: equal entries once, a long list cut off."""
    if len(values) > 1 and all(item == values[0] for item in values):
        return f"{_text(values[0])} (all {len(values)})"
    shown = [f"({_text(v)})" if isinstance(v, list | dict) else _text(v) for v in values]
    if len(values) > 2 * _MOST:
        shown[_MOST:] = [f"and {len(values) - _MOST} more"]
    return " ".join(shown)


def markdown_table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Lay out a table of texts in Markdown; line ends and bars within cells are replaced."""
    cells = [
        [" ".join(str(text).split()).replace("|", "\\|") for text in row] for row in (head, *rows)
    ]
    table = tabulate(cells, "firstrow", "pipe", disable_numparse=True)
    return re.sub("  +", " ", re.sub(r"(?<=\|):?-+(?=\|)", ":---", table))  # without the padding
