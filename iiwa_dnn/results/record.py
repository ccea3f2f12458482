"""The record of one run: its settings, its samples, and the judgement of each step."""

from __future__ import annotations

import json
import math
import os
import sys
import tokenize
import warnings
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Annotated, Any, get_origin, get_type_hints

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.errors import FileError, InvalidInputError
from iiwa_dnn.files import one_line, percent, plain, write_atomically
from iiwa_dnn.results.column import Column

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
CodeArray = NDArray[np.int8]

MODES = ("converged", "continuous")
LIMITS, RATES = ("q_lower", "q_upper", "dq_max"), ("ddq_max", "dddq_max")

# Errors of NumPy, zip and JSON on a damaged file; InvalidInputError is a ValueError.
_DAMAGE = (
    ValueError, TypeError, EOFError, SyntaxError, MemoryError, zipfile.BadZipFile, zlib.error,
    NotImplementedError, RuntimeError, OverflowError, tokenize.TokenError,
)  # fmt: skip


@dataclass(frozen=True, eq=False, repr=False)
class Record:
    """One run of N steps of a robot with n joints, judged by k reference solvers (k may be 0).

    The arrays are copied and read-only. Sample i is the state at ``t[i]``; step i leads from
    sample i to sample i + 1. There are m inequality rows, l priority levels and f tracked frames
    beside the first. In the gaps and in ``reference_residual`` NaN means that the reference was not
    asked at that step and inf that it gave no answer. Optional arrays, from ``ddq`` on, are None in
    a run without them; files of older versions lack some and are read all the same.

    Attributes:
        settings: Everything the run was asked for, in JSON types; an infinite limit reads None.
        wall_time_s: Wall time of the run [s]. Not saved: the same seed gives the same file.
        crosscheck_gap: Largest `solution_gap` over the references [rad/s], (N,); NaN where none
            was asked.
    """

    t: Annotated[FloatArray, Column("Time [s], increasing", ("N+1",))]
    q: Annotated[FloatArray, Column("Joint positions [rad]", ("N+1", "n"))]
    dq: Annotated[FloatArray, Column("Joint velocities that moved the robot [rad/s]", ("N", "n"))]
    dq_solver: Annotated[
        FloatArray, Column("Joint velocities that the network answered [rad/s]", ("N", "n"))
    ]
    position: Annotated[FloatArray, Column("Tip position [m]", ("N+1", 3))]
    rotation: Annotated[
        FloatArray, Column("Tip orientation, tip axes to world axes", ("N+1", 3, 3))
    ]
    position_desired: Annotated[FloatArray, Column("Desired tip position [m]", ("N+1", 3))]
    rotation_desired: Annotated[FloatArray, Column("Desired tip orientation", ("N+1", 3, 3))]
    kinetic_index: Annotated[
        FloatArray, Column("dqᵀ G(q) dq: [rad²/s²] with G = I, [J] with inertia", ("N",))
    ]
    kkt_residual: Annotated[
        FloatArray, Column("Largest KKT residual of the network's answer", ("N",))
    ]
    iterations: Annotated[
        IntArray, Column("Network iterations (sub-steps) spent on each step", ("N",), np.int64)
    ]
    solution_gap: Annotated[
        FloatArray,
        Column("Largest joint velocity difference to each reference [rad/s]", ("N", "k")),
    ]
    objective_gap: Annotated[
        FloatArray, Column("Difference in the objective to each reference", ("N", "k"))
    ]
    reference_residual: Annotated[
        FloatArray, Column("Largest KKT residual of each reference's own answer", ("N", "k"))
    ]
    settings: dict[str, Any]
    ddq: Annotated[
        FloatArray | None,
        Column(
            "Joint accelerations that the network answered [rad/s^2], of a scheme of the "
            "acceleration level; `dq` is then the mean velocity of each step, and `dq_solver` the "
            "velocity after it",
            ("N", "n"),
        ),
    ] = None
    torque: Annotated[
        FloatArray | None,
        Column("Joint torques of a run in physics [N m], the largest of each step", ("N", "n")),
    ] = None
    bound_multiplier: Annotated[
        FloatArray | None,
        Column(
            "Multipliers of the joint velocity bounds: positive at an upper one, negative at a "
            "lower one, 0 at an inactive one; the decrease of the objective per rad/s by which the "
            "bound is relaxed. None if no bound was ever active",
            ("N", "n"),
        ),
    ] = None
    clipped: Annotated[
        CodeArray | None,
        Column(
            "1 where a joint's command was clipped to its bounds on leaving the controller, else 0",
            ("N", "n"),
            np.int8,
        ),
    ] = None
    action: Annotated[
        CodeArray | None,
        Column(
            "Action of the policy at each step: codes of "
            "`iiwa_dnn.control.policies.Action`, 0 where the network's answer was taken",
            ("N",),
            np.int8,
        ),
    ] = None
    fraction: Annotated[
        FloatArray | None,
        Column(
            "Fraction of a control period by which the reference's clock advanced", ("N",), fill=1.0
        ),
    ] = None
    blocking: Annotated[
        CodeArray | None,
        Column(
            "Bounds in the way of a solution: positive upper ones, negative lower ones; 1 for a "
            "position limit, 2 for a velocity limit, 0 where none is in the way",
            ("N", "n"),
            np.int8,
        ),
    ] = None
    row_multiplier: Annotated[
        FloatArray | None,
        Column(
            'Multipliers z >= 0 of the m inequality rows that ``settings["rows"]`` names '
            '(``{"part": ..., "row": ...}``, row from 1). None if no row was ever active',
            ("N", "m"),
        ),
    ] = None
    blocking_rows: Annotated[
        CodeArray | None,
        Column(
            "1 where an inequality row was in the way of a solution, else 0", ("N", "m"), np.int8
        ),
    ] = None
    level_residual: Annotated[
        FloatArray | None,
        Column("Largest residual of the task rows of each priority level", ("N", "l")),
    ] = None
    frame_position: Annotated[
        FloatArray | None,
        Column('Positions of the tracked frames ``settings["frames"]`` [m]', ("N+1", "f", 3)),
    ] = None
    frame_rotation: Annotated[
        FloatArray | None, Column("Orientations of these frames", ("N+1", "f", 3, 3))
    ] = None
    frame_position_desired: Annotated[
        FloatArray | None, Column("Desired positions of these frames [m]", ("N+1", "f", 3))
    ] = None
    frame_rotation_desired: Annotated[
        FloatArray | None, Column("Desired orientations of these frames", ("N+1", "f", 3, 3))
    ] = None
    distance: Annotated[
        FloatArray | None, Column("Distance of the nearest pair of bodies [m]", ("N+1",))
    ] = None
    nearest: Annotated[
        IntArray | None,
        Column('Index of that pair in ``settings["collisions"]["pairs"]``', ("N+1",), np.int64),
    ] = None
    wall_time_s: float | None = None
    crosscheck_gap: FloatArray = field(init=False)

    def __post_init__(self) -> None:
        samples = np.size(self.t)
        sizes = {"N": samples - 1, "N+1": samples}
        for name, column in self._columns.items():
            object.__setattr__(self, name, column.check(name, getattr(self, name), sizes))
        if not (np.isfinite(self.t).all() and (np.diff(self.t) > 0).all()):
            raise InvalidInputError("t", "must hold increasing times, one at least", self.t)
        limits = LIMITS if self.torque is None else (*LIMITS, "torque_max")
        object.__setattr__(self, "settings", _checked(self.settings, limits, sizes))
        if (self.distance is None) != (self.nearest is None):
            raise InvalidInputError("distance", "and nearest come together", self.distance)
        if self.nearest is not None:
            _check_pairs(self.settings, self.nearest)
        # One solver's NaN does not hide another's answer.
        gap = np.fmax.reduce(self.solution_gap, axis=1, initial=np.nan)
        gap.flags.writeable = False
        object.__setattr__(self, "crosscheck_gap", gap)

    def __repr__(self) -> str:
        error = np.linalg.norm(self.position - self.position_desired, axis=1).max()
        slowed = f"path completed {percent(self.path_completed)}, "
        text = (
            f"Record({self.settings['robot']}, {self.steps:,} steps of {self.settings['dt']:g} s, "
            f"{self.settings['status']}, {slowed if self.path_completed < 1.0 else ''}"
            f"position error max {error:.4g} m)"
        )
        return " ".join(text.split())

    @property
    def steps(self) -> int:
        """N, the number of steps taken."""
        return len(self.t) - 1

    @property
    def dof(self) -> int:
        """n, the number of joints."""
        return int(self.q.shape[1])

    @property
    def references(self) -> int:
        """k, the number of reference solvers; their names are in the settings."""
        return int(self.solution_gap.shape[1])

    @property
    def path_time(self) -> float:
        """Time of the path that the reference's clock covered [s]."""
        steps = self.steps if self.fraction is None else self.fraction.sum()
        return float(self.settings["dt"]) * float(steps)

    @property
    def path_completed(self) -> float:
        """Share of the asked path time that the reference's clock covered, 0 to 1."""
        dt, duration = float(self.settings["dt"]), self.settings["duration"]
        share = self.path_time / (dt * max(1, round(duration / dt)))
        return float(np.nan_to_num(np.clip(share, 0.0, 1.0)))

    @property
    def _columns(self) -> dict[str, Column]:
        """The columns that this record has, by name."""
        return {name: c for name, c in COLUMNS.items() if getattr(self, name) is not None}

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the record as an uncompressed .npz file, atomically and without pickles.

        The same record gives the same bytes.

        Args:
            path: The file; ``.npz`` is not appended.

        Raises:
            FileError: If the file cannot be written.
        """
        arrays = {name: getattr(self, name) for name in (*self._columns, "crosscheck_gap")}
        text = np.array(json.dumps(self.settings, sort_keys=True, allow_nan=False))
        # NumPy leaves the time stamps in the archive at the zip format's own zero, 1980.
        write_atomically(path, lambda file: np.savez(file, settings=text, **arrays))

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Record:
        """Read a record written by `save`.

        Args:
            path: The file.

        Returns:
            The record; its `wall_time_s` is None, since the file does not hold it.

        Raises:
            FileError: If the file is missing, damaged or not a record.
        """
        try:
            with Path(path).open("rb") as file, warnings.catch_warnings():
                # NumPy warns of a slightly wrong head before it gives up.
                warnings.simplefilter("ignore", UserWarning)
                arrays = np.load(file, allow_pickle=False)
                if not isinstance(arrays, np.lib.npyio.NpzFile):
                    raise FileError(path, "not a record: not an .npz archive")
                needed = (name for name in COLUMNS if name in arrays or name not in OPTIONAL)
                stored: dict[str, Any] = {name: arrays[name] for name in needed}
                stored_gap, text = arrays["crosscheck_gap"], str(arrays["settings"])
            record = cls(settings=json.loads(text), **stored)
            same_gap = np.array_equal(stored_gap, record.crosscheck_gap, equal_nan=True)
        except FileError:
            raise
        except OSError as error:
            raise FileError(path, f"cannot be read ({one_line(error)})") from error
        except KeyError as error:
            raise FileError(path, f"not a record: {one_line(error)}") from error
        except _DAMAGE as error:
            raise FileError(path, f"not a record, or damaged: {one_line(error)}") from error
        if not same_gap:
            raise FileError(path, "crosscheck_gap is not the largest solution_gap of each step")
        return record


COLUMNS: dict[str, Column] = {
    name: hint.__metadata__[0]
    for name, hint in get_type_hints(Record, include_extras=True).items()
    if get_origin(hint) is Annotated
}
"""The arrays of a record by name: the one list that checks, files and documentation are made of."""

OPTIONAL = frozenset(item.name for item in fields(Record) if item.default is None)
"""Columns that a run may lack."""

Record.__doc__ = "\n        ".join(
    [(Record.__doc__ or "").rstrip(), *(f"{name}: {column}" for name, column in COLUMNS.items())]
)


def cut(arrays: Mapping[str, NDArray[Any]], steps: int) -> dict[str, NDArray[Any]]:
    """Protect columns and cut them to the steps that were taken: `Record` need not copy them then.

    Args:
        arrays: Columns by name, each as long as `Column.allocate` made it: (N, ...) or (N+1, ...).
        steps: Steps that were taken, at most N.
    """
    ended = {}
    for name, array in arrays.items():
        array.setflags(write=False)
        ended[name] = array[: steps + 1 if COLUMNS[name].per_sample else steps]
    return ended


def _checked(
    settings: Mapping[str, Any], limits: tuple[str, ...], sizes: Mapping[str, int]
) -> dict[str, Any]:
    """Return the settings in JSON types after a check of all keys that the metrics need."""
    if not isinstance(settings, Mapping):
        raise InvalidInputError("settings", "must be a dict", settings)
    try:
        checked: dict[str, Any] = plain(settings)
        _check_lists(checked, limits, sizes)
        check, times = checked["check"], (checked["dt"], checked["duration"])
        tolerances = (checked["tol"], check["tolerance"], check["reference_tolerance"])
        numbers = all(map(_is_number, (*times, *tolerances)))
        if not (numbers and min(times) > 0 and min(tolerances) >= 0):
            problem = "dt and duration must be positive, and no tolerance negative"
            raise InvalidInputError("settings", problem, (*times, *tolerances))
        if not math.isfinite(checked["duration"] / checked["dt"]):
            raise InvalidInputError("settings", "duration / dt is not finite", times)
        texts = all(isinstance(checked[key], str) for key in ("robot", "status"))
        if checked["mode"] not in MODES or not texts:
            problem = f"mode must be one of {MODES}, robot and status a text"
            raise InvalidInputError("settings", problem, checked["mode"])
    except KeyError as error:
        raise InvalidInputError("settings", f"{error} is missing", settings) from error
    except TypeError as error:
        raise InvalidInputError("settings", str(error), settings) from error
    return checked


def _check_lists(
    settings: Mapping[str, Any], limits: tuple[str, ...], sizes: Mapping[str, int]
) -> None:
    """Check that limits, solvers and rows are as many as the arrays have columns."""
    for key in limits:
        values, n = settings[key], sizes["n"]
        if len(values) != n or not all(value is None or _is_number(value) for value in values):
            raise InvalidInputError(f"settings[{key!r}]", f"must hold {n} limits", values)
    names, k = settings["check"]["solvers"], sizes["k"]
    if len(names) != k or not all(isinstance(name, str) for name in names):
        problem = f"must name {k} solvers, one for each column of solution_gap"
        raise InvalidInputError("settings['check']['solvers']", problem, settings["check"])
    rows = settings.get("rows") or []
    named = all(isinstance(row["part"], str) and row["row"] >= 1 for row in rows)
    if not named or len(rows) != sizes.get("m", len(rows)):
        problem = f'must name {sizes.get("m", "the")} rows as {{"part": text, "row": from 1}}'
        raise InvalidInputError("settings['rows']", problem, rows)


def _check_pairs(settings: Mapping[str, Any], nearest: IntArray) -> None:
    """Check that every index of a pair has a name, and the least distance is stated."""
    try:
        pairs, distance = settings["collisions"]["pairs"], settings["collisions"]["distance"]
        fits = nearest.min() >= 0 and nearest.max() < len(pairs) and _is_number(distance)
    except (KeyError, TypeError):
        fits = False
    if not fits:
        problem = "must state the distance, and the pairs that the array nearest counts"
        raise InvalidInputError("settings['collisions']", problem, settings.get("collisions"))


def _is_number(value: object) -> bool:
    """Tell whether a value out of JSON is a number within the range of a float."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return abs(value) <= sys.float_info.max
