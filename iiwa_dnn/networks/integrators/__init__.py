"""Integrators of a network's ODE."""

from iiwa_dnn.networks.integrators.base import Integrator, Progress
from iiwa_dnn.networks.integrators.explicit import SAFETY, ExplicitEuler
from iiwa_dnn.networks.integrators.implicit import ImplicitEuler

__all__ = [
    "SAFETY",
    "ExplicitEuler",
    "ImplicitEuler",
    "Integrator",
    "Progress",
]
