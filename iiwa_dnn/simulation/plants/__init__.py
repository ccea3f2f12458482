"""Plants: robots that move under the controller's velocity commands."""

from iiwa_dnn.simulation.plants.base import (
    IdealPlant as IdealPlant,
    Plant as Plant,
    PlantState as PlantState,
)
from iiwa_dnn.simulation.plants.mujoco import MujocoPlant as MujocoPlant
