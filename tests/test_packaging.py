"""What is built and handed on: the wheel, pins, and one version everywhere."""

import re
import subprocess
import sys
from importlib.metadata import requires, version
from pathlib import Path
from zipfile import ZipFile

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parents[1]


def test_wheel_carries_the_package_its_robots_and_nothing_else(tmp_path: Path) -> None:
    words = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", tmp_path]
    subprocess.run(words, cwd=ROOT, check=True, capture_output=True)
    (wheel,) = tmp_path.glob("*.whl")
    names = set(ZipFile(wheel).namelist())
    metadata = f"iiwa_dnn-{version('iiwa-dnn')}.dist-info/"
    modules = {path.relative_to(ROOT).as_posix() for path in ROOT.glob("iiwa_dnn/**/*.py")}
    robots = {f"iiwa_dnn/{path.relative_to(ROOT)}" for path in ROOT.glob("robots/*/*.urdf")}
    assert modules | robots | {"iiwa_dnn/py.typed", f"{metadata}licenses/LICENSE"} <= names
    assert not [name for name in names if not name.startswith(("iiwa_dnn/", metadata))]
    assert len(robots) > 1


@pytest.mark.parametrize(
    ("file", "pattern"),
    [
        ("pyproject.toml", r'^version = "([^"]+)"'),
        ("CITATION.cff", r"^version: (\S+)$"),
        ("CHANGELOG.md", r"^## \[(\d[^]]*)\]"),  # the newest release, under Unreleased
    ],
)
def test_one_version(file: str, pattern: str) -> None:
    match = re.search(pattern, (ROOT / file).read_text(encoding="utf-8"), re.MULTILINE)
    assert match is not None
    assert match[1] == version("iiwa-dnn"), "if pyproject.toml is newer: make setup"


def test_constraints_pin_every_dependency_within_its_bound() -> None:
    lines = (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines()
    pinned = dict(line.split("==") for line in lines)
    requirements = [Requirement(line) for line in requires("iiwa-dnn") or []]
    assert len(requirements) > 20
    for requirement in requirements:
        name = canonicalize_name(requirement.name)
        if name != "iiwa-dnn":
            assert requirement.specifier.contains(pinned[name]), requirement
