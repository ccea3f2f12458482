"""What goes otherwise than planned in a run, collected while it runs."""

from __future__ import annotations

from typing import Any

import numpy as np

from iiwa_dnn.control.policies import Resolution
from iiwa_dnn.kernels import clip_command
from iiwa_dnn.qp.program import Matrix, Vector
from iiwa_dnn.robot.robot import Robot


class Incidents:
    """The optional arrays of a record, each made when there is something to put into it.

    Attributes:
        delay: By how much the reference's clock is behind the run's [s].
        pending: Whether the last step was a policy's: the arm could not follow then.
    """

    def __init__(self, steps: int, robot: Robot, dt: float) -> None:
        """Nothing has happened yet.

        Args:
            steps: Of the whole run.
            robot: The robot, n joints, with its limits.
            dt: Control period [s].
        """
        self.delay, self.pending = 0.0, False
        self._steps, self._robot, self._dt = steps, robot, dt
        self._clipped = np.zeros(robot.dof, np.int8)
        self._arrays: dict[str, np.ndarray[Any, Any]] = {}

    def note(self, k: int, resolution: Resolution) -> None:
        """Note what a policy decided at step k."""
        self.pending = True
        self.delay += self._dt * (1.0 - resolution.fraction)
        self._array("action", (), np.int8)[k] = resolution.action
        fractions = self._array("fraction", (), np.float64, 1.0)
        fractions[k] = resolution.fraction
        qp, sides = resolution.qp, resolution.sides
        bound = np.where(sides > 0, qp.ub, qp.lb)
        at_velocity = np.abs(bound) >= self._robot.dq_max
        self._array("blocking", (sides.size,), np.int8)[k] = sides * (1 + at_velocity)

    def clipped(self, k: int, q: Vector, gain: float, dq: Vector) -> Vector:
        """The command of step k, clipped to the bounds at joint positions q (n,)."""
        dq = dq.copy()  # it may be the network's own answer
        if clip_command(q, self._robot.limits, gain, dq, self._clipped):
            self._array("clipped", (q.size,), np.int8)[k] = self._clipped
            self._clipped[:] = 0
        return dq

    def multipliers(self, rows: slice, multipliers: Matrix) -> None:
        """Note the multipliers of the bounds (count, n) of a stretch of steps."""
        if multipliers.any():
            self._array("bound_multiplier", multipliers.shape[1:], np.float64)[rows] = multipliers

    def status(self, k: int) -> str:
        """The status of a run that a policy stopped at step k."""
        where = [
            f"joint {i + 1} {'upper' if code > 0 else 'lower'} "
            f"{'velocity' if abs(code) == 2 else 'position'} limit"
            for i, code in enumerate(self._arrays["blocking"][k].tolist())
            if code
        ]
        against = f", against {', '.join(where)}" if where else ""
        return f"stopped at step {k} (t = {k * self._dt:g} s): no solution{against}"

    def arrays(self, steps: int) -> dict[str, Any]:
        """The record's optional arrays, cut to the steps that were taken."""
        return {name: array[:steps] for name, array in self._arrays.items()}

    def _array(
        self, name: str, shape: tuple[int, ...], kind: Any, fill: float = 0.0
    ) -> np.ndarray[Any, Any]:
        if name not in self._arrays:
            self._arrays[name] = np.full((self._steps, *shape), fill, kind)
        return self._arrays[name]
