r"""A Franka arm through libfranka: joint velocities at 1 kHz over its Franka Control Interface.

Each state of the robot opens a cycle of 1 ms. A command that comes too late for its cycle is lost,
and the robot goes on at constant acceleration. What it has commanded itself then comes back in
`q_d`, `dq_d` and `ddq_d` of the next state.

In k lost cycles of the period dt a velocity grows by up to k dt A at the acceleration A, and a
limit that shrinks at the deceleration D (`Robot.ramps`) by k dt D. The robot judges velocities at
its measured posture, which lags behind the commanded one. `FrankaPlant.with_room` leaves room for
all of that.

Source: https://frankarobotics.github.io/docs/libfranka/docs/system_requirements.html, section
"Packet handling".
"""

import socket
import struct
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError, import_extra
from iiwa_dnn.files import one_line
from iiwa_dnn.qp.program import Vector
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.schemes.motion_limits import TANGENT
from iiwa_dnn.simulation.plants.base import JOINTS, Feedback, RealPlant

PERIOD = 1e-3
"""Period of a control cycle [s]."""

PORT = 1337
"""TCP port of a robot's controller."""

PATIENCE = 5.0
"""Time to wait for a connection, and for the first answer [s]."""

_CONNECT = struct.pack("<3I2H", 0, 0, 16, 0, 9)
"""Request to connect: command, its number, size in bytes, version, UDP port, here "discard"."""

_ACCELERATION = 0.75
_JERK = 0.24
"""Ratios to the robot's limits. A late command may be dropped or, by franka-sim, be taken after all
when the robot has gone on without it: the next one then reads as 3 J, and as 4 J after several, and
its acceleration as up to A + 2 J dt."""

_BRAKING = 0.75
"""Part of the acceleration that braking before a ramp asks for: the arm lags behind."""

_TOLERANCE = 1e-3
"""libfranka's kJointVelocityLimitsTolerance without lost cycles [rad/s]."""

_OFF_AXIS = 2e-3
"""Distance between the flange and the model's last axis that calibration may leave [m]."""

_ROUNDING = 1e-5
"""Difference of two velocities that are equal in single precision [rad/s]."""


