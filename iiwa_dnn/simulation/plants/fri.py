"""A KUKA LBR arm through its Fast Robot Interface, FRI: joint positions over UDP.

The robot sends its state at every period and the client answers with the joint positions to be
reached at the end of the next one. States and answers are numbered, and each state repeats the
number of the last answer that the robot has: so an answer that was lost is noticed. The robot then
keeps its last commanded position, and the motion goes on from there, from rest.

Source: KUKA's client SDK, https://github.com/lbr-stack/fri.
"""

import socket
import time
from select import select
from typing import Any, ClassVar

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.files import one_line
from iiwa_dnn.qp.program import Matrix, Vector
from iiwa_dnn.robot import Robot
from iiwa_dnn.simulation.plants.base import FEEDBACKS, Feedback, RealPlant
from iiwa_dnn.simulation.plants.fri_messages import (
    COMMAND_ID,
    JOINTS,
    LARGEST_MESSAGE,
    MONITORING_ID,
    PORT,
    Quality,
    SessionState,
    message_types,
    parse,
)

CONNECT_TIME = 30.0
"""Time to wait for the robot's first message, and for its consent to be commanded [s]."""

SILENCE = 1.0
"""Time without a message after which the robot is given up [s]."""

_WRAP = 2**32  # sequence counters begin again here


class FriClient:
    """A client's side of FRI: takes the robot's messages and answers them.

    Attributes:
        message: The newest message of the robot.
        is_confirmed: Whether the robot has received an answer since the message before.
    """

    def __init__(self, host: str, port: int) -> None:
        """Listen for the robot, and wait for its first message.

        Args:
            host: Address of the robot; "": whoever sends first.
            port: Port to listen at.

        Raises:
            InvalidInputError: The port is taken, or no robot sends.
            MissingDependencyError: The package protobuf is not installed.
        """
        message_types()
        self._link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._robot: Any = None
        self._counter = 0
        self.message: Any = None
        self.is_confirmed = True
        try:
            self._host = socket.gethostbyname(host) if host else ""
            self._link.bind(("", port))
        except OSError as error:
            self.close()
            problem = f"{host} UDP port {port}: {one_line(error)}".strip()
            raise InvalidInputError("host", problem, host) from error
        if not self.receive(CONNECT_TIME):
            self.close()
            problem = f"no robot sent a message to UDP port {port} within {CONNECT_TIME:g} s"
            raise InvalidInputError("host", f"{host}: {problem}".removeprefix(": "), host)

    def close(self) -> None:
        """Listen no longer."""
        self._link.close()

    @property
    def is_open(self) -> bool:
        """Test whether the client listens."""
        return self._link.fileno() >= 0

    def receive(self, patience: float) -> int:
        """Take the robot's newest message; wait for one if there is none.

        Args:
            patience: Longest time to wait [s].

        Returns:
            Number of the robot's periods since the message before; 0: no message came.
        """
        before = self.message
        deadline = time.monotonic() + patience
        while select([self._link], [], [], max(0.0, deadline - time.monotonic()))[0]:
            datagram, sender = self._link.recvfrom(LARGEST_MESSAGE)
            if self._take(datagram, sender):
                deadline = 0.0  # newer ones may be there already
        if self.message is before:
            return 0
        if before is None:
            return 1
        new = self.message.header
        self.is_confirmed = new.reflectedSequenceCounter != before.header.reflectedSequenceCounter
        return int((new.sequenceCounter - before.header.sequenceCounter) % _WRAP)

    def _take(self, datagram: bytes, sender: Any) -> bool:
        """Keep a datagram's message if it is the robot's and newer; return whether it is."""
        if sender != self._robot and (self._robot or self._host not in ("", sender[0])):
            return False
        message = parse(message_types().monitoring, MONITORING_ID, datagram)
        if message is None or len(message.monitorData.measuredJointPosition.value) != JOINTS:
            return False
        if self.message is not None:
            before = self.message.header.sequenceCounter
            if not 0 < (message.header.sequenceCounter - before) % _WRAP < _WRAP // 2:
                return False
        self._robot = sender
        self.message = message
        return True

    def answer(self, q: Vector) -> None:
        """Send joint positions (7,) [rad] for the newest message."""
        command = message_types().command(
            header={
                "messageIdentifier": COMMAND_ID,
                "sequenceCounter": self._counter,
                "reflectedSequenceCounter": self.message.header.sequenceCounter,
            },
            commandData={"jointPosition": {"value": q.tolist()}},
        )
        self._counter = (self._counter + 1) % _WRAP
        self._link.sendto(command.SerializeToString(), self._robot)

    @property
    def state(self) -> SessionState:
        """State of the session."""
        return SessionState(self.message.connectionInfo.sessionState)

    @property
    def period(self) -> float:
        """Time between two messages [s]."""
        return 1e-3 * float(self.message.connectionInfo.sendPeriod)

    @property
    def measured(self) -> Vector:
        """Measured joint positions [rad], (7,)."""
        return np.array(self.message.monitorData.measuredJointPosition.value)

    @property
    def held(self) -> Vector:
        """Joint positions that the robot itself commands [rad], (7,), to be repeated at first."""
        data = self.message.monitorData
        # From FRI 2 on, states before COMMANDING_WAIT have measured positions alone.
        shown = (self.message.ipoData.jointPosition, data.commandedJointPosition)
        known = [each.value for each in shown if len(each.value) == JOINTS]
        return np.array(known[0]) if known else self.measured

    def describe(self) -> str:
        """Describe the state of the session and the connection's quality."""
        return f"{self.state.name}, connection {Quality(self.message.connectionInfo.quality).name}"


