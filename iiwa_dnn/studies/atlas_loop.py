"""The loop of the atlas: an arm, a network and a disturbance, step by step."""

import numpy as np

from iiwa_dnn.errors import IiwaDnnError
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Vector
from iiwa_dnn.references import Reference
from iiwa_dnn.references.base import Ahead
from iiwa_dnn.robot import Configuration
from iiwa_dnn.robot.kinematics import Kinematics
from iiwa_dnn.schemes.program import StepProgram
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.atlas_disturbances import Disturbance


class DisturbedLoop:
    """The paper's arm along a path, closed by a network over a disturbed `StepProgram`.

    `iiwa_dnn.simulation.Loop` is not used: the disturbances act inside the controller's step, on
    the Jacobian and the target before a program is written, on its bounds before it is answered,
    and on the network's state before the answer is read. No other run wants hooks there.

    Attributes:
        program: The scheme laid out for the controller's model of the arm, n joints.
        solver: The network, which advances by one control period a step.
        disturbance: The disturbance, with the true arm.
        q: True joint positions [rad], (n,).
    """

    def __init__(
        self,
        program: StepProgram,
        solver: DNNSolver,
        disturbance: Disturbance,
        reference: Reference,
        steps: int,
        dt: float,
    ) -> None:
        """Put the arm at rest at the paper's start, for so many periods of dt [s] at most."""
        self.program = program
        self.solver = solver
        self.disturbance = disturbance
        self.q: Vector = np.array(paper.START)
        self._arm = Kinematics(disturbance.robot)
        self._past = np.zeros((3, self.q.size))
        self._qp = QP.from_data(np.zeros(program.data_size), program.sizes)
        start = Configuration(disturbance.robot, self.q)
        self._dt = dt
        self._reference = reference.anchored(start)
        path = Ahead(self._reference, dt) if program.scheme.ahead else self._reference
        self._targets = path.sample(dt * np.arange(steps)).data

    def step(self, k: int) -> tuple[float, float]:
        """Take step k.

        Returns:
            Distance of the tool from its target before the step [m], and the largest KKT residual
            of the answer.

        Raises:
            IiwaDnnError: The tool is 1 m away from its target, or the network has diverged.
        """
        self._arm.update(self.q)
        tool: Vector = self._arm.placements[self._arm.frame_ids[0]].copy()
        target = self._targets[k].copy()
        error = float(np.linalg.norm(target[:3] - tool[9:]))
        if not error < 1.0:
            raise IiwaDnnError(f"the tool is {error:.2g} m away")
        self._write(k, target, tool)
        x, residual = self._answer(k)
        self._move(k, x)
        return error, residual

    def _write(self, k: int, target: Vector, tool: Vector) -> None:
        """Write the program of step k for a target (18,) and the tool's placement (12,)."""
        program = self.program
        seen = self.disturbance.measure(self.q)
        program.kinematics.update(seen)
        self._past[0] = seen
        self.disturbance.mislead(program, target, tool, self.q)
        t = k * self._dt
        program.write(self._qp.data, target.reshape(1, -1), self._past, self._dt, t)
        self.disturbance.constrain(k, self._qp)

    def _answer(self, k: int) -> tuple[Vector, float]:
        """Advance the network; return x and its largest KKT residual."""
        qp = self._qp
        answer = self.solver.advance(qp, self._dt)
        state = self.solver.warm_state(qp.sizes)
        if state is None:
            raise IiwaDnnError("the state is not finite")
        noise = self.disturbance.noise
        if noise is None:
            return answer.x, answer.residuals.largest
        network = self.solver.network
        width = self.q.size if network.carries_x else state.size
        state[:width] += noise[k, :width]
        point = np.empty_like(answer.point)
        residual = max(network.read(qp, state, point))
        return point, residual

    def _move(self, k: int, x: Vector) -> None:
        """Move the arm by the network's x, whose first n are velocities."""
        velocity: Vector = x[: self.q.size].copy()
        self.disturbance.hold(k, velocity)
        self._past[1] = velocity
        self.q = self.q + self._dt * velocity
