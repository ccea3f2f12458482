"""What holds for every test."""

from __future__ import annotations

import ast
import gc
import math
import os
from pathlib import Path

import pytest
from hypothesis import settings

# What is imported stays; looking through it again and again took a sixteenth of the whole time.
gc.disable()

# Before anything imports matplotlib: no test opens a window.
os.environ["MPLBACKEND"] = "Agg"

# The same examples in every run; no deadline, since the first call of a kernel may compile it.
settings.register_profile("iiwa_dnn", derandomize=True, deadline=None)
settings.load_profile("iiwa_dnn")


def _imported(source: Path, package: Path) -> set[Path]:
    """Files of a package that one of its files imports."""
    names = []
    for node in ast.walk(ast.parse(source.read_text())):
        if isinstance(node, ast.Import):
            names += [(name.name,) for name in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            names += [(f"{node.module}.{name.name}", node.module) for name in node.names]
    found = set()
    for candidates in names:  # a module of that name, or the name of something in the module
        paths = [package.parent.joinpath(*name.split(".")) for name in candidates]
        files = [file for at in paths for file in (at.with_suffix(".py"), at / "__init__.py")]
        found |= set([file for file in files if file.is_file() and package in file.parents][:1])
    return found


def _forget_stale_kernels() -> None:
    """Delete compiled code that is older than a file that its own file imports, by others too.

    numba looks at a function's own file only, and would go on with what it once made of others.
    """
    package = Path(__file__).parents[1] / "iiwa_dnn"
    newest = {source: source.stat().st_mtime for source in package.rglob("*.py")}
    compiled = {index: index.stat().st_mtime for index in package.rglob("__pycache__/*.nbi")}
    latest = max(newest.values(), default=0.0)
    if min(compiled.values(), default=latest) >= latest:
        return  # without reading all of the package, which takes seconds
    imports = {source: _imported(source, package) for source in newest}
    changed = True
    while changed:
        changed = False
        for source, others in imports.items():
            latest = max([newest[source], *(newest[other] for other in others)])
            changed |= latest > newest[source]
            newest[source] = latest
    for index, made in compiled.items():
        source = index.parents[1] / f"{index.name.split('.')[0]}.py"
        if made < newest.get(source, math.inf):
            index.unlink()


# The processes of pytest-xdist begin after the one that starts them, which has done it.
if "PYTEST_XDIST_WORKER" not in os.environ:
    _forget_stale_kernels()


def pytest_collection_finish() -> None:
    gc.freeze()
    gc.enable()


def _skipped(config: pytest.Config) -> list[pytest.TestReport | pytest.CollectReport]:
    """Reports of skipped tests and modules, where a skip is a failure: with CI=true."""
    reporter = config.pluginmanager.get_plugin("terminalreporter")
    if os.environ.get("CI") != "true" or reporter is None:
        return []
    return list(reporter.stats.get("skipped", []))


def pytest_sessionfinish(session: pytest.Session) -> None:
    if session.exitstatus == pytest.ExitCode.OK and _skipped(session.config):
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


def pytest_terminal_summary(
    terminalreporter: pytest.TerminalReporter, config: pytest.Config
) -> None:
    if skipped := _skipped(config):
        terminalreporter.section("skipped, which with CI=true is a failure", red=True, bold=True)
        for report in skipped:
            reason = report.longrepr[2] if isinstance(report.longrepr, tuple) else report.longrepr
            terminalreporter.line(f"{report.nodeid}: {reason}")
