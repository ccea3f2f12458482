"""Integrators of a network's ODE."""

from iiwa_dnn.networks.integrators.base import Integrator, Settled
from iiwa_dnn.networks.integrators.explicit import SAFETY, ExplicitEuler
from iiwa_dnn.networks.integrators.implicit import ImplicitEuler
from iiwa_dnn.networks.integrators.runge_kutta import AdaptiveRungeKutta

__all__ = [
    "SAFETY",
    "AdaptiveRungeKutta",
    "ExplicitEuler",
    "ImplicitEuler",
    "Integrator",
    "Settled",
]
