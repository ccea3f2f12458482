"""Types of a kernel's variables, from annotations, and their declarations in C."""

from __future__ import annotations

import ast
from dataclasses import dataclass, field

from .sources import Module, Package, fail


@dataclass(frozen=True, eq=False)
class Kind:
    """A type.

    Attributes:
        tag: Its name in C.
        code: Its letter where types are told apart by a text.
        element: Type of the elements of an array without gaps, or of a plain tuple.
        axes: Number of axes of an array.
        members: Type of each member of a tuple, plain or named.
    """

    tag: str
    code: str
    element: Kind | None = None
    axes: int = 0
    members: dict[str, Kind] = field(default_factory=dict)

    @property
    def is_named(self) -> bool:
        """Test whether it is a named tuple, which is handed on by its address."""
        return bool(self.members) and self.element is None

    @property
    def word(self) -> str:
        """Name of the type within a longer name."""
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


class Kinds:
    """Types that annotations stand for, and the structs of C that they need."""

    def __init__(self, package: Package) -> None:
        """Begin with no struct."""
        self._package = package
        self.structs: dict[str, str] = {}

    def of(self, module: Module, node: ast.AST) -> Kind:
        """Return the type that an annotation, or a named tuple, stands for."""
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
            case _, ast.ClassDef():
                return self._named(home, found)
            case _, ast.Assign(value=value):
                return self.of(home, value)
        fail(module, node, "is no type of a kernel's variable")

    def tuple(self, kind: Kind, count: int) -> Kind:
        """Return the type of a plain tuple, whose items have the same type."""
        tag = f"{kind.word}_{count}"
        self.structs[tag] = f"typedef struct {{ {kind.tag} at[{count}]; }} {tag};"
        members = {f"at[{i}]": kind for i in range(count)}
        return Kind(tag, f"({kind.code * count})", kind, members=members)

    def _named(self, module: Module, node: ast.ClassDef) -> Kind:
        rows = [each for each in node.body if isinstance(each, ast.AnnAssign)]
        members = {ast.unparse(row.target): self.of(module, row.annotation) for row in rows}
        tag = module.c_name(node.name)
        about = (ast.get_docstring(node) or "").partition("\n")[0]
        fields = "".join(f"\n    {kind.tag} {name};" for name, kind in members.items())
        self.structs[tag] = f"/* {about} */\ntypedef struct {{{fields}\n}} {tag};"
        return Kind(tag, f"<{''.join(k.code for k in members.values())}>", members=members)
