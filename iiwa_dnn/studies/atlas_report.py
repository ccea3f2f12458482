"""The atlas's tables, verdicts, figure and report, out of the numbers of its cells."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import matplotlib
import numpy as np

from iiwa_dnn.files import write_text
from iiwa_dnn.results.markdown import number, save_markdown
from iiwa_dnn.results.plots import COLUMN, new_figure, write_figures
from iiwa_dnn.results.publication import Table
from iiwa_dnn.studies.atlas import MEASURES, SOLVED, UNLIMITED, Size, of_league, part
from iiwa_dnn.studies.statistics import paired_difference

if TYPE_CHECKING:
    from matplotlib.figure import Figure

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

_MARKERS = "os^vD*P"
_number = partial(number, form=".2e", unknown="–")


class Claim(NamedTuple):
    """A claim that one network is better than another, as papers make it.

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


def tabulate(cells: Sequence[Row], results: Sequence[Row]) -> list[dict[str, Any]]:
    """Lay out a row for each cell: settings, numbers of its runs, and means of those completed."""
    rows = []
    for cell, result in zip(cells, results, strict=True):
        means = {}
        for name in MEASURES:
            known = [value for value in result[name] if value is not None]
            means[name] = float(np.mean(known)) if known else None
        lost = sum(value is None for value in result["residual"])
        rows.append({**cell, "lost": lost, "mean": means, **result})
    return rows


def find(rows: Sequence[Row], **wanted: Any) -> list[Row]:
    """Find the rows with these settings; the first row's scheme, budget and period by default."""
    first = {name: rows[0][name] for name in ("work", "dt")}
    first["scheme"] = of_league(rows[0]["scheme"], wanted.get("disturbance", ""))
    return [row for row in rows if {**first, **wanted}.items() <= row.items()]


def scores(rows: Sequence[Row], network: str) -> Vector | None:
    """Return the mean decimal logarithm of a network's residual over the disturbances, (seeds,).

    The undisturbed runs are those of the seed's path. None stands for a network with a failed run.
    """
    found = of_every_disturbance(rows, network)
    if any(row["lost"] for row in found):
        return None
    count = max(len(row["residual"]) for row in found)
    values = [np.resize(np.maximum(row["residual"], SOLVED), count) for row in found]
    mean: Vector = np.log10(values).mean(axis=0)
    return mean


def of_every_disturbance(rows: Sequence[Row], network: str) -> list[Row]:
    """Return the row of a network for each disturbance, with the league's scheme and budget."""
    kinds = dict.fromkeys(row["disturbance"] for row in rows)
    return [find(rows, network=network, disturbance=kind)[0] for kind in kinds]


def compare(one: Vector, other: Vector) -> int:
    """Compare paired numbers, (k,) both: -1 if the first are smaller, 1 if larger, 0 for a tie."""
    if abs(float(np.mean(one - other))) < MARGIN:
        return 0
    if len(one) < 2:
        return int(np.sign(one[0] - other[0]))
    return paired_difference(one, other).sign


def places(rows: Sequence[Row]) -> dict[str, str]:
    """Rank the networks, the best first: the first and the last place that each may have.

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
    """Judge a claim by pairs of runs with the first scheme at the middle budget.

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
    if any(lost):
        sign = int(lost[0]) - int(lost[1])
    else:
        sign = compare(*(np.log10(np.maximum(row["residual"], SOLVED)) for row in pair))
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
        slope = None
        if None not in means:
            slope = np.polyfit(np.log([row["dt"] for row in own]), np.log(means), 1)[0]
        found.append([name, *map(_number, means), number(slope, ".2f", "–")])
    return found


