"""Redundancy-resolution schemes: costs, tasks and limits that make a control step's program."""

from iiwa_dnn.robot.obstacles import Box, Capsule, ConvexMesh, HalfSpace, Obstacle, Sphere
from iiwa_dnn.schemes.acceleration import JointAcceleration, JointTorque
from iiwa_dnn.schemes.base import Scheme
from iiwa_dnn.schemes.collisions import CollisionAvoidance
from iiwa_dnn.schemes.costs import CyclicMotion, KineticEnergy, Manipulability
from iiwa_dnn.schemes.double_indicator import DoubleIndicator
from iiwa_dnn.schemes.frame_tasks import AxisTask, PoseTask, RelativePoseTask, RemoteCentreTask
from iiwa_dnn.schemes.joint_tasks import (
    CentreOfMassTask,
    ElbowAngleTask,
    JointCouplingTask,
    PostureTask,
)
from iiwa_dnn.schemes.limits import JointLimits
from iiwa_dnn.schemes.motion_limits import AccelerationLimits, JerkLimits
from iiwa_dnn.schemes.parts import Cost, Limit, Part, Step, Task
from iiwa_dnn.schemes.pseudo_inverse import PseudoInverse
from iiwa_dnn.schemes.tasks import OrientationTask, PositionTask

__all__ = [
    "AccelerationLimits",
    "AxisTask",
    "Box",
    "Capsule",
    "CentreOfMassTask",
    "CollisionAvoidance",
    "ConvexMesh",
    "Cost",
    "CyclicMotion",
    "DoubleIndicator",
    "ElbowAngleTask",
    "HalfSpace",
    "JerkLimits",
    "JointAcceleration",
    "JointCouplingTask",
    "JointLimits",
    "JointTorque",
    "KineticEnergy",
    "Limit",
    "Manipulability",
    "Obstacle",
    "OrientationTask",
    "Part",
    "PoseTask",
    "PositionTask",
    "PostureTask",
    "PseudoInverse",
    "RelativePoseTask",
    "RemoteCentreTask",
    "Scheme",
    "Sphere",
    "Step",
    "Task",
]
