"""Write functions of C that read named tuples and records out of flat arrays of numbers.

A named tuple is read member by member, a record as its sizes and its numbers, an array as its shape
and its elements: floats out of one array, sizes, integers and truth values out of another. Nothing
is copied: arrays are views.
"""

from __future__ import annotations

from collections.abc import Container

from .kinds import BOOL, FLOAT, Kind
from .sources import c_word


def write_readers(kind: Kind, written: Container[str], found: dict[str, str]) -> None:
    """Write the function that reads a type, after those of its members' types.

    Args:
        kind: Type of a named tuple or a record.
        written: Names of members that are arrays of which only the shape is read.
        found: Functions by the names of their types; those that are missing are added.
    """
    if kind.tag in found:
        return
    lines = _of_record(kind) if kind.sizes else [f"{kind.tag} own;"]
    for name, member in {} if kind.sizes else kind.members.items():
        place = f"own.{c_word(name)}"
        if member.axes:
            sizes = [f"{place}.size{axis}" for axis in range(member.axes)]
            lines += [f"{size} = read_size(reader);" for size in sizes]
            word = "doubles" if member.element is FLOAT else "ints"
            count = "0" if name in written else " * ".join(sizes)
            lines.append(f"{place}.data = read_{word}(reader, {count});")
        elif member.members:
            write_readers(member, written, found)
            lines.append(f"{place} = {_call(member)};")
        elif member is FLOAT:
            lines.append(f"{place} = *read_doubles(reader, 1);")
        else:
            lines.append(f"{place} = read_int(reader){' != 0' * (member is BOOL)};")
    body = "\n    ".join([*lines, "return own;"])
    found[kind.tag] = f"static {kind.tag} {_name(kind)}(struct reader *reader)\n{{\n    {body}\n}}"


def _of_record(kind: Kind) -> list[str]:
    """Return the lines that read the sizes and the numbers of a record."""
    fixed, *shared = kind.sizes.values()
    sizes = [own for own in kind.sizes if own]
    counts = [str(fixed), *(f"{n} * {size}" for n, size in zip(shared, sizes, strict=True))]
    return [
        *(f"const int64_t {size} = read_size(reader);" for size in sizes),
        f"const int64_t count = {' + '.join(counts)};",
        "const Vector numbers = {read_doubles(reader, count), count};",
        f"const {kind.tag} own = {kind.tag}_of({', '.join(['numbers', *sizes])});",
    ]


def _name(kind: Kind) -> str:
    return f"read_{kind.tag}"


def _call(kind: Kind) -> str:
    return f"{_name(kind)}(reader)"
