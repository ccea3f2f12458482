"""Expressions of a kernel, as C."""

from __future__ import annotations

import ast
import builtins
import re
from dataclasses import dataclass, field
from types import ModuleType
from typing import TYPE_CHECKING, Any

from .kinds import BOOL, FLOAT, INT, INT_VECTOR, VECTOR, VOID, Array, Kind, Struct, array_of
from .sources import ENTRY, Constants, Module, decoration, fail

if TYPE_CHECKING:
    from .translator import Translator

ATOM = 15
UNARY = 14
CONDITIONAL = 3
"""Precedences: of a name, of a sign, and of the conditional operator."""

_OPERATORS: dict[type, tuple[str, int]] = {
    ast.Mult: ("*", 13),
    ast.Div: ("/", 13),
    ast.Add: ("+", 12),
    ast.Sub: ("-", 12),
    ast.LShift: ("<<", 11),
    ast.RShift: (">>", 11),
    ast.Lt: ("<", 10),
    ast.LtE: ("<=", 10),
    ast.Gt: (">", 10),
    ast.GtE: (">=", 10),
    ast.Eq: ("==", 9),
    ast.NotEq: ("!=", 9),
    ast.BitAnd: ("&", 8),
}

_EXACT = {"abs": "fabs"} | {name: name for name in ["sqrt", "ceil", "floor", "copysign"]}
"""Functions of C whose results are exact or rounded correctly, of whichever library they are."""

_LIBRARY = _EXACT | {name: name for name in ["sin", "cos", "atan2", "tanh", "exp", "log"]}
"""All functions of C: those of the module math. Numpy's own may differ in the last digit."""

_C_WORDS = """
auto bool break case char const continue default do double else enum extern float for goto
if inline int long register restrict return short signed sizeof static struct switch
typedef union unsigned void volatile while arena vector matrix cube sqrt sin cos tan tanh
exp log pow floor ceil round fabs fmod fmin fmax atan2 copysign isfinite int_min int_max
double_min double_max failed
"""
"""Words of C and of kernels.h that no variable is called."""


@dataclass
class Value:
    """An expression of C.

    Attributes:
        kind: Its type.
        text: The expression.
        level: Precedence of its outermost operator.
        known: Its value, if it is a constant.
        items: The values that a tuple was made of.
        pointer: Whether it is a pointer to a named tuple.
    """

    kind: Kind
    text: str
    level: int = ATOM
    known: Any = None
    items: list[Value] = field(default_factory=list)
    pointer: bool = False

    def at(self, level: int) -> str:
        """Return the expression, in parentheses where its precedence is below a level."""
        return self.text if self.level >= level else f"({self.text})"

    def member(self, name: str, kind: Kind) -> Value:
        """Return a member of a tuple."""
        return Value(kind, f"{self.at(ATOM)}{'->' if self.pointer else '.'}{name}")

    def sizes(self) -> list[Value]:
        """Return the sizes of an array."""
        assert isinstance(self.kind, Array)
        return [Value(INT, f"{self.at(ATOM)}.size{i}") for i in range(self.kind.axes)]


def number_text(value: float) -> str:
    """Write a number as C does."""
    text = repr(value).replace("inf", "INFINITY").replace("nan", "NAN")
    return text.lower() if isinstance(value, bool) else text


def literal(kind: Kind, *members: str) -> str:
    """Return a value of a struct of C."""
    inner = ", ".join(members)
    return f"({kind.tag}){{{inner}}}"


