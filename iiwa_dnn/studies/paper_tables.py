"""The paper's tables beside ours: Table I, laps, and Table II."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import product
from typing import Any, NamedTuple

import numpy as np

from iiwa_dnn.simulation import NOISE_ENTRIES
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.runs import HeartRun, Scope
from iiwa_dnn.studies.statistics import (
    Estimate,
    estimate,
    judge_change,
    judge_row,
    paired_difference,
)

Runs = dict[Any, HeartRun]
Results = Mapping[Any, Mapping[str, Any]]
Table = dict[str, Any]

_SETTLED = HeartRun(mode="converged", orientation="so3")

VARIANTS: dict[str, HeartRun] = {
    "continuous, block": HeartRun(),
    "converged, SO(3)": _SETTLED,
    "continuous, block, G = inertia": HeartRun(kinetic="inertia"),
    "converged, SO(3), G = inertia": replace(_SETTLED, kinetic="inertia"),
}
"""Ways to run Table I; the first is the paper's own."""

_LAPS = replace(_SETTLED, motion="midpoint")
DRIFTERS: dict[str, HeartRun] = {
    "pseudo-inverse, SO(3)": replace(_LAPS, baseline=True),
    "pseudo-inverse, position only": replace(_LAPS, baseline=True, orientation="none"),
    "double indicator, ξ = 0.2, SO(3)": _LAPS,
    "double indicator, ξ = 0.2, position only": replace(_LAPS, orientation="none"),
}
"""Runs along several hearts."""

# Eight sub-steps are what is computed to be stable along the whole heart; to compute it at every
# step takes time.
MODES: dict[str, HeartRun] = {
    "continuous, block": HeartRun(substeps=8),
    "converged, SO(3)": _SETTLED,
}
"""Ways to run Table II; the first is the paper's own."""

_WINDOWS = (1, paper.WINDOW)


def table1_runs(scope: Scope) -> Runs:
    """Make the runs of Table I by variant and weight."""
    return {
        (name, weight): replace(variant, weight=weight, dt=scope.dt, duration=scope.duration)
        for name, variant in VARIANTS.items()
        for weight in scope.weights
    }


def table1(scope: Scope, results: Results) -> Table:
    """Lay the results of `table1_runs` out beside the paper's, with their verdicts.

    The drift of less than a whole heart has none.
    """
    columns = [paper.WEIGHTS.index(weight) for weight in scope.weights]
    printed = {key: [row[column] for column in columns] for key, row in paper.TABLE1.items()}
    is_whole = scope.duration >= HeartRun().reference().period
    variants = {}
    for name in VARIANTS:
        runs = [results[name, weight] for weight in scope.weights]
        rows = {key: [values[key] for values in runs] for key in runs[0]}
        verdicts = {
            key: judge_row(scope.weights, row, rows[key])
            for key, row in printed.items()
            if is_whole or key != "joint_drift_rad"
        }
        variants[name] = {"rows": rows, "verdicts": verdicts}
    return {"weights": list(scope.weights), "paper": printed, "variants": variants}


def lap_runs(scope: Scope) -> Runs:
    """Make the runs of several hearts by name."""
    length = scope.laps * HeartRun().reference().period
    return {name: replace(run, dt=scope.laps_dt, duration=length) for name, run in DRIFTERS.items()}


def laps(scope: Scope, results: Results) -> Table:
    """Lay out the largest joint drift after each lap [rad], by the names of `lap_runs`."""
    return {name: results[name]["lap_drift_rad"] for name in DRIFTERS}


def table2_runs(scope: Scope) -> Runs:
    """Make the runs of Table II by mode and window, and if noisy by entry of the noise and seed."""
    runs: Runs = {}
    for (name, mode), window in product(MODES.items(), _WINDOWS):
        quiet = replace(mode, dt=scope.dt, duration=scope.duration, filter_window=window)
        runs[name, window] = quiet
        for entry, seed in product(NOISE_ENTRIES, range(scope.seeds)):
            noisy = replace(quiet, noise=paper.NOISE, noise_at=entry, seed=seed)
            runs[name, window, entry, seed] = noisy
    return runs


def table2(scope: Scope, results: Results) -> Table:
    """Lay the results of `table2_runs` out beside the paper's, with their verdicts."""
    modes: dict[str, Any] = {name: {} for name in MODES}
    for name, entry in product(MODES, NOISE_ENTRIES):
        quiet = [results[name, window] for window in _WINDOWS]
        noisy = [
            [results[name, window, entry, seed] for seed in range(scope.seeds)]
            for window in _WINDOWS
        ]
        modes[name][entry] = {key: _measure(key, quiet, noisy) for key in paper.TABLE2}
    return {
        "cases": list(paper.CASES),
        "paper": {key: list(values) for key, values in paper.TABLE2.items()},
        "paper_changes": {key: _changes_of_paper(values) for key, values in paper.TABLE2.items()},
        "modes": modes,
    }


def _measure(
    key: str, quiet: Sequence[Mapping[str, Any]], noisy: Sequence[Sequence[Mapping[str, Any]]]
) -> dict[str, Any]:
    """Lay out one measure of the four cases, and its changes by noise and filter."""
    silent = [values[key] for values in quiet]
    plain, filtered = np.array([[values[key] for values in runs] for runs in noisy], float)
    cases = [*map(Estimate, silent), estimate(plain), estimate(filtered)]
    difference = paired_difference(filtered, plain)
    changes = {
        "filter, with noise": _relative(difference, float(plain.mean())),
        "filter, without noise": Estimate(silent[1] / silent[0] - 1.0),
        "noise, without filter": _relative(estimate(plain - silent[0]), silent[0]),
    }
    printed = _changes_of_paper(paper.TABLE2[key])
    return {
        "cases": [case.to_json() for case in cases],
        # The cases have no order, so that there is no trend over them.
        "verdict": judge_row([0.0] * 4, paper.TABLE2[key], [case.mean for case in cases]),
        "difference": difference.to_json(),
        "changes": {
            name: change.to_json() | judge_change(printed[name], change)
            for name, change in changes.items()
        },
    }


def _relative(difference: Estimate, base: float) -> Estimate:
    """Divide a difference by the mean that it is a change of."""
    return Estimate(difference.mean / base, difference.half_width / base, difference.samples)


def _changes_of_paper(values: Sequence[float]) -> dict[str, float]:
    """Compute the same relative changes from the paper's four numbers."""
    quiet, quiet_filtered, noisy, noisy_filtered = values
    return {
        "filter, with noise": noisy_filtered / noisy - 1.0,
        "filter, without noise": quiet_filtered / quiet - 1.0,
        "noise, without filter": noisy / quiet - 1.0,
    }


class Experiment(NamedTuple):
    """An experiment of the paper: its runs, and the table that is made of their results."""

    runs: Callable[[Scope], Runs]
    tabulate: Callable[[Scope, Results], Table]


EXPERIMENTS: dict[str, Experiment] = {
    "table1": Experiment(table1_runs, table1),
    "laps": Experiment(lap_runs, laps),
    "table2": Experiment(table2_runs, table2),
}


def figure_runs(scope: Scope) -> dict[str, HeartRun]:
    """Make the runs of the paper's Fig. 2 by its panels; the last is Fig. 1's too."""
    quiet = HeartRun(dt=scope.dt, duration=scope.duration)
    noisy = replace(quiet, noise=paper.NOISE)
    return {
        "no noise, no filter": quiet,
        "noise, no filter": noisy,
        "no noise, filter": replace(quiet, filter_window=paper.WINDOW),
        "noise, filter": replace(noisy, filter_window=paper.WINDOW),
    }
