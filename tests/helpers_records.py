"""Made-up records whose metrics are known in closed form."""

from typing import Any

import numpy as np
import pytest

from iiwa_dnn.references import Heart, Target
from iiwa_dnn.results import plots
from iiwa_dnn.results.record import Record

DOF = 7


def draw_only(monkeypatch: pytest.MonkeyPatch, *names: str) -> None:
    """Let a run draw these figures alone: each takes half a second to be written."""
    monkeypatch.setattr(plots, "FIGURES", {name: plots.FIGURES[name] for name in names})


def make_record(
    steps: int = 10, dof: int = DOF, solvers: tuple[str, ...] = ("proxqp",), **changes: Any
) -> Record:
    """A run at rest with no error at all; `changes` replaces fields, `settings` only its keys."""
    references = len(solvers)
    settings: dict[str, Any] = {
        "robot": "iiwa7",
        "joints": [f"joint {k + 1}" for k in range(dof)],
        "q_lower": [-2.5] * dof,
        "q_upper": [2.5] * dof,
        "dq_max": [1.5] * dof,
        "dt": 0.1,
        "duration": max(steps, 1) * 0.1,
        "mode": "converged",
        "check": {
            "solvers": list(solvers),
            "second": ["osqp" if name == "proxqp" else "proxqp" for name in solvers],
            "tolerance": 1e-6,
            "reference_tolerance": 1e-8,
        },
        "tol": 1e-9,
        "scheme": {"name": "DoubleIndicator", "weight": 0.2, "kinetic": "identity"},
        "reference": {"name": "Heart", "scale": 3.45e-3, "period": 10.0},
        "motion": "euler",
        "noise": 0.0,
        "filter_window": 1,
        "seed": 0,
        "versions": {"iiwa_dnn": "0.1.0", "numpy": np.__version__},
        "status": "completed",
    }
    fields: dict[str, Any] = {
        "t": 0.1 * np.arange(steps + 1),
        "q": np.zeros((steps + 1, dof)),
        "dq": np.zeros((steps, dof)),
        "dq_solver": np.zeros((steps, dof)),
        "position": np.zeros((steps + 1, 3)),
        "rotation": np.tile(np.eye(3), (steps + 1, 1, 1)),
        "position_desired": np.zeros((steps + 1, 3)),
        "rotation_desired": np.tile(np.eye(3), (steps + 1, 1, 1)),
        "kinetic_index": np.zeros(steps),
        "kkt_residual": np.full(steps, 1e-10),
        "iterations": np.full(steps, 2),
        "solution_gap": np.full((steps, references), 1e-9),
        "objective_gap": np.full((steps, references), 1e-12),
        "feasibility_gap": np.full((steps, references), 1e-11),
        "reference_residual": np.full((steps, references), 1e-10),
        "wall_time_s": 0.5,
    }
    settings |= changes.pop("settings", {})
    return Record(**(fields | changes), settings=settings)


def heart_record(
    steps: int = 100_000,
    noise: float = 0.0,
    error: float = 2e-7,
    solvers: tuple[str, ...] = ("proxqp",),
    seed: int = 0,
    **settings: Any,
) -> Record:
    """A run that looks like the paper's heart: 10 s, seven joints, errors of the given size [m]."""
    rng = np.random.default_rng(seed)
    t = np.linspace(0.0, 10.0, steps + 1)
    phase = 2.0 * np.pi * t / 10.0
    heart = Heart().anchored(Target([0.0, 0.45, 0.6], np.eye(3)))
    desired = np.array([target.position[[1, 0, 2]] for target in heart.sample(t)])
    direction = np.column_stack([np.sin(phase), np.sin(2 * phase + 1.0), np.cos(3 * phase)])
    actual = desired + error * 0.7 * (direction + rng.normal(0.0, 0.02, (steps + 1, 3)))
    swing = np.array([0.2, 0.14, 0.25, -0.3, 0.1, 0.22, 0.3])
    q = swing * (np.sin(phase[:, np.newaxis] + np.arange(DOF)) - np.sin(np.arange(DOF)))
    q += [0.3, 0.8, -0.4, -1.4, 0.2, 0.9, 2.3]
    dq = np.diff(q, axis=0) / np.diff(t)[:, np.newaxis] + noise * rng.normal(size=(steps, DOF))
    gap = 10.0 ** rng.uniform(-10.0, -8.0, (steps, len(solvers)))
    return make_record(
        steps=steps,
        solvers=solvers,
        t=t,
        q=q,
        dq=dq,
        dq_solver=dq,
        position=actual,
        position_desired=desired,
        kinetic_index=np.sum(dq**2, axis=1),
        kkt_residual=10.0 ** rng.uniform(-13.0, -9.1, steps),
        solution_gap=gap * (1 + 10 * np.arange(len(solvers))),
        settings={"dt": 10.0 / steps, "duration": 10.0} | settings,
    )
