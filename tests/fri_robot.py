"""A robot controller's side of KUKA's FRI, with a simulated arm behind it.

`FriController` is the session alone: messages out, datagrams in, one period after the other. It has
no clock; `serve` lets it talk to a client over UDP in real time.

KUKA publishes the session states and the messages, but not the numbers: the window and the
thresholds of the connection quality and the length of the waiting states are this module's. A robot
brakes where this one holds its last commanded position. It is for programs, not for safety: what is
accepted here may be refused there.
"""

import socket
import time
from collections import Counter, deque
from collections.abc import Callable
from select import select
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from fri_messages import (
    COMMAND_ID,
    LARGEST_MESSAGE,
    MONITORING_ID,
    PORT,
    WRAP,
    Quality,
    SessionState,
    message_types,
    parse,
)
from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.files import one_line
from iiwa_dnn.qp.program import Vector
from iiwa_dnn.robot import Robot
from iiwa_dnn.simulation.plants import Plant

JOINTS = 7

WINDOW = 100
"""Number of the last messages that the connection quality is computed from."""

THRESHOLDS = {Quality.EXCELLENT: 0.98, Quality.GOOD: 0.9, Quality.FAIR: 0.5, Quality.POOR: 0.0}
"""Smallest ratio of messages answered in time for a connection quality."""

READY_PERIODS = 20
"""Periods in MONITORING_READY before the robot asks for commands."""

MIRRORED_PERIODS = 20
"""Answers in COMMANDING_WAIT that repeat the robot's position before commands are followed."""

CLOSING_MESSAGES = 3
"""Messages that tell the client of the end of the session; some may be lost."""

_PATIENCE = 0.1  # longest period without real time [s]
_LATE = 0.5  # part of a period by which a message may be sent late [1]
_ROUNDING = 1e-6  # of a repeated position [rad], and of a velocity limit, relative to it

# Entries of the SDK's enumerations: overlay of joint positions, commands of positions, drives on.
_OVERLAY_JOINT = 1
_COMMAND_POSITION = 1
_DRIVE_ACTIVE = 2


