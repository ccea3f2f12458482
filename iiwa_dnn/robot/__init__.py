"""Robot arms from URDF files: model, limits, kinematics and shapes."""

from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.robot.robot import Robot, available_robots, load_robot

__all__ = ["Configuration", "Robot", "available_robots", "load_robot"]
