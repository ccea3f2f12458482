"""Mistakes put into the code one at a time, and the test that notices each: tests/mutants.txt.

A line of the list holds a file, a line of its code, the line in its place, and the first test that
fails, "survives" or "unknown". ``python tests/mutants.py LIST`` tries all that are unknown or were
noticed, and fails where one survives that was noticed before.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
SURVIVES = "survives"


class Mutant(NamedTuple):
    file: str
    line: str
    mutation: str
    found: str


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
    lines = text.split("\n")
    places = [number for number, line in enumerate(lines) if line.strip() == mutant.line]
    if len(places) != 1:
        return "gone"
    module = path.relative_to(tree / "iiwa_dnn")
    tests = [mutant.found.partition("[")[0], f"tests/{module.with_name(f'test_{module.name}')}"]
    tests += [f"tests/{module.parts[0]}", "tests"]
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
            lost += found == SURVIVES and mutant.found not in (SURVIVES, "unknown")
    return min(1, lost)


if __name__ == "__main__":
    text = Path(sys.argv[1]).read_text()
    sys.exit(main([Mutant(*line.split("\t")) for line in text.splitlines()]))
