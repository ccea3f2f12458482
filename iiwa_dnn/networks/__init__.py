"""Dynamic neural networks: ODEs whose equilibria are the KKT points of a quadratic program."""

from iiwa_dnn.networks.base import Flow, Network
from iiwa_dnn.networks.dual import DualNetwork
from iiwa_dnn.networks.primal_dual import PrimalDualNetwork
from iiwa_dnn.networks.projection import ProjectionNetwork
from iiwa_dnn.networks.zeroing import ZeroingNetwork

__all__ = [
    "DualNetwork",
    "Flow",
    "Network",
    "PrimalDualNetwork",
    "ProjectionNetwork",
    "ZeroingNetwork",
]
