r"""Table II: noise and filter, on and off, over many seeds that all cases share.

Theory without a filter: in the task's space the position error of a converged run is
an Ornstein-Uhlenbeck process, driven by J n at every step and drawn back at the rate of the
position gain :math:`\delta`. With velocity noise of standard deviation :math:`\sigma` its mean
squared error per axis is

.. math::  \frac{\operatorname{tr}(J J^T)}{3}\,\frac{\sigma^2\,\Delta t}{2\,\delta},

and with noise on the measured angles, which the feedback multiplies by :math:`\delta` before the
robot moves by it, :math:`\delta^2` times that (docs/theory.md).
"""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from itertools import product
from typing import Any

import numpy as np

from iiwa_dnn.schemes import DoubleIndicator
from iiwa_dnn.simulation import NOISE_ENTRIES, NoiseEntry
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.runs import HeartRun, Scope
from iiwa_dnn.studies.statistics import Estimate, estimate, paired_difference
from iiwa_dnn.studies.verdicts import judge_change, judge_row

# Eight sub-steps are what is computed to be stable along the whole heart, as the ablation shows; to
# compute it at every step takes time.
MODES: dict[str, HeartRun] = {
    "continuous, block": HeartRun(substeps=8),
    "converged, SO(3)": HeartRun(mode="converged", orientation="so3"),
}
"""Ways to run Table II; the first is the paper's own."""

MEASURES = {"max_position_error_m": paper.CASES_MAX_ERROR, "mse_position_error_m2": paper.CASES_MSE}
"""The paper's two measures and its numbers, in the order of `paper.CASES`."""


_WINDOWS = (1, paper.WINDOW)


def cells(scope: Scope) -> dict[Any, HeartRun]:
    """Make the runs by mode and window, and if noisy also by entry of the noise and seed."""
    runs: dict[Any, HeartRun] = {}
    for name, mode in MODES.items():
        base = replace(mode, dt=scope.dt, duration=scope.duration)
        for window in _WINDOWS:
            quiet = replace(base, filter_window=window)
            runs[name, window] = quiet
            for entry, seed in product(NOISE_ENTRIES, range(scope.seeds)):
                noisy = replace(quiet, noise=paper.NOISE, noise_at=entry, seed=seed)
                runs[name, window, entry, seed] = noisy
    return runs


def tabulate(scope: Scope, results: Mapping[Any, Mapping[str, Any]]) -> dict[str, Any]:
    """Lay the results of `cells` out beside the paper's, with their verdicts, in JSON types."""
    modes: dict[str, Any] = {}
    for name in MODES:
        quiet = [results[name, window] for window in _WINDOWS]
        modes[name] = {}
        for entry in NOISE_ENTRIES:
            noisy = [
                [results[name, window, entry, seed] for seed in range(scope.seeds)]
                for window in _WINDOWS
            ]
            measures = {key: _measure(key, quiet, noisy) for key in MEASURES}
            theory = _theory(entry, quiet[0], scope)
            modes[name][entry] = measures | {"theory_noise_mse_m2": theory}
    return {
        "scope": asdict(scope),
        "weight": paper.WEIGHT,
        "noise": paper.NOISE,
        "filter_window": paper.WINDOW,
        "cases": list(paper.CASES),
        "paper": {key: list(values) for key, values in MEASURES.items()},
        "paper_changes": {key: _paper_changes(values) for key, values in MEASURES.items()},
        "modes": modes,
    }


def _measure(
    key: str, quiet: Sequence[Mapping[str, Any]], noisy: Sequence[Sequence[Mapping[str, Any]]]
) -> dict[str, Any]:
    """Lay out one measure of the four cases, and its changes by noise and filter."""
    silent = [values[key] for values in quiet]
    plain, filtered = np.array([[values[key] for values in runs] for runs in noisy], float)
    cases = [*map(Estimate.exact, silent), estimate(plain), estimate(filtered)]
    changes = {
        "filter, with noise": _relative(paired_difference(filtered, plain), float(plain.mean())),
        "filter, without noise": Estimate.exact(silent[1] / silent[0] - 1.0),
        "noise, without filter": _relative(estimate(plain - silent[0]), silent[0]),
    }
    printed = _paper_changes(MEASURES[key])
    return {
        "cases": [case.to_json() for case in cases],
        "verdict": judge_row(range(4), MEASURES[key], [case.mean for case in cases]),
        "difference": paired_difference(filtered, plain).to_json(),
        "changes": {
            name: change.to_json() | judge_change(printed[name], change)
            for name, change in changes.items()
        },
    }


def _relative(difference: Estimate, base: float) -> Estimate:
    """Relate a difference to the mean that it is a change of."""
    return Estimate(difference.mean / base, difference.half_width / base, difference.samples)


def _paper_changes(values: Sequence[float]) -> dict[str, float]:
    """Compute the same relative changes from the paper's four numbers."""
    quiet, quiet_filtered, noisy, noisy_filtered = values
    return {
        "filter, with noise": noisy_filtered / noisy - 1.0,
        "filter, without noise": quiet_filtered / quiet - 1.0,
        "noise, without filter": noisy / quiet - 1.0,
    }


def _theory(entry: NoiseEntry, quiet: Mapping[str, Any], scope: Scope) -> float | None:
    """Compute the mean squared error that noise adds [m^2]; None where there is no theory."""
    if entry == "network":
        return None
    gain = DoubleIndicator().position_gain
    velocity = paper.NOISE if entry == "velocity" else gain * paper.NOISE
    square: float = quiet["jacobian_square_m2"] / 3.0 * velocity**2 * scope.dt / (2.0 * gain)
    return square
