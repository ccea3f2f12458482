r"""Joint velocity bounds that keep the joint positions inside their limits.

.. math::

    lb = \max(-\dot q_{max},\; \kappa\,(q_{lower} - q)), \qquad
    ub = \min(\dot q_{max},\; \kappa\,(q_{upper} - q))

A joint may approach its limit no faster than exponentially with rate :math:`\kappa`, so in steps
of dt it never passes it as long as :math:`\kappa\,dt \le 1`.

Source: equation (6) of the paper.
"""

from __future__ import annotations

import numpy as np

from iiwa_dnn import kernels
from iiwa_dnn.qp.program import Vector
from iiwa_dnn.robot.configuration import Configuration


def velocity_bounds(conf: Configuration, limit_gain: float) -> tuple[Vector, Vector]:
    """Lower and upper joint velocity bounds at a configuration.

    Outside a limit the paper's formula can ask for more than the velocity limit allows, and then
    has lb > ub. Both bounds are therefore clipped to the velocity limit: the arm comes back as
    fast as it may, and lb <= ub always.

    Args:
        conf: Where the robot is, n joints.
        limit_gain: The paper's kappa [1/s].

    Returns:
        ``(lb, ub)`` [rad/s], each of shape (n,).
    """
    lb, ub = np.empty(conf.q.size), np.empty(conf.q.size)
    kernels.velocity_bounds(conf.q, conf.robot.limits, limit_gain, lb, ub)
    return lb, ub
