r"""A Franka arm through libfranka: joint velocities at 1 kHz over its Franka Control Interface.

Each state of the robot opens a cycle of 1 ms. A command that comes too late for its cycle is lost,
and the robot goes on at constant acceleration. What it has commanded itself then comes back in
`q_d`, `dq_d` and `ddq_d` of the next state.

In k lost cycles of the period dt a velocity grows by up to k dt A at the acceleration A, and a
limit that shrinks at the deceleration D (`Robot.ramps`) by k dt D: `FrankaPlant.with_room` leaves
room for both.

Source: https://frankarobotics.github.io/docs/libfranka/docs/system_requirements.html, section
"Packet handling".
"""

from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError, import_extra
from iiwa_dnn.files import one_line
from iiwa_dnn.qp.program import Matrix, Vector
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.simulation.plants.base import FEEDBACKS, Feedback, RealPlant

PERIOD = 1e-3
"""Period of a control cycle [s]."""

JOINTS = 7

_ACCELERATION = 0.8
_JERK = 0.25
"""Ratios to the robot's limits. A late command may be dropped or, by franka-sim, be taken after all
when the robot has gone on without it: in one of the two histories the next one reads as 3 J."""

_TOLERANCE = 1e-3
"""libfranka's kJointVelocityLimitsTolerance without lost cycles [rad/s]."""

_OFF_AXIS = 2e-3
"""Distance between the flange and the model's last axis that calibration may leave [m]."""

_ROUNDING = 1e-6
"""Difference of two velocities that are equal in single precision [rad/s]."""


@dataclass
class _Motion:
    """Progress of a motion of an arm, beside its last state.

    Attributes:
        commanded: Sum of the commands, from the measured start [rad], (7,).
        offset: Difference of it to the robot's own sum [rad], (7,).
        command: Last command [rad/s], (7,).
        substitutes: `FrankaPlant.substitutes`, (2, 7).
        waits: Whether the state that answers the last command is still to come.
        time: Time since the motion began, by the robot's clock [s].
        late: Times at which commands were found to have come too late [s].
    """

    commanded: Vector
    offset: Vector = field(default_factory=lambda: np.zeros(JOINTS))
    command: Vector = field(default_factory=lambda: np.zeros(JOINTS))
    substitutes: Matrix | None = None
    waits: bool = False
    time: float = 0.0
    late: list[float] = field(default_factory=list)


