r"""Kalman filter of joint angles, for noisy encoders and drives with a velocity bias.

The model of each joint has its angle q, an unknown and nearly constant disturbance d of its
velocity, the commanded velocity u, the measured angle z, and white noise n_1, n_2, n_3:

.. math::

    q^+ = q + dt\,(u + d + \sigma n_1), \qquad d^+ = d + \sqrt{dt}\,\beta\,n_2, \qquad
    z = q + \sigma_m n_3

All joints share one covariance, so a step computes two gains, not two per joint. Feeding back the
estimated q instead of z reduces the encoders' noise in the command. Subtracting the estimated d
from the command compensates a joint's bias in every posture, which an integral term of the tip's
error cannot do in motion. If the drives execute commands some periods late, u is the command that
they execute now, and the estimated angles are predicted to the time at which the next command
begins; all commands until then are known.

Source: R. E. Kalman, "A new approach to linear filtering and prediction problems", Journal of Basic
Engineering 82 (1960).
"""

from dataclasses import dataclass

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.qp.program import Vector


@dataclass(frozen=True)
class NoiseModel:
    """Noise model of a `JointEstimator`.

    Attributes:
        velocity: Standard deviation sigma of white noise on each velocity command [rad/s].
        measurement: Standard deviation sigma_m of white noise on each measured angle [rad]; > 0.
        bias_walk: Random walk beta of the disturbance [rad/s per sqrt(s)]; if 0, the disturbance is
            assumed and estimated to be 0.
        bias: Standard deviation of the disturbance at the start [rad/s].
        delay_periods: Number of control periods by which the drives execute a command late.
    """

    velocity: float = 0.01
    measurement: float = 1e-5
    bias_walk: float = 0.0
    bias: float = 0.1
    delay_periods: int = 0

    def __post_init__(self) -> None:
        """Validate the settings; raises InvalidInputError with the name of one out of range."""
        checks.positive("measurement", self.measurement)
        for name in ("velocity", "bias_walk", "bias"):
            checks.not_negative(name, getattr(self, name))
        checks.integer("delay_periods", self.delay_periods, 0)


class JointEstimator:
    """Kalman filter of the angles and velocity disturbances of n joints.

    Attributes:
        model: Noise model, with the delay of the drives.
        dt: Control period [s].
        bias: Estimated disturbance of the velocity [rad/s], (n,); (0,) before the first `update`.
    """

    def __init__(self, model: NoiseModel, dt: float) -> None:
        """Create a filter without a reading.

        Raises:
            InvalidInputError: `dt` is not a positive time.
        """
        self.model = model
        self.dt = checks.positive("dt", dt)
        self.bias: Vector = np.zeros(0)
        self._q: Vector | None = None
        self._late: tuple[Vector, ...] = ()

    def update(self, reading: Vector) -> Vector:
        """Correct the estimate by measured angles [rad], (n,).

        The first reading initialises the estimate.

        Returns:
            Estimated angles [rad], (n,), a new array; with a delay of the drives, predicted to the
            time at which the next command begins.
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
        """Predict the estimate by one control period, after a command [rad/s], (n,), was sent.

        With a delay, the angles move by the command that was sent `delay_periods` periods earlier.
        """
        assert self._q is not None, "predict comes after update"
        command, *late = (*self._late, command)
        self._late = tuple(late)
        dt = self.dt
        model = self.model
        self._q = self._q + dt * (command + self.bias)
        self._qq += dt * (2.0 * self._qd + dt * self._dd) + (dt * model.velocity) ** 2
        self._qd += dt * self._dd
        self._dd += dt * model.bias_walk**2
