"""Robot arms from URDF files or tables: model, limits, kinematics and shapes."""

from iiwa_dnn.robot.configuration import Configuration as Configuration, FrameState as FrameState
from iiwa_dnn.robot.denavit_hartenberg import robot_from_dh as robot_from_dh
from iiwa_dnn.robot.loading import available_robots as available_robots, load_robot as load_robot
from iiwa_dnn.robot.robot import Robot as Robot
