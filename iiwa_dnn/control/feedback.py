r"""Feedback against disturbances: an integral term, and a gain chosen from the noise.

**Integral term.** The schemes draw an error e back by :math:`\dot e = -\delta e`; a disturbance d
of the velocity then leaves :math:`e = d / \delta`. With the integral of the error fed back too,

.. math::  \dot e = -\delta\,e - k \int e\,dt + d,

a constant d leaves nothing, a ramp of slope r leaves :math:`r / k`, and a sinusoid is damped below
the frequency :math:`\sqrt{k / 2}` and grows above it, by an eighth at :math:`\sqrt k` with
:math:`k = \delta^2 / 4`. There the poles meet at :math:`-\delta / 2`: what a constant d leaves goes
the fastest way without changing its sign; an error at the start overshoots by
:math:`e^{-2} = 0.135` of itself.

**Gain.** In steps of dt, with white noise of standard deviation :math:`\sigma` on the velocity
and :math:`\sigma_m` on the measured position, the error
:math:`e^+ = (1 - \delta\,dt)\,e + dt\,(\sigma n - \delta \sigma_m m)` has the variance

.. math::  \frac{dt\,(\sigma^2 + \delta^2 \sigma_m^2)}{\delta\,(2 - \delta\,dt)},

least at the positive root of :math:`\sigma_m^2 \delta^2 + \sigma^2 dt\,\delta = \sigma^2`: about
:math:`\sigma / \sigma_m`, and :math:`1 / dt` where the measurement is exact. The command is as
rough as the error it feeds back: from one step to the next it changes by :math:`\delta\,dt` times
the noise, which is what limits the gain in practice.

Sources: L. Jin, Y. Zhang, S. Li, "Integration-enhanced Zhang neural network for real-time-varying
matrix inversion in the presence of various kinds of noises", IEEE Transactions on Neural Networks
and Learning Systems 27 (2016), which calls it noise-tolerant; the gain is that of a stationary
first-order Kalman filter.
"""

import math

import numpy as np
import pinocchio as pin

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.references import Target
from iiwa_dnn.robot.configuration import Configuration

ROUGHNESS = 0.02
"""Roughness of a command that `noise_gain` accepts: its change from step to step as a share of the
noise's, which is :math:`\\delta\\,dt`."""


def noise_gain(
    velocity_noise: float, measurement_noise: float, dt: float, roughness: float = ROUGHNESS
) -> float:
    """The feedback gain with the least error that keeps the command smooth enough.

    Args:
        velocity_noise: Standard deviation of white noise on each velocity command [rad/s].
        measurement_noise: Of white noise on each measured angle [rad].
        dt: Control period [s].
        roughness: Largest accepted gain times dt, in (0, 1].

    Returns:
        The gain [1/s], above 0; 0 where there is no noise on the velocity to work against.

    Raises:
        InvalidInputError: A number is out of range; the message names it.
    """
    checks.positive("dt", dt)
    if not 0.0 < checks.positive("roughness", roughness) <= 1.0:
        raise InvalidInputError("roughness", f"must be in (0, 1], not {roughness}", roughness)
    a = checks.not_negative("velocity_noise", velocity_noise) ** 2
    b = checks.not_negative("measurement_noise", measurement_noise) ** 2
    if a == 0.0:
        return 0.0
    # The root in the form that does not cancel, and holds for b = 0.
    best = 2.0 * a / (a * dt + math.sqrt((a * dt) ** 2 + 4.0 * a * b))
    return min(best, roughness / dt)


class IntegralFeedback:
    """The integral term: turns a target into one that moves to make up for the past errors.

    Attributes:
        gain: k [1/s^2].
    """

    def __init__(self, gain: float) -> None:
        """Start from no past.

        Raises:
            InvalidInputError: `gain` is not a positive number.
        """
        self.gain = checks.positive("integral_gain", gain)
        self._integral = np.zeros(6)

    def reset(self) -> None:
        """Forget the past."""
        self._integral[:] = 0.0

    def observe(self, conf: Configuration, target: Target, dt: float) -> None:
        """Add this step's error to the integral; once a step, and not while the arm cannot follow.

        Args:
            conf: Where the robot is.
            target: Where it should be.
            dt: Control period [s].
        """
        self._integral[:3] += dt * (target.position - conf.position)
        self._integral[3:] += dt * np.asarray(pin.log3(target.rotation @ conf.rotation.T))

    def apply(self, target: Target) -> Target:
        """The target with the integral added to its velocities."""
        data = target.data.copy()
        data[12:] += self.gain * self._integral
        return Target.from_data(data)
