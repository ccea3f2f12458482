"""What is built and handed on: wheel, sdist, pins, and one version everywhere."""

from __future__ import annotations

import re
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path
from zipfile import ZipFile

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

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


def test_wheel_carries_the_package_its_robots_and_nothing_else(built: Path) -> None:
    wheel = files_of_wheel(built)
    modules = {path.relative_to(ROOT).as_posix() for path in ROOT.glob("iiwa_dnn/**/*.py")}
    metadata = f"iiwa_dnn-{version('iiwa-dnn')}.dist-info/"
    wanted = {*modules, "iiwa_dnn/py.typed", f"{metadata}licenses/LICENSE"}
    assert ROBOTS
    assert wanted | {f"iiwa_dnn/{name}" for name in ROBOTS} <= set(wheel)
    assert not [name for name in wheel if not name.startswith(("iiwa_dnn/", metadata))]


def test_pip_builds_the_same_wheel_from_the_sdist(built: Path, tmp_path: Path) -> None:
    (sdist,) = built.glob("*.tar.gz")
    run(
        "pip", "wheel", "--no-deps", "--no-index", "--no-build-isolation", "--no-cache-dir",
        "--wheel-dir", tmp_path, sdist,
    )  # fmt: skip
    assert files_of_wheel(tmp_path) == files_of_wheel(built)


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


def test_constraints_pin_every_dependency_within_its_bound() -> None:
    lines = (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines()
    assert all(re.fullmatch(r"[a-z0-9-]+==[0-9][0-9a-z.]*", line) for line in lines)
    pinned = dict(line.split("==") for line in lines)
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = [name for extra in project["optional-dependencies"].values() for name in extra]
    for requirement in map(Requirement, [*project["dependencies"], *extras]):
        name = canonicalize_name(requirement.name)
        if name != "iiwa-dnn":
            assert requirement.specifier.contains(pinned[name]), requirement
