"""Write a plan as flat arrays of numbers and integers, in the order in which the core reads them.

Beside the arrays stand trees of names: what each number is, as C and JSON have it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from enum import IntEnum
from typing import Any

import numpy as np

from iiwa_dnn.compiling.kinds import BOOL, FLOAT, Kind
from iiwa_dnn.export.core import WRITTEN
from iiwa_dnn.export.nodes import Labels, Node, PartNumber, about_members, rows_of, table_node
from iiwa_dnn.networks.integrators.base import CompiledAnswer
from iiwa_dnn.schemes.program import Column, ProgramArrays
from iiwa_dnn.step.plan import PathColumn, Paths

ADDRESSES: dict[tuple[type, str], type[IntEnum] | None] = {
    (CompiledAnswer, "address"): None,
    (CompiledAnswer, "rates"): None,
    (ProgramArrays, "table"): Column,
    (Paths, "table"): PathColumn,
}
"""Members of named tuples that are addresses of parts; or tables, with their columns."""


class Flat:
    """Numbers and integers of a plan.

    Attributes:
        numbers: The floats.
        integers: Sizes, integers and truth values; parts are `PartNumber`.
        named: Names of the floats.
        worded: Names of the integers.
    """

    def __init__(
        self,
        part: Callable[[int], int],
        nodes: Mapping[tuple[type, str], Node],
        labels: Labels,
    ) -> None:
        """Begin without numbers.

        Args:
            part: Function that returns the part at an address.
            nodes: Nodes of arrays by the types of their named tuples and their members' names.
            labels: Comments on the elements of arrays.
        """
        self._part = part
        self._nodes = nodes
        self._labels = labels
        self.numbers: list[float] = []
        self.integers: list[int] = []
        self.named: dict[str, Node] = {}
        self.worded: dict[str, Node] = {}

    @property
    def parts(self) -> list[int]:
        """Places of the integers that are parts."""
        return [k for k, own in enumerate(self.integers) if isinstance(own, PartNumber)]

    def add(self, name: str, kind: Kind, own: Any) -> None:
        """Add a named tuple by a name."""
        self._keep(name, self._tuple(kind, own), self.named, self.worded)

    def add_numbers(self, name: str, numbers: np.ndarray[Any, Any]) -> None:
        """Add an array of floats of which no shape is read."""
        self.numbers += numbers.ravel().tolist()
        self._keep(name, (Node.of(numbers, {}) if numbers.size else None, None), self.named, {})

    @staticmethod
    def _keep(
        name: str,
        both: tuple[Node | None, Node | None],
        named: dict[str, Node],
        worded: dict[str, Node],
    ) -> None:
        """Keep the nodes of a member, by its name, that there are."""
        for found, place in zip(both, (named, worded), strict=True):
            if found is not None:
                place[name] = found

    def _tuple(self, kind: Kind, own: Any) -> tuple[Node | None, Node | None]:
        """Add a named tuple; return the nodes of its floats and of its integers."""
        named: dict[str, Node] = {}
        worded: dict[str, Node] = {}
        for name, member in kind.members.items():
            self._keep(name, self._member(own, name, member), named, worded)
        about = about_members(type(own))
        return (
            Node(named, about=about) if named else None,
            Node(worded, about=about) if worded else None,
        )

    def _member(self, owner: Any, name: str, kind: Kind) -> tuple[Node | None, Node | None]:
        """Add a member of a named tuple; return its nodes."""
        own = getattr(owner, name)
        columns = ADDRESSES.get((type(owner), name), int)
        if kind.sizes:
            self.integers += own.sizes
            self.numbers += own.numbers.tolist()
            sizes = {size: Node(int(n)) for size, n in zip(own.names, own.sizes, strict=True)}
            found = Node.of(own, self._labels) if own.size else None
            return found, Node(sizes) if sizes else None
        if kind.axes:
            return self._array(owner, name, kind, columns)
        if kind.members:
            return self._tuple(kind, own)
        if kind is FLOAT:
            self.numbers.append(float(own))
            return Node(float(own)), None
        number = self._part(own) if columns is None else bool(own) if kind is BOOL else int(own)
        self.integers.append(number)
        return None, Node(number)

    def _array(
        self, owner: Any, name: str, kind: Kind, columns: Any
    ) -> tuple[Node | None, Node | None]:
        """Add the shape and the elements of an array."""
        own = getattr(owner, name)
        shape = {"shape": Node([Node(size) for size in own.shape])}
        self.integers += own.shape
        found = self._nodes.get((type(owner), name))
        if name in WRITTEN or not own.size:
            return None, Node(shape)
        if kind.element is FLOAT:
            self.numbers += own.ravel().tolist()
            return found or Node.of(rows_of(owner, name), self._labels, name), Node(shape)
        rows = own.tolist()
        if columns is int:
            shape["data"] = found or Node.of(rows, self._labels, name)
        else:
            self._number(rows, columns)
            shape["rows"] = table_node(rows, columns)
        self.integers += [each for row in rows for each in (row if kind.axes > 1 else [row])]
        return None, Node(shape)

    def _number(self, rows: list[list[int]], columns: Any) -> None:
        """Replace the addresses in the rows of a table by numbers of parts."""
        for column in [own for own in columns if own.name in ("ADDRESS", "REST")]:
            for row in rows:
                row[column] = self._part(row[column])
