"""The signal chain of a run: from the plant's encoders to the controller, and from there back."""

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.control.clipping import clip_command
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.estimation import JointEstimator
from iiwa_dnn.control.filters import MovingAverage
from iiwa_dnn.qp import QP, Vector
from iiwa_dnn.simulation.noise import Disturbance, gaussian_noise


class SignalChain:
    """Noise, disturbance, average, estimator and clip of a run."""

    def __init__(
        self, disturbance: Disturbance, steps: int, joints: int, dt: float, seed: int
    ) -> None:
        """Draw the noise of a run of so many steps of dt [s]."""
        self._disturbance = disturbance
        self._noise = gaussian_noise(disturbance.noise, steps, joints, seed)
        times = dt * np.arange(steps, dtype=np.float64)
        added = disturbance.velocity
        self._added = None if added is None else added.at(times)
        model = disturbance.estimator
        self._estimator = None if model is None else JointEstimator(model, dt)
        # A window longer than the run never fills; so none is too long for the memory.
        window = min(disturbance.filter_window, steps)
        self._average = MovingAverage(window)
        self._known = MovingAverage(window)

    @property
    def misleads(self) -> bool:
        """Test whether the controller may see another posture than the robot has."""
        return self._estimator is not None or self._noise_at("measurement")

    @property
    def changes(self) -> bool:
        """Test whether a velocity is changed on its way to the robot."""
        noisy = self._noise_at("velocity") or self._noise_at("network")
        averaged = self._disturbance.filter_window > 1
        return noisy or averaged or self._estimator is not None or self._added is not None

    @property
    def alters(self) -> bool:
        """Test whether more than the controller's own answer moves the robot."""
        return self._disturbance.noise > 0.0 or self.changes

    def _noise_at(self, entry: str) -> bool:
        return self._disturbance.noise > 0.0 and self._disturbance.noise_at == entry

    def see(self, k: int, reading: Vector) -> Vector:
        """Return the joint positions (n,) [rad] that the controller sees at step k."""
        if self._noise_at("measurement"):
            reading = reading + self._noise[k]
        return reading if self._estimator is None else self._estimator.update(reading)

    def act(
        self, k: int, velocity: Vector, qp: QP, controller: Controller
    ) -> tuple[Vector, NDArray[np.int8]]:
        """Return the command that the plant gets at step k, and the joints that were clipped.

        Args:
            k: The step.
            velocity: The controller's answer [rad/s], (n,).
            qp: The program at the joints' true positions, whose limits the command keeps.
            controller: The controller: noise may enter at its network.
        """
        command = velocity if self._estimator is None else velocity - self._estimator.bias
        known = command
        if self._noise_at("velocity"):
            command = command + self._noise[k]
        elif self._noise_at("network"):
            controller.solver.disturb(self._noise[k])
        if self._added is not None:
            command = command + self._added[k]
        if self._disturbance.filter_window > 1:
            command = self._average(command)
        command, clipped = clip_command(qp, command, controller.control_step.yielding)
        if self._estimator is not None:
            # The joints get the average, clipped: the estimator is told of its known part.
            known = self._known(known)
            self._estimator.predict(np.clip(known, qp.lb[: known.size], qp.ub[: known.size]))
        return command, clipped
