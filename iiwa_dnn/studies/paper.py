"""The paper's parameters and the numbers of its tables.

Source: "Enhanced Orientation Tracking for Redundant Manipulators via DNN-Based Double Control",
section V. Lengths are in [m], angles in [rad]; its Table II calls the mean squared error's unit
"meters", which can only be [m^2].
"""

from collections.abc import Mapping
from typing import Any

from iiwa_dnn.robot.arms import ARMS

START = ARMS["iiwa7"].start
"""theta(0) [rad]."""

JOINT_LIMIT = 2.5
"""Position limit on every joint [rad]: of the experiment, not of the robot."""

DT = 1e-4
"""Control period [s], the paper's trajectory planning interval."""

NOISE = 0.01
"""The white noise's amplitude, read as the standard deviation; the paper gives no unit."""

WINDOW = 10
"""Samples in the moving average."""

WEIGHT = 0.2
"""xi of Table II and Fig. 2. Section V-A names 0.3 instead, which no result belongs to."""

WEIGHTS = (0.1, 0.2, 0.4, 0.5, 0.6, 0.8, 0.9)
"""xi of the columns of Table I."""

TABLE1: dict[str, tuple[float | None, ...]] = {
    "max_position_error_m": (7.25e-5, 5.59e-5, 6.50e-5, 4.06e-5, 7.88e-5, 4.24e-5, 1.75e-5),
    "joint_drift_rad": (None, 1.74e-2, 3.88e-2, None, 8.71e-2, None, None),
    "max_kinetic_index_times_dt": (4.54e-6,) * 7,
}
"""Rows of Table I by the names of our numbers: MAX E [m], MAX |theta(T) - theta(0)| [rad], of which
four cells of the printed table cannot be read, and MAX of the squared joint velocity, see
docs/errata.md on its size."""

CASES = ("no noise, no filter", "no noise, filter", "noise, no filter", "noise, filter")
"""The rows of Table II, and the panels (a), (c), (b), (d) of Fig. 2."""

TABLE2 = {
    "max_position_error_m": (6.70e-5, 6.47e-5, 7.07e-5, 6.87e-5),
    "mse_position_error_m2": (2.00e-10, 1.97e-10, 3.28e-10, 2.49e-10),
}
"""Columns of Table II by the names of our numbers: MAX E [m] and MSE [m^2], both of `CASES`."""


def published(settings: Mapping[str, Any]) -> dict[str, float]:
    """Return the paper's numbers for a run of these settings, by the names of `TABLE1`.

    If the run does not draw the paper's heart with one of the paper's weights, or has noise or
    physics, there are none.
    """
    heart = {"name": "heart", "scale": 3.45e-3, "period": 10.0}
    weight = settings["scheme"].get("weight")
    if settings["robot"] != "iiwa7" or settings["reference"] != heart or weight not in WEIGHTS:
        return {}
    if settings.get("motion") == "physics" or settings.get("noise"):
        return {}
    column = WEIGHTS.index(weight)
    printed = {name: row[column] for name, row in TABLE1.items()}
    return {name: number for name, number in printed.items() if number is not None}
