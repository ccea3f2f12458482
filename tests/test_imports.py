"""Data moves one way: a module imports only from those above it. Read from the source by ast."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

from helpers_physics import run_python

PACKAGE = Path(__file__).parents[1] / "iiwa_dnn"

# A room imports only from the rooms before it; its own modules may import each other. Studies and
# commands come after the package itself: they take its public names, as programs of others do.
ORDER = (
    "errors",
    "compiling",
    "checks",
    "files",
    "naming",
    "robot",
    "references",
    "qp",
    "networks",
    "schemes",
    "control",
    "results",
    "simulation",
    "export",
    "__init__",
    "studies",
    "app",
    "__main__",
)

# It reads a Record and recomputes nothing: robot, solver and simulation are out of its sight.
BEFORE_THE_RECORD = {"errors", "checks", "files", "naming"}
# What draws the robot itself needs its shapes too, and nothing else of it.
DRAW_THE_ROBOT = {"pictures", "scenery"}

FILES = sorted(PACKAGE.rglob("*.py"))


def imported(source: str, module: tuple[str, ...]) -> Iterator[tuple[int, tuple[str, ...]]]:
    """Line and absolute name of all that a module imports, inside functions and TYPE_CHECKING too.

    Args:
        source: The module's text.
        module: Its name in parts, with a last ``"__init__"`` for a package.
    """
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield node.lineno, tuple(alias.name.split("."))
        elif isinstance(node, ast.ImportFrom):
            base = module[: -node.level] if node.level else ()
            base += tuple(node.module.split(".")) if node.module else ()
            for alias in node.names:
                yield node.lineno, (*base, alias.name)


def faults(source: str, module: tuple[str, ...]) -> list[str]:
    """What is wrong with a module's imports, one line each; see `imported` for the arguments."""
    found = []
    own = module[1]
    if own not in ORDER:
        return [f"{own} has no place yet: add it to ORDER in tests/test_imports.py"]
    for line, name in imported(source, module):
        where = f"{'.'.join(module)}:{line}: imports {'.'.join(name)}"
        if name[0] != "iiwa_dnn":
            continue
        other = name[1] if len(name) > 1 and name[1] in ORDER else "__init__"
        if other == own:
            continue
        if ORDER.index(other) > ORDER.index(own):
            found.append(f"{where}, which points back: {other} stands after {own}")
        elif own == "results" and other not in BEFORE_THE_RECORD | (
            {"robot"} if module[-1] in DRAW_THE_ROBOT else set()
        ):
            found.append(f"{where}, but results/ works from the record alone")
    return found


def module_name(path: Path) -> tuple[str, ...]:
    return path.relative_to(PACKAGE.parent).with_suffix("").parts


@pytest.mark.parametrize("path", FILES, ids=lambda path: "/".join(module_name(path)[1:]))
def test_imports_point_forward(path: Path) -> None:
    found = faults(path.read_text(encoding="utf-8"), module_name(path))
    assert not found, "\n".join(found)


@pytest.mark.parametrize(
    ("own", "source", "fault"),
    [
        ("qp/program", "from iiwa_dnn.networks import DNNSolver", "networks stands after qp"),
        ("qp/program", "from iiwa_dnn import networks", "networks stands after qp"),
        ("qp/program", "import iiwa_dnn.networks as s", "networks stands after qp"),
        ("qp/program", "from ..networks import DNNSolver", "networks stands after qp"),
        ("qp/program", "def f():\n    from .. import networks", "networks stands after qp"),
        ("qp/program", "if TYPE_CHECKING:\n    from ..networks import A", "program:2: imports"),
        ("qp/program", "from iiwa_dnn import load_robot", "__init__ stands after qp"),
        ("qp/program", "import iiwa_dnn", "__init__ stands after qp"),
        ("qp/__init__", "from ..networks import A", "networks stands after qp"),
        ("results/plots", "from iiwa_dnn.robot import Robot", "works from the record alone"),
        ("results/report", "from iiwa_dnn import qp", "works from the record alone"),
        ("results/report", "from iiwa_dnn import simulation", "simulation stands after results"),
        ("__init__", "from iiwa_dnn.studies import atlas", "studies stands after __init__"),
        ("surprise", "import numpy", "add it to ORDER"),
    ],
)
def test_a_wrong_import_is_found(own: str, source: str, fault: str) -> None:
    (line,) = faults(source, ("iiwa_dnn", *own.split("/")))
    assert fault in line


@pytest.mark.parametrize(
    ("own", "source"),
    [
        ("networks/solver", "from iiwa_dnn.qp import QP\nfrom .. import checks\nimport numpy"),
        ("networks/projection", "from .base import Network\nfrom ..qp import f"),
        ("networks/__init__", "from .projection import Projection"),
        ("results/plots", "from .record import Record\nfrom iiwa_dnn.errors import FileError"),
        ("results/pictures", "from iiwa_dnn.robot import Robot"),
        ("__init__", "from iiwa_dnn.export import load\nfrom .robot import Robot"),
        ("studies/atlas", "from iiwa_dnn import QP, simulate\nfrom .paper import START"),
    ],
)
def test_a_right_import_passes(own: str, source: str) -> None:
    assert faults(source, ("iiwa_dnn", *own.split("/"))) == []


def test_the_root_of_the_package_is_small() -> None:
    folders = {path.name for path in PACKAGE.iterdir() if path.is_dir()} - {"__pycache__"}
    assert len(folders) <= 12
    assert len(list(PACKAGE.glob("*.py"))) <= 6


def test_the_package_needs_no_extra_and_imports_no_command_and_no_second_reader() -> None:
    code = (
        "import sys; sys.modules.update(mujoco=None, viser=None, imageio_ffmpeg=None)\n"
        "import iiwa_dnn; iiwa_dnn.load_robot('iiwa7')\n"
        "print({'tyro', 'tomli_w', 'iiwa_dnn.app.track', 'yourdfpy'} & set(sys.modules))"
    )
    result = run_python(code)
    assert result.stdout == "set()\n", result.stderr
