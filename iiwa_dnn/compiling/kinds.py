"""Translate annotations of kernels to types of C, and write the structs that these need."""

from __future__ import annotations

import ast
import math
import re
import textwrap
from dataclasses import dataclass, field
from typing import Any

from .sources import Module, Package, c_word, fail


@dataclass(frozen=True, eq=False)
class Kind:
    """Type of a variable in a kernel and in C.

    Attributes:
        tag: Name of the type in C.
        code: Letters of the type in the code that describes a function's types.
        element: Type of the elements of an array without gaps, or of a plain tuple.
        axes: Number of axes of an array.
        members: Type of each member of a tuple, plain or named, or of a record.
        sizes: Of a record: for each name of a size, how many numbers the record has per unit of
            that size; by the empty name, how many it has besides.
    """

    tag: str
    code: str
    element: Kind | None = None
    axes: int = 0
    members: dict[str, Kind] = field(default_factory=dict)
    sizes: dict[str, int] = field(default_factory=dict)

    @property
    def is_named(self) -> bool:
        """Test whether the type is a named tuple or a record: C functions take its address."""
        return bool(self.members) and self.element is None

    @property
    def is_sized(self) -> bool:
        """Test whether the sizes of all records in the type follow from their arrays' lengths."""
        inner = (own.is_sized for own in self.members.values())
        return len(self.sizes) <= 2 and all(inner)

    @property
    def word(self) -> str:
        """Name of the type in names of C that are made of several words."""
        return self.tag.removesuffix("64_t")


VOID = Kind("void", "n")
INT = Kind("int64_t", "i")
FLOAT = Kind("double", "d")
BOOL = Kind("bool", "b")

_KINDS = {
    "None": VOID,
    "int": INT,
    "float": FLOAT,
    "bool": BOOL,
    "Vector": Kind("Vector", "v", FLOAT, 1),
    "Array": Kind("Vector", "v", FLOAT, 1),
    "Matrix": Kind("Matrix", "m", FLOAT, 2),
    "IntVector": Kind("IntVector", "V", INT, 1),
    "IntMatrix": Kind("IntMatrix", "M", INT, 2),
}
ARRAYS = {(own.element, own.axes): own for own in _KINDS.values() if own.axes}
"""Types of arrays by the type of their elements and the number of axes."""


WIDTH = 120
"""Largest length of a line of C that somebody reads."""


class Kinds:
    """Types of C for the annotations of a package.

    Attributes:
        structs: Declarations in C of the types so far, by their names.
    """

    def __init__(self, package: Package) -> None:
        """Take the package in whose modules types are found."""
        self._package = package
        self.structs: dict[str, str] = {}

    def of(self, module: Module, node: ast.AST) -> Kind:
        """Return the type of an annotation, or of a class, in a module.

        Raises:
            TranslationError: There is no such type in C.
        """
        text = ast.unparse(node)
        if text in _KINDS:
            return _KINDS[text]
        home, found = self._package.find(module, getattr(node, "name", text))
        match node, found:
            case ast.Subscript(
                value=ast.Name(id="tuple"), slice=ast.Tuple(elts=[item, *others])
            ), _:
                if {ast.unparse(each) for each in others} == {ast.unparse(item)}:
                    return self.tuple(self.of(module, item), 1 + len(others))
            case _, ast.ClassDef(bases=bases):
                base = ast.unparse(bases[0]) if bases else ""
                make = {"IntEnum": self._enumeration, "Record": self._record}
                return make.get(base, self._named)(home, found)
            case _, ast.Assign(value=value):
                return self.of(home, value)
        bare = isinstance(node, ast.arg)
        fail(module, node, "has no annotation" if bare else "is no type of a kernel's variable")

    def tuple(self, kind: Kind, count: int) -> Kind:
        """Return the type of a plain tuple of `count` items of one type."""
        tag = f"{kind.word}_{count}"
        self.structs[tag] = f"typedef struct {{ {kind.tag} at[{count}]; }} {tag};"
        members = {f"at[{i}]": kind for i in range(count)}
        return Kind(tag, f"({kind.code * count})", kind, members=members)

    def _named(self, module: Module, node: ast.ClassDef) -> Kind:
        """Write the struct of a named tuple, and return its type."""
        rows = [each for each in node.body if isinstance(each, ast.AnnAssign)]
        members = {ast.unparse(row.target): self.of(module, row.annotation) for row in rows}
        tag = module.c_name(node.name)
        fields = _fields({name: f"{kind.tag} {name}" for name, kind in members.items()}, node)
        self.structs[tag] = f"/* {_about(node)} */\ntypedef struct {{\n{fields}\n}} {tag};"
        return Kind(tag, f"<{''.join(k.code for k in members.values())}>", members=members)

    def _enumeration(self, module: Module, node: ast.ClassDef) -> Kind:
        """Write the C enumeration of an IntEnum; return the type of its members, an integer."""
        tag = module.c_name(node.name)
        rows = [f"    {tag}_{own.name} = {own.value}," for own in module[node.name]]
        inner = "\n".join(rows)
        self.structs[tag] = f"/* {_about(node)} */\ntypedef enum {{\n{inner}\n}} {tag};"
        return INT

    def _record(self, module: Module, node: ast.ClassDef) -> Kind:
        """Write the struct of a record and the function that views an array so; return the type.

        The struct holds the whole array, a pointer to the numbers at its beginning, and the parts
        that follow these.
        """
        tag = module.c_name(node.name)
        rows = [own for own in node.body if isinstance(own, ast.AnnAssign)]
        annotations = {ast.unparse(row.target): row.annotation for row in rows if not row.value}
        names = {name: self.of(module, own) for name, own in annotations.items()}
        members = {"numbers": _KINDS["Vector"], **names}
        values = ["numbers", *[f"({tag}_numbers *)numbers.data"] * bool(names)]
        end = {"": len(names)}
        for row in rows:
            if isinstance(row.value, ast.Call):
                kind = members[ast.unparse(row.target)] = self.of(module, row.annotation)
                place = " + ".join(["numbers.data", *_counted(end)])
                given = [] if kind.sizes else map(module.value, row.value.args)
                values.append(_part(kind, [*given], place, end))
        inner = _fields({name: f"double {c_word(name)}" for name in names}, node)
        if names:
            self.structs[f"{tag}_numbers"] = f"typedef struct {{\n{inner}\n}} {tag}_numbers;"
        pointer = {"at": f"{tag}_numbers *at"} if names else {}
        parts = {k: f"{own.tag} {c_word(k)}" for k, own in members.items() if k not in names}
        inner = _fields({"numbers": parts["numbers"], **pointer, **parts}, node)
        self.structs[tag] = f"/* {_about(node)} */\ntypedef struct {{\n{inner}\n}} {tag};"
        given = "".join(f", int64_t {size}" for size in end if size)
        inner = ",\n        ".join(values)
        self.structs[f"{tag}_of"] = (
            f"static inline {tag} {tag}_of(Vector numbers{given})\n{{\n"
            f"    const {tag} own = {{\n        {inner}\n    }};\n    return own;\n}}"
        )
        return Kind(tag, f"{{{tag}}}", members=members, sizes=end)


