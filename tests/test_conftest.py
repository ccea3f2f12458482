"""With CI=true, a skipped test is a failure."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

SKIPS = """
import pytest

def test_passes():
    assert True

def test_skips():
    pytest.skip("no such package")
"""
FAILS_AS_EXPECTED = """
import pytest

@pytest.mark.xfail
def test_fails():
    assert False
"""


def run_pytest(folder: Path, ci: str, source: str) -> subprocess.CompletedProcess[str]:
    shutil.copy(Path(__file__).with_name("conftest.py"), folder)
    (folder / "test_it.py").write_text(source, encoding="utf-8")
    return subprocess.run(
        [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "--rootdir", folder, folder],
        cwd=folder,
        # Without the plugins that are installed, which take longer to import than the tests run.
        env={**os.environ, "CI": ci, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"},
        capture_output=True,
        text=True,
    )


def test_a_skip_fails_in_ci_and_is_listed(tmp_path: Path) -> None:
    module = "import pytest\npytest.importorskip('no_such_package')"
    (tmp_path / "test_module.py").write_text(module, encoding="utf-8")
    result = run_pytest(tmp_path, "true", SKIPS)
    assert result.returncode != 0
    assert "with CI=true is a failure" in result.stdout
    listed = result.stdout.split("with CI=true is a failure")[1]
    assert "test_it.py" in listed
    assert "test_module.py" in listed


def test_a_skip_passes_elsewhere(tmp_path: Path) -> None:
    result = run_pytest(tmp_path, "", SKIPS)
    assert result.returncode == 0
    assert "CI=true" not in result.stdout


def test_an_expected_failure_is_not_a_skip(tmp_path: Path) -> None:
    assert run_pytest(tmp_path, "true", FAILS_AS_EXPECTED).returncode == 0
