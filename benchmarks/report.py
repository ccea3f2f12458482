"""The benchmark's report: Markdown, JSON and a plot, out of what was measured."""

from __future__ import annotations

import datetime
import os
import platform
import re
from collections.abc import Iterable, Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np

from iiwa_dnn.files import write_json, write_text
from iiwa_dnn.results.markdown import markdown_table
from iiwa_dnn.results.plots import DOUBLE_COLUMN, legend_above, new_figure, write_figures

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PACKAGES = (
    "iiwa-dnn",
    "daqp",
    "osqp",
    "piqp",
    "proxsuite",
    "quadprog",
    "qpsolvers",
    "numpy",
)

LIMITS = """\
- One process on one machine, with whatever else runs on it. The peers take turns every 50 programs,
  so that noise falls on all alike; differences of a few per cent mean nothing.
- The clock runs over the Python call: what a caller waits for. For programs this small, the call
  itself is much of it, and the compiled solvers would be quicker without it.
- Each peer gets each program in its own layout before the clock starts.
- Asked for is an absolute tolerance of 1e-9. Active-set solvers return more than that for nothing;
  the others stop there. An answer whose residual is above 1e-8 counts as failed, though its time
  counts.
- This package's solver takes programs as checked. A first call, which compiles, is left out.
- The random programs are often degenerate: more constraints hold at the solution than there are
  variables, some without a multiplier. That is where quadprog gives up.
- Warm means that a solver starts from its last answer, where it can. quadprog cannot.
"""


_SOLVERS = {
    "solver": "{solver}",
    "median µs": "{median_us:.2f}",
    "p99 µs": "{p99_us:.1f}",
    "worst residual": "{worst_residual:.1e}",
    "failed": "{failed} of {programs}",
}
_KNOWN = {
    "kind": "{kind}",
    "recognised": "{recognised} of {programs}",
    "median ms": "{median_ms:.3f}",
    "largest ms": "{largest_ms:.2f}",
    "largest error of x": "{largest_error:.1e}",
}


def processor() -> str:
    """The processor's name, or the machine's type if the system does not give the name."""
    file = Path("/proc/cpuinfo")
    text = file.read_text(encoding="utf-8") if file.exists() else ""
    found = re.search(r"(?m)^model name\s*:\s*(.+)$", text)
    return found[1].strip() if found else platform.processor() or platform.machine()


def environment(more: Sequence[str] = ()) -> dict[str, Any]:
    """Date, processor and versions; `more` are packages to name beside ``PACKAGES``."""
    return {
        "date": datetime.datetime.now(tz=datetime.timezone.utc).isoformat(timespec="seconds"),
        "cpu": processor(),
        "cores": os.cpu_count(),
        "python": platform.python_version(),
        "versions": {name: version(name) for name in (*PACKAGES, *more)},
    }


def made_on(where: Mapping[str, Any]) -> str:
    """Return an `environment` in words."""
    versions = ", ".join(f"{name} {number}" for name, number in where["versions"].items())
    cores = f"{where['cores']} cores, Python {where['python']}"
    return f"{where['date']}, {where['cpu']}, {cores}, {versions}."


def tabulate(columns: Mapping[str, str], rows: Iterable[Mapping[str, Any]]) -> str:
    """Lay out a table in Markdown, a column by its head and the format of its cells."""
    return markdown_table([*columns], ([_cell(f, row) for f in columns.values()] for row in rows))


def _cell(text: str, row: Mapping[str, Any]) -> str:
    try:
        return text.format_map(row)
    except TypeError:  # None, where there is no number
        return ""


def save_report(results: Mapping[str, Any], folder: Path) -> list[Path]:
    """Write ``report.md``, ``results.json`` and ``times.png``/``.pdf``.

    Args:
        results: ``environment``, ``streams`` (name, about, warm, rows) and ``known``.
        folder: Where to; it exists.

    Returns:
        The files written.
    """
    write_json(folder / "results.json", results)
    write_text(folder / "report.md", markdown(results))
    figures = write_figures({"times": lambda: times_figure(results["streams"])}, folder)
    return [folder / "report.md", folder / "results.json", *figures]


def markdown(results: Mapping[str, Any]) -> str:
    """The report's text."""
    parts = [
        "# Solvers of small quadratic programs",
        made_on(results["environment"]),
        "![Median time of each solver on each stream](times.png)",
    ]
    for stream in results["streams"]:
        parts += [f"## {stream['name']}", f"{stream['about'].capitalize()}."]
        parts += [tabulate(_SOLVERS, stream["rows"]), verdict(stream["rows"])]
    parts += [
        "## Programs known by construction",
        tabulate(_KNOWN, results["known"]),
        "## Limits of the comparison",
        LIMITS,
    ]
    return "\n\n".join(parts)


def verdict(rows: Sequence[Mapping[str, Any]]) -> str:
    """This package's median beside that of the quickest peer without failures."""
    ours, *peers = rows
    sound = [row for row in peers if row["failed"] == 0] or peers
    best = min(sound, key=lambda row: float(row["median_us"]))
    ratio = ours["median_us"] / best["median_us"]
    return f"iiwa_dnn takes {ratio:.2f} times what the quickest peer takes, {best['solver']}."


def times_figure(streams: Sequence[Mapping[str, Any]]) -> Figure:
    """Median times, one group for each stream, on a logarithmic scale."""
    figure = new_figure(DOUBLE_COLUMN, 3.2)
    axes = figure.add_subplot()
    names = [row["solver"] for row in streams[0]["rows"]]
    shades = matplotlib.colormaps["viridis"](np.linspace(0.15, 0.9, len(names)))
    for i, name in enumerate(names):
        times = [stream["rows"][i]["median_us"] for stream in streams]
        places = [k + 0.08 * (i - 0.5 * (len(names) - 1)) for k in range(len(streams))]
        colour = shades[i] if i else "0.0"  # the network's own
        axes.plot(places, times, "os^Dv<>PX"[i % 9], color=colour, markersize=4, label=name)
    for edge in range(1, len(streams)):
        axes.axvline(edge - 0.5, color="0.8", linewidth=0.6)
    axes.grid(visible=False, axis="x")
    axes.set_yscale("log")
    axes.set_ylabel("Median time [µs]")
    labels = [stream["name"].replace(", ", ",\n") for stream in streams]
    axes.set_xticks(range(len(streams)), labels)
    legend_above(axes, columns=5)
    return figure
