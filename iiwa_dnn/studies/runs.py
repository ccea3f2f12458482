"""One run of the paper's heart, and its metrics.

`measure` is the task of the sweeps: its result depends on the `HeartRun` alone.
"""

from dataclasses import dataclass
from functools import cache
from typing import Any, Literal

import numpy as np

from iiwa_dnn import (
    AccelerationLimits,
    Configuration,
    CrossCheck,
    DNNSolver,
    DoubleIndicator,
    ExplicitEuler,
    Heart,
    ImplicitEuler,
    JerkLimits,
    ProjectionNetwork,
    PseudoInverse,
    Record,
    Reference,
    Robot,
    Scheme,
    checks,
    compute_metrics,
    load_robot,
    simulate,
)
from iiwa_dnn.control.controller import Mode
from iiwa_dnn.schemes.costs import Kinetic
from iiwa_dnn.schemes.tasks import Orientation
from iiwa_dnn.simulation import NoiseEntry
from iiwa_dnn.simulation.motion import Motion
from iiwa_dnn.studies import paper

_KEPT = (
    "max_position_error_m",
    "mse_position_error_m2",
    "max_orientation_error_rad",
    "joint_drift_rad",
    "max_kinetic_index",
    "max_kkt_residual",
    "position_limit_violation_rad",
    "velocity_limit_violation_rad_s",
)
_HANDED_ON = ("dt", "duration", "mode", "motion", "noise", "noise_at", "filter_window", "seed")


@dataclass(frozen=True)
class Scope:
    """Sizes of the paper's experiments.

    Attributes:
        duration: Length of each run [s]; the heart takes 10 s.
        seeds: Number of noises in Table II, two or more.
        weights: Columns of Table I.
        laps: Number of hearts drawn to see the drift add up.
        laps_dt: Control period of those laps [s]; they are integrated by the midpoint rule.
        dt: Control period of everything else [s].
    """

    duration: float = 10.0
    seeds: int = 100
    weights: tuple[float, ...] = paper.WEIGHTS
    laps: int = 10
    laps_dt: float = 1e-3
    dt: float = paper.DT

    def __post_init__(self) -> None:
        """Check the sizes; raises InvalidInputError naming the one that is wrong."""
        checks.integer("seeds", self.seeds, 2)
        checks.integer("laps", self.laps, 1)
        checks.positive("duration", self.duration)
        for weight in self.weights:
            checks.one_of("weights", str(weight), tuple(map(str, paper.WEIGHTS)))


FULL = Scope()
"""The paper's experiments at full length, over 100 seeds."""

QUICK = Scope(duration=1.0, seeds=5, laps=2, laps_dt=1e-2)
"""The same with the first second of each run: a smoke test, not for comparison."""


@dataclass(frozen=True)
class HeartRun:
    """Settings of one run of the paper's robot along its heart; the defaults are the paper's own.

    Attributes:
        weight: The paper's xi.
        mode: ``"continuous"`` (the paper's) or ``"converged"``.
        orientation: ``"block"`` (the paper's), ``"so3"`` or ``"none"``.
        kinetic: G: ``"identity"`` (the paper's) or ``"inertia"``.
        baseline: True for the pseudo-inverse, which has neither weight nor bounds.
        substeps: Advance of the network in ``continuous`` mode: that many explicit sub-steps a
            control step, as many as are ``"computed"`` to be stable, or ``"implicit"`` Euler.
        noise: Standard deviation, in the unit of `noise_at` (`NOISE_ENTRIES`).
        noise_at: Entry of the noise.
        filter_window: Samples in the moving average.
        seed: Seed of the noise.
        dt: Control period [s].
        duration: Length of the run [s].
        motion: Motion integrator.
    """

    weight: float = paper.WEIGHT
    mode: Mode = "continuous"
    orientation: Orientation = "block"
    kinetic: Kinetic = "identity"
    baseline: bool = False
    substeps: int | Literal["computed", "implicit"] = "computed"
    noise: float = 0.0
    noise_at: NoiseEntry = "velocity"
    filter_window: int = 1
    seed: int = 0
    dt: float = paper.DT
    duration: float = 10.0
    motion: Motion = "euler"

    def run(self) -> Record:
        """Carry out the run, without reference solvers."""
        options: dict[str, Any] = {name: getattr(self, name) for name in _HANDED_ON}
        implicit = self.substeps == "implicit"
        steps = None if isinstance(self.substeps, str) else self.substeps
        advance_integrator = ImplicitEuler() if implicit else ExplicitEuler(substeps=steps)
        # Implicit steps of the flow without the projection are convex problems, and compiled.
        solver = DNNSolver(
            ProjectionNetwork(primal_projection=not implicit), advance_integrator=advance_integrator
        )
        return simulate(
            paper_robot(),
            self.scheme(),
            self.reference(),
            paper.START,
            solver=solver,
            check=CrossCheck(()),
            **options,
        )

    def scheme(self) -> Scheme:
        """Make the scheme, with the paper's start as its home."""
        if self.baseline:
            return PseudoInverse(orientation=self.orientation)
        return DoubleIndicator(
            self.weight,
            orientation=self.orientation,
            kinetic=self.kinetic,
            home=paper.START,
            extra_limits=(AccelerationLimits(np.inf), JerkLimits(np.inf)),  # the paper has none
        )

    def reference(self) -> Reference:
        """Make the heart from the paper's start."""
        return Heart().anchored(Configuration(paper_robot(), paper.START))


@cache
def paper_robot() -> Robot:
    """Load the iiwa 7 with the paper's position limits."""
    return load_robot("iiwa7").with_limits(lower=-paper.JOINT_LIMIT, upper=paper.JOINT_LIMIT)


def measure(run: HeartRun) -> dict[str, Any]:
    """Carry out a run and sum it up.

    Returns:
        Some of `compute_metrics`, and: ``status``; ``total_variation_rad_s``, of the joint
        velocity that varies most; ``lap_drift_rad``, the largest joint drift after each whole
        lap; ``max_kinetic_index_times_dt``, as the paper seems to print it.
    """
    record = run.run()
    metrics = compute_metrics(record)
    index = metrics["max_kinetic_index"]
    return {
        **{name: metrics[name] for name in _KEPT},
        "status": record.settings["status"],
        "total_variation_rad_s": total_variation(record),
        "lap_drift_rad": lap_drift(record, Heart().period),
        "max_kinetic_index_times_dt": None if index is None else index * run.dt,
    }


def total_variation(record: Record) -> float:
    """Return the largest total variation of a joint velocity over a run [rad/s].

    It is the sum of the changes from step to step, so chatter adds its height at every step.
    """
    return float(np.abs(np.diff(record.dq, axis=0)).sum(axis=0).max())


def lap_drift(record: Record, period: float) -> list[float]:
    """Return the largest distance of a joint from its start [rad] after each whole lap."""
    dt = float(record.settings["dt"])
    ends = [round(lap * period / dt) for lap in range(1, int(record.t[-1] / period + 0.5) + 1)]
    return [float(np.abs(record.q[k] - record.q[0]).max()) for k in ends if k <= record.steps]
