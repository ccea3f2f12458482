"""The step program of a scheme that is any object with a `build_qp` of its own."""

from typing import Any

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import QP, Matrix, Vector
from iiwa_dnn.references import Target
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.robot.kinematics import Kinematics
from iiwa_dnn.schemes.program import StepProgram


class ForeignProgram(StepProgram):
    """A scheme that builds its programs in its own way, behind the methods of a `StepProgram`."""

    def __init__(self, robot: Robot, scheme: Any, q: Vector) -> None:
        """Ask the scheme for one program, at joint positions q (n,) [rad], to know its sizes.

        Raises:
            InvalidInputError: The program has another number of variables than the scheme states.
        """
        self.robot = robot
        self.scheme = scheme
        self.target_frames = (robot.tip,)
        self.blocks = ()
        self.kinematics = Kinematics(robot)
        conf = Configuration(robot, q)
        qp = scheme.build_qp(conf, Target(conf.position, conf.rotation))
        self.sizes = checks.instance("build_qp", qp, QP).sizes
        slack = getattr(scheme, "slack", 0)
        n = self.sizes[0]
        if n != robot.dof + slack:
            problem = f"built a program in {n} variables for {robot.dof} joints and {slack} slacks"
            raise InvalidInputError("scheme", problem, scheme)
        self._encode()

    is_compiled = False
    ahead = frozenset()
    rate_limits = None

    @property
    def row_weights(self) -> Vector:
        """Weight of each equality row where a policy lets the tasks yield, (p,): all alike."""
        return np.ones(self.sizes[2])

    @property
    def elastic(self) -> Vector:
        """1 for each inequality row of an elastic limit, (m,): none is."""
        return np.zeros(self.sizes[1])

    def write(
        self,
        data: Vector,
        targets: Matrix,
        past: Matrix,
        dt: float,
        t: float = 0.0,
    ) -> None:
        """Write the whole program of one step.

        Args:
            data: The program, `QP.data`, (size,), overwritten.
            targets: Target of the tip, (1, 18).
            past: Joint positions [rad], last command and the one before [rad/s], (3, n).
            dt: Control period [s].
            t: Time [s].

        Raises:
            InvalidInputError: The program has other sizes than the first one.
        """
        conf = Configuration(self.robot, past[0])
        qp = self.scheme.build_qp(conf, Target.from_data(targets[0]))
        if qp.sizes != self.sizes:
            problem = f"built a program of sizes {qp.sizes} after others of {self.sizes}"
            raise InvalidInputError("scheme", problem)
        data[:] = qp.data

    def settings(self) -> dict[str, object]:
        """Return what a run's settings say of the scheme's rows: its name, and their numbers."""
        name = type(self.scheme).__name__
        rows = [{"part": name, "row": j + 1} for j in range(self.sizes[1])]
        return {"rows": rows, "bounding": [name]}
