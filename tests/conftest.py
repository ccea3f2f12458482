"""What holds for every test."""

from __future__ import annotations

import gc
import os

import pytest
from hypothesis import settings

# What is imported stays; looking through it again and again took a sixteenth of the whole time.
gc.disable()

# Before anything imports matplotlib: no test opens a window.
os.environ["MPLBACKEND"] = "Agg"

# The same examples in every run, and none too slow on a busy machine.
settings.register_profile("iiwa_dnn", derandomize=True, deadline=None)
settings.load_profile("iiwa_dnn")


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
