"""The wheel: compiled from the text that is emitted, for every Python, without iiwa_dnn."""

import shutil
import sys
import zipfile
from pathlib import Path

import armstep
import pytest

from helpers_export import run
from hostile_arms import START, make_shield
from iiwa_dnn import export
from iiwa_dnn.export.core import core
from iiwa_dnn.export.cuda import cuda_code


def test_the_wheel_repeats_recorded_steps_without_this_package(tmp_path: Path) -> None:
    pytest.importorskip("hatchling")
    project = tmp_path / "project"
    shutil.copytree(
        Path(armstep.__file__).parents[1],
        project,
        ignore=shutil.ignore_patterns("*.bin", "armstep.[ch]", "*.cu", "dist", "test"),
    )
    build = [sys.executable, "-m", "hatchling", "build", "-t"]
    with pytest.raises(AssertionError, match=r"armstep\.c is missing: \.ci/core writes it"):
        run(*build, "wheel", cwd=project)
    (project / "armstep" / "armstep.c").write_text(core().code, encoding="utf-8")
    (project / "armstep" / "armstep.h").write_text(core().header, encoding="utf-8")
    (project / "armstep" / "shields.cu").write_text(cuda_code(), encoding="utf-8")
    # A repository around that ignores what is emitted would leave it out.
    (tmp_path / ".git").mkdir()
    (tmp_path / ".gitignore").write_text(
        "armstep.[ch]\nshields.cu\n_library.bin\n", encoding="utf-8"
    )
    run(*build, "sdist", cwd=project)
    [sdist] = (project / "dist").glob("armstep-*.tar.gz")
    shutil.unpack_archive(sdist, tmp_path / "unpacked", filter="data")
    [source] = (tmp_path / "unpacked").iterdir()
    run(*build, "wheel", cwd=source)
    [wheel] = (source / "dist").glob("armstep-*-py3-none-linux_*.whl")
    assert wheel.stat().st_size < 275_000  # half of it for GPUs
    with zipfile.ZipFile(wheel) as own:
        assert "armstep/armstep.c" not in own.namelist()
        assert "armstep/shields.cu" in own.namelist()
        own.extractall(tmp_path / "site")
    path = export.tables(make_shield(), tmp_path / "arm.json", q0=START)
    lines = f"""
import sys; sys.path[:0] = [{str(tmp_path / "site")!r}]
import os; os.environ.pop("ARMSTEP_LIBRARY")
from armstep.__main__ import main
assert main(["check", {str(path)!r}]) == 0
assert "iiwa_dnn" not in sys.modules and "pinocchio" not in sys.modules
"""
    assert "200 steps, 0 differ" in run(sys.executable, "-I", "-c", lines)
