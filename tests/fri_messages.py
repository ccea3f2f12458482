"""Messages of KUKA's Fast Robot Interface, FRI, in the wire format of protobuf.

The robot sends a monitoring message at every period, the client answers it by a command message.
Field numbers are those of KUKA's client SDK 1.11 to 2.5; a reader skips fields that it does not
know, so only those used here are declared. SDK 2.7 puts a length before and a checksum behind each
message and is not supported.
"""

from enum import IntEnum
from functools import cache
from typing import Any, NamedTuple

from iiwa_dnn.errors import import_extra

MONITORING_ID = 0x245142
"""Identifier of a monitoring message of an LBR arm."""

COMMAND_ID = 0x34001
"""Identifier of a command message to an LBR arm."""

PORT = 30200
"""UDP port at which a client listens."""

_REMEDY = "pip install 'iiwa-dnn[fri]'"

LARGEST_MESSAGE = 1500
"""Size of the largest message [bytes]."""


WRAP = 2**32
"""Number at which the sequence counters begin again."""


class SessionState(IntEnum):
    """State of the session between robot and client."""

    IDLE = 0
    MONITORING_WAIT = 1
    MONITORING_READY = 2
    COMMANDING_WAIT = 3
    COMMANDING_ACTIVE = 4


class Quality(IntEnum):
    """Connection quality; a client may command from GOOD on."""

    POOR = 0
    FAIR = 1
    GOOD = 2
    EXCELLENT = 3


class MessageTypes(NamedTuple):
    """Classes of the two messages, made by protobuf."""

    monitoring: Any
    command: Any


# Each message with its fields: name, number, label, type. An enumeration is an int32 on the wire.
_FIELDS = {
    "JointValues": (("value", 1, "repeated", "double"),),
    "TimeStamp": (("sec", 1, "required", "uint32"), ("nanosec", 2, "required", "uint32")),
    "MessageHeader": (
        ("messageIdentifier", 1, "required", "uint32"),
        ("sequenceCounter", 2, "required", "uint32"),
        ("reflectedSequenceCounter", 3, "required", "uint32"),
    ),
    "ConnectionInfo": (
        ("sessionState", 1, "required", "int32"),
        ("quality", 2, "required", "int32"),
        ("sendPeriod", 3, "optional", "uint32"),
        ("receiveMultiplier", 4, "optional", "uint32"),
    ),
    "RobotInfo": (
        ("numberOfJoints", 1, "optional", "int32"),
        ("safetyState", 2, "optional", "int32"),
        ("driveState", 5, "repeated", "int32"),
        ("operationMode", 6, "optional", "int32"),
        ("controlMode", 7, "optional", "int32"),
    ),
    "MessageMonitorData": (
        ("measuredJointPosition", 1, "optional", "JointValues"),
        ("measuredTorque", 2, "optional", "JointValues"),
        ("commandedJointPosition", 3, "optional", "JointValues"),
        ("commandedTorque", 4, "optional", "JointValues"),
        ("externalTorque", 5, "optional", "JointValues"),
        ("timestamp", 15, "optional", "TimeStamp"),
    ),
    "MessageIpoData": (
        ("jointPosition", 1, "optional", "JointValues"),
        ("clientCommandMode", 10, "optional", "int32"),
        ("overlayType", 11, "optional", "int32"),
    ),
    "FRIMonitoringMessage": (
        ("header", 1, "required", "MessageHeader"),
        ("robotInfo", 2, "optional", "RobotInfo"),
        ("monitorData", 3, "optional", "MessageMonitorData"),
        ("connectionInfo", 4, "optional", "ConnectionInfo"),
        ("ipoData", 5, "optional", "MessageIpoData"),
    ),
    "MessageCommandData": (("jointPosition", 1, "optional", "JointValues"),),
    "FRICommandMessage": (
        ("header", 1, "required", "MessageHeader"),
        ("commandData", 2, "optional", "MessageCommandData"),
    ),
}


@cache
def message_types() -> MessageTypes:
    """Build the classes of the messages.

    Raises:
        MissingDependencyError: The package protobuf is not installed.
    """
    descriptor = import_extra("google.protobuf.descriptor_pb2", _REMEDY)
    factory = import_extra("google.protobuf.message_factory", _REMEDY)
    kind = descriptor.FieldDescriptorProto
    file = descriptor.FileDescriptorProto(name="fri.proto", package="fri", syntax="proto2")
    for message, fields in _FIELDS.items():
        declared = file.message_type.add(name=message)
        for name, number, label, type_name in fields:
            field = declared.field.add(name=name, number=number)
            field.label = kind.Label.Value(f"LABEL_{label.upper()}")
            if type_name in _FIELDS:
                field.type = kind.TYPE_MESSAGE
                field.type_name = f".fri.{type_name}"
            else:
                field.type = kind.Type.Value(f"TYPE_{type_name.upper()}")
    classes = factory.GetMessages([file])
    return MessageTypes(classes["fri.FRIMonitoringMessage"], classes["fri.FRICommandMessage"])


def parse(kind: Any, identifier: int, datagram: bytes) -> Any:
    """Read a message; return None for anything else than a whole one of its kind.

    Args:
        kind: Class of the message, of `MessageTypes`.
        identifier: Identifier that its header has to hold.
        datagram: Content of a UDP packet.
    """
    try:
        message = kind.FromString(datagram)
    except import_extra("google.protobuf.message", _REMEDY).DecodeError:
        return None
    return message if message.header.messageIdentifier == identifier else None
