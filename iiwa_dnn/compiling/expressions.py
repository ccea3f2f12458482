"""Expressions of a kernel, as C."""

from __future__ import annotations

import ast
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from .kinds import ARRAYS, BOOL, FLOAT, INT, Kind
from .sources import Module, decoration, fail

if TYPE_CHECKING:
    from .translator import Translator

SIGNS: dict[type, str] = {ast.Mult: "*", ast.Add: "+", ast.Sub: "-"}
_ROUNDED: dict[type, str] = {ast.FloorDiv: "quotient", ast.Mod: "remainder"}
_COMPARISONS: dict[type, str] = {
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
    ast.Eq: "==",
    ast.NotEq: "!=",
}

_FUNCTIONS = {
    **{f"math.{name}": (FLOAT, name) for name in ("sin", "cos", "atan2", "tanh", "exp", "log")},
    "math.copysign": (FLOAT, "copysign"),
    "math.sqrt": (FLOAT, "sqrt"),
    "np.sqrt": (FLOAT, "sqrt"),
    "np.copysign": (FLOAT, "copysign"),
    "np.ceil": (FLOAT, "ceil"),
    "math.ceil": (INT, "(int64_t)ceil"),
    "math.floor": (INT, "(int64_t)floor"),
    "math.isfinite": (BOOL, "isfinite"),
    "int": (INT, "(int64_t)"),
    "float": (FLOAT, "(double)"),
    "abs": (FLOAT, "fabs"),
}
"""Type of the result and name in C of Python's functions. Numpy's others may differ in the last
digit."""


class Value(NamedTuple):
    """An expression of C, in parentheses where it has an operator.

    Attributes:
        kind: Its type.
        text: The expression.
    """

    kind: Kind
    text: str

    @property
    def sizes(self) -> list[str]:
        """Sizes of an array."""
        return [f"{self.text}.size{i}" for i in range(self.kind.axes)]

    @property
    def size(self) -> str:
        """Number of elements of an array."""
        return " * ".join(self.sizes)


def number_text(value: float) -> str:
    """Write a number as C does."""
    text = repr(value).replace("inf", "INFINITY").replace("nan", "NAN")
    return text.lower() if isinstance(value, bool) else text


def literal(kind: Kind, members: Sequence[str]) -> str:
    """Return a value of a struct of C."""
    inner = ", ".join(members)
    return f"(({kind.tag}){{{inner if kind.is_named or kind.axes else f'{{{inner}}}'}}})"


def _array(kind: Kind | None, data: str, sizes: Sequence[str]) -> Value:
    """Return an array of elements of a type."""
    own = ARRAYS[kind, len(sizes)]
    return Value(own, literal(own, [data, *sizes]))


