r"""A Kalman filter for joint angles that are measured with noise and driven with a bias.

For each joint by itself, with q the angle, d an unknown and nearly constant disturbance of its
velocity, and u the velocity that was commanded:

.. math::

    q^+ = q + dt\,(u + d + \sigma n_1), \qquad d^+ = d + \sqrt{dt}\,\beta\,n_2, \qquad
    z = q + \sigma_m n_3

All joints share the covariance, so the gains are computed once a step, two numbers. Feeding back
the estimated q instead of z keeps the encoders' noise out of the command; taking the estimated d
off the command removes a bias in the joints themselves, whatever the posture, which an integral
term of the tip's error cannot do in motion. If the drives carry a command out some periods late,
the velocity above is the one that they carry out, and the estimated angles are those at which the
next command begins, since all commands until then are known.

Source: R. E. Kalman, "A new approach to linear filtering and prediction problems", Journal of Basic
Engineering 82 (1960).
"""

from dataclasses import dataclass

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.qp.program import Vector


@dataclass(frozen=True)
class NoiseModel:
    """Noise that the filter assumes.

    Attributes:
        velocity: Standard deviation sigma of white noise on each velocity command [rad/s].
        measurement: sigma_m, of white noise on each measured angle [rad]; above 0.
        bias_walk: beta, how fast the disturbance may change [rad/s per sqrt(s)]; with 0 there is
            none, and nothing is taken off the command.
        bias: Standard deviation of the disturbance at the start [rad/s].
        delay_periods: Number of control periods by which the drives carry a command out late.
    """

    velocity: float = 0.01
    measurement: float = 1e-5
    bias_walk: float = 0.0
    bias: float = 0.1
    delay_periods: int = 0

    def __post_init__(self) -> None:
        """Check the numbers; raises InvalidInputError naming the one that is wrong."""
        checks.positive("measurement", self.measurement)
        for name in ("velocity", "bias_walk", "bias"):
            checks.not_negative(name, getattr(self, name))
        checks.integer("delay_periods", self.delay_periods, 0)


class JointEstimator:
    """Kalman filter of n joints.

    Attributes:
        model: Standard deviations of the noise.
        dt: Control period [s].
        bias: Estimated disturbance of the velocity [rad/s], (n,).
    """

    def __init__(self, model: NoiseModel, dt: float) -> None:
        """Start without an estimate.

        Raises:
            InvalidInputError: `dt` is not a positive time.
        """
        self.model = model
        self.dt = checks.positive("dt", dt)
        self.bias: Vector = np.zeros(0)
        self._q: Vector | None = None
        self._late: tuple[Vector, ...] = ()

    def update(self, reading: Vector) -> Vector:
        """Take in measured angles (n,) [rad]; return estimated ones, a new array.

        With a delay they are those at which the next command begins.
        """
        model = self.model
        noise = model.measurement**2
        if self._q is None:
            self._q = reading.copy()
            self.bias = np.zeros_like(reading)
            self._late = (np.zeros_like(reading),) * model.delay_periods
            # Covariance of (q, d): the first reading is all that is known of q.
            self._qq = noise
            self._qd = 0.0
            self._dd = model.bias**2 if model.bias_walk else 0.0
            return self._q.copy()
        innovation = reading - self._q
        total = self._qq + noise
        k_q = self._qq / total
        k_d = self._qd / total
        self._q = self._q + k_q * innovation
        self.bias = self.bias + k_d * innovation
        # The measured direction's part goes; noise / total is 1 - k_q without cancellation.
        self._dd -= k_d * self._qd
        self._qq = noise * k_q
        self._qd = self._qd * noise / total
        return self._q + self.dt * (sum(self._late) + model.delay_periods * self.bias)

    def predict(self, command: Vector) -> None:
        """Predict one control period with a command (n,) [rad/s] to the drives."""
        assert self._q is not None, "predict comes after update"
        command, *late = (*self._late, command)
        self._late = tuple(late)
        dt = self.dt
        model = self.model
        self._q = self._q + dt * (command + self.bias)
        self._qq += dt * (2.0 * self._qd + dt * self._dd) + (dt * model.velocity) ** 2
        self._qd += dt * self._dd
        self._dd += dt * model.bias_walk**2