class Expressions:
    """Translation of the expressions of one function.

    Attributes:
        translator: The translation that the function belongs to.
        module: The function's module.
        kinds: Types of its parameters and variables.
        parameters: Names of its parameters.
        scope: Variables of the loops that are being translated.
        lines: Lines of C.
        written: Names of the arrays that are written into.
    """

    def __init__(self, translator: Translator, module: Module) -> None:
        """Begin the translation of a function."""
        self.translator = translator
        self.module = module
        self.kinds: dict[str, Kind] = {}
        self.parameters: set[str] = set()
        self.scope: list[str] = []
        self.lines: list[str] = []
        self.written: set[str] = set()
        self._count = 0

    def require(self, holds: object, node: ast.AST, problem: str = "has no translation") -> None:
        """Refuse a node unless something holds."""
        if not holds:
            fail(self.module, node, problem)

    def add(self, text: str) -> None:
        """Add a line, indented by the blocks that are open."""
        depth = 1 + sum(line.endswith("{") for line in self.lines)
        depth -= sum(line.lstrip().startswith("}") for line in self.lines) + text.startswith("}")
        self.lines.append("    " * depth + text)

    def fresh(self) -> str:
        """Return a name that no variable has."""
        self._count += 1
        return f"own_{self._count}"

    def kept(self, value: Value) -> Value:
        """Keep a value in a variable of C."""
        if value.known is not None:
            return value
        own = Value(value.kind, self.fresh())
        self.add(f"const {own.kind.tag} {own.text} = {self.content(value)};")
        return own

    def value(self, node: ast.expr) -> Value:
        """Translate an expression."""
        translate = getattr(self, f"on_{type(node).__name__.lower()}", None)
        self.require(translate, node)
        value: Value = translate(node)  # type: ignore[misc]
        return value

    def number(self, node: ast.expr) -> Value:
        """Translate an expression that is a number."""
        value = self.value(node)
        self.require(value.kind in (INT, FLOAT, BOOL), node, "is no number")
        return value

    def name(self, own: str) -> str:
        """Return a variable's name in C."""
        return f"{own}_" if re.search(rf"\b{own}\b", _C_WORDS) else own

    def on_constant(self, node: ast.Constant) -> Value:
        """Translate a literal."""
        return self.constant(node.value, "", node)

    def constant(self, found: Any, name: str, node: ast.AST) -> Value:
        """Translate a value of Python."""
        if getattr(found, "shape", None) == ():
            found = found.item()
        for python, kind in ((bool, BOOL), (int, INT), (float, FLOAT)):
            if isinstance(found, python):
                text = number_text(python(found))
                return Value(kind, text, UNARY if text[0] == "-" else ATOM, python(found))
        if isinstance(found, ModuleType | Constants) or callable(found):
            return Value(VOID, name, known=found)
        self.require(hasattr(found, "__len__"), node)
        return self.translator.table(self.module, name, found)

    def on_name(self, node: ast.Name) -> Value:
        """Translate a variable or a constant of the module."""
        if node.id in self.kinds:
            kind = self.kinds[node.id]
            pointer = node.id in self.parameters and getattr(kind, "is_named", False)
            return Value(kind, self.name(node.id), pointer=pointer)
        _, found = self.translator.package.find(self.module, node.id)
        self.require(not isinstance(found, ast.FunctionDef), node, "is a function, not a number")
        known = node.id in self.module.names or hasattr(builtins, node.id)
        self.require(known, node, "is not known here")
        return self.constant(self.translator.package.value(self.module, node.id), node.id, node)

    def on_attribute(self, node: ast.Attribute) -> Value:
        """Translate a member of a tuple, an array's size, or a constant of another module."""
        owner = self.value(node.value)
        if owner.kind is VOID:
            return self.constant(getattr(owner.known, node.attr), node.attr, node)
        if isinstance(owner.kind, Array):
            self.require(node.attr in ("size", "shape"), node)
            sizes = owner.sizes()
            if node.attr == "shape":
                return self.tuple_of(sizes)
            return Value(INT, " * ".join(own.text for own in sizes), 13 if len(sizes) > 1 else ATOM)
        members = dict(getattr(owner.kind, "members", ()))
        self.require(node.attr in members, node, "is no member")
        return owner.member(node.attr, members[node.attr])

    def on_tuple(self, node: ast.Tuple) -> Value:
        """Translate a tuple."""
        return self.tuple_of([self.value(item) for item in node.elts])

    def tuple_of(self, items: list[Value], kind: Struct | None = None) -> Value:
        """Join values to a plain tuple, of a type that is stated or of their own."""
        own = kind or self.translator.kinds.tuple([item.kind for item in items])
        inner = ", ".join(self.content(item) for item in items)
        text = literal(own, f"{{{inner}}}" if own.same else inner)
        return Value(own, text, UNARY, items=items)

    def content(self, value: Value) -> str:
        """Return a value, also where it is behind a pointer."""
        return f"*{value.text}" if value.pointer else value.text

    def on_unaryop(self, node: ast.UnaryOp) -> Value:
        """Translate a sign or a negation."""
        value = self.number(node.operand)
        if isinstance(node.op, ast.Not):
            return Value(BOOL, f"!{value.at(UNARY)}", UNARY)
        self.require(isinstance(node.op, ast.USub), node)
        if value.known is not None:
            return self.constant(-value.known, "", node)
        return Value(value.kind, f"-{value.at(ATOM)}", UNARY)

    def on_binop(self, node: ast.BinOp) -> Value:
        """Translate an arithmetic operation."""
        left = self.number(node.left)
        right = self.number(node.right)
        kind = type(node.op)
        both = FLOAT if FLOAT in (left.kind, right.kind) else INT
        if kind in (ast.FloorDiv, ast.Mod):
            word = "quotient" if kind is ast.FloorDiv else "remainder"
            self.require(both is INT or kind is ast.Mod, node)
            return Value(both, f"{both.tag.removesuffix('64_t')}_{word}({left.text}, {right.text})")
        self.require(kind in _OPERATORS, node)
        sign, level = _OPERATORS[kind]
        if kind is ast.Div:
            both = FLOAT
            if left.kind is not FLOAT:
                left = Value(FLOAT, f"(double){left.at(UNARY)}", UNARY)
        return Value(both, f"{left.at(level)} {sign} {right.at(level + 1)}", level)

    def on_compare(self, node: ast.Compare) -> Value:
        """Translate comparisons; the middle of a chain is read twice."""
        values = [self.number(item) for item in (node.left, *node.comparators)]
        self.require(not any("(" in own.text for own in values[1:-1]), node, "calls in a chain")
        parts = []
        for op, left, right in zip(node.ops, values, values[1:], strict=False):
            self.require(type(op) in _OPERATORS, node)
            sign, level = _OPERATORS[type(op)]
            parts.append(Value(BOOL, f"{left.at(11)} {sign} {right.at(11)}", level))
        return parts[0] if len(parts) == 1 else self._joined("&&", 5, parts)

    def on_boolop(self, node: ast.BoolOp) -> Value:
        """Translate ``and`` and ``or`` of conditions."""
        sign, level = ("&&", 5) if isinstance(node.op, ast.And) else ("||", 4)
        return self._joined(sign, level, [self.condition(item) for item in node.values])

    def condition(self, node: ast.expr) -> Value:
        """Translate a condition."""
        value = self.number(node)
        self.require(value.kind is not FLOAT, node, "is no condition")
        return value

    def _joined(self, sign: str, level: int, parts: list[Value]) -> Value:
        # In parentheses also where C needs none: compilers ask for those.
        return Value(BOOL, f" {sign} ".join(part.at(6) for part in parts), level)

    def on_ifexp(self, node: ast.IfExp) -> Value:
        """Translate a conditional expression."""
        test = self.condition(node.test)
        first = self.value(node.body)
        second = self.value(node.orelse)
        kind = self.joined(first.kind, second.kind, node)
        text = f"{test.at(4)} ? {self.cast(first, kind)} : {self.cast(second, kind)}"
        return Value(kind, text, CONDITIONAL)

    def joined(self, first: Kind | None, second: Kind, node: ast.AST) -> Kind:
        """Return the type of a variable that takes values of both types."""
        if first is None or first == second:
            return second
        self.require({first, second} <= {INT, FLOAT, BOOL}, node, "changes a variable's type")
        return FLOAT if FLOAT in (first, second) else INT

    def cast(self, value: Value, kind: Kind) -> str:
        """Return a value as one of a type."""
        text = self.content(value)
        if value.kind in (INT, BOOL) and kind is FLOAT:
            return f"(double){value.at(UNARY)}"
        return text if value.level > CONDITIONAL or value.pointer else f"({text})"

    def on_subscript(self, node: ast.Subscript) -> Value:
        """Translate an element or a part of an array, or a member of a tuple."""
        owner = self.value(node.value)
        parts = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
        if isinstance(owner.kind, Struct):
            return self._member(owner, parts[0])
        self.require(isinstance(owner.kind, Array), node)
        return self._part(owner, parts, node)

    def _member(self, owner: Value, index: ast.expr) -> Value:
        at = self.number(index)
        assert isinstance(owner.kind, Struct)
        if at.known is None:
            self.require(owner.kind.same, index, "is no known index of a tuple of several types")
            return owner.member(f"at[{at.text}]", owner.kind.same or VOID)
        return owner.items[at.known] if owner.items else owner.member(*owner.kind.members[at.known])

    def _part(self, owner: Value, parts: list[ast.expr], node: ast.AST) -> Value:
        """Translate an element of an array, or a part without gaps."""
        array = owner.kind
        assert isinstance(array, Array)
        sizes = owner.sizes()
        offset: list[str] = []
        shape: list[str] = []
        for axis, part in enumerate(parts):
            start, size = self._range(part, sizes[axis])
            self.require(size is None or axis + 1 == len(parts), node, "has gaps between its rows")
            shape += [] if size is None else [size]
            if start.known != 0:
                strides = [own.text for own in sizes[axis + 1 :]]
                offset.append(" * ".join([start.at(13), *strides]))
        shape += [own.text for own in sizes[len(parts) :]]
        at = " + ".join(offset)
        if not shape:
            return Value(array.element, f"{owner.at(ATOM)}.data[{at or 0}]")
        kind = array_of(array.element, len(shape))
        assert kind is not None
        data = " + ".join([f"{owner.at(ATOM)}.data", *offset])
        return Value(kind, literal(kind, data, *shape), UNARY)

    def _range(self, part: ast.expr, size: Value) -> tuple[Value, str | None]:
        """Return the first index along an axis, and the number of them; None for one index."""
        if not isinstance(part, ast.Slice):
            at = self.number(part)
            return (
                Value(INT, f"{size.text} - {-at.known}", 12) if (at.known or 0) < 0 else at
            ), None
        self.require(part.step is None, part, "is a slice with a step")
        start = self.number(part.lower) if part.lower else Value(INT, "0", known=0)
        stop = self.number(part.upper) if part.upper else size
        return start, stop.text if start.known == 0 else f"{stop.at(12)} - {start.at(13)}"

    def on_call(self, node: ast.Call) -> Value:
        """Translate a call."""
        self.require(not node.keywords or ast.unparse(node.func) == "np.empty", node)
        if isinstance(node.func, ast.Attribute) and node.func.attr in ("reshape", "copy"):
            return self._method(node, node.func.attr, self.value(node.func.value))
        name = ast.unparse(node.func)
        if name in ("np.empty", "np.zeros"):
            return self._made(node, name)
        if isinstance(node.func, ast.Name):
            home, found = self.translator.package.find(self.module, node.func.id)
            if isinstance(found, ast.FunctionDef) and decoration(found):
                return self._called(node, home, found)
            if isinstance(found, ast.ClassDef):
                return self._named(node, home, found)
        return self._standard(node, name.rpartition(".")[2])

    def _method(self, node: ast.Call, name: str, owner: Value) -> Value:
        """Translate ``array.reshape`` and ``array.copy``."""
        self.require(isinstance(owner.kind, Array), node)
        assert isinstance(owner.kind, Array)
        shape = owner.sizes()
        if name == "copy":
            size = " * ".join(own.text for own in shape)
            data = f"arena_copy(arena, {owner.at(ATOM)}.data, {size})"
        else:
            shape = [self.number(each) for each in node.args]
            data = f"{owner.at(ATOM)}.data"
        kind = array_of(owner.kind.element, len(shape))
        self.require(kind, node)
        assert kind is not None
        return Value(kind, literal(kind, data, *(own.text for own in shape)), UNARY)

    def _made(self, node: ast.Call, name: str) -> Value:
        """Translate the making of an array, which is given back where the function returns."""
        given = self.value(node.args[0])
        shape = given.items or [given]
        kind = array_of(INT if len(node.args) + len(node.keywords) > 1 else FLOAT, len(shape))
        self.require(kind and all(own.kind is INT for own in shape), node)
        assert kind is not None
        shape = [own if own.text.replace("_", "").isalnum() else self.kept(own) for own in shape]
        size = " * ".join(own.text for own in shape)
        take = "arena_take" if name == "np.empty" else "arena_zeros"
        text = literal(kind, f"{take}(arena, {size})", *(own.text for own in shape))
        return Value(kind, text, UNARY)

    def _named(self, node: ast.Call, home: Module, found: ast.ClassDef) -> Value:
        """Translate the making of a named tuple."""
        kind = self.translator.kinds.of(home, ast.Name(found.name))
        assert isinstance(kind, Struct)
        values = [self.value(each) for each in node.args]
        self.require(len(values) == len(kind.members), node, "leaves members out")
        pairs = zip(values, kind.members, strict=True)
        return Value(
            kind, literal(kind, *(self.cast(own, member[1]) for own, member in pairs)), UNARY
        )

    def _called(self, node: ast.Call, home: Module, found: ast.FunctionDef) -> Value:
        """Translate the call of another kernel."""
        made = self.translator.function(home, found)
        self.require(made.text or decoration(found) == ENTRY, node, "calls itself")
        self.require(len(node.args) == len(made.parameters), node, "leaves arguments out")
        pairs = zip(node.args, made.parameters.values(), strict=True)
        texts = [self._argument(each, kind) for each, kind in pairs]
        given = [node.args[i] for i in made.written]
        self.written |= {each.id for each in given if isinstance(each, ast.Name)}
        return Value(made.result, f"{made.name}({', '.join(['arena', *texts])})")

    def _argument(self, node: ast.expr, kind: Kind) -> str:
        """Return an argument for a parameter of a type: a named tuple's address."""
        value = self.value(node)
        same = value.kind == kind or {value.kind, kind} <= {INT, FLOAT, BOOL}
        self.require(same, node, f"is a {value.kind.tag}, where a {kind.tag} is expected")
        if not getattr(kind, "is_named", False):
            return value.text
        if value.pointer:
            return value.text
        return (
            f"&{value.text}"
            if value.level == ATOM and "(" not in value.text
            else (f"({kind.tag}[1]){{{value.text}}}")
        )

    def _standard(self, node: ast.Call, name: str) -> Value:
        """Translate a function of Python, of its module math or of numpy."""
        if name == "len":
            return self.value(node.args[0]).sizes()[0]
        values = [self.number(each) for each in node.args]
        first = values[0]
        if name in ("min", "max"):
            return self._extreme(name, values)
        if name in ("int", "float"):
            kind = INT if name == "int" else FLOAT
            return Value(kind, f"({kind.tag}){first.at(UNARY)}", UNARY)
        if name == "abs" and first.kind is not FLOAT:
            return Value(INT, f"llabs({first.text})")
        if name == "isfinite":
            return Value(BOOL, f"isfinite({first.text})")
        self.require(name in _LIBRARY, node)
        is_exact = name in _EXACT or not ast.unparse(node.func).startswith("np.")
        self.require(is_exact, node, "may have other last digits than that of the module math")
        text = f"{_LIBRARY[name]}({', '.join(value.text for value in values)})"
        # Those of the module math are integers.
        if ast.unparse(node.func) in ("math.ceil", "math.floor"):
            return Value(INT, f"(int64_t){text}", UNARY)
        return Value(FLOAT, text)

    def _extreme(self, name: str, values: list[Value]) -> Value:
        """Translate ``min`` and ``max``, from the left to the right."""
        kind = FLOAT if FLOAT in [value.kind for value in values] else INT
        text = values[0].text
        for other in values[1:]:
            text = f"{kind.tag.removesuffix('64_t')}_{name}({text}, {other.text})"
        return Value(kind, text)


def table_kind(values: Any) -> Array:
    """Return the type of a table of numbers."""
    return INT_VECTOR if values and isinstance(values[0], int) else VECTOR
