"""Disturbances of the loop: how they are drawn, and where they may enter."""

import math
from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.control.estimation import NoiseModel
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp.program import Matrix, Vector

NoiseEntry = Literal["velocity", "network", "measurement"]
NOISE_ENTRIES: tuple[NoiseEntry, ...] = ("velocity", "network", "measurement")
"""Places at which noise may enter the loop; sigma is in the unit of what it is added to.

``velocity`` [rad/s]: added to the joint velocity that the controller commands, before the filter:
the paper's section IV. ``network`` [rad/s]: added to x of the network's state after each step's
answer was taken, so the network has one control step to work it off; a network that settles at
every step forgets it. ``measurement`` [rad]: added to the joint angles that the controller sees;
the robot, and the record, keep the true ones.
"""


LARGEST = 1e3
"""The most noise that is accepted, [rad/s] or [rad]: no robot has it, and far more overflows."""


def gaussian_noise(sigma: float, steps: int, joints: int, seed: int) -> Matrix:
    """White Gaussian noise, drawn anew at every control step (section IV of the paper).

    Args:
        sigma: Standard deviation, in [rad/s] or [rad] by where it enters (`NOISE_ENTRIES`); the
            paper's amplitude is 0.01.
        steps: Number of control steps.
        joints: Number of joints.
        seed: The same seed gives the same noise, wherever it enters.

    Returns:
        Noise in the unit of `sigma`, of shape (steps, joints).

    Raises:
        InvalidInputError: `sigma` is negative, not finite or above ``LARGEST``, or `seed` is
            negative.
    """
    if checks.not_negative("noise", sigma) > LARGEST:
        raise InvalidInputError("noise", f"must be at most {LARGEST:g}, not {sigma:g}", sigma)
    checks.integer("seed", seed, 0)
    if sigma == 0.0:
        return np.zeros((steps, joints))
    return sigma * np.random.default_rng(seed).standard_normal((steps, joints))


@dataclass(frozen=True)
class VelocityDisturbance:
    """A disturbance of every joint's velocity that no average removes.

    It is added where the noise ``velocity`` is: ``bias + slope t + amplitude sin(2 pi f t)``.

    Attributes:
        bias: Constant part [rad/s].
        slope: Growth of the ramp [rad/s^2].
        amplitude: Of the sinusoid [rad/s].
        frequency: f, of the sinusoid [Hz].
    """

    bias: float = 0.0
    slope: float = 0.0
    amplitude: float = 0.0
    frequency: float = 1.0

    def __post_init__(self) -> None:
        """Check the numbers; raises InvalidInputError naming the one that is wrong."""
        for name in ("bias", "slope", "amplitude"):
            if checks.finite(name, value := getattr(self, name)) > LARGEST or value < -LARGEST:
                raise InvalidInputError(name, f"must be within {LARGEST:g}, not {value:g}", value)
        checks.positive("frequency", self.frequency)

    def at(self, times: Vector) -> Vector:
        """The disturbance [rad/s] at times (k,) [s], the same for all joints; (k,)."""
        wave = np.sin(2.0 * math.pi * self.frequency * times)
        disturbance: Vector = self.bias + self.slope * times + self.amplitude * wave
        return disturbance


@dataclass(frozen=True)
class Disturbance:
    """All that disturbs the signals between controller and robot, and what is done against it.

    Attributes:
        noise: Standard deviation of white noise on each joint, in the unit of the quantity it is
            added to: [rad/s], or [rad] for ``measurement``.
        noise_at: ``"velocity"``, commanded; ``"network"``, its x; ``"measurement"``, read joints.
        velocity: Added to every joint's velocity beside the noise; None: nothing.
        filter_window: Samples of the moving average of the velocity; 1: no filter.
        estimator: Noise model of a Kalman filter of the joint positions, whose bias the controller
            takes off its command; None: it sees what is measured.
    """

    noise: float = 0.0
    noise_at: NoiseEntry = "velocity"
    velocity: VelocityDisturbance | None = None
    filter_window: int = 1
    estimator: NoiseModel | None = None

    def __post_init__(self) -> None:
        """Check the parameters; raises InvalidInputError naming the one that is wrong."""
        checks.one_of("noise_at", self.noise_at, NOISE_ENTRIES)
        checks.integer("filter_window", self.filter_window, 1)
        if self.velocity is not None:
            checks.instance("disturbance", self.velocity, VelocityDisturbance)
        if self.estimator is not None:
            checks.instance("estimator", self.estimator, NoiseModel)

    def settings(self) -> dict[str, Any]:
        """Return the entries of a run's settings, as values that JSON can hold."""
        return {
            "noise": self.noise,
            "noise_at": self.noise_at,
            "disturbance": None if self.velocity is None else asdict(self.velocity),
            "filter_window": self.filter_window,
            "estimator": None if self.estimator is None else self.estimator.settings(),
        }
