"""How a network's ODE is advanced in time."""

from iiwa_dnn.integrators.base import Integrator, Settled
from iiwa_dnn.integrators.explicit import SAFETY, ExplicitEuler
from iiwa_dnn.integrators.implicit import ImplicitEuler

__all__ = ["SAFETY", "ExplicitEuler", "ImplicitEuler", "Integrator", "Settled"]