def figure(rows: Sequence[Row]) -> Figure:
    """Draw the tool's error against the work of a control period, a curve a network."""
    drawn = new_figure(COLUMN, 4.6)
    axis = drawn.subplots()
    names = list(places(rows))
    colors = matplotlib.colormaps["turbo"](np.linspace(0.03, 0.97, len(names)))
    for i, name in enumerate(names):
        known = []
        for work in sorted({row["work"] for row in rows} - {UNLIMITED}):
            for row in find(rows, network=name, disturbance="none", work=work):
                if not row["lost"]:
                    known.append((row["taken"][1], row["mean"]["rms_error_m"]))
        if known:
            axis.loglog(
                *np.transpose(known),
                color="black" if name == PAPER else colors[i],
                marker=_MARKERS[i % 7],
                markersize=3,
                linewidth=2.0 if name == PAPER else 0.9,
                label=name,
            )
    axis.set_xlabel("operations a control period")
    axis.set_ylabel("RMS position error [m]")
    drawn.legend(loc="outside lower center", ncols=2, fontsize=5)
    return drawn


def write_report(folder: Path, size: Size, rows: Sequence[Row], head: str, plots: bool) -> str:
    """Write ``report.md``, ``cards.md``, the tables and, where asked for, the figure.

    Returns the text of the report.
    """
    ranking = places(rows)
    parts = ["# Atlas of neurodynamic control", head]
    if plots:
        write_figures({"atlas": partial(figure, rows)}, folder)
        parts.append("![Position error against the work of a control period](atlas.png)")
    for table in _tables(size, rows, ranking):
        table.save(folder)
        parts.append(table.markdown())
    parts.append(_REMARKS)
    write_text(folder / "cards.md", "\n\n".join(card(rows, name, ranking) for name in ranking))
    save_markdown(folder, parts)
    return "\n\n".join(parts)


def card(rows: Sequence[Row], name: str, ranking: Mapping[str, str]) -> str:
    """Write a network's card: ODE, source and promises, its work, and what was measured."""
    entry = part("network", name)
    kind = entry.network if isinstance(entry.network, type) else type(entry.network)
    inner = getattr(entry.network, "network", entry.network)
    modules = dict.fromkeys([kind.__module__, type(inner).__module__])
    texts = [inspect.getdoc(sys.modules[name]) for name in modules if name != "abc"]
    found = of_every_disturbance(rows, name)
    undisturbed = found[0]
    activation = getattr(entry.network, "activation", None)
    lines = [
        f"# {name}",
        *(text for text in texts if text),
        f"- class: `{kind.__name__}`; place in this league: {ranking[name]}",
        f"- gain: {undisturbed['share']:g} of the linear limit",
    ]
    if undisturbed["taken"]:
        count, work = undisturbed["taken"]
        lines.append(f"- a control period: evaluations {count}, operations {work:.0f}")
    if activation is not None:
        bound = activation.settle_time(1.0)
        within = f"within {bound:g} rho" if bound < np.inf else "not within a bounded time"
        lines.append(f"- settles from an error of 1 {within}")
    lines += [
        f"- {row['disturbance']}: residual {_shown(row)}, tool {_shown(row, 'rms_error_m')} m"
        for row in found
    ]
    return "\n".join(lines) + "\n"


