"""Kinematics of a robot as a kernel, from tables of its model: an exported controller's own.

At the desk Pinocchio computes the same (`iiwa_dnn.robot.kinematics`), and the tests hold the kernel
to it.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from iiwa_dnn.checks import Array, Matrix
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.trigonometry import sin_cos
from iiwa_dnn.robot.robot import Robot

IntVector = NDArray[np.int64]
IntMatrix = NDArray[np.int64]

CYCLE = (0, 1, 2, 0, 1)
"""Axes, so that those after one are the next two."""


class ModelTables(NamedTuple):
    """Tables of a robot of n joints, each of which turns about its z axis or slides along it.

    Pinocchio's joints with other axes are turned so, with all that they carry. A placement has 12
    numbers: the rotation's columns, then the position [m].

    Attributes:
        parents: For each joint the number of the one that carries it, from 1; 0: the world, (n,).
        joints: Placement of each joint at 0 in the frame of its parent, (n, 12).
        kinds: For each joint 1 and 0 if it slides, 0 and 1 if it turns, (n, 2).
        frames: For each frame its row among the placements, and the joint that carries it, (k, 2).
        offsets: Placement of each frame in its joint's, (k, 12).
        bodies: For what each joint carries the placement of its principal axes, and for each of
            them the root of its mass, then of its moment, (n, 18); none without the inertia matrix.
        supports: 1 where joint j moves body i, else 0, (n, n); none with them.
        armature: Inertia of the motors [kg m^2], (n,).
    """

    parents: IntVector
    joints: Matrix
    kinds: Matrix
    frames: IntMatrix
    offsets: Matrix
    bodies: Matrix
    supports: Matrix
    armature: Array


def model_tables(robot: Robot, frames: Sequence[int], dynamics: bool = False) -> ModelTables:
    """Return the tables of a robot and its frames, by Pinocchio's indices; with bodies if asked."""
    model = robot.model
    moving = range(1, model.njoints)
    axes = np.array([np.reshape(model.joints[j].createData().S, (2, 3)) for j in moving])
    turns = [pin.SE3.Identity(), *map(_turn, axes.sum(axis=1))]
    carriers = [(model.frames[k], turns[model.frames[k].parentJoint]) for k in frames]
    carrying = moving if dynamics else ()
    bodies = [_body(turns[j].actInv(model.inertias[j])) for j in carrying]
    supports = [[float(j in list(model.supports[i])) for j in moving] for i in carrying]
    return ModelTables(
        np.array(model.parents[1:], dtype=np.int64),
        np.array(
            [
                _flat(turns[model.parents[j]].actInv(model.jointPlacements[j] * turns[j]))
                for j in moving
            ]
        ),
        np.asarray(axes.any(axis=2), dtype=np.float64),
        np.array([[k, model.frames[k].parentJoint] for k in frames], dtype=np.int64),
        np.array([_flat(turn.actInv(frame.placement)) for frame, turn in carriers]),
        np.reshape(bodies, (-1, 18)),
        np.reshape(supports, (-1, model.nv)),
        np.array(model.armature),
    )


def _turn(axis: Array) -> pin.SE3:
    """Return a rotation that takes the z axis to an axis (3,)."""
    turn = pin.Quaternion.FromTwoVectors(np.array([0.0, 0.0, 1.0]), axis)
    return pin.SE3(turn.matrix(), np.zeros(3))


def _flat(placement: Any) -> Array:
    """Return Pinocchio's placement as 12 numbers."""
    return np.append(placement.rotation.T, placement.translation)


def _body(body: Any) -> Array:
    """Return a row of `ModelTables.bodies` for Pinocchio's inertia of a body."""
    moments, axes = np.linalg.eigh(body.inertia)
    masses = np.append(np.full(3, body.mass), moments.clip(0.0))
    return np.concatenate([axes.T.ravel(), body.lever, np.sqrt(masses)])


