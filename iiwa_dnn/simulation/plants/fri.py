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
    WRAP,
    Quality,
    SessionState,
    message_types,
    parse,
)

CONNECT_TIME = 30.0
"""Time to wait for the robot's first message, and for its consent to be commanded [s]."""

SILENCE = 1.0
"""Time without a message after which the robot is given up [s]."""


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
        self._link: socket.socket | None = None

    def _connect(self) -> socket.socket:
        """Listen for the robot and wait for its first message, unless this was done before.

        Raises:
            InvalidInputError: The port is taken, or no robot sends messages.
            MissingDependencyError: The package protobuf is not installed.
        """
        if self._link is not None:
            return self._link
        message_types()
        if ":" in self.host:
            problem = f"{self.host} has a port: it is UDP port {self.port} always"
            raise InvalidInputError("host", problem, self.host)
        self._robot: Any = None
        self._message: Any = None
        self._counter = 0
        self._is_confirmed = True
        link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._address = socket.gethostbyname(self.host) if self.host else ""
            link.bind(("", self.port))
            if not self._next_message(link, CONNECT_TIME):
                raise TimeoutError(f"no robot sent a message within {CONNECT_TIME:g} s")
        except OSError as error:
            link.close()
            problem = f"{self.host} UDP port {self.port}: {one_line(error)}".strip()
            raise InvalidInputError("host", problem, self.host) from error
        self._link = link
        return link

    def _next_message(self, link: socket.socket, patience: float) -> int:
        """Take the robot's newest message; wait for one if there is none.

        Args:
            link: Socket that listens for the robot.
            patience: Longest time to wait [s].

        Returns:
            Number of the robot's periods since the message before; 0: no message came.
        """
        before = self._message
        deadline = time.monotonic() + patience
        while select([link], [], [], max(0.0, deadline - time.monotonic()))[0]:
            datagram, sender = link.recvfrom(LARGEST_MESSAGE)
            if self._take(datagram, sender):
                deadline = 0.0  # newer ones may be there already
        if self._message is before:
            return 0
        if before is None:
            return 1
        new = self._message.header
        self._is_confirmed = new.reflectedSequenceCounter != before.header.reflectedSequenceCounter
        return int((new.sequenceCounter - before.header.sequenceCounter) % WRAP)

    def _take(self, datagram: bytes, sender: Any) -> bool:
        """Keep a datagram's message if it is the robot's and newer; return whether it is."""
        if sender != self._robot and (self._robot or self._address not in ("", sender[0])):
            return False
        message = parse(message_types().monitoring, MONITORING_ID, datagram)
        if message is None or len(message.monitorData.measuredJointPosition.value) != JOINTS:
            return False
        if self._message is not None:
            before = self._message.header.sequenceCounter
            if not 0 < (message.header.sequenceCounter - before) % WRAP < WRAP // 2:
                return False
        self._robot = sender
        self._message = message
        return True

    def _answer(self, q: Vector) -> None:
        """Send joint positions (7,) [rad] for the newest message."""
        command = message_types().command(
            header={
                "messageIdentifier": COMMAND_ID,
                "sequenceCounter": self._counter,
                "reflectedSequenceCounter": self._message.header.sequenceCounter,
            },
            commandData={"jointPosition": {"value": q.tolist()}},
        )
        self._counter = (self._counter + 1) % WRAP
        self._connect().sendto(command.SerializeToString(), self._robot)

    @property
    def _state(self) -> SessionState:
        """State of the session."""
        return SessionState(self._message.connectionInfo.sessionState)

    @property
    def _held(self) -> Vector:
        """Joint positions that the robot itself commands [rad], (7,), to be repeated at first."""
        data = self._message.monitorData
        # From FRI 2 on, states before COMMANDING_WAIT have measured positions alone.
        shown = (self._message.ipoData.jointPosition, data.commandedJointPosition)
        known = [each.value for each in shown if len(each.value) == JOINTS]
        return np.array(known[0]) if known else self.posture

    def _describe(self) -> str:
        """Describe the state of the session and the connection's quality."""
        quality = Quality(self._message.connectionInfo.quality)
        return f"{self._state.name}, connection {quality.name}"

    @property
    def period(self) -> float:
        """Period of the robot's messages [s]; connects if need be."""
        self._connect()
        return 1e-3 * float(self._message.connectionInfo.sendPeriod)

    @property
    def posture(self) -> Vector:
        """Measured joint angles of the last state [rad], (7,); connects if need be."""
        self._connect()
        return np.array(self._message.monitorData.measuredJointPosition.value)

    def _begin(self) -> None:
        """Repeat the robot's position until it lets itself be commanded."""
        deadline = time.monotonic() + CONNECT_TIME
        while self._next_message(self._connect(), SILENCE):
            if self._state is SessionState.COMMANDING_ACTIVE:
                self._motion.commanded = self._held
                return
            if self._state is SessionState.IDLE or time.monotonic() > deadline:
                break
            self._answer(self._held)
        self._motion.fault = f"the robot did not let itself be commanded: {self._describe()}"

    def _receive(self) -> None:
        """Wait for the robot's next state, and see whether it has our last command."""
        motion = self._motion
        periods = self._next_message(self._connect(), SILENCE)
        if not periods:
            motion.fault = f"no message from the robot for {SILENCE:g} s"
        elif self._state is not SessionState.COMMANDING_ACTIVE:
            motion.fault = f"the robot ended the motion: {self._describe()}"
        motion.time += periods * self.period
        if periods > 1 or not self._is_confirmed:
            motion.late.append(motion.time)
            motion.substitutes = np.zeros((2, JOINTS))
        if not self._is_confirmed:
            motion.commanded = motion.commanded - self.period * motion.command

    def _send(self) -> None:
        """Send the joint positions after a period of the last command."""
        self._answer(self._motion.commanded)

    def stop(self) -> None:
        """Answer no longer: the robot keeps its last commanded position."""
        if self._link is not None:
            self.move(np.zeros(JOINTS))
            self._link.close()
        self._link = None
