"""Expressions of the subset of Python that compiled functions use, as C."""

from __future__ import annotations

import ast
import builtins
import inspect
import math
import operator
from collections.abc import Callable
from dataclasses import replace
from functools import reduce
from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np

from iiwa_dnn.compiling.library import Entry, source_of
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.export.lines import Lines
from iiwa_dnn.export.values import (
    ATOM,
    BOOL,
    CONDITIONAL,
    DOUBLE,
    INT,
    UNARY,
    Array,
    Object,
    Scalar,
    Struct,
    Tuple,
    Value,
    integer,
    length,
    number,
)

if TYPE_CHECKING:
    from iiwa_dnn.export.translator import Translator

# The operators of C with their precedence, and their results on known integers.
_OPERATORS: dict[type, tuple[str, int, Callable[[Any, Any], Any]]] = {
    ast.Mult: ("*", 13, operator.mul),
    ast.Div: ("/", 13, operator.truediv),
    ast.Add: ("+", 12, operator.add),
    ast.Sub: ("-", 12, operator.sub),
    ast.LShift: ("<<", 11, operator.lshift),
    ast.RShift: (">>", 11, operator.rshift),
    ast.Lt: ("<", 10, operator.lt),
    ast.LtE: ("<=", 10, operator.le),
    ast.Gt: (">", 10, operator.gt),
    ast.GtE: (">=", 10, operator.ge),
    ast.Eq: ("==", 9, operator.eq),
    ast.NotEq: ("!=", 9, operator.ne),
    ast.BitAnd: ("&", 8, operator.and_),
}

# Python's // and % round down, C's towards zero.
_ROUNDED_DOWN: dict[tuple[type, Scalar], tuple[str, Callable[[Any, Any], Any]]] = {
    (ast.FloorDiv, INT): ("quotient", operator.floordiv),
    (ast.Mod, INT): ("remainder_of", operator.mod),
    (ast.Mod, DOUBLE): ("double_remainder", operator.mod),
}

_POWERS = {2: "square_of", 3: "cube_of"}