class Expressions:
    """Translation of the expressions of one function.

    Attributes:
        translator: The translation that the function belongs to.
        module: The function's module.
        parameters: Types of its parameters.
        kinds: Types of its parameters and variables.
        written: Arrays that are written into, as Python names them.
    """

    def __init__(self, translator: Translator, module: Module, parameters: dict[str, Kind]) -> None:
        """Begin the translation of a function."""
        self.translator = translator
        self.module = module
        self.parameters = parameters
        self.kinds = dict(parameters)
        self.written: set[str] = set()

    def require(self, holds: bool, node: ast.AST, problem: str) -> None:
        """Refuse a node unless something holds."""
        if not holds:
            fail(self.module, node, problem)

    def condition(self, node: ast.expr) -> str:
        """Translate a condition, in parentheses."""
        text = self.value(node).text
        return text if isinstance(node, ast.Compare | ast.BoolOp | ast.UnaryOp) else f"({text})"

    def value(self, node: ast.expr) -> Value:
        """Translate an expression."""
        match node:
            case ast.Name(id=name) if name in self.kinds:
                kind = self.kinds[name]
                is_address = kind.is_named and name in self.parameters
                return Value(kind, f"(*{name})" if is_address else name)
            case ast.Constant() | ast.Name() | ast.Attribute(value=ast.Name(id="math" | "np")):
                return self._constant(node)
            case ast.Attribute():
                return self._attribute(node)
            case ast.Tuple(elts=items):
                values = [self.value(item) for item in items]
                kind = self.translator.kinds.tuple(self._wider(values), len(values))
                return Value(kind, literal(kind, [own.text for own in values]))
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return Value(BOOL, f"(!{self.value(operand).text})")
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                own = self.value(operand)
                return Value(own.kind, f"(-{own.text})")
            case ast.BinOp(left=left, op=op, right=right):
                return self._arithmetic(type(op), self.value(left), self.value(right))
            case ast.Compare(left=left, ops=ops, comparators=others):
                texts = [self.value(item).text for item in (left, *others)]
                signs = [_COMPARISONS[type(op)] for op in ops]
                parts = [
                    f"{a} {sign} {b}" for a, sign, b in zip(texts, signs, texts[1:], strict=False)
                ]
                return Value(BOOL, f"({' && '.join(parts)})")
            case ast.BoolOp(op=op, values=items):
                sign = " && " if isinstance(op, ast.And) else " || "
                return Value(BOOL, f"({sign.join(map(self.condition, items))})")
            case ast.IfExp(test=test, body=body, orelse=orelse):
                both = [self.value(body), self.value(orelse)]
                text = f"({self.condition(test)} ? {both[0].text} : {both[1].text})"
                return Value(self._wider(both), text)
            case ast.Subscript(value=owner, slice=ast.Tuple(elts=parts)):
                return self._part(self.value(owner), parts)
            case ast.Subscript(value=ast.Attribute(value=owner, attr="shape"), slice=axis):
                return Value(INT, self.value(owner).sizes[self.module.value(axis)])
            case ast.Subscript(value=owner, slice=part):
                return self._part(self.value(owner), [part])
            case ast.Call():
                return self._call(node)
        fail(self.module, node, "has no translation")

    def _wider(self, values: list[Value]) -> Kind:
        """Return the type that takes all of some values; the compiler refuses what it does not."""
        return next((own.kind for own in values if own.kind is FLOAT), values[0].kind)

    def _constant(self, node: ast.expr) -> Value:
        """Translate a constant, or a table of numbers, of a module."""
        found = self.module.value(node)
        for python, kind in ((bool, BOOL), (int, INT), (float, FLOAT)):
            if isinstance(found, python):
                return Value(kind, number_text(python(found)))
        tag = f"{self.module.name.rpartition('.')[2]}_{ast.unparse(node)}"
        data = self.translator.table(tag, found)
        return _array(data.kind, data.text, [str(len(found))])

    def _attribute(self, node: ast.Attribute) -> Value:
        """Translate a member of a named tuple, or an array's size."""
        owner = self.value(node.value)
        if owner.kind.axes and node.attr == "size":
            return Value(INT, f"({owner.size})")
        kind = owner.kind.members[node.attr]
        known = self.translator.constants.get(owner.kind.tag, {}).get(node.attr)
        if known is None:
            return Value(kind, f"{owner.text}.{node.attr}")
        return Value(kind, f"(({kind.tag}){known})")

    def _arithmetic(self, op: type, left: Value, right: Value) -> Value:
        kind = FLOAT if FLOAT in (left.kind, right.kind) else INT
        if op is ast.Div:
            return Value(FLOAT, f"((double){left.text} / {right.text})")
        if op in _ROUNDED:
            return Value(kind, f"{kind.word}_{_ROUNDED[op]}({left.text}, {right.text})")
        return Value(kind, f"({left.text} {SIGNS[op]} {right.text})")

    def _part(self, owner: Value, parts: list[ast.expr]) -> Value:
        """Translate an element of an array, or a part without gaps, or an item of a tuple."""
        element = owner.kind.element
        assert element
        if owner.kind.members:
            return Value(element, f"{owner.text}.at[{self.value(parts[0]).text}]")
        sizes = owner.sizes
        shape = sizes[len(parts) :]
        place = [f"{owner.text}.data"]
        for axis, part in enumerate(parts):
            start = part
            if isinstance(part, ast.Slice):
                ends = axis + 1 == len(parts) and part.step is None
                self.require(ends, part, "has gaps between its rows")
                start = part.lower or ast.Constant(0)
                stop = self.value(part.upper).text if part.upper else sizes[axis]
                shape.insert(0, f"{stop} - {self.value(start).text}")
            self.require(not isinstance(start, ast.UnaryOp), part, "counts from the end")
            at = self.value(start).text
            if at != "0":
                place.append(" * ".join([at, *sizes[axis + 1 :]]))
        if shape:
            return _array(element, " + ".join(place), shape)
        return Value(element, f"{place[0]}[{' + '.join(place[1:]) or 0}]")

    def _call(self, node: ast.Call) -> Value:
        """Translate a call."""
        self.require(not node.keywords, node, "has no translation")
        name = ast.unparse(node.func)
        match node.func:
            case ast.Attribute(value=owner, attr="copy"):
                own = self.value(owner)
                data = f"arena_copy(arena, {own.text}.data, {own.size})"
                return _array(own.kind.element, data, own.sizes)
            case ast.Attribute(value=owner, attr="reshape"):
                own = self.value(owner)
                return _array(own.kind.element, f"{own.text}.data", self._texts(node.args))
            case ast.Attribute(value=ast.Name(id="np"), attr="empty" | "zeros" as word):
                shape = self._texts(getattr(node.args[0], "elts", node.args))
                return _array(FLOAT, f"arena_{word}(arena, {' * '.join(shape)})", shape)
        home, found = self.translator.package.find(self.module, name)
        if isinstance(found, ast.FunctionDef) and decoration(found):
            return self._kernel(node, home, found)
        if isinstance(found, ast.ClassDef):
            kind = self.translator.kinds.of(home, found)
            return Value(kind, literal(kind, self._texts(node.args)))
        return self._standard(name, [self.value(each) for each in node.args])

    def _texts(self, nodes: list[ast.expr]) -> list[str]:
        return [self.value(each).text for each in nodes]

    def _kernel(self, node: ast.Call, home: Module, found: ast.FunctionDef) -> Value:
        """Translate the call of another kernel."""
        own = self.translator.function(home, found)
        texts = ["arena"]
        for each, name in zip(node.args, own.parameters, strict=True):
            value = self.value(each)
            text = f"&{value.text}" if value.kind.is_named else value.text
            if value.kind.is_named and isinstance(each, ast.Call):
                text = f"({value.kind.tag}[1]){{{value.text}}}"
            texts.append(text)
            given = ast.unparse(each)
            places = [place for place in own.written if place.partition(".")[0] == name]
            self.written |= {given + place.removeprefix(name) for place in places}
        return Value(own.result, f"{own.name}({', '.join(texts)})")

    def _standard(self, name: str, values: list[Value]) -> Value:
        """Translate a function of Python, of its module math or of numpy."""
        kind = self._wider(values)
        if name == "len":
            return Value(INT, values[0].sizes[0])
        own = (kind, f"{kind.word}_{name}")
        kind, word = own if name in ("min", "max") else _FUNCTIONS[name]
        return Value(kind, f"{word}({', '.join(own.text for own in values)})")
