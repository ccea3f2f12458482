"""The samples of a record as a table for other programs."""

import os

import numpy as np

from iiwa_dnn.files import write_csv
from iiwa_dnn.results.record import COLUMNS, Record


def save_csv(record: Record, path: str | os.PathLike[str]) -> None:
    """Write all arrays over time as a CSV file with a header, all digits kept, atomically.

    A row is a sample. The columns are the record's arrays, ``t,q1,q2,...``, row by row. The last
    sample begins no step: its entries of arrays of one entry a step are ``nan``.

    Raises:
        FileError: If the file cannot be written.
    """
    head: list[str] = []
    table = np.empty((record.steps + 1, 0))
    for name in COLUMNS:
        array = getattr(record, name)
        if not len(array):
            continue
        values = array.reshape(len(array), -1)
        rows = np.full((len(table), values.shape[1]), np.nan)
        rows[: len(values)] = values
        head += [f"{name}{i}" for i in range(1, len(rows[0]) + 1)] if array.ndim > 1 else [name]
        table = np.hstack([table, rows])
    write_csv(path, head, table)
