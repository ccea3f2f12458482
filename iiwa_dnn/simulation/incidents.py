"""Optional arrays of a record: what policies, limits and clipping did, collected during a run."""

import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.control.answers import Answers
from iiwa_dnn.control.policies import Action, Resolution
from iiwa_dnn.results.failures import describe
from iiwa_dnn.results.metrics import bound_kinds
from iiwa_dnn.robot import Robot

PATIENCE = 100
"""Consecutive fallbacks to the reference solver after which a run warns."""


class Incidents:
    """Arrays of the steps that did not go as planned, each made when there is something to put in.

    Attributes:
        pending: Whether the last step was a policy's: the arm could not follow then.
    """

    def __init__(self, steps: int, robot: Robot, settings: Mapping[str, Any]) -> None:
        """Start without incidents.

        Args:
            steps: Steps of the whole run.
            robot: The robot, n joints, with its limits.
            settings: Settings of the run, with its inequality rows.
        """
        self.pending, self._series = False, 0
        self._steps, self._robot = steps, robot
        self._rows, self._kinds = settings["rows"], bound_kinds(settings)
        self._arrays: dict[str, NDArray[Any]] = {}

    def note(self, k: int, resolution: Resolution) -> None:
        """Note what a policy decided at step k."""
        self.act(k, resolution.action)
        fractions = self._array("fraction", (), np.float64, 1.0)
        fractions[k] = resolution.fraction
        n, qp = self._robot.dof, resolution.qp
        sides = resolution.sides[:n]
        bound = np.where(sides > 0, qp.ub[:n], qp.lb[:n])
        # Bounds that cross are others' than the robot's.
        at_velocity = (np.abs(bound) >= self._robot.dq_max) & (qp.lb <= qp.ub)[:n]
        self._array("blocking", (n,), np.int8)[k] = sides * (1 + at_velocity)
        if resolution.rows.any():
            self._array("blocking_rows", resolution.rows.shape, np.int8)[k] = resolution.rows

    def act(self, k: int, action: Action) -> None:
        """Note what was done at step k in place of the network's answer; warn of a long series."""
        self.pending = True
        actions = self._array("action", (), np.int8)
        actions[k] = action
        went_on = self._series if actions[k - 1] == Action.FALLBACK else 0
        self._series = went_on + 1 if action is Action.FALLBACK else 0
        if self._series == PATIENCE:
            warnings.warn(
                f"step {k}: the network did not settle in {PATIENCE} steps in a row, and the "
                "reference solver answered in its place",
                stacklevel=2,
            )

    def clip(self, k: int, clipped: NDArray[np.int8]) -> None:
        """Note which joints' commands were clipped at step k, (n,)."""
        if clipped.any():
            self._array("clipped", clipped.shape, np.int8)[k] = clipped

    def multipliers(self, rows: slice, answers: Answers, stages: int) -> None:
        """Note the multipliers of the limits over a stretch of steps, of each the first stage's."""
        for name, values in (
            ("bound_multiplier", answers.bound_multipliers[::stages]),
            ("row_multiplier", answers.row_multipliers[::stages]),
        ):
            if values.any():
                self._array(name, values.shape[1:], np.float64)[rows] = values

    def status(self, k: int, t: float) -> str:
        """Return the status of a run that a policy stopped at step k."""
        where = [
            describe({"joint": i + 1, "side": side, "limit": self._kinds[abs(code) - 1]})
            for i, code in enumerate(self._arrays["blocking"][k].tolist())
            if code and (side := "upper" if code > 0 else "lower")
        ]
        if "blocking_rows" in self._arrays:
            blocking = np.flatnonzero(self._arrays["blocking_rows"][k])
            where += [describe(self._rows[i]) for i in blocking]
        against = f", against {', '.join(where)}" if where else ""
        return f"stopped at step {k} (t = {t:g} s): no solution{against}"

    def arrays(self, steps: int) -> dict[str, Any]:
        """Return the record's optional arrays, cut to the steps that were taken."""
        return {name: array[:steps] for name, array in self._arrays.items()}

    def _array(
        self, name: str, shape: tuple[int, ...], kind: Any, fill: float = 0.0
    ) -> NDArray[Any]:
        if name not in self._arrays:
            self._arrays[name] = np.full((self._steps, *shape), fill, kind)
        return self._arrays[name]
