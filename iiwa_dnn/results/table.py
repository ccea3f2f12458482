"""The samples of a record as a table for other programs."""

import os

import numpy as np

from iiwa_dnn.files import write_csv
from iiwa_dnn.results.record import Record


def save_csv(record: Record, path: str | os.PathLike[str]) -> None:
    """Write joints and tip over time as a CSV file with a header, all digits kept, atomically.

    The columns are ``t,q1,...,dq1,...,x,y,z,x_desired,y_desired,z_desired`` in [s], [rad],
    [rad/s] and [m]; the last sample has no velocity (``nan``).

    Raises:
        FileError: If the file cannot be written.
    """
    joints = [f"{name}{i + 1}" for name in ("q", "dq") for i in range(record.dof)]
    head = ["t", *joints, *"xyz", *(f"{axis}_desired" for axis in "xyz")]
    dq = np.vstack([record.dq, np.full(record.dof, np.nan)])
    table = np.column_stack([record.t, record.q, dq, record.position, record.position_desired])
    write_csv(path, head, table)
