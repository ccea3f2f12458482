"""Expressions of a kernel, as C."""

from __future__ import annotations

import ast
import builtins
import re
from types import ModuleType
from typing import TYPE_CHECKING, Any, NamedTuple

from .kinds import ARRAYS, BOOL, FLOAT, INT, NUMBERS, VOID, Kind
from .sources import Module, decoration, fail

if TYPE_CHECKING:
    from .translator import Made, Translator

SIGNS: dict[type, str] = {ast.Mult: "*", ast.Add: "+", ast.Sub: "-", ast.Div: "/"}
_COMPARISONS: dict[type, str] = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="}
_COMPARISONS |= {ast.Eq: "==", ast.NotEq: "!="}
_ROUNDED: dict[type, str] = {ast.FloorDiv: "quotient", ast.Mod: "remainder"}

_EXACT = ("sqrt", "ceil", "floor", "copysign")
_LIBRARY = {f"math.{name}" for name in (*_EXACT, "sin", "cos", "atan2", "tanh", "exp", "log")}
_LIBRARY |= {f"np.{name}" for name in _EXACT}
"""Functions that C has by the same name. Numpy's others may differ in the last digit."""

_C_WORDS = re.findall(
    r"\w+",
    """
    auto case char const default do double else enum extern float for goto inline int long register
    restrict short signed sizeof static struct switch typedef union unsigned void volatile arena
    vector matrix cube sqrt sin cos tan tanh exp log pow floor ceil round fabs fmod fmin fmax atan2
    copysign isfinite failed
    """,
)
"""Words of C and of kernels.h that no variable is called."""

_PLACE = re.compile(r"(\(\*\w+\)|\w+)(\.\w+)*")
"""Text of a variable or of a member of one."""


class Value(NamedTuple):
    """An expression of C, in parentheses where it has an operator.

    Attributes:
        kind: Its type.
        text: The expression.
        known: Its value, if it is a constant.
        items: The values that a plain tuple was made of.
    """

    kind: Kind
    text: str
    known: Any = None
    items: tuple[Value, ...] = ()

    @property
    def sizes(self) -> list[Value]:
        """Sizes of an array."""
        return [Value(INT, f"{self.text}.size{i}") for i in range(self.kind.axes)]


def number_text(value: float) -> str:
    """Write a number as C does."""
    text = repr(value).replace("inf", "INFINITY").replace("nan", "NAN")
    return text.lower() if isinstance(value, bool) else text


def literal(kind: Kind, *members: str) -> str:
    """Return a value of a struct of C."""
    return f"(({kind.tag}){{{', '.join(members)}}})"


def product(sizes: list[Value]) -> str:
    """Return the number of elements of an array."""
    return " * ".join(own.text for own in sizes)


