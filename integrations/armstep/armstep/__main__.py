"""Compare the steps of an arm with those that its tables recorded: ``python -m armstep check``."""

import copy
import json
import pickle
import sys
from pathlib import Path
from typing import Any

import numpy as np

from armstep.arms import TWIST
from armstep.controller import Controller, Controllers
from armstep.errors import ArmstepError, TablesError
from armstep.shield import KINDS, Shield, Shields
from armstep.tables import load_tables

BATCH = 3
"""Arms of the batch beside one arm."""


def check(path: str, own: str | None = None) -> int:
    """Run the recorded steps of a file of tables: of one arm, of three in one call, of copies.

    Returns:
        Number of steps whose command or result is another one.

    Raises:
        TablesError: The file cannot be read, or holds no recorded steps.
    """
    tables = load_tables(path, own)
    try:
        vectors = json.loads(Path(path).read_text(encoding="utf-8"))["vectors"]
        rows = np.array([[*map(float, row)] for row in vectors["rows"]])
        tolerance = float(vectors["tolerance"])
    except (LookupError, TypeError, ValueError):
        raise TablesError(f"{path}: holds no recorded steps") from None
    kinds: Any = (Shield, Shields) if tables.kind == "shield" else (Controller, Controllers)
    arms = kinds[0](tables), kinds[1](tables, BATCH)
    differing = 0
    for k, row in enumerate(rows):
        differing += not _is_same(arms, row, tolerance)
        if k % 50 == 25:
            arms = pickle.loads(pickle.dumps(copy.deepcopy(arms)))
    print(f"{tables.name}, {tables.digest}: {len(rows)} steps, {differing} differ from iiwa_dnn's")
    return differing


def _is_same(arms: Any, row: Any, tolerance: float) -> bool:
    """Take a recorded step of one arm and of a batch; return whether all are as recorded."""
    tables = arms[0].tables
    n = len(tables.joint_names)
    most = np.where(np.isfinite(tables.limits["velocity"]), tables.limits["velocity"], 1.0)
    q, (kind, period), asked, expected = np.split(row[1:-1], [n, n + 2, len(row) - 2 - n])
    given: dict[str, Any] = {"q": q, "target": asked}
    times = {"t": row[0]}
    if tables.kind == "shield":
        request = {KINDS[int(kind) - 1]: asked[: TWIST if kind == 2 else n]} if kind else {}
        given = {"q": q, **request}
        times = {"dt": period or None}
    tiled = {name: np.tile(value, (BATCH, 1)) for name, value in given.items()}
    one, many = arms[0].step(**given, **times), arms[1].step(**tiled, **times)
    errors = np.abs(np.array([one.dq, *many.dq]) - expected) / most
    return bool(errors.max() <= tolerance) and {one.result, *many.reason} == {row[-1]}


def main(words: list[str]) -> int:
    """Check the tables that the command line names."""
    try:
        if len(words) not in (2, 3) or words[0] != "check":
            raise ArmstepError("usage: python -m armstep check TABLES [OWN]")
        return int(check(*words[1:]) > 0)
    except ArmstepError as error:
        print(error, file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
