"""Translate expressions of kernels to C."""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from enum import IntEnum
from pathlib import Path
from typing import Any, NamedTuple

from .kinds import ARRAYS, BOOL, FLOAT, INT, VOID, Kind, Kinds, commented
from .sources import Module, Package, TranslationError, c_word, decoration, fail

Rank = IntEnum("Rank", "CHOICE OR AND EQUALITY COMPARISON SUM PRODUCT UNARY PRIMARY")
"""Binding strength of C's operators, the weakest first."""

SIGNS: dict[type, str] = {ast.Mult: "*", ast.Add: "+", ast.Sub: "-", ast.Div: "/"}
_RANKS = {"*": Rank.PRODUCT, "/": Rank.PRODUCT, "==": Rank.EQUALITY, "!=": Rank.EQUALITY}
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
    "math.ceil": (INT, "int_ceil"),
    "math.floor": (INT, "int_floor"),
    "math.isfinite": (BOOL, "isfinite"),
    "int": (INT, "int_of"),
    "abs": (FLOAT, "fabs"),
}
"""Result's type and C name of functions of Python; numpy's others may differ in the last digit."""

NUMBERS: dict[Kind, type] = {BOOL: bool, INT: int, FLOAT: float}
_OF_FLOAT = {INT: ("(int64_t){}", Rank.UNARY), BOOL: ("{} != 0.0", Rank.EQUALITY)}


class Value(NamedTuple):
    """Expression of C.

    Attributes:
        kind: Type of the expression.
        text: Text of the expression, without parentheses around it.
        rank: Binding strength of the outermost operator.
        pointer: For a struct that is reached through a pointer, the pointer's text; else "".
        parts: For an array written as a literal, pointer to its first element, and its sizes.
        places: Variables, or members of variables, whose memory the expression may view.
    """

    kind: Kind
    text: str
    rank: int = Rank.PRIMARY
    pointer: str = ""
    parts: tuple[Value, ...] = ()
    places: frozenset[str] = frozenset()

    def within(self, rank: int) -> str:
        """Return the text as an operand: in parentheses if its operator binds less than `rank`."""
        return self.text if self.rank >= rank else f"({self.text})"

    def member(self, name: str, kind: Kind) -> Value:
        """Return a member of a struct."""
        owner = f"{self.pointer}->" if self.pointer else f"{self.within(Rank.PRIMARY)}."
        places = frozenset(f"{place}.{name}" for place in self.places)
        return Value(kind, f"{owner}{c_word(name)}", places=places)

    def converted(self, kind: Kind) -> Value:
        """Return an integer converted to a float if `kind` is `FLOAT`; else the value unchanged."""
        if kind is not FLOAT or self.kind is not INT:
            return self
        if self.text.isdigit():
            return Value(FLOAT, f"{self.text}.0")
        return Value(FLOAT, f"(double){self.within(Rank.UNARY)}", Rank.UNARY)

    @property
    def data(self) -> Value:
        """Pointer to the first element of an array."""
        return self.parts[0] if self.parts else self.member("data", self.kind)

    @property
    def sizes(self) -> list[Value]:
        """Sizes of an array."""
        if self.parts:
            return [*self.parts[1:]]
        return [self.member(f"size{i}", INT) for i in range(self.kind.axes)]

    @property
    def size(self) -> Value:
        """Number of elements of an array, the product of its sizes."""
        return joined("*", self.sizes)

    @property
    def initializer(self) -> str:
        """Text of the value as the initializer of a variable."""
        return self.text.removeprefix(f"({self.kind.tag})") if self.is_literal else self.text

    @property
    def is_literal(self) -> bool:
        """Test whether the value is a compound literal, a struct without a variable."""
        return self.text.startswith(f"({self.kind.tag}){{")


def joined(sign: str, values: Sequence[Value]) -> Value:
    """Join whole numbers by an operator, from left to right; a single one is returned unchanged."""
    if sign == "*" and all(own.text.isdigit() for own in values):
        return number(math.prod(int(own.text) for own in values))
    whole = values[0]
    for value in values[1:]:
        rank = _RANKS.get(sign, Rank.SUM)
        whole = Value(INT, f"{whole.within(rank)} {sign} {value.within(rank + 1)}", rank)
    return whole


