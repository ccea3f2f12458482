"""Start postures of arms without a known one."""

import numpy as np
import pinocchio as pin

from iiwa_dnn.checks import Array

_TESTED = 20
"""Postures that are tested for their surroundings and for collisions, the best ones."""

_AWAY = 0.1
"""Distance of the surroundings, in reaches."""

_ZERO = 1e-6
"""Ratio to the largest singular value below which one is zero."""


def best_start(
    model: pin.Model, tip_id: int, reach: float, shapes: pin.GeometryModel, postures: Array
) -> Array:
    """Choose the posture out of (k, n) [rad] that is farthest from singular ones, (n,).

    The measure of a posture is the least singular value of the tip's Jacobian, among those that are
    not zero in all postures; rows of rotation are multiplied by the robot's reach, or left out if
    there are fewer than six joints. The `_TESTED` postures with the largest measure are ordered by
    the number of pairs of collision shapes that meet, without pairs that meet in all of them, then
    by the least measure a tenth of the reach away along each axis.

    Source: C. A. Klein, B. E. Blaho, "Dexterity measures for the design and control of
    kinematically redundant manipulators", Int. J. Robotics Research 6(2), 1987.

    Args:
        model: The Pinocchio model of n joints.
        tip_id: Index of the tip's frame.
        reach: Distance of the tip from the base at most [m]; of no use if 0 or infinite.
        shapes: Collision shapes; none where they are not known.
        postures: The postures.
    """
    reach = reach if 0.0 < reach < np.inf else 1.0
    jacobians = _jacobians(model, tip_id, postures, reach)
    values = np.linalg.svd(jacobians, compute_uv=False)
    least = (values > _ZERO * values.max()).sum(axis=1).max() - 1
    order = np.argsort(-values[:, least], kind="stable")[:_TESTED]
    best = postures[order]
    steps = _AWAY * reach * np.linalg.pinv(jacobians[order], _ZERO)[:, :, :3].transpose(0, 2, 1)
    around = best[:, np.newaxis] + np.concatenate([steps, -steps], axis=1)
    jacobians = _jacobians(model, tip_id, around.reshape(-1, model.nv), reach)
    values = np.linalg.svd(jacobians, compute_uv=False)[:, least].reshape(len(best), -1)
    order = np.lexsort([-values.min(axis=1), _count_collisions(model, shapes, best)])
    return np.array(best[order[0]])


def _jacobians(model: pin.Model, tip_id: int, postures: Array, reach: float) -> Array:
    """Compute the tip's Jacobians (k, 6, n) with the rows of rotation times the reach [m], or 0."""
    data = model.createData()
    at_tip = (tip_id, pin.LOCAL_WORLD_ALIGNED)
    found = [pin.computeFrameJacobian(model, data, q, *at_tip) for q in postures]
    units = np.repeat([1.0, reach if model.nv >= 6 else 0.0], 3)[:, np.newaxis]
    return np.asarray(units * np.reshape(found, (-1, 6, model.nv)))


def _count_collisions(model: pin.Model, shapes: pin.GeometryModel, postures: Array) -> Array:
    """Count the pairs of collision shapes that meet at each posture (k, n), (k,).

    Pairs that meet at all postures are left out.
    """
    geometry = shapes.copy()
    geometry.addAllCollisionPairs()
    data = model.createData()
    scratch = pin.GeometryData(geometry)
    meet = np.zeros((len(postures), len(geometry.collisionPairs)), dtype=bool)
    for row, q in zip(meet, postures, strict=True):
        pin.computeCollisions(model, data, geometry, scratch, q, False)
        row[:] = [result.isCollision() for result in scratch.collisionResults]
    return np.asarray((meet & ~meet.all(axis=0)).sum(axis=1))
