"""Layout of a control step as compiled code reads it, and the instant that the step answers."""

from enum import IntEnum
from typing import NamedTuple

from iiwa_dnn.networks.integrators.base import CompiledAnswer
from iiwa_dnn.qp import Vector
from iiwa_dnn.qp.layout import IntMatrix
from iiwa_dnn.schemes.periods import Periods
from iiwa_dnn.schemes.program import ProgramArrays
from iiwa_dnn.schemes.step import StepViews
from iiwa_dnn.step.fallback import Yielding
from iiwa_dnn.step.state import MotionState


class PathColumn(IntEnum):
    """Columns of `Paths.table`: function address, feed-forward flag, slice of the constants."""

    ADDRESS = 0
    FEED_FORWARD = 1
    START = 2
    STOP = 3


class Paths(NamedTuple):
    """Compiled paths of the tracked frames.

    Attributes:
        table: A row for each of k paths, (k, 4), with the columns of `PathColumn`.
        constants: Base target and constants of each path, one path after another, (size,).
    """

    table: IntMatrix
    constants: Vector


class ControlPlan(NamedTuple):
    """Constants, settings and work arrays of a control step, as compiled code reads them.

    Attributes:
        arrays: Arrays from which the nominal program is assembled.
        network: Function that answers the nominal program, with its settings.
        paths: Paths of the tracked frames; empty if targets are given.
        yielding: Constants of the fallback programs and stopping motions.
        fallback: Network states of the fallback programs, (`fallback_size`,), their warm starts;
            changed by steps.
        policy: Action of the policy at a step without a solution; `BRAKE` in continuous mode.
        timing: Periods of the step.
    """

    arrays: ProgramArrays
    network: CompiledAnswer
    paths: Paths
    yielding: Yielding
    fallback: Vector
    policy: int
    timing: Periods


class Instant(NamedTuple):
    """One instant of a motion, which a control step answers with a command.

    Attributes:
        step: The instant as the parts of the scheme read it.
        motion: State of the motion, with the last command and the stored motion to rest.
        next_motion: State for the next step, overwritten.
    """

    step: StepViews
    motion: MotionState
    next_motion: MotionState
