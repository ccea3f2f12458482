"""Resumable grids of runs, on all cores through joblib or on a Dask cluster.

A cell is one setting of a task, in JSON types. The outcome of a finished cell is one file, named by
the hash of its settings and of all else that the numbers depend on (`fingerprint`). A sweep that
was killed, even by ``kill -9``, finds the finished cells the next time and computes the others;
after any change there are new cells, and old ones are never taken for them. Only the process that
asked writes files, each atomically.

The answers come in the order of the cells, whatever the number of workers, and each worker keeps
to one thread, so the same cells give the same numbers on one machine.
"""

import hashlib
import inspect
import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

import joblib
from tqdm import tqdm

from iiwa_dnn.errors import IiwaDnnError, InvalidInputError
from iiwa_dnn.files import one_line, plain, prepare_folder, write_json
from iiwa_dnn.results.record import Record
from iiwa_dnn.robot.loading import robots_folder

Settings = Mapping[str, Any]

_PACKAGES = ("iiwa-dnn", "numpy", "scipy", "numba", "pin")
_PATIENCE = 10.0  # time to look for a scheduler [s]
_ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1"
)


@dataclass(frozen=True)
class Outcome:
    """The outcome of one cell.

    Attributes:
        values: Its numbers, in JSON types.
        record: The run itself, where figures will be drawn from it; None keeps the numbers only.
    """

    values: dict[str, Any]
    record: Record | None = None


Task = Callable[[Settings], Outcome]


@cache
def fingerprint(task: Task) -> dict[str, Any]:
    """Collect everything that the numbers of a function depend on besides its arguments.

    That is ``versions`` of the packages that compute, and ``source``, a hash of the function's
    module, of all modules of this package, and of the robots' URDFs.
    """
    package = Path(__file__).parents[1]
    files = [Path(inspect.getfile(task)), *sorted(package.rglob("*.py"))]
    files += sorted(robots_folder().rglob("*.urdf"))
    digest = hashlib.sha256()
    for path in files:
        digest.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    versions = {name: version(name) for name in _PACKAGES}
    return {"versions": versions, "source": digest.hexdigest()[:24]}


