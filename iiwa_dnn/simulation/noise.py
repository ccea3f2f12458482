"""Noise, filter, estimator and clip: from the plant's encoders to the controller, and back."""

from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn import checks
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.qp import QP, Vector
from iiwa_dnn.qp.program import Matrix
from iiwa_dnn.simulation.clipping import clip_command
from iiwa_dnn.simulation.estimation import JointEstimator
from iiwa_dnn.simulation.filters import MovingAverage
from iiwa_dnn.simulation.settings import RunSettings


def gaussian_noise(sigma: float, steps: int, joints: int, seed: int) -> Matrix:
    """Draw white Gaussian noise, anew at every control step (section IV of the paper).

    Args:
        sigma: Standard deviation [rad/s] or [rad]; the paper's amplitude is 0.01.
        steps: Number of control steps.
        joints: Number of joints.
        seed: The same seed gives the same noise.

    Returns:
        Noise in the unit of `sigma`, of shape (steps, joints).
    """
    return sigma * np.random.default_rng(seed).standard_normal((steps, joints))


class SignalChain:
    """Noise, moving average, estimator and clip of a run.

    Attributes:
        settings: Entries of a run's settings, values that JSON can hold.
        alters: Whether the command that moves the robot may differ from the controller's.
        misleads: Whether the controller may see joint positions that differ from the true ones.
    """

    def __init__(self, run: RunSettings, shape: tuple[int, int]) -> None:
        """Draw the noise of a run, of the shape (steps, n).

        Raises:
            InvalidInputError: Noise that is given has another shape or is not finite.
        """
        steps, joints = shape
        model = run.estimator
        if isinstance(run.noise, np.ndarray):
            self._noise = checks.finite_array("noise", run.noise, shape)
            size: Any = float(np.sqrt(np.mean(run.noise**2)))
        else:
            size = run.noise
            self._noise = gaussian_noise(size, steps, joints, run.seed)
        window = run.filter_window
        self.settings: dict[str, Any] = {
            "noise": size,
            "noise_at": run.noise_at,
            "filter_window": window,
            "estimator": None if model is None else {"name": "kalman", **asdict(model)},
        }
        self._entry = run.noise_at if self._noise.any() else None
        self._estimator = None if model is None else JointEstimator(model, run.dt)
        # A window longer than the run never fills; so none is too long for the memory.
        self._average = MovingAverage(min(window, steps))
        self._known = MovingAverage(min(window, steps))
        self.alters = self._entry is not None or window > 1 or model is not None
        self.misleads = self._entry == "measurement" or model is not None

    def see(self, k: int, reading: Vector) -> Vector:
        """Return the joint positions (n,) [rad] that the controller sees at step k."""
        if self._entry == "measurement":
            reading = reading + self._noise[k]
        return reading if self._estimator is None else self._estimator.update(reading)

    def act(
        self, k: int, velocity: Vector, qp: QP, controller: Controller
    ) -> tuple[Vector, NDArray[np.int8]]:
        """Return the plant's command at step k, (n,), and 1 for each joint that was clipped, (n,).

        Args:
            k: The step.
            velocity: The controller's answer [rad/s], (n,).
            qp: The program at the joints' true positions, whose limits the command keeps.
            controller: The controller: noise may enter at its network.
        """
        estimator = self._estimator
        command = velocity if estimator is None else velocity - estimator.bias
        known = command
        if self._entry == "velocity":
            command = command + self._noise[k]
        elif self._entry == "network":
            controller.solver.disturb(self._noise[k])
        command, clipped = clip_command(
            qp, self._average(command), controller.control_layout.plan.yielding
        )
        if estimator is not None:
            # The joints get the average, clipped: the estimator is told of its known part.
            known = self._known(known)
            estimator.predict(np.clip(known, qp.lb[: known.size], qp.ub[: known.size]))
        return command, clipped
