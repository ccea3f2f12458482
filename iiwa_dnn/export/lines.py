"""Lines of a C function as it is made, and its variables."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Collection
from dataclasses import dataclass
from typing import Any, NamedTuple

from iiwa_dnn.export.values import Known, Scalar, Value, declaration

WIDTH = 100

# Words of C and macros of its headers that a Python name may not become.
_TAKEN = frozenset(
    "auto break case char const continue default do double else enum extern float for goto if "
    "inline int long register restrict return short signed sizeof static struct switch typedef "
    "union unsigned void volatile while bool true false NAN INFINITY I".split()
)


def identifier(name: str) -> str:
    """Return a Python name as one of C."""
    return f"{name}_" if name in _TAKEN or name.startswith("_") else name


@dataclass(eq=False)
class Variable:
    """A variable of a C function.

    Attributes:
        name: Its name in C.
        kind: Its type.
        known: Its value, if it is known.
        pointer: Whether it points to its struct.
    """

    name: str
    kind: Any
    known: Known | None = None
    pointer: bool = False

    def read(self) -> Value:
        """Return the variable as an expression."""
        return Value(self.kind, self.name, known=self.known, pointer=self.pointer)


# Functions whose call may be left out where nobody needs the result.
_PURE = frozenset(
    "sqrt fabs sin cos atan2 floor ceil double_min double_max int_min int_max".split()
)


class _Line(NamedTuple):
    """A line of C, and the name of the variable that it declares or writes."""

    depth: int
    text: str
    declared: str = ""
    stored: str = ""

    @property
    def own(self) -> str:
        """Name of the variable that the line declares or writes, and does not read for others."""
        return self.declared or self.stored

    def is_idle(self, read: Collection[str]) -> bool:
        """Test whether the line only gives a variable its value that is not among those read."""
        called = re.findall(r"(\w+)\(", self.text)
        return bool(self.own) and self.own not in read and _PURE.issuperset(called)

    def names(self) -> set[str]:
        """Return the names that the line reads."""
        return set(re.findall(r"[A-Za-z_]\w*", self.text)) - {self.own}


class Lines:
    """Lines of a C function as it is made."""

    def __init__(self) -> None:
        """Begin with none."""
        self._lines: list[_Line] = []
        self.depth = 1

    def __len__(self) -> int:
        return len(self._lines)

    def add(self, text: str, declared: str = "", stored: str = "") -> None:
        """Add a line, and say which variable it declares, or writes."""
        self._lines.append(_Line(self.depth, text, declared, stored))

    def declare(self, variable: Variable, text: str) -> None:
        """Declare a variable with a value."""
        start = declaration(variable.kind, variable.name, variable.pointer)
        if variable.known is not None:
            start = f"const {start}"
        self.add(f"{start} = {text};", variable.name)

    def declare_first(self, variable: Variable) -> None:
        """Declare a variable at the beginning of the function."""
        start = declaration(variable.kind, variable.name)
        text = f"{start} = 0;" if isinstance(variable.kind, Scalar) else f"{start};"
        self._lines.insert(0, _Line(1, text, variable.name))

    def open(self, text: str) -> None:
        """Begin a block."""
        self.add(f"{text} {{".lstrip())
        self.depth += 1

    def close(self, then: str = "") -> None:
        """End a block; `then` begins the next one."""
        self.depth -= 1
        self.add(f"}} {then} {{" if then else "}")
        self.depth += bool(then)

    @property
    def only_declare(self) -> bool:
        """Test whether the lines declare variables, and do nothing else."""
        return all(line.declared and "(" not in line.text for line in self._lines)

    def used(self) -> tuple[list[str], set[str]]:
        """Return the lines without variables that nobody reads, and the names in them."""
        lines = self._lines
        while True:
            before = len(lines)
            read = set().union(*(line.names() for line in lines))
            kept = [line for line in lines if not line.is_idle(read)]
            # The same name further up is another variable's.
            later: set[str] = set()
            lines = []
            for line in reversed(kept):
                if line.declared and not line.is_idle(later) or not line.declared:
                    later.discard(line.declared)
                    later |= line.names() | ({line.stored} - {""})
                    lines.append(line)
            lines.reverse()
            if len(lines) == before:
                return [wrapped(line.text, "    " * line.depth) for line in lines], read


def wrapped(text: str, indent: str = "") -> str:
    """Break a line of C where it is too long."""
    start = indent or text[: len(text) - len(text.lstrip())]
    return textwrap.fill(
        text.lstrip(),
        WIDTH,
        initial_indent=start,
        subsequent_indent=f"{indent}    ",
        break_long_words=False,
        break_on_hyphens=False,
    )
