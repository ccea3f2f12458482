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
from iiwa_dnn.qp.program import Vector
from iiwa_dnn.simulation.plants.base import JOINTS, Feedback, RealPlant
from iiwa_dnn.simulation.plants.fri_messages import (
    COMMAND_ID,
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
        if ":" in host:
            raise InvalidInputError(
                "host", f"{host} has a port: it is UDP port {port} always", host
            )
        self._link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._robot: Any = None
        self._counter = 0
        self.message: Any = None
        self.is_confirmed = True
        try:
            self._host = socket.gethostbyname(host) if host else ""
            self._link.bind(("", port))
            if not self.receive(CONNECT_TIME):
                raise TimeoutError(f"no robot sent a message within {CONNECT_TIME:g} s")
        except OSError as error:
            self.close()
            problem = f"{host} UDP port {port}: {one_line(error)}".strip()
            raise InvalidInputError("host", problem, host) from error

    def close(self) -> None:
        """Listen no longer."""
        self._link.close()

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

    name: ClassVar[str] = "fri"
    packages: ClassVar[tuple[str, ...]] = ("protobuf",)

    def __init__(self, host: str = "", feedback: Feedback = "commanded", port: int = PORT) -> None:
        super().__init__(host, feedback)
        self.port = checks.integer("port", port, 1)
        self._client: FriClient | None = None

    def _connect(self) -> FriClient:
        """Wait for the robot's first message, unless this was done before.

        Raises:
            InvalidInputError: No robot sends messages.
            MissingDependencyError: The package protobuf is not installed.
        """
        if self._client is None:
            self._client = FriClient(self.host, self.port)
        return self._client

    @property
    def period(self) -> float:
        """Period of the robot's messages [s]; connects if need be."""
        return self._connect().period

    @property
    def posture(self) -> Vector:
        """Measured joint angles of the last state [rad], (7,); connects if need be."""
        return self._connect().measured

    def _begin(self) -> None:
        """Repeat the robot's position until it lets itself be commanded."""
        client = self._connect()
        deadline = time.monotonic() + CONNECT_TIME
        while client.receive(SILENCE):
            if client.state is SessionState.COMMANDING_ACTIVE:
                self._motion.commanded = client.held
                return
            if client.state is SessionState.IDLE or time.monotonic() > deadline:
                break
            client.answer(client.held)
        self._motion.fault = f"the robot did not let itself be commanded: {client.describe()}"

    def _receive(self) -> None:
        """Wait for the robot's next state, and see whether it has our last command."""
        motion = self._motion
        client = self._connect()
        periods = client.receive(SILENCE)
        if not periods:
            motion.fault = f"no message from the robot for {SILENCE:g} s"
        elif client.state is not SessionState.COMMANDING_ACTIVE:
            motion.fault = f"the robot ended the motion: {client.describe()}"
        motion.time += periods * client.period
        if periods > 1 or not client.is_confirmed:
            motion.late.append(motion.time)
            motion.substitutes = np.zeros((2, JOINTS))
        if not client.is_confirmed:
            motion.commanded = motion.commanded - client.period * motion.command

    def _send(self) -> None:
        """Send the joint positions after a period of the last command."""
        self._connect().answer(self._motion.commanded)

    def stop(self) -> None:
        """Answer no longer: the robot keeps its last commanded position."""
        if self._client is not None:
            self.move(np.zeros(JOINTS))
            self._client.close()
        self._client = None
