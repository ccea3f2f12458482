"""Settings of a run, the same in Python and in the table [run] of a settings file."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.control.controller import Mode
from iiwa_dnn.control.paths import References, by_frame
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.simulation.estimation import NoiseModel
from iiwa_dnn.simulation.motion import MOTIONS, Motion
from iiwa_dnn.simulation.plants import IdealPlant, Plant
from iiwa_dnn.step.policies import Policy

MAX_STEPS = 20_000_000
"""Largest number of steps of a run, for memory: a record takes 0.4 kB a step."""


NoiseEntry = Literal["velocity", "network", "measurement"]
NOISE_ENTRIES: tuple[NoiseEntry, ...] = get_args(NoiseEntry)
"""Signals that noise may be added to; it has the unit of that signal.

``velocity`` [rad/s]: the joint velocity that the controller commands, before the filter: the
paper's section IV. ``network`` [rad/s]: x of the network's state after each step's answer was
taken, so the network has one control step to work it off; a network that converges at every step
forgets it. ``measurement`` [rad]: the joint positions that the controller sees; the robot, and the
record, keep the true ones.
"""

LARGEST = 1e3
"""The largest noise that is accepted, [rad/s] or [rad]: far more overflows."""


@dataclass(frozen=True, eq=False)
class RunSettings:
    """Settings of a run.

    Attributes:
        dt: Control period [s].
        duration: Length of the run [s], rounded to whole steps; None takes the reference's.
        mode: ``"converged"``: the network converges at every step; ``"continuous"``: it advances by
            one control period (`iiwa_dnn.Controller`).
        motion: ``"euler"``, ``"midpoint"`` or ``"rk4"``; ``continuous`` and physics take ``euler``.
        policy: Action at a step without solution (`iiwa_dnn.Controller`).
        plant: The arm that moves; by default the ideal one (`MujocoPlant` has masses and motors).
        check: Reference solvers, by default ProxQP; ``CrossCheck(())`` asks nobody.
        solver: The network, its integrators and their tolerance, by default the paper's network; it
            is reset before the run.
        noise: Standard deviation of white noise on each joint, in the unit of the signal that it
            is added to; or the noise itself, (steps, n).
        noise_at: Signal that the noise is added to (`NOISE_ENTRIES`).
        filter_window: Samples of the moving average of the velocity; 1: no filter.
        estimator: Noise model of a Kalman filter of the joint positions, whose bias is taken off
            the command; None: the controller sees the measured positions.
        seed: Seed of the noise and of the plant.

    Raises:
        InvalidInputError: A setting is out of range; the message names it.
    """

    dt: float = 1e-4
    duration: float | None = None
    mode: Mode = "converged"
    motion: Motion = "euler"
    policy: Policy = "slow"
    plant: Plant = field(default_factory=IdealPlant)
    check: CrossCheck = field(default_factory=CrossCheck)
    solver: DNNSolver = field(default_factory=DNNSolver)
    noise: float | ArrayLike = 0.0
    noise_at: NoiseEntry = "velocity"
    filter_window: int = 1
    estimator: NoiseModel | None = None
    seed: int = 0

    def __post_init__(self) -> None:
        checks.positive("dt", self.dt)
        if self.duration is not None:
            checks.positive("duration", self.duration)
        checks.one_of("motion", self.motion, tuple(MOTIONS))
        checks.offers("plant", self.plant, "start", "read", "move")
        checks.instance("check", self.check, CrossCheck)
        if not isinstance(self.noise, np.ndarray) and not (
            checks.not_negative("noise", self.noise) <= LARGEST
        ):
            raise InvalidInputError("noise", f"must be at most {LARGEST:g}", self.noise)
        checks.one_of("noise_at", self.noise_at, NOISE_ENTRIES)
        checks.integer("filter_window", self.filter_window, 1)
        if self.estimator is not None:
            checks.instance("estimator", self.estimator, NoiseModel)
        checks.integer("seed", self.seed, 0)

    def duration_of(self, reference: References | None) -> float:
        """Return the duration of a run along a reference [s]."""
        paths = by_frame(reference, "").values()
        own = self.duration or max((path.duration for path in paths), default=self.dt)
        return checks.positive("duration", own)

    def steps(self, reference: References | None) -> int:
        """Count the whole steps of a run along a reference.

        Raises:
            InvalidInputError: There are none or too many, or the reference does not end.
        """
        count = self.duration_of(reference) / self.dt
        if not 0.5 < count <= MAX_STEPS:
            name = "dt" if count > 1.0 and self.dt < 1e-6 else "duration"
            problem = f"{count:.3g} steps of {self.dt:g} s; there must be from 1 to {MAX_STEPS:,}"
            raise InvalidInputError(name, problem, getattr(self, name))
        return max(1, round(count))
