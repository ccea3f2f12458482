"""Infer the array sizes that a kernel needs from its loops, for its calls from Python.

An index that is the sum of a loop variable, sizes and arguments has a largest value that is known
before the kernel runs: an array that ends below it is refused. Indices that depend on data, or that
stand behind a condition, are not looked at.
"""

from __future__ import annotations

import ast
from collections import Counter
from typing import NamedTuple

from .expressions import Expressions
from .kinds import INT, Kind
from .sources import decoration, stored_names

DEPTH = 3
"""Calls of other kernels that are followed into each other."""

_SIGNS = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*"}


_JUMPS = (ast.Return, ast.Break, ast.Continue)


class Extent(NamedTuple):
    """Least and largest value of a whole number, as expressions in C."""

    low: str
    high: str


Known = Extent | list[str] | dict[str, "Known"] | None
"""Known value before a kernel runs: of an array its sizes, of a tuple its members."""


def known_of(kind: Kind, place: str) -> Known:
    """Return the known sizes of an argument by its name in C."""
    if kind.axes:
        return [f"{place}.size{axis}" for axis in range(kind.axes)]
    if kind.is_named:
        # A record's numbers lie in its array.
        lasting = {k: own for k, own in kind.members.items() if own is not INT or not kind.sizes}
        return {name: known_of(own, f"{place}.{name}") for name, own in lasting.items()}
    return Extent(place, place) if kind is INT else None


