"""Table I: seven weights without noise, in the paper's way and in ours, and ten laps of drift."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from typing import Any

from iiwa_dnn.studies import paper
from iiwa_dnn.studies.runs import HeartRun, Scope
from iiwa_dnn.studies.verdicts import judge_row

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
"""Runs that draw one heart after another."""

_MEASURES = (
    "max_position_error_m", "mse_position_error_m2", "joint_drift_rad", "max_kinetic_index",
    "max_orientation_error_rad", "max_kkt_residual", "total_variation_rad_s", "status",
)  # fmt: skip
_PAPER = {
    "max_position_error_m": paper.MAX_ERROR,
    "joint_drift_rad": paper.DRIFT,
    "max_kinetic_index": paper.KINETIC_INDEX,
}
# The kinetic index is judged as it is printed, and divided by dt.
_JUDGED = _PAPER | {"max_kinetic_index_times_dt": paper.KINETIC_INDEX}


def cells(scope: Scope) -> list[HeartRun]:
    """List the runs of the table, weights of each variant in turn, and then the laps."""
    weights = [
        replace(variant, weight=weight, dt=scope.dt, duration=scope.duration)
        for variant in VARIANTS.values()
        for weight in paper.WEIGHTS
    ]
    length = scope.laps * HeartRun().reference().period
    laps = [replace(run, dt=scope.laps_dt, duration=length) for run in DRIFTERS.values()]
    return [*weights, *laps]


def tabulate(scope: Scope, results: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Lay the results of `cells` out beside the paper's, with their verdicts, in JSON types."""
    columns = len(paper.WEIGHTS)
    variants = {}
    for i, name in enumerate(VARIANTS):
        part = results[i * columns : (i + 1) * columns]
        rows: dict[str, list[Any]] = {key: [values[key] for values in part] for key in _MEASURES}
        rows["max_kinetic_index_times_dt"] = [
            None if value is None else value * scope.dt for value in rows["max_kinetic_index"]
        ]
        verdicts = {
            key: judge_row(paper.WEIGHTS, printed, rows[key]).to_json()
            for key, printed in _JUDGED.items()
        }
        variants[name] = {"rows": rows, "verdicts": verdicts}
    laps = zip(DRIFTERS, results[len(VARIANTS) * columns :], strict=True)
    return {
        "scope": asdict(scope),
        "weights": list(paper.WEIGHTS),
        "paper": {key: list(printed) for key, printed in _PAPER.items()},
        "variants": variants,
        "laps": {
            name: {key: values[key] for key in ("lap_drift_rad", "max_position_error_m", "status")}
            for name, values in laps
        },
    }
