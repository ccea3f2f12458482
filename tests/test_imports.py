"""Data moves one way: a module imports only from those above it. Read from the source by ast."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "iiwa_dnn"

# A module, or a folder of modules, may import what stands before it. A new one gets its place here.
ORDER = (
    "exceptions",
    "offscreen",
    "checks",
    "files",
    "interrupts",
    "kernels",
    "arms",
    "urdf",
    "robot",
    "shapes",
    "mujoco_model",
    "configuration",
    "references",
    "qp",
    "schemes",
    "networks",
    "integrators",
    "certificates",
    "solver",
    "batch",
    "crosscheck",
    "checkpool",
    "policies",
    "feedback",
    "estimation",
    "answers",
    "controller",
    "record",
    "torques",
    "incidents",
    "metrics",
    "statistics",
    "simulation",
    "provenance",
    "sweeps",
    "experiments",
    "decimation",
    "panels",
    "plots",
    "paper_plots",
    "singular_plots",
    "report",
    "paper_findings",
    "paper_report",
    "rendering",
    "pictures",
    "viewer",
    "live",
    "settings",
    "command_line",
    "cli",
    "solve_cli",
    "paper_cli",
    "noise_cli",
    "physics_cli",
    "view_cli",
    "benchmarks",
    "__init__",
    "__main__",
)

# They read a Record and recompute nothing: robot, solver and simulation are out of their sight.
AFTER_THE_RECORD = {
    "decimation", "panels", "plots", "paper_plots", "singular_plots", "report",
    "paper_findings", "paper_report",
    "rendering", "pictures", "viewer",
}  # fmt: skip
BEFORE_THEM = {
    "exceptions",
    "checks",
    "files",
    "record",
    "torques",
    "incidents",
    "metrics",
    "statistics",
}
# What draws the robot itself needs its shapes too, and nothing else of it.
DRAW_THE_ROBOT = {"rendering", "pictures", "viewer"}
SHAPES = {"robot", "shapes", "mujoco_model", "offscreen"}

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
        if name[0] == "numba" and own != "kernels":
            found.append(f"{where}, but only kernels/ is compiled")
        if name[0] != "iiwa_dnn":
            continue
        other = name[1] if len(name) > 1 and name[1] in ORDER else "__init__"
        if other == own:
            continue
        if ORDER.index(other) > ORDER.index(own):
            found.append(f"{where}, which points back: {other} stands after {own}")
        elif own in DRAW_THE_ROBOT and other in SHAPES:
            continue
        elif own in AFTER_THE_RECORD and other not in BEFORE_THEM | AFTER_THE_RECORD:
            found.append(f"{where}, but {own} works from the record alone")
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
        ("qp", "from iiwa_dnn.solver import DNNSolver", "points back: solver stands after qp"),
        ("qp", "from iiwa_dnn import solver", "points back: solver stands after qp"),
        ("qp", "import iiwa_dnn.solver as s", "points back: solver stands after qp"),
        ("qp", "from .solver import DNNSolver", "points back: solver stands after qp"),
        ("qp", "def f():\n    from . import solver", "points back: solver stands after qp"),
        ("qp", "if TYPE_CHECKING:\n    from .solver import A", "qp:2: imports iiwa_dnn.solver.A"),
        ("qp", "from iiwa_dnn import load_robot", "points back: __init__ stands after qp"),
        ("qp", "import iiwa_dnn", "points back: __init__ stands after qp"),
        ("networks/projection", "from ..solver import A", "points back: solver stands after"),
        ("networks/__init__", "from ..solver import A", "points back: solver stands after"),
        ("plots", "from iiwa_dnn.robot import Robot", "plots works from the record alone"),
        ("report", "from iiwa_dnn import simulation", "report works from the record alone"),
        ("viewer/a", "from iiwa_dnn.controller import A", "viewer works from the record alone"),
        ("solver", "from numba import njit", "only kernels/ is compiled"),
        ("solver", "import numba.typed", "only kernels/ is compiled"),
        ("surprise", "import numpy", "add it to ORDER"),
    ],
)
def test_a_wrong_import_is_found(own: str, source: str, fault: str) -> None:
    (line,) = faults(source, ("iiwa_dnn", *own.split("/")))
    assert fault in line


@pytest.mark.parametrize(
    ("own", "source"),
    [
        ("kernels/program", "import numba\nfrom numba import njit"),
        ("kernels/dense", "from numba import njit"),
        ("solver", "from iiwa_dnn.qp import QP\nfrom . import kernels\nimport numpy"),
        ("networks/projection", "from .base import Network\nfrom ..kernels import f"),
        ("networks/__init__", "from .projection import Projection"),
        ("plots", "from iiwa_dnn.record import Record\nfrom iiwa_dnn.exceptions import FileError"),
        ("report", "from iiwa_dnn.plots import save_figures"),
        ("rendering", "from iiwa_dnn.robot import Robot"),
        ("__init__", "from iiwa_dnn.cli import main\nfrom .robot import Robot"),
    ],
)
def test_a_right_import_passes(own: str, source: str) -> None:
    assert faults(source, ("iiwa_dnn", *own.split("/"))) == []
