"""What a number depends on besides its settings: versions, source, and the robots' URDFs."""

from __future__ import annotations

import ast
import hashlib
import inspect
from collections.abc import Callable, Iterator
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from iiwa_dnn.robot import available_robots, load_robot

_PACKAGES = ("iiwa-dnn", "numpy", "scipy", "numba", "pin")


@cache
def fingerprint(task: Callable[..., Any]) -> dict[str, Any]:
    """What the numbers of a function depend on besides its arguments.

    Args:
        task: A function of a module.

    Returns:
        ``versions`` of the packages that compute, and ``source``, a hash of the function's module,
        of all of this package that it imports, and of the robots' URDFs.
    """
    digest = hashlib.sha256()
    for path in sources(Path(inspect.getfile(task))):
        digest.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    for robot in available_robots():
        urdf = load_robot(robot).path
        digest.update(b"" if urdf is None else urdf.read_bytes())
    versions = {name: version(name) for name in _PACKAGES}
    return {"versions": versions, "source": digest.hexdigest()[:24]}


def sources(start: Path) -> list[Path]:
    """A Python file and all modules of this package that it imports, directly or not.

    Read from the source, so that it does not matter what else the process has imported. The
    package's own ``__init__`` is left out: it hands names on and computes nothing.
    """
    found, todo = {start}, [start]
    while todo:
        for node in ast.walk(ast.parse(todo.pop().read_bytes())):
            names: list[str] = []
            if isinstance(node, ast.ImportFrom) and node.module and not node.level:
                names = [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
            elif isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            new = {path for name in names for path in _files(name)} - found
            found |= new
            todo += new
    return sorted(found)


def _files(module: str) -> Iterator[Path]:
    """The files of a module of this package and of the packages it lies in."""
    root, *parts = module.split(".")
    if root != "iiwa_dnn":
        return
    for depth in range(1, len(parts) + 1):
        base = Path(__file__).parents[1].joinpath(*parts[:depth])
        for path in (base.with_suffix(".py"), base / "__init__.py"):
            if path.is_file():
                yield path
