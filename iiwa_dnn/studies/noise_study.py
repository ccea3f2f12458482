"""Means against disturbances compared: error against smoothness of the command, paired by seed.

Every countermeasure meets every disturbance on the paper's heart, converged, with SO(3) rows. Runs
with chance in them share their seeds, so a countermeasure is compared with none run by run.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from iiwa_dnn.control.estimation import NoiseModel
from iiwa_dnn.control.feedback import noise_gain
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.references import Heart
from iiwa_dnn.results.metrics import position_error
from iiwa_dnn.results.plots import DOUBLE_COLUMN, new_figure
from iiwa_dnn.results.record import FloatArray
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.schemes import DoubleIndicator
from iiwa_dnn.simulation import simulate
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.runs import paper_robot
from iiwa_dnn.studies.statistics import estimate, paired_difference
from iiwa_dnn.studies.sweeps import Outcome

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ENCODER_NOISE = 1e-4
"""Standard deviation of the measured angles [rad] where they are noisy."""

DISTURBANCES: dict[str, dict[str, Any]] = {
    "none": {},
    "white, the paper's": {"noise": paper.NOISE},
    "encoder": {"noise": ENCODER_NOISE, "noise_at": "measurement"},
    "constant": {"noise": lambda t: 0.01 + 0.0 * t},
    "ramp": {"noise": lambda t: 0.01 * t},
    "sinusoid": {"noise": lambda t: 0.01 * np.sin(2.0 * np.pi * t)},
}
"""0.01 rad/s is the paper's amplitude; the ramp reaches it within 1 s, the sinusoid has 1 Hz."""

_BY_CHANCE = ("white, the paper's", "encoder")

GAIN = noise_gain(paper.NOISE, 0.0, paper.DT)
"""The gain that the paper's noise asks for, its angles being exact [1/s]."""

COUNTERMEASURES: dict[str, dict[str, Any]] = {
    "none": {},
    "average of 10, the paper's": {"filter_window": paper.WINDOW},
    "gain": {"gain": GAIN},
    "gain and average": {"gain": GAIN, "filter_window": paper.WINDOW},
    "Kalman": {"estimator": {"velocity": 1e-3, "measurement": ENCODER_NOISE}},
    "Kalman with bias": {
        "estimator": {"velocity": 1e-3, "measurement": 1e-6, "bias_walk": 0.01, "bias": 0.1}
    },
}

SETTLED_AFTER = 1.0
"""Time after which errors and roughness are counted [s]."""

MEASURES = ("mse_m2", "max_error_m", "last_error_m", "command_roughness", "motion_roughness")


def cells(seeds: int, duration: float) -> list[dict[str, Any]]:
    """List the settings of all runs of this duration [s]: one without chance, else every seed."""
    return [
        {"disturbance": kind, "countermeasure": means, "seed": seed, "duration": duration}
        for kind, means in product(DISTURBANCES, COUNTERMEASURES)
        for seed in range(seeds if kind in _BY_CHANCE else 1)
    ]


def measure(settings: Mapping[str, Any]) -> Outcome:
    """Carry out the run of one of `cells` and sum it up.

    Returns:
        ``mse_m2``, over samples and axes, and ``max_error_m`` after ``SETTLED_AFTER``;
        ``last_error_m`` at the end; ``command_roughness`` and ``motion_roughness``, the total
        variation of the network's answer and of the velocity that moved the robot, per second and
        joint [rad/s per s].
    """
    asked = dict(DISTURBANCES[settings["disturbance"]])
    means = dict(COUNTERMEASURES[settings["countermeasure"]])
    if callable(asked.get("noise")):
        times = paper.DT * np.arange(round(settings["duration"] / paper.DT))
        asked["noise"] = np.tile(asked["noise"](times)[:, np.newaxis], 7)
    if "estimator" in means:
        means["estimator"] = NoiseModel(**means["estimator"])
    gain = means.pop("gain", DoubleIndicator().position_gain)
    record = simulate(
        paper_robot(),
        DoubleIndicator(paper.WEIGHT, position_gain=gain, orientation_gain=gain),
        Heart().anchored(Configuration(paper_robot(), paper.START)),
        paper.START,
        dt=paper.DT,
        duration=settings["duration"],
        seed=settings["seed"],
        check=CrossCheck(()),
        **asked,
        **means,
    )
    settled = record.t >= SETTLED_AFTER
    error = position_error(record)
    distance = np.linalg.norm(error, axis=1)
    return Outcome(
        {
            "status": record.settings["status"],
            "mse_m2": float(np.mean(error[settled] ** 2)),
            "max_error_m": float(distance[settled].max()),
            "last_error_m": float(distance[-1]),
            "command_roughness": _roughness(record.dq_solver[settled[:-1]]),
            "motion_roughness": _roughness(record.dq[settled[:-1]]),
        }
    )


def _roughness(velocity: FloatArray) -> float:
    """Compute the total variation per second, the mean over the joints."""
    changes = np.abs(np.diff(velocity, axis=0)).sum(axis=0)
    return float(changes.mean() / (len(velocity) * paper.DT))


def tabulate(
    cells: Sequence[Mapping[str, Any]], results: Sequence[Mapping[str, Any]]
) -> list[dict[str, Any]]:
    """Lay the results of `cells` out in a row for each pair, in JSON types.

    It has the names, the measures' means, with 95 % intervals where there is chance, and
    ``mse_ratio``, the mean squared error without a countermeasure over that with it.
    """
    pairs: dict[tuple[str, str], list[Mapping[str, Any]]] = {}
    for cell, result in zip(cells, results, strict=True):
        pairs.setdefault((cell["disturbance"], cell["countermeasure"]), []).append(result)
    rows = []
    for (kind, means), runs in pairs.items():
        mse = np.array([run["mse_m2"] for run in runs])
        base = np.array([run["mse_m2"] for run in pairs[kind, "none"]])
        row = {"disturbance": kind, "countermeasure": means, "runs": len(runs)}
        row |= {name: float(np.mean([run[name] for run in runs])) for name in MEASURES}
        row["completed"] = all(run["status"] == "completed" for run in runs)
        row["mse_ratio"] = float(base.mean() / mse.mean())
        by_chance = len(runs) > 1
        row["difference"] = paired_difference(mse, base).to_json() if by_chance else None
        row["mse"] = estimate(mse).to_json() if by_chance else None
        rows.append(row)
    return rows


def noise_figure(rows: Sequence[Mapping[str, Any]]) -> Figure:
    """Draw the mean squared error and the command's roughness of every row of `tabulate`."""
    figure = new_figure(DOUBLE_COLUMN, 3.4)
    panels = figure.subplots(1, 2, sharey=True)
    heights = np.arange(len(COUNTERMEASURES))
    for axes, name, label in (
        (panels[0], "mse_m2", "Mean squared error [m²]"),
        (panels[1], "command_roughness", "Roughness of the command [rad/s²]"),
    ):
        for i, kind in enumerate(DISTURBANCES):
            values = [row[name] for row in rows if row["disturbance"] == kind]
            # With a small distance, so that none hides another.
            axes.plot(values, heights + 0.1 * (i - 2.5), "o^sDvX"[i], linestyle="", label=kind)
        axes.set_xscale("log")
        axes.set_xlabel(label)
    panels[0].set_yticks(heights, list(COUNTERMEASURES))
    panels[0].invert_yaxis()
    handles, names = panels[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside upper center", ncols=len(names))
    return figure
