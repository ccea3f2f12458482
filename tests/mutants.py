"""Mistakes put into the code one at a time, and the test that notices each: tests/mutants.txt.

A line of the list holds a file, a line of its code, the line in its place, and the first test that
fails, or "survives". `draw SEED COUNT` prints a new list of unknown ones. `run LIST` tries all that
are unknown or were noticed, and fails where one survives that was noticed before.
"""

from __future__ import annotations

import ast
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
ROOMS = ("qp", "networks", "schemes", "control", "robot", "references")
UNKNOWN = "unknown"
SURVIVES = "survives"
COMPARISONS = [(ast.Lt, ast.LtE), (ast.Gt, ast.GtE), (ast.Lt, ast.Gt), (ast.Eq, ast.NotEq)]
OPERATORS = [(ast.And, ast.Or), (ast.Add, ast.Sub), (ast.Mult, ast.Div), (ast.Is, ast.IsNot)]
NAMES = {"min": "max", "max": "min", "any": "all", "all": "any", "floor": "ceil", "sin": "cos"}


class Mutant(NamedTuple):
    file: str
    line: str
    mutation: str
    found: str


def alternatives(node: ast.AST) -> Iterator[str]:
    """What may stand in a node's place."""
    match node:
        case ast.Compare(ops=[op]) | ast.BinOp(op=op) | ast.BoolOp(op=op):
            for pair in (*COMPARISONS, *OPERATORS):
                if type(op) in pair:
                    other = pair[pair.index(type(op)) - 1]()
                    changed = {"op": other, "ops": [other]}
                    yield ast.unparse(type(node)(**(dict(ast.iter_fields(node)) | changed)))
        case ast.UnaryOp(operand=operand):
            yield ast.unparse(operand)
        case ast.Constant(value=bool(value)):
            yield str(not value)
        case ast.Constant(value=int(value) | float(value)):
            yield str(2 * value or 1)
        case ast.Name(id=name) if name in NAMES:
            yield NAMES[name]
        case ast.Assign(targets=[ast.Subscript() | ast.Attribute()]):
            yield "pass"
        case ast.AugAssign() | ast.Expr(value=ast.Call()) | ast.Continue():
            yield "pass"


def nodes(node: ast.AST) -> Iterator[ast.AST]:
    """All that runs and stands on one line: no types, decorators and messages."""
    if getattr(node, "lineno", 0) == getattr(node, "end_lineno", 1):
        yield node
    for name, value in ast.iter_fields(node):
        if name not in ("annotation", "returns", "decorator_list"):
            for child in value if isinstance(value, list) else [value]:
                if isinstance(child, ast.AST) and not isinstance(child, ast.Raise | ast.JoinedStr):
                    yield from nodes(child)


def at(text: str, line: str) -> list[int]:
    return [number for number, each in enumerate(text.split("\n")) if each.strip() == line]


def mutations(text: str) -> dict[str, list[str]]:
    """All mutations of each line that the text holds once."""
    lines = text.splitlines()
    found: dict[str, list[str]] = {}
    for node in nodes(ast.parse(text)):
        raw = lines[node.lineno - 1].encode()
        line = raw.decode().strip()
        if len(at(text, line)) == 1:
            for other in alternatives(node):
                inner = other if isinstance(node, ast.stmt | ast.Name) else f"({other})"
                mutation = raw[: node.col_offset] + inner.encode() + raw[node.end_col_offset :]
                found.setdefault(line, []).append(mutation.decode().strip())
    return found


def draw(seed: int, count: int) -> Iterator[Mutant]:
    rng = random.Random(seed)
    files = [path for room in ROOMS for path in sorted((ROOT / "iiwa_dnn" / room).rglob("*.py"))]
    every = [(path, *item) for path in files for item in mutations(path.read_text()).items()]
    for path, line, others in rng.sample(every, count):
        yield Mutant(str(path.relative_to(ROOT)), line, rng.choice(others), UNKNOWN)


def failure(tree: Path, *words: str) -> str:
    """The first test that fails, or "" if none does."""
    environment = os.environ | {"PYTHONPATH": str(tree), "CFLAGS": "-O0", "CI": ""}
    environment["PYTHONDONTWRITEBYTECODE"] = "1"  # the next mutant may be as old and as long
    command = ["timeout", "-sKILL", "1200", sys.executable, *words]
    done = subprocess.run(command, cwd=tree, env=environment, capture_output=True, text=True)
    if done.returncode in (0, 4, 5):  # 4 and 5: there is no such test
        return ""
    test = re.search(r"^(?:FAILED|ERROR) (.+?)(?: - .*)?$", done.stdout, re.MULTILINE)
    return test[1] if test else f"exit code {done.returncode} of {words[-1]}"


def attempt(tree: Path, mutant: Mutant) -> str:
    """Put a mutant into a copy of the tree, and run the likeliest tests first."""
    path = tree / mutant.file
    text = path.read_text() if path.exists() else ""
    places = at(text, mutant.line)
    if len(places) != 1:
        return "gone"
    module = path.relative_to(tree / "iiwa_dnn")
    tests = [mutant.found.partition("[")[0], f"tests/{module.with_name(f'test_{module.name}')}"]
    tests += [f"tests/{module.parts[0]}", "tests"][: 1 if mutant.found == UNKNOWN else 2]
    lines = text.split("\n")
    lines[places[0]] = lines[places[0]].replace(mutant.line, mutant.mutation)
    path.write_text("\n".join(lines))
    found = failure(tree, "-c", "import iiwa_dnn.control")
    for test in tests:
        if not found and (tree / test.partition("::")[0]).exists():
            found = failure(tree, "-m", "pytest", "-qx", "-n0", "-p", "no:cacheprovider", test)
    path.write_text(text)
    return found or SURVIVES


def main(listed: list[Mutant]) -> int:
    """Try the mutants, and return 1 where one survives that did not before."""
    ignored = shutil.ignore_patterns(".*", "__pycache__", "_kernels.*", "build", "runs", "site")
    lost = 0
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(shutil.copytree(ROOT, Path(folder) / "tree", ignore=ignored))
        for mutant in listed:
            found = SURVIVES if mutant.found == SURVIVES else attempt(tree, mutant)
            print(*mutant[:3], found, sep="\t", flush=True)
            lost += found == SURVIVES and mutant.found not in (SURVIVES, UNKNOWN)
    return min(1, lost)


if __name__ == "__main__":
    if sys.argv[1] == "run":
        text = Path(sys.argv[2]).read_text()
        sys.exit(main([Mutant(*line.split("\t")) for line in text.splitlines()]))
    for drawn in draw(int(sys.argv[2]), int(sys.argv[3])):
        print(*drawn, sep="\t")
