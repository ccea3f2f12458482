"""Plants: what moves under the controller's velocity commands."""

from iiwa_dnn.simulation.plants.base import Plant
from iiwa_dnn.simulation.plants.ideal import IdealPlant
from iiwa_dnn.simulation.plants.mujoco import MujocoPlant

__all__ = ["IdealPlant", "MujocoPlant", "Plant"]