class FrankaPlant(RealPlant):
    """A Franka arm that follows joint velocity commands.

    Args:
        host: Address of the robot's controller.
        feedback: Joint angles that `read` returns: ``"commanded"``, the sum of the commands, has
            neither noise nor delay; ``"measured"`` are the encoders'.
        lost_cycles: Cycles that may be lost in a row without a limit being broken.

    Raises:
        InvalidInputError: The host is empty, there is no such feedback, or the number is negative.
    """

    packages: ClassVar[tuple[str, ...]] = ("pylibfranka",)

    def __init__(self, host: str, feedback: Feedback = "commanded", lost_cycles: int = 5) -> None:
        if not host:
            raise InvalidInputError("host", "is needed: the address of the robot's controller")
        self.host = host
        checks.one_of("feedback", feedback, FEEDBACKS)
        self.feedback = feedback
        self.lost_cycles = checks.integer("lost_cycles", lost_cycles, 0)
        self._fault: str | None = None
        self._franka: Any = None
        self._robot: Any = None
        self._control: Any = None
        self._release()

    def _release(self) -> None:
        """Close the connection."""
        self._control = None
        self._robot = None

    def _connect(self) -> None:
        """Connect to the robot and read its state, unless this was done before.

        Raises:
            MissingDependencyError: pylibfranka is not installed.
            InvalidInputError: No robot answers, or it cannot move.
        """
        if self._robot is not None:
            return
        self._franka = import_extra("pylibfranka", "pip install 'iiwa-dnn[franka]'")
        try:
            robot = self._franka.Robot(self.host, self._franka.RealtimeConfig.kIgnore)
            self._state = robot.read_once()
        except (RuntimeError, self._franka.FrankaException) as error:
            problem = f"{self.host}: {_in_words(error)}"
            raise InvalidInputError("host", problem, self.host) from error
        self._robot = robot
        self._fault = None
        self._motion = _Motion(np.array(self._state.q))

    @property
    def period(self) -> float:
        """Control period of the robot [s]."""
        return PERIOD

    @property
    def posture(self) -> Vector:
        """Measured joint angles before the run [rad], (7,); connects if need be."""
        self._connect()
        return np.array(self._state.q)

    def with_room(self, robot: Robot) -> Robot:
        """Return a robot with limits that leave room for lost cycles and for rounding."""
        acceleration = _ACCELERATION * robot.ddq_max
        lost = self.lost_cycles * PERIOD
        offset, deceleration = robot.ramps
        shrinking = np.where(deceleration < np.inf, deceleration, 0.0)
        return replace(
            robot,
            dq_max=robot.dq_max - _TOLERANCE - lost * acceleration,
            ddq_max=acceleration,
            dddq_max=_JERK * robot.dddq_max,
            ramps=np.array([offset + _TOLERANCE + lost * (acceleration + shrinking), deceleration]),
        )

    def start(self, robot: Robot, q0: Vector, dt: float, seed: int) -> None:
        """Connect to the robot, which has to stand at joint angles `q0` (7,) [rad] already.

        Raises:
            MissingDependencyError: pylibfranka is not installed.
            InvalidInputError: No robot answers, it stands elsewhere, or the robot of the run has
                other joints or another control period.
        """
        self.check_start(robot, q0, dt, JOINTS)
        self._motion.commanded = np.array(q0)
        self._check_model(robot)

    def _check_model(self, robot: Robot) -> None:
        """Raise InvalidInputError if the axis of the last joint misses the arm's own flange."""
        flange = np.reshape(self._state.O_T_EE, (4, 4), "F") @ np.linalg.inv(
            np.reshape(self._state.F_T_EE, (4, 4), "F")
        )
        joint = Configuration(robot, self._state.q).frame(robot.joint_names[-1])
        off_axis = float(np.linalg.norm((joint.rotation.T @ (flange[:3, 3] - joint.position))[:2]))
        if off_axis > _OFF_AXIS:
            problem = f"is not that of the arm: its last joint is {off_axis:.3g} m from the flange"
            raise InvalidInputError("robot", problem, robot)

    def _wait(self) -> None:
        """Wait for the robot's next state, if a command was sent since the last one."""
        if not self._motion.waits:
            return
        self._motion.waits = False
        before = self._state
        try:
            self._state, duration = self._control.readOnce()
        except (RuntimeError, self._franka.FrankaException) as error:
            self._fault = _in_words(error)
            return
        self._motion.time += duration.to_sec()
        self._motion.commanded += PERIOD * self._motion.command
        last = np.array(self._state.dq_d)
        self._motion.substitutes = None
        if _differ(last, self._motion.command) and not self._is_old(before, duration):
            self._motion.late.append(self._motion.time)
            previous = last - PERIOD * np.array(self._state.ddq_d)
            self._motion.substitutes = np.array([last, previous])
            self._motion.commanded = self._state.q_d + self._motion.offset

    def _is_old(self, before: Any, duration: Any) -> bool:
        """Test whether the state shows the commands of the state before: one is on its way yet.

        A robot that has lost a command does not stay at a velocity, but at an acceleration.
        """
        one = duration.to_sec() < 1.5 * PERIOD
        stayed = not _differ(self._state.dq_d, before.dq_d)
        return one and stayed and _differ(PERIOD * np.array(before.ddq_d), 0.0)

    @property
    def q(self) -> Vector:
        """Measured joint angles [rad], (7,), a copy."""
        self._wait()
        return np.array(self._state.q)

    @property
    def time(self) -> float:
        """Time since the motion began, by the robot's clock [s]."""
        self._wait()
        return self._motion.time

    @property
    def substitutes(self) -> Matrix | None:
        """Last command and the one before, (2, 7) [rad/s], if the robot lost ours; else None."""
        self._wait()
        return self._motion.substitutes

    @property
    def fault(self) -> str | None:
        """Error of the robot or of the connection to it; None while there is none."""
        return self._fault

    def read(self) -> Vector:
        """Return the commanded or the measured joint angles [rad], (7,); the first call begins."""
        if self._control is None and self._fault is None:
            self._begin()
        self._wait()
        return self._motion.commanded.copy() if self.feedback == "commanded" else self.q

    def _begin(self) -> None:
        """Begin a motion of joint velocities, from rest."""
        mode = self._franka.ControllerMode.JointImpedance
        try:
            self._control = self._robot.start_joint_velocity_control(mode)
            self._state, _ = self._control.readOnce()
        except (RuntimeError, self._franka.FrankaException) as error:
            self._fault = _in_words(error)
        self._motion.offset = self._motion.commanded - self._state.q_d

    def move(self, command: Vector) -> None:
        """Send a velocity command (7,) [rad/s] for the cycle of the last state."""
        if self._fault is not None:
            return
        self._wait()
        self._motion.command = np.array(command)
        self._motion.waits = True
        self._send(self._franka.JointVelocities(self._motion.command.tolist()))

    def _send(self, command: Any) -> None:
        """Send libfranka's `JointVelocities`."""
        try:
            self._control.writeOnce(command)
        except (RuntimeError, self._franka.FrankaException) as error:
            self._fault = _in_words(error)

    def stop(self) -> None:
        """End the motion and close the connection; libfranka brakes an arm that still moves."""
        if self._control is not None and self._fault is None:
            self._wait()
            last = self._franka.JointVelocities([0.0] * JOINTS)
            last.motion_finished = True
            self._send(last)
        self._release()

    def settings(self) -> dict[str, Any]:
        """Return the plant's entries in the settings of a record."""
        entries = {"name": "franka", "host": self.host, "feedback": self.feedback}
        return {"plant": entries | {"late_s": list(self._motion.late)}}


def _differ(dq: ArrayLike, other: ArrayLike) -> bool:
    """Test whether velocities (7,) [rad/s] differ by more than rounding."""
    return bool(np.abs(np.subtract(dq, other)).max() > _ROUNDING)


def _in_words(error: Exception) -> str:
    """Return an error of libfranka in one line."""
    return one_line(error).removeprefix("libfranka: ")