def number(value: float) -> Value:
    """Return the C literal of a number of Python or a float of numpy.

    Raises:
        TypeError: `value` is no number.
    """
    for kind, own in NUMBERS.items():
        if isinstance(value, own):
            text = repr(own(value)).replace("inf", "INFINITY").replace("nan", "NAN")
            text = text.lower() if own is bool else text
            return Value(kind, text, Rank.UNARY if text.startswith("-") else Rank.PRIMARY)
    raise TypeError(f"{value!r} is no number")


def literal(kind: Kind, members: Sequence[str]) -> str:
    """Return the compound literal of a struct, from the texts of its members."""
    inner = ", ".join(members)
    return f"({kind.tag}){{{inner if kind.is_named or kind.axes else f'{{{inner}}}'}}}"


def array(element: Kind | None, data: Value, sizes: Sequence[Value]) -> Value:
    """Return an array from the type of its elements, a pointer to the first one, and the sizes."""
    kind = ARRAYS[element, len(sizes)]
    parts = (data, *sizes)
    return Value(kind, literal(kind, [own.text for own in parts]), parts=parts)


def _inserted(places: Iterable[str], given: dict[str, frozenset[str]]) -> set[str]:
    """Return places that begin with parameters as places of the arguments `given` for these."""
    parts = [place.partition(".") for place in places]
    return {f"{own}{dot}{rest}" for name, dot, rest in parts for own in given[name]}


def _arrays(kind: Kind, place: str = "") -> Iterator[str]:
    """List the places of all arrays in a type: `place`, or its members, each after a dot."""
    if kind.axes:
        yield place
    for name, own in kind.members.items():
        yield from _arrays(own, f"{place}.{name}")


class Use(IntEnum):
    """Uses of translated C.

    Members:
        LIBRARY: The package's library, called from Python.
        CHECKED: The same, which compares each index with its axis.
        CORE: C that somebody reads.
        OWN: The same, of functions of a user's: where their memory is too little, they return.
    """

    LIBRARY = 0
    CHECKED = 1
    CORE = 2
    OWN = 3

    @property
    def is_read(self) -> bool:
        """Test whether the C is exported, so that it has to be readable."""
        return self >= Use.CORE


class Translation:
    """Types, constants and settings that all functions of a translation share.

    Attributes:
        package: The package of the functions.
        kinds: Types of the functions' variables.
        constants: Declarations of constants of modules, by C names.
        numbers: Number of each part by its name in C: of the kernels that have the types of an
            entry, which calls them by their numbers.
        use: What the C is for.
    """

    def __init__(self, folder: Path, use: Use) -> None:
        """Take the folder of a package, and what the C is for."""
        self.package = Package(folder)
        self.use = use
        self.kinds = Kinds(self.package)
        self.constants: dict[str, str] = {}
        self.numbers: dict[str, int] = {}

    def function(self, module: Module, node: ast.FunctionDef) -> Expressions:
        """Return the translation of a function, which is made at the first call."""
        raise NotImplementedError

    def constant(self, name: str, own: Any, about: str) -> Value:
        """Declare a constant with a comment; return its value in C.

        Args:
            name: C name of the constant.
            own: A number, or a sequence of numbers of one type.
            about: The comment, or "".

        Raises:
            TranslationError: Another constant has the name.
        """
        is_table = isinstance(own, Sequence)
        numbers = [number(each) for each in (own if is_table else [own])]
        kind = numbers[0].kind
        items = ", ".join(each.text for each in numbers)
        text = f"{name}[] = {{{items}}}" if is_table else f"{name} = {items}"
        text = commented(f"static const {kind.tag} {text}", about)
        if self.constants.setdefault(name, text) != text:
            raise TranslationError(f"{name} is the name of two constants")
        if not is_table:
            return Value(kind, name)
        data = Value(kind, f"({kind.tag} *){name}", Rank.UNARY)
        return array(kind, data, [number(len(own))])


