"""The samples of a record as a table for other programs."""

import math
import os

import numpy as np

from iiwa_dnn.files import write_csv
from iiwa_dnn.results.record import COLUMNS, Record

_HEADS = {"position": list("xyz"), "position_desired": [f"{axis}_desired" for axis in "xyz"]}
"""Names of columns that are not the array's name and a number."""

_FIRST = ("t", "q", "dq", *_HEADS)
"""Arrays with which the table begins; the others follow in the record's order."""


def save_csv(record: Record, path: str | os.PathLike[str]) -> None:
    """Write all arrays over time as a CSV file with a header, all digits kept, atomically.

    A row is a sample. The columns are ``t,q1,...,dq1,...,x,y,z,x_desired,y_desired,z_desired`` in
    [s], [rad], [rad/s] and [m], then those of the record's further arrays, ``kkt_residual`` or, if
    there are several, ``torque1,torque2,...``, row by row. The last sample begins no step: its
    entries of arrays of one entry a step are ``nan``.

    Raises:
        FileError: If the file cannot be written.
    """
    head: list[str] = []
    parts = []
    for name in dict.fromkeys((*_FIRST, *COLUMNS)):
        array = getattr(record, name)
        if array is None:
            continue
        rows = np.full((record.steps + 1, math.prod(array.shape[1:])), np.nan)
        rows[: len(array)] = array.reshape(len(array), rows.shape[1])
        numbers = range(1, rows.shape[1] + 1)
        plain = [name] if array.ndim == 1 else [f"{name}{i}" for i in numbers]
        head += _HEADS.get(name, plain)
        parts.append(rows)
    write_csv(path, head, np.hstack(parts))
