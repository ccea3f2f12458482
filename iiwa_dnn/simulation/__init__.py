"""The closed loop of controller and plant, with noise and disturbances."""

from iiwa_dnn.simulation.disturbances import Disturbances as Disturbances, Push as Push
from iiwa_dnn.simulation.filters import MovingAverage as MovingAverage
from iiwa_dnn.simulation.motion import MOTIONS as MOTIONS
from iiwa_dnn.simulation.noise import gaussian_noise as gaussian_noise
from iiwa_dnn.simulation.plants import (
    IdealPlant as IdealPlant,
    MujocoPlant as MujocoPlant,
    Plant as Plant,
    PlantState as PlantState,
)
from iiwa_dnn.simulation.runner import simulate as simulate
from iiwa_dnn.simulation.settings import (
    NOISE_ENTRIES as NOISE_ENTRIES,
    NoiseEntry as NoiseEntry,
    RunSettings as RunSettings,
)
