"""How a network's ODE is advanced in time."""

from iiwa_dnn.integrators.base import Integrator, Settled
from iiwa_dnn.integrators.explicit import SAFETY, ExplicitEuler
from iiwa_dnn.integrators.implicit import ImplicitEuler
from iiwa_dnn.integrators.runge_kutta import AdaptiveRungeKutta

__all__ = [
    "SAFETY",
    "AdaptiveRungeKutta",
    "ExplicitEuler",
    "ImplicitEuler",
    "Integrator",
    "Settled",
]