class Expressions:
    """Translation of a function's expressions.

    Attributes:
        translator: The translation that the function belongs to.
        function: The function.
        file: Its file, as messages name it.
        lines: Lines of the function.
        names: Variables and constants by their names in Python.
        stored: Names of variables that were written already.
    """

    def __init__(self, translator: Translator, function: Any, file: str) -> None:
        """Begin the translation of a function."""
        self.translator = translator
        self.function = function
        self.file = file
        self.lines = Lines()
        self.names: dict[str, Value] = {}
        self.stored: set[str] = set()
        self._temporaries = 0

    def require(self, holds: object, node: Any, problem: str = "has no translation") -> None:
        """Raise an InvalidInputError with file and line of a node unless something holds."""
        if not holds:
            what = f"`{ast.unparse(node).splitlines()[0]}` {problem}"
            raise InvalidInputError(self.function.__name__, f"{self.file}:{node.lineno}: {what}")

    def value(self, node: ast.expr) -> Value:
        """Translate an expression."""
        translate = getattr(self, f"on_{type(node).__name__.lower()}", None)
        self.require(translate, node)
        value: Value = translate(node)  # type: ignore[misc]
        return value

    def scalar(self, node: ast.expr) -> Value:
        """Translate an expression that is a number."""
        value = self.value(node)
        self.require(isinstance(value.kind, Scalar), node, "is no number")
        return value

    def condition(self, node: ast.expr) -> Value:
        """Translate a condition."""
        value = self.scalar(node)
        self.require(value.kind is not DOUBLE, node, "is no condition")
        return value

    def written(self, value: Value) -> Value:
        """Return a value as an expression of C; a tuple's items are put together."""
        if not value.items:
            return value
        shown = [item for item in value.items if not getattr(item.kind, "is_table", False)]
        items = ", ".join(self.written(item).text for item in shown)
        self.translator.define(value.kind)
        start, end = ("{{", "}}") if isinstance(value.kind, Tuple) else ("{", "}")
        return Value(value.kind, f"(struct {value.kind.tag}){start}{items}{end}")

    def temporary(self, value: Value) -> Value:
        """Return a value as a variable of the function."""
        value = self.written(value)
        start = value.text.split("(")[0]
        if start == value.text and start.isidentifier():
            return value
        self._temporaries += 1
        name = f"{start if start.isidentifier() else 'value'}_{self._temporaries}"
        variable = Value(value.kind, name)
        self.lines.add(f"{variable.declared()} = {value.text};", name)
        return variable

    def on_constant(self, node: ast.Constant) -> Value:
        """Translate a literal."""
        return self.constant(node.value, "")

    def on_name(self, node: ast.Name) -> Value:
        """Translate a variable, or a constant of the module."""
        if node.id in self.names:
            return self.names[node.id]
        if node.id in self.stored:
            raise WideError(node.id)
        own = self.function.__globals__
        known = own if node.id in own else vars(builtins)
        self.require(node.id in known, node, "is not known here")
        return self.constant(known[node.id], node.id)

    def constant(self, found: Any, name: str) -> Value:
        """Translate a constant of Python by its name."""
        if isinstance(found, bool):
            return Value(BOOL, str(found).lower(), known=found)
        if isinstance(found, int | np.integer):
            return integer(int(found))
        if isinstance(found, float):
            return Value(DOUBLE, number(found), UNARY, found)
        if isinstance(found, np.ndarray):
            return self.translator.table(name, found)
        return Value(Object(found))

    def on_attribute(self, node: ast.Attribute) -> Value:
        """Translate a field, the size or the shape of an array, or a constant of a module."""
        owner = self.value(node.value)
        kind = owner.kind
        if isinstance(kind, Object):
            return self.constant(getattr(kind.value, node.attr), node.attr)
        if isinstance(kind, Array) and node.attr in ("size", "shape"):
            lengths = [length(size) for size in kind.shape]
            return self.product(lengths) if node.attr == "size" else self.tuple_of(lengths)
        fields = [name for name, _ in getattr(kind, "fields", ())]
        self.require(node.attr in fields, node)
        return owner.parts()[fields.index(node.attr)]

    def product(self, factors: list[Value]) -> Value:
        """Multiply integers."""
        return reduce(lambda a, b: self.operation(ast.Mult, a, b), factors)

    def on_tuple(self, node: ast.Tuple) -> Value:
        """Translate a tuple."""
        return self.tuple_of([self.value(item) for item in node.elts])

    def tuple_of(self, items: list[Value]) -> Value:
        """Join values to a tuple."""
        kinds = [item.kind for item in items]
        if all(kind == kinds[0] for kind in kinds):
            return Value(Tuple(kinds[0], len(items)), items=items)
        runs = [(tag, len(list(run))) for tag, run in groupby(kind.tag for kind in kinds)]
        words = [tag if count == 1 else f"{count}_{tag}s" for tag, count in runs]
        fields = tuple((f"item{i}", kind) for i, kind in enumerate(kinds))
        return Value(Struct("_".join(["tuple", *words]), fields), items=items)

    def on_unaryop(self, node: ast.UnaryOp) -> Value:
        """Translate a sign or a negation."""
        value = self.scalar(node.operand)
        if isinstance(node.op, ast.Not):
            known = None if value.known is None else not value.known
            return Value(BOOL, f"!{value.at(UNARY)}", UNARY, known)
        self.require(isinstance(node.op, ast.USub), node)
        known = None if value.known is None else -value.known
        return Value(value.kind, f"-{value.at(UNARY + 1)}", UNARY, known)

    def on_binop(self, node: ast.BinOp) -> Value:
        """Translate an arithmetic operation."""
        left = self.scalar(node.left)
        right = self.scalar(node.right)
        kind = type(node.op)
        if kind is ast.Pow:
            self.require(left.kind is DOUBLE and right.known in _POWERS, node)
            return Value(DOUBLE, self.translator.helper(_POWERS[right.known], left.text))
        both = DOUBLE if DOUBLE in (left.kind, right.kind) else INT
        if (kind, both) in _ROUNDED_DOWN:
            name, compute = _ROUNDED_DOWN[kind, both]
            if left.known is not None and right.known is not None and both is INT:
                return integer(compute(left.known, right.known))
            return Value(both, self.translator.helper(name, left.text, right.text))
        self.require(kind in _OPERATORS, node)
        return self.operation(kind, left, right)

    def operation(self, kind: type, left: Value, right: Value) -> Value:
        """Translate an operation or a comparison of two numbers."""
        sign, level, compute = _OPERATORS[kind]
        both = DOUBLE if DOUBLE in (left.kind, right.kind) or kind is ast.Div else INT
        known = None
        if left.known is not None and right.known is not None and both is INT:
            known = compute(left.known, right.known)
            if left.is_literal and right.is_literal:
                return self.constant(known, "")
        if kind is ast.Div and left.kind is INT:
            left = Value(DOUBLE, f"(double){left.at(UNARY)}", UNARY)
        is_test = issubclass(kind, ast.cmpop)
        # Of a comparison of comparisons, compilers want to see what is meant.
        lowest = 10 if is_test else level
        text = f"{left.at(lowest + is_test)} {sign} {right.at(lowest + 1)}"
        return Value(BOOL if is_test else both, text, level, known)

    def on_compare(self, node: ast.Compare) -> Value:
        """Translate comparisons; of a chain, the middle is read twice."""
        values = [self.scalar(item) for item in (node.left, *node.comparators)]
        middle = "".join(value.text for value in values[1:-1])
        self.require("(" not in middle and all(type(op) in _OPERATORS for op in node.ops), node)
        pairs = zip(node.ops, values[:-1], values[1:], strict=True)
        parts = [self.operation(type(op), left, right) for op, left, right in pairs]
        return parts[0] if len(parts) == 1 else _joined("&&", 5, parts)

    def on_boolop(self, node: ast.BoolOp) -> Value:
        """Translate ``and`` and ``or`` of conditions."""
        sign, level = ("&&", 5) if isinstance(node.op, ast.And) else ("||", 4)
        return _joined(sign, level, [self.condition(item) for item in node.values])

    def on_ifexp(self, node: ast.IfExp) -> Value:
        """Translate a conditional expression."""
        test = self.condition(node.test)
        if test.known is not None:
            return self.value(node.body if test.known else node.orelse)
        first = self.written(self.value(node.body))
        second = self.written(self.value(node.orelse))
        kind = DOUBLE if DOUBLE in (first.kind, second.kind) else first.kind
        level = CONDITIONAL
        text = f"{test.at(level + 1)} ? {first.at(level + 1)} : {second.at(level)}"
        return Value(kind, text, level)

    def on_subscript(self, node: ast.Subscript) -> Value:
        """Translate an element, a slice or a row of an array, or an item of a tuple."""
        owner = self.value(node.value)
        index = node.slice
        if isinstance(owner.kind, Array):
            return self._element(owner, index.elts if isinstance(index, ast.Tuple) else [index])
        self.require(isinstance(owner.kind, Tuple), node)
        at = self.scalar(index)
        if owner.items and at.known is not None:
            item: Value = owner.items[at.known]
            return item
        return Value(owner.kind.element, f"{self.temporary(owner).text}.at[{at.text}]")

    def _element(self, owner: Value, parts: list[ast.expr]) -> Value:
        """Translate an element, or the beginning of a part of an array."""
        array = owner.kind
        offset, shape = self._offset(array, parts)
        content = None
        if array.content is not None and offset.known is not None:
            content = array.content[offset.known :]
        if shape:
            kind = Array(array.element, shape, array.storage, content)
            if offset.text == "0":
                return Value(kind, owner.text, owner.level)
            return Value(kind, f"{owner.at(12)} + {offset.at(13)}", 12)
        known = content[0] if content else None
        if not array.is_table:
            return Value(array.element, f"{owner.at(ATOM)}[{offset.text}]", known=known)
        self.require(content, parts[0], "is no known index of a table")
        return integer(int(known or 0))

    def _offset(self, array: Array, parts: list[ast.expr]) -> tuple[Value, tuple[int | str, ...]]:
        """Return the first index of a part of an array in its numbers, and the part's shape."""
        offset = integer(0)
        shape: list[int | str] = []
        for axis, part in enumerate(parts):
            start, size = self._range(part, array.shape[axis])
            self.require(size is None or axis + 1 == len(parts), part)
            shape += [] if size is None else [size]
            stride = self.product([integer(1), *map(length, array.shape[axis + 1 :])])
            step = start if stride.text == "1" else self.operation(ast.Mult, stride, start)
            if step.text != "0":
                offset = step if offset.text == "0" else self.operation(ast.Add, offset, step)
        return offset, (*shape, *array.shape[len(parts) :])

    def _range(self, part: ast.expr, size: int | str) -> tuple[Value, int | str | None]:
        """Return the first index along an axis, and how many there are; None for an index alone."""
        if not isinstance(part, ast.Slice):
            return self.scalar(part), None
        self.require(part.step is None, part, "is a slice with a step")
        start = self.scalar(part.lower) if part.lower else integer(0)
        stop = self.scalar(part.upper) if part.upper else length(size)
        width = stop if start.text == "0" else self.operation(ast.Sub, stop, start)
        return start, width.text if width.known is None else width.known

    def on_call(self, node: ast.Call) -> Value:
        """Translate a call."""
        self.require(not node.keywords, node, "has keyword arguments")
        arguments = [self.value(argument) for argument in node.args]
        if isinstance(node.func, ast.Attribute) and node.func.attr == "reshape":
            owner = self.value(node.func.value)
            shape = tuple(size.known for size in arguments)
            self.require(None not in shape, node, "has a shape that is not known")
            return replace(owner, kind=replace(owner.kind, shape=shape))
        called = self.value(node.func).kind
        self.require(isinstance(called, Object), node)
        if called.value in _CALLS:
            return _CALLS[called.value](self, *arguments)
        if hasattr(called.value, "_fields"):
            return Value(self.translator.named_tuple(called.value, arguments), items=arguments)
        return self._called(node, called.value, arguments)

    def _called(self, node: ast.Call, function: Any, arguments: list[Value]) -> Value:
        """Call a compiled function, by its name or its address."""
        if isinstance(function, Entry):
            function = Entry.functions[arguments.pop(0).known]
        plain = source_of(function)
        self.require(inspect.isfunction(plain), node)
        constants = [_constant_of(argument) for argument in arguments]
        if all(constant is not None for constant in constants):
            result = plain(*constants)
            if isinstance(result, int | float):
                return self.constant(result, "")
        made = self.translator.function(function, arguments)
        if made is None:
            self.require(False, node, "calls itself")
            raise AssertionError
        if made.constant is not None:
            return made.constant
        texts = [text for argument in arguments for text in self._argument(argument)]
        return Value(made.result, f"{made.name}({', '.join(texts)})")

    def _argument(self, value: Value) -> list[str]:
        """Return the arguments in C for one in Python."""
        kind = value.kind
        if isinstance(kind, Array):
            further = [size for size in kind.shape if isinstance(size, str)]
            return [] if kind.is_table else [value.text, *further]
        if isinstance(kind, Struct) and not value.pointer:
            return [f"&{self.temporary(value).text}"]
        return [self.written(value).text]


