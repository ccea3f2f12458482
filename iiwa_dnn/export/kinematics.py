"""Kinematics of a robot as straight C code, out of Pinocchio's model.

Each joint's placement is a product of its parent's, of a constant one and of the joint's own
motion, written entry by entry: constants are folded, and zeros and ones are left out.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.export.lines import Lines
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Robot

_ROUNDING = 1e-15
"""Distance from 0, 1 or -1 up to which an entry of a rotation is that number."""

Sum = dict[tuple[str, ...], float]
"""Sum of products of C variables, each with a factor; the empty product is a constant."""

Rows = list[list[Sum]]
"""Matrix or, with one column, vector of sums."""


class _Pose(NamedTuple):
    """Orientation (3, 3) and position (3, 1)."""

    rotation: Rows
    position: Rows


class _Code:
    """Lines of the function, and its variables."""

    def __init__(self) -> None:
        self.lines = Lines()

    def variable(self, name: str, text: str) -> None:
        """Declare a variable."""
        self.lines.add(f"const double {name} = {text};", name)

    def variables(self, name: str, matrix: Rows) -> Rows:
        """Keep the entries of a matrix in variables, but for those that are one already."""
        return [
            [
                self._kept(f"{name}{axis}{k if len(row) > 1 else ''}", row[k])
                for k in range(len(row))
            ]
            for axis, row in zip("xyz", matrix, strict=True)
        ]

    def _kept(self, name: str, entry: Sum) -> Sum:
        factors = [*entry, ()]
        if len(entry) < 2 and (
            not factors[0] or (factors[0][1:] == () and abs(entry[factors[0]]) == 1.0)
        ):
            return entry
        self.variable(name, _text(entry))
        return {(name,): 1.0}


def kinematics_code(robot: Robot, frames: Iterable[int]) -> str:
    """Return the C function ``kinematics`` of a robot, as `Kinematics.update` computes it.

    Args:
        robot: The robot, n joints.
        frames: Pinocchio's indices of the frames that are placed.

    Raises:
        InvalidInputError: A joint neither turns about an axis nor slides along one.
    """
    model = robot.model
    code = _Code()
    origin = _Pose(_constant(np.eye(3)), _constant(np.zeros((3, 1))))
    poses = [origin]
    for j in range(1, model.njoints):
        fixed = model.jointPlacements[j]
        parent = poses[model.parents[j]]
        base = _moved(parent, fixed.rotation, fixed.translation)
        base = _Pose(code.variables(f"B{j}", base.rotation), code.variables(f"p{j}", base.position))
        poses.append(_joint(code, robot, j, base))
    for index in sorted(set(frames)):
        frame = model.frames[index]
        placed = _moved(
            poses[frame.parentJoint], frame.placement.rotation, frame.placement.translation
        )
        code.lines.add(f"/* {frame.name} */")
        for k in range(3):
            for i in range(3):
                text = _text(placed.rotation[i][k])
                code.lines.add(f"placements[{12 * index + 3 * k + i}] = {text};")
        for i in range(3):
            text = _text(placed.position[i][0])
            code.lines.add(f"placements[{12 * index + 9 + i}] = {text};")
    body = "\n".join(code.lines.used()[0])
    about = "/* Compute the joint Jacobian and the frames' placements, from the robot's model. */"
    head = "static void kinematics(const double *q, double *jacobian, double *placements)"
    return f"{about}\n{head}\n{{\n{body}\n}}"


def _joint(code: _Code, robot: Robot, j: int, base: _Pose) -> _Pose:
    """Write the motion of a joint; return its pose."""
    slide, turn = _axis(robot, j)
    at = int(robot.model.idx_vs[j])
    if turn.any():
        axis = code.variables(f"w{j}", _product(base.rotation, _constant(turn[:, None])))
        moment = _cross(base.position, axis)
        _write_row(code, at, [*moment, *axis])
        turned = _product(base.rotation, _turn(code, j, at, turn))
        return _Pose(code.variables(f"R{j}", turned), base.position)
    axis = code.variables(f"v{j}", _product(base.rotation, _constant(slide[:, None])))
    _write_row(code, at, [*axis, *_constant(np.zeros((3, 1)))])
    moved = [
        [_added(base.position[i][0], _times(axis[i][0], {(f"q[{at}]",): 1.0}))] for i in range(3)
    ]
    return _Pose(base.rotation, code.variables(f"s{j}", moved))


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


def _turn(code: _Code, j: int, at: int, axis: Vector) -> Rows:
    """Write sine and cosine of a joint, and return the rotation about its axis (3,)."""
    code.variable(f"s{j}", f"sin(q[{at}])")
    code.variable(f"c{j}", f"cos(q[{at}])")
    x, y, z = axis
    across = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    along = np.outer(axis, axis)
    rest = np.eye(3) - along
    return [
        [
            _sum({(): along[i, k], (f"c{j}",): rest[i, k], (f"s{j}",): across[i, k]})
            for k in range(3)
        ]
        for i in range(3)
    ]


def _write_row(code: _Code, at: int, row: Rows) -> None:
    for i, entry in enumerate(row):
        code.lines.add(f"jacobian[{6 * at + i}] = {_text(entry[0])};")


def _moved(pose: _Pose, rotation: Matrix, translation: Vector) -> _Pose:
    """Move a pose by a constant one in its own frame."""
    turned = _product(pose.rotation, _constant(_rounded(rotation)))
    shift = _product(pose.rotation, _constant(translation[:, None]))
    position = [[_added(pose.position[i][0], shift[i][0])] for i in range(3)]
    return _Pose(turned, position)


def _rounded(matrix: Matrix) -> Matrix:
    """Return a matrix (any shape) whose entries next to 0, 1 and -1 are these."""
    nearest = np.clip(np.round(matrix), -1.0, 1.0)
    result: Matrix = np.where(np.abs(matrix - nearest) < _ROUNDING, nearest, matrix)
    return result


def _constant(matrix: Matrix) -> Rows:
    return [[_sum({(): float(value)}) for value in row] for row in matrix]


def _sum(terms: Sum) -> Sum:
    """Return a sum without its zeros."""
    return {factors: float(value) for factors, value in terms.items() if abs(value) > 0.0}


def _added(a: Sum, b: Sum, factor: float = 1.0) -> Sum:
    """Return a + factor b."""
    result = dict(a)
    for factors, value in b.items():
        result[factors] = result.get(factors, 0.0) + factor * value
    return _sum(result)


def _times(a: Sum, b: Sum) -> Sum:
    result: Sum = {}
    for own, value in a.items():
        for other, factor in b.items():
            result = _added(result, {(*own, *other): value * factor})
    return result


def _product(a: Rows, b: Rows) -> Rows:
    """Return the product of two matrices."""
    result: Rows = []
    for row in a:
        result.append([])
        for k in range(len(b[0])):
            entry: Sum = {}
            for i, factor in enumerate(row):
                entry = _added(entry, _times(factor, b[i][k]))
            result[-1].append(entry)
    return result


def _cross(a: Rows, b: Rows) -> Rows:
    """Return the cross product of two vectors."""
    result: Rows = []
    for i in range(3):
        j = (i + 1) % 3
        k = (i + 2) % 3
        result.append([_added(_times(a[j][0], b[k][0]), _times(a[k][0], b[j][0]), -1.0)])
    return result


def _text(entry: Sum) -> str:
    """Write a sum in C."""
    text = ""
    for factors, value in entry.items():
        parts = [*([] if abs(value) == 1.0 and factors else [repr(abs(value))]), *factors]
        sign = "-" if value < 0.0 else "+"
        product = " * ".join(parts)
        text += f" {sign} {product}" if text else f"{'-' * (sign == '-')}{product}"
    return text or "0.0"
