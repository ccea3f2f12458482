"""Compare the steps of an arm with those that its tables recorded: ``python -m armstep check``."""

import copy
import json
import pickle
import sys
from pathlib import Path
from typing import Any

import numpy as np

from armstep.controller import Controller, Controllers
from armstep.errors import ArmstepError, TablesError
from armstep.shield import Shield, Shields
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
    kinds: Any = (Shield, Shields) if tables.kind == "shield" else (Controller, Controllers)
    arms = kinds[0](tables), kinds[1](tables, BATCH)
    differing = 0
    try:
        vectors = json.loads(Path(path).read_text(encoding="utf-8"))["vectors"]
        for k, step in enumerate(vectors["steps"]):
            differing += not _is_same(arms, step, vectors["tolerance"])
            if k % 50 == 25:
                arms = pickle.loads(pickle.dumps(copy.deepcopy(arms)))
    except (LookupError, TypeError, ValueError) as error:
        raise TablesError(f"{path}: holds no recorded steps: {error!r}") from None
    count = len(vectors["steps"])
    print(f"{tables.name}, {tables.digest}: {count} steps, {differing} differ from iiwa_dnn's")
    return differing


def _is_same(arms: Any, step: dict[str, Any], tolerance: float) -> bool:
    """Take a recorded step of one arm and of a batch; return whether all are as recorded."""
    given = {name: np.array(value, np.float64) for name, value in step["given"].items()}
    tiled = {k: np.tile(each, (BATCH, 1)) if each.ndim else each for k, each in given.items()}
    one, many = arms[0].step(**given), arms[1].step(**tiled)
    most = arms[0].tables.limits["velocity"]
    errors = np.abs([one.dq, *many.dq] - np.array(step["dq"])) / np.where(
        np.isfinite(most), most, 1.0
    )
    return bool(errors.max() <= tolerance) and {one.result, *many.reason} == {step["result"]}


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