class Expressions:
    """Translation of the expressions of one function.

    Attributes:
        node: Syntax tree of the function.
        result: Type of the function's result.
        translator: The translation that the function belongs to.
        module: The function's module.
        parameters: Types of the function's parameters.
        kinds: Types of the function's parameters and variables.
        written: Arrays that the function writes, as places in Python.
        aliases: For each variable, or member of one, the places whose memory it may view.
        assigned: Variables that have a value on every path to the current statement.
        lines: Lines of the C body that are translated.
        is_certain: Whether the current expression is evaluated whenever its statement runs.
        uses_arena: Whether the function, or a kernel that it calls, takes memory.
    """

    node: ast.FunctionDef
    result: Kind

    def __init__(
        self, translator: Translation, module: Module, parameters: dict[str, Kind]
    ) -> None:
        """Begin the translation of a function with the types of its parameters."""
        self.translator = translator
        self.module = module
        self.parameters = parameters
        self.kinds = dict(parameters)
        self.written: set[str] = set()
        self.aliases: dict[str, set[str]] = {}
        self.assigned = {*parameters}
        self.lines: list[str] = []
        self.is_certain = True
        self.uses_arena = translator.use is not Use.CORE  # else for those that call it alone
        self._kept = 0

    @property
    def name(self) -> str:
        """Name of the function in C."""
        return self.module.c_name(self.node.name)

    @property
    def views(self) -> dict[str, set[str]]:
        """Parameters, or their members, whose memory each array in the result may view."""
        return {place: self.sources(f"return{place}") for place in _arrays(self.result)}

    def require(self, holds: bool, node: ast.AST, problem: str) -> None:
        """Raise a TranslationError with a problem at a node unless a condition holds."""
        if not holds:
            fail(self.module, node, problem)

    def value(self, node: ast.expr) -> Value:
        """Translate an expression; raise a TranslationError if it has no translation."""
        match node:
            case ast.Name(id=name) if name in self.kinds:
                return self._variable(node)
            case ast.Constant() | ast.Name() | ast.Attribute(value=ast.Name(id="math" | "np")):
                return self._constant(node)
            case ast.Attribute():
                return self._attribute(node)
            case ast.Tuple(elts=items):
                values = [self.value(item) for item in items]
                element = self._wider(values)
                kind = self.translator.kinds.tuple(element, len(values))
                return Value(
                    kind, literal(kind, [own.converted(element).initializer for own in values])
                )
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return Value(BOOL, f"!{self.value(operand).within(Rank.UNARY)}", Rank.UNARY)
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                own = self.value(operand)
                text = f"({own.text})" if own.text.startswith("-") else own.within(Rank.UNARY)
                return Value(own.kind, f"-{text}", Rank.UNARY)
            case ast.BinOp(left=left, op=op, right=right):
                return self._arithmetic(type(op), self.value(left), self.value(right))
            case ast.Compare(left=left, ops=ops, comparators=others):
                between = [self._once(each) for each in others[:-1]]
                values = [self.value(left), *between, self.value(others[-1])]
                return self._comparison(values, [_COMPARISONS[type(op)] for op in ops])
            case ast.BoolOp(op=op, values=items):
                sign, rank = ("&&", Rank.AND) if isinstance(op, ast.And) else ("||", Rank.OR)
                values = [self.value(items[0]), *map(self._uncertain, items[1:])]
                return Value(BOOL, f" {sign} ".join(v.within(Rank.EQUALITY) for v in values), rank)
            case ast.IfExp(test=test, body=body, orelse=orelse):
                head = self.value(test).within(Rank.OR)
                both = [self._uncertain(body), self._uncertain(orelse)]
                kind = self._wider(both)
                first, second = [own.converted(kind).within(Rank.OR) for own in both]
                places = both[0].places | both[1].places
                return Value(kind, f"{head} ? {first} : {second}", Rank.CHOICE, places=places)
            case ast.Subscript(value=ast.Attribute(value=owner, attr="shape"), slice=axis):
                return self.value(owner).sizes[int(self.module.value(axis))]
            case ast.Subscript(value=owner, slice=part):
                return self._part(self._once(owner), getattr(part, "elts", [part]))
            case ast.Call():
                return self._call(node)
        fail(self.module, node, "has no translation")

    def _variable(self, node: ast.Name) -> Value:
        """Translate a parameter or variable; a struct that is a parameter is a pointer in C."""
        name = node.id
        self.require(name in self.assigned, node, "is not assigned on every path here")
        kind = self.kinds[name]
        places = frozenset([name])
        own = Value(kind, c_word(name), places=places)
        if kind.is_named and name in self.parameters:
            return own._replace(text=f"*{own.text}", rank=Rank.UNARY, pointer=own.text)
        return own

    def _uncertain(self, node: ast.expr) -> Value:
        """Translate an expression that is evaluated on a condition only."""
        before = self.is_certain
        self.is_certain = False
        own = self.value(node)
        self.is_certain = before
        return own

    def _once(self, node: ast.expr) -> Value:
        """Translate an expression whose text is repeated in C: a call is kept in a variable."""
        own = self.value(node)
        is_called = any(isinstance(each, ast.Call) for each in ast.walk(node))
        return self._keep(own, node) if is_called and not own.parts else own

    def _keep(self, own: Value, node: ast.expr) -> Value:
        """Keep a value in a new variable, declared before the current statement; return that."""
        self.require(self.is_certain, node, "is needed twice, and not in each case")
        self._kept += 1
        name = f"own_{self._kept}"
        self.lines.append(f"const {own.kind.tag} {name} = {own.initializer};")
        return Value(own.kind, name, places=own.places)

    def sources(self, place: str) -> set[str]:
        """Return the parameters, or members of parameters, whose memory a place may view."""
        found = {place}
        waiting = [place]
        while waiting:
            own = waiting.pop()
            for name, others in self.aliases.items():
                if own == name or own.startswith(f"{name}."):
                    new = {other + own.removeprefix(name) for other in others} - found
                    found |= new
                    waiting += new
        return {own for own in found if own.partition(".")[0] in self.parameters}

    def _named(self, kind: Kind, text: str, views: Mapping[str, Iterable[str]]) -> Value:
        """Return a value whose members, by their names after a dot, may view the given places."""
        place = f"own {len(self.aliases)}"
        self.aliases |= {f"{place}{member}": {*places} for member, places in views.items()}
        return Value(kind, text, places=frozenset([place]))

    def _wider(self, values: list[Value]) -> Kind:
        """Return `FLOAT` if one of the values is a float, else the first type."""
        return next((own.kind for own in values if own.kind is FLOAT), values[0].kind)

    def _constant(self, node: ast.expr) -> Value:
        """Translate a literal number or a module's constant, a number or a sequence of numbers."""
        found = self.module.value(node)
        if not isinstance(node, ast.Name):
            return number(found)
        home, _ = self.translator.package.find(self.module, node.id)
        about = home.about.get(node.id, "")
        return self.translator.constant(home.c_name(node.id), found, about)

    def _attribute(self, node: ast.Attribute) -> Value:
        """Translate a member of a named tuple, a record or an enumeration, or an array's size."""
        name = ast.unparse(node.value)
        home, found = self.translator.package.find(self.module, name)
        if name not in self.kinds and isinstance(found, ast.ClassDef):
            kind = self.translator.kinds.of(home, found)
            return Value(kind, f"{home.c_name(found.name)}_{node.attr}")
        owner = self.value(node.value)
        if owner.kind.axes and node.attr == "size":
            return owner.size
        own = owner.member(node.attr, owner.kind.members[node.attr])
        if owner.kind.sizes and own.kind in NUMBERS:
            return self._number(owner, node.attr, own)
        return own

    def _number(self, owner: Value, name: str, own: Value) -> Value:
        """Translate a number of a record, where integers and truth values are stored as floats."""
        pointer = owner.member("at", FLOAT).text
        found = owner._replace(pointer=pointer).member(name, FLOAT)
        text, rank = _OF_FLOAT.get(own.kind, ("{}", Rank.PRIMARY))
        return Value(own.kind, text.format(found.text), rank, places=own.places)

    def _comparison(self, values: list[Value], signs: list[str]) -> Value:
        """Translate a chain of comparisons by signs between neighbouring values."""
        kind = self._wider(values)
        texts = [own.converted(kind).within(Rank.SUM) for own in values]
        parts = [f"{a} {sign} {b}" for a, sign, b in zip(texts, signs, texts[1:], strict=False)]
        rank = Rank.AND if len(parts) > 1 else _RANKS.get(signs[0], Rank.COMPARISON)
        return Value(BOOL, " && ".join(parts), rank)

    def _arithmetic(self, op: type, left: Value, right: Value) -> Value:
        """Translate a binary operation; both operands are floats if one is, or by ``/``."""
        kind = FLOAT if FLOAT in (left.kind, right.kind) or op is ast.Div else INT
        both = [left.converted(kind), right.converted(kind)]
        if op in _ROUNDED:
            return Value(kind, f"{kind.word}_{_ROUNDED[op]}({both[0].text}, {both[1].text})")
        return joined("/" if op is ast.Div else SIGNS[op], both)._replace(kind=kind)

    def _part(self, owner: Value, parts: list[ast.expr]) -> Value:
        """Translate an element of an array, a part of one without gaps, or an item of a tuple."""
        element = owner.kind.element
        assert element
        if owner.kind.members:
            item = self._checked(self.value(parts[0]), number(len(owner.kind.members))).text
            return Value(element, f"{owner.within(Rank.PRIMARY)}.at[{item}]")
        *_, last = parts
        sizes = owner.sizes
        ends = sizes[: len(parts)]
        shape = sizes[len(parts) :]
        if isinstance(last, ast.Slice):
            self.require(last.step is None, last, "has gaps between its rows")
            size = ends[-1]
            ends[-1] = joined("+", [size, number(1)])
            if last.upper:
                size = self._checked(self._once(last.upper), ends[-1])
            if last.lower:
                size = joined("-", [size, self._once(last.lower)])
            shape.insert(0, self._checked(size, ends[-1]))
            parts = [*parts[:-1], last.lower or ast.Constant(0)]
        offsets = [self._offset(part, ends[k], sizes[k + 1 :]) for k, part in enumerate(parts)]
        offsets = [own for own in offsets if own.text != "0"]
        if shape:
            whole = array(element, joined("+", [owner.data, *offsets]), shape)
            return whole._replace(places=owner.places)
        first = re.sub(r"^\(\(\w+ \*\)(\w+)\)$", r"\1", owner.data.within(Rank.PRIMARY))
        inner = joined("+", offsets).text if offsets else "0"
        return Value(element, f"{first}[{inner}]", places=owner.places)

    def _checked(self, index: Value, size: Value) -> Value:
        """Return an index; in a checked build, one that is compared with a size when the C runs."""
        if self.translator.use is not Use.CHECKED:
            return index
        return Value(INT, f"checked({index.text}, {size.text})")

    def _offset(self, node: ast.expr, size: Value, steps: list[Value]) -> Value:
        """Translate an index along an axis into the number of elements before it in memory."""
        self.require(not isinstance(node, ast.Slice), node, "has gaps between its rows")
        self.require(not isinstance(node, ast.UnaryOp), node, "counts from the end")
        at = self._checked(self.value(node), size)
        if at.text == "0" or not steps:
            return at
        return joined("*", steps if at.text == "1" else [at, *steps])

    def _call(self, node: ast.Call) -> Value:
        """Translate a call: of a kernel, a class, a method, or a function of Python or numpy."""
        self.require(not node.keywords, node, "has no translation")
        name = ast.unparse(node.func)
        match node.func:
            case ast.Attribute(value=owner, attr="copy"):
                own = self._once(owner)
                return self._taken(own.kind.element, "copy", [own.data, own.size], own.sizes)
            case ast.Attribute(value=owner, attr="reshape"):
                own = self._once(owner)
                shape = [*map(self._once, node.args)]
                if self.translator.use is Use.CHECKED:
                    texts = [own.size.text, joined("*", shape).text, shape[0].text]
                    shape[0] = Value(INT, f"shaped({', '.join(texts)})")
                return array(own.kind.element, own.data, shape)._replace(places=own.places)
            case ast.Attribute(value=record, attr="of"):
                kind = self.translator.kinds.of(self.module, record)
                return self._record(kind, *map(self.value, node.args))
            case ast.Attribute(value=record, attr="width"):
                kind = self.translator.kinds.of(self.module, record)
                return number(kind.sizes[""])
            case ast.Attribute(value=ast.Name(id="np"), attr="empty" | "zeros" as word):
                shape = [*map(self._once, getattr(node.args[0], "elts", node.args))]
                return self._taken(FLOAT, word, [joined("*", shape)], shape)
        home, found = self.translator.package.find(self.module, name)
        if isinstance(found, ast.FunctionDef) and decoration(found):
            return self._kernel(node, home, found)
        values = [self.value(each) for each in node.args]
        if isinstance(found, ast.ClassDef):
            kind = self.translator.kinds.of(home, found)
            given = [*zip(values, kind.members.items(), strict=True)]
            texts = [own.converted(each).initializer for own, (_, each) in given]
            views = {f".{name}": own.places for own, (name, _) in given}
            return self._named(kind, literal(kind, texts), views)
        return self._standard(name, values)

    def _record(self, kind: Kind, numbers: Value, *given: Value) -> Value:
        """Translate the view of an array as a record; a missing last size is computed."""
        fixed, *shared = kind.sizes.values()
        own = numbers.size.text
        sizes = [each.text for each in given]
        pairs = zip(sizes, shared, strict=False)
        asked = " + ".join([str(fixed), *(f"{count} * ({size})" for size, count in pairs)])
        if len(shared) == len(sizes) + 1:
            sizes.append(f"int_max(0, ({own} - ({asked})) / {shared[-1]})")
            asked += f" + {shared[-1]} * {sizes[-1]}"
        if self.translator.use is Use.CHECKED:
            text = Value(INT, f"shaped({own}, {asked}, {own})")
            numbers = array(FLOAT, numbers.data, [text])._replace(places=numbers.places)
        views = {f".{name}": numbers.places for name in kind.members}
        for name, own_kind in kind.members.items():
            views |= {f".{name}.{each}": numbers.places for each in own_kind.members}
        return self._named(kind, f"{kind.tag}_of({', '.join([numbers.text, *sizes])})", views)

    def _taken(
        self, element: Kind | None, word: str, given: list[Value], sizes: list[Value]
    ) -> Value:
        """Return an array in memory that the function takes from its arena.

        Args:
            element: Type of the elements.
            word: How the memory begins: ``empty``, ``zeros`` or ``copy``.
            given: Number of the elements, after the pointer that a copy is made from.
            sizes: Sizes of the array.
        """
        assert element
        self.uses_arena = True
        texts = ", ".join(["arena", *(own.text for own in given)])
        data = Value(element, f"({element.tag} *)arena_{word}({texts})", Rank.UNARY)
        if self.translator.use is Use.OWN:
            data = self._checked_memory(element, word, [own.text for own in given])
        return array(element, data, sizes)

    def _checked_memory(self, element: Kind, word: str, given: list[str]) -> Value:
        """Take memory for `_taken`, before which the function ends if there is too little."""
        self.require(self.is_certain, self.node, "takes memory in some cases alone")
        self._kept += 1
        name = f"own_{self._kept}"
        size = f"8 * (size_t)({given[-1]})"
        fill = {
            "zeros": f"memset({name}, 0, {size});",
            "copy": f"memcpy({name}, {given[0]}, {size});",
        }
        self.lines += [
            f"{element.tag} *const {name} = ({element.tag} *)arena_empty(arena, {given[-1]});",
            "if (arena->full) {",
            "    arena_leave(arena, &mark);",
            "    return;" if self.result is VOID else f"    return ({self.result.tag}){{0}};",
            "}",
            *[fill[word]] * (word in fill),
        ]
        return Value(element, name)

    def _kernel(self, node: ast.Call, home: Module, found: ast.FunctionDef) -> Value:
        """Translate the call of another kernel."""
        own = self.translator.function(home, found)
        self.uses_arena |= own.uses_arena
        texts = ["arena"] * own.uses_arena
        given = {}
        for each, (name, kind) in zip(node.args, own.parameters.items(), strict=True):
            value = self.value(each).converted(kind)
            texts.append(self._address(value, each) if value.kind.is_named else value.text)
            given[name] = value.places
        self.written |= _inserted(own.written, given)
        views = {member: _inserted(places, given) for member, places in own.views.items()}
        return self._named(own.result, f"{own.name}({', '.join(texts)})", views)

    def _address(self, value: Value, node: ast.expr) -> str:
        """Return the text of a struct's address; the result of a call is kept in a variable."""
        if any(isinstance(each, ast.Call) for each in ast.walk(node)):
            value = self._keep(value, node)
        return value.pointer or f"&{value.text}"

    def _standard(self, name: str, values: list[Value]) -> Value:
        """Translate a call of a function of Python, of `math` or of numpy, by its dotted name."""
        kind = self._wider(values)
        if name == "len":
            return values[0].sizes[0]
        if name == "float":
            return values[0].converted(FLOAT)
        own = (kind, f"{kind.word}_{name}")
        result, word = own if name in ("min", "max") else _FUNCTIONS[name]
        given = kind if name in ("min", "max") else FLOAT
        texts = [own.converted(given).text for own in values]
        return Value(result, f"{word}({', '.join(texts)})")
