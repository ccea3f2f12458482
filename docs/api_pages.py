"""Write a page of the API for each room of the package, from what it makes public."""

import __future__

import inspect
import shutil
from collections.abc import Iterator
from importlib import import_module
from importlib.machinery import SourceFileLoader
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any

ROOMS = {
    "robot": (),
    "references": (),
    "schemes": (),
    "control": (),
    "posing": (),
    "simulation": (
        *("Plant", "PlantState", "Disturbances", "Push"),
        *("estimation.JointEstimator", "estimation.NoiseModel"),
    ),
    "results": ("report.save_run",),
    "qp": ("register",),
    "networks": ("Flow", "NoiseSuppressingNetwork", "activations.*", "tracking.Formula"),
    "export": ("*",),
    "errors": (),
}
"""The pages, and what stands on them beside the names of `iiwa_dnn` that come from this room."""


EVALUATED = ("iiwa_dnn.results.record",)
"""Modules that read their own annotations."""


def load_package() -> ModuleType:
    """Import the package so that its annotations stay text, as `ArrayLike | None` is written."""
    usual = SourceFileLoader.get_code

    def get_code(loader: SourceFileLoader, fullname: str) -> CodeType | None:
        if not fullname.startswith("iiwa_dnn") or fullname in EVALUATED:
            return usual(loader, fullname)
        path = loader.get_filename(fullname)
        flags = __future__.annotations.compiler_flag
        code: CodeType = compile(loader.get_data(path), path, "exec", flags, dont_inherit=True)
        return code

    SourceFileLoader.get_code = get_code  # type: ignore[method-assign,assignment]
    try:
        package = import_module("iiwa_dnn")
        for name in package.__all__:  # some are imported at their first use
            getattr(package, name)
        return package
    finally:
        SourceFileLoader.get_code = usual  # type: ignore[method-assign]


def members(package: ModuleType, room: str) -> Iterator[tuple[str, Any]]:
    """Iterate over the names on a room's page, with what they stand for."""
    home = f"{package.__name__}.{room}"
    for name in package.__all__:
        found = getattr(package, name)
        if f"{getattr(found, '__module__', '')}.".startswith(f"{home}."):
            yield f"{package.__name__}.{name}", found
    for more in ROOMS[room]:
        module, _, name = f"{home}.{more}".rpartition(".")
        place = import_module(module)
        for each, found in vars(place).items():
            own = getattr(found, "__module__", "").startswith(module)
            new = each[0] != "_" and each not in package.__all__
            if each == name or (name == "*" and own and new):
                yield f"{module}.{each}", found


def write_pages(folder: Path) -> None:
    """Write the pages into a folder, which is emptied."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    package = load_package()
    for room in ROOMS:
        lines = [f"# iiwa_dnn.{room}", "", "```{eval-rst}", f".. automodule:: iiwa_dnn.{room}", ""]
        for name, found in members(package, room):
            if inspect.isclass(found):
                # Nobody makes a record by hand; its docstring has its columns.
                given = "(...)" if found is package.Record else ""
                lines += [f".. autoclass:: {name}{given}", "   :members:", ""]
            else:
                kind = "function" if inspect.isfunction(found) else "data"
                lines += [f".. auto{kind}:: {name}", ""]
        (folder / f"{room}.md").write_text("\n".join([*lines, "```", ""]), encoding="utf-8")
