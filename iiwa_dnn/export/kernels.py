"""Kernels that an exported controller alone needs."""

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp import Matrix, Vector


@compiled
def move_centers(constants: Vector, centers: Matrix, t: float) -> None:
    """Write the centres of moving obstacles at time t [s] into the constants (k,) of all parts.

    Each row of the centers (obstacles, 7) has the first of a centre's indices, the centre at time 0
    [m], and its velocity [m/s].
    """
    for k in range(len(centers)):
        first = int(centers[k, 0])
        for i in range(3):
            constants[first + i] = centers[k, 1 + i] + t * centers[k, 4 + i]
