"""The atlas's tables, verdicts, figure and report, out of the numbers of its cells."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import matplotlib
import numpy as np

from iiwa_dnn.results.markdown import markdown_table, number, save_markdown
from iiwa_dnn.results.plots import DOUBLE_COLUMN, new_figure, write_figures
from iiwa_dnn.studies.atlas import MEASURES, NETWORKS
from iiwa_dnn.studies.atlas_disturbances import DISTURBANCES, DT
from iiwa_dnn.studies.statistics import paired_difference

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Row = Mapping[str, Any]
PAPER = "projection (the paper's)"
_MARKERS = "os^vD*P"

_number = partial(number, form=".2e", unknown="–")


class Claim(NamedTuple):
    """A claim that one network is better than another, as papers make it.

    Attributes:
        text: The claim.
        better: Name of the network that should be better.
        worse: Name of the other.
        disturbance: Disturbance under which.
        measure: Measure by which.
    """

    text: str
    better: str
    worse: str
    disturbance: str = "none"
    measure: str = "rms_residual"


CLAIMS = (
    Claim("A zeroing network follows where a gradient network lags", "zeroing, Euler", "gradient"),
    Claim("Three Taylor steps are more exact than Euler", "zeroing, Taylor 3", "zeroing, Euler"),
    Claim("Four Taylor steps are more exact than three", "zeroing, Taylor 4", "zeroing, Taylor 3"),
    Claim("The FIFD formula is more exact than Euler", "zeroing, FIFD", "zeroing, Euler"),
    Claim(
        "A sign-bi-power activation is more exact than a linear one",
        "zeroing, sign-bi-power", "zeroing, Euler",
    ),
    Claim(
        "A power-sigmoid activation is more exact than a linear one",
        "zeroing, power-sigmoid", "zeroing, Euler",
    ),
    Claim(
        "A predefined-time activation is more exact than a linear one",
        "zeroing, predefined time", "zeroing, Euler",
    ),
    Claim("A growing gain is more exact", "zeroing, growing gain", "zeroing, Euler"),
    Claim(
        "The integral rejects a constant disturbance",
        "zeroing, noise-tolerant", "zeroing, Euler", "constant",
    ),
    Claim("The integral bounds a ramp", "zeroing, noise-tolerant", "zeroing, Euler", "ramp"),
    Claim("A finite-time dual network beats the dual", "dual, finite time", "dual"),
    Claim("A fixed-time dual network beats the dual", "dual, fixed time", "dual"),
    Claim("A dual network needs fewer states and is no worse", "simplified dual", "dual"),
    Claim("The paper's network beats the dual", PAPER, "dual", measure="rms_error_m"),
    Claim("The paper's network beats the primal-dual", PAPER, "primal-dual", "none", "rms_error_m"),
    Claim("A network beats a plain numerical method", PAPER, "ADMM (OSQP)", "none", "rms_error_m"),
)  # fmt: skip


def tabulate(cells: Sequence[Row], results: Sequence[Row]) -> list[dict[str, Any]]:
    """Lay out a row for each cell: settings, numbers of its runs, and means of those completed."""
    rows = []
    for cell, result in zip(cells, results, strict=True):
        means = {}
        for name in MEASURES:
            known = [value for value in result[name] if value is not None]
            means[name] = float(np.mean(known)) if known else None
        lost = sum(value is None for value in result["rms_error_m"])
        rows.append({**cell, "lost": lost, "mean": means, **result})
    return rows


def judge(rows: Sequence[Row], claim: Claim) -> dict[str, Any]:
    """Judge a claim by pairs of runs with the first scheme at the middle budget.

    Returns:
        The claim, both means and the verdict: ``holds`` or ``does not hold`` where the whole
        interval of the difference says so or a network lost runs, else ``undecided``.
    """
    # A failed run, None, is NaN here.
    better, worse = (
        np.array(find(rows, name, claim.disturbance)[claim.measure], float)
        for name in (claim.better, claim.worse)
    )
    means = [float(np.mean(values)) for values in (better, worse)]
    first, second = np.nan_to_num(means, nan=np.inf)
    sign = int(first > second) - int(first < second)
    if np.isfinite(means).all() and len(better) > 1:
        sign = paired_difference(better, worse).sign
    verdict = {-1: "holds", 0: "undecided", 1: "does not hold"}[sign]
    known = [None if np.isnan(mean) else mean for mean in means]
    return {**claim._asdict(), "values": known, "verdict": verdict}


def find(rows: Sequence[Row], network: str, disturbance: str, scheme: str = "") -> Row:
    """Find the row of a network at the middle budget; the first scheme by default."""
    wanted = {
        "network": network,
        "disturbance": disturbance,
        "scheme": scheme or rows[0]["scheme"],
        "evaluations": rows[0]["evaluations"],
    }
    return next(row for row in rows if wanted.items() <= row.items())


def figure(rows: Sequence[Row]) -> Figure:
    """Draw error against evaluations, a curve a network: undisturbed, and with white noise."""
    drawn = new_figure(DOUBLE_COLUMN, 4.6)
    axes = drawn.subplots(1, 2, sharey=True)
    names = list(NETWORKS)
    budgets = sorted({row["evaluations"] for row in rows})
    colors = matplotlib.colormaps["turbo"](np.linspace(0.03, 0.97, len(names)))
    for axis, kind in zip(axes, ("none", "white"), strict=True):
        for i, name in enumerate(names):
            wanted = {"network": name, "scheme": rows[0]["scheme"], "disturbance": kind}
            found = [row for row in rows if wanted.items() <= row.items()]
            errors = {row["evaluations"]: row["mean"]["rms_error_m"] for row in found}
            known = sorted(pair for pair in errors.items() if pair[1] is not None)
            if known:
                axis.loglog(
                    *np.transpose(known),
                    "-" if NETWORKS[name].systems else "--",
                    color="black" if name == PAPER else colors[i],
                    marker=_MARKERS[i % 7],
                    markersize=3,
                    linewidth=2.0 if name == PAPER else 0.9,
                    label=name,
                )
        axis.set_xticks(budgets, [str(count) for count in budgets])
        axis.minorticks_off()
        axis.set_title(f"disturbance: {kind}")
        axis.set_xlabel("evaluations a control period")
    axes[0].set_ylabel("RMS position error [m]")
    handles, labels = axes[0].get_legend_handles_labels()
    drawn.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=5.5)
    return drawn


def write_report(folder: Path, rows: Sequence[Row], head: str, plots: bool) -> str:
    """Write ``report.md`` and, where asked for, the figure; returns the text."""
    names = dict.fromkeys(row["network"] for row in rows)
    league = sorted(names, key=lambda name: _rank(rows, name))
    claims = [claim for claim in CLAIMS if {claim.better, claim.worse} <= names.keys()]
    parts = ["# Atlas of neurodynamic control", head]
    if plots:
        write_figures({"atlas": partial(figure, rows)}, folder)
        parts.append("![Error against evaluations; dashed: products, solid: systems](atlas.png)")
    parts += [
        f"## League: RMS position error [m], {rows[0]['scheme']}, {rows[0]['evaluations']} "
        f"evaluations a period of {DT:g} s",
        _league_table(rows, league),
        "A number in brackets counts runs that failed.",
        "## Schemes: RMS position error [m], undisturbed",
        _scheme_table(rows, league),
        "## Every scheme with every disturbance: RMS position error [m]",
        markdown_table(
            ("network", "combinations", "with a failed run", "median", "worst"),
            (_summed(rows, name) for name in league),
        ),
        "## Verdicts",
        _verdict_table(rows, claims),
    ]
    save_markdown(folder, parts)
    return "\n\n".join(parts)


def _league_table(rows: Sequence[Row], league: Sequence[str]) -> str:
    lines = []
    for name in league:
        errors = [_shown(find(rows, name, kind)) for kind in DISTURBANCES]
        lines.append([name, "system" if NETWORKS[name].systems else "product", *errors])
    return markdown_table(("network", "evaluation", *DISTURBANCES), lines)


def _scheme_table(rows: Sequence[Row], league: Sequence[str]) -> str:
    schemes = list(dict.fromkeys(row["scheme"] for row in rows))
    lines = [
        [name, *(_shown(find(rows, name, "none", scheme)) for scheme in schemes)] for name in league
    ]
    return markdown_table(("network", *schemes), lines)


def _verdict_table(rows: Sequence[Row], claims: Sequence[Claim]) -> str:
    lines = []
    for claim in claims:
        found = judge(rows, claim)
        means = map(_number, found["values"])
        lines.append([claim.text, claim.disturbance, claim.measure, *means, found["verdict"]])
    return markdown_table(("claim", "disturbance", "measure", "ours", "beside", "verdict"), lines)


def _rank(rows: Sequence[Row], name: str) -> float:
    """Compute the mean logarithm of the error over the disturbances; inf if a run was lost."""
    found = [find(rows, name, kind) for kind in DISTURBANCES]
    if any(row["lost"] for row in found):
        return np.inf
    return float(np.mean([np.log(row["mean"]["rms_error_m"]) for row in found]))


def _summed(rows: Sequence[Row], name: str) -> list[str]:
    """Sum a network up over all schemes and disturbances at the middle budget."""
    wanted = {"network": name, "evaluations": rows[0]["evaluations"]}
    own = [row for row in rows if wanted.items() <= row.items()]
    errors = [row["mean"]["rms_error_m"] for row in own if not row["lost"]]
    ends = [float(np.median(errors)), max(errors)] if errors else [None, None]
    return [name, str(len(own)), str(len(own) - len(errors)), *map(_number, ends)]


def _shown(row: Row) -> str:
    lost = f" ({row['lost']} of {row['seeds']})" if row["lost"] else ""
    return _number(row["mean"]["rms_error_m"]) + lost
