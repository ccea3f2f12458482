"""Expressions of the subset of Python that compiled functions use, as C."""

from __future__ import annotations

import ast
import builtins
import math
import operator
from collections.abc import Callable
from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.export.lines import Lines, Variable
from iiwa_dnn.export.values import (
    ATOM,
    BOOL,
    CONDITIONAL,
    DOUBLE,
    INT,
    UNARY,
    Array,
    Known,
    Object,
    Scalar,
    Struct,
    Tuple,
    Value,
    integer,
    length,
    number,
)
from iiwa_dnn.qp.compiling import Signature, borrowed

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
_ROUNDED_DOWN: dict[type, tuple[str, str, Callable[[int, int], int]]] = {
    ast.FloorDiv: ("quotient", "", operator.floordiv),
    ast.Mod: ("remainder_of", "double_remainder", operator.mod),
}

_FUNCTIONS: dict[Any, str] = {
    np.sqrt: "sqrt",
    math.sqrt: "sqrt",
    np.sin: "sin",
    np.cos: "cos",
    np.arctan2: "atan2",
    np.ceil: "ceil",
    np.floor: "floor",
    math.floor: "floor",
    math.copysign: "copysign",
    np.copysign: "copysign",
}
"""Functions of Python on doubles that C's library has."""


class Refusal(InvalidInputError):
    """Python code that has no translation; the message names file and line."""


