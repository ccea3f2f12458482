"""The closed loop of controller and plant, with noise and disturbances."""

from iiwa_dnn.control.filters import MovingAverage as MovingAverage
from iiwa_dnn.simulation.disturbances import Disturbances as Disturbances
from iiwa_dnn.simulation.disturbances import Push as Push
from iiwa_dnn.simulation.motion import MOTIONS as MOTIONS
from iiwa_dnn.simulation.noise import NOISE_ENTRIES as NOISE_ENTRIES
from iiwa_dnn.simulation.noise import Disturbance as Disturbance
from iiwa_dnn.simulation.noise import NoiseEntry as NoiseEntry
from iiwa_dnn.simulation.noise import VelocityDisturbance as VelocityDisturbance
from iiwa_dnn.simulation.noise import gaussian_noise as gaussian_noise
from iiwa_dnn.simulation.plants import FrankaPlant as FrankaPlant
from iiwa_dnn.simulation.plants import FriPlant as FriPlant
from iiwa_dnn.simulation.plants import IdealPlant as IdealPlant
from iiwa_dnn.simulation.plants import MujocoPlant as MujocoPlant
from iiwa_dnn.simulation.plants import Plant as Plant
from iiwa_dnn.simulation.plants import RealPlant as RealPlant
from iiwa_dnn.simulation.retiming import Trajectory as Trajectory
from iiwa_dnn.simulation.retiming import retime as retime
from iiwa_dnn.simulation.runner import Simulation as Simulation
from iiwa_dnn.simulation.runner import simulate as simulate
