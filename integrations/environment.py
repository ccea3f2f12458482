"""An environment of its own for the software that an integration's tests run beside a shield."""

import subprocess
import sys
from functools import partial
from pathlib import Path
from typing import Any

import iiwa_dnn


def environment(folder: Path, python: str, packages: Any, shield: Any, *projects: Path) -> Path:
    """Install packages, and anew a shield as `arm_shield` and projects; return the Python there."""
    own = folder / "bin" / "python"
    run = partial(subprocess.run, check=True)
    if not own.exists():
        run([python, "-m", "venv", "--without-pip", folder])
    pip = [sys.executable, "-m", "pip", "--python", own, "--disable-pip-version-check", "install"]
    run([*pip, "-q", *packages])
    project = iiwa_dnn.export.python(shield, folder / "arm_shield", name="arm_shield")
    run([*pip, "-q", "--force-reinstall", "--no-deps", project, *projects])
    return own
