"""What is public says the shape of its arrays, and the unit where they stand for something.

Ruff's pydocstyle rules see to it that there is a docstring. Here the annotations are read: where
one is an array, the words about it must hold a shape such as ``(n,)``, or its parts as in
``[x | y]``; and those about joint angles, velocities, forces and times a unit such as ``[rad]``. A
method that a protocol or a base class describes needs no description of its own.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

PACKAGE = Path(__file__).parents[1] / "iiwa_dnn"
FILES = sorted(PACKAGE.rglob("*.py"))
"""Every module, whether its names are handed on by the package or not."""

_ARRAY = re.compile(r"\b(NDArray|ArrayLike|Vector|Matrix|FloatArray|Image)\b")
_SHAPE = re.compile(
    r"\([^()]*(,|\.\.\.)[^()]*\)|\bsize\b|\bshape\b|\brow\b|likewise|\[\w+ \||\bnumber\b"
)
_UNIT = re.compile(r"\[[^\]]+\]|\bunit|[Cc]ost vector")  # a program's q has any unit
_PHYSICAL = re.compile(
    r"^(q|q0|dq|velocity|velocities|position|positions|linear_velocity|angular_velocity|torque|"
    r"lower|upper|q_lower|q_upper|dq_max|home|displacement|t|times|force|noise)$"
)


class Item(NamedTuple):
    """One array that is public, and what is said of it."""

    where: str
    name: str
    words: str


def sections(docstring: str) -> dict[str, str]:
    """Entries of ``Args:`` and ``Attributes:`` by name, the other sections, and all of it as ''."""
    found: dict[str, str] = {"": docstring}
    part = ""
    name = ""
    for line in docstring.splitlines():
        if re.fullmatch(r"\s*(Args|Attributes|Returns|Yields|Raises):", line):
            part, name = line.strip().rstrip(":"), ""
            found.setdefault(part, "")
        elif part in ("Args", "Attributes"):
            entry = re.match(r"\s+\*{0,2}(\w+): (.*)", line)
            if entry:
                name = entry[1]
                found[name] = entry[2]
            elif name:
                found[name] += " " + line.strip()
        elif part:
            found[part] += " " + line.strip()
    return found


def says_for_others(node: ast.ClassDef) -> bool:
    """Whether a class describes methods that others implement."""
    return bool({"Protocol", "ABC"} & set(map(ast.unparse, node.bases)))


def described_elsewhere() -> set[str]:
    """Methods of protocols and abstract methods: who implements one need not say it all again."""
    found = set()
    for path in FILES:
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.ClassDef) and says_for_others(node):
                found |= {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
    return found


DESCRIBED = described_elsewhere()


def column_words(annotation: ast.expr) -> str:
    """Meaning and shape in ``Annotated[..., Column(meaning, shape)]``, of which docs are made."""
    calls = [node for node in ast.walk(annotation) if isinstance(node, ast.Call)]
    return " ".join(ast.unparse(argument) for call in calls for argument in call.args)


def is_kernel(function: ast.FunctionDef) -> bool:
    """Whether a function is a part's kernel, whose shapes schemes/parts.py states."""
    return [argument.arg for argument in function.args.args[:2]] == ["step", "constants"]


def is_public(name: str) -> bool:
    return not name.startswith("_")


def arrays(path: Path) -> Iterator[Item]:
    """The public arrays of a module: arguments and results of functions, attributes of classes."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    module = path.relative_to(PACKAGE).as_posix()

    def of_function(function: ast.FunctionDef, owner: str, inherited: str) -> Iterator[Item]:
        if is_kernel(function):
            return
        said = sections(ast.get_docstring(function) or "")
        if said[""].startswith("See :meth:") or (inherited and function.name in DESCRIBED):
            return
        where = f"{module}:{function.lineno} {owner}{function.name}"
        for argument in function.args.args + function.args.kwonlyargs:
            if argument.annotation is None or not _ARRAY.search(ast.unparse(argument.annotation)):
                continue
            yield Item(where, argument.arg, said.get(argument.arg, said[""] + inherited))
        returns = ast.unparse(function.returns) if function.returns is not None else ""
        if _ARRAY.search(returns) and "ndarray" not in returns.lower().replace("ndarray[np", ""):
            yield Item(where, "return value", said.get("Returns", said.get("Yields", said[""])))

    for node in tree.body:
        if isinstance(node, ast.FunctionDef) and is_public(node.name):
            yield from of_function(node, "", "")
        if not isinstance(node, ast.ClassDef) or not is_public(node.name):
            continue
        text = ast.get_docstring(node) or ""
        said = sections(text)
        for item in node.body:
            if isinstance(item, ast.AnnAssign) and isinstance(item.target, ast.Name):
                name = item.target.id
                if is_public(name) and _ARRAY.search(ast.unparse(item.annotation)):
                    where = f"{module}:{item.lineno} {node.name}"
                    yield Item(where, name, said.get(name, column_words(item.annotation)))
            elif isinstance(item, ast.FunctionDef) and (
                is_public(item.name) or item.name in ("__init__", "__call__")
            ):
                own = ast.get_docstring(item)
                if own is None and item.name in said:  # a property that the class describes
                    continue
                inherited = "" if says_for_others(node) else f" {text}"
                yield from of_function(item, f"{node.name}.", inherited)


def faults(path: Path) -> list[str]:
    found = []
    for item in arrays(path):
        if not _SHAPE.search(item.words):
            found.append(f"{item.where}: {item.name} has no shape: {item.words.strip()[:70]!r}")
        elif _PHYSICAL.match(item.name) and not _UNIT.search(item.words):
            found.append(f"{item.where}: {item.name} has no unit: {item.words.strip()[:70]!r}")
    return found


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.relative_to(PACKAGE).as_posix())
def test_public_arrays_have_shapes_and_units(path: Path) -> None:
    found = faults(path)
    assert not found, "\n".join(found)


def test_a_missing_shape_and_a_missing_unit_are_found(tmp_path: Path) -> None:
    good = (
        'def move(q: ArrayLike, gain: float) -> Vector:\n    """Move.\n\n    Args:\n'
        "        q: Joint positions [rad], (n,).\n        gain: How much.\n\n    Returns:\n"
        '        The same, (n,).\n    """\n'
    )
    file = PACKAGE / "made_up.py"
    for text, words in (
        (good, None),
        (good.replace("[rad], (n,)", "[rad]"), "q has no shape"),
        (good.replace("[rad], (n,)", "(n,)"), "q has no unit"),
        (good.replace("The same, (n,)", "The same"), "return value has no shape"),
        (
            'class A:\n    """A.\n\n    Attributes:\n        x: Two.\n    """\n    x: Vector\n',
            "x has no",
        ),
    ):
        found = faults_of_text(text, file, tmp_path)
        assert (found == []) if words is None else (words in found[0])


def faults_of_text(text: str, name: Path, folder: Path) -> list[str]:
    """The faults of a text, as if it were a module of the package."""
    path = folder / name.name
    path.write_text(text, encoding="utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(globals(), "PACKAGE", folder)
        return faults(path)


def test_arrays_are_looked_at() -> None:
    assert sum(1 for path in FILES for _ in arrays(path)) > 150
