"""One instant of a control loop, as the parts of a scheme see it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from pinocchio import rnea

from iiwa_dnn import checks
from iiwa_dnn.checks import read_only
from iiwa_dnn.errors import NotFoundError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.references import Target
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.robot.configuration import FrameState
from iiwa_dnn.robot.kinematics import Kinematics

TARGET_SIZE = 18
"""Length of `Target.data`."""


class StepViews(NamedTuple):
    """One instant of a control loop of n joints, as compiled parts read it.

    Attributes:
        t: Time [s].
        rate: Inverse of the control period [1/s]; inf outside of a loop.
        q: Joint positions [rad], (n,).
        last: Last command [rad/s], (n,).
        before: Command before the last one [rad/s], (n,).
        jacobian: Joint Jacobian, `Kinematics.jacobian`, (n, 6).
        placements: Frame placements by frame index, `Kinematics.placements`, (frames, 12).
        moves: 1 where a joint moves a frame, else 0, `Kinematics.moves`, (frames, n).
        inertia: Joint-space inertia matrix [kg m^2], (n, n), current if a cost needs it.
        targets: Targets of the tracked frames, `Target.data` each, (k, 18).
    """

    t: float
    rate: float
    q: Vector
    last: Vector
    before: Vector
    jacobian: Matrix
    placements: Matrix
    moves: Matrix
    inertia: Matrix
    targets: Matrix


class Step:
    """One instant of a control loop, as parts written in numpy see it.

    Attributes:
        robot: The robot, n joints.
        t: Time [s].
        dt: Control period [s]; inf outside of a loop.
        q: Joint positions [rad], (n,).
        dq: Last command [rad/s], (n,).
    """

    __slots__ = ("_kinematics", "_targets", "dq", "dt", "q", "robot", "t")

    def __init__(
        self,
        robot: Robot,
        q: ArrayLike,
        targets: Target | Mapping[str, Target] | None = None,
        dt: float = np.inf,
        t: float = 0.0,
        dq: ArrayLike | None = None,
    ) -> None:
        """Compute the kinematics of one instant, for example to test a part of one's own.

        Args:
            robot: The robot, n joints.
            q: Joint positions [rad], (n,).
            targets: Target of the tip, or targets by frame name; None: each frame's own pose.
            dt: Control period [s]; inf outside of a loop.
            t: Time [s].
            dq: Last command [rad/s], (n,); None: zero.

        Raises:
            InvalidInputError: `q` or `dq` has a wrong shape or is not finite.
        """
        shape = (robot.dof,)
        posture = checks.finite_array("q", q, shape)
        command = np.zeros(robot.dof) if dq is None else checks.finite_array("dq", dq, shape)
        kinematics = Kinematics(robot, robot.frame_names, dynamics=True)
        kinematics.update(posture)
        by_frame = targets if isinstance(targets, Mapping) else {robot.tip: targets}
        data = {name: target.data for name, target in by_frame.items() if target is not None}
        self._set(kinematics, data, t, dt, posture, command)

    @classmethod
    def from_kinematics(
        cls,
        kinematics: Kinematics,
        targets: Mapping[str, Vector],
        t: float,
        dt: float,
        q: Vector,
        dq: Vector,
    ) -> Step:
        """Make the instant that `kinematics` hold, without checks; targets by frame, (18,) each."""
        step = cls.__new__(cls)
        step._set(kinematics, targets, t, dt, q, dq)
        return step

    def _set(
        self,
        kinematics: Kinematics,
        targets: Mapping[str, Vector],
        t: float,
        dt: float,
        q: Vector,
        dq: Vector,
    ) -> None:
        self._kinematics = kinematics
        self._targets = targets
        self.robot = kinematics.robot
        self.t = t
        self.dt = dt
        self.q = q
        self.dq = dq

    def frame(self, name: str | None = None) -> FrameState:
        """Return pose and Jacobian of a frame of the robot; None stands for the tip.

        Raises:
            NotFoundError: The robot has no frame of that name.
        """
        return FrameState(*self._kinematics.frame(self.robot.tip if name is None else name))

    def target(self, name: str | None = None) -> Target:
        """Return the target of a frame that some task tracks; None stands for the tip.

        Raises:
            NotFoundError: No task tracks a frame of that name.
        """
        frame = self.robot.tip if name is None else name
        if frame not in self._targets:
            raise NotFoundError("target of frame", frame, self._targets)
        return Target.from_data(self._targets[frame])

    @property
    def inertia(self) -> Matrix:
        """Joint-space inertia matrix [kg m^2], (n, n)."""
        return read_only(np.array(Configuration(self.robot, self.q).inertia))

    @property
    def bias(self) -> Vector:
        """Joint torques of gravity, Coriolis and centrifugal forces [N m], (n,)."""
        data = self._kinematics.data
        model = self._kinematics.robot.model
        return np.array(rnea(model, data, self.q, self.dq, np.zeros(self.q.size)))

    def views(self, frame: str) -> StepViews:
        """Return the instant for a compiled part that tracks a frame, its target the first.

        Without a target, the frame is to stay where it is.
        """
        kinematics = self._kinematics
        target = self._targets.get(frame)
        if target is None:
            state = self.frame(frame)
            target = Target(state.position, state.rotation).data
        return StepViews(
            self.t,
            1.0 / self.dt if self.dt < np.inf else np.inf,
            self.q,
            self.dq,
            self.dq,
            kinematics.jacobian,
            kinematics.placements,
            kinematics.moves,
            kinematics.inertia,
            np.array(target).reshape(1, TARGET_SIZE),
        )
