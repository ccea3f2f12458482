"""Kinematics of a robot as a kernel over tables of its model, for exported C and `Shields`.

Elsewhere Pinocchio computes them (`iiwa_dnn.robot.kinematics`); tests compare both.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from iiwa_dnn.checks import Array, Matrix
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.compiling.trigonometry import sin_cos
from iiwa_dnn.robot.kinematics import Placement, Twist
from iiwa_dnn.robot.robot import Robot

IntVector = NDArray[np.int64]

AXIS = 2
"""Axis that a joint turns about or slides along: z."""

CYCLE = (0, 1, 2, 0, 1)
"""Axes, so that those after one are the next two."""


class PrincipalAxes(Record):
    """Placement of a body's principal axes in the frame of its joint, and roots of its inertia.

    `roots` are the square root of the mass, three times, and those of the principal moments.
    """

    placement: Placement = part(Placement)
    roots: Array = part(6)


class ModelTables(NamedTuple):
    """Tables of a robot of n joints, each of which turns about its z axis or slides along it.

    Pinocchio's joints with other axes are turned so, with all that they carry.

    Attributes:
        parents: For each joint the number of the one that carries it, from 1; 0: the world, (n,).
        joints: `Placement` of each joint at 0 in the frame of its parent, (n, 12).
        slides: 1 for a joint that slides, 0 for one that turns, (n,).
        frames: For each frame its row among the placements, (k,).
        carriers: For each frame the joint that carries it, (k,).
        offsets: `Placement` of each frame in its joint's, (k, 12).
        bodies: `PrincipalAxes` of what each joint carries, (n, 18); none without the inertia
            matrix.
        supports: 1 where joint j moves body i, else 0, (n, n); none with them.
        armature: Inertia of the motors [kg m^2], (n,).
    """

    parents: IntVector
    joints: Matrix
    slides: Array
    frames: IntVector
    carriers: IntVector
    offsets: Matrix
    bodies: Matrix
    supports: Matrix
    armature: Array


def model_tables(robot: Robot, frames: Sequence[int], dynamics: bool = False) -> ModelTables:
    """Return the tables of a robot and its frames, by Pinocchio's indices.

    Tables of the bodies are empty without `dynamics`.
    """
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
        np.asarray(axes[:, 0].any(axis=1), dtype=np.float64),
        np.array(frames, dtype=np.int64),
        np.array([model.frames[k].parentJoint for k in frames], dtype=np.int64),
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
        placements: Frame placements by frame index, (frames, 12); the rows of `model.frames` are
            overwritten.
        inertia: Joint-space inertia matrix [kg m^2], (n, n), overwritten if the model has bodies.
    """
    placed = np.zeros((q.size + 1, Placement.width()))
    world = Placement.of(placed[0])
    for i in range(3):
        world.axes[i, i] = 1.0
    start = Placement.of(np.empty(Placement.width()))
    for j in range(q.size):
        slides = model.slides[j]
        here = Placement.of(placed[j + 1])
        compose(Placement.of(placed[model.parents[j]]), Placement.of(model.joints[j]), start)
        _move(start, slides, q[j], here)
        _write_twist(here, AXIS, slides, Twist.of(jacobian[j]))
    for k in range(model.frames.size):
        carrier = Placement.of(placed[model.carriers[k]])
        frame = Placement.of(placements[model.frames[k]])
        compose(carrier, Placement.of(model.offsets[k]), frame)
    if len(model.bodies) > 0:
        _write_inertia(model, placed, jacobian, inertia)


@compiled
def compose(first: Placement, second: Placement, product: Placement) -> None:
    """Write the product of two placements."""
    for k in range(3):
        _turn_into(first.axes, second.axes[k], product.axes[k])
    _turn_into(first.axes, second.position, product.position)
    for i in range(3):
        product.position[i] += first.position[i]


@compiled
def _turn_into(axes: Matrix, v: Array, turned: Array) -> None:
    """Write a vector (3,), given along the axes of a frame (3, 3), along the world's."""
    for i in range(3):
        turned[i] = axes[0, i] * v[0] + axes[1, i] * v[1] + axes[2, i] * v[2]


@compiled
def _move(start: Placement, slides: float, q: float, moved: Placement) -> None:
    """Write the placement of a joint at position q, out of that at 0."""
    sine, cosine = sin_cos((1.0 - slides) * q)
    for i in range(3):
        x = start.axes[0, i]
        y = start.axes[1, i]
        z = start.axes[2, i]
        moved.axes[0, i] = x * cosine + y * sine
        moved.axes[1, i] = y * cosine - x * sine
        moved.axes[2, i] = z
        moved.position[i] = start.position[i] + z * (slides * q)


@compiled
def _write_twist(placement: Placement, axis: int, slides: float, twist: Twist) -> None:
    """Write the twist about the world's origin of sliding along (1) or turning about (0) an axis.

    The axis is one of a placement, by its number.
    """
    turns = 1.0 - slides
    direction = placement.axes[axis]
    position = placement.position
    for i in range(3):
        twist.angular[i] = turns * direction[i]
        moment = position[CYCLE[i + 1]] * direction[CYCLE[i + 2]]
        moment -= position[CYCLE[i + 2]] * direction[CYCLE[i + 1]]
        twist.linear[i] = slides * direction[i] + turns * moment


@compiled
def _write_inertia(model: ModelTables, placed: Matrix, jacobian: Matrix, inertia: Matrix) -> None:
    """Write the inertia matrix (n, n) out of the joints' placements (n + 1, 12) and twists (n, 6).

    Each body adds the products of its joints' velocities along and about its principal axes, times
    mass and moments. No joint after the body's own moves it.
    """
    n = len(inertia)
    own = Placement.of(np.empty(Placement.width()))
    line = Twist.of(np.empty(Twist.width()))
    speeds = np.empty(n)
    for i in range(n):
        for j in range(n):
            inertia[i, j] = model.armature[i] if i == j else 0.0
    for body in range(n):
        principal = PrincipalAxes.of(model.bodies[body])
        compose(Placement.of(placed[body + 1]), principal.placement, own)
        for k in range(principal.roots.size):
            along = 1.0 if k < 3 else 0.0
            _write_twist(own, k % 3, 1.0 - along, line)
            for j in range(body + 1):
                twist = Twist.of(jacobian[j])
                speed = 0.0
                for i in range(3):
                    speed += line.angular[i] * twist.linear[i] + line.linear[i] * twist.angular[i]
                speeds[j] = model.supports[body, j] * principal.roots[k] * speed
            for i in range(body + 1):
                for j in range(body + 1):
                    inertia[i, j] += speeds[i] * speeds[j]