def _tables(size: Size, rows: Sequence[Row], ranking: Mapping[str, str]) -> list[Table]:
    """Lay out the tables of a report."""
    head = ["place", "network", "evaluations", *size.disturbances]
    of = f"{size.schemes[0]}, {size.middle:g} operations a control period"
    claims = [
        claim
        for claim in CLAIMS
        if {claim.better, claim.worse} <= set(size.networks)
        and claim.disturbance in size.disturbances
    ]
    tables = [
        Table("league", f"RMS KKT residual: {of}", head, _league(rows, ranking, _shown)),
        Table(
            "errors",
            f"RMS position error of the tool [m]: {of}",
            head,
            _league(rows, ranking, partial(_shown, measure="rms_error_m")),
        ),
        Table(
            "seeds",
            f"Median RMS KKT residual of the seeds (seeds below {SOLVED:g}, above 1): {of}",
            head,
            _league(rows, ranking, _of_seeds),
        ),
        Table(
            "spread",
            f"Geometric mean of the columns, residuals below {SOLVED:g} counted as that: {of}",
            ["place", "network", "mean of the seeds", "smallest", "largest"],
            _spread(rows, ranking),
        ),
        Table(
            "verdicts",
            "Claims of the papers that cards.md names, by the residual of pairs of runs",
            ["claim", "disturbance", "network of the claim", "network beside it", "verdict"],
            [judge(rows, claim) for claim in claims],
        ),
    ]
    found = orders(rows)
    if found:
        periods = sorted({row["dt"] for row in rows if row["work"] == UNLIMITED}, reverse=True)
        columns = ["network", *(f"{1e3 * dt:g} ms" for dt in periods), "slope"]
        caption = "RMS KKT residual against the control period, one evaluation each"
        tables.append(Table("orders", caption, columns, found))
    return [*tables, *_of_schemes(size, rows, ranking)]


def _of_schemes(size: Size, rows: Sequence[Row], ranking: Mapping[str, str]) -> list[Table]:
    """Lay out the tables of several schemes."""
    if len(size.schemes) == 1 or "none" not in size.disturbances:
        return []
    lines = []
    for name in ranking:
        found = [
            find(rows, network=name, scheme=scheme, disturbance="none")[0]
            for scheme in size.schemes
        ]
        lines.append([name, *map(_shown, found)])
    caption = "RMS KKT residual of each scheme, undisturbed"
    others = [row for row in rows if row["seeds"] <= size.others]
    firsts = [_firsts(others, scheme) for scheme in size.schemes[1:]]
    columns = ["scheme", "first", "second", "third", "networks that lost a run"]
    return [
        Table("schemes", caption, ["network", *size.schemes], lines),
        Table(
            "firsts", "The smallest geometric means of each other scheme's columns", columns, firsts
        ),
    ]


def _firsts(rows: Sequence[Row], scheme: str) -> list[str]:
    """Lay out the first three networks with a scheme, and how many lost a run."""
    own = [row for row in rows if row["scheme"] == scheme]
    ranking = places(own)
    three = [f"{name} {mean}" for _, name, mean, *_ in _spread(own, ranking)[:3]]
    lost = list(ranking.values()).count("–")
    return [scheme, *three, *["–"] * (3 - len(three)), str(lost)]


def _spread(rows: Sequence[Row], ranking: Mapping[str, str]) -> list[list[str]]:
    """Lay out the geometric mean of the disturbances of every network that lost no run."""
    lines = []
    for name, place in ranking.items():
        logarithms = scores(rows, name)
        if logarithms is not None:
            spread = (logarithms.mean(), logarithms.min(), logarithms.max())
            lines.append([place, name, *(f"{10.0**value:.1e}" for value in spread)])
    return lines


def _of_seeds(row: Row) -> str:
    """Show the median residual of a cell, and how many of its seeds are solved and lost."""
    residuals = [np.inf if value is None else value for value in row["residual"]]
    solved = sum(value <= SOLVED for value in residuals)
    far = sum(value > 1.0 for value in residuals)
    return f"{np.median(residuals):.1e} ({solved}, {far})"


def _league(
    rows: Sequence[Row], ranking: Mapping[str, str], show: Callable[[Row], str]
) -> list[list[str]]:
    """Lay out what is shown of every network and disturbance, the best network first."""
    lines = []
    for name, place in ranking.items():
        found = of_every_disturbance(rows, name)
        taken = next((row["taken"] for row in found if row["taken"]), None)
        count = "–" if taken is None else str(taken[0])
        lines.append([place, name, count, *map(show, found)])
    return lines


def _shown(row: Row, measure: str = "residual") -> str:
    lost = f" ({row['lost']} of {row['seeds']})" if row["lost"] else ""
    return _number(row["mean"][measure]) + lost
