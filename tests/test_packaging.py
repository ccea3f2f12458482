"""What is built and handed on: wheel, sdist, pins, and one version everywhere."""

from __future__ import annotations

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
ROBOTS = sorted(path.relative_to(ROOT).as_posix() for path in ROOT.glob("robots/*/*.urdf"))


def run(*command: str | Path) -> None:
    result = subprocess.run(
        [sys.executable, "-m", *map(str, command)], cwd=ROOT, capture_output=True, text=True
    )
    assert result.returncode == 0, result.stdout + result.stderr


def files_of_wheel(folder: Path) -> list[str]:
    """Names of the files in the wheel in a folder."""
    (wheel,) = folder.glob("*.whl")
    with ZipFile(wheel) as archive:
        return sorted(archive.namelist())


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the sdist and the wheel of the checkout."""
    folder = tmp_path_factory.mktemp("built")
    run("hatchling", "build", "-t", "sdist", "-t", "wheel", "-d", folder)
    return folder


@pytest.fixture(scope="module")
def wheel(built: Path) -> list[str]:
    return files_of_wheel(built)


def test_wheel_carries_the_robots_and_the_type_marker(wheel: list[str]) -> None:
    assert "robots/iiwa7/iiwa7.urdf" in ROBOTS
    assert {f"iiwa_dnn/{name}" for name in ROBOTS} <= set(wheel)
    assert "iiwa_dnn/py.typed" in wheel


def test_wheel_carries_the_whole_package_and_nothing_else(wheel: list[str]) -> None:
    modules = {path.relative_to(ROOT).as_posix() for path in ROOT.glob("iiwa_dnn/**/*.py")}
    assert modules <= set(wheel)
    metadata = f"iiwa_dnn-{version('iiwa-dnn')}.dist-info/"
    others = [name for name in wheel if not name.startswith(("iiwa_dnn/", metadata))]
    assert others == []
    assert f"{metadata}licenses/LICENSE" in wheel


def test_pip_builds_the_same_wheel_from_the_sdist(
    built: Path, wheel: list[str], tmp_path: Path
) -> None:
    (sdist,) = built.glob("*.tar.gz")
    run(
        "pip", "wheel", "--no-deps", "--no-index", "--no-build-isolation", "--no-cache-dir",
        "--wheel-dir", tmp_path, sdist,
    )  # fmt: skip
    assert files_of_wheel(tmp_path) == wheel


@pytest.mark.parametrize(
    ("file", "pattern"),
    [
        ("pyproject.toml", r'^version = "([^"]+)"'),
        ("CITATION.cff", r"^version: (\S+)$"),
        ("README.md", r"note   = \{Version (\S+)\}"),
        ("CHANGELOG.md", r"^## \[(\d[^]]*)\]"),  # the newest release, under Unreleased
    ],
)
def test_one_version(file: str, pattern: str) -> None:
    match = re.search(pattern, (ROOT / file).read_text(encoding="utf-8"), re.MULTILINE)
    assert match is not None
    assert match[1] == version("iiwa-dnn"), "if pyproject.toml is newer: make setup"


def pins() -> dict[str, str]:
    lines = (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines()
    for line in lines:
        assert re.fullmatch(r"[a-z0-9-]+==[0-9][0-9a-z.]*", line), line
    found = dict(line.split("==") for line in lines)
    assert len(found) == len(lines), "a name stands twice"
    assert list(found) == sorted(found)
    return found


def test_constraints_are_names_and_versions_only() -> None:
    assert pins()


def test_constraints_pin_every_dependency_within_its_bound() -> None:
    pinned = pins()
    for requirement in map(Requirement, requires("iiwa-dnn") or []):
        name = canonicalize_name(requirement.name)
        if name != "iiwa-dnn":
            assert requirement.specifier.contains(pinned[name]), requirement
