"""Commands called in this process, and what they leave."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from iiwa_dnn.app.main import main

SHORT = ("--dt", "1e-3", "--duration", "0.05")
QUICK = (*SHORT, "--no-plots")


def call(*words: object) -> int:
    """The exit code, whether the parser ends the process or the function returns."""
    try:
        return main(list(map(str, words)))
    except SystemExit as end:
        return int(str(end.code))


def results(folder: Path) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """Record and metrics, read with numpy and json alone."""
    with np.load(folder / "record.npz", allow_pickle=False) as archive:
        arrays = dict(archive)
    return arrays, json.loads((folder / "metrics.json").read_text())


def track(folder: Path, *words: object) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """A quick run that succeeds, without figures."""
    assert call("track", *QUICK, *words, "--out", folder) == 0
    return results(folder)


def marked(mark: str) -> list[str]:
    """Commands of the living processes whose environment holds a mark."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            if mark.encode() in (folder / "environ").read_bytes().split(b"\0"):
                command = (folder / "cmdline").read_bytes()
                found.append(command.replace(b"\0", b" ").decode())
        except OSError:  # it has ended, or is another user's
            continue
    return found
