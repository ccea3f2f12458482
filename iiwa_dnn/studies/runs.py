"""One run of the paper's heart from plain settings, and the numbers that are kept of it.

`measure` is the task of the sweeps: whatever it returns depends on its settings alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from functools import cache
from typing import Any, Literal

import numpy as np

from iiwa_dnn.control.controller import Mode
from iiwa_dnn.networks import ProjectionNetwork
from iiwa_dnn.networks.integrators import ExplicitEuler, ImplicitEuler, Integrator
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.references import Heart, Reference
from iiwa_dnn.results.metrics import compute_metrics
from iiwa_dnn.results.record import Record
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.robot.robot import Robot, load_robot
from iiwa_dnn.schemes import DoubleIndicator, PseudoInverse, Scheme
from iiwa_dnn.schemes.double_indicator import Kinetic
from iiwa_dnn.schemes.orientation import Orientation
from iiwa_dnn.simulation import NoiseEntry, Simulation
from iiwa_dnn.simulation.motion import Motion
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.stability import amplification
from iiwa_dnn.studies.sweeps import Outcome

_KEPT = (
    "max_position_error_m",
    "mse_position_error_m2",
    "max_orientation_error_rad",
    "joint_drift_rad",
    "max_kinetic_index",
    "max_kkt_residual",
    "position_limit_violation_rad",
    "velocity_limit_violation_rad_s",
    "wall_time_s",
)
_STABILITY_SAMPLES = 101


@dataclass(frozen=True)
class HeartRun:
    """Settings of one run of the paper's robot along its heart; the defaults are the paper's own.

    Attributes:
        weight: The paper's xi.
        mode: ``"continuous"`` (the paper's) or ``"converged"``.
        orientation: ``"block"`` (the paper's), ``"so3"`` or ``"none"``.
        kinetic: G: ``"identity"`` (the paper's) or ``"inertia"``.
        baseline: Whether the pseudo-inverse takes the scheme's place, which has neither weight
            nor bounds.
        substeps: How the network is advanced in ``continuous`` mode: that many explicit
            sub-steps a control step, as many as are ``"computed"`` to be stable, or
            ``"implicit"`` Euler.
        noise: Standard deviation, in the unit of `noise_at` (`NOISE_ENTRIES`).
        noise_at: Where the noise enters.
        filter_window: Samples in the moving average.
        seed: Seed of the noise.
        dt: Control period [s].
        duration: Length of the run [s].
        motion: Motion integrator.
        keep_record: Whether the run itself is kept, for figures.
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
    keep_record: bool = False

    def settings(self) -> dict[str, Any]:
        """In JSON types; runs that cannot differ have the same settings, and are run once."""
        silent = replace(self, seed=0, noise_at="velocity") if self.noise == 0.0 else self
        return asdict(silent)

    def simulation(self) -> Simulation:
        """The run, ready to be carried out, without reference solvers."""
        # Implicit steps of the flow without the projection are convex problems, and compiled.
        network = ProjectionNetwork(primal_projection=self.substeps != "implicit")
        return Simulation(
            paper_robot(),
            self.scheme(),
            self.reference(),
            paper.START,
            dt=self.dt,
            duration=self.duration,
            mode=self.mode,
            motion=self.motion,
            noise=self.noise,
            noise_at=self.noise_at,
            filter_window=self.filter_window,
            seed=self.seed,
            check=CrossCheck(()),
            solver=DNNSolver(network, follower=self.follower()),
        )

    def scheme(self) -> Scheme:
        """What builds the programs, with the paper's start as its home."""
        if self.baseline:
            return PseudoInverse(orientation=self.orientation)
        return DoubleIndicator(
            self.weight, orientation=self.orientation, kinetic=self.kinetic, home=paper.START
        )

    def reference(self) -> Reference:
        """The heart from the paper's start."""
        return Heart().anchored(Configuration(paper_robot(), paper.START))

    def follower(self) -> Integrator:
        """The integrator of ``continuous`` mode."""
        if self.substeps == "implicit":
            return ImplicitEuler()
        return ExplicitEuler(substeps=None if self.substeps == "computed" else self.substeps)


@cache
def paper_robot() -> Robot:
    """The iiwa 7 with the paper's position limits."""
    return load_robot("iiwa7").with_limits(lower=-paper.JOINT_LIMIT, upper=paper.JOINT_LIMIT)


def measure(settings: Mapping[str, Any]) -> Outcome:
    """Carry out one run and sum it up.

    Args:
        settings: Those of a `HeartRun`.

    Returns:
        Some of `compute_metrics`, and: ``status``; ``total_variation_rad_s``, of the joint
        velocity that varies most; ``lap_drift_rad``, the largest joint drift after each whole
        lap; ``jacobian_square_m2``, the mean over the path of tr(J J^T) for the position rows;
        ``amplification``, of one explicit sub-step in continuous mode (`amplification`), else
        None.
    """
    run = HeartRun(**settings)
    record = run.simulation().run()
    metrics = compute_metrics(record)
    values = {name: metrics[name] for name in _KEPT}
    values |= {
        "status": record.settings["status"],
        "total_variation_rad_s": total_variation(record),
        "lap_drift_rad": lap_drift(record, Heart().period),
        **_along_the_path(run, record),
    }
    return Outcome(values, record if run.keep_record else None)


def total_variation(record: Record) -> float:
    """Sum of the joint velocity's changes from step to step [rad/s], of the joint with most.

    A smooth run's is the sum of its ups and downs; chatter adds its height at every step.
    """
    if record.steps < 2:
        return 0.0
    return float(np.abs(np.diff(record.dq, axis=0)).sum(axis=0).max())


def lap_drift(record: Record, period: float) -> list[float]:
    """Largest distance of a joint from its start [rad] after each whole lap."""
    dt = float(record.settings["dt"])
    ends = [round(lap * period / dt) for lap in range(1, int(record.t[-1] / period + 0.5) + 1)]
    return [float(np.abs(record.q[k] - record.q[0]).max()) for k in ends if k <= record.steps]


def _along_the_path(run: HeartRun, record: Record) -> dict[str, float | None]:
    """What depends on the postures that the run went through, at a hundred of them."""
    scheme, reference = run.scheme(), run.reference()
    explicit = run.mode == "continuous" and run.substeps != "implicit"
    worst, squares = 0.0, []
    samples = np.unique(np.linspace(0, record.steps - 1, _STABILITY_SAMPLES).astype(int))
    for k in samples:
        conf = Configuration(paper_robot(), record.q[k])
        squares.append(float(np.sum(conf.jacobian[:3] ** 2)))
        if explicit:
            qp = scheme.build_qp(conf, reference.at(float(record.t[k])))
            # An explicit run's iterations are its sub-steps.
            step = run.dt / record.settings["rho"] / float(record.iterations[k])
            worst = max(worst, amplification(qp, step))
    return {
        "jacobian_square_m2": float(np.mean(squares)),
        "amplification": worst if explicit else None,
    }
