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
    Target,
    checks,
    compute_metrics,
    load_robot,
    simulate,
)
from iiwa_dnn.control.controller import Mode
from iiwa_dnn.references.targets import TargetData
from iiwa_dnn.results.metrics import position_error
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
        scale: Scale of the heart [m].
        period: Time of a lap [s].
        phase: Point of the heart at which the arm begins, as a fraction of a lap.
        start: Standard deviation of the network's state before the first step.
        limit_gain: The paper's kappa [1/s].
        orientation_gain: The paper's nu [1/s].
        velocity: Velocity limit of each joint [rad/s], below those of the data sheet.
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
    scale: float = 3.45e-3
    period: float = 10.0
    phase: float = 0.0
    start: float = 0.0
    limit_gain: float = 20.0
    orientation_gain: float = 10.2
    velocity: float = np.inf

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
        robot = paper_robot(self.velocity)
        scheme = self.scheme()

        def begin(steps: int) -> None:
            if steps == 0:  # after the solver's reset, before the first step
                state = solver.state_for(scheme.program(robot).sizes)
                state += np.random.default_rng(self.seed).normal(0.0, self.start, state.size)

        return simulate(
            robot,
            scheme,
            self.reference(),
            paper.START,
            solver=solver,
            check=CrossCheck(()),
            progress=begin,
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
            orientation_gain=self.orientation_gain,
            limit_gain=self.limit_gain,
            home=paper.START,
            extra_limits=(AccelerationLimits(np.inf), JerkLimits(np.inf)),  # the paper has none
        )

    def reference(self) -> Reference:
        """Make the heart from the paper's start."""
        start = Configuration(paper_robot(), paper.START)
        size = self.scale, self.period
        # The shifted heart is in Python, whose steps take a third longer.
        heart = ShiftedHeart(*size, self.phase * self.period) if self.phase else Heart(*size)
        return heart.anchored(Target(start.position - heart.at(0.0).position, start.rotation))


@dataclass(frozen=True, eq=False)
class ShiftedHeart(Heart):
    """The heart, begun at the time `shift` [s]; its origin stays the notch."""

    shift: float = 0.0

    def move(self, t: float, target: TargetData) -> None:
        """Move a target in place from the path's origin, at rest, to time t [s]."""
        super().move(t + self.shift, target)


@cache
def paper_robot(velocity: float | tuple[float, ...] = np.inf) -> Robot:
    """Load the iiwa 7 with the paper's position limits, its velocity [rad/s] limited."""
    robot = load_robot("iiwa7")
    return robot.with_limits(
        lower=-paper.JOINT_LIMIT,
        upper=paper.JOINT_LIMIT,
        velocity=np.minimum(robot.dq_max, velocity),
    )


def measure(run: HeartRun) -> dict[str, Any]:
    """Carry out a run and sum it up.

    Returns:
        Some of `compute_metrics`, and: ``status``; ``lap_drift_rad``, the largest joint drift after
        each whole lap; ``max_kinetic_index_times_dt``, as the paper seems to print it;
        ``max_axis_error_m``, the largest error along one axis; ``time_of_max_error_s``.
    """
    record = run.run()
    metrics = compute_metrics(record)
    error = position_error(record)
    index = metrics["max_kinetic_index"]
    return {
        **{name: metrics[name] for name in _KEPT},
        "status": record.settings["status"],
        "lap_drift_rad": lap_drift(record, run.period),
        "max_axis_error_m": float(np.abs(error).max()),
        "time_of_max_error_s": float(record.t[np.linalg.norm(error, axis=1).argmax()]),
        "max_kinetic_index_times_dt": None if index is None else index * run.dt,
    }


def lap_drift(record: Record, period: float) -> list[float]:
    """Return the largest distance of a joint from its start [rad] after each whole lap."""
    dt = float(record.settings["dt"])
    ends = [round(lap * period / dt) for lap in range(1, int(record.t[-1] / period + 0.5) + 1)]
    return [float(np.abs(record.q[k] - record.q[0]).max()) for k in ends if k <= record.steps]
