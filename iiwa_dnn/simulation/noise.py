"""Noise, filter, estimator and clip: from the plant's encoders to the controller, and back."""

from dataclasses import asdict
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn import checks
from iiwa_dnn.control.clipping import clip_command
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.estimation import JointEstimator, NoiseModel
from iiwa_dnn.control.filters import MovingAverage
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import QP, Vector
from iiwa_dnn.qp.program import Matrix

NoiseEntry = Literal["velocity", "network", "measurement"]
NOISE_ENTRIES: tuple[NoiseEntry, ...] = ("velocity", "network", "measurement")
"""Signals that noise may be added to; it has the unit of that signal.

``velocity`` [rad/s]: the joint velocity that the controller commands, before the filter: the
paper's section IV. ``network`` [rad/s]: x of the network's state after each step's answer was
taken, so the network has one control step to work it off; a network that converges at every step
forgets it. ``measurement`` [rad]: the joint positions that the controller sees; the robot, and the
record, keep the true ones.
"""

LARGEST = 1e3
"""The largest noise that is accepted, [rad/s] or [rad]: far more overflows."""


def gaussian_noise(sigma: float, steps: int, joints: int, seed: int) -> Matrix:
    """Draw white Gaussian noise, anew at every control step (section IV of the paper).

    Args:
        sigma: Standard deviation [rad/s] or [rad]; the paper's amplitude is 0.01.
        steps: Number of control steps.
        joints: Number of joints.
        seed: The same seed gives the same noise.

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


class SignalChain:
    """Noise, moving average, estimator and clip of a run.

    Attributes:
        settings: Entries of a run's settings, values that JSON can hold.
        alters: Whether more than the controller's own answer moves the robot.
        misleads: Whether the controller may see another posture than the robot has.
    """

    def __init__(
        self,
        noise: float | ArrayLike,
        entry: NoiseEntry,
        window: int,
        model: NoiseModel | None,
        shape: tuple[int, int],
        dt: float,
        seed: int,
    ) -> None:
        """Draw the noise of a run.

        Args:
            noise: Standard deviation of white noise [rad/s] or [rad], or the noise, (steps, n).
            entry: Signal that it is added to (`NOISE_ENTRIES`).
            window: Samples of the moving average of the velocity; 1: no filter.
            model: Noise model of a Kalman filter of the joint positions, whose bias is taken off
                the command; None: the controller sees the measured positions.
            shape: Number of steps, and of joints n.
            dt: Control period [s].
            seed: Seed of the noise.

        Raises:
            InvalidInputError: An argument is out of range; the message names it.
        """
        steps, joints = shape
        checks.one_of("noise_at", entry, NOISE_ENTRIES)
        checks.integer("filter_window", window, 1)
        if model is not None:
            checks.instance("estimator", model, NoiseModel)
        if isinstance(noise, np.ndarray):
            self._noise = checks.finite_array("noise", noise, shape)
            size = float(np.sqrt(np.mean(noise**2)))
        else:
            size = noise  # type: ignore[assignment]
            self._noise = gaussian_noise(size, steps, joints, seed)
        self.settings: dict[str, Any] = {
            "noise": size,
            "noise_at": entry,
            "filter_window": window,
            "estimator": None if model is None else {"name": "kalman", **asdict(model)},
        }
        self._entry = entry if self._noise.any() else None
        self._estimator = None if model is None else JointEstimator(model, dt)
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
        """Return the command that the plant gets at step k, and the joints that were clipped.

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
