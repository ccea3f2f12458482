"""Redundancy-resolution schemes: costs, tasks and limits that make a control step's program."""

from iiwa_dnn.robot.obstacles import (
    Box as Box,
    Capsule as Capsule,
    HalfSpace as HalfSpace,
    Obstacle as Obstacle,
    Sphere as Sphere,
)
from iiwa_dnn.schemes.collisions import CollisionAvoidance as CollisionAvoidance
from iiwa_dnn.schemes.costs import (
    CyclicMotion as CyclicMotion,
    KineticEnergy as KineticEnergy,
    Manipulability as Manipulability,
)
from iiwa_dnn.schemes.joint_limits import (
    AccelerationLimits as AccelerationLimits,
    JerkLimits as JerkLimits,
    JointLimits as JointLimits,
    own_rate_limits as own_rate_limits,
)
from iiwa_dnn.schemes.literature import (
    DoubleIndicator as DoubleIndicator,
    PseudoInverse as PseudoInverse,
)
from iiwa_dnn.schemes.parts import Cost as Cost, Limit as Limit, Part as Part, Task as Task
from iiwa_dnn.schemes.scheme import Scheme as Scheme
from iiwa_dnn.schemes.separation import Separation as Separation
from iiwa_dnn.schemes.step import Step as Step
from iiwa_dnn.schemes.tasks import (
    AxisTask as AxisTask,
    JointCouplingTask as JointCouplingTask,
    OrientationTask as OrientationTask,
    PoseTask as PoseTask,
    PositionTask as PositionTask,
    PostureTask as PostureTask,
    RelativePoseTask as RelativePoseTask,
    RemoteCenterTask as RemoteCenterTask,
)
from iiwa_dnn.schemes.tip_speed import TipSpeedLimit as TipSpeedLimit
from iiwa_dnn.schemes.torque import TorqueLimits as TorqueLimits