@compiled
def write_kinematics(
    model: ModelTables, q: Array, jacobian: Matrix, placements: Matrix, inertia: Matrix
) -> None:
    """Write the kinematics at joint positions q (n,) [rad or m], as `Kinematics` holds them.

    Args:
        model: The robot's tables.
        q: Joint positions, (n,).
        jacobian: Joint Jacobian, (n, 6), overwritten.
        placements: Frame placements by frame index, (frames, 12): rows of the model's frames.
        inertia: Joint-space inertia matrix [kg m^2], (n, n), overwritten if the model has bodies.
    """
    placed = np.zeros((q.size + 1, 12))
    start = np.empty(12)
    for i in range(3):
        placed[0, 4 * i] = 1.0
    for j in range(q.size):
        compose(placed[model.parents[j]], model.joints[j], start)
        _move(start, model.kinds[j], q[j], placed[j + 1])
        _write_twist(placed[j + 1], 2, model.kinds[j, 0], model.kinds[j, 1], jacobian[j])
    for k in range(len(model.frames)):
        carrier = placed[model.frames[k, 1]]
        compose(carrier, model.offsets[k], placements[model.frames[k, 0]])
    if len(model.bodies) > 0:
        _write_inertia(model, placed, jacobian, inertia)


@compiled
def compose(first: Array, second: Array, product: Array) -> None:
    """Write the product (12,) of two placements (12,)."""
    for k in range(4):
        for i in range(3):
            product[3 * k + i] = (
                first[i] * second[3 * k]
                + first[3 + i] * second[3 * k + 1]
                + first[6 + i] * second[3 * k + 2]
            )
    for i in range(3):
        product[9 + i] += first[9 + i]


@compiled
def _move(start: Array, kind: Array, q: float, moved: Array) -> None:
    """Write the placement (12,) at position q of a joint of a kind (2,) from that at 0, (12,)."""
    sine, cosine = sin_cos(kind[1] * q)
    for i in range(3):
        moved[i] = start[i] * cosine + start[3 + i] * sine
        moved[3 + i] = start[3 + i] * cosine - start[i] * sine
        moved[6 + i] = start[6 + i]
        moved[9 + i] = start[9 + i] + start[6 + i] * (kind[0] * q)


@compiled
def _write_twist(placement: Array, axis: int, slides: float, turns: float, twist: Array) -> None:
    """Write the twist (6,) about the world's origin of sliding along and turning about an axis.

    The axis is one of a placement (12,), by its number.
    """
    direction = placement[3 * axis : 3 * axis + 3]
    position = placement[9:]
    for i in range(3):
        twist[3 + i] = turns * direction[i]
        moment = position[CYCLE[i + 1]] * direction[CYCLE[i + 2]]
        moment -= position[CYCLE[i + 2]] * direction[CYCLE[i + 1]]
        twist[i] = slides * direction[i] + turns * moment


@compiled
def _write_inertia(model: ModelTables, placed: Matrix, jacobian: Matrix, inertia: Matrix) -> None:
    """Write the inertia matrix (n, n) out of the joints' placements (n + 1, 12) and twists (n, 6).

    Each body adds the products of its joints' velocities along and about its principal axes, times
    mass and moments. No joint after the body's own moves it.
    """
    n = len(inertia)
    own = np.empty(12)
    line = np.empty(6)
    speeds = np.empty(n)
    for i in range(n):
        for j in range(n):
            inertia[i, j] = model.armature[i] if i == j else 0.0
    for body in range(n):
        compose(placed[body + 1], model.bodies[body, :12], own)
        for k in range(6):
            along = 1.0 if k < 3 else 0.0
            _write_twist(own, k % 3, 1.0 - along, along, line)
            for j in range(body + 1):
                speed = 0.0
                for i in range(3):
                    speed += line[3 + i] * jacobian[j, i] + line[i] * jacobian[j, 3 + i]
                speeds[j] = model.supports[body, j] * model.bodies[body, 12 + k] * speed
            for i in range(body + 1):
                for j in range(body + 1):
                    inertia[i, j] += speeds[i] * speeds[j]
