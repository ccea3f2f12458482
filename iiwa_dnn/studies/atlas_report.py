"""The atlas's tables, verdicts, figure and report, out of the numbers of its cells."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from tabulate import tabulate as lay_out

from iiwa_dnn.files import write_text
from iiwa_dnn.results.report import markdown_table
from iiwa_dnn.studies.atlas import MEASURES, PERIODS, SOLVED, UNLIMITED, Cell, Size
from iiwa_dnn.studies.statistics import paired_difference

if TYPE_CHECKING:
    from iiwa_dnn.qp import Vector

Row = Mapping[str, Any]
PAPER = "projection (the paper's)"
MARGIN = 0.01
"""Difference of the decimal logarithms below which two networks are equal, 2.3 %."""

_REMARKS = """\
A place is formed by pairs of runs with the same seed: two networks are compared by the difference
of their mean log residuals over the disturbances, with Student's interval at 95 %. A difference
below 2.3 % or an interval that holds zero is a tie. A place "2–5" says that one network is better
and that three may be as good.

A number in brackets counts runs that failed; a network that lost one has no place."""


class Claim(NamedTuple):
    """A published claim that one network is better than another.

    Attributes:
        text: The claim.
        better: Name of the network that should be better.
        worse: Name of the other.
        disturbance: Disturbance under which.
    """

    text: str
    better: str
    worse: str
    disturbance: str = "none"


CLAIMS = (
    Claim("A zeroing network follows where a gradient network lags", "zeroing, Euler", "gradient"),
    Claim(
        "Finite time (sign-bi-power) is more exact than linear",
        "zeroing, sign-bi-power", "zeroing, Euler",
    ),
    Claim(
        "A power-sigmoid activation is more exact than linear",
        "zeroing, power-sigmoid", "zeroing, Euler",
    ),
    Claim("Fixed time is more exact than linear", "zeroing, fixed time", "zeroing, Euler"),
    Claim(
        "Predefined time is more exact than linear", "zeroing, predefined time", "zeroing, Euler"
    ),
    Claim("A growing gain is more exact", "zeroing, growing gain", "zeroing, Euler"),
    Claim(
        "The integral rejects a constant disturbance",
        "zeroing, noise-tolerant", "zeroing, Euler", "constant",
    ),
    Claim("The integral bounds a ramp", "zeroing, noise-tolerant", "zeroing, Euler", "ramp"),
    Claim(
        "The integral suppresses white noise", "zeroing, noise-tolerant", "zeroing, Euler", "white"
    ),
    Claim("A finite-time dual network beats the dual", "dual, finite time", "dual"),
    Claim("A fixed-time dual network beats the dual", "dual, fixed time", "dual"),
    Claim("A simplified dual network is no worse than the dual", "simplified dual", "dual"),
    Claim("The correction helps the one-layer network", "one-layer, corrected", "one-layer"),
    Claim("The paper's network beats the dual", PAPER, "dual"),
    Claim("The paper's network beats the primal-dual", PAPER, "primal-dual"),
    Claim("The paper's network beats a plain numerical method", PAPER, "ADMM (OSQP)"),
    Claim(
        "The paper's network by implicit steps beats a plain numerical method",
        "projection, implicit Euler", "ADMM (OSQP)",
    ),
)  # fmt: skip


def tabulate(cells: Sequence[Cell], results: Sequence[Row]) -> list[dict[str, Any]]:
    """Lay out a row for each cell: settings, numbers of its runs, and means of those completed."""
    rows = []
    for cell, result in zip(cells, results, strict=True):
        means = {}
        for name in MEASURES:
            known = [value for value in result[name] if value is not None]
            means[name] = float(np.mean(known)) if known else None
        lost = sum(value is None for value in result["residual"])
        rows.append({**asdict(cell), "lost": lost, "mean": means, **result})
    return rows


def find(rows: Sequence[Row], **wanted: Any) -> list[Row]:
    """Return the rows with these settings; scheme, work and period default to the first row's."""
    wanted = {name: rows[0][name] for name in ("scheme", "work", "dt")} | wanted
    return [row for row in rows if wanted.items() <= row.items()]


def of_every_disturbance(rows: Sequence[Row], network: str) -> list[Row]:
    """Return the row of a network for each disturbance, with the league's scheme and budget."""
    kinds = dict.fromkeys(row["disturbance"] for row in rows)
    return [find(rows, network=network, disturbance=kind)[0] for kind in kinds]


def scores(rows: Sequence[Row], network: str) -> Vector | None:
    """Return the mean decimal logarithm of a network's residual over the disturbances, (seeds,).

    Undisturbed residuals are repeated for the seeds of the same path. None stands for a network
    with a failed run.
    """
    found = of_every_disturbance(rows, network)
    if any(row["lost"] for row in found):
        return None
    count = max(len(row["residual"]) for row in found)
    return np.asarray(np.mean([np.resize(_logarithms(row), count) for row in found], axis=0))


def _logarithms(row: Row) -> Vector:
    """Return the decimal logarithms of a row's residuals, none below that of `SOLVED`."""
    return np.asarray(np.log10(np.maximum(row["residual"], SOLVED)))


def compare(one: Vector, other: Vector) -> int:
    """Compare paired numbers, (k,) both: -1 if the first are smaller, 1 if larger, 0 for a tie."""
    if abs(float(np.mean(one - other))) < MARGIN:
        return 0
    return paired_difference(one, other).sign


