"""Lines of a C function as it is made."""

import re
import textwrap
from collections.abc import Collection
from typing import NamedTuple

WIDTH = 100

# Words of C, macros of its headers and functions that are looked for in vain: no Python name
# becomes one of them.
_TAKEN = re.findall(
    r"\w+",
    "auto break case char const continue default do double else enum extern float for goto if "
    "inline int long register restrict return short signed sizeof static struct switch typedef "
    "union unsigned void volatile while bool true false NAN INFINITY I malloc free alloca",
)

_PURE = re.findall(
    r"\w+", "sqrt fabs sin cos atan2 floor ceil double_min double_max int_min int_max"
)
"""Functions whose call may be left out where nobody needs the result."""


def identifier(name: str) -> str:
    """Return a Python name as one of C."""
    return f"{name.strip('_')}_" if name in _TAKEN or name.startswith("_") else name


class _Line(NamedTuple):
    """A line of C, and the name of the variable that it declares or writes."""

    depth: int
    text: str
    declared: str = ""
    stored: str = ""

    def is_idle(self, read: Collection[str]) -> bool:
        """Test whether the line only gives a variable its value that is not among those read."""
        own = self.declared or self.stored
        called = re.findall(r"(\w+)\(", self.text)
        return bool(own) and own not in read and set(called) <= set(_PURE)

    def names(self) -> set[str]:
        """Return the names that the line reads."""
        return set(re.findall(r"[A-Za-z_]\w*", self.text)) - {self.declared or self.stored}


class Lines:
    """Lines of a C function as it is made."""

    def __init__(self) -> None:
        """Begin with none."""
        self._lines: list[_Line] = []
        self._depth = 1

    def __len__(self) -> int:
        return len(self._lines)

    def add(self, text: str, declared: str = "", stored: str = "") -> None:
        """Add a line, and say which variable it declares, or writes."""
        self._lines.append(_Line(self._depth, text, declared, stored))

    def add_first(self, text: str, declared: str) -> None:
        """Add a declaration at the beginning of the function."""
        self._lines.insert(0, _Line(1, text, declared))

    def open(self, text: str) -> None:
        """Begin a block."""
        self.add(f"{text} {{".lstrip())
        self._depth += 1

    def close(self, then: str = "") -> None:
        """End a block; `then` begins the next one."""
        self._depth -= 1
        self.add(f"}} {then} {{" if then else "}")
        self._depth += bool(then)

    @property
    def only_declare(self) -> bool:
        """Test whether the lines declare variables, and do nothing else."""
        return all(line.declared and "(" not in line.text for line in self._lines)

    def used(self) -> tuple[list[str], set[str]]:
        """Return the lines without variables that nobody reads, and the names in them."""
        lines = self._lines
        before = -1
        while before != len(lines):
            before = len(lines)
            read = set().union(*(line.names() for line in lines))
            later: set[str] = set()
            kept = []
            for line in reversed(lines):
                if line.is_idle(later if line.declared else read):
                    continue
                # The same name further up is another variable's.
                later.discard(line.declared)
                later |= line.names() | {line.stored}
                kept.append(line)
            lines = kept[::-1]
        return [wrapped(line.text, "    " * line.depth) for line in lines], read


def wrapped(text: str, indent: str = "") -> str:
    """Break a line of C where it is too long."""
    if text and len(indent) + len(text) <= WIDTH:
        return indent + text
    return textwrap.fill(
        text,
        WIDTH,
        initial_indent=indent,
        subsequent_indent=f"{indent}    ",
        break_long_words=False,
        break_on_hyphens=False,
    )
