"""Robot arms from URDF files or tables: model, limits, kinematics and shapes."""

from iiwa_dnn.robot.configuration import Configuration, FrameState
from iiwa_dnn.robot.denavit_hartenberg import robot_from_dh
from iiwa_dnn.robot.loading import available_robots, load_robot
from iiwa_dnn.robot.robot import Robot

__all__ = [
    "Configuration",
    "FrameState",
    "Robot",
    "available_robots",
    "load_robot",
    "robot_from_dh",
]
