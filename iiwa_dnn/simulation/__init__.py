"""The closed loop of controller and plant, with noise and disturbances."""

from iiwa_dnn.control.filters import MovingAverage
from iiwa_dnn.simulation.disturbances import Disturbances, Push
from iiwa_dnn.simulation.motion import MOTIONS
from iiwa_dnn.simulation.noise import NOISE_ENTRIES, NoiseEntry, VelocityDisturbance, gaussian_noise
from iiwa_dnn.simulation.plants import IdealPlant, MujocoPlant, Plant
from iiwa_dnn.simulation.retiming import Trajectory, retime
from iiwa_dnn.simulation.runner import Simulation, simulate

__all__ = [
    "MOTIONS",
    "NOISE_ENTRIES",
    "Disturbances",
    "IdealPlant",
    "MovingAverage",
    "MujocoPlant",
    "NoiseEntry",
    "Plant",
    "Push",
    "Simulation",
    "Trajectory",
    "VelocityDisturbance",
    "gaussian_noise",
    "retime",
    "simulate",
]
