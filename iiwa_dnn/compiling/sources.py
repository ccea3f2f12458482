"""Names of a package's modules, read from source text: functions, types and constants."""

from __future__ import annotations

import ast
import builtins
import copy
from pathlib import Path
from typing import Any, NoReturn

KERNELS = ("compiled", "inlined", "released")
"""Decorators of a kernel: plain, copied into its callers, and called without Python's lock."""

ENTRY = "entry"
"""Decorator of a function without a body, which calls the kernel at an address."""


class TranslationError(ValueError):
    """A kernel leaves the subset of Python that is translated; the message names file and line."""


class Module:
    """Top-level names of one file.

    Attributes:
        name: Full name of the module.
        path: Path of the file, from the folder that holds the package.
        names: For each name the statement that binds it.
    """

    def __init__(self, folder: Path, name: str, path: Path) -> None:
        """Read a file."""
        self.name = name
        self.path = path.relative_to(folder).as_posix()
        self.names: dict[str, ast.stmt] = {}
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            for each in node.body if isinstance(node, ast.If) else [node]:
                self.names |= dict.fromkeys(_bound(each), each)

    def kernels(self) -> list[ast.FunctionDef]:
        """List the functions that are translated."""
        functions = [node for node in self.names.values() if isinstance(node, ast.FunctionDef)]
        return [node for node in functions if decoration(node)]


def _bound(node: ast.stmt) -> list[str]:
    """List the names that a statement binds."""
    match node:
        case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
            return [name]
        case ast.Import(names=names) | ast.ImportFrom(names=names):
            return [alias.asname or alias.name.partition(".")[0] for alias in names]
        case ast.Assign() | ast.AnnAssign():
            return _names(node, ast.Store)
    return []


def _names(node: ast.AST, context: type) -> list[str]:
    """List the variables that a node reads (`ast.Load`) or writes (`ast.Store`)."""
    names = [each for each in ast.walk(node) if isinstance(each, ast.Name)]
    return [each.id for each in names if isinstance(each.ctx, context)]


def fail(module: Module, node: ast.AST, problem: str) -> NoReturn:
    """Raise the TranslationError of a node."""
    text = ast.unparse(node).partition("\n")[0]
    raise TranslationError(f"{module.path}:{getattr(node, 'lineno', 0)}: `{text}` {problem}")


def decoration(node: ast.FunctionDef) -> str:
    """Return the decorator that makes a function a kernel or an entry; else nothing."""
    words = [ast.unparse(each).partition("(")[0] for each in node.decorator_list]
    return next((word for word in words if word in (*KERNELS, ENTRY)), "")


class Package:
    """All modules of a package, read where they are asked for."""

    def __init__(self, folder: Path) -> None:
        """Take the folder of a package."""
        self.folder = folder
        self._modules: dict[str, Module] = {}
        self._values: dict[tuple[str, str], Any] = {}

    def module(self, name: str, file: Path | None = None) -> Module:
        """Return a module by its full name, from a file unless it is one of the package."""
        if name not in self._modules:
            path = self.folder.parent.joinpath(*name.split("."))
            own = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
            folder = file.parent if file else self.folder.parent
            self._modules[name] = Module(folder, name, file or own)
        return self._modules[name]

    def modules(self) -> list[Module]:
        """Return all modules that have a kernel, by their paths."""
        paths = [path.relative_to(self.folder.parent) for path in self.folder.rglob("*.py")]
        names = [".".join(path.with_suffix("").parts) for path in sorted(paths)]
        found = [self.module(name.removesuffix(".__init__")) for name in names]
        return [module for module in found if module.kernels()]

    def find(self, module: Module, name: str) -> tuple[Module, ast.stmt | None]:
        """Return the module in which a name is bound, and the statement that binds it.

        The statement is an import for a name from outside of the package, and None for a builtin.
        """
        node = module.names.get(name)
        if not isinstance(node, ast.ImportFrom):
            return module, node
        home = str(node.module)
        if node.level or home.partition(".")[0] != self.folder.name:
            return module, node
        own = next(each.name for each in node.names if (each.asname or each.name) == name)
        return self.find(self.module(home), own)

    def value(self, module: Module, name: str) -> Any:
        """Return the value of a constant, by executing the one statement that binds it.

        A class stands for its constants alone.
        """
        module, node = self.find(module, name)
        if node is None:
            return getattr(builtins, name)
        if isinstance(node, ast.ClassDef):
            node = copy.copy(node)
            node.body = [each for each in node.body if isinstance(each, ast.Assign)]
            node.decorator_list = []
        own = _bound(node)
        key = (module.name, name if name in own else own[0])
        if key not in self._values:
            read = set(_names(node, ast.Load)) & set(module.names) - set(own)
            scope = {each: self.value(module, each) for each in read}
            exec(compile(ast.Module([node], []), module.path, "exec"), scope)
            self._values[key] = scope[key[1]]
        return self._values[key]
