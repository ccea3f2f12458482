"""Data moves one way: a module imports only from those above it. Read from the source by ast."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

from helpers_physics import run_python

PACKAGE = Path(__file__).parents[1] / "iiwa_dnn"

# A subpackage imports only from the subpackages before it; its own modules may import each other.
# Studies and commands come after the package itself: they take its public names, as programs of
# others do.
ORDER = (
    *("errors", "compiling", "checks", "files", "naming", "processes"),
    *("robot", "references", "qp", "networks"),
    *("schemes", "step", "posing", "control", "results", "simulation", "export", "__init__"),
    *("studies", "app", "__main__"),
)
# Results read a record and recompute nothing; what draws the robot needs its shapes too.
BEFORE_THE_RECORD = {"errors", "checks", "files", "naming", "results"}
DRAW_THE_ROBOT = {"pictures", "scenery"}


def imported(source: str, module: tuple[str, ...]) -> Iterator[tuple[str, ...]]:
    """Absolute names of all that a module imports, in functions and under TYPE_CHECKING too."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (tuple(alias.name.split(".")) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = module[: -node.level] if node.level else ()
            base += tuple(node.module.split(".")) if node.module else ()
            yield from ((*base, alias.name) for alias in node.names)


def faults(source: str, module: tuple[str, ...]) -> list[str]:
    """Rooms that a module, whose name is given in parts, must not import from."""
    found = []
    own = module[1]
    for name in imported(source, module):
        other = name[1] if len(name) > 1 and name[1] in ORDER else "__init__"
        allowed = set(ORDER[: ORDER.index(own) + 1])
        if own == "results":
            allowed = BEFORE_THE_RECORD | ({"robot"} if module[-1] in DRAW_THE_ROBOT else set())
        if name[0] == "iiwa_dnn" and other not in allowed:
            found.append(other)
    return found


def test_imports_point_forward() -> None:
    found = {}
    for path in PACKAGE.rglob("*.py"):
        module = path.relative_to(PACKAGE.parent).with_suffix("").parts
        found["/".join(module)] = faults(path.read_text(encoding="utf-8"), module)
    assert not {name: rooms for name, rooms in found.items() if rooms}
    assert len(found) > 50


def circles(modules: dict[str, set[str]]) -> list[str]:
    """Modules that import themselves by way of others, given what each imports."""
    found = []
    for name in modules:
        seen: set[str] = set()
        ahead = {*modules[name]}
        while ahead:
            seen |= ahead
            ahead = {each for far in ahead for each in modules.get(far, ())} - seen
        if name in seen:
            found.append(name)
    return found


def test_no_modules_of_the_robot_import_each_other_in_a_circle() -> None:
    modules: dict[str, set[str]] = {}
    for path in (PACKAGE / "robot").glob("[!_]*.py"):
        module = path.relative_to(PACKAGE.parent).with_suffix("").parts
        names = imported(path.read_text(encoding="utf-8"), module)
        modules[path.stem] = {name[2] for name in names if name[1:2] == ("robot",) and name[2:]}
    assert circles(modules) == []
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}}) == ["a", "b", "c"]
    assert {"start", "tools"} <= modules["robot"]


def test_a_wrong_import_is_found_and_a_right_one_passes() -> None:
    wrong = "from iiwa_dnn import qp\nimport iiwa_dnn\ndef f():\n    from ..networks import A"
    assert faults(wrong, ("iiwa_dnn", "qp", "program")) == ["__init__", "networks"]
    assert faults(wrong, ("iiwa_dnn", "results", "report")) == ["qp", "__init__", "networks"]
    assert faults(wrong, ("iiwa_dnn", "studies", "atlas")) == []


def test_an_import_needs_no_extra_and_loads_no_command_and_nothing_slow() -> None:
    code = (
        "import sys; sys.modules.update(mujoco=None, viser=None, imageio_ffmpeg=None)\n"
        "import iiwa_dnn; iiwa_dnn.Shield(iiwa_dnn.load_robot('iiwa7'))\n"
        "slow = {'numpy.ma', 'importlib.metadata', 'iiwa_dnn.export', 'scipy', 'matplotlib'}\n"
        "slow |= {'tyro', 'tomli_w', 'iiwa_dnn.app.track', 'yourdfpy', 'multiprocessing'}\n"
        "slow |= {'iiwa_dnn.results', 'iiwa_dnn.simulation', 'iiwa_dnn.control.shields'}\n"
        "print(slow & set(sys.modules))"
    )
    result = run_python(code)
    assert result.stdout == "set()\n", result.stderr


def test_names_that_are_imported_at_their_first_use_are_all_public() -> None:
    code = "import iiwa_dnn; print(len(dir(iiwa_dnn)) > len(vars(iiwa_dnn)))\n"
    code += "from iiwa_dnn import *; print(Record, simulate, iiwa_dnn.results.metrics.__name__)"
    done = run_python(code)
    assert done.stdout.splitlines()[0] == "True", done.stderr
    assert "iiwa_dnn.results.metrics" in done.stdout
