"""Values of the translation: C expressions with their types and what is known of them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

ATOM = 16
UNARY = 14
CONDITIONAL = 3
"""Precedences of C."""


class Known:
    """A number or a table that is known when the code is made.

    Attributes:
        value: The number, or the table (k,).
        used: Whether the code that was made depends on it.
    """

    __slots__ = ("_sources", "used", "value")

    def __init__(self, value: Any, *sources: Known | None) -> None:
        """Take a value that was computed from those of `sources`."""
        self.value = value
        self.used = False
        self._sources = sources

    def use(self) -> Any:
        """Return the value; the code depends on it from now on."""
        if not self.used:
            self.used = True
            for source in self._sources:
                if source is not None:
                    source.use()
        return self.value


class Storage:
    """Numbers that pointers point to: a pointer through which nobody writes is one to const.

    Attributes:
        number: Its number in the marks of declarations.
        written: Whether something is written.
        local: Name of the function that it lives in; "" for what outlives the functions.
        sources: Storages that are written too where this one is.
    """

    __slots__ = ("local", "number", "sources", "written")

    all: list[Storage] = []  # noqa: RUF012  cleared by each translation

    def __init__(self, local: str = "") -> None:
        """Begin as one that nobody writes into."""
        self.number = len(Storage.all)
        self.written = False
        self.local = local
        self.sources: list[Storage] = []
        Storage.all.append(self)

    def write(self) -> None:
        """Note that something is written."""
        if not self.written:
            self.written = True
            for source in self.sources:
                source.write()

    def passes_to(self, source: Storage) -> None:
        """Note that what is written here is written into another storage."""
        self.sources.append(source)
        if self.written:
            source.write()


def qualified(text: str) -> str:
    """Replace the marks of pointers in a C text by ``const`` or nothing."""
    return re.sub(
        "\0(\\d+)\0", lambda mark: "" if Storage.all[int(mark[1])].written else "const ", text
    )


@dataclass(frozen=True)
class Scalar:
    """An ``int``, ``double`` or ``bool``."""

    name: str


INT = Scalar("int")
DOUBLE = Scalar("double")
BOOL = Scalar("bool")


@dataclass(frozen=True)
class Array:
    """A pointer to numbers.

    Attributes:
        element: Type of a number.
        shape: Lengths along the axes: known ones, or a C expression.
        storage: Storage of the numbers.
        content: The numbers themselves where they are known, a flat table (k,).
    """

    element: Scalar
    shape: tuple[Known | str, ...]
    storage: Storage
    content: Known | None = None

    @property
    def in_table(self) -> bool:
        """Test whether the numbers are read while the code is made, and never by it."""
        return self.element is INT and self.content is not None


@dataclass(frozen=True)
class Struct:
    """A named tuple, or a tuple of different types.

    Attributes:
        tag: Name of the struct in C.
        fields: Types by the fields' names.
    """

    tag: str
    fields: dict[str, Any]

    @property
    def holds_arrays(self) -> bool:
        """Test whether a field is an array."""
        return any(isinstance(kind, Array) for kind in self.fields.values())


@dataclass(frozen=True)
class Tuple:
    """A tuple of values of one type, an array inside of a struct in C."""

    element: Any
    length: int

    @property
    def tag(self) -> str:
        """Name of the struct in C."""
        name = {2: "pair", 3: "triple", 4: "quadruple"}.get(self.length, f"tuple_{self.length}")
        if self.element is DOUBLE:
            return name
        return f"{name}_of_{getattr(self.element, 'tag', '') or self.element.name}s"


@dataclass(frozen=True)
class Object:
    """Something of Python's: a module, a function, a class."""

    value: Any


@dataclass
class Value:
    """A C expression.

    Attributes:
        kind: Its type.
        text: The expression.
        level: Precedence of its outermost operator.
        known: Its value, if it is known.
        pointer: Whether it points to its struct.
        items: The values of a tuple that has not been written yet.
    """

    kind: Any
    text: str = ""
    level: int = ATOM
    known: Known | None = None
    pointer: bool = False
    items: list[Value] = field(default_factory=list)

    def at(self, level: int) -> str:
        """Return the expression as an operand of an operator of a precedence."""
        return self.text if self.level >= level else f"({self.text})"

    @property
    def is_literal(self) -> bool:
        """Test whether the expression is an integer as such."""
        return self.known is not None and self.text.lstrip("-").isdigit()

    def field(self, name: str) -> Value:
        """Return a field of a struct."""
        arrow = "->" if self.pointer else "."
        return Value(self.kind.fields[name], f"{self.at(ATOM)}{arrow}{name}")


def integer(known: Known) -> Value:
    """Return a known integer as a literal, on which the code then depends."""
    value = int(known.use())
    # The address of a function is no number of the text: the function is called by its name.
    return Value(INT, str(value if abs(value) < 2**31 else 0), known=known)


def length(dimension: Known | str) -> Value:
    """Return the length of an axis."""
    if isinstance(dimension, Known):
        return integer(dimension)
    return Value(INT, dimension, ATOM if dimension.isidentifier() else CONDITIONAL)


def number(value: float) -> str:
    """Write a double as C does."""
    value = float(value)
    if np.isnan(value):
        return "NAN"
    if np.isinf(value):
        return "INFINITY" if value > 0.0 else "-INFINITY"
    return repr(value)


def declaration(kind: Any, name: str, pointer: bool = False) -> str:
    """Declare a variable of a type."""
    if isinstance(kind, Array):
        return f"\0{kind.storage.number}\0{kind.element.name} *{name}"
    if isinstance(kind, Scalar):
        return f"{kind.name} {name}"
    return f"{'const ' if pointer else ''}struct {kind.tag} {'*' if pointer else ''}{name}"


def knowns(kind: Any) -> Iterator[Known]:
    """List what is known of a type."""
    if isinstance(kind, Array):
        yield from (length for length in kind.shape if isinstance(length, Known))
        if kind.content is not None:
            yield kind.content
    elif isinstance(kind, Struct):
        for own in kind.fields.values():
            yield from knowns(own)


def skeleton(kind: Any) -> str:
    """Describe a type without the values of what is known."""
    if isinstance(kind, Array):
        shape = "".join("k" if isinstance(length, Known) else "?" for length in kind.shape)
        return f"{kind.element.name}[{shape}{'=' * (kind.content is not None)}]"
    if isinstance(kind, Struct):
        return f"{kind.tag}({','.join(map(skeleton, kind.fields.values()))})"
    return getattr(kind, "tag", "") or str(getattr(kind, "name", kind))


def renewed(kind: Any, name: str) -> Any:
    """Return the type of a parameter: what is known is noted anew.

    A length that is not known becomes a further parameter, by the name of the array.
    """
    if isinstance(kind, Array):
        lengths = [
            Known(own.value)
            if isinstance(own, Known)
            else f"{name}_{'rows' if not i else 'columns'}"
            for i, own in enumerate(kind.shape)
        ]
        content = None if kind.content is None else Known(kind.content.value)
        storage = Storage() if name else kind.storage
        return Array(kind.element, tuple(lengths), storage, content)
    if isinstance(kind, Struct):
        return replace(kind, fields={key: renewed(own, "") for key, own in kind.fields.items()})
    return kind


def same(known: Known, other: Known) -> bool:
    """Compare what is known of two arguments."""
    return np.array_equal(known.value, other.value)
