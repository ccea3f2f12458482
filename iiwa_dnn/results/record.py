"""The record of one run: its settings, its samples, and the judgement of each step."""

from __future__ import annotations

import json
import os
import tokenize
import warnings
import zipfile
import zlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Annotated, Any, get_origin, get_type_hints

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn import checks
from iiwa_dnn.errors import FileError, InvalidInputError
from iiwa_dnn.files import one_line, percent, plain, write_atomically
from iiwa_dnn.results.column import Column

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
CodeArray = NDArray[np.int8]

MODES = ("converged", "continuous")
LIMITS = ("q_lower", "q_upper", "dq_max")
RATES = ("ddq_max", "dddq_max")

# Errors of NumPy, zip and JSON on a missing or damaged file; InvalidInputError is a ValueError.
_UNREADABLE = (
    OSError,
    LookupError,
    ValueError,
    TypeError,
    EOFError,
    SyntaxError,
    MemoryError,
    RuntimeError,
    ArithmeticError,
    zipfile.BadZipFile,
    zlib.error,
    tokenize.TokenError,
)


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
            "lower one, 0 at an inactive one (`RowLayout.bound_multipliers`); the decrease of the "
            "objective per rad/s by which the bound is relaxed. None if no bound was ever active",
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
            "position limit, 2 for a velocity, 3 for an acceleration, 4 for a jerk limit, 0 where "
            "none is in the way",
            ("N", "n"),
            np.int8,
        ),
    ] = None
    bound_kind: Annotated[
        CodeArray | None,
        Column(
            "Kind of each active bound, as in `blocking`. None if there is no "
            "acceleration or jerk limit: a bound below the velocity limit is then of a position",
            ("N", "n"),
            np.int8,
        ),
    ] = None
    row_multiplier: Annotated[
        FloatArray | None,
        Column(
            'Multipliers z >= 0 of the m inequality rows that ``settings["rows"]`` names '
            '(``{"part": ..., "row": ...}``, row from 1), 0 of an inactive one. '
            "None if no row was ever active",
            ("N", "m"),
        ),
    ] = None
    blocking_rows: Annotated[
        CodeArray | None,
        Column(
            "1 where an inequality row was in the way of a solution, else 0", ("N", "m"), np.int8
        ),
    ] = None
    kind: Annotated[
        CodeArray | None,
        Column(
            "Program that each step answered: 0 its own, 1 the scaled one (A x = s b), 2 the "
            "softened one, 3 held back from it by acceleration, jerk or braking, 4 stopped",
            ("N",),
            np.int8,
        ),
    ] = None
    excess: Annotated[
        FloatArray | None,
        Column(
            "Largest excess of each command over the bounds of its own step, and, unless it is "
            "held back, over its inequality rows",
            ("N",),
        ),
    ] = None
    judge: Annotated[
        CodeArray | None,
        Column(
            "Solver that judged in the place of each reference: 0 itself, 1 the second one, -1 "
            "none",
            ("N", "k"),
            np.int8,
            fill=-1,
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
        object.__setattr__(self, "settings", _checked(self, sizes))
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
        return float(self.settings["dt"]) * float(self.filled("fraction").sum())

    @property
    def path_duration(self) -> float:
        """Time of the path once, or of the run if that is shorter, in whole steps [s]."""
        dt = float(self.settings["dt"])
        duration = self.settings.get("path_duration", self.settings["duration"])
        return dt * float(max(1, round(duration / dt)))

    @property
    def path_completed(self) -> float:
        """Fraction of `path_duration` that the reference's clock covered, 0 to 1."""
        fraction = self.path_time / self.path_duration
        return float(np.nan_to_num(np.clip(fraction, 0.0, 1.0)))

    def filled(self, name: str) -> NDArray[Any]:
        """Return the column of this name, or if the run lacks it one of its fill values."""
        array: NDArray[Any] | None = getattr(self, name)
        if array is not None:
            return array
        sizes = {"n": self.dof, "m": len(self.settings.get("rows") or ()), "l": 0, "f": 0}
        sizes["k"] = self.references
        return COLUMNS[name].allocate(self.steps, **sizes)

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
                stored = np.load(file, allow_pickle=False)
                if not isinstance(stored, np.lib.npyio.NpzFile):
                    raise ValueError("not an .npz archive")
                names = [name for name in COLUMNS if name in stored or name not in OPTIONAL]
                arrays: dict[str, Any] = {name: stored[name] for name in (*names, "crosscheck_gap")}
                settings = json.loads(str(stored["settings"]))
            gap = arrays.pop("crosscheck_gap")
            record = cls(settings=settings, **arrays)
            if not np.array_equal(gap, record.crosscheck_gap, equal_nan=True):
                raise ValueError("crosscheck_gap is not the largest solution_gap of each step")
        except _UNREADABLE as error:
            raise FileError(path, f"cannot be read as a record: {one_line(error)}") from error
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


def _checked(record: Record, sizes: Mapping[str, int]) -> dict[str, Any]:
    """Return the settings in JSON types after a check of all keys that the metrics need."""
    try:
        settings: dict[str, Any] = plain(record.settings)
        _check_limits(settings, LIMITS if record.torque is None else (*LIMITS, "torque_max"), sizes)
        _check_names(settings, sizes)
        _check_values(settings)
        _check_pairs(settings, record)
    except KeyError as error:
        raise InvalidInputError("settings", f"{error} is missing", record.settings) from error
    except (TypeError, OverflowError) as error:
        raise InvalidInputError("settings", str(error), record.settings) from error
    return settings


def _check_limits(
    settings: Mapping[str, Any], keys: Iterable[str], sizes: Mapping[str, int]
) -> None:
    """Check that each limit has a number or None for every joint."""
    for key in keys:
        values = settings[key]
        finite = [value for value in values if value is not None]
        if len(values) != sizes["n"] or not np.isfinite(np.array(finite)).all():
            problem = f"must hold {sizes['n']} limits"
            raise InvalidInputError(f"settings[{key!r}]", problem, values)


def _check_names(settings: Mapping[str, Any], sizes: Mapping[str, int]) -> None:
    """Check that the columns of the arrays have as many names of solvers and rows."""
    solvers = settings["check"]["solvers"]
    if len(solvers) != sizes["k"] or not all(isinstance(name, str) for name in solvers):
        problem = f"must name {sizes['k']} solvers, one for each column of solution_gap"
        raise InvalidInputError("settings['check']['solvers']", problem, solvers)
    rows = settings.get("rows") or []
    named = all(isinstance(row["part"], str) and row["row"] >= 1 for row in rows)
    if not named or len(rows) != sizes.get("m", len(rows)):
        problem = f'must name {sizes.get("m", "the")} rows as {{"part": text, "row": from 1}}'
        raise InvalidInputError("settings['rows']", problem, rows)


def _check_values(settings: Mapping[str, Any]) -> None:
    """Check mode, texts, times and tolerances."""
    checks.one_of("settings['mode']", settings["mode"], MODES)
    for key in ("robot", "status"):
        if not isinstance(settings[key], str):
            raise InvalidInputError(f"settings[{key!r}]", "must be a text", settings[key])
    for key in ("dt", "duration"):
        checks.positive(f"settings[{key!r}]", settings[key])
    checks.not_negative("settings['tol']", settings["tol"])
    for key in ("tolerance", "reference_tolerance"):
        checks.not_negative(f"settings['check'][{key!r}]", settings["check"][key])
    checks.finite("settings: duration / dt", settings["duration"] / settings["dt"])


def _check_pairs(settings: Mapping[str, Any], record: Record) -> None:
    """Check that every index of a nearest pair has a name, and that the distance is stated."""
    if (record.distance is None) != (record.nearest is None):
        raise InvalidInputError("distance", "and nearest come together", record.distance)
    if record.nearest is None:
        return
    collisions = settings["collisions"]
    checks.finite("settings['collisions']['distance']", collisions["distance"])
    if not 0 <= record.nearest.min() <= record.nearest.max() < len(collisions["pairs"]):
        problem = "must name the pairs that the array nearest counts"
        raise InvalidInputError("settings['collisions']['pairs']", problem, collisions["pairs"])