class Expressions:
    """Translation of the expressions of one function.

    Attributes:
        translator: The translation that the function belongs to.
        module: The function's module.
        kinds: Types of its parameters and variables.
        parameters: Types of its parameters.
        written: Arrays that are written into, as Python names them.
        lines: Lines of C.
        depth: Number of blocks that are open.
    """

    def __init__(self, translator: Translator, module: Module, parameters: dict[str, Kind]) -> None:
        """Begin the translation of a function."""
        self.translator = translator
        self.module = module
        self.kinds = dict(parameters)
        self.parameters = parameters
        self.written: set[str] = set()
        self.lines: list[str] = []
        self.depth = 1
        self._count = 0

    def require(self, holds: object, node: ast.AST, problem: str = "has no translation") -> None:
        """Refuse a node unless something holds."""
        if not holds:
            fail(self.module, node, problem)

    def add(self, text: str) -> None:
        """Add a line."""
        self.lines.append("    " * self.depth + text)

    def kept(self, value: Value) -> Value:
        """Keep a value in a variable of C."""
        if value.known is not None:
            return value
        self._count += 1
        own = Value(value.kind, f"own_{self._count}")
        self.add(f"const {own.kind.tag} {own.text} = {value.text};")
        return own

    def number(self, node: ast.expr) -> Value:
        """Translate an expression that is a number."""
        value = self.value(node)
        self.require(value.kind in NUMBERS, node, "is no number")
        return value

    def condition(self, node: ast.expr) -> str:
        """Translate a condition, in parentheses."""
        value = self.number(node)
        self.require(value.kind is not FLOAT, node, "is no condition")
        return f"({value.text})" if _PLACE.match(value.text) else value.text

    def value(self, node: ast.expr) -> Value:
        """Translate an expression."""
        match node:
            case ast.Constant(value=found):
                return self.constant(found, "", node)
            case ast.Name():
                return self._variable(node)
            case ast.Attribute():
                return self._attribute(node)
            case ast.Tuple(elts=items):
                return self.tuple_of([self.value(item) for item in items])
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return Value(BOOL, f"(!{self.condition(operand)})")
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                value = self.number(operand)
                known = None if value.known is None else -value.known
                return Value(value.kind, f"(-{value.text})", known)
            case ast.BinOp():
                return self._arithmetic(node)
            case ast.Compare():
                return self._comparison(node)
            case ast.BoolOp(op=op, values=values):
                sign = " && " if isinstance(op, ast.And) else " || "
                return Value(BOOL, f"({sign.join(map(self.condition, values))})")
            case ast.IfExp(test=test, body=body, orelse=orelse):
                first = self.value(body)
                second = self.value(orelse)
                kind = self.joined(first.kind, second.kind, node)
                return Value(kind, f"({self.condition(test)} ? {first.text} : {second.text})")
            case ast.Subscript():
                return self._subscript(node)
            case ast.Call():
                return self._call(node)
        fail(self.module, node, "has no translation")

    def joined(self, first: Kind, second: Kind, node: ast.AST) -> Kind:
        """Return the type that takes values of two types."""
        same = first == second or {first, second} <= set(NUMBERS)
        self.require(same, node, "changes a variable's type")
        return first if first == second else max(first, second, key=NUMBERS.index)

    def constant(self, found: Any, name: str, node: ast.AST) -> Value:
        """Translate a value of Python."""
        if getattr(found, "shape", None) == ():
            found = found.item()
        for python, kind in ((bool, BOOL), (int, INT), (float, FLOAT)):
            if isinstance(found, python):
                return Value(kind, number_text(python(found)), python(found))
        if isinstance(found, ModuleType) or callable(found):
            return Value(VOID, name, found)
        self.require(hasattr(found, "__len__"), node)
        return self.translator.table(self.module, name, found)

    def name(self, own: str) -> str:
        """Return a variable's name in C."""
        return f"{own}_" if own in _C_WORDS else own

    def _variable(self, node: ast.Name) -> Value:
        """Translate a variable, or a constant of the module."""
        if node.id in self.kinds:
            own = self.name(node.id)
            behind = node.id in self.parameters and self.kinds[node.id].is_named
            return Value(self.kinds[node.id], f"(*{own})" if behind else own)
        package = self.translator.package
        self.require(
            node.id in self.module.names or node.id in dir(builtins), node, "is not known here"
        )
        _, found = package.find(self.module, node.id)
        self.require(not isinstance(found, ast.FunctionDef), node, "is a function, not a number")
        return self.constant(package.value(self.module, node.id), node.id, node)

    def _attribute(self, node: ast.Attribute) -> Value:
        """Translate a member of a tuple, an array's size, or a constant of another module."""
        owner = self.value(node.value)
        if owner.kind is VOID:
            return self.constant(getattr(owner.known, node.attr), node.attr, node)
        if owner.kind.axes and node.attr == "shape":
            return self.tuple_of(owner.sizes)
        if owner.kind.axes and node.attr == "size":
            return Value(INT, f"({product(owner.sizes)})")
        members = dict(owner.kind.members)
        self.require(node.attr in members, node, "is no member")
        return Value(members[node.attr], f"{owner.text}.{node.attr}")

    def tuple_of(self, items: list[Value], kind: Kind | None = None) -> Value:
        """Join values to a plain tuple, of a type that is stated or of their own."""
        own = kind or self.translator.kinds.tuple([item.kind for item in items])
        inner = [item.text for item in items]
        if own.members[0][0] == "at[0]":
            inner = [f"{{{', '.join(inner)}}}"]
        return Value(own, literal(own, *inner), items=tuple(items))

    def _arithmetic(self, node: ast.BinOp) -> Value:
        left = self.number(node.left)
        right = self.number(node.right)
        kind = FLOAT if FLOAT in (left.kind, right.kind) else INT
        own = type(node.op)
        if own in _ROUNDED and (kind is INT or own is ast.Mod):
            name = f"{kind.tag.removesuffix('64_t')}_{_ROUNDED[own]}"
            return Value(kind, f"{name}({left.text}, {right.text})")
        self.require(own in SIGNS, node)
        if own is ast.Div:
            return Value(FLOAT, f"((double){left.text} / {right.text})")
        return Value(kind, f"({left.text} {SIGNS[own]} {right.text})")

    def _comparison(self, node: ast.Compare) -> Value:
        """Translate comparisons; the middle of a chain is read twice."""
        for each in node.comparators[:-1]:
            self.require(isinstance(each, ast.Name | ast.Constant), node, "computes in a chain")
        values = [self.number(item).text for item in (node.left, *node.comparators)]
        parts = []
        for op, left, right in zip(node.ops, values, values[1:], strict=False):
            self.require(type(op) in _COMPARISONS, node)
            parts.append(f"({left} {_COMPARISONS[type(op)]} {right})")
        return Value(BOOL, parts[0] if len(parts) == 1 else f"({' && '.join(parts)})")

    def _subscript(self, node: ast.Subscript) -> Value:
        """Translate an element or a part of an array, or a member of a tuple."""
        owner = self.value(node.value)
        parts = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
        if owner.kind.axes:
            return self._part(owner, parts, node)
        self.require(owner.kind.members, node)
        at = self.number(parts[0])
        name, kind = owner.kind.members[at.known or 0]
        if at.known is None:
            self.require(name == "at[0]", node, "is no known index of a tuple of several types")
            name = f"at[{at.text}]"
        return Value(kind, f"{owner.text}.{name}")

    def _part(self, owner: Value, parts: list[ast.expr], node: ast.AST) -> Value:
        """Translate an element of an array, or a part without gaps."""
        sizes = owner.sizes
        offset = []
        shape = [own.text for own in sizes[len(parts) :]]
        for axis, part in enumerate(parts):
            start = part
            if isinstance(part, ast.Slice):
                last = axis + 1 == len(parts)
                self.require(last and part.step is None, node, "has gaps between its rows")
                start = part.lower or ast.Constant(0)
                stop = self.number(part.upper) if part.upper else sizes[axis]
                shape.insert(0, f"{stop.text} - {self.number(start).text}")
            at = self.number(start)
            self.require((at.known or 0) >= 0, node, "counts from the end")
            if at.known != 0:
                offset.append(product([at, *sizes[axis + 1 :]]))
        if not shape:
            assert owner.kind.element
            return Value(owner.kind.element, f"{owner.text}.data[{' + '.join(offset) or 0}]")
        kind = ARRAYS[owner.kind.element, len(shape)]
        return Value(kind, literal(kind, " + ".join([f"{owner.text}.data", *offset]), *shape))

    def _call(self, node: ast.Call) -> Value:
        """Translate a call."""
        name = ast.unparse(node.func)
        self.require(not node.keywords, node)
        match node.func:
            case ast.Attribute(value=owner, attr="reshape"):
                return self._array(self.value(owner), "", node.args, node)
            case ast.Attribute(value=owner, attr="copy"):
                own = self.kept(self.value(owner))
                data = f"arena_copy(arena, {own.text}.data, {product(own.sizes)})"
                return Value(own.kind, literal(own.kind, data, *(s.text for s in own.sizes)))
            case ast.Name(id=called):
                home, found = self.translator.package.find(self.module, called)
                if isinstance(found, ast.FunctionDef) and decoration(found):
                    return self._kernel(node, self.translator.function(home, found))
                if isinstance(found, ast.ClassDef):
                    kind = self.translator.kinds.of(home, ast.Name(found.name))
                    values = [self.value(each).text for each in node.args]
                    self.require(len(values) == len(kind.members), node, "leaves members out")
                    return Value(kind, literal(kind, *values))
        if name in ("np.empty", "np.zeros"):
            take = "arena_take" if name == "np.empty" else "arena_zeros"
            shape = node.args[0]
            parts = shape.elts if isinstance(shape, ast.Tuple) else [shape]
            return self._array(Value(ARRAYS[FLOAT, 1], ""), take, parts, node)
        return self._standard(node, name)

    def _array(self, owner: Value, take: str, shape: list[ast.expr], node: ast.AST) -> Value:
        """Translate an array of a shape, that is taken from the arena, or has another's data."""
        sizes = [self.kept(self.number(each)) for each in shape]
        kind = ARRAYS.get((owner.kind.element, len(sizes)))
        self.require(kind and all(own.kind is INT for own in sizes), node)
        assert kind
        data = f"{take}(arena, {product(sizes)})" if take else f"{owner.text}.data"
        return Value(kind, literal(kind, data, *(own.text for own in sizes)))

    def _kernel(self, node: ast.Call, made: Made) -> Value:
        """Translate the call of another kernel."""
        self.require(made.done, node, "calls itself")
        self.require(len(node.args) == len(made.parameters), node, "leaves arguments out")
        texts = ["arena"]
        for each, (name, kind) in zip(node.args, made.parameters.items(), strict=True):
            value = self.value(each)
            problem = f"is a {value.kind.tag}, where a {kind.tag} is expected"
            self.require(value.kind == kind or {value.kind, kind} <= set(NUMBERS), each, problem)
            place = f"&{value.text}"
            if not _PLACE.fullmatch(value.text):
                place = f"({kind.tag}[1]){{{value.text}}}"
            texts.append(place if kind.is_named else value.text)
            given = ast.unparse(each)
            own = [text for text in made.written if text.partition(".")[0] == name]
            self.written |= {given + text.removeprefix(name) for text in own}
        return Value(made.result, f"{made.name}({', '.join(texts)})")

    def _standard(self, node: ast.Call, name: str) -> Value:
        """Translate a function of Python, of its module math or of numpy."""
        if name == "len":
            return self.value(node.args[0]).sizes[0]
        values = [self.number(each) for each in node.args]
        kind = FLOAT if FLOAT in [value.kind for value in values] else INT
        text = values[0].text
        match name:
            case "min" | "max":
                for other in values[1:]:
                    text = f"{kind.tag.removesuffix('64_t')}_{name}({text}, {other.text})"
                return Value(kind, text)
            case "abs":
                return Value(kind, f"{'fabs' if kind is FLOAT else 'llabs'}({text})")
            case "int":
                return Value(INT, f"((int64_t){text})")
            case "float":
                return Value(FLOAT, f"((double){text})")
            case "math.isfinite":
                return Value(BOOL, f"isfinite({text})")
        self.require(name in _LIBRARY, node)
        text = f"{name.partition('.')[2]}({', '.join(value.text for value in values)})"
        if name in ("math.ceil", "math.floor"):  # integers in Python
            return Value(INT, f"((int64_t){text})")
        return Value(FLOAT, text)
