"""An environment of its own for the software that an integration's tests run beside a shield."""

import subprocess
import sys
from functools import partial
from pathlib import Path
from typing import Any

import iiwa_dnn

ROOT = Path(__file__).parents[1]


def tables_of(python: Path) -> Path:
    """Return the tables of the shield of an environment."""
    return python.parents[1] / "arm_shield.json"


def environment(folder: Path, python: str, packages: Any, shield: Any, *projects: Path) -> Path:
    """Install packages, and anew armstep and projects, beside a shield; return the Python there."""
    own = folder / "bin" / "python"
    run = partial(subprocess.run, check=True)
    if not own.exists():
        run([python, "-m", "venv", "--without-pip", folder])
    pip = [sys.executable, "-m", "pip", "--python", own, "--disable-pip-version-check", "install"]
    run([*pip, "-q", *packages])
    iiwa_dnn.export.tables(shield, tables_of(own))
    run([ROOT / ".ci" / "core"])
    armstep = ROOT / "integrations" / "armstep"
    run([*pip, "-q", "--force-reinstall", "--no-deps", armstep, *projects])
    return own
