r"""Networks that are affine but for one projection, of which one compiled function evaluates all.

.. math::  \rho\,\dot s = O\,\bigl\{\Pi_{[l,\,u]}(A s + k) - s - \kappa\,(A s + k)\bigr\}

The primal-dual, one-layer and dual networks differ in the matrices.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.networks.base import CompiledRates, Flow
from iiwa_dnn.qp.dense import dot
from iiwa_dnn.qp.layout import Matrix, QPViews, Vector
from iiwa_dnn.qp.program import QP


class Clipped(NamedTuple):
    """A program as such a network of k states has it.

    Attributes:
        matrix: A, (k, k).
        offset: k, (k,).
        lower: Lower limits l of what is projected, in the units of the states, (k,).
        upper: Upper limits u, in the units of the states, (k,).
        outer: O, (k, k).
        kappa: 1 where what is projected is taken off again, else 0.
    """

    matrix: Matrix
    offset: Vector
    lower: Vector
    upper: Vector
    outer: Matrix
    kappa: float = 0.0

    def jacobian(self, state: Vector) -> Matrix:
        """Differentiate the rates at a state (k,), (k, k)."""
        aim = self.matrix @ state + self.offset
        inside = (aim > self.lower) & (aim < self.upper)
        inner = (inside - self.kappa)[:, np.newaxis] * self.matrix - np.eye(state.size)
        result: Matrix = self.outer @ inner
        return result

    def flow(self, qp: QP, step: float, unknowns: Callable[[Vector], Vector] | None = None) -> Flow:
        """Make the flow, with one bound on its stable steps [rho]."""
        constants = np.concatenate(self, axis=None)
        rates = CompiledRates(qp, clipped_rates, constants, self.offset.size)
        return Flow(rates, self.jacobian, unknowns, lambda state: step)


@compiled
def clipped_rates(qp: QPViews, constants: Vector, state: Vector, rates: Vector) -> None:
    """Write the rates (k,); the constants are the numbers of `Clipped` one after the other."""
    size = state.size
    at_offset = size * size
    at_lower = at_offset + size
    at_upper = at_lower + size
    at_outer = at_upper + size
    kappa = constants[constants.size - 1]
    inner = np.empty(size)
    for i in range(size):
        aim = dot(constants, i * size, state, size) + constants[at_offset + i]
        clipped = min(max(aim, constants[at_lower + i]), constants[at_upper + i])
        inner[i] = clipped - state[i] - kappa * aim
    for i in range(size):
        rates[i] = dot(constants, at_outer + i * size, inner, size)
