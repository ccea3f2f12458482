r"""Feedback gain out of the noise.

In steps of dt, with white noise of standard deviation :math:`\sigma` on the velocity
and :math:`\sigma_m` on the measured position, the error
:math:`e^+ = (1 - \delta\,dt)\,e + dt\,(\sigma n - \delta \sigma_m m)` has the variance

.. math::  \frac{dt\,(\sigma^2 + \delta^2 \sigma_m^2)}{\delta\,(2 - \delta\,dt)},

least at the positive root of :math:`\sigma_m^2 \delta^2 + \sigma^2 dt\,\delta = \sigma^2`: about
:math:`\sigma / \sigma_m`, and :math:`1 / dt` where the measurement is exact. The command is as
rough as the error it feeds back: from one step to the next it changes by :math:`\delta\,dt` times
the noise, which is what limits the gain in practice.

The gain is that of a stationary first-order Kalman filter.
"""

import math

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError

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
