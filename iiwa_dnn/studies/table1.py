"""Table I: seven weights without noise, in the paper's way and in ours, and ten laps of drift."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from iiwa_dnn.studies import paper
from iiwa_dnn.studies.runs import HeartRun
from iiwa_dnn.studies.scope import Scope
from iiwa_dnn.studies.verdicts import Verdict, judge_row

VARIANTS: dict[str, HeartRun] = {
    "continuous, block": HeartRun(),
    "converged, SO(3)": HeartRun(mode="converged", orientation="so3"),
    "continuous, block, G = inertia": HeartRun(kinetic="inertia"),
    "converged, SO(3), G = inertia": HeartRun(
        mode="converged", orientation="so3", kinetic="inertia"
    ),
}
"""Ways to run Table I; the first is the paper's own."""

_LAPS = HeartRun(mode="converged", orientation="so3", motion="midpoint")
DRIFTERS: dict[str, HeartRun] = {
    "pseudo-inverse, SO(3)": replace(_LAPS, baseline=True),
    "pseudo-inverse, position only": replace(_LAPS, baseline=True, orientation="none"),
    "double indicator, ξ = 0.2, SO(3)": _LAPS,
    "double indicator, ξ = 0.2, position only": replace(_LAPS, orientation="none"),
}
"""What draws one heart after another."""

_MEASURES = (
    "max_position_error_m",
    "mse_position_error_m2",
    "joint_drift_rad",
    "max_kinetic_index",
    "max_orientation_error_rad",
    "max_kkt_residual",
    "total_variation_rad_s",
    "status",
)


def cells(scope: Scope) -> list[HeartRun]:
    """The runs of the table, weights of each variant in turn, and then the laps."""
    weights = [
        replace(variant, weight=weight, dt=scope.dt, duration=scope.duration)
        for variant in VARIANTS.values()
        for weight in paper.WEIGHTS
    ]
    return [*weights, *_laps(scope)]


def _laps(scope: Scope) -> list[HeartRun]:
    period = HeartRun().reference().period
    return [
        replace(run, dt=scope.laps_dt, duration=scope.laps * period) for run in DRIFTERS.values()
    ]


def tabulate(scope: Scope, results: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """The table, beside the paper's, with its verdicts.

    Args:
        scope: What was run.
        results: The numbers of `cells`, in that order.

    Returns:
        The table in JSON types.
    """
    columns = len(paper.WEIGHTS)
    variants = {}
    for i, name in enumerate(VARIANTS):
        part = results[i * columns : (i + 1) * columns]
        rows: dict[str, list[Any]] = {key: [values[key] for values in part] for key in _MEASURES}
        rows["max_kinetic_index_times_dt"] = [
            None if value is None else value * scope.dt for value in rows["max_kinetic_index"]
        ]
        variants[name] = {
            "rows": rows,
            "verdicts": {key: v.to_json() for key, v in _verdicts(rows).items()},
        }
    laps = results[len(VARIANTS) * columns :]
    return {
        "scope": scope.to_json(),
        "weights": list(paper.WEIGHTS),
        "paper": {
            "max_position_error_m": list(paper.MAX_ERROR),
            "joint_drift_rad": list(paper.DRIFT),
            "max_kinetic_index": list(paper.KINETIC_INDEX),
        },
        "variants": variants,
        "laps": {
            name: {key: values[key] for key in ("lap_drift_rad", "max_position_error_m", "status")}
            for name, values in zip(DRIFTERS, laps, strict=True)
        },
    }


def _verdicts(rows: Mapping[str, list[Any]]) -> dict[str, Verdict]:
    """On each of the paper's rows; on its kinetic index as it is printed and divided by dt."""
    pairs = {
        "max_position_error_m": paper.MAX_ERROR,
        "joint_drift_rad": paper.DRIFT,
        "max_kinetic_index": paper.KINETIC_INDEX,
        "max_kinetic_index_times_dt": paper.KINETIC_INDEX,
    }
    return {key: judge_row(paper.WEIGHTS, printed, rows[key]) for key, printed in pairs.items()}
