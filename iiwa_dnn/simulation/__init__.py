"""The controller closed around a robot that moves as it is told, with noise and a filter."""

from iiwa_dnn.simulation.filters import MovingAverage
from iiwa_dnn.simulation.loop import Simulation, simulate
from iiwa_dnn.simulation.motion import MOTIONS
from iiwa_dnn.simulation.noise import NOISE_ENTRIES, NoiseEntry, VelocityDisturbance, gaussian_noise

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
