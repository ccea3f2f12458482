"""What holds for every test."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import settings

# Before anything imports matplotlib: no test opens a window.
os.environ["MPLBACKEND"] = "Agg"

# The same examples in every run; no deadline, since the first call of a kernel may compile it.
settings.register_profile("iiwa_dnn", derandomize=True, deadline=None)
settings.load_profile("iiwa_dnn")


def _forget_stale_kernels() -> None:
    """Delete compiled code that is older than a kernel's source.

    numba looks at a function's own file only, and would go on with what it once made of others.
    """
    folder = Path(__file__).parents[1] / "iiwa_dnn"
    newest = max((source.stat().st_mtime for source in folder.rglob("*.py")), default=0.0)
    for index in folder.rglob("__pycache__/*.nbi"):
        if index.stat().st_mtime < newest:
            index.unlink()


_forget_stale_kernels()


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
