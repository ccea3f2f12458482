"""Values of the translation: C expressions, with their types and what is known of them."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any

import numpy as np

ATOM = 16
UNARY = 14
CONDITIONAL = 3
"""Precedences of C."""


class Storage:
    """Numbers that pointers point to: a pointer through which nobody writes is one to const.

    Attributes:
        number: Its number in the marks of declarations.
        written: Whether something is written.
        owner: Function that it lives in; None for what outlives the functions.
    """

    all: list[Storage] = []  # noqa: RUF012  cleared by each translation

    def __init__(self, owner: Any = None) -> None:
        """Begin as one that nobody writes into."""
        self.number = len(Storage.all)
        self.written = False
        self.owner = owner
        self._sources: list[Storage] = []
        Storage.all.append(self)

    def write(self) -> None:
        """Note that something is written, here and where it is passed on to."""
        if not self.written:
            self.written = True
            for source in self._sources:
                source.write()

    def pass_to(self, source: Storage) -> None:
        """Note that what is written here is written into another storage."""
        self._sources.append(source)
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

    tag: str


@dataclass(frozen=True)
class Known(Scalar):
    """A number of a named tuple that is known when the code is made; C does not have it."""

    value: int = 0
    is_table = True


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
        content: The numbers themselves where they are known; None for one that changes.
    """

    element: Scalar
    shape: tuple[int | str, ...]
    storage: Storage = field(default_factory=Storage, compare=False)
    content: tuple[float | None, ...] | None = None
    tag = "array"

    @property
    def is_table(self) -> bool:
        """Test whether the numbers are read while the code is made, and never by it."""
        return self.element is INT and self.content is not None


@dataclass(frozen=True)
class Struct:
    """A named tuple, or a tuple of different types.

    Attributes:
        tag: Name of the struct in C.
        fields: Names and types.
    """

    tag: str
    fields: tuple[tuple[str, Any], ...]

    @property
    def members(self) -> list[tuple[str, Any]]:
        """Fields that C has."""
        return [each for each in self.fields if not getattr(each[1], "is_table", False)]


@dataclass(frozen=True)
class Tuple:
    """A tuple of values of one type: an array inside of a struct in C."""

    element: Any
    length: int

    @property
    def tag(self) -> str:
        """Name of the struct in C."""
        name = {2: "pair", 3: "triple", 4: "quadruple"}.get(self.length, f"tuple_{self.length}")
        return name if self.element is DOUBLE else f"{name}_of_{self.element.tag}s"

    @property
    def members(self) -> list[tuple[str, Any]]:
        """Fields that C has."""
        return [(f"at[{self.length}]", self.element)]


@dataclass(frozen=True)
class Object:
    """Something of Python's: a module, a function, a class."""

    value: Any
    tag = "object"


@dataclass
class Value:
    """A C expression.

    Attributes:
        kind: Its type.
        text: The expression.
        level: Precedence of its outermost operator.
        known: Its value, if it is known when the code is made.
        pointer: Whether it points to its struct.
        items: Items of a tuple that is not put together yet.
    """

    kind: Any
    text: str = ""
    level: int = ATOM
    known: Any = None
    pointer: bool = False
    items: list[Value] = field(default_factory=list)

    def at(self, level: int) -> str:
        """Return the expression as an operand of an operator of a precedence."""
        return self.text if self.level >= level else f"({self.text})"

    @property
    def is_literal(self) -> bool:
        """Test whether the expression is an integer as such."""
        return self.text.lstrip("-").isdigit()

    def declared(self) -> str:
        """Declare the variable whose name the expression is."""
        if isinstance(self.kind, Array):
            return f"\0{self.kind.storage.number}\0{self.kind.element.tag} *{self.text}"
        if self.pointer:
            return f"const struct {self.kind.tag} *{self.text}"
        return f"{'' if isinstance(self.kind, Scalar) else 'struct '}{self.kind.tag} {self.text}"

    def parts(self) -> list[Value]:
        """Return the items of a tuple, the fields of a struct, or the elements of an array."""
        kind = self.kind
        if self.items or not isinstance(kind, Array | Struct | Tuple):
            return self.items
        if isinstance(kind, Struct):
            dot = "->" if self.pointer else "."
            fields = [Value(own, f"{self.at(ATOM)}{dot}{name}") for name, own in kind.fields]
            return [
                integer(own.kind.value) if isinstance(own.kind, Known) else own for own in fields
            ]
        start, size = (".at", kind.length) if isinstance(kind, Tuple) else ("", kind.shape[0])
        texts = [f"{self.at(ATOM)}{start}[{k}]" for k in range(int(size))]
        known = getattr(kind, "content", None) or [None] * len(texts)
        pairs = zip(texts, known, strict=False)
        return [Value(kind.element, text, known=value) for text, value in pairs]


def integer(value: int) -> Value:
    """Return a known integer as a literal."""
    # The address of a function is no number of the text: the function is called by its name.
    return Value(INT, str(value if abs(value) < 2**31 else 0), known=int(value))


def length(size: int | str) -> Value:
    """Return the length of an axis."""
    return integer(size) if isinstance(size, int) else Value(INT, size, CONDITIONAL)


def number(value: float) -> str:
    """Write a double as C does."""
    if np.isfinite(value):
        return repr(float(value))
    return "NAN" if np.isnan(value) else f"{'-' * (value < 0.0)}INFINITY"
