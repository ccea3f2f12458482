"""The signal chain of a run: from the plant's encoders to the controller, and from there back."""

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn import checks
from iiwa_dnn.control.clipping import clip_command
from iiwa_dnn.control.estimation import JointEstimator, NoiseModel
from iiwa_dnn.control.filters import MovingAverage
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Vector
from iiwa_dnn.simulation.noise import NOISE_ENTRIES, NoiseEntry, VelocityDisturbance, gaussian_noise


class SignalChain:
    """Noise, disturbance, average, estimator and clip of a run of so many steps.

    Attributes:
        misleads: Whether the controller may see another posture than the robot has.
        changes: Whether a velocity is changed on its way to the robot.
        alters: Whether something but the controller's own answer, which keeps the limits, may move
            the robot.
    """

    def __init__(
        self,
        steps: int,
        joints: int,
        dt: float,
        noise: float,
        noise_at: NoiseEntry,
        disturbance: VelocityDisturbance | None,
        filter_window: int,
        estimator: NoiseModel | None,
        seed: int,
    ) -> None:
        """Check the arguments and draw the noise; see `iiwa_dnn.simulate`."""
        checks.one_of("noise_at", noise_at, NOISE_ENTRIES)
        checks.integer("filter_window", filter_window, 1)
        drawn = gaussian_noise(noise, steps, joints, seed)
        self._noise, self._noise_at = (drawn if noise > 0.0 else None), noise_at
        times = dt * np.arange(steps, dtype=np.float64)
        self._disturbance = self._estimator = None
        if disturbance is not None:
            checks.instance("disturbance", disturbance, VelocityDisturbance)
            self._disturbance = disturbance.at(times)
        if estimator is not None:
            self._estimator = JointEstimator(
                checks.instance("estimator", estimator, NoiseModel), dt
            )
        # A window longer than the run never fills; so none is too long for the memory.
        self._window = min(filter_window, steps)
        noisy, estimates = self._noise is not None, estimator is not None
        self.misleads = estimates or (noisy and noise_at == "measurement")
        self.changes = estimates or disturbance is not None or filter_window > 1
        self.changes |= noisy and noise_at != "measurement"
        self.alters = noisy or self.changes

    def restart(self) -> None:
        """Forget the past of a run."""
        if self._estimator is not None:
            self._estimator.reset()
        self._average, self._known = MovingAverage(self._window), MovingAverage(self._window)
        self._clipper = DNNSolver()

    def see(self, k: int, reading: Vector) -> Vector:
        """Return the joint positions (n,) [rad] that the controller sees at step k."""
        if self._noise is not None and self._noise_at == "measurement":
            reading = reading + self._noise[k]
        return reading if self._estimator is None else self._estimator.update(reading)

    def act(
        self, k: int, velocity: Vector, qp: QP, solver: DNNSolver
    ) -> tuple[Vector, NDArray[np.int8]]:
        """Return the command that the plant gets at step k, and the joints that were clipped.

        Args:
            k: The step.
            velocity: The controller's answer [rad/s], (n,).
            qp: The program at the joints' true positions, whose limits the command keeps.
            solver: The controller's network, for noise that enters there.
        """
        command = velocity if self._estimator is None else velocity - self._estimator.bias
        known = command
        if self._noise is not None:
            if self._noise_at == "velocity":
                command = command + self._noise[k]
            elif self._noise_at == "network":
                solver.disturb(self._noise[k])
        if self._disturbance is not None:
            command = command + self._disturbance[k]
        if self._window > 1:
            command = self._average(command)
        command, clipped = clip_command(qp, command, self._clipper)
        if self._estimator is not None:
            # The joints get the average, clipped: the estimator is told of its known part.
            known = self._known(known)
            self._estimator.predict(np.clip(known, qp.lb[: known.size], qp.ub[: known.size]))
        return command, clipped
