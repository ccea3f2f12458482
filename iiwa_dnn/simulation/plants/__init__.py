"""Plants: what moves under the controller's velocity commands."""

from iiwa_dnn.simulation.plants.base import Plant
from iiwa_dnn.simulation.plants.ideal import IdealPlant

__all__ = ["IdealPlant", "Plant"]
