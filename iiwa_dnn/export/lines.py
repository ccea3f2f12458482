"""Lines of a C function as it is made, and its variables."""

from __future__ import annotations

import re
import textwrap
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


class _Line(NamedTuple):
    """A line of C, and the name of the variable that it declares."""

    depth: int
    text: str
    declared: str = ""


class Lines:
    """Lines of a C function as it is made."""

    def __init__(self) -> None:
        """Begin with none."""
        self._lines: list[_Line] = []
        self.depth = 1

    def __len__(self) -> int:
        return len(self._lines)

    def add(self, text: str, declared: str = "") -> None:
        """Add a line, and say which variable it declares."""
        self._lines.append(_Line(self.depth, text, declared))

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

    def used(self, calls: str = "(") -> tuple[list[str], set[str]]:
        """Return the lines without variables that nobody reads, and the names in them.

        A variable whose value holds `calls` is kept: a function may do something else too.
        """
        kept = []
        names: set[str] = set()
        for line in reversed(self._lines):
            if line.declared and line.declared not in names and calls not in line.text:
                continue
            # The same name further up is another variable's.
            names.discard(line.declared)
            names |= set(re.findall(r"[A-Za-z_]\w*", line.text)) - {line.declared}
            indent = "    " * line.depth
            kept.append(wrapped(line.text, indent))
        return kept[::-1], names


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