def ranks(rows: Sequence[Row]) -> dict[str, str]:
    """Return the rank of each network, the best first, as the range of places that ties allow.

    Networks with failed runs come last, without a place.
    """
    known = {name: scores(rows, name) for name in dict.fromkeys(row["network"] for row in rows)}
    ranked = {name: score for name, score in known.items() if score is not None}
    found = {}
    for name in sorted(ranked, key=lambda name: float(ranked[name].mean())):
        signs = [compare(ranked[name], other) for other in ranked.values()]
        first = 1 + signs.count(1)
        last = len(signs) - signs.count(-1)
        found[name] = str(first) if first == last else f"{first}–{last}"
    return found | {name: "–" for name, score in known.items() if score is None}


def judge(rows: Sequence[Row], claim: Claim) -> list[str]:
    """Judge a claim by the residuals of pairs of runs with the same seed.

    Returns:
        The claim, its disturbance, both networks with their means, and the verdict: ``holds`` or
        ``does not hold`` where the interval of the difference of logarithms says so or a network
        lost runs; ``tie``.
    """
    pair = [
        find(rows, network=name, disturbance=claim.disturbance)[0]
        for name in (claim.better, claim.worse)
    ]
    lost = [bool(row["lost"]) for row in pair]
    sign = int(lost[0]) - int(lost[1])
    if not any(lost):
        sign = compare(*map(_logarithms, pair))
    verdict = {-1: "holds", 0: "tie", 1: "does not hold"}[sign]
    means = [f"{row['network']}: {_shown(row)}" for row in pair]
    return [claim.text, claim.disturbance, *means, verdict]


def orders(rows: Sequence[Row]) -> list[list[str]]:
    """Return, for each zeroing network, the residual at each control period and its slope."""
    found = []
    of_periods = [row for row in rows if row["work"] == UNLIMITED]
    for name in dict.fromkeys(row["network"] for row in of_periods):
        own = [row for row in of_periods if row["network"] == name]
        means = [row["mean"]["residual"] for row in own]
        slope = "–"
        if None not in means:
            exponent = np.polyfit(np.log([row["dt"] for row in own]), np.log(means), 1)[0]
            slope = f"{exponent:.2f}"
        found.append([name, *map(_shown, own), slope])
    return found


def report(folder: Path, size: Size, rows: Sequence[Row], head: str) -> str:
    """Write each table as NAME.tex into a folder; return the report in Markdown."""
    parts = ["# Atlas of neurodynamic control", head]
    for name, caption, columns, texts in _tables(size, rows):
        latex = lay_out(texts, columns, "latex_booktabs", disable_numparse=True)
        write_text(folder / f"{name}.tex", latex + "\n")
        parts += [f"## {caption}", markdown_table(columns, texts)]
    return "\n\n".join([*parts, _REMARKS]) + "\n"


def _tables(size: Size, rows: Sequence[Row]) -> list[Any]:
    """Lay out the tables of a report that have rows and more than two columns.

    Returns:
        Of each the name of its file, its caption, the heads of its columns, and its rows of texts.
    """
    ranking = ranks(rows)
    head = ["rank", "network", "evaluations", *size.disturbances]
    of = f"{size.schemes[0]}, {size.work:g} operations a control period"
    claims = [
        judge(rows, claim)
        for claim in CLAIMS
        if {claim.better, claim.worse} <= set(size.networks)
        and claim.disturbance in size.disturbances
    ]
    position = partial(_shown, measure="rms_error_m")
    tables = [
        ("league", f"RMS KKT residual: {of}", head, _league(rows, ranking, _shown)),
        (
            "failures",
            "Runs that failed: the first reason",
            ["network", "disturbance", "reason"],
            [
                [row["network"], row["disturbance"], f"{row['failures'][0]:.100}"]
                for row in find(rows)
                if row["failures"]
            ],
        ),
        (
            "errors",
            f"RMS position error [m], the places by the residual: {of}",
            head,
            _league(rows, ranking, position),
        ),
        (
            "verdicts",
            "Claims of the papers, by the residual of pairs of runs, gains chosen undisturbed",
            ["claim", "disturbance", "network of the claim", "network beside it", "verdict"],
            claims,
        ),
        (
            "orders",
            "RMS KKT residual against the control period, one evaluation each",
            ["network", *(f"{1e3 * dt:g} ms" for dt in PERIODS), "slope"],
            orders(rows),
        ),
        (
            "schemes",
            "RMS KKT residual of each scheme, undisturbed",
            ["network", *size.schemes],
            [
                [
                    name,
                    *(
                        _shown(find(rows, network=name, scheme=scheme, disturbance="none")[0])
                        for scheme in size.schemes
                    ),
                ]
                for name in ranking
            ],
        ),
    ]
    return [table for table in tables if table[3] and len(table[2]) > 2]


def _league(
    rows: Sequence[Row], ranking: Mapping[str, str], show: Callable[[Row], str]
) -> list[list[str]]:
    """Lay out the results of every network and disturbance, the best network first."""
    lines = []
    for name, rank in ranking.items():
        found = of_every_disturbance(rows, name)
        taken = next((row["taken"] for row in found if row["taken"]), ["–"])
        lines.append([rank, name, str(taken[0]), *map(show, found)])
    return lines


def _shown(row: Row, measure: str = "residual") -> str:
    """Format the mean of a row, and its number of failed runs."""
    mean = row["mean"][measure]
    lost = f" ({row['lost']} of {row['seeds']})" if row["lost"] else ""
    return ("–" if mean is None else f"{mean:.2e}") + lost
