"""What the paper leaves out, one choice against the other: integrator, orientation, noise entry."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, Literal

from iiwa_dnn.schemes.tasks import Orientation
from iiwa_dnn.simulation import NOISE_ENTRIES
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.runs import HeartRun
from iiwa_dnn.studies.scope import Scope

SUBSTEPS: tuple[int | Literal["implicit"], ...] = (1, 2, 4, 7, 8, 16, "implicit")
ORIENTATIONS: tuple[Orientation, ...] = ("block", "so3")
ENTRIES = ("none", *NOISE_ENTRIES)

_MEASURES = (
    "max_position_error_m",
    "max_orientation_error_rad",
    "joint_drift_rad",
    "total_variation_rad_s",
    "max_kinetic_index",
    "amplification",
    "status",
)


def cells(scope: Scope) -> list[HeartRun]:
    """Every combination, in the paper's mode at the weight of its Table II, with one seed."""
    base = HeartRun(dt=scope.dt, duration=scope.duration)
    return [
        replace(base, orientation=orientation, substeps=substeps, **_noise(entry))
        for orientation in ORIENTATIONS
        for entry in ENTRIES
        for substeps in SUBSTEPS
    ]


def _noise(entry: str) -> dict[str, Any]:
    return {} if entry == "none" else {"noise": paper.NOISE, "noise_at": entry}


def tabulate(scope: Scope, results: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """One row for each combination, and which of them comes closest to the paper's drift.

    A row is stable if the network is integrated implicitly, or if no explicit sub-step of its run
    magnifies an error.

    Args:
        scope: What was run.
        results: The numbers of `cells`, in that order.

    Returns:
        The table in JSON types.
    """
    drift = paper.DRIFT[paper.WEIGHTS.index(paper.WEIGHT)]
    combinations = [
        {"orientation": orientation, "noise_at": entry, "substeps": substeps}
        for orientation in ORIENTATIONS
        for entry in ENTRIES
        for substeps in SUBSTEPS
    ]
    rows = []
    for combination, values in zip(combinations, results, strict=True):
        row = combination | {key: values[key] for key in _MEASURES}
        growth = row["amplification"]
        rows.append(row | {"stable": growth is None or growth <= 1.0})
    closest = min(rows, key=lambda row: _distance(row["joint_drift_rad"], drift))
    stable = min(
        (row for row in rows if row["stable"]),
        key=lambda row: _distance(row["joint_drift_rad"], drift),
    )
    return {
        "scope": scope.to_json(),
        "weight": paper.WEIGHT,
        "paper": {"joint_drift_rad": drift, "max_position_error_m": paper.MAX_ERROR[1]},
        "rows": rows,
        "closest_to_the_papers_drift": closest,
        "closest_stable": stable,
    }


def _distance(drift: float | None, printed: float | None) -> float:
    """How many powers of e lie between two drifts; infinite if one is missing or zero."""
    if not drift or not printed:
        return math.inf
    return abs(math.log(drift / printed))