def _part(kind: Kind, shape: list[Any], place: str, end: dict[str, int]) -> str:
    """Return the C initializer of a record's part, and count its numbers in `end`.

    Args:
        kind: Type of the part.
        shape: Sizes of the part, numbers or names; of a nested record, none.
        place: C expression of the part's address.
        end: Numbers of the record before the part, as in `Kind.sizes`; updated.
    """
    if kind.sizes:
        shape = [kind.sizes[""]]
    size = next((own for own in shape if isinstance(own, str)), "" if shape else "n")
    end[size] = end.get(size, 0) + math.prod(own for own in shape if own != size)
    inner = f"{{{', '.join([place, *map(str, shape or ['n'])])}}}"
    return f"{kind.tag}_of((Vector){inner})" if kind.sizes else inner


def _counted(sizes: dict[str, int]) -> list[str]:
    """Return the summands in C of a number of numbers, given as in `Kind.sizes`."""
    fixed = [str(sizes[""])] * (sizes[""] > 0)
    return fixed + [f"{n} * {size}" if n > 1 else size for size, n in sizes.items() if size and n]


def attributes(docstring: str) -> dict[str, str]:
    """Read the descriptions of attributes or members in a docstring, by their names."""
    sections = re.split("^(?:Attributes|Members):\n", docstring, flags=re.MULTILINE)[1:]
    rows = re.findall(r"^ {4}(\w+): (.+(?:\n {8}.+)*)", "".join(sections), re.MULTILINE)
    return {name: " ".join(text.split()) for name, text in rows}


def commented(declaration: str, about: str) -> str:
    """Write a declaration in C with a comment behind it, or before it if the line is long."""
    whole = f"{declaration}; /* {about} */"
    if about and ("\n" in declaration or len(whole) > WIDTH - 12):
        above = textwrap.fill(f"/* {about} */", WIDTH - 12, subsequent_indent=" * ")
        return f"{above}\n{declaration};"
    return whole if about else f"{declaration};"


def _fields(declarations: dict[str, str], node: ast.ClassDef) -> str:
    """Write the members of a C struct, with comments from the docstring of a class.

    Args:
        declarations: Declaration of each member, by its name in the class.
        node: The class.
    """
    about = attributes(ast.get_docstring(node) or "")
    lines = [commented(text, about.get(name, "")) for name, text in declarations.items()]
    return textwrap.indent("\n".join(lines), "    ")


def _about(node: ast.ClassDef) -> str:
    """Return the first line of a class's docstring."""
    return (ast.get_docstring(node) or "").partition("\n")[0]
