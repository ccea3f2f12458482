r"""Torque control of commanded joint velocities, at the rate of the physics.

The control law is computed torque on the *nominal* model,

.. math::

    \tau = \mathrm{rnea}(\hat q, \hat v, a) + d\,\hat v, \qquad
    a = a_d + 2\omega\,(v_d - \hat v) + \omega^2 (q_d - \hat q)

which gives every joint a critically damped error of bandwidth :math:`\omega`, whatever its
inertia. The desired motion is integrated from the commands: within one control period the desired
velocity goes linearly from the last command to the new one. The velocity controller's feedback acts
through that integral, so that a constant disturbance leaves no constant error at the tip.

Only the encoders are read. Position and velocity come from an observer that predicts with *a*, the
acceleration that was asked for, and corrects with the innovation (critically damped, bandwidth
:math:`\omega_o`).

Sources: R. M. Murray, Z. Li, S. S. Sastry, "A Mathematical Introduction to Robotic Manipulation",
section 4.5 (computed torque); D. G. Luenberger, "Observing the state of a linear system", IEEE
Trans. Military Electronics 8 (1964).
"""

import math
from dataclasses import asdict, dataclass

import numpy as np
import pinocchio as pin

from iiwa_dnn import checks
from iiwa_dnn.qp.program import Vector
from iiwa_dnn.robot.mujoco_model import JointDynamics, torque_limits
from iiwa_dnn.robot.robot import Robot

_FASTEST = 1e6  # observed joint velocity from which on the loop counts as diverged [rad/s]


@dataclass(frozen=True)
class TorqueGains:
    """Gains of the torque loop.

    Attributes:
        bandwidth: Bandwidth of the position error [rad/s].
        observer_bandwidth: Bandwidth of the observer [rad/s].
        leash: Largest lead of the desired position over the measured one [rad], so that it does
            not wind up where the arm is rate-limited.
    """

    bandwidth: float = 60.0
    observer_bandwidth: float = 300.0
    leash: float = 0.1

    def __post_init__(self) -> None:
        """Check the numbers; raises InvalidInputError naming the one that is wrong."""
        for name, value in asdict(self).items():
            checks.positive(name, value)


class Observer:
    """Joint positions and velocities from encoder readings, by a model of double integrators.

    Attributes:
        q: Joint positions [rad], (n,).
        v: Joint velocities [rad/s], (n,).
    """

    def __init__(self, bandwidth: float, timestep: float, q: Vector) -> None:
        """Start at rest at q (n,) [rad]; bandwidth in [rad/s], time between readings in [s]."""
        # Both poles of the error at exp(-w h), exactly, for any step h.
        pole = math.exp(-bandwidth * timestep)
        self._timestep = timestep
        self._correct_q = 1.0 - pole**2
        self._correct_v = (1.0 - pole) ** 2 / timestep
        self.q = q.copy()
        self.v = np.zeros_like(q)

    def correct(self, reading: Vector) -> None:
        """Correct position and velocity by measured joint positions (n,) [rad]."""
        innovation = reading - self.q
        self.q = self.q + self._correct_q * innovation
        self.v = self.v + self._correct_v * innovation

    def predict(self, a: Vector) -> None:
        """Advance position and velocity to the next reading at an acceleration (n,) [rad/s^2]."""
        h = self._timestep
        self.q = self.q + h * (self.v + 0.5 * h * a)
        self.v = self.v + h * a


class TorqueController:
    """The torque loop of an arm with n joints, and its observer, from rest.

    Robot and dynamics are as the controller knows them. A velocity command is reached within a
    period [s]; `torque` is called every timestep [s].

    Attributes:
        gains: Stiffness.
        limit: Torque limits [N m], (n,).
        substeps: Timesteps in a period.
    """

    def __init__(
        self,
        robot: Robot,
        period: float,
        timestep: float,
        gains: TorqueGains,
        dynamics: JointDynamics,
        q: Vector,
    ) -> None:
        """Start at rest at joint angles `q` (n,) [rad]."""
        self.gains = gains
        self.limit = torque_limits(robot)
        self.substeps = round(period / timestep)
        self._period = period
        self._timestep = timestep
        self._damping = dynamics.damping
        self._model = robot.model.copy()  # the robot's own stays as it is
        self._model.armature = np.full(robot.dof, dynamics.armature)
        self._data = self._model.createData()
        self._observer = Observer(self.gains.observer_bandwidth, self._timestep, q)
        self._q_desired = q.copy()
        self._v_desired = np.zeros_like(q)
        self._a_desired = np.zeros_like(q)

    def command(self, dq: Vector) -> None:
        """Take a new velocity command [rad/s], (n,), to be reached within one control period."""
        self._a_desired = (dq - self._v_desired) / self._period

    def torque(self, reading: Vector) -> Vector:
        """Compute torques within the limits [N m], (n,), for the next physics step.

        Args:
            reading: Measured joint angles [rad], (n,).
        """
        self._observer.correct(reading)
        q = self._observer.q
        v = self._observer.v
        ahead = np.clip(self._q_desired - q, -self.gains.leash, self.gains.leash)
        w = self.gains.bandwidth
        a = self._a_desired + w * (2.0 * (self._v_desired - v) + w * ahead)
        torque = pin.rnea(self._model, self._data, q, v, a) + self._damping * v
        self._observer.predict(a)
        h = self._timestep
        self._q_desired = q + ahead + h * (self._v_desired + 0.5 * h * self._a_desired)
        self._v_desired = self._v_desired + h * self._a_desired
        limited: Vector = np.clip(torque, -self.limit, self.limit)
        return limited

    @property
    def diverged(self) -> bool:
        """True if the observer's velocity is far beyond any joint's, or not a number."""
        return not float(np.abs(self._observer.v).max()) < _FASTEST