@dataclass(frozen=True)
class Sweep:
    """A task, and the folder in which its finished cells are kept.

    Attributes:
        task: A function of a module, so that a worker can import it; its result must depend on
            nothing but its argument.
        folder: Folder of the cells' files; made if need be.
    """

    task: Task
    folder: Path

    def run(
        self,
        cells: Sequence[Settings],
        *,
        workers: int | None = None,
        dask: str | None = None,
        quiet: bool = False,
    ) -> list[dict[str, Any]]:
        """Compute the cells that are not there yet, and return the numbers of all.

        Args:
            cells: Settings in JSON types; equal ones are computed once.
            workers: Number of processes, 1 for this one alone; None takes every core.
            dask: ``"local"`` starts a Dask cluster on this machine, any other text is the address
                of a scheduler; None stays with joblib.
            quiet: Show no progress bar.

        Returns:
            The numbers of each cell, in the order of `cells`.

        Raises:
            InvalidInputError: There is no Dask at that address.
            FileError: A file cannot be written.
        """
        prepare_folder(self.folder)
        names = [self.name(cell) for cell in cells]
        found = {name: self._read(name) for name in names}
        todo = {name: cell for name, cell in zip(names, cells, strict=True) if found[name] is None}
        bar = tqdm(
            total=len(found),
            initial=len(found) - len(todo),
            unit="run",
            dynamic_ncols=True,
            disable=quiet or None,  # None: no bar where standard error is not a terminal
        )
        with bar:
            for name, outcome in self._outcomes(todo, workers, dask):
                found[name] = self._write(name, todo[name], outcome)
                bar.update()
        return [found[name] or {} for name in names]

    def record(self, cell: Settings) -> Record:
        """Load the record of a finished cell.

        Raises:
            FileError: The cell is not finished, or its task kept no record.
        """
        return Record.load(self.folder / f"{self.name(cell)}.npz")

    def name(self, cell: Settings) -> str:
        """Return the name of a cell's files: a hash of all that its numbers depend on."""
        text = json.dumps(self._identity(cell), sort_keys=True, allow_nan=False)
        return hashlib.sha256(text.encode()).hexdigest()[:24]

    def _identity(self, cell: Settings) -> dict[str, Any]:
        task = f"{self.task.__module__}.{self.task.__qualname__}"
        return {"task": task, "settings": plain(cell), **fingerprint(self.task)}

    def _read(self, name: str) -> dict[str, Any] | None:
        """Read the numbers of a finished cell; None if its file is missing or damaged."""
        try:
            content = json.loads((self.folder / f"{name}.json").read_text(encoding="utf-8"))
            values: dict[str, Any] = content["values"]
            kept = not content["record"] or (self.folder / f"{name}.npz").is_file()
        except (OSError, ValueError, KeyError, TypeError):
            return None
        return values if kept else None

    def _write(self, name: str, cell: Settings, outcome: Outcome) -> dict[str, Any]:
        """Write the outcome of a cell; the numbers last, since they say that it is finished."""
        values: dict[str, Any] = plain(outcome.values)
        if outcome.record is not None:
            outcome.record.save(self.folder / f"{name}.npz")
        kept = outcome.record is not None
        content = {"identity": self._identity(cell), "record": kept, "values": values}
        write_json(self.folder / f"{name}.json", content)
        return values

    def _outcomes(
        self, todo: Mapping[str, Settings], workers: int | None, dask: str | None
    ) -> Iterator[tuple[str, Outcome]]:
        """Compute the cells, each yielded as soon as it is done, in whatever order."""
        if not todo:
            return
        compute = joblib.delayed(_compute)
        expected = fingerprint(self.task)
        calls = (compute(name, self.task, dict(cell), expected) for name, cell in todo.items())
        workers = min(workers or joblib.cpu_count(), len(todo))
        client: AbstractContextManager[Any] = nullcontext()
        backend = {"backend": "loky", "n_jobs": workers, "inner_max_num_threads": 1}
        if dask is not None:
            client = _connect(workers, dask)
            backend = {"backend": "dask"}
        with client, joblib.parallel_config(**backend):
            # One cell a message: a finished one is written at once.
            # max_nbytes: no arrays in shared memory, which a killed sweep would leave behind.
            options = {"batch_size": 1, "return_as": "generator_unordered", "max_nbytes": None}
            yield from joblib.Parallel(**options)(calls)


def _compute(
    name: str, task: Task, cell: Settings, expected: dict[str, Any]
) -> tuple[str, Outcome]:
    """Compute a cell in a worker; one with other versions than the asking process refuses."""
    own = fingerprint(task)
    if own != expected:
        raise IiwaDnnError(f"a worker runs other versions: {own}, expected {expected}")
    try:
        return name, task(cell)
    except IiwaDnnError as error:
        # The base class alone is sure to survive the way back from another process.
        raise IiwaDnnError(f"{error} (in a sweep, at {json.dumps(plain(cell))})") from None


def _connect(workers: int, address: str) -> Any:
    """Return a client of a Dask scheduler, or of a cluster of its own for ``"local"``."""
    try:
        from distributed import Client
    except ImportError as error:
        raise InvalidInputError("dask", "is not installed: pip install iiwa-dnn[dask]") from error
    options: dict[str, Any] = {"address": address}
    if address == "local":
        options = {"n_workers": workers, "threads_per_worker": 1}
        options |= {"dashboard_address": None, "env": _ONE_THREAD}
    try:
        return Client(timeout=_PATIENCE, **options)
    except (OSError, ValueError) as error:
        problem = f"no scheduler at {address!r} ({one_line(error)})"
        raise InvalidInputError("dask", problem) from error
