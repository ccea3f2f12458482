"""Dynamic neural networks: ODEs whose equilibria are the KKT points of a quadratic program."""

from iiwa_dnn.networks.activations import ActivatedNetwork
from iiwa_dnn.networks.base import Flow, Network
from iiwa_dnn.networks.dual import DualNetwork, SimplifiedDualNetwork
from iiwa_dnn.networks.gradient import GradientNetwork
from iiwa_dnn.networks.noise_suppressing import NoiseSuppressingNetwork
from iiwa_dnn.networks.primal_dual import OneLayerNetwork, PrimalDualNetwork
from iiwa_dnn.networks.projection import ProjectionNetwork
from iiwa_dnn.networks.zeroing import ZeroingNetwork

__all__ = [
    "ActivatedNetwork",
    "DualNetwork",
    "Flow",
    "GradientNetwork",
    "Network",
    "NoiseSuppressingNetwork",
    "OneLayerNetwork",
    "PrimalDualNetwork",
    "ProjectionNetwork",
    "SimplifiedDualNetwork",
    "ZeroingNetwork",
]
