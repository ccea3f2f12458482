"""Redundancy-resolution schemes: costs, tasks and limits that make a control step's program."""

from iiwa_dnn.schemes.base import Scheme
from iiwa_dnn.schemes.costs import CyclicMotion, KineticEnergy
from iiwa_dnn.schemes.double_indicator import DoubleIndicator
from iiwa_dnn.schemes.limits import JointLimits
from iiwa_dnn.schemes.parts import Cost, Limit, Part, Step, Task
from iiwa_dnn.schemes.pseudo_inverse import PseudoInverse
from iiwa_dnn.schemes.tasks import OrientationTask, PositionTask

__all__ = [
    "Cost",
    "CyclicMotion",
    "DoubleIndicator",
    "JointLimits",
    "KineticEnergy",
    "Limit",
    "OrientationTask",
    "Part",
    "PositionTask",
    "PseudoInverse",
    "Scheme",
    "Step",
    "Task",
]
