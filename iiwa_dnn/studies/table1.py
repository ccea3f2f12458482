"""Table I: seven weights without noise, in the paper's way and in ours, and ten laps of drift."""

from collections.abc import Mapping
from dataclasses import asdict, replace
from typing import Any

from iiwa_dnn.errors import InvalidInputError
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
    "max_position_error_m",
    "mse_position_error_m2",
    "joint_drift_rad",
    "max_kinetic_index",
    "max_orientation_error_rad",
    "max_kkt_residual",
    "total_variation_rad_s",
    "status",
)
_PAPER = {
    "max_position_error_m": paper.MAX_ERROR,
    "joint_drift_rad": paper.DRIFT,
    "max_kinetic_index": paper.KINETIC_INDEX,
}
# The kinetic index is judged as it is printed, and divided by dt.
_JUDGED = _PAPER | {"max_kinetic_index_times_dt": paper.KINETIC_INDEX}


def cells(scope: Scope) -> dict[Any, HeartRun]:
    """Make the runs of the table by variant and weight, and those of the laps by name."""
    weights = {
        (name, weight): replace(variant, weight=weight, dt=scope.dt, duration=scope.duration)
        for name, variant in VARIANTS.items()
        for weight in paper.WEIGHTS
    }
    length = scope.laps * HeartRun().reference().period
    laps = {name: replace(run, dt=scope.laps_dt, duration=length) for name, run in DRIFTERS.items()}
    return weights | laps


def column_cells(scope: Scope, weight: float) -> dict[str, HeartRun]:
    """Make the runs of one column of the table by variant.

    Raises:
        InvalidInputError: The table has no column of this weight.
    """
    if weight not in paper.WEIGHTS:
        columns = ", ".join(map(str, paper.WEIGHTS))
        raise InvalidInputError("weight", f"must be one of {columns}, not {weight!r}", weight)
    runs = cells(scope)
    return {name: runs[name, weight] for name in VARIANTS}


def tabulate_column(
    scope: Scope, weight: float, results: Mapping[str, Mapping[str, Any]]
) -> dict[str, Any]:
    """Lay the results of `column_cells` out beside the paper's, in JSON types."""
    column = paper.WEIGHTS.index(weight)
    runs = {}
    for name, values in results.items():
        index = values["max_kinetic_index"]
        scaled = None if index is None else index * scope.dt
        runs[name] = {**values, "max_kinetic_index_times_dt": scaled}
    return {
        "weight": weight,
        "paper": {key: printed[column] for key, printed in _JUDGED.items()},
        "variants": runs,
    }


def tabulate(scope: Scope, results: Mapping[Any, Mapping[str, Any]]) -> dict[str, Any]:
    """Lay the results of `cells` out beside the paper's, with their verdicts, in JSON types."""
    variants = {}
    for name in VARIANTS:
        runs = [results[name, weight] for weight in paper.WEIGHTS]
        rows: dict[str, list[Any]] = {key: [values[key] for values in runs] for key in _MEASURES}
        rows["max_kinetic_index_times_dt"] = [
            None if value is None else value * scope.dt for value in rows["max_kinetic_index"]
        ]
        verdicts = {
            key: judge_row(paper.WEIGHTS, printed, rows[key]) for key, printed in _JUDGED.items()
        }
        variants[name] = {"rows": rows, "verdicts": verdicts}
    kept = ("lap_drift_rad", "max_position_error_m", "status")
    return {
        "scope": asdict(scope),
        "weights": list(paper.WEIGHTS),
        "paper": {key: list(printed) for key, printed in _PAPER.items()},
        "variants": variants,
        "laps": {name: {key: results[name][key] for key in kept} for name in DRIFTERS},
    }
