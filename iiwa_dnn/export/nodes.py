"""Write arrays of a plan as C variables that are initialised by names of fields, or as JSON.

Beside each limit, gain and capsule stands its joint or link, from the docstrings its meaning.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from enum import IntEnum
from inspect import cleandoc
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from iiwa_dnn.compiling.expressions import number
from iiwa_dnn.compiling.kinds import attributes, commented
from iiwa_dnn.compiling.records import Record
from iiwa_dnn.qp import Vector
from iiwa_dnn.references import Reference
from iiwa_dnn.references.targets import TargetData
from iiwa_dnn.robot.kinematics import Placement
from iiwa_dnn.robot.kinematics_kernel import ModelTables, PrincipalAxes
from iiwa_dnn.robot.robot import Robot
from iiwa_dnn.schemes.collisions import CollisionAvoidance
from iiwa_dnn.schemes.layout import ProgramLayout
from iiwa_dnn.schemes.parts import Part
from iiwa_dnn.schemes.program import BlockKind, Column
from iiwa_dnn.schemes.scene import Body, Pair, SceneViews, scene_views

Labels = Mapping[str, Sequence[str]]
"""Comments on the elements of an array, by its name in a named tuple or its size in a record."""

SHORT = 100
"""Longest initializer that stays on one line."""

_ROWS: dict[tuple[type, str], type[Record]] = {
    (ModelTables, "joints"): Placement,
    (ModelTables, "offsets"): Placement,
    (ModelTables, "bodies"): PrincipalAxes,
    (SceneViews, "bodies"): Body,
    (SceneViews, "pairs"): Pair,
}
"""Records in the rows of the matrices of named tuples."""


class PartNumber(int):
    """Number of a part, which C and JSON name.

    Attributes:
        name: Name of the part.
        text: The number in C.
    """

    name: str
    text: str

    @classmethod
    def of(cls, number: int, name: str, text: str) -> PartNumber:
        """Make one from its number, its name and its text in C."""
        own = cls(number)
        own.name = name
        own.text = text
        return own


class Node(NamedTuple):
    """Value of C: a struct, an array or a number.

    Attributes:
        value: A dictionary of nodes by members' names, a list of nodes, or a number.
        labels: Comments on the elements of an array, or none.
        about: Comments on the members of a struct by their names; on the struct by an empty name.
    """

    value: Any
    labels: Sequence[str] = ()
    about: Mapping[str, str] = MappingProxyType({})

    @classmethod
    def of(cls, own: Any, labels: Labels, key: str = "") -> Node:
        """Make a node of a record, a named tuple, an array of numbers or records, or a number.

        Args:
            own: The record, named tuple, array or number.
            labels: Comments on the elements of arrays.
            key: Name by which `labels` has those of `own`, if it is an array.
        """
        if isinstance(own, tuple) or (isinstance(own, Record) and own.ndim == 1):
            return cls.struct(own, labels)
        if isinstance(own, np.ndarray):
            elements: Any = own if isinstance(own, Record) else own.tolist()
            return cls([cls.of(each, labels) for each in elements], labels.get(key, ()))
        if isinstance(own, list):
            return cls([cls.of(each, labels) for each in own])
        return cls(own)

    @classmethod
    def struct(cls, own: Any, labels: Labels) -> Node:
        """Make a node of a record or a named tuple, without members that have no numbers."""
        if isinstance(own, Record):
            keys = {name: str(shape[0]) if shape else "" for name, shape in own.members.items()}
        else:
            keys = {name: name for name in own._fields}
        items = {name: rows_of(own, name) for name in keys}
        inner = {k: cls.of(each, labels, keys[k]) for k, each in items.items() if np.size(each)}
        return cls(inner, about=about_members(type(own)))

    def declaration(self, name: str, kind: str) -> str:
        """Declare the node as a variable or member of C; `kind` is the C type of its numbers."""
        if isinstance(self.value, list):
            first: Node = self.value[0]
            return first.declaration(f"{name}[{len(self.value)}]", kind)
        if not isinstance(self.value, dict):
            return f"{kind} {name}"
        lines = [
            commented(own.declaration(member, kind), self.about.get(member) or own.sentence)
            for member, own in self.value.items()
        ]
        return f"struct {_block(lines)} {name}"

    @property
    def sentence(self) -> str:
        """Comment on the struct, or on the structs of an array; else ""."""
        if isinstance(self.value, list):
            first: Node = self.value[0]
            return first.sentence
        return self.about.get("", "")

    @property
    def plain(self) -> Any:
        """Value for JSON: parts by their names, infinities as words."""
        if isinstance(self.value, dict):
            return {name: own.plain for name, own in self.value.items()}
        if isinstance(self.value, list):
            return [own.plain for own in self.value]
        if isinstance(self.value, PartNumber):
            return self.value.name
        is_number = isinstance(self.value, int) or np.isfinite(self.value)
        return self.value if is_number else str(self.value)

    def initializer(self) -> str:
        """Write the C initializer; long structs and labelled arrays have a line for each item."""
        if isinstance(self.value, dict):
            items = [f".{name} = {own.initializer()}" for name, own in self.value.items()]
        elif isinstance(self.value, list):
            items = [own.initializer() for own in self.value]
        else:
            return constant(self.value)
        is_flat = isinstance(self.value, list) and not isinstance(self.value[0].value, list | dict)
        if is_flat and not self.labels:
            return f"{{{', '.join(items)}}}"
        return braced(items, self.labels)


def braced(items: Sequence[str], labels: Sequence[str] = ()) -> str:
    """Write initializers between braces, each on a line if they are long or have comments."""
    whole = f"{{{', '.join(items)}}}"
    if not labels and "\n" not in whole and len(whole) < SHORT:
        return whole
    comments = [f"/* {label} */ " for label in labels] or [""] * len(items)
    lines = [f"{comment}{item}," for comment, item in zip(comments, items, strict=True)]
    return _block(lines)


def _block(lines: Sequence[str]) -> str:
    """Write lines between braces, and indent them."""
    return "\n".join(["{", *lines]).replace("\n", "\n    ") + "\n}"


def constant(own: float) -> str:
    """Write a number in C; behind a member of an enumeration stands its name as a comment."""
    if isinstance(own, PartNumber):
        return own.text
    return number(own).text + (f" /* {own.name} */" if isinstance(own, IntEnum) else "")


def about_members(own: type) -> dict[str, str]:
    """Read the docstring of a class: by an empty name its first line, then attributes."""
    text = cleandoc(own.__doc__ or "")
    return {"": text.partition("\n")[0], **attributes(text)}


def rows_of(own: Any, name: str) -> Any:
    """Return a member of a named tuple or a record; a matrix of records as an array of those."""
    kind = _ROWS.get((type(own), name))
    return kind.of(getattr(own, name)) if kind else getattr(own, name)


def table_node(rows: Sequence[Sequence[int]], columns: type[IntEnum]) -> Node:
    """Make a node of a table whose rows are structs, by the names of its columns."""
    about = {name.lower(): text for name, text in about_members(columns).items()}
    nodes = []
    for row in rows:
        members = {own.name.lower(): Node(row[own]) for own in columns}
        if columns is Column:
            members["kind"] = Node(BlockKind(row[Column.KIND]))
        nodes.append(Node(members, about=about))
    return Node(nodes)


def robot_labels(robot: Robot, frames: Sequence[int]) -> Labels:
    """Return comments with the names of joints and frames; `frames` are those of the kinematics."""
    names = [frame.name for frame in robot.model.frames]
    of_joints = ("n", "parents", "joints", "slides", "armature", "lower", "upper")
    of_frames = ("frames", "carriers", "offsets")
    labels: dict[str, Sequence[str]] = dict.fromkeys(of_joints, robot.joint_names)
    return labels | dict.fromkeys(of_frames, tuple(names[k] for k in frames)) | {"support": names}


def part_constants(part: Part, robot: Robot, numbers: Vector, labels: Labels) -> Node:
    """Make a node of the constants of a part, (k,), by their names."""
    if isinstance(part, CollisionAvoidance):
        scene = scene_views(numbers)
        frames = robot.model.frames
        pairs = part.scene(robot).pairs
        bodies = [frames[Body.of(body).frame].name for body in scene.bodies]
        for row, both in zip(scene.pairs, pairs, strict=True):
            pair = Pair.of(row)
            bodies[pair.first], bodies[pair.second] = both
        words = [" and ".join(both) for both in pairs]
        return Node.of(scene, {**labels, "bodies": bodies, "pairs": words})
    made = part.constants(robot)
    return Node.of(
        type(made).of(numbers, *made.sizes) if isinstance(made, Record) else numbers, labels
    )


def program_constants(program: ProgramLayout, labels: Labels) -> Node:
    """Make a node of the constants of all parts of a program, by the parts' names."""
    found: dict[str, Node] = {}
    for k, part in enumerate(program.parts):
        name = _member(part, found)
        numbers = program.constants_of(k)
        if numbers.size:
            found[name] = part_constants(part, program.robot, numbers, labels)
        if program.table[k, Column.KIND] == BlockKind.SOFT_TASK:
            found[f"{name}_weight"] = Node(float(program.constants[program.table[k, Column.STOP]]))
    return Node(found)


def path_constants(paths: Sequence[Reference], labels: Labels) -> Node:
    """Make a node of the base and the constants of paths, by the paths' names."""
    found: dict[str, Node] = {}
    for path in paths:
        name = _member(path, found)
        found[f"{name}_base"] = Node.of(TargetData.of(path.base), labels)
        if path.constants.size:
            found[name] = Node.of(path.constants, labels)
    return Node(found)


def _member(part: object, others: Mapping[str, Any]) -> str:
    """Return a member's name: that of an object's class, with a number if `others` have it."""
    name = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", type(part).__name__).lower().strip("_")
    count = sum(re.fullmatch(rf"{name}(_\d+)?", other) is not None for other in others)
    return f"{name}_{1 + count}" if count else name
