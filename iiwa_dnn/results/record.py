"""The record of one run: its settings, its samples, and the judgement of each step."""

import json
import os
from dataclasses import MISSING, dataclass, fields
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn.checks import Array, read_only
from iiwa_dnn.errors import FileError, InvalidInputError
from iiwa_dnn.files import one_line, percent, plain, write_atomically

IntArray = NDArray[np.int64]
CodeArray = NDArray[np.int8]

RATES = {"acceleration": "ddq_max", "jerk": "dddq_max"}
"""Keys in a run's settings of the rate limits that its scheme mentions, by the limited quantity."""

OWN_LIMITS = {
    "lower position": "q_lower",
    "upper position": "q_upper",
    "velocity": "dq_max",
    **RATES,
}
"""Keys in a run's settings of its limits, by the limited quantity; with ``robot_`` before the key,
of those of the robot's URDF or data sheet."""


NEEDED = {"robot", "joints", "mode", "dt", "duration", "status", "tol", "check"}
"""Settings that metrics and reports read of each run."""


class Column(NamedTuple):
    """An array of a record.

    Attributes:
        meaning: Quantity of the entries, with its unit.
        shape: Length of each axis, a number or a symbol; the first is ``"N"`` for one entry a step
            or ``"N+1"`` for one entry a sample.
        dtype: Type of the entries.
        fill: Entry at a step for which nothing was recorded.
    """

    meaning: str
    shape: tuple[str | int, ...]
    dtype: type[Any] = np.float64
    fill: float = 0.0

    def allocate(self, steps: int, **sizes: int) -> NDArray[Any]:
        """Make the array of a run, full of `fill`; `sizes` are lengths of other axes: ``n=7``."""
        known = {"N": steps, "N+1": steps + 1, **sizes}
        lengths = [known.get(size, 0) if isinstance(size, str) else size for size in self.shape]
        # Zeros take no memory before something else is written.
        return np.full(lengths, self.fill) if self.fill else np.zeros(lengths, self.dtype)

    def check(self, name: str, value: ArrayLike, sizes: dict[str | int, int]) -> NDArray[Any]:
        """Return a read-only copy of an array of this column, its type and shape checked.

        Lengths of axes whose symbol is not yet in `sizes` are entered there.

        Raises:
            InvalidInputError: If the array has another type or shape.
        """
        array = np.array(value)
        if name in OPTIONAL and not array.size:
            return np.zeros((0, *(sizes.get(axis, 0) for axis in self.shape[1:])), self.dtype)
        lengths = (*array.shape, *[0] * len(self.shape))
        axes = zip(self.shape, lengths, strict=False)
        expected = tuple(sizes.setdefault(axis, length) for axis, length in axes)
        if array.shape != expected or not np.can_cast(array.dtype, self.dtype, "same_kind"):
            symbols = f"({', '.join(map(str, self.shape))}) = {expected}"
            problem = f"{array.dtype} of shape {array.shape}, expected numbers {symbols}"
            raise InvalidInputError(name, problem, value)
        return read_only(array.astype(self.dtype, order="C", copy=False))


ABSENT: Any = ()
"""Value of an absent column."""


