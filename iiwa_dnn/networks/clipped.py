r"""Networks that are affine but for one projection.

.. math::  \rho\,\dot s = O\,\bigl\{\Pi_{[l,\,u]}(A s + k) - s - \kappa\,(A s + k)\bigr\}

The primal-dual, one-layer and dual networks differ in the matrices.
"""

from typing import NamedTuple

import numpy as np

from iiwa_dnn.qp.layout import Matrix, Vector


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

    def rates(self, state: Vector) -> Vector:
        """Evaluate the rates at a state, (k,) both."""
        aim = self.matrix @ state + self.offset
        clipped = np.minimum(np.maximum(aim, self.lower), self.upper)
        result: Vector = self.outer @ (clipped - state - self.kappa * aim)
        return result

    def jacobian(self, state: Vector) -> Matrix:
        """Differentiate the rates at a state (k,), (k, k)."""
        aim = self.matrix @ state + self.offset
        inside = (aim > self.lower) & (aim < self.upper)
        inner = (inside - self.kappa)[:, np.newaxis] * self.matrix - np.eye(state.size)
        result: Matrix = self.outer @ inner
        return result
