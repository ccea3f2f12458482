"""Means against noise and disturbances of the joint velocity: error against smoothness.

    python scripts/noise_study.py runs/noise --seeds 10

Every countermeasure meets every disturbance on the paper's heart, converged, with the same seeds.
Finished runs are kept in the folder, beside the tables, noise.md.
"""

import sys
from itertools import product
from pathlib import Path

import numpy as np
import tyro
from tabulate import tabulate

import iiwa_dnn
from iiwa_dnn.results.metrics import position_error
from iiwa_dnn.simulation.estimation import NoiseModel
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.runs import paper_robot
from iiwa_dnn.studies.statistics import estimate
from iiwa_dnn.studies.sweeps import sweep

ENCODER_NOISE = 1e-4  # standard deviation of the measured joint positions [rad]
SETTLED_AFTER = 1.0  # time after which errors and roughness are counted [s]
GAIN = 0.02 / paper.DT  # which feeds 2 % of the noise back in the next command [1/s]

# Noise of each disturbance at some times (k,), in 0.01 rad/s; a number is its standard deviation.
DISTURBANCES = {
    "none": 0.0,
    "white, the paper's": paper.NOISE,
    "encoder": ENCODER_NOISE,
    "constant": np.ones_like,
}
CHANCE = ("white, the paper's", "encoder")

COUNTERMEASURES = {
    "none": {},
    "average of 10, the paper's": {"filter_window": paper.WINDOW},
    "gain": {"gain": GAIN},
    "gain and average": {"gain": GAIN, "filter_window": paper.WINDOW},
    "Kalman": {"estimator": NoiseModel(velocity=1e-3, measurement=ENCODER_NOISE)},
    "Kalman with bias": {
        "estimator": NoiseModel(velocity=1e-3, measurement=1e-6, bias_walk=0.01, bias=0.1)
    },
}


def measure(cell):
    """Carry out a run, (disturbance, countermeasure, seed, duration), and sum it up.

    Returns mean squared, largest and last error [m], and the total variation of command and motion.
    """
    kind, means, seed, duration = cell
    noise = DISTURBANCES[kind]
    if callable(noise):
        times = paper.DT * np.arange(round(duration / paper.DT))
        noise = 0.01 * np.tile(noise(times)[:, np.newaxis], 7)
    options = dict(COUNTERMEASURES[means])
    gain = options.pop("gain", 10.2)
    record = iiwa_dnn.simulate(
        paper_robot(),
        iiwa_dnn.DoubleIndicator(paper.WEIGHT, position_gain=gain, orientation_gain=gain),
        iiwa_dnn.Heart().anchored(iiwa_dnn.Configuration(paper_robot(), paper.START)),
        paper.START,
        dt=paper.DT,
        duration=duration,
        seed=seed,
        noise=noise,
        noise_at="measurement" if kind == "encoder" else "velocity",
        check=iiwa_dnn.CrossCheck(()),
        **options,
    )
    settled = record.t >= SETTLED_AFTER
    error = position_error(record)
    distance = np.linalg.norm(error, axis=1)
    signals = (record.dq_solver[settled[:-1]], record.dq[settled[:-1]])
    commands, motion = (np.abs(np.diff(dq, axis=0)).sum() / record.dof for dq in signals)
    span = duration - SETTLED_AFTER
    largest = float(distance[settled].max())
    mse = float(np.mean(error[settled] ** 2))
    return [mse, largest, float(distance[-1]), float(commands / span), float(motion / span)]


def main(
    folder: tyro.conf.Positional[str] = "runs/noise",
    seeds: int = 100,
    duration: float = 2.0,
    workers: int | None = None,
):
    """Run every disturbance with every countermeasure, and print a table for each disturbance.

    Runs last `duration` [s], above 1; those with chance in them are drawn for so many seeds.
    """
    cells = [
        (kind, means, seed, duration)
        for kind, means in product(DISTURBANCES, COUNTERMEASURES)
        for seed in range(seeds if kind in CHANCE else 1)
    ]
    results = sweep(measure, cells, Path(folder) / "cells", workers=workers)
    found = {cell[:2]: [] for cell in cells}
    for cell, result in zip(cells, results, strict=True):
        found[cell[:2]].append(result)
    head = ("countermeasure", "MSE [m²]", "max [m]", "last [m]", "command", "motion [rad/s²]")
    parts = []
    for kind in DISTURBANCES:
        rows = []
        for means in COUNTERMEASURES:
            values = np.array(found[kind, means])
            range_ = f" ± {estimate(values[:, 0]).half_width:.1g}" if len(values) > 1 else ""
            mse, *others = (f"{value:.3g}" for value in values.mean(axis=0))
            rows.append([means, mse + range_, *others])
        parts += [f"## {kind}", tabulate(rows, head, "pipe", disable_numparse=True)]
    text = "\n\n".join(parts)
    (Path(folder) / "noise.md").write_text(text + "\n", encoding="utf-8")
    print(text)


if __name__ == "__main__":
    sys.exit(tyro.cli(main))