class Reading:
    """A kernel, read with what is known of its arguments.

    Attributes:
        needs: The conditions on sizes, in C; a dictionary for its order.
        result: What is known of the result.
    """

    def __init__(
        self,
        own: Expressions,
        known: dict[str, Known],
        guards: tuple[str, ...] = (),
        depth: int = 0,
    ) -> None:
        """Read a kernel that runs where none of the guards, conditions in C, holds."""
        self.needs: dict[str, None] = {}
        self.result: Known = None
        self._own = own
        self._known = known
        self._guards = guards
        self._depth = depth
        self._stores = Counter(stored_names(own.node))
        self._read(own.node.body)

    def _read(self, block: list[ast.stmt]) -> None:
        """Read those statements of a block that are reached in any case."""
        for node in block:
            match node:
                case ast.For(target=target, iter=ast.Call(args=ends), body=body):
                    self._loop(ast.unparse(target), [self._value(end) for end in ends], body)
                case ast.If(test=test) | ast.While(test=test):
                    self._value(test)
                    if any(isinstance(each, _JUMPS) for each in ast.walk(node)):
                        return
                case ast.Assign(targets=[target], value=value):
                    self._value(target)
                    self._know(target, self._value(value))
                case ast.Return(value=ast.expr() as value):
                    self.result = self._value(value)
                case _:
                    self._parts(node)

    def _know(self, target: ast.expr, found: Known) -> None:
        """Store the known value of a variable that is written once, or of several."""
        if isinstance(target, ast.Tuple) and isinstance(found, dict):
            for each, member in zip(target.elts, found.values(), strict=True):
                self._know(each, member)
        elif isinstance(target, ast.Name) and self._stores[target.id] == 1:
            self._known[target.id] = found

    def _loop(self, name: str, ends: list[Known], body: list[ast.stmt]) -> None:
        """Read the body of a loop whose ends are known."""
        match [Extent("0", "0"), *ends][-2:]:
            case [Extent(low=low), Extent(high=high)]:
                guards = self._guards
                self._guards = (*guards, f"{high} <= {low}")
                self._known[name] = Extent(low, f"({high} - 1)")
                self._read(body)
                self._guards = guards

    def _parts(self, node: ast.AST) -> None:
        """Read all parts of a node."""
        for child in ast.iter_child_nodes(node):
            self._value(child)

    def _value(self, node: ast.AST) -> Known:
        """Return the known value of an expression; note the sizes that it needs."""
        match node:
            case ast.Constant(value=int() as number):
                return Extent(str(number), str(number))
            case ast.Name(id=name):
                return self._known.get(name)
            case ast.Tuple(elts=members):
                return {str(i): self._value(each) for i, each in enumerate(members)}
            case ast.Attribute(value=owner, attr=name):
                return _member(self._value(owner), name)
            case ast.BinOp(left=left, op=op, right=right):
                return _combined(self._value(left), type(op), self._value(right))
            case ast.IfExp(test=first) | ast.BoolOp(values=[first, *_]):
                self._value(first)
            case ast.Subscript(value=owner, slice=index):
                return self._element(self._value(owner), index)
            case ast.Call(func=function, args=arguments):
                return self._called(function, [self._value(each) for each in arguments])
            case _:
                self._parts(node)
        return None

    def _element(self, owner: Known, index: ast.expr) -> Known:
        """Return the known value of an element or a part; note the size that an index needs."""
        if isinstance(owner, dict):
            return owner.get(ast.unparse(index))
        if not isinstance(owner, list):
            return None
        places = index.elts if isinstance(index, ast.Tuple) else [index]
        whole = [None] * (len(owner) - len(places))
        parts = map(self._along, [*places, *whole], owner)
        return [part for part in parts if part] or None

    def _along(self, place: ast.expr | None, size: str) -> str:
        """Return the size of a part along an axis of this size, nothing for an element."""
        if place is None:
            return size
        if not isinstance(place, ast.Slice):
            self._need(self._value(place), " + 1", size)
            return ""
        start = self._value(place.lower) if place.lower else Extent("0", "0")
        end = self._value(place.upper) if place.upper else Extent(size, size)
        self._need(end, "", size)
        if not isinstance(start, Extent) or not isinstance(end, Extent):
            return "INT64_MAX"
        return f"({end.high} - {start.low})"

    def _need(self, last: Known, beyond: str, size: str) -> None:
        """Note that an axis needs a size, that of its last place and what is beyond."""
        if isinstance(last, Extent) and last.high != size:
            need = " || ".join([*self._guards, f"{last.high}{beyond} <= {size}"])
            if "INT64_MAX" not in need:  # of a size that is not known
                self.needs[need] = None

    def _called(self, function: ast.expr, arguments: list[Known]) -> Known:
        """Return the known value of a call; note the sizes that the called kernel needs."""
        if isinstance(function, ast.Attribute):
            self._value(function.value)
            sizes = [each.high for each in arguments if isinstance(each, Extent)]
            return sizes if function.attr == "reshape" and len(sizes) == len(arguments) else None
        home, node = self._own.module.package.find(self._own.module, ast.unparse(function))
        if isinstance(node, ast.ClassDef):
            names = [ast.unparse(own.target) for own in node.body if isinstance(own, ast.AnnAssign)]
            return dict(zip(names, arguments, strict=True))
        if not isinstance(node, ast.FunctionDef) or not decoration(node) or self._depth == DEPTH:
            return None
        own = self._own.translator.function(home, node)
        known = dict(zip(own.parameters, arguments, strict=True))
        reading = Reading(own, known, self._guards, self._depth + 1)
        self.needs |= reading.needs
        return reading.result


def _member(owner: Known, name: str) -> Known:
    """Return the known value of a member of a tuple, or of an array's size and shape."""
    if isinstance(owner, dict):
        return owner.get(name)
    if isinstance(owner, list) and name == "size":
        return Extent(*2 * [f"({' * '.join(owner)})"])
    if isinstance(owner, list) and name == "shape":
        return {str(axis): Extent(size, size) for axis, size in enumerate(owner)}
    return None


def _combined(left: Known, op: type[ast.operator], right: Known) -> Known:
    """Return the range of a sum, a difference or a product with a constant factor.

    Two that vary may not reach their largest values at once.
    """
    if not isinstance(left, Extent) or not isinstance(right, Extent) or op not in _SIGNS:
        return None
    if left.low != left.high and right.low != right.high:
        return None
    sign = _SIGNS[op]
    if op is ast.Sub:
        right = Extent(right.high, right.low)
    return Extent(f"({left.low} {sign} {right.low})", f"({left.high} {sign} {right.high})")