@dataclass(frozen=True, eq=False, repr=False)
class Record:
    """One run of N steps of a robot with n joints, judged by k reference solvers (k may be 0).

    The arrays are copied and read-only. Sample i is the state at ``t[i]``; step i leads from
    sample i to sample i + 1. There are m inequality rows and f tracked frames beside the first. In
    the gaps and in ``reference_residual`` NaN means that the reference was not asked at that step
    and inf that it gave no answer. A column of which a run has nothing has the length zero;
    `filled` makes it as long as the run.

    Attributes:
        settings: Settings of the run, in JSON types; an infinite limit is None.
        wall_time_s: Wall time of the run [s]. Not saved: the same seed gives the same file.
    """

    t: Annotated[Array, Column("Time [s], increasing", ("N+1",))]
    q: Annotated[Array, Column("Joint positions [rad]", ("N+1", "n"))]
    dq: Annotated[Array, Column("Joint velocities that moved the robot [rad/s]", ("N", "n"))]
    dq_solver: Annotated[
        Array, Column("Joint velocities that the controller answered [rad/s]", ("N", "n"))
    ]
    position: Annotated[Array, Column("Tip position [m]", ("N+1", 3))]
    rotation: Annotated[Array, Column("Tip orientation, tip axes to world axes", ("N+1", 3, 3))]
    position_desired: Annotated[Array, Column("Desired tip position [m]", ("N+1", 3))]
    rotation_desired: Annotated[Array, Column("Desired tip orientation", ("N+1", 3, 3))]
    kinetic_index: Annotated[
        Array, Column("dqᵀ G(q) dq: [rad²/s²] with G = I, [J] with inertia", ("N",))
    ]
    kkt_residual: Annotated[Array, Column("Largest KKT residual of the network's answer", ("N",))]
    iterations: Annotated[
        IntArray, Column("Network iterations (sub-steps) spent on each step", ("N",), np.int64)
    ]
    solution_gap: Annotated[
        Array,
        Column(
            "Largest joint velocity difference to each reference [rad/s], where x is unique",
            ("N", "k"),
        ),
    ]
    objective_gap: Annotated[
        Array,
        Column("Difference in the objective to each reference, relative to its terms", ("N", "k")),
    ]
    feasibility_gap: Annotated[
        Array, Column("Largest violation of a bound or row, relative to its terms", ("N", "k"))
    ]
    reference_residual: Annotated[
        Array, Column("Largest KKT residual of each reference's own answer", ("N", "k"))
    ]
    settings: dict[str, Any]
    torque: Annotated[
        Array,
        Column("Joint torques of a run in physics [N m], the largest of each step", ("N", "n")),
    ] = ABSENT
    sent: Annotated[
        Array,
        Column("Commands to an arm that moves in another way than they say [rad/s]", ("N", "n")),
    ] = ABSENT
    bound_multiplier: Annotated[
        Array,
        Column(
            "Multipliers of the joint velocity bounds: positive at an upper one, negative at a "
            "lower one, 0 at an inactive one (`LogLayout.multipliers`); the decrease of the "
            "objective per rad/s by which the bound is relaxed",
            ("N", "n"),
        ),
    ] = ABSENT
    clipped: Annotated[
        CodeArray,
        Column(
            "1 where a joint's command was clipped to its bounds on leaving the controller, else 0",
            ("N", "n"),
            np.int8,
        ),
    ] = ABSENT
    action: Annotated[
        CodeArray,
        Column(
            "Action of the policy at each step: codes of "
            "`iiwa_dnn.step.policies.Action`, 0 where the network's answer was taken",
            ("N",),
            np.int8,
        ),
    ] = ABSENT
    fraction: Annotated[
        Array,
        Column(
            "Fraction of a control period by which the reference's clock advanced", ("N",), fill=1.0
        ),
    ] = ABSENT
    limiting: Annotated[
        CodeArray,
        Column(
            "Limits whose bounds limit the solution, positive for upper and negative for lower "
            "ones: 1 position, 2 velocity, 3 acceleration, 4 jerk, 5 position-dependent velocity, "
            '6 and above those of ``settings["bounding"]``; 0 if none is limiting',
            ("N", "n"),
            np.int8,
        ),
    ] = ABSENT
    bound_kind: Annotated[
        CodeArray,
        Column(
            "Limit of each active bound, as in `limiting`. Of length zero if none was noted: one "
            "below the velocity limit then counts as of a position",
            ("N", "n"),
            np.int8,
        ),
    ] = ABSENT
    row_multiplier: Annotated[
        Array,
        Column(
            'Multipliers z >= 0 of the m inequality rows that ``settings["rows"]`` names '
            '(``{"part": ..., "row": ...}``, row from 1), 0 of an inactive one',
            ("N", "m"),
        ),
    ] = ABSENT
    limiting_rows: Annotated[
        CodeArray,
        Column(
            "1 and its `row_pair` where an inequality row limited the solution, else 0",
            ("N", "m"),
            np.int16,
        ),
    ] = ABSENT
    row_pair: Annotated[
        CodeArray,
        Column(
            'Number from 1 among ``settings["pairs"]`` of the pair that an active inequality row '
            "belongs to, 0 for a row that always belongs to the same",
            ("N", "m"),
            np.int16,
        ),
    ] = ABSENT
    kind: Annotated[
        CodeArray,
        Column(
            "Program that each command answers: 0 the nominal one, 1 the scaled one (A x = s b), 2 "
            "the relaxed one, 3 the nominal one, rate-limited on the way to its answer, 4 stopped",
            ("N",),
            np.int8,
        ),
    ] = ABSENT
    excess: Annotated[
        Array,
        Column(
            "Largest excess of each command over the bounds of its own step, and, unless it is "
            "rate-limited, over its inequality rows",
            ("N",),
        ),
    ] = ABSENT
    judge: Annotated[
        CodeArray,
        Column(
            "Judge in the place of each reference: 0 itself, 1 the second solver, 2 a proof, -1 "
            "none",
            ("N", "k"),
            np.int8,
        ),
    ] = ABSENT
    frame_position: Annotated[
        Array,
        Column('Positions of the tracked frames ``settings["frames"]`` [m]', ("N+1", "f", 3)),
    ] = ABSENT
    frame_rotation: Annotated[Array, Column("Orientations of these frames", ("N+1", "f", 3, 3))] = (
        ABSENT
    )
    frame_position_desired: Annotated[
        Array, Column("Desired positions of these frames [m]", ("N+1", "f", 3))
    ] = ABSENT
    frame_rotation_desired: Annotated[
        Array, Column("Desired orientations of these frames", ("N+1", "f", 3, 3))
    ] = ABSENT
    distance: Annotated[Array, Column("Distance of the nearest pair of bodies [m]", ("N+1",))] = (
        ABSENT
    )
    nearest: Annotated[
        IntArray,
        Column('Index of that pair in ``settings["collisions"]["pairs"]``', ("N+1",), np.int64),
    ] = ABSENT
    demand: Annotated[
        Array,
        Column(
            "Torques that the velocities take by `TorqueLimits` [N m], the larger ones of the "
            "lightest and the heaviest payload",
            ("N", "n"),
        ),
    ] = ABSENT
    wall_time_s: float | None = None

    def __post_init__(self) -> None:
        samples = np.size(self.t)
        sizes: dict[str | int, int] = {"N": samples - 1, "N+1": samples, 3: 3}
        for name, column in COLUMNS.items():
            object.__setattr__(self, name, column.check(name, getattr(self, name), sizes))
        if not (samples and np.isfinite(self.t).all() and (np.diff(self.t) > 0).all()):
            raise InvalidInputError("t", "must hold increasing times, one at least", self.t)
        object.__setattr__(self, "settings", plain(self.settings))

    def __repr__(self) -> str:
        error = np.linalg.norm(self.position - self.position_desired, axis=1).max()
        return (
            f"Record({self.settings['robot']}, {self.steps:,} steps of {self.settings['dt']:g} s, "
            f"{self.settings['status']}, {percent(self.path_completed)} of the path asked for, "
            f"position error max {error:.4g} m)"
        )

    @property
    def steps(self) -> int:
        """N, the number of steps taken."""
        return len(self.t) - 1

    @property
    def dof(self) -> int:
        """n, the number of joints."""
        return int(self.q.shape[1])

    @property
    def crosscheck_gap(self) -> Array:
        """Largest `solution_gap` over the references [rad/s], (N,); NaN where none was asked."""
        # One solver's NaN does not hide another's answer.
        gap: Array = np.fmax.reduce(self.solution_gap, axis=1, initial=np.nan)
        return gap

    @property
    def path_time(self) -> float:
        """Time of the path that the reference's clock covered [s]."""
        return float(self.settings["dt"]) * float(self.filled("fraction").sum())

    @property
    def path_completed(self) -> float:
        """Fraction of the path's duration that the reference's clock covered, 0 to 1.

        If the run is shorter than the path, it is a fraction of the run's duration.
        """
        dt = self.settings["dt"]
        asked = self.settings["duration"]
        duration = min(asked, self.settings.get("path_duration") or asked)
        steps = max(1, round(duration / dt))
        return float(np.nan_to_num(np.clip(self.path_time / (dt * steps), 0.0, 1.0)))

    def filled(self, name: str) -> NDArray[Any]:
        """Return the column of this name, or fill values in place of one of length zero."""
        array: NDArray[Any] = getattr(self, name)
        rows = len(self.settings.get("rows") or ())
        sizes = {"n": self.dof, "k": self.solution_gap.shape[1], "m": rows}
        return array if len(array) else COLUMNS[name].allocate(self.steps, **sizes)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the record as an uncompressed .npz file, atomically and without pickles.

        The same record gives the same bytes. Copies are left out: ``dq_solver`` has the length zero
        if it is ``dq``, and ``rotation_desired`` the length one if the target does not turn.

        Args:
            path: The file; ``.npz`` is not appended.

        Raises:
            FileError: If the file cannot be written.
        """
        arrays = {name: getattr(self, name) for name in (*COLUMNS, "crosscheck_gap")}
        if np.array_equal(self.dq_solver, self.dq):
            arrays["dq_solver"] = self.dq_solver[:0]
        if (self.rotation_desired == self.rotation_desired[0]).all():
            arrays["rotation_desired"] = self.rotation_desired[:1]
        text = np.array(json.dumps(self.settings, sort_keys=True, allow_nan=False))
        # NumPy leaves the time stamps in the archive at the zip format's own zero, 1980.
        write_atomically(path, lambda file: np.savez(file, settings=text, **arrays))

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> "Record":
        """Read a record written by `save`.

        Args:
            path: The file.

        Returns:
            The record; its `wall_time_s` is None, since the file does not hold it.

        Raises:
            FileError: If the file is missing, damaged or not a record of this version.
        """
        try:
            # Not np.load, which takes any file that is no archive for a pickled object.
            with Path(path).open("rb") as file:
                stored = np.lib.npyio.NpzFile(file, allow_pickle=False)
                names = [name for name in COLUMNS if name not in NEW or name in stored]
                arrays: dict[str, Any] = {name: stored[name] for name in names}
                settings = json.loads(str(stored["settings"]))
            if not len(arrays["dq_solver"]):
                arrays["dq_solver"] = arrays["dq"]
            if len(arrays["rotation_desired"]) == 1:
                arrays["rotation_desired"] = arrays["rotation_desired"].repeat(len(arrays["t"]), 0)
            if missing := NEEDED - settings.keys():
                raise KeyError(f"settings without {', '.join(sorted(missing))}")
            return cls(settings=settings, **arrays)
        except Exception as error:  # whatever NumPy, zip and JSON meet in a damaged file
            raise FileError(path, f"cannot be read as a record: {one_line(error)}") from error


COLUMNS: dict[str, Column] = {
    item.name: item.type.__metadata__[0]
    for item in fields(Record)
    if hasattr(item.type, "__metadata__")
}
"""The arrays of a record by name: the one list that checks, files and documentation are made of."""

OPTIONAL = frozenset(
    item.name for item in fields(Record) if item.default is not MISSING and item.name in COLUMNS
)
"""Columns that may have the length zero."""

NEW = frozenset({"row_pair"})
"""Columns that files of the last version lack; they have the length zero then."""

Record.__doc__ = "\n        ".join(
    [
        (Record.__doc__ or "").rstrip(),
        *(
            f"{name}: {column.meaning}, ({', '.join(map(str, column.shape))})."
            for name, column in COLUMNS.items()
        ),
    ]
)
