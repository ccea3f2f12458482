"""A robot's side of KUKA's Fast Robot Interface (FRI), with an arm that follows every command.

The robot sends a monitoring message in every period, and the client answers it by a command; both
are in protobuf's wire format. Field numbers are those of KUKA's client SDK 1.11 to 2.5; a reader
skips fields that it does not know, so only those used here are declared. KUKA publishes states and
messages, but no numbers: the lengths of the waiting states are this module's. A robot brakes where
this one ends the session. It is for programs, not for safety.
"""

import socket
import time
from collections.abc import Callable
from enum import IntEnum
from typing import Any

import numpy as np
from google.protobuf import descriptor_pb2, message_factory

from iiwa_dnn.qp.program import Vector
from iiwa_dnn.robot import Robot

MONITORING_ID = 0x245142
COMMAND_ID = 0x34001

READY_PERIODS = 20
"""Periods in MONITORING_READY before the robot asks for commands."""

MIRRORED_PERIODS = 20
"""Answers in COMMANDING_WAIT that repeat the robot's position before commands are followed."""

CLOSING_MESSAGES = 3
"""Messages that tell the client of the end of the session; some may be lost."""

_PATIENCE = 1.0  # longest time for an answer [s]
_ROUNDING = 1e-6  # of a repeated position [rad], and of a velocity limit, relative to it
_ONE = 1  # in the SDK's enumerations: an overlay of joint positions, commands of positions


class SessionState(IntEnum):
    """State of the session between robot and client."""

    IDLE = 0
    MONITORING_WAIT = 1
    MONITORING_READY = 2
    COMMANDING_WAIT = 3
    COMMANDING_ACTIVE = 4


_EXCELLENT = 3  # connection quality

# Fields of each message by their numbers. An enumeration is an int32 on the wire.
_FIELDS = {
    "JointValues": {1: "value repeated double"},
    "TimeStamp": {1: "sec required uint32", 2: "nanosec required uint32"},
    "MessageHeader": {
        1: "messageIdentifier required uint32",
        2: "sequenceCounter required uint32",
        3: "reflectedSequenceCounter required uint32",
    },
    "ConnectionInfo": {
        1: "sessionState required int32",
        2: "quality required int32",
        3: "sendPeriod optional uint32",
        4: "receiveMultiplier optional uint32",
    },
    "RobotInfo": {1: "numberOfJoints optional int32", 5: "driveState repeated int32"},
    "MessageMonitorData": {
        1: "measuredJointPosition optional JointValues",
        2: "measuredTorque optional JointValues",
        3: "commandedJointPosition optional JointValues",
        4: "commandedTorque optional JointValues",
        5: "externalTorque optional JointValues",
        15: "timestamp optional TimeStamp",
    },
    "MessageIpoData": {
        1: "jointPosition optional JointValues",
        10: "clientCommandMode optional int32",
        11: "overlayType optional int32",
    },
    "FRIMonitoringMessage": {
        1: "header required MessageHeader",
        2: "robotInfo optional RobotInfo",
        3: "monitorData optional MessageMonitorData",
        4: "connectionInfo optional ConnectionInfo",
        5: "ipoData optional MessageIpoData",
    },
    "MessageCommandData": {1: "jointPosition optional JointValues"},
    "FRICommandMessage": {
        1: "header required MessageHeader",
        2: "commandData optional MessageCommandData",
    },
}


def message_types() -> tuple[Any, Any]:
    """Build the classes of monitoring and of command messages."""
    kind = descriptor_pb2.FieldDescriptorProto
    file = descriptor_pb2.FileDescriptorProto(name="fri.proto", package="fri", syntax="proto2")
    for message, fields in _FIELDS.items():
        declared = file.message_type.add(name=message)
        for number, field in fields.items():
            name, label, own = field.split()
            added = declared.field.add(name=name, number=number)
            added.label = kind.Label.Value(f"LABEL_{label.upper()}")
            if own in _FIELDS:
                added.type = kind.TYPE_MESSAGE
                added.type_name = f".fri.{own}"
            else:
                added.type = kind.Type.Value(f"TYPE_{own.upper()}")
    classes = message_factory.GetMessages([file])
    return classes["fri.FRIMonitoringMessage"], classes["fri.FRICommandMessage"]


MONITORING, COMMAND = message_types()


