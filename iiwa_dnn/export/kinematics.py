"""Kinematics of a robot as straight C code, out of Pinocchio's model.

Matrices of sums of products stand for what C computes: Python's operators fold constants and leave
out zeros and ones, and the sums are written entry by entry.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.export.lines import Lines
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Robot

_ROUNDING = 1e-15
"""Distance from 0, 1 or -1 up to which an entry of a rotation is that number."""

Sums = NDArray[np.object_]
"""Array of `Sum`."""


class Sum:
    """Sum of products of C variables.

    Attributes:
        terms: Factor of each product; the empty product is a constant.
    """

    def __init__(self, terms: dict[tuple[str, ...], float]) -> None:
        """Keep the terms that are not zero."""
        self.terms = {names: float(value) for names, value in terms.items() if abs(value) > 0.0}

    def __add__(self, other: Sum) -> Sum:
        terms = dict(self.terms)
        for names, value in other.terms.items():
            terms[names] = terms.get(names, 0.0) + value
        return Sum(terms)

    def __sub__(self, other: Sum) -> Sum:
        return self + Sum({names: -value for names, value in other.terms.items()})

    def __mul__(self, other: Sum) -> Sum:
        total = Sum({})
        for own, value in self.terms.items():
            products = {(*own, *names): value * factor for names, factor in other.terms.items()}
            total = total + Sum(products)
        return total

    @property
    def is_plain(self) -> bool:
        """Test whether the sum is a constant, or a variable with or without a sign."""
        terms = list(self.terms.items())
        if len(terms) != 1:
            return not terms
        names, value = terms[0]
        return not names or (len(names) == 1 and abs(value) == 1.0)

    def __str__(self) -> str:
        text = ""
        for names, value in self.terms.items():
            factors = [*([] if abs(value) == 1.0 and names else [repr(abs(value))]), *names]
            sign = "-" if value < 0.0 else "+"
            product = " * ".join(factors)
            text += f" {sign} {product}" if text else f"{'-' * (sign == '-')}{product}"
        return text or "0.0"


constant: Any = np.frompyfunc(lambda value: Sum({(): value}), 1, 1)
"""Return numbers (any shape) as sums."""


class _Pose(NamedTuple):
    """Orientation (3, 3) and position (3,)."""

    rotation: Sums
    position: Sums

    def moved(self, placement: Any) -> _Pose:
        """Move the pose by a constant placement in its own frame."""
        position = self.position + self.rotation @ constant(placement.translation)
        return _Pose(self.rotation @ constant(_rounded(placement.rotation)), position)


class _Code:
    """Lines of the function, and its variables."""

    def __init__(self) -> None:
        self.lines = Lines()

    def variable(self, name: str, text: str) -> Sum:
        """Declare a variable."""
        self.lines.add(f"const double {name} = {text};", name)
        return Sum({(name,): 1.0})

    def kept(self, name: str, sums: Sums) -> Sums:
        """Keep sums in variables with the axes in their names, but for those that are plain."""
        kept = np.empty_like(sums)
        for index, entry in np.ndenumerate(sums):
            own = name + "".join("xyz"[axis] for axis in index)
            kept[index] = entry if entry.is_plain else self.variable(own, str(entry))
        return kept

    def write(self, array: str, first: int, values: Iterable[Sum]) -> None:
        """Write values into an array, from an index on."""
        for i, value in enumerate(values):
            self.lines.add(f"{array}[{first + i}] = {value};")


def kinematics_code(robot: Robot, frames: Iterable[int], dynamics: bool = False) -> str:
    """Return the C function ``kinematics`` of a robot, as `Kinematics.update` computes it.

    Args:
        robot: The robot, n joints.
        frames: Pinocchio's indices of the frames that are placed.
        dynamics: Whether the inertia matrix is computed too.

    Raises:
        InvalidInputError: A joint neither turns about an axis nor slides along one.
    """
    model = robot.model
    code = _Code()
    poses = [_Pose(constant(np.eye(3)), constant(np.zeros(3)))]
    twists = np.empty((model.njoints, 6), dtype=object)
    for j in range(1, model.njoints):
        base = poses[model.parents[j]].moved(model.jointPlacements[j])
        pose, twists[j] = _joint(code, robot, j, base)
        poses.append(pose)
        code.write("jacobian", 6 * int(model.idx_vs[j]), twists[j])
    for index in sorted(set(frames)):
        frame = model.frames[index]
        placed = poses[frame.parentJoint].moved(frame.placement)
        code.lines.add(f"/* {frame.name} */")
        code.write("placements", 12 * index, [*placed.rotation.T.ravel(), *placed.position])
    if dynamics:
        _add_inertia(code, robot, poses, twists)
    body = "\n".join(code.lines.used()[0])
    result = "joint Jacobian, frames' placements" + " and inertia matrix" * dynamics
    head = "const double *q, double *jacobian, double *placements" + ", double *inertia" * dynamics
    about = f"/* Compute {result}, from the robot's model. */"
    return f"{about}\nstatic void kinematics({head})\n{{\n{body}\n}}"


def _joint(code: _Code, robot: Robot, j: int, base: _Pose) -> tuple[_Pose, Sums]:
    """Write the motion of a joint from its base; return its pose and its twist (6,)."""
    slide, turn = _axis(robot, j)
    at = int(robot.model.idx_vs[j])
    rotation = code.kept(f"B{j}", base.rotation)
    position = code.kept(f"p{j}", base.position)
    if turn.any():
        axis = code.kept(f"w{j}", rotation @ constant(turn))
        moment = code.kept(f"v{j}", np.cross(position, axis))
        turned = code.kept(f"R{j}", rotation @ _turn(code, j, at, turn))
        return _Pose(turned, position), np.append(moment, axis)
    axis = code.kept(f"v{j}", rotation @ constant(slide))
    moved = code.kept(f"s{j}", position + axis * Sum({(f"q[{at}]",): 1.0}))
    return _Pose(rotation, moved), np.append(axis, constant(np.zeros(3)))


def _axis(robot: Robot, j: int) -> tuple[Vector, Vector]:
    """Return the directions along which a joint slides and about which it turns, (3,) each."""
    model = robot.model.joints[j]
    if model.nq != 1 or model.nv != 1:
        problem = f"joint {robot.model.names[j]} is a {model.shortname()}, which is not exported"
        raise InvalidInputError("robot", problem, robot)
    data = model.createData()
    model.calc(data, np.zeros(1), np.zeros(1))
    subspace = _rounded(np.ravel(data.S))
    return subspace[:3], subspace[3:]


def _rounded(matrix: Matrix) -> Matrix:
    """Return a matrix (any shape) whose entries next to 0, 1 and -1 are these."""
    nearest = np.clip(np.round(matrix), -1.0, 1.0)
    result: Matrix = np.where(np.abs(matrix - nearest) < _ROUNDING, nearest, matrix)
    return result


def _turn(code: _Code, j: int, at: int, axis: Vector) -> Sums:
    """Write sine and cosine of a joint, and return the rotation about its axis (3,)."""
    sine = code.variable(f"s{j}", f"sin(q[{at}])")
    cosine = code.variable(f"c{j}", f"cos(q[{at}])")
    across = np.cross(axis, np.eye(3)).T
    along = np.outer(axis, axis)
    turned: Sums = constant(along) + constant(np.eye(3) - along) * cosine + constant(across) * sine
    return turned


def _add_inertia(code: _Code, robot: Robot, poses: list[_Pose], twists: Sums) -> None:
    """Write the inertia matrix by the composite-rigid-body algorithm, about the world's origin.

    Source: R. Featherstone, "Rigid Body Dynamics Algorithms", Springer (2008), chapter 6.
    """
    model = robot.model
    masses = [body.mass for body in model.inertias]
    firsts = []
    seconds = []
    for j, pose in enumerate(poses):
        first, second = _moments(code, j, pose, model.inertias[j])
        firsts.append(first)
        seconds.append(second)
    for j in range(model.njoints - 1, 0, -1):
        first = code.kept(f"h{j}", firsts[j])
        second = _kept_symmetric(code, f"I{j}", seconds[j])
        velocity, turning = np.split(twists[j], 2)
        force = velocity * constant(masses[j]) + np.cross(turning, first)
        torque = second @ turning + np.cross(first, velocity)
        wrench = np.append(code.kept(f"f{j}", force), code.kept(f"n{j}", torque))
        _write_column(code, robot, j, twists, wrench)
        parent = model.parents[j]
        masses[parent] += masses[j]
        firsts[parent] = firsts[parent] + first
        seconds[parent] = seconds[parent] + second


def _moments(code: _Code, j: int, pose: _Pose, body: Any) -> tuple[Sums, Sums]:
    """Write the first (3,) and the second (3, 3) moment of a joint's body about the origin."""
    mass = constant(body.mass)
    center = code.kept(f"g{j}", pose.position + pose.rotation @ constant(body.lever))
    half_turned = code.kept(f"H{j}", pose.rotation @ constant(body.inertia))
    turned = half_turned @ pose.rotation.T
    square = code.kept(f"r{j}", np.array(center @ center, dtype=object))
    shift = constant(np.eye(3)) * square - np.outer(center, center)
    return center * mass, _kept_symmetric(code, f"J{j}", turned + shift * mass)


def _kept_symmetric(code: _Code, name: str, matrix: Sums) -> Sums:
    """Keep the upper half of a symmetric matrix in variables; the lower half is the same."""
    kept = code.kept(name, matrix)
    lower = np.tril_indices(3, -1)
    kept[lower] = kept.T[lower]
    return kept


def _write_column(code: _Code, robot: Robot, j: int, twists: Sums, wrench: Sums) -> None:
    """Write the inertia matrix's entries of a joint and those before it, with their mirror images.

    The wrench (6,) is the one that accelerates all that the joint carries along its own axis.
    """
    model = robot.model
    column = int(model.idx_vs[j])
    for i in range(1, j + 1):
        row = int(model.idx_vs[i])
        moves = i in list(model.supports[j])
        entry = twists[i] @ wrench if moves else Sum({})
        if i == j:
            entry = entry + constant(model.armature[column])
        code.write("inertia", robot.dof * row + column, [entry])
        if i != j:
            copied = Sum({(f"inertia[{robot.dof * row + column}]",): 1.0})
            code.write("inertia", robot.dof * column + row, [copied])