class Expressions:
    """Translation of a function's expressions.

    Attributes:
        translator: The translation that the function belongs to.
        lines: Lines of the function.
        names: Variables and constants by their names in Python.
        function: The function.
        file: Its file, as messages name it.
    """

    def __init__(self, translator: Translator, function: Any, file: str) -> None:
        """Begin the translation of a function."""
        self.translator = translator
        self.lines = Lines()
        self.names: dict[str, Variable | Value] = {}
        self.function = function
        self.file = file
        self._temporaries = 0

    def refusal(self, node: Any, problem: str = "") -> Refusal:
        """Return the error for code that has no translation."""
        what = problem or f"`{ast.unparse(node).splitlines()[0]}` has no translation"
        return Refusal(self.function.__name__, f"{self.file}:{node.lineno}: {what}")

    def value(self, node: ast.expr) -> Value:
        """Translate an expression."""
        translate = getattr(self, f"on_{type(node).__name__.lower()}", None)
        if translate is None:
            raise self.refusal(node)
        value: Value = translate(node)
        return value

    def scalar(self, node: ast.expr) -> Value:
        """Translate an expression that is a number."""
        value = self.value(node)
        if not isinstance(value.kind, Scalar):
            raise self.refusal(node, f"`{ast.unparse(node)}` is no number")
        return value

    def known(self, node: ast.expr) -> Known:
        """Translate an expression whose value is known."""
        known = self.value(node).known
        if known is None:
            raise self.refusal(node, f"`{ast.unparse(node)}` is not known when the code is made")
        return known

    def written(self, value: Value) -> Value:
        """Return a value as an expression of C; a tuple's items are put together."""
        if not value.items:
            return value
        items = ", ".join(self.written(item).text for item in value.items)
        self.translator.define(value.kind)
        start, end = ("{{", "}}") if isinstance(value.kind, Tuple) else ("{", "}")
        return Value(value.kind, f"(struct {value.kind.tag}){start}{items}{end}")

    def temporary(self, value: Value) -> Value:
        """Return a value as a variable of the function."""
        value = self.written(value)
        if value.text.isidentifier():
            return value
        self._temporaries += 1
        name = value.text.split("(")[0]
        start = name if name.isidentifier() else "value"
        variable = Variable(f"{start}_{self._temporaries}", value.kind)
        self.lines.declare(variable, value.text)
        return variable.read()

    def on_constant(self, node: ast.Constant) -> Value:
        """Translate a literal."""
        value = node.value
        if isinstance(value, bool):
            return Value(BOOL, "true" if value else "false", known=Known(value))
        if isinstance(value, int):
            return integer(Known(value))
        if isinstance(value, float):
            return Value(DOUBLE, number(value), known=Known(value))
        raise self.refusal(node)

    def on_name(self, node: ast.Name) -> Value:
        """Translate a variable, or a constant of the module."""
        own = self.names.get(node.id)
        if isinstance(own, Variable):
            return own.read()
        if own is not None:
            return own
        found = self.function.__globals__.get(node.id, _BUILTINS.get(node.id))
        if found is None:
            raise self.refusal(node, f"`{node.id}` is not known here")
        return self.constant(node, found, node.id)

    def constant(self, node: ast.expr, found: Any, name: str) -> Value:
        """Translate a constant of Python by its name."""
        if isinstance(found, float):
            level = UNARY if found < 0.0 else ATOM
            return Value(DOUBLE, number(found), level, Known(found))
        if isinstance(found, int | np.integer) and not isinstance(found, bool):
            return integer(Known(int(found)))
        if isinstance(found, np.ndarray):
            return self.translator.table(name, found)
        return Value(Object(found))

    def on_attribute(self, node: ast.Attribute) -> Value:
        """Translate a field, the size or the shape of an array, or a constant of a module."""
        owner = self.value(node.value)
        kind = owner.kind
        if isinstance(kind, Object):
            return self.constant(node, getattr(kind.value, node.attr), node.attr)
        if isinstance(kind, Struct) and node.attr in kind.fields:
            return owner.field(node.attr)
        if isinstance(kind, Array) and node.attr == "size":
            return self._product([length(own) for own in kind.shape])
        if isinstance(kind, Array) and node.attr == "shape":
            return Value(Tuple(INT, len(kind.shape)), items=[length(own) for own in kind.shape])
        raise self.refusal(node)

    def _product(self, factors: list[Value]) -> Value:
        product = factors[0]
        for factor in factors[1:]:
            product = self.operation(ast.Mult, product, factor)
        return product

    def on_tuple(self, node: ast.Tuple) -> Value:
        """Translate a tuple."""
        return self.tuple_of([self.value(item) for item in node.elts])

    def tuple_of(self, items: list[Value]) -> Value:
        """Join values to a tuple."""
        kinds = [item.kind for item in items]
        if all(kind == kinds[0] for kind in kinds):
            return Value(Tuple(kinds[0], len(items)), items=items)
        names = [getattr(kind, "tag", "") or getattr(kind, "name", "array") for kind in kinds]
        runs = [(name, len(list(run))) for name, run in groupby(names)]
        words = [name if count == 1 else f"{count}_{name}s" for name, count in runs]
        return Value(
            Struct("_".join(["tuple", *words]), {f"item{i}": kind for i, kind in enumerate(kinds)}),
            items=items,
        )

    def on_unaryop(self, node: ast.UnaryOp) -> Value:
        """Translate a sign or a negation."""
        value = self.scalar(node.operand)
        if isinstance(node.op, ast.Not):
            known = None if value.known is None else Known(not value.known.value, value.known)
            return Value(BOOL, f"!{value.at(UNARY)}", UNARY, known)
        if not isinstance(node.op, ast.USub):
            raise self.refusal(node)
        known = None if value.known is None else Known(-value.known.value, value.known)
        return Value(value.kind, f"-{value.at(UNARY + 1)}", UNARY, known)

    def on_binop(self, node: ast.BinOp) -> Value:
        """Translate an arithmetic operation."""
        left = self.scalar(node.left)
        if isinstance(node.op, ast.Pow):
            return self._power(node, left)
        right = self.scalar(node.right)
        if type(node.op) in _ROUNDED_DOWN:
            return self._rounded_down(type(node.op), left, right)
        if type(node.op) not in _OPERATORS:
            raise self.refusal(node)
        return self.operation(type(node.op), left, right)

    def operation(self, kind: type, left: Value, right: Value) -> Value:
        """Translate an operation on two numbers."""
        sign, level, compute = _OPERATORS[kind]
        result = DOUBLE if DOUBLE in (left.kind, right.kind) or kind is ast.Div else INT
        known = None
        if left.known is not None and right.known is not None and result is INT:
            known = Known(compute(left.known.value, right.known.value), left.known, right.known)
            if left.is_literal and right.is_literal:
                return integer(known)
        if kind is ast.Div and DOUBLE not in (left.kind, right.kind):
            left = Value(DOUBLE, f"(double){left.at(UNARY)}", UNARY)
        return Value(result, f"{left.at(level)} {sign} {right.at(level + 1)}", level, known)

    def _rounded_down(self, kind: type, left: Value, right: Value) -> Value:
        name, of_doubles, compute = _ROUNDED_DOWN[kind]
        operands = f"({left.text}, {right.text})"
        if DOUBLE in (left.kind, right.kind):
            return Value(DOUBLE, f"{self.translator.helper(of_doubles)}{operands}")
        if left.known is not None and right.known is not None:
            known = Known(compute(left.known.value, right.known.value), left.known, right.known)
            return integer(known)
        return Value(INT, f"{self.translator.helper(name)}{operands}")

    def _power(self, node: ast.BinOp, base: Value) -> Value:
        exponent = self.known(node.right).value
        if exponent not in (2, 3) or base.kind is not DOUBLE:
            raise self.refusal(node)
        name = self.translator.helper("square_of" if exponent == 2 else "cube_of")
        return Value(DOUBLE, f"{name}({base.text})")

    def on_compare(self, node: ast.Compare) -> Value:
        """Translate comparisons; of a chain, the middle is read twice."""
        values = [self.scalar(item) for item in (node.left, *node.comparators)]
        parts = []
        for sign, left, right in zip(node.ops, values[:-1], values[1:], strict=True):
            if type(sign) not in _OPERATORS or len(node.ops) > 1 and "(" in right.text + left.text:
                raise self.refusal(node)
            text, level, compute = _OPERATORS[type(sign)]
            result = Value(BOOL, f"{left.at(level)} {text} {right.at(level + 1)}", level)
            if left.kind is INT and right.kind is INT and left.known and right.known:
                answer = compute(left.known.value, right.known.value)
                result.known = Known(answer, left.known, right.known)
            parts.append(result)
        return parts[0] if len(parts) == 1 else self._joined("&&", 5, parts)

    def on_boolop(self, node: ast.BoolOp) -> Value:
        """Translate ``and`` and ``or`` of conditions."""
        sign, level = ("&&", 5) if isinstance(node.op, ast.And) else ("||", 4)
        return self._joined(sign, level, [self.scalar(item) for item in node.values])

    def _joined(self, sign: str, level: int, parts: list[Value]) -> Value:
        # In parentheses too where C does not need them: compilers ask for those.
        return Value(BOOL, f" {sign} ".join(part.at(6) for part in parts), level)

    def on_ifexp(self, node: ast.IfExp) -> Value:
        """Translate a conditional expression."""
        test = self.condition(node.test)
        if test.known is not None:
            return self.value(node.body if test.known.use() else node.orelse)
        first = self.written(self.value(node.body))
        second = self.written(self.value(node.orelse))
        kind = first.kind
        if kind != second.kind:
            if {kind, second.kind} != {INT, DOUBLE}:
                raise self.refusal(node, "the two sides have different types")
            kind = DOUBLE
        level = CONDITIONAL
        text = f"{test.at(level + 1)} ? {first.at(level + 1)} : {second.at(level)}"
        return Value(kind, text, level)

    def condition(self, node: ast.expr) -> Value:
        """Translate a condition."""
        value = self.scalar(node)
        if value.kind is DOUBLE:
            raise self.refusal(node, f"`{ast.unparse(node)}` is no condition")
        return value

    def on_subscript(self, node: ast.Subscript) -> Value:
        """Translate an element, a slice or a row of an array, or an item of a tuple."""
        owner = self.value(node.value)
        index = node.slice
        if isinstance(owner.kind, Array):
            parts = index.elts if isinstance(index, ast.Tuple) else [index]
            return self._element(node, owner, parts)
        if owner.items:
            return owner.items[self.known(index).use()]
        if isinstance(owner.kind, Tuple):
            text = self.temporary(owner).text
            return Value(owner.kind.element, f"{text}.at[{self.scalar(index).text}]")
        raise self.refusal(node)

    def _element(self, node: ast.Subscript, owner: Value, parts: list[ast.expr]) -> Value:
        array = owner.kind
        offset = None
        shape: list[Known | str] = []
        if len(parts) > len(array.shape):
            raise self.refusal(node)
        for axis, part in enumerate(parts):
            start, size = self._range(node, part, array.shape[axis])
            if size is not None and axis + 1 < len(parts):
                raise self.refusal(node, "a slice along an axis but the last has no translation")
            shape += [] if size is None else [size]
            stride = self._product([integer(Known(1)), *map(length, array.shape[axis + 1 :])])
            step = start if stride.text == "1" else self.operation(ast.Mult, stride, start)
            if step.text != "0":
                offset = step if offset is None else self.operation(ast.Add, offset, step)
        shape += array.shape[len(parts) :]
        if not shape:
            return self._read(owner, offset or integer(Known(0)))
        content = None
        if array.content is not None and (offset is None or offset.known is not None):
            at = 0 if offset is None else offset.known.value
            content = Known(array.content.value[at:], array.content, offset and offset.known)
        text = owner.text if offset is None else f"{owner.at(12)} + {offset.at(13)}"
        kind = Array(array.element, tuple(shape), array.storage, content)
        return Value(kind, text, owner.level if offset is None else 12)

    def _range(
        self, node: ast.Subscript, part: ast.expr, size: Known | str
    ) -> tuple[Value, Known | str | None]:
        """Return the first index along an axis, and how many there are; None for an index alone."""
        if not isinstance(part, ast.Slice):
            return self.scalar(part), None
        if part.step is not None:
            raise self.refusal(node)
        start = self.scalar(part.lower) if part.lower else integer(Known(0))
        if part.lower is None and part.upper is None:
            return start, size
        stop = self.scalar(part.upper) if part.upper else length(size)
        width = stop if start.text == "0" else self.operation(ast.Sub, stop, start)
        return start, width.known or width.text

    def _read(self, owner: Value, index: Value) -> Value:
        array = owner.kind
        known = None
        if array.content is not None and index.known is not None:
            known = Known(array.content.value[index.known.value], array.content, index.known)
        if array.in_table:
            if known is None:
                raise Refusal(owner.text, "is read at an index that is not known")
            return integer(known)
        return Value(array.element, f"{owner.at(ATOM)}[{index.text}]", known=known)

    def on_call(self, node: ast.Call) -> Value:
        """Translate a call."""
        if isinstance(node.func, ast.Attribute):
            owner = self.value(node.func.value)
            if isinstance(owner.kind, Array) and node.func.attr == "reshape":
                return self._reshaped(node, owner)
        function = self.value(node.func).kind
        if not isinstance(function, Object):
            raise self.refusal(node)
        own = _CALLS.get(_key(function.value))
        if own is not None:
            return own(self, node)
        if function.value in _FUNCTIONS:
            arguments = [self.scalar(argument).text for argument in node.args]
            return Value(DOUBLE, f"{_FUNCTIONS[function.value]}({', '.join(arguments)})")
        if isinstance(function.value, type) and hasattr(function.value, "_fields"):
            return self._named_tuple(node, function.value)
        callee = function.value
        arguments = list(node.args)
        entered = Signature.entered_by(callee)
        if entered is not None:
            callee = entered.function_at(self.known(arguments.pop(0)).use())
        if not hasattr(callee, "__code__") and not hasattr(callee, "py_func"):
            raise self.refusal(node)
        values = [self.value(argument) for argument in arguments]
        return self.called(node, callee, values)

    def called(self, node: ast.Call, function: Any, arguments: list[Value]) -> Value:
        """Call a compiled function."""
        if node.keywords:
            raise self.refusal(node, "keyword arguments have no translation")
        made = self.translator.function(function, arguments, lambda text: self.refusal(node, text))
        if made.constant is not None:
            return made.constant
        texts = [text for argument in arguments for text in self._argument(argument)]
        return Value(made.result, f"{made.name}({', '.join(texts)})")

    def _argument(self, value: Value) -> list[str]:
        """Return the arguments in C for one in Python."""
        value = self.written(value)
        kind = value.kind
        if isinstance(kind, Array):
            further = [own for own in kind.shape if not isinstance(own, Known)]
            return [value.text, *further] if not kind.in_table else []
        if isinstance(kind, Struct) and kind.holds_arrays:
            return [value.text if value.pointer else f"&{self.temporary(value).text}"]
        return [value.text]

    def _named_tuple(self, node: ast.Call, kind: Any) -> Value:
        if node.keywords or len(node.args) != len(kind._fields):
            raise self.refusal(node, "a named tuple takes all of its fields, by their order")
        items = [self.value(argument) for argument in node.args]
        values = dict(zip(kind._fields, items, strict=True))
        struct = self.translator.named_tuple(kind, values)
        shown = [item for item in items if not getattr(item.kind, "in_table", False)]
        return Value(struct, items=shown)

    def _reshaped(self, node: ast.Call, owner: Value) -> Value:
        shape = [self.known(argument) for argument in node.args]
        kind = owner.kind
        array = Array(kind.element, tuple(shape), kind.storage, kind.content)
        return Value(array, owner.text, owner.level)

    def minimum(self, node: ast.Call) -> Value:
        """Translate ``min`` and ``max``, from the left to the right as numba does."""
        assert isinstance(node.func, ast.Name)
        values = [self.scalar(argument) for argument in node.args]
        result = values[0]
        for value in values[1:]:
            kind = DOUBLE if DOUBLE in (result.kind, value.kind) else INT
            name = self.translator.helper(f"{kind.name}_{node.func.id}")
            result = Value(kind, f"{name}({result.text}, {value.text})")
        return result

    def absolute(self, node: ast.Call) -> Value:
        """Translate ``abs`` of a double."""
        value = self.scalar(node.args[0])
        if value.kind is not DOUBLE:
            raise self.refusal(node)
        return Value(DOUBLE, f"fabs({value.text})")

    def to_integer(self, node: ast.Call) -> Value:
        """Translate ``int``."""
        value = self.scalar(node.args[0])
        known = None if value.known is None else Known(int(value.known.value), value.known)
        if value.kind is INT:
            return value
        return Value(INT, f"(int){value.at(UNARY)}", UNARY, known)

    def to_double(self, node: ast.Call) -> Value:
        """Translate ``float``."""
        return Value(DOUBLE, f"(double){self.scalar(node.args[0]).at(UNARY)}", UNARY)

    def itself(self, node: ast.Call) -> Value:
        """Translate a call that returns its argument."""
        return self.value(node.args[0])

    def rows(self, node: ast.Call) -> Value:
        """Translate ``len``."""
        kind = self.value(node.args[0]).kind
        if not isinstance(kind, Array):
            raise self.refusal(node)
        return length(kind.shape[0])


_BUILTINS: dict[str, Any] = {
    name: getattr(builtins, name)
    for name in ("abs", "min", "max", "int", "float", "len", "range", "True", "False")
    if hasattr(builtins, name)
}


def _key(function: Any) -> int:
    return id(function)


_CALLS: dict[int, Callable[[Expressions, ast.Call], Value]] = {
    _key(min): Expressions.minimum,
    _key(max): Expressions.minimum,
    _key(abs): Expressions.absolute,
    _key(int): Expressions.to_integer,
    _key(float): Expressions.to_double,
    _key(len): Expressions.rows,
    _key(np.uint64): Expressions.itself,
    _key(borrowed): Expressions.itself,
}
"""Calls with a translation of their own."""
