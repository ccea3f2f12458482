"""Robot arms from URDF files: model, limits, kinematics and shapes."""

from iiwa_dnn.robot.configuration import Configuration, FrameState
from iiwa_dnn.robot.loading import available_robots, load_robot
from iiwa_dnn.robot.robot import Robot

__all__ = ["Configuration", "FrameState", "Robot", "available_robots", "load_robot"]
