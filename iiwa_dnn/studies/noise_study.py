"""What helps against which disturbance: error against smoothness of the command, paired by seed.

Every countermeasure meets every disturbance on the paper's heart, converged, with SO(3) rows. Runs
with chance in them share their seeds, so a countermeasure is compared with none run by run.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from iiwa_dnn.control.estimation import NoiseModel
from iiwa_dnn.control.feedback import noise_gain
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.references import Heart
from iiwa_dnn.results.record import Record
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.schemes import DoubleIndicator
from iiwa_dnn.simulation import Simulation, VelocityDisturbance
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.runs import paper_robot
from iiwa_dnn.studies.statistics import estimate, paired_difference
from iiwa_dnn.studies.sweeps import Outcome

ENCODER_NOISE = 1e-4
"""Standard deviation of the measured angles [rad] where they are noisy."""

DISTURBANCES: dict[str, dict[str, Any]] = {
    "none": {},
    "white, the paper's": {"noise": paper.NOISE},
    "encoder": {"noise": ENCODER_NOISE, "noise_at": "measurement"},
    "constant": {"disturbance": {"bias": 0.01}},
    "ramp": {"disturbance": {"slope": 0.01}},
    "sinusoid": {"disturbance": {"amplitude": 0.01, "frequency": 1.0}},
}
"""0.01 rad/s is the paper's amplitude; the ramp reaches it within 1 s, the sinusoid has 1 Hz."""

GAIN = noise_gain(paper.NOISE, 0.0, paper.DT)
"""The gain that the paper's noise asks for, its angles being exact [1/s]."""

COUNTERMEASURES: dict[str, dict[str, Any]] = {
    "none": {},
    "average of 10, the paper's": {"filter_window": paper.WINDOW},
    "gain": {"gain": GAIN},
    "gain and average": {"gain": GAIN, "filter_window": paper.WINDOW},
    "integral": {"integral_gain": DoubleIndicator().position_gain ** 2 / 4.0},
    "gain and integral": {"gain": GAIN, "integral_gain": GAIN**2 / 4.0},
    "Kalman": {"estimator": {"velocity": 1e-3, "measurement": ENCODER_NOISE}},
    "Kalman with bias": {
        "estimator": {"velocity": 1e-3, "measurement": 1e-6, "bias_walk": 0.01, "bias": 0.1}
    },
}

SETTLED_AFTER = 1.0
"""From here on [s] errors and roughness are counted."""

MEASURES = ("mse_m2", "max_error_m", "last_error_m", "command_roughness", "motion_roughness")
_STOCHASTIC = ("noise",)


def cells(seeds: int, duration: float) -> list[dict[str, Any]]:
    """Settings of all runs: those without chance once, the others for every seed.

    Args:
        seeds: Number of noises.
        duration: Length of each run [s].
    """
    return [
        {"disturbance": kind, "countermeasure": means, "seed": seed, "duration": duration}
        for kind, means in pairs()
        for seed in range(seeds if _has_chance(kind) else 1)
    ]


def pairs() -> list[tuple[str, str]]:
    """Disturbance and countermeasure of each row of the table."""
    return [(kind, means) for kind in DISTURBANCES for means in COUNTERMEASURES]


def measure(settings: Mapping[str, Any]) -> Outcome:
    """Carry out one run and sum it up.

    Args:
        settings: One of `cells`.

    Returns:
        ``mse_m2``, over samples and axes, and ``max_error_m`` after ``SETTLED_AFTER``;
        ``last_error_m`` at the end; ``command_roughness`` and ``motion_roughness``, the total
        variation of the network's answer and of what moved the robot, per second and joint
        [rad/s per s].
    """
    asked = dict(DISTURBANCES[settings["disturbance"]])
    means = dict(COUNTERMEASURES[settings["countermeasure"]])
    if "disturbance" in asked:
        asked["disturbance"] = VelocityDisturbance(**asked["disturbance"])
    if "estimator" in means:
        means["estimator"] = NoiseModel(**means["estimator"])
    gain = means.pop("gain", DoubleIndicator().position_gain)
    robot = paper_robot()
    record = Simulation(
        robot,
        DoubleIndicator(paper.WEIGHT, position_gain=gain, orientation_gain=gain),
        Heart().anchored(Configuration(robot, paper.START)),
        paper.START,
        dt=paper.DT,
        duration=settings["duration"],
        seed=settings["seed"],
        check=CrossCheck(()),
        **asked,
        **means,
    ).run()
    return Outcome({"status": record.settings["status"], **_sums(record)})


def _sums(record: Record) -> dict[str, float]:
    settled = record.t >= SETTLED_AFTER
    error = record.position - record.position_desired
    distance = np.linalg.norm(error, axis=1)
    return {
        "mse_m2": float(np.mean(error[settled] ** 2)),
        "max_error_m": float(distance[settled].max()),
        "last_error_m": float(distance[-1]),
        "command_roughness": _roughness(record.dq_solver[settled[:-1]], record),
        "motion_roughness": _roughness(record.dq[settled[:-1]], record),
    }


def _roughness(velocity: np.ndarray[Any, Any], record: Record) -> float:
    """Total variation per second, the mean over the joints."""
    changes = np.abs(np.diff(velocity, axis=0)).sum(axis=0)
    return float(changes.mean() / (len(velocity) * record.settings["dt"]))


def tabulate(
    seeds: int, duration: float, results: Sequence[Mapping[str, Any]]
) -> list[dict[str, Any]]:
    """One row for each pair, with means and 95 % intervals where there is chance.

    Args:
        seeds: As for `cells`.
        duration: As for `cells`.
        results: The numbers of `cells`, in that order.

    Returns:
        Rows in JSON types: the names, the measures' means, and ``mse_ratio``, the mean squared
        error without a countermeasure over that with it, with its interval by pairs.
    """
    left, rows = iter(results), []
    plain: dict[str, np.ndarray[Any, Any]] = {}
    for kind, means in pairs():
        runs = [next(left) for _ in range(seeds if _has_chance(kind) else 1)]
        mse = np.array([run["mse_m2"] for run in runs])
        base = plain.setdefault(kind, mse)  # the first countermeasure is none
        row = {"disturbance": kind, "countermeasure": means, "runs": len(runs)}
        row |= {name: float(np.mean([run[name] for run in runs])) for name in MEASURES}
        row["completed"] = all(run["status"] == "completed" for run in runs)
        row["mse_ratio"] = float(base.mean() / mse.mean())
        row["difference"] = row["mse"] = None
        if len(runs) > 1:
            row["mse"] = estimate(mse).to_json()
            row["difference"] = paired_difference(mse, base).to_json()
        rows.append(row)
    return rows


def _has_chance(kind: str) -> bool:
    return any(key in DISTURBANCES[kind] for key in _STOCHASTIC)
