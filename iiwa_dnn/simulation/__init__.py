"""The controller closed around a robot that moves as it is told, with noise and a filter."""

from iiwa_dnn.control.filters import MovingAverage
from iiwa_dnn.simulation.motion import MOTIONS
from iiwa_dnn.simulation.noise import NOISE_ENTRIES, NoiseEntry, VelocityDisturbance, gaussian_noise
from iiwa_dnn.simulation.runner import Simulation, simulate

__all__ = [
    "MOTIONS",
    "NOISE_ENTRIES",
    "MovingAverage",
    "NoiseEntry",
    "Simulation",
    "VelocityDisturbance",
    "gaussian_noise",
    "simulate",
]