def _constant_of(value: Value) -> Any:
    """Return a value as Python has it if all of it is known, else None."""
    kind = value.kind
    if not isinstance(kind, Array) or kind.content is None:
        return value.known
    shape = [int(size) for size in kind.shape]
    content = kind.content[: math.prod(shape)]
    return None if None in content else np.array(content).reshape(shape)


class WideError(Exception):
    """A variable is used outside of the block in which it is assigned first."""


def _joined(sign: str, level: int, parts: list[Value]) -> Value:
    # In parentheses too where C does not need them: compilers ask for those.
    return Value(BOOL, f" {sign} ".join(part.at(6) for part in parts), level)


def _extreme(name: str) -> Callable[..., Value]:
    """Return the translation of ``min`` or ``max``: from the left to the right, as numba does."""

    def translate(body: Expressions, *values: Value) -> Value:
        kind = DOUBLE if DOUBLE in [value.kind for value in values] else INT
        texts = [value.text for value in values]
        helper = body.translator.helper
        return Value(kind, reduce(lambda a, b: helper(f"{kind.tag}_{name}", a, b), texts))

    return translate


def _library(name: str) -> Callable[..., Value]:
    """Return the translation of a function that C's library has."""
    return lambda body, *values: Value(DOUBLE, f"{name}({', '.join(v.text for v in values)})")


def _to_integer(body: Expressions, value: Value) -> Value:
    if value.kind is INT:
        return value
    known = None if value.known is None else int(value.known)
    return Value(INT, f"(int){value.at(UNARY)}", UNARY, known)


_CALLS: dict[Any, Callable[..., Value]] = {
    min: _extreme("min"),
    max: _extreme("max"),
    abs: _library("fabs"),
    np.sqrt: _library("sqrt"),
    math.sqrt: _library("sqrt"),
    np.sin: _library("sin"),
    np.cos: _library("cos"),
    np.arctan2: _library("atan2"),
    math.sin: _library("sin"),
    math.cos: _library("cos"),
    math.atan2: _library("atan2"),
    np.ceil: _library("ceil"),
    np.floor: _library("floor"),
    math.floor: _library("floor"),
    math.ceil: _library("ceil"),
    np.copysign: _library("copysign"),
    math.copysign: _library("copysign"),
    int: _to_integer,
    float: lambda body, value: Value(DOUBLE, f"(double){value.at(UNARY)}", UNARY),
    len: lambda body, array: length(array.kind.shape[0]),
}
"""Functions with a translation of their own."""
