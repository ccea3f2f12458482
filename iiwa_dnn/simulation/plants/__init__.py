"""Plants: what moves under the controller's velocity commands."""

from iiwa_dnn.simulation.plants.base import Plant as Plant
from iiwa_dnn.simulation.plants.ideal import IdealPlant as IdealPlant
from iiwa_dnn.simulation.plants.mujoco import MujocoPlant as MujocoPlant
