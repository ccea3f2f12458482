"""Choices that the paper leaves open, one against the other: integrator, orientation, noise."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from itertools import product
from typing import Any, Literal

from iiwa_dnn.schemes.tasks import Orientation
from iiwa_dnn.simulation import NOISE_ENTRIES
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.runs import HeartRun, Scope

SUBSTEPS: tuple[int | Literal["implicit"], ...] = (1, 2, 4, 7, 8, 16, "implicit")
ORIENTATIONS: tuple[Orientation, ...] = ("block", "so3")
ENTRIES = ("none", *NOISE_ENTRIES)

_MEASURES = (
    "max_position_error_m", "max_orientation_error_rad", "joint_drift_rad",
    "total_variation_rad_s", "max_kinetic_index", "amplification", "status",
)  # fmt: skip


def cells(scope: Scope) -> list[HeartRun]:
    """List every combination, in the paper's mode at the weight of its Table II, with one seed."""
    base = HeartRun(dt=scope.dt, duration=scope.duration)
    runs = []
    for choice in _combinations():
        silent = choice["noise_at"] == "none"
        noise = {"noise": 0.0, "noise_at": base.noise_at} if silent else {"noise": paper.NOISE}
        runs.append(replace(base, **choice | noise))
    return runs


def tabulate(scope: Scope, results: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Lay out a row for each combination, and find the closest to the paper's drift.

    A row is stable if the network is integrated implicitly, or if no explicit sub-step of its run
    magnifies an error. The results are those of `cells`, in that order; the table in JSON types.
    """
    drift = paper.DRIFT[paper.WEIGHTS.index(paper.WEIGHT)]
    rows = []
    for combination, values in zip(_combinations(), results, strict=True):
        row = combination | {key: values[key] for key in _MEASURES}
        growth = row["amplification"]
        rows.append(row | {"stable": growth is None or growth <= 1.0})

    def distance(row: Mapping[str, Any]) -> float:
        """Powers of e between the drifts; infinite if one is missing or zero."""
        ours = row["joint_drift_rad"]
        return abs(math.log(ours / drift)) if ours and drift else math.inf

    return {
        "scope": asdict(scope),
        "weight": paper.WEIGHT,
        "paper": {"joint_drift_rad": drift, "max_position_error_m": paper.MAX_ERROR[1]},
        "rows": rows,
        "closest_to_the_papers_drift": min(rows, key=distance),
        "closest_stable": min((row for row in rows if row["stable"]), key=distance),
    }


def _combinations() -> list[dict[str, Any]]:
    return [
        {"orientation": orientation, "noise_at": entry, "substeps": substeps}
        for orientation, entry, substeps in product(ORIENTATIONS, ENTRIES, SUBSTEPS)
    ]
