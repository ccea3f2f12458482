r"""Networks that are affine but for one projection, of which one compiled function evaluates all.

.. math::  \rho\,\dot s = O\,\bigl\{\Pi_{[l,\,u]}(A s + k) - s - \kappa\,(A s + k)\bigr\}

The primal-dual, one-layer and dual networks differ in the matrices, which are set up once a
program (`ClippedNetwork.arrays`).
"""

from abc import abstractmethod
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from iiwa_dnn.networks.base import Flow, Network
from iiwa_dnn.qp.dense import dot
from iiwa_dnn.qp.layout import Matrix, QPViews, Sizes, Vector, compiled
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


@dataclass(frozen=True, kw_only=True)
class ClippedNetwork(Network):
    """The base of the networks that are affine but for one projection.

    A subclass names `clipped_rates` as its `compiled_rates`.
    """

    @abstractmethod
    def arrays(self, qp: QP) -> Clipped:
        """Set a program up."""

    def prepare(self, qp: QP) -> Vector:
        """Return the numbers of the program's `Clipped`, (2 k k + 3 k + 1,)."""
        return _numbers(self, qp.data.tobytes(), qp.sizes)

    def flow(self, qp: QP) -> Flow:
        """Make the right-hand side and its derivative for this program."""
        return Flow(super().flow(qp).rates, lambda state: self._jacobian(qp, state))

    def _jacobian(self, qp: QP, state: Vector) -> Matrix:
        """Differentiate the rates, (k, k)."""
        matrix, offset, lower, upper, outer, kappa = _set_up(self, qp.data.tobytes(), qp.sizes)
        aim = matrix @ state + offset
        inside = (aim > lower) & (aim < upper)
        inner = (inside - kappa)[:, np.newaxis] * matrix
        np.einsum("ii->i", inner)[:] -= 1.0
        result: Matrix = outer @ inner
        return result


@lru_cache(maxsize=4)  # a step of the network asks several times
def _set_up(network: ClippedNetwork, data: bytes, sizes: Sizes) -> Clipped:
    return network.arrays(QP.from_data(np.frombuffer(data), sizes))


@lru_cache(maxsize=4)
def _numbers(network: ClippedNetwork, data: bytes, sizes: Sizes) -> Vector:
    return np.concatenate(_set_up(network, data, sizes), axis=None)
