"""Resumable grids of runs, computed by joblib, which stores finished cells.

A finished cell is a file of `joblib.Memory`, found by the hash of its task, its settings and all
else that its result depends on (`fingerprint`). A sweep that was killed, even by ``kill -9``, finds
the finished cells the next time and computes the others; after any change there are new cells.

The results come in the order of the cells, whatever the number of workers, and each worker keeps
to one thread, so the same cells give the same numbers on one machine.
"""

import hashlib
import inspect
import os
from collections.abc import Callable, Sequence
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

import joblib
from tqdm import tqdm

from iiwa_dnn.errors import IiwaDnnError
from iiwa_dnn.files import prepare_folder
from iiwa_dnn.processes import end_with
from iiwa_dnn.robot.arms import robots_folder

Task = Callable[[Any], Any]

PACKAGES = ("iiwa-dnn", "numpy", "scipy", "pin")
"""Packages whose versions a result depends on."""


@cache
def fingerprint(task: Task) -> str:
    """Hash the sources of a task and of this package, the robots, and versions of `PACKAGES`."""
    digest = hashlib.sha256(" ".join([task.__qualname__, *map(version, PACKAGES)]).encode())
    package = Path(__file__).parents[1]
    files = (*sorted(package.rglob("*.py")), *sorted(robots_folder().rglob("*.urdf")))
    for path in (Path(inspect.getfile(task)), *files):
        digest.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()


def sweep(
    task: Task,
    cells: Sequence[Any],
    folder: Path,
    *,
    workers: int | None = None,
    quiet: bool = False,
) -> list[Any]:
    """Return the results of all cells, in their order; compute those that are not stored yet.

    Args:
        task: Function of a module, so that a worker can import it; its result must depend on
            nothing but its argument.
        cells: Arguments of the task, whose hashes distinguish them.
        folder: Folder of the finished cells; made if need be.
        workers: Number of processes, 1 for this one alone; None takes every core.
        quiet: Show no progress bar.

    Raises:
        IiwaDnnError: A cell has an error, which is named with the cell.
        FileError: A file cannot be written.
    """
    kept = joblib.Memory(prepare_folder(folder), verbose=0).cache(_compute, ignore=["task"])
    calls = (joblib.delayed(kept)(task, cell, fingerprint(task)) for cell in cells)
    backend: dict[str, Any] = {
        "backend": "loky",
        "n_jobs": -1 if workers is None else workers,
        "inner_max_num_threads": 1,
        "initializer": end_with,
        "initargs": (os.getpid(),),
    }
    with joblib.parallel_config(**backend):
        # One cell a message, and no arrays in shared memory, which a killed sweep would leave.
        results = joblib.Parallel(batch_size=1, return_as="generator", max_nbytes=None)(calls)
        shown = tqdm(
            results, total=len(cells), unit="run", dynamic_ncols=True, disable=quiet or None
        )
        return list(shown)


def _compute(task: Task, cell: Any, expected: str) -> Any:
    """Compute a cell in a worker; raise an error if the worker has other sources or versions."""
    if fingerprint(task) != expected:
        raise IiwaDnnError("a worker runs another version of this package or of what it needs")
    try:
        return task(cell)
    except IiwaDnnError as error:
        # The base class alone is sure to survive the way back from another process.
        raise IiwaDnnError(f"{error} (in a sweep, at {cell})") from None