class FriPlant(RealPlant):
    """A KUKA LBR iiwa that follows joint positions, the sum of the velocity commands.

    Args:
        host: Address of the robot's controller; "": whichever robot sends first.
        feedback: Joint angles that `read` returns: ``"commanded"``, the sum of the commands, has
            neither noise nor delay; ``"measured"`` are the encoders'.
        port: UDP port at which the robot reaches its client.

    Raises:
        InvalidInputError: There is no such feedback.
    """

    packages: ClassVar[tuple[str, ...]] = ("protobuf",)

    def __init__(self, host: str = "", feedback: Feedback = "commanded", port: int = PORT) -> None:
        self.host = host
        self.port = checks.integer("port", port, 1)
        checks.one_of("feedback", feedback, FEEDBACKS)
        self.feedback = feedback
        self._client: Any = None
        self._reset()

    def _reset(self) -> None:
        """Forget the motion before."""
        self._fault: str | None = None
        self._commanded: Vector | None = None
        self._velocity: Vector = np.zeros(JOINTS)
        self._substitutes: Matrix | None = None
        self._waits = False
        self._periods = 0
        self._lost = 0

    def _connect(self) -> None:
        """Wait for the robot's first message, unless this was done before.

        Raises:
            InvalidInputError: No robot sends messages.
            MissingDependencyError: The package protobuf is not installed.
        """
        if self._client is None or not self._client.is_open:
            self._client = FriClient(self.host, self.port)
            self._reset()

    @property
    def period(self) -> float:
        """Period of the robot's messages [s]; connects if need be."""
        self._connect()
        return float(self._client.period)

    @property
    def posture(self) -> Vector:
        """Measured joint angles before the run [rad], (7,); connects if need be."""
        self._connect()
        return np.array(self._client.measured)

    def start(self, robot: Robot, q0: Vector, dt: float, seed: int) -> None:
        """Connect to the robot, which has to stand at joint angles `q0` (7,) [rad] already.

        Raises:
            MissingDependencyError: The package protobuf is not installed.
            InvalidInputError: No robot sends messages, it stands elsewhere, or the robot of the run
                has other joints or another control period.
        """
        self.check_start(robot, q0, dt, JOINTS)

    def _begin(self) -> None:
        """Repeat the robot's position until it lets itself be commanded."""
        client = self._client
        deadline = time.monotonic() + CONNECT_TIME
        while client.receive(SILENCE):
            if client.state is SessionState.COMMANDING_ACTIVE:
                self._commanded = client.held
                return
            if client.state is SessionState.IDLE or time.monotonic() > deadline:
                break
            client.answer(client.held)
        self._fault = f"the robot did not let itself be commanded: {client.describe()}"

    def _wait(self) -> None:
        """Wait for the robot's next state, if a command was sent since the last one."""
        if not self._waits or self._commanded is None:
            return
        self._waits = False
        client = self._client
        periods = client.receive(SILENCE)
        if not periods:
            self._fault = f"no message from the robot for {SILENCE:g} s"
        elif client.state is not SessionState.COMMANDING_ACTIVE:
            self._fault = f"the robot ended the motion: {client.describe()}"
        self._periods += periods
        self._substitutes = None
        if periods > 1 or not client.is_confirmed:
            self._lost += 1
            self._substitutes = np.zeros((2, JOINTS))
        if not client.is_confirmed:
            self._commanded = self._commanded - client.period * self._velocity

    @property
    def q(self) -> Vector:
        """Measured joint angles [rad], (7,), a copy."""
        self._wait()
        return np.array(self._client.measured)

    @property
    def time(self) -> float:
        """Time since the motion began, by the robot's count of periods [s]."""
        self._wait()
        return float(self._periods * self._client.period)

    @property
    def substitutes(self) -> Matrix | None:
        """Zeros (2, 7) [rad/s], if the robot kept its position for lack of a command; else None."""
        self._wait()
        return self._substitutes

    @property
    def fault(self) -> str | None:
        """Reason for which the robot can no longer be commanded; None while it can."""
        return self._fault

    def read(self) -> Vector:
        """Return the commanded or the measured joint angles [rad], (7,); the first call begins."""
        if self._commanded is None and self._fault is None:
            self._begin()
        self._wait()
        if self._commanded is None or self.feedback == "measured":
            return self.q
        return self._commanded.copy()

    def move(self, command: Vector) -> None:
        """Send the joint positions after a period of a velocity command (7,) [rad/s]."""
        self._wait()
        if self._fault is not None or self._commanded is None:
            return
        self._velocity = np.array(command)
        self._commanded = self._commanded + self._client.period * self._velocity
        self._waits = True
        self._client.answer(self._commanded)

    def stop(self) -> None:
        """Answer no longer: the robot keeps its last commanded position."""
        self.move(np.zeros(JOINTS))
        self._client.close()

    def settings(self) -> dict[str, Any]:
        """Return the plant's entries in the settings of a record."""
        entries = {"name": "fri", "host": self.host, "feedback": self.feedback}
        return {"plant": entries | {"lost_commands": self._lost}}
