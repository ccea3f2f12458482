"""The documents: their code runs and prints what they say, their links lead somewhere.

A ``python`` block is run, the blocks of one document after each other in one namespace. A ``text``
block right after one is what it prints, to the letter.
"""

import contextlib
import importlib
import io
import json
import operator
import os
import re
import shlex
import subprocess
import sys
import types
from pathlib import Path

import pytest
import tyro

import iiwa_dnn
from iiwa_dnn.app.main import CONFIG
from iiwa_dnn.app.words import ExportWords, RunWords
from iiwa_dnn.compiling.library import source_of

ROOT = Path(__file__).parents[1]
DOCUMENTS = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted(ROOT.glob("docs/**/*.md"))]

_BLOCK = re.compile(r"^```python\n(.*?)^```$(?:\s*^```text\n(.*?)^```$)?", re.MULTILINE | re.DOTALL)
_LINK = re.compile(r"(?<!`)!?\[[^]]*\]\(([^)#\s]+)(?:#[^)\s]*)?\)")
_ANCHOR = re.compile(r"\]\(([\w/.]*\.md)?#([^)\s]+)\)")
_HEADING = re.compile(r"^#{1,3} (.+)$", re.MULTILINE)
_RAW_LINK = re.compile(r'<a href="([^"#:]+)"')
_RUN = re.compile(r"^iiwa-dnn ((?:track|physics|export) (?!--help).*|track)$", re.MULTILINE)
_TEST = re.compile(r"`(tests/[\w/]+\.py)(?:::(\w+))?`")


def defined(path: Path) -> set[str]:
    """Names of the functions in a Python file."""
    return set(re.findall(r"^def (\w+)", path.read_text(encoding="utf-8"), re.MULTILINE))


def anchors(text: str) -> set[str]:
    """Anchors of the headings of a page, as the forge and Sphinx name them."""
    return {
        re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        for heading in _HEADING.findall(text)
    }


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: path.name)
def test_the_code_in_the_documents_runs(
    path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)  # whatever it writes, it does not write here
    monkeypatch.setenv("CFLAGS", "-O0")  # of the Makefile that an export has
    text = path.read_text(encoding="utf-8")
    module = types.ModuleType("__docs__")  # dataclasses ask for the one of their class
    monkeypatch.setitem(sys.modules, "__docs__", module)
    for block in _BLOCK.finditer(text):
        line = text.count("\n", 0, block.start()) + 1  # in a traceback that of the document
        code = compile("\n" * line + block[1], path.name, "exec")
        with contextlib.redirect_stdout(io.StringIO()) as output:
            exec(code, vars(module))
        assert block[2] in (None, output.getvalue()), f"{path.name}:{line}"


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: path.name)
def test_links_and_named_tests_exist(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    for target in [*_LINK.findall(text), *_RAW_LINK.findall(text)]:
        if not target.startswith(("http://", "https://", "mailto:")):
            assert (path.parent / target).exists(), f"{path.name} links to {target}"
    for target, anchor in _ANCHOR.findall(text):
        page = (path.parent / target if target else path).read_text(encoding="utf-8")
        assert anchor in anchors(page), f"{path.name} links to {target}#{anchor}"
    for file, name in _TEST.findall(text):
        assert (ROOT / file).is_file(), f"{path.name} names {file}"
        assert not name or name in defined(ROOT / file), f"{path.name} names {file}::{name}"


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: path.name)
def test_the_commands_of_a_page_are_understood_and_none_is_refused_its_folder(path: Path) -> None:
    """A folder belongs to one run: other settings need another ``--out``."""
    owners = {Path("runs/heart"): ["track"]}  # make heart, the first thing that a reader does
    for line in _RUN.findall(path.read_text(encoding="utf-8")):
        words = shlex.split(line, comments=True)
        kind = ExportWords if words[0] == "export" else RunWords
        options = tyro.cli(kind, args=words[1:], config=CONFIG)
        if options.config is None and words[0] != "export":
            name = options.path or options.reference or "heart"
            out = Path("runs") / ("physics" if words[0] == "physics" else Path(name).stem)
            owner = owners.setdefault(options.out or out, words)
            assert owner == words, f"{path.name}: iiwa-dnn {line}"


def test_attributes_that_the_pages_name_exist() -> None:
    found = {
        match
        for path in DOCUMENTS
        for match in re.findall(r"`([A-Z]\w+)\.(\w+)\b", path.read_text(encoding="utf-8"))
    }
    known = [
        (getattr(iiwa_dnn, name), attribute)
        for name, attribute in found
        if name in iiwa_dnn.__all__
    ]
    assert len(known) > 10
    for kind, attribute in known:
        fields = {name for base in kind.__mro__ for name in vars(base).get("__annotations__", ())}
        assert hasattr(kind, attribute) or attribute in fields, f"{kind.__name__}.{attribute}"


def test_every_public_name_stands_on_one_page_of_the_api(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(ROOT / "docs")
    pages = importlib.import_module("api_pages")
    shown = [name for room in pages.ROOMS for name, _ in pages.members(iiwa_dnn, room)]
    assert len(shown) == len(set(shown))
    modules = {"iiwa_dnn.export"}
    assert {f"iiwa_dnn.{name}" for name in iiwa_dnn.__all__} - modules <= set(shown)
    linked = re.findall(r"^api/(\w+)$", (ROOT / "docs/api.md").read_text(), re.MULTILINE)
    assert linked == list(pages.ROOMS)


def test_a_package_whose_annotations_stay_text_says_the_same() -> None:
    code = "import api_pages; print(api_pages.load_package().Record.__doc__, end='')"
    options = {"cwd": ROOT / "docs", "env": {**os.environ, "PYTHONPATH": str(ROOT)}}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, **options)
    assert done.stdout == iiwa_dnn.Record.__doc__, done.stderr


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
            found = source_of(operator.attrgetter(name)(module))
            assert found.__module__ == module.__name__, f"{name} comes from {found.__module__}"


def test_every_erratum_has_its_tests_and_every_test_its_erratum() -> None:
    text = (ROOT / "docs" / "errata.md").read_text(encoding="utf-8")
    entries = re.split(r"^## (?=\d+\. )", text, flags=re.MULTILINE)[1:]
    assert [int(entry.split(".")[0]) for entry in entries] == list(range(1, len(entries) + 1))
    named = [_TEST.findall(entry) for entry in entries]
    assert all(named), "an entry without a test"
    tests = {name for name in defined(ROOT / "tests/test_errata.py") if name.startswith("test_")}
    assert {name for entry in named for file, name in entry if "errata" in file} == tests


@pytest.mark.parametrize("name", ["quickstart", "solver_comparison"])
def test_kept_outputs_of_a_notebook_are_those_of_one_run_in_order(name: str) -> None:
    text = (ROOT / "notebooks" / f"{name}.ipynb").read_text(encoding="utf-8")
    code = [cell for cell in json.loads(text)["cells"] if cell["cell_type"] == "code"]
    assert [cell["execution_count"] for cell in code] == list(range(1, len(code) + 1))
    outputs = [output for cell in code for output in cell["outputs"]]
    assert any("image/png" in output.get("data", {}) for output in outputs)
    # A warning would be in stderr.
    assert not [
        out for out in outputs if out["output_type"] == "error" or out.get("name") == "stderr"
    ]
    assert "/home/" not in text
