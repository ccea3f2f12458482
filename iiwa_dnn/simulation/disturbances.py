"""Differences between an arm in physics and the controller's nominal model of it.

The default of every disturbance is none. The option ``--disturb`` takes `Disturbances.typical`; its
sizes are assumptions, stated here, as the maker publishes none of them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp.program import Vector


@dataclass(frozen=True)
class Push:
    """A force on the tip for a while.

    Attributes:
        force: Force along the world's axes [N], (3,).
        start: Time at which it begins [s].
        duration: Time for which it lasts [s].
    """

    force: tuple[float, float, float] = (0.0, 10.0, 0.0)
    start: float = 5.0
    duration: float = 0.2

    def __post_init__(self) -> None:
        """Check the numbers; raises InvalidInputError naming the one that is wrong."""
        object.__setattr__(self, "force", checks.vector3("push", self.force))
        checks.not_negative("push_at", self.start)
        checks.not_negative("push_for", self.duration)


@dataclass(frozen=True)
class Disturbances:
    """Differences between the arm and the controller's model of it.

    Attributes:
        mass_error: Relative error of the moving links' masses and inertias: each is too heavy or
            too light by this much, which of the two is drawn from the seed.
        friction: Coulomb friction as a fraction of the joints' torque limits; a joint without a
            limit has none.
        encoder_noise: Standard deviation of white noise on every encoder reading [rad].
        encoder_bits: Encoder readings are rounded to 2 pi / 2^bits [rad]; 0 rounds nothing.
        delay_periods: Control periods by which a velocity command arrives late.
        push: A push on the tip, if there is one.
    """

    mass_error: float = 0.0
    friction: float = 0.0
    encoder_noise: float = 0.0
    encoder_bits: int = 0
    delay_periods: int = 0
    push: Push | None = None

    def __post_init__(self) -> None:
        """Check the numbers; raises InvalidInputError naming the one that is wrong."""
        for name in ("mass_error", "friction", "encoder_noise"):
            checks.not_negative(name, getattr(self, name))
        for name in ("encoder_bits", "delay_periods"):
            checks.integer(name, getattr(self, name), 0)
        if self.mass_error >= 1.0:
            raise InvalidInputError("mass_error", "must be below 1", self.mass_error)

    @classmethod
    def typical(cls, push: Push | None = None) -> Disturbances:
        """Return all disturbances at their assumed sizes, and a push only where one is given."""
        return cls(
            mass_error=0.1,  # every mass of the URDF is an estimate
            friction=0.01,  # 1.76 N m at the iiwa's first two joints
            encoder_noise=1e-5,
            encoder_bits=18,  # 2.4e-5 rad
            delay_periods=1,
            push=push,
        )

    def mass_factors(self, joints: int, seed: int) -> Vector:
        """Draw for each joint the factor by which the links that it carries are too heavy, (n,)."""
        signs = np.random.default_rng([seed, 0]).choice([-1.0, 1.0], joints)
        return 1.0 + self.mass_error * signs


class Encoder:
    """An encoder on every joint, whose readings have noise and are then rounded.

    Args:
        noise: Standard deviation of a reading [rad].
        bits: Readings are rounded to 2 pi / 2^bits [rad]; 0 rounds nothing.
        seed: Seed of the noise.
    """

    def __init__(self, noise: float, bits: int, seed: int) -> None:
        self.noise = noise
        self.step = math.ldexp(2.0 * math.pi, -bits) if bits else 0.0
        self._rng = np.random.default_rng([seed, 1])

    def __call__(self, q: Vector) -> Vector:
        """Measure joint angles `q` (n,) [rad]; the reading is a new array."""
        reading: Vector = q.copy()
        if self.noise:
            reading += self.noise * self._rng.standard_normal(q.size)
        if self.step:
            reading = self.step * np.round(reading / self.step)
        return reading
