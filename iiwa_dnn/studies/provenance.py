"""Provenance of a number besides its settings: versions, source, and the robots' URDFs."""

import hashlib
import inspect
from collections.abc import Callable
from functools import cache
from importlib.metadata import version
from modulefinder import ModuleFinder
from pathlib import Path
from typing import Any

from iiwa_dnn.robot.loading import load_robot, package_robots

_PACKAGES = ("iiwa-dnn", "numpy", "scipy", "numba", "pin")


@cache
def fingerprint(task: Callable[..., Any]) -> dict[str, Any]:
    """Collect everything that the numbers of a function depend on besides its arguments.

    That is ``versions`` of the packages that compute, and ``source``, a hash of the function's
    module, of all of this package that it imports, and of the robots' URDFs.
    """
    digest = hashlib.sha256()
    for path in sources(Path(inspect.getfile(task))):
        digest.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    for robot in package_robots():
        urdf = load_robot(robot).path
        digest.update(b"" if urdf is None else urdf.read_bytes())
    versions = {name: version(name) for name in _PACKAGES}
    return {"versions": versions, "source": digest.hexdigest()[:24]}


def sources(start: Path) -> list[Path]:
    """List a Python file and all modules of this package that it imports, directly or not.

    Nothing is imported for it, so that it does not matter what else the process has imported. The
    package's own ``__init__`` is left out: it hands names on and computes nothing.
    """
    finder: Any = ModuleFinder([])  # no other package is looked into
    finder.add_module("iiwa_dnn").__path__ = [str(Path(__file__).parents[1])]
    finder.run_script(str(start))
    return sorted({Path(module.__file__) for module in finder.modules.values() if module.__file__})
