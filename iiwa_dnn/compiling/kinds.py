"""Types of a kernel's variables, from annotations, and their declarations in C."""

from __future__ import annotations

import ast
from dataclasses import dataclass

from .sources import Module, Package, fail


@dataclass(frozen=True)
class Kind:
    """A type.

    Attributes:
        tag: Its name in C.
        code: Its letter where types are told apart by a text.
        axes: Number of axes of an array without gaps; 0: none is.
        members: Name in C and type of each member of a tuple, plain or named.
        is_named: Whether it is a named tuple, which is handed on by its address.
    """

    tag: str
    code: str
    element: Kind | None = None
    axes: int = 0
    members: tuple[tuple[str, Kind], ...] = ()
    is_named: bool = False

    @property
    def word(self) -> str:
        """Name of the type within a longer name."""
        return self.tag.removesuffix("_t")


VOID = Kind("void", "n")
INT = Kind("int64_t", "i")
FLOAT = Kind("double", "d")
BOOL = Kind("bool", "b")
NUMBERS = (BOOL, INT, FLOAT)
"""Types of numbers; each takes the values of those before it."""

_KINDS = {
    "None": VOID,
    "int": INT,
    "float": FLOAT,
    "bool": BOOL,
    "Vector": Kind("vector", "v", FLOAT, 1),
    "Array": Kind("vector", "v", FLOAT, 1),
    "Matrix": Kind("matrix", "m", FLOAT, 2),
    "Cube": Kind("cube", "c", FLOAT, 3),
    "IntVector": Kind("int_vector", "V", INT, 1),
    "IntMatrix": Kind("int_matrix", "M", INT, 2),
}
ARRAYS = {(own.element, own.axes): own for own in _KINDS.values() if own.axes}
"""Types of arrays by the type of their elements and the number of axes."""


class Kinds:
    """Types that annotations stand for, and the structs of C that they need."""

    def __init__(self, package: Package) -> None:
        """Begin with no struct."""
        self._package = package
        self.structs: dict[str, str] = {}

    def of(self, module: Module, node: ast.expr) -> Kind:
        """Return the type that an annotation stands for."""
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            node = ast.parse(node.value, mode="eval").body
        text = ast.unparse(node)
        if text in _KINDS:
            return _KINDS[text]
        if isinstance(node, ast.Subscript) and text.startswith("tuple["):
            items = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
            return self.tuple([self.of(module, item) for item in items])
        home, found = self._package.find(module, text)
        match found:
            case ast.ClassDef():
                return self._named(home, found)
            case ast.Assign(value=value):
                return self.of(home, value)
        fail(module, node, "is no type of a kernel's variable")

    def tuple(self, kinds: list[Kind]) -> Kind:
        """Return the type of a plain tuple; one of equal types may be indexed by a variable."""
        tag = "tuple_" + "_".join(kind.word for kind in kinds)
        names = [f"item{i}" for i in range(len(kinds))]
        fields = " ".join(f"{kind.tag} {own};" for kind, own in zip(kinds, names, strict=True))
        if len(set(kinds)) == 1:
            tag = f"{kinds[0].word}_{len(kinds)}"
            names = [f"at[{i}]" for i in range(len(kinds))]
            fields = f"{kinds[0].tag} at[{len(kinds)}];"
        self.structs.setdefault(tag, f"typedef struct {{ {fields} }} {tag};")
        code = "".join(kind.code for kind in kinds)
        return Kind(tag, f"({code})", members=tuple(zip(names, kinds, strict=True)))

    def _named(self, module: Module, node: ast.ClassDef) -> Kind:
        rows = [each for each in node.body if isinstance(each, ast.AnnAssign)]
        members = [(ast.unparse(row.target), self.of(module, row.annotation)) for row in rows]
        tag = f"{module.name.rpartition('.')[2]}_{node.name.strip('_')}"
        about = (ast.get_docstring(node) or "").partition("\n")[0]
        fields = "".join(f"\n    {kind.tag} {name};" for name, kind in members)
        self.structs.setdefault(tag, f"/* {about} */\ntypedef struct {{{fields}\n}} {tag};")
        code = "".join(kind.code for _, kind in members)
        return Kind(tag, f"<{code}>", members=tuple(members), is_named=True)
