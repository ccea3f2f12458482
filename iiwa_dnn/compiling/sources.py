"""Read the functions, types and constants of a package from source text, without importing it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NoReturn

KERNELS = ("compiled", "released")
"""Decorators of a kernel: plain, and called without Python's lock."""

ENTRY = "entry"
"""Decorator of a prototype, a function without a body: it calls a function by its address."""


_WORDS = re.compile(
    "alignas|alignof|and_eq|arena|asm|auto|bitand|bitor|case|catch|char|compl|const|"
    "const_cast|constexpr|decltype|default|delete|do|double|dynamic_cast|enum|explicit|"
    "export|extern|float|friend|goto|inline|int|int64_t|long|mark|mutable|namespace|"
    "new|noexcept|not_eq|nullptr|operator|or_eq|private|protected|public|register|"
    "reinterpret_cast|restrict|short|signed|sizeof|static|static_assert|static_cast|"
    "struct|switch|template|this|thread_local|throw|typedef|typeid|typename|union|"
    "unsigned|using|virtual|void|volatile|wchar_t|xor|xor_eq"
)
"""Words that are no names of variables: those of C and C++, and names in every C function."""


class TranslationError(Exception):
    """A kernel leaves the subset of Python that is translated; the message has file and line."""


def fail(module: Module, node: ast.AST, problem: str) -> NoReturn:
    """Raise a TranslationError with the file, line and first line of text of a syntax node."""
    text = ast.unparse(node).partition("\n")[0]
    raise TranslationError(f"{module.path}:{getattr(node, 'lineno', 0)}: `{text}` {problem}")


def decoration(node: ast.AST | None) -> str:
    """Return the decorator that makes a function a kernel or an entry; nothing if none does."""
    words = [ast.unparse(each) for each in getattr(node, "decorator_list", [])]
    return next((word for word in words if word in (*KERNELS, ENTRY)), "")


def has_kernels(file: Path) -> bool:
    """Test whether a file defines a kernel or an entry."""
    words = "|".join((*KERNELS, ENTRY))
    return bool(re.search(rf"^@({words})\b", file.read_text(encoding="utf-8"), re.MULTILINE))


def stored_names(node: ast.AST) -> list[str]:
    """List the variables that a syntax node assigns, once each time, without ``_``."""
    names = [each for each in ast.walk(node) if isinstance(each, ast.Name)]
    return [each.id for each in names if isinstance(each.ctx, ast.Store) and each.id != "_"]


def _bound(node: ast.stmt) -> list[str]:
    """List the names that a statement of a module binds."""
    match node:
        case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
            return [name]
        case ast.Import(names=names) | ast.ImportFrom(names=names):
            return [alias.asname or alias.name.partition(".")[0] for alias in names]
        case ast.Assign() | ast.AnnAssign():
            return stored_names(node)
    return []


def c_name(module: str, name: str, package: str = "iiwa_dnn") -> str:
    """Return the C name of a name in a module: both joined by ``_``, without the package's name."""
    words = [*module.removeprefix(f"{package}.").split("."), name.strip("_")]
    return "_".join(words).lstrip("_")


def c_word(name: str) -> str:
    """Return the C name of a variable: its own, with ``_`` behind it if it is one of `_WORDS`."""
    return f"{name}_" if _WORDS.fullmatch(name) else name


class Module(dict[str, Any]):
    """Names that one file binds; the value of a constant is computed at its first look-up.

    Attributes:
        package: The package.
        name: Full name of the module.
        file: The file.
        path: Its path, from the folder that holds the package.
        names: Statement that binds each name.
        about: Docstring of each constant that has one.
    """

    def __init__(self, package: Package, name: str, file: Path) -> None:
        """Read and parse a file."""
        self.package = package
        self.name = name
        self.file = file
        self.path = f"{name.replace('.', '/')}.py"
        self.names: dict[str, Any] = {}
        self.about: dict[str, str] = {}
        body = ast.parse(file.read_text(encoding="utf-8")).body
        for node, following in zip(body, [*body[1:], None], strict=True):
            for each in node.body if isinstance(node, ast.If) else [node]:
                self.names |= dict.fromkeys(_bound(each), each)
            match following:
                case ast.Expr(value=ast.Constant(value=str(text))):
                    self.about |= dict.fromkeys(_bound(node), " ".join(text.split()))

    def __missing__(self, name: str) -> Any:
        """Compute the value of a constant by executing the one statement that binds the name."""
        home, _ = self.package.find(self, name)
        if home is not self:
            return home[name]
        exec(compile(ast.Module([self.names[name]], []), self.path, "exec"), {}, self)
        return self[name]

    def c_name(self, name: str) -> str:
        """Return the C name of a name that the file binds."""
        return c_name(self.name, name, self.package.folder.name)

    def value(self, node: ast.expr) -> Any:
        """Compute the value of an expression of constants."""
        return eval(ast.unparse(node), {}, self)


class Package:
    """Modules of a package, each read at its first look-up."""

    def __init__(self, folder: Path) -> None:
        """Take the folder of a package."""
        self.folder = folder
        self._modules: dict[str, Module] = {}

    @property
    def modules(self) -> list[Module]:
        """Modules that have been read."""
        return [*self._modules.values()]

    def module(self, name: str, file: Path | None = None) -> Module:
        """Return a module by its full name; `file` is that of a module outside of the package."""
        if name not in self._modules:
            path = self.folder.parent.joinpath(*name.split("."))
            own = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
            self._modules[name] = Module(self, name, file or own)
        return self._modules[name]

    def kernels(self) -> Iterator[tuple[Module, ast.FunctionDef]]:
        """List all kernels and entries of the package with their modules, ordered by paths."""
        for path in sorted(self.folder.rglob("*.py")):
            if not has_kernels(path):
                continue
            name = ".".join(path.relative_to(self.folder.parent).with_suffix("").parts)
            module = self.module(name.removesuffix(".__init__"))
            for node in module.names.values():
                if decoration(node):
                    yield module, node

    def find(self, module: Module, name: str) -> tuple[Module, ast.stmt | None]:
        """Follow a name through imports; return the module and the statement that bind it.

        For a name from outside of the package the statement is its import, for a builtin None.
        """
        node = module.names.get(name)
        if not isinstance(node, ast.ImportFrom):
            return module, node
        home = str(node.module)
        if node.level or home.partition(".")[0] != self.folder.name:
            return module, node
        own = next(each.name for each in node.names if name in (each.asname, each.name))
        return self.find(self.module(home), own)
