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
    """

    tag: str
    code: str = ""


@dataclass(frozen=True)
class Array(Kind):
    """An array without gaps, of one, two or three axes."""

    element: Kind = Kind("")
    axes: int = 1


@dataclass(frozen=True)
class Struct(Kind):
    """A tuple, plain or named, of `members`: the name of each in C, and its type."""

    members: tuple[tuple[str, Kind], ...] = ()
    is_named: bool = False

    @property
    def same(self) -> Kind | None:
        """The type of all members of a plain tuple; None if they differ."""
        first = self.members[0][1]
        return first if self.members[0][0] == "at[0]" else None


VOID = Kind("void", "n")
INT = Kind("int64_t", "i")
FLOAT = Kind("double", "d")
BOOL = Kind("bool", "b")
NUMBERS = {"None": VOID, "int": INT, "float": FLOAT, "bool": BOOL}
VECTOR = Array("vector", "v", FLOAT, 1)
MATRIX = Array("matrix", "m", FLOAT, 2)
CUBE = Array("cube", "c", FLOAT, 3)
INT_VECTOR = Array("int_vector", "V", INT, 1)
INT_MATRIX = Array("int_matrix", "M", INT, 2)
ARRAYS = {
    "Vector": VECTOR,
    "Array": VECTOR,
    "Matrix": MATRIX,
    "Cube": CUBE,
    "IntVector": INT_VECTOR,
    "IntMatrix": INT_MATRIX,
}


def array_of(element: Kind, axes: int) -> Array | None:
    """Return the type of an array; None if there is none."""
    return next(
        (own for own in ARRAYS.values() if (own.element, own.axes) == (element, axes)), None
    )


class Kinds:
    """Types that annotations stand for, and the structs of C that they need."""

    def __init__(self, package: Package) -> None:
        """Begin with no struct."""
        self._package = package
        self.structs: dict[str, str] = {}

    def of(self, module: Module, node: ast.expr | None) -> Kind:
        """Return the type that an annotation stands for."""
        if node is None:
            return VOID
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            node = ast.parse(node.value, mode="eval").body
        text = ast.unparse(node)
        known = NUMBERS.get(text) or ARRAYS.get(text)
        if known is not None:
            return known
        if isinstance(node, ast.Subscript) and text.startswith("tuple["):
            items = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
            return self.tuple([self.of(module, item) for item in items])
        home, found = self._package.find(module, text)
        if isinstance(found, ast.ClassDef):
            return self._named(home, found)
        if isinstance(found, ast.Assign):
            return self.of(home, found.value)
        own: Kind = fail(module, node, "is no type of a kernel's variable")
        return own

    def tuple(self, kinds: list[Kind]) -> Struct:
        """Return the type of a plain tuple."""
        if all(kind == kinds[0] for kind in kinds):
            tag = f"{kinds[0].tag.removesuffix('_t')}_{len(kinds)}"
            members = [(f"at[{i}]", kind) for i, kind in enumerate(kinds)]
            self._define(tag, f"{kinds[0].tag} at[{len(kinds)}];")
        else:
            tag = "tuple_" + "_".join(kind.tag.removesuffix("_t") for kind in kinds)
            members = [(f"item{i}", kind) for i, kind in enumerate(kinds)]
            self._define(tag, " ".join(f"{kind.tag} {name};" for name, kind in members))
        code = "".join(kind.code for kind in kinds)
        return Struct(tag, f"({code})", tuple(members))

    def _named(self, module: Module, node: ast.ClassDef) -> Struct:
        rows = [each for each in node.body if isinstance(each, ast.AnnAssign)]
        members = [(ast.unparse(row.target), self.of(module, row.annotation)) for row in rows]
        tag = f"{module.name.rpartition('.')[2]}_{node.name.strip('_')}"
        about = (ast.get_docstring(node) or "").partition("\n")[0]
        fields = "".join(f"\n    {kind.tag} {name};" for name, kind in members)
        self._define(tag, fields + "\n", f"/* {about} */\n")
        code = "".join(kind.code for _, kind in members)
        return Struct(tag, f"<{code}>", tuple(members), True)

    def _define(self, tag: str, fields: str, comment: str = "") -> None:
        self.structs.setdefault(tag, f"{comment}typedef struct {{ {fields} }} {tag};")
