"""Plants: what moves under the controller's velocity commands."""

from iiwa_dnn.simulation.plants.base import Plant as Plant, RealPlant as RealPlant
from iiwa_dnn.simulation.plants.franka import FrankaPlant as FrankaPlant
from iiwa_dnn.simulation.plants.fri import FriPlant as FriPlant
from iiwa_dnn.simulation.plants.ideal import IdealPlant as IdealPlant
from iiwa_dnn.simulation.plants.mujoco import MujocoPlant as MujocoPlant