class Connection:
    """Datagrams between the robot and a client: sequence counters and connection quality.

    Attributes:
        quality: Connection quality, of the last `WINDOW` messages.
        packets: Numbers of commands in time, late, repeated and garbled, and of messages without
            one ("missing").
        answered: Whether a new command came in this period.
    """

    def __init__(self) -> None:
        self.quality = Quality.POOR
        self.packets: Counter[str] = Counter()
        self._sequence = 0
        self._newest: Any = None
        self.answered = False
        self._in_time: deque[bool] = deque([False] * WINDOW, maxlen=WINDOW)

    def header(self) -> dict[str, int]:
        """Return the header of this period's message."""
        newest = self._newest
        return {
            "messageIdentifier": MONITORING_ID,
            "sequenceCounter": self._sequence,
            "reflectedSequenceCounter": 0 if newest is None else newest.header.sequenceCounter,
        }

    def receive(self, datagram: bytes, ordered: bool) -> None:
        """Take a datagram, if it holds a command that is new.

        Args:
            datagram: Content of a UDP packet.
            ordered: Whether commands older than the last one are dropped; otherwise a client may
                have begun anew.
        """
        command = parse(message_types().command, COMMAND_ID, datagram)
        if command is None:
            self.packets["garbled"] += 1
            return
        if self._newest is not None:
            before = self._newest.header.sequenceCounter
            ahead = (command.header.sequenceCounter - before) % WRAP
            if ahead == 0 or (ordered and ahead > WRAP // 2):
                self.packets["repeated"] += 1
                return
        self._newest = command
        self.answered = True

    def end_period(self) -> Any:
        """Judge the answer to this period's message; return the new command, None without one."""
        kind = "missing"
        if self.answered:
            in_time = self._newest.header.reflectedSequenceCounter == self._sequence
            kind = "in time" if in_time else "late"
        self.packets[kind] += 1
        self._in_time.append(kind == "in time")
        ratio = sum(self._in_time) / WINDOW
        self.quality = next(each for each, least in THRESHOLDS.items() if ratio >= least)
        self._sequence = (self._sequence + 1) % WRAP
        command = self._newest if self.answered else None
        self.answered = False
        return command


class FriController:
    """One session of a robot with one client, in joint position control.

    In each period: send `message`, hand every datagram to `receive`, then `advance`.

    A command is followed if it is newer than the last one, inside the position limits, and reached
    from the last commanded position within the velocity limits in one period. Without a command the
    arm keeps its position. Bytes that hold no command are dropped. The session ends at a command
    that is refused, or with a connection below GOOD while commands are followed.

    Attributes:
        state: State of the session.
        fault: Reason for the end of the session; None: it goes on, or ended with the arm at rest.
        connection: Datagrams of the session.
        commanded: Commanded joint positions [rad], (7,).
        period: Time between two messages [s].
    """

    def __init__(self, robot: Robot, plant: Plant, q0: ArrayLike, period: float) -> None:
        """Put the arm at rest and open the session.

        Args:
            robot: Robot with the limits that commands have to keep, 7 joints.
            plant: Arm that moves.
            q0: Joint positions at the start [rad], (7,).
            period: Time between two messages [s], whole milliseconds.

        Raises:
            InvalidInputError: An argument does not fit FRI, or the start is outside the limits.
            MissingDependencyError: The package protobuf is not installed.
        """
        if robot.dof != JOINTS:
            raise InvalidInputError("robot", f"must have {JOINTS} joints, not {robot.dof}", robot)
        self.period = round(checks.positive("period", period), 3)
        if abs(self.period - period) > 1e-9 or not 1e-3 <= self.period <= 0.1:
            problem = f"must be whole milliseconds from 1 to 100, not {1e3 * period:g}"
            raise InvalidInputError("period", problem, period)
        self.commanded: Vector = checks.finite_array("q0", q0, (JOINTS,))
        outside = robot.outside(self.commanded)
        if outside:
            raise InvalidInputError("q0", outside, q0)
        message_types()
        self.state = SessionState.MONITORING_WAIT
        self.fault: str | None = None
        self.connection = Connection()
        self._robot = robot
        self._plant = plant
        self._held = self.commanded
        self._in_state = 0
        self._moves = False
        self._torque: Vector | None = None
        plant.start(robot, self.commanded, self.period, 0)

    def message(self) -> bytes:
        """Encode the monitoring message of this period."""
        seconds, nanoseconds = divmod(time.time_ns(), 10**9)
        zeros = {"value": [0.0] * JOINTS}
        torque = self._torque
        held = {
            "jointPosition": {"value": self._held.tolist()},
            "clientCommandMode": _COMMAND_POSITION,
            "overlayType": _OVERLAY_JOINT,
        }
        message = message_types().monitoring(
            header=self.connection.header(),
            robotInfo={"numberOfJoints": JOINTS, "driveState": [_DRIVE_ACTIVE] * JOINTS},
            monitorData={
                "measuredJointPosition": {"value": self._plant.read().tolist()},
                "measuredTorque": zeros if torque is None else {"value": torque.tolist()},
                "commandedJointPosition": {"value": self.commanded.tolist()},
                "commandedTorque": zeros,
                "externalTorque": zeros,
                "timestamp": {"sec": seconds, "nanosec": nanoseconds},
            },
            connectionInfo={
                "sessionState": self.state,
                "quality": self.connection.quality,
                "sendPeriod": round(1e3 * self.period),
                "receiveMultiplier": 1,
            },
            ipoData=held if self.state >= SessionState.COMMANDING_WAIT else None,
        )
        return bytes(message.SerializeToString())

    def receive(self, datagram: bytes) -> None:
        """Take a datagram of the client."""
        self.connection.receive(datagram, ordered=self.state >= SessionState.COMMANDING_WAIT)

    def advance(self) -> None:
        """End the period: change the state, and move the arm for the next period."""
        command = self.connection.end_period()
        good = self.connection.quality >= Quality.GOOD
        self._in_state += 1
        q = self.commanded
        if self.state is SessionState.IDLE:
            pass
        elif not good and self.state < SessionState.COMMANDING_ACTIVE:
            self._enter(SessionState.MONITORING_WAIT)
        elif self.state is SessionState.MONITORING_WAIT:
            self._enter(SessionState.MONITORING_READY)
        elif self.state is SessionState.MONITORING_READY:
            if self._in_state >= READY_PERIODS:
                self._enter(SessionState.COMMANDING_WAIT)
        elif not good:
            quality = self.connection.quality.name
            self.end(f"the connection became {quality} in motion" if self._moves else None)
        elif command is not None:
            q = self._judge(np.array(command.commandData.jointPosition.value))
            self._moves = bool((q != self.commanded).any())
        moved = self._plant.move((q - self.commanded) / self.period)
        self._torque = moved.torque
        self.commanded = q
        if moved.fault is not None:
            self.end(moved.fault)

    def end(self, fault: str | None = None) -> None:
        """End the session; the arm keeps its commanded position."""
        self.fault = fault
        self._enter(SessionState.IDLE)

    def _enter(self, state: SessionState) -> None:
        self.state = state
        self._in_state = 0

    def _judge(self, q: Vector) -> Vector:
        """Return the joint positions (7,) [rad] to move to by a command `q`, of any size."""
        refusal = self._refusal(q)
        if refusal:
            self.end(f"command refused: {refusal}")
        elif self.state is SessionState.COMMANDING_ACTIVE:
            return q
        elif np.abs(q - self.commanded).max() > _ROUNDING:
            self._in_state = 0
        elif self._in_state >= MIRRORED_PERIODS:
            self._enter(SessionState.COMMANDING_ACTIVE)
        return self.commanded

    def _refusal(self, q: Vector) -> str | None:
        """Return the reason for refusing a command `q`, of any size; None if it is followed."""
        if q.shape != (JOINTS,) or not np.isfinite(q).all():
            return f"it does not hold {JOINTS} finite joint positions"
        outside = self._robot.outside(q)
        if outside:
            return outside
        ratio = np.abs(q - self.commanded) / (self.period * self._robot.dq_max)
        joint = int(ratio.argmax())
        if ratio[joint] > 1.0 + _ROUNDING:
            return f"joint {joint + 1} jumps, {ratio[joint]:.3g} times its velocity limit"
        return None


def serve(
    controller: FriController,
    host: str = "127.0.0.1",
    port: int = PORT,
    own_port: int = 0,
    realtime: bool = True,
    observe: Callable[[FriController], object] = lambda controller: None,
) -> None:
    """Let a controller talk to a client over UDP until the session ends.

    Args:
        controller: Controller with an open session.
        host: Address of the client.
        port: Port of the client.
        own_port: Port of the robot; 0: a free one.
        realtime: Whether periods have their length. Otherwise each ends with the client's answer,
            or 0.1 s without one: nothing is late on a machine with other work.
        observe: Function that is called after each period.

    Raises:
        InvalidInputError: There is no such host, or the port is taken.
    """
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        try:
            client = (socket.gethostbyname(host), port)
            link.bind(("", own_port))
        except OSError as error:
            raise InvalidInputError("host", f"{host}: {one_line(error)}", host) from error
        try:
            deadline = time.perf_counter()
            while controller.state is not SessionState.IDLE:
                link.sendto(controller.message(), client)
                now = time.perf_counter()
                # A client is not to blame for a message that was sent late.
                deadline = max(deadline, now - _LATE * controller.period) + controller.period
                if not realtime:
                    deadline = now + _PATIENCE
                waits = True
                while waits and select([link], [], [], max(0.0, deadline - time.perf_counter()))[0]:
                    datagram, sender = link.recvfrom(LARGEST_MESSAGE)
                    if sender == client:
                        controller.receive(datagram)
                    waits = realtime or not controller.connection.answered
                controller.advance()
                observe(controller)
        finally:
            controller.end(controller.fault)
            for _ in range(CLOSING_MESSAGES):
                link.sendto(controller.message(), client)
