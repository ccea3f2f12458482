"""Names of a package's modules, read from source text: functions, types and constants."""

from __future__ import annotations

import ast
import builtins
import importlib
import types
from collections.abc import Iterator
from pathlib import Path
from typing import Any

KERNELS = ("compiled", "inlined", "released")
"""Decorators of a kernel: plain, copied into its callers, and called without Python's lock."""

ENTRY = "entry"
"""Decorator of a function without a body, which calls the kernel at an address."""


class TranslationError(ValueError):
    """A kernel leaves the subset of Python that is translated; the message names file and line."""


class Constants(types.SimpleNamespace):
    """Constants of a class, in their order."""

    def __iter__(self) -> Iterator[Any]:
        """Go through the values."""
        return iter(vars(self).values())


def fail(module: Module, node: ast.AST, problem: str) -> Any:
    """Raise the TranslationError of a node."""
    text = ast.unparse(node).partition("\n")[0]
    line = getattr(node, "lineno", 0)
    raise TranslationError(f"{module.path}:{line}: `{text}` {problem}")


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
        self.is_package = path.name == "__init__.py"
        self.names: dict[str, ast.stmt] = {}
        tree = ast.parse(path.read_text(encoding="utf-8"))
        for node in tree.body:
            for each in node.body if isinstance(node, ast.If) else [node]:
                self._note(each)

    def _note(self, node: ast.stmt) -> None:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            self.names[node.name] = node
        elif isinstance(node, ast.Import | ast.ImportFrom):
            for alias in node.names:
                self.names[alias.asname or alias.name.partition(".")[0]] = node
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            for each in ast.walk(node):
                if isinstance(each, ast.Name) and isinstance(each.ctx, ast.Store):
                    self.names[each.id] = node

    def kernels(self) -> list[ast.FunctionDef]:
        """List the functions that are translated."""
        functions = [node for node in self.names.values() if isinstance(node, ast.FunctionDef)]
        return [node for node in functions if decoration(node)]


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

    def module(self, name: str) -> Module:
        """Return a module of the package by its full name."""
        if name not in self._modules:
            path = self.folder.parent.joinpath(*name.split("."))
            file = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
            self._modules[name] = Module(self.folder.parent, name, file)
        return self._modules[name]

    def add(self, name: str, path: Path) -> Module:
        """Add a module from outside of the package, and return it."""
        self._modules[name] = Module(path.parent, name, path)
        return self._modules[name]

    def modules(self) -> list[Module]:
        """Return all modules that have a kernel, by their paths."""
        found = []
        for path in sorted(self.folder.rglob("*.py")):
            if "@" in path.read_text(encoding="utf-8"):
                parts = path.relative_to(self.folder.parent).with_suffix("").parts
                name = ".".join(parts).removesuffix(".__init__")
                found.append(self.module(name))
        return [module for module in found if module.kernels()]

    def find(self, module: Module, name: str) -> tuple[Module, ast.stmt | None]:
        """Return the module in which a name is bound, and the statement that binds it.

        The statement is an import for a name from outside of the package, and None for a builtin.
        """
        node = module.names.get(name)
        if not isinstance(node, ast.ImportFrom) or not self._is_own(node):
            return module, node
        own = next(each.name for each in node.names if (each.asname or each.name) == name)
        return self.find(self.module(str(node.module)), own)

    def _is_own(self, node: ast.ImportFrom) -> bool:
        return str(node.module).partition(".")[0] == self.folder.name

    def value(self, module: Module, name: str) -> Any:
        """Return the value of a constant, by executing the one statement that binds it.

        A class stands for its constants alone; those of an enumeration are numbers.
        """
        module, node = self.find(module, name)
        own = node.name if isinstance(node, ast.ClassDef) else name
        key = (module.name, own)
        if key not in self._values:
            self._values[key] = self._execute(module, node, own)
        return self._values[key]

    def _execute(self, module: Module, node: ast.stmt | None, name: str) -> Any:
        if node is None:
            return getattr(builtins, name)
        if isinstance(node, ast.ClassDef):
            rows = [each for each in node.body if isinstance(each, ast.Assign)]
            members = {ast.unparse(row.targets[0]): self._run(module, row) for row in rows}
            return Constants(**{key: own[key] for key, own in members.items()})
        if isinstance(node, ast.Import):
            own = next(each for each in node.names if name in (each.asname, each.name))
            return importlib.import_module(own.name)
        if isinstance(node, ast.ImportFrom):
            return getattr(importlib.import_module(str(node.module)), name)
        found = self._run(module, node)
        return found[name]

    def _run(self, module: Module, node: ast.stmt) -> dict[str, Any]:
        """Execute an assignment with the constants that it reads."""
        if isinstance(node, ast.AnnAssign):
            value = node.value or ast.Constant(None)
            node = ast.copy_location(ast.Assign([node.target], value), node)
        names = [each for each in ast.walk(node) if isinstance(each, ast.Name)]
        read = [each.id for each in names if isinstance(each.ctx, ast.Load)]
        scope = {each: self.value(module, each) for each in read if each in module.names}
        exec(compile(ast.Module([node], []), module.path, "exec"), scope)
        return scope