class FriController:
    """One session of a robot of 7 joints with one client, in joint position control.

    In each period: send `message`, hand the answer to `advance`. A command is followed if it is
    inside the position limits, and reached from the last commanded position within the velocity
    limits in one period. The session ends at any other, and where none comes.

    Attributes:
        state: State of the session.
        fault: Reason for the end of the session; None: it goes on, or was ended.
        commanded: Commanded joint positions [rad], (7,).
        period: Time between two messages [s], whole milliseconds.
    """

    def __init__(self, robot: Robot, q0: Vector, period: float) -> None:
        self.state = SessionState.MONITORING_WAIT
        self.fault: str | None = None
        self.commanded = q0
        self.period = period
        self._robot = robot
        self._held = q0
        self._in_state = 0
        self._sequence = 0
        self._reflected = 0

    def message(self) -> bytes:
        """Encode the monitoring message of this period."""
        seconds, nanoseconds = divmod(time.time_ns(), 10**9)
        zeros = {"value": [0.0] * 7}
        commanded = {"value": self.commanded.tolist()}
        held = {"value": self._held.tolist()}
        asks = self.state >= SessionState.COMMANDING_WAIT
        message = MONITORING(
            header={
                "messageIdentifier": MONITORING_ID,
                "sequenceCounter": self._sequence,
                "reflectedSequenceCounter": self._reflected,
            },
            robotInfo={"numberOfJoints": 7, "driveState": [2] * 7},
            monitorData={
                "measuredJointPosition": commanded,
                "measuredTorque": zeros,
                "commandedJointPosition": commanded,
                "commandedTorque": zeros,
                "externalTorque": zeros,
                "timestamp": {"sec": seconds, "nanosec": nanoseconds},
            },
            connectionInfo={
                "sessionState": self.state,
                "quality": _EXCELLENT,
                "sendPeriod": round(1e3 * self.period),
                "receiveMultiplier": 1,
            },
            ipoData={"jointPosition": held, "clientCommandMode": _ONE, "overlayType": _ONE}
            if asks
            else None,
        )
        return bytes(message.SerializeToString())

    def advance(self, answer: bytes) -> None:
        """End the period: take the client's answer, change the state, and move the arm."""
        self._in_state += 1
        command = COMMAND.FromString(answer)
        header = command.header
        fits = (header.messageIdentifier, header.reflectedSequenceCounter)
        assert fits == (COMMAND_ID, self._sequence)
        self._reflected = header.sequenceCounter
        self._sequence += 1
        if self.state is SessionState.MONITORING_WAIT:
            self._enter(SessionState.MONITORING_READY)
        elif self.state is SessionState.MONITORING_READY:
            if self._in_state >= READY_PERIODS:
                self._enter(SessionState.COMMANDING_WAIT)
        elif self.state >= SessionState.COMMANDING_WAIT:
            self._take(np.array(command.commandData.jointPosition.value))

    def end(self, fault: str | None = None) -> None:
        """End the session; the arm keeps its commanded position."""
        self.fault = fault
        self._enter(SessionState.IDLE)

    def _enter(self, state: SessionState) -> None:
        self.state = state
        self._in_state = 0

    def _take(self, q: Vector) -> None:
        """Follow commanded joint positions, of any size, or wait for those that are held."""
        refusal = self._refusal(q)
        if refusal:
            self.end(f"command refused: {refusal}")
        elif self.state is SessionState.COMMANDING_ACTIVE:
            self.commanded = q
        elif np.abs(q - self.commanded).max() > _ROUNDING:
            self._in_state = 0
        elif self._in_state >= MIRRORED_PERIODS:
            self._enter(SessionState.COMMANDING_ACTIVE)

    def _refusal(self, q: Vector) -> str | None:
        """Return the reason for refusing commanded joint positions; None if there is none."""
        if q.shape != (7,) or not np.isfinite(q).all():
            return "it does not hold 7 finite joint positions"
        ratio = np.abs(q - self.commanded) / (self.period * self._robot.dq_max)
        joint = int(ratio.argmax())
        if ratio[joint] > 1.0 + _ROUNDING:
            return f"joint {joint + 1} jumps, {ratio[joint]:.3g} times its velocity limit"
        return self._robot.outside(q)


def serve(controller: FriController, port: int, observe: Callable[[FriController], object]) -> None:
    """Let a controller talk to a client over UDP, not in real time, until the session ends.

    `observe` is called after each period.
    """
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        client = ("127.0.0.1", port)
        link.bind(("", 0))
        try:
            while controller.state is not SessionState.IDLE:
                waits = controller.state is SessionState.MONITORING_WAIT
                link.settimeout(0.1 if waits else _PATIENCE)
                link.sendto(controller.message(), client)
                try:
                    controller.advance(link.recv(1500))
                except (TimeoutError, ConnectionError):
                    if not waits:  # the client may not have begun
                        controller.end("no answer")
                observe(controller)
        finally:
            controller.end(controller.fault)
            for _ in range(CLOSING_MESSAGES):
                link.sendto(controller.message(), client)
