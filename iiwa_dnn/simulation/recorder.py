"""Recorder of a run: collect the outcomes of a loop into the arrays of a record."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.control.controller import Controller
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Matrix, Status, Vector
from iiwa_dnn.results.record import COLUMNS, OPTIONAL
from iiwa_dnn.robot import Configuration
from iiwa_dnn.robot.kinematics import Kinematics
from iiwa_dnn.schemes import TorqueLimits
from iiwa_dnn.simulation.loop import Outcome
from iiwa_dnn.step.log import log_of
from iiwa_dnn.step.policies import Action

SEARCHED = 100
"""Steps of the continuous mode of which one is tested for a solution."""

_LATER = {"solution_gap", "objective_gap", "feasibility_gap", "reference_residual", "t"}


class Recorder:
    """Arrays of a record, made from the outcomes of a loop.

    Attributes:
        arrays: Columns by name; an optional one once there is something to put in.
        outcomes: Outcomes that are not in the arrays yet.
        last_step: Step at which the run ended early; None: it has not.
        layout: Columns of the commands' rows.
        infeasible: A step of the continuous mode that was shown to have no solution; None: none.
    """

    def __init__(self, steps: int, controller: Controller, q0: Vector) -> None:
        """Allocate the columns that every run has.

        Args:
            steps: Steps of the whole run.
            controller: The controller.
            q0: Joint positions at the start [rad], (n,).
        """
        program = controller.program
        self._controller = controller
        self._steps = steps
        further = program.target_frames[1:]
        self._frame_ids = [program.robot.frame_id(name) for name in further]
        self._kinematics = Kinematics(program.robot, program.target_frames)
        self.outcomes: list[Outcome] = []
        self.last_step: int | None = None
        self.layout = controller.control_layout.log_layout
        self.infeasible: int | None = None
        self._done = 0
        self.arrays: dict[str, NDArray[Any]] = {}
        for name in COLUMNS.keys() - OPTIONAL - _LATER:
            self._array(name)
        self.arrays["q"][0] = q0

    def observe(self, k: int, outcome: Outcome) -> None:
        """Keep the outcome of step k until the next `flush`."""
        self.outcomes.append(outcome)
        if outcome.ends:
            self.last_step = k

    def flush(self) -> Matrix:
        """Write the outcomes since the last call into the arrays.

        Returns:
            Step logs of their commands, one a stage, (k, width).
        """
        outcomes = self.outcomes
        self.outcomes = []
        count = len(outcomes)
        data = np.array([command.data for each in outcomes for command in each.commands])
        steps = slice(self._done, self._done + count)
        arrays = self.arrays
        arrays["q"][steps.start + 1 : steps.stop + 1] = [each.q for each in outcomes]
        arrays["dq"][steps] = [each.dq for each in outcomes]
        arrays["dq_solver"][steps] = [each.velocity for each in outcomes]
        stages = len(data) // count
        stats = log_of(data, self.layout.sizes).stats
        iterations = np.reshape(stats.iterations, (count, stages))
        arrays["iterations"][steps] = iterations.sum(axis=1)
        residuals = np.max([stats.primal, stats.dual, stats.gap], axis=0)
        arrays["kkt_residual"][steps] = residuals.reshape(count, stages).max(axis=1)
        first = data[::stages]  # pose, target and multipliers are the first stage's
        logs = log_of(first, self.layout.sizes)
        self._look_for_infeasible(first)
        placements = np.array([each.placement for each in outcomes])
        self._add_samples(self._done, placements, logs.targets.reshape(count, -1))
        of_bounds, of_rows = self.layout.multipliers(first)
        kinds = np.where(of_bounds > 0.0, logs.upper_kind, -np.asarray(logs.lower_kind))
        for name, values in (
            ("bound_multiplier", of_bounds),
            ("bound_kind", kinds * (of_bounds != 0.0)),
            ("row_multiplier", of_rows),
            ("row_pair", np.asarray(logs.row_pair) * (of_rows != 0.0)),
            ("kind", np.asarray(logs.kind)),
            ("excess", self.layout.excess(first)),
        ):
            if values.any():
                self._array(name, m=self.layout.sizes.m)[steps] = values
        for k, outcome in enumerate(outcomes, steps.start):
            self._add_incident(k, outcome)
        self._add_kinetic_index(steps, outcomes[-1].ends)
        self._done += count
        return data

    def _look_for_infeasible(self, data: Matrix) -> None:
        """Note the first step of a run in continuous mode whose program is infeasible.

        There a large residual may be a lag of the network, or an infeasible program. Of each
        `SEARCHED` step logs in `data` (k, width), the program with the largest residual is solved,
        and if it is infeasible, those before it.
        """
        if self._controller.mode != "continuous" or self.infeasible is not None:
            return
        violation = np.asarray(log_of(data, self.layout.sizes).stats.primal)
        for first in range(0, len(data), SEARCHED):
            worst = first + int(violation[first : first + SEARCHED].argmax())
            if self._is_infeasible(data[worst]):
                found = (k for k in range(first, worst) if self._is_infeasible(data[k]))
                self.infeasible = self._done + next(found, worst)
                return

    def _is_infeasible(self, data: Vector) -> bool:
        """Test whether the program of a step log (width,) is proven to be infeasible."""
        qp = QP.from_data(log_of(data, self.layout.sizes).program, self.layout.qp_sizes)
        return DNNSolver().solve(qp).status is Status.PRIMAL_INFEASIBLE

    def finish(self, steps: int) -> dict[str, NDArray[Any]]:
        """Write the last sample; return the columns of the first `steps` steps."""
        controller = self._controller
        self.arrays["t"] = controller.dt * np.arange(steps + 1, dtype=np.float64)
        placement = controller.placement(self.arrays["q"][steps])
        targets = controller.targets(self.arrays["t"][steps] - controller.path_lag)
        self._add_samples(steps, placement[np.newaxis], targets.reshape(1, -1))
        for k in controller.program.places_of(TorqueLimits):
            limit: Any = controller.program.parts[k]
            own = self.arrays["q"][:steps], self.arrays["dq"][:steps], controller.dt
            self._array("demand")[:steps] = limit.demands(controller.robot, *own)
        return {
            name: array[: steps + (COLUMNS[name].shape[0] == "N+1")]
            for name, array in self.arrays.items()
        }

    def _array(self, name: str, **sizes: int) -> NDArray[Any]:
        """Return a column; allocate it at its first use. Sizes are those of `Column.allocate`."""
        if name not in self.arrays:
            n = self._controller.robot.dof
            known = {"n": n, "f": len(self._frame_ids)} | sizes
            self.arrays[name] = COLUMNS[name].allocate(self._steps, **known)
        return self.arrays[name]

    def _add_incident(self, k: int, outcome: Outcome) -> None:
        """Record the action, clipping and limits of step k."""
        for name, values in (("torque", outcome.torque), ("sent", outcome.sent)):
            if values is not None:
                self._array(name)[k] = values
        if outcome.clipped is not None and outcome.clipped.any():
            self._array("clipped")[k] = outcome.clipped
        if outcome.action is not Action.NONE:
            self._array("action")[k] = outcome.action
        command = outcome.commands[0]
        if command.action is Action.NONE:
            return
        self._array("fraction")[k] = command.fraction
        self._array("limiting")[k] = command.log.limiting[: command.dq.size]
        sides = command.log.limiting[self.layout.sizes.n :]
        if sides.any():
            self._array("limiting_rows", m=sides.size)[k] = sides

    def _add_kinetic_index(self, steps: slice, ended: bool) -> None:
        """Write the kinetic index of some steps; if the run has `ended`, without the last one."""
        scheme = self._controller.scheme
        robot = self._controller.robot
        column = self.arrays["kinetic_index"]
        if scheme.kinetic == "identity":
            column[steps] = np.square(self.arrays["dq"][steps]).sum(axis=1)
            return
        for k in range(steps.start, steps.stop - ended):
            conf = Configuration(robot, self.arrays["q"][k])
            column[k] = scheme.kinetic_index(conf, self.arrays["dq"][k])

    def _add_samples(self, first: int, placements: Matrix, targets: Matrix) -> None:
        """Write samples from number `first` on: placements (k, 12) and targets (k, 18 frames)."""
        samples = slice(first, first + len(placements))
        arrays = self.arrays
        arrays["position"][samples] = placements[:, 9:]
        # A placement holds the rotation column by column, a target row by row.
        arrays["rotation"][samples] = placements[:, :9].reshape(-1, 3, 3).swapaxes(1, 2)
        arrays["position_desired"][samples] = targets[:, :3]
        arrays["rotation_desired"][samples] = targets[:, 3:12].reshape(-1, 3, 3)
        if not self._frame_ids:
            return
        desired = targets.reshape(len(targets), -1, 18)[:, 1:]
        turned = desired[..., 3:12].reshape(len(targets), -1, 3, 3)
        self._array("frame_position_desired")[samples] = desired[..., :3]
        self._array("frame_rotation_desired")[samples] = turned
        positions = self._array("frame_position")
        rotations = self._array("frame_rotation")
        for k in range(samples.start, samples.stop):
            self._kinematics.update(arrays["q"][k])
            further = self._kinematics.placements[self._frame_ids]
            positions[k] = further[:, 9:]
            rotations[k] = further[:, :9].reshape(-1, 3, 3).swapaxes(1, 2)
