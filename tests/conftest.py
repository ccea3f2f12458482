"""What holds for every test."""

import gc
import os
import signal
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import settings

# What a shell starts in the background ignores Ctrl-C, and so would the commands of tests.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# What is imported stays; looking through it again and again took a sixteenth of the whole time.
gc.disable()

# Before anything imports matplotlib: no test opens a window.
os.environ["MPLBACKEND"] = "Agg"

# The same examples in every run, and none too slow on a busy machine.
settings.register_profile("iiwa_dnn", derandomize=True, deadline=None)
settings.load_profile("iiwa_dnn")


@pytest.fixture
def written(tmp_path: Path) -> Callable[[str | bytes], Path]:
    """Write a URDF file, and return its path."""

    def write(content: str | bytes) -> Path:
        path = tmp_path / "some.urdf"
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return write


def pytest_collection_finish() -> None:
    gc.freeze()
    gc.enable()


def pytest_sessionfinish(session: pytest.Session) -> None:
    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    is_strict = os.environ.get("CI") == "true" and reporter is not None
    if is_strict and reporter.stats.get("skipped") and session.exitstatus == pytest.ExitCode.OK:
        session.exitstatus = pytest.ExitCode.TESTS_FAILED
        reporter.write_line("\nwith CI=true a skipped test is a failure", red=True)
