"""The documents: their code runs and prints what they say, their links lead somewhere.

A ``python`` block is run, the blocks of one document after each other in one namespace. A ``text``
block right after one is what it prints, to the letter.
"""

from __future__ import annotations

import ast
import contextlib
import importlib
import io
import operator
import re
import shlex
import sys
import types
from pathlib import Path

import pytest
import tyro

from helpers_export import compile_quickly
from iiwa_dnn.app.main import COMMANDS, CONFIG
from iiwa_dnn.compiling.library import source_of

ROOT = Path(__file__).parents[1]
DOCUMENTS = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted(ROOT.glob("docs/**/*.md"))]

_FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_LINK = re.compile(r"(?<!`)!?\[[^]]*\]\(([^)#\s]+)(#[^)\s]*)?\)")
_RAW_LINK = re.compile(r'<a href="([^"#:]+)"')
_RUN = re.compile(r"^iiwa-dnn ((?:track|physics|export) (?!--help).*|track)$", re.MULTILINE)
_TEST = re.compile(r"`(tests/[\w/]+\.py)(?:::(\w+))?`")


def blocks(text: str) -> list[tuple[str, str, int, bool]]:
    """Language, content, line of the content, and whether it comes right after the one before."""
    found, end = [], 0
    for match in _FENCE.finditer(text):
        line = text.count("\n", 0, match.start()) + 2
        found.append((match[1], match[2], line, not text[end : match.start()].strip()))
        end = match.end()
    return found


def run_blocks(text: str, name: str) -> None:
    """Run the Python of a document, `name` in tracebacks, and compare what it prints."""
    # A module of its own, since dataclasses ask for that of their class.
    module = types.ModuleType("__docs__")
    sys.modules["__docs__"], namespace = module, vars(module)
    printed: str | None = None
    for language, content, line, follows in blocks(text):
        if language == "python":
            # Line numbers of the document, for the traceback.
            code = compile("\n" * (line - 1) + content, name, "exec")
            with contextlib.redirect_stdout(io.StringIO()) as output:
                exec(code, namespace)
            printed = output.getvalue()
        elif language == "text" and follows and printed is not None:
            assert printed == content, f"{name}:{line}: the block above prints otherwise"


def defined(path: Path) -> set[str]:
    """Names of the functions in a Python file."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: path.name)
def test_the_code_in_the_documents_runs(
    path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)  # whatever it writes, it does not write here
    compile_quickly(monkeypatch)
    run_blocks(path.read_text(encoding="utf-8"), path.name)


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: path.name)
def test_links_and_named_tests_exist(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    for target in (*(target for target, _ in _LINK.findall(text)), *_RAW_LINK.findall(text)):
        if not target.startswith(("http://", "https://", "mailto:")):
            assert (path.parent / target).exists(), f"{path.name} links to {target}"
    for file, name in _TEST.findall(text):
        assert (ROOT / file).is_file(), f"{path.name} names {file}"
        assert not name or name in defined(ROOT / file), f"{path.name} names {file}::{name}"


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: path.name)
def test_the_commands_of_a_page_are_understood_and_none_is_refused_its_folder(path: Path) -> None:
    """A folder belongs to one run: other settings need another ``--out``."""
    owners = {Path("runs/heart"): ["track"]}  # make heart, the first thing that a reader does
    for line in _RUN.findall(path.read_text(encoding="utf-8")):
        words = shlex.split(line, comments=True)
        options = tyro.cli(COMMANDS[words[0]], args=words[1:], config=CONFIG)
        if options.config is None and words[0] != "export":
            name = options.path or options.reference or "heart"
            out = Path("runs") / ("physics" if words[0] == "physics" else Path(name).stem)
            owner = owners.setdefault(options.out or out, words)
            assert owner == words, f"{path.name}: iiwa-dnn {line}"


def test_the_table_of_contents_is_complete() -> None:
    pages = {path.stem for path in (ROOT / "docs").glob("*.md")} - {"index"}
    pages |= {f"notebooks/{path.stem}" for path in (ROOT / "notebooks").glob("*.ipynb")}
    index = (ROOT / "docs" / "index.md").read_text(encoding="utf-8")
    trees = re.findall(r"^```{toctree}\n(.*?)^```$", index, re.MULTILINE | re.DOTALL)
    named = {line for tree in trees for line in tree.splitlines() if line and line[0] != ":"}
    assert named == pages


def test_the_table_of_equations_names_what_exists() -> None:
    text = (ROOT / "docs" / "theory.md").read_text(encoding="utf-8")
    section = text.split("## Equations and files")[1].split("\n## ")[0]
    rows = re.findall(
        r"\| \[([\w/.]+)\]\(\.\./iiwa_dnn/([\w/.]+)\) \| (.+) \|$", section, re.MULTILINE
    )
    assert len(rows) == sum(line.startswith("| ") for line in section.splitlines()) - 2
    for label, file, names in rows:
        assert label == file
        module = importlib.import_module(f"iiwa_dnn.{file.removesuffix('.py').replace('/', '.')}")
        for name in re.findall(r"`([\w.]+)`", names):
            found = operator.attrgetter(name)(module)
            found = source_of(found)
            assert found.__module__ == module.__name__, f"{name} comes from {found.__module__}"


def test_every_erratum_has_its_tests_and_every_test_its_erratum() -> None:
    text = (ROOT / "docs" / "errata.md").read_text(encoding="utf-8")
    entries = re.split(r"^## (?=\d+\. )", text, flags=re.MULTILINE)[1:]
    numbers = [int(entry.split(".")[0]) for entry in entries]
    assert numbers == list(range(1, len(entries) + 1))
    assert len(entries) >= 8
    named = [_TEST.findall(entry) for entry in entries]
    assert all(named), "an entry without a test"
    tests = {name for name in defined(ROOT / "tests/test_errata.py") if name.startswith("test_")}
    assert {name for entry in named for file, name in entry if "errata" in file} == tests