class FrankaPlant(RealPlant):
    """A Franka arm that follows joint velocity commands.

    Args:
        host: Address of the robot's controller.
        feedback: Joint angles that `read` returns: ``"commanded"``, the sum of the commands, has
            neither noise nor delay; ``"measured"`` are the encoders'.
        lost_cycles: Cycles that may be lost in a row without a limit being broken.
        lag: Distance up to which the measured joints may be from the commanded ones without a
            limit being broken [rad]; the commanded ones are drawn along beyond it.

    Raises:
        InvalidInputError: The host is empty, there is no such feedback, or a number is negative.
    """

    name: ClassVar[str] = "franka"
    packages: ClassVar[tuple[str, ...]] = ("pylibfranka",)
    tip_speed: ClassVar[float | None] = 2.5  # the robot's own is 3, of the measured motion

    def __init__(
        self,
        host: str,
        feedback: Feedback = "commanded",
        lost_cycles: int = 5,
        lag: float = 0.02,
    ) -> None:
        super().__init__(host, feedback)
        if not host:
            raise InvalidInputError("host", "is needed: the address of the robot's controller")
        self.lost_cycles = checks.integer("lost_cycles", lost_cycles, 0)
        self.lag = checks.not_negative("lag", lag)
        self._robot: Any = None
        self._control: Any = None

    def _connect(self) -> None:
        """Connect to the robot and read its state, unless this was done before.

        Raises:
            MissingDependencyError: pylibfranka is not installed.
            InvalidInputError: No robot answers, or it cannot move.
        """
        if self._robot is not None:
            return
        self._franka: Any = import_extra("pylibfranka", "pip install 'iiwa-dnn[franka]'")
        try:
            _await_answer(self.host)
            robot = self._franka.Robot(self.host, self._franka.RealtimeConfig.kIgnore)
            self._state = robot.read_once()
        except (OSError, RuntimeError, self._franka.FrankaException) as error:
            problem = f"{self.host}: {_in_words(error)}"
            raise InvalidInputError("host", problem, self.host) from error
        self._robot = robot

    @property
    def period(self) -> float:
        """Control period of the robot [s]."""
        return PERIOD

    @property
    def posture(self) -> Vector:
        """Measured joint angles of the last state [rad], (7,); connects if need be."""
        self._connect()
        return np.array(self._state.q)

    def with_room(self, robot: Robot) -> Robot:
        """Return a robot with limits that leave room for lost cycles, lag and rounding."""
        acceleration = _ACCELERATION * robot.ddq_max
        lost = self.lost_cycles * PERIOD
        offset, deceleration = robot.ramps
        shrinking = np.where(deceleration < np.inf, deceleration, 0.0)
        offset = offset + _TOLERANCE + lost * (acceleration + shrinking)
        slower = _BRAKING * acceleration * (1.0 + offset / TANGENT)
        return replace(
            robot,
            q_lower=robot.q_lower + self.lag,
            q_upper=robot.q_upper - self.lag,
            dq_max=robot.dq_max - _TOLERANCE - lost * acceleration,
            ddq_max=acceleration,
            dddq_max=_JERK * robot.dddq_max,
            ramps=np.array([offset, np.where(shrinking, np.minimum(shrinking, slower), np.inf)]),
        )

    def start(self, robot: Robot, q0: Vector, dt: float, seed: int) -> None:
        """Connect to the robot, which has to stand at joint angles `q0` (7,) [rad] already.

        Raises:
            MissingDependencyError: pylibfranka is not installed.
            InvalidInputError: No robot answers, it stands elsewhere, or the robot of the run has
                other joints or another control period.
        """
        super().start(robot, q0, dt, seed)
        flange = np.reshape(self._state.O_T_EE, (4, 4), "F") @ np.linalg.inv(
            np.reshape(self._state.F_T_EE, (4, 4), "F")
        )
        joint = Configuration(robot, self._state.q).frame(robot.joint_names[-1])
        off_axis = float(np.linalg.norm((joint.rotation.T @ (flange[:3, 3] - joint.position))[:2]))
        if off_axis > _OFF_AXIS:
            problem = f"is not that of the arm: its last joint is {off_axis:.3g} m from the flange"
            raise InvalidInputError("robot", problem, robot)

    @contextmanager
    def _faults(self) -> Iterator[None]:
        """Note an error of libfranka as the fault."""
        try:
            yield
        except (RuntimeError, self._franka.FrankaException) as error:
            self._motion.fault = self._motion.fault or _in_words(error)

    def _begin(self) -> None:
        """Begin a motion of joint velocities, from rest."""
        with self._faults():
            # libfranka waits for the consent to a motion without an end. Of a robot that has fallen
            # silent the first state may have been there already, and the second one fails.
            for _ in range(2):
                self._robot.read_once()
            mode = self._franka.ControllerMode.JointImpedance
            self._control = self._robot.start_joint_velocity_control(mode)
            self._state, _ = self._control.readOnce()
        self._offset = self._motion.commanded - self._state.q_d

    def _receive(self) -> None:
        """Wait for the robot's next state, and compare its own last command with ours."""
        motion = self._motion
        before = self._state
        with self._faults():
            self._state, duration = self._control.readOnce()
        if motion.fault is not None:
            return
        motion.time += duration.to_sec()
        last = np.array(self._state.dq_d)
        change = PERIOD * np.array(self._state.ddq_d)
        is_taken = not _differ(last, motion.command)
        if not is_taken and self._went_on(before, round(duration.to_sec() / PERIOD)):
            motion.late.append(motion.time)
            motion.substitutes = np.array([last, last - change])
        elif is_taken and motion.previous.any() and _differ(change, last - motion.previous):
            # An earlier command that counted as lost has been taken after all.
            motion.substitutes = np.array([motion.command, motion.command - change])
        if motion.substitutes is not None:
            motion.commanded = self._state.q_d + self._offset
        measured = np.array(self._state.q)
        motion.commanded = np.clip(motion.commanded, measured - self.lag, measured + self.lag)

    def _went_on(self, before: Any, cycles: int) -> bool:
        """Test whether the robot has gone on without a command since the state before.

        It then has the velocity of constant acceleration, from that state or from our command.
        Another one is that of an earlier command, and the last one is on its way yet.
        """
        motion = self._motion
        lost = before.dq_d + cycles * PERIOD * np.array(before.ddq_d)
        taken = motion.command + (cycles - 1) * (motion.command - motion.previous)
        return not (_differ(self._state.dq_d, lost) and _differ(self._state.dq_d, taken))

    def _send(self, is_last: bool = False) -> None:
        """Send the last command for the cycle of the last state."""
        command = self._franka.JointVelocities(self._motion.command.tolist())
        command.motion_finished = is_last
        with self._faults():
            self._control.writeOnce(command)

    def stop(self) -> None:
        """End the motion and close the connection; libfranka brakes an arm that still moves."""
        if self._control is not None and self.fault is None:
            self._motion.command = np.zeros(JOINTS)
            self._send(is_last=True)
        self._control = None
        self._robot = None


def _await_answer(host: str) -> None:
    """Ask a robot to connect, in a version of the protocol that no robot has.

    The refusal shows that somebody answers. libfranka waits for the first answer without an end,
    and no signal or other thread of Python gets a turn.

    Raises:
        OSError: There is no such address, or no answer.
    """
    with socket.create_connection((host, PORT), PATIENCE) as link:
        link.sendall(_CONNECT)
        if not link.recv(1):
            raise ConnectionError("the connection was closed without an answer")
        with suppress(OSError):  # it may take the next client when it has closed this connection
            link.shutdown(socket.SHUT_WR)
            while link.recv(64):
                pass


def _differ(dq: ArrayLike, other: ArrayLike) -> bool:
    """Test whether velocities (7,) [rad/s] differ by more than rounding."""
    return bool(np.abs(np.subtract(dq, other)).max() > _ROUNDING)


def _in_words(error: Exception) -> str:
    """Return an error of libfranka or of the connection in one line."""
    if isinstance(error, TimeoutError):
        return f"no answer within {PATIENCE:g} s; another program may be connected"
    return one_line(error).removeprefix("libfranka: ")
