"""Choices that the paper leaves open, one against the other: integrator, orientation, noise."""

import math
from collections.abc import Mapping
from dataclasses import asdict, replace
from itertools import product
from typing import Any, Literal

from iiwa_dnn.schemes.tasks import Orientation
from iiwa_dnn.simulation import NOISE_ENTRIES
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.runs import HeartRun, Scope

SUBSTEPS: tuple[int | Literal["implicit"], ...] = (1, 2, 4, 7, 8, 16, "implicit")
ORIENTATIONS: tuple[Orientation, ...] = ("block", "so3")

_MEASURES = (
    "max_position_error_m",
    "max_orientation_error_rad",
    "joint_drift_rad",
    "total_variation_rad_s",
    "max_kinetic_index",
    "amplification",
    "status",
)


def cells(scope: Scope) -> dict[Any, HeartRun]:
    """Make a run of each orientation, entry of the noise and advance of the network.

    All are in the paper's mode at the weight of its Table II, with one seed.
    """
    base = HeartRun(dt=scope.dt, duration=scope.duration)
    runs: dict[Any, HeartRun] = {}
    for orientation, substeps in product(ORIENTATIONS, SUBSTEPS):
        quiet = replace(base, orientation=orientation, substeps=substeps)
        runs[orientation, "none", substeps] = quiet
        for entry in NOISE_ENTRIES:
            noisy = replace(quiet, noise=paper.NOISE, noise_at=entry)
            runs[orientation, entry, substeps] = noisy
    return runs


def tabulate(scope: Scope, results: Mapping[Any, Mapping[str, Any]]) -> dict[str, Any]:
    """Lay out a row for each combination, and find the closest to the paper's drift.

    A row is stable if the network is integrated implicitly, or if no explicit sub-step of its run
    magnifies an error. The results are those of `cells`; the table in JSON types.
    """
    drift = paper.DRIFT[paper.WEIGHTS.index(paper.WEIGHT)]
    rows = []
    for choice in product(ORIENTATIONS, ("none", *NOISE_ENTRIES), SUBSTEPS):
        values = results[choice]
        growth = values["amplification"]
        row = dict(zip(("orientation", "noise_at", "substeps"), choice, strict=True))
        row |= {key: values[key] for key in _MEASURES}
        rows.append(row | {"stable": growth is None or growth <= 1.0})

    def distance(row: Mapping[str, Any]) -> float:
        """Compute the powers of e between the drifts; infinite if one is missing or zero."""
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
