"""Parts of a program: costs, tasks and limits, each a block of rows.

A part of one's own overrides one method, written with numpy. The package's own parts name a
compiled form instead (`Part.kind`, `Part.numbers`), which stands beside the equation in `costs`,
`tasks` and `limits` and is chosen by its number in `iiwa_dnn.schemes.assembly`.
"""

from collections.abc import Mapping
from dataclasses import fields
from typing import Any, Literal, TypeVar

import numpy as np
from numpy.typing import NDArray
from pinocchio import rnea

from iiwa_dnn.checks import read_only
from iiwa_dnn.errors import NotFoundError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.references import Target
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.robot.configuration import FrameState
from iiwa_dnn.robot.kinematics import Kinematics

PartT = TypeVar("PartT", bound="Part")

Tracking = Literal["paper", "next"]
TRACKINGS: tuple[Tracking, ...] = ("paper", "next")

CUSTOM = 0
"""The kind of a part without a compiled form."""

TARGET_SIZE = 18
"""Numbers of a target, `Target.data`."""


class Step:
    """One instant of a control loop, as a part of one's own is asked with it.

    Attributes:
        robot: The robot, n joints.
        t: Time [s].
        dt: Control period [s]; inf where a program is built outside of a loop.
        q: Joint positions [rad], (n,).
        dq: Last command [rad/s], (n,); zeros at the first step.
    """

    __slots__ = ("_kinematics", "_targets", "dq", "dt", "q", "robot", "t")

    def __init__(
        self,
        kinematics: Kinematics,
        targets: Mapping[str, Vector],
        t: float,
        dt: float,
        q: Vector,
        dq: Vector,
    ) -> None:
        self._kinematics, self._targets = kinematics, targets
        self.robot, self.t, self.dt, self.q, self.dq = kinematics.robot, t, dt, q, dq

    def frame(self, name: str | None = None) -> FrameState:
        """Return pose and Jacobian of a frame of the robot; None stands for the tip.

        Raises:
            NotFoundError: The robot has no frame of that name.
        """
        return FrameState(*self._kinematics.frame(self.robot.tip if name is None else name))

    def target(self, name: str | None = None) -> Target:
        """Return the target of a frame that some task tracks; None stands for the tip.

        Raises:
            NotFoundError: No task tracks a frame of that name.
        """
        frame = self.robot.tip if name is None else name
        if frame not in self._targets:
            raise NotFoundError("target of frame", frame, self._targets)
        return Target.from_data(self._targets[frame])

    @property
    def inertia(self) -> Matrix:
        """Joint-space inertia matrix [kg m^2], (n, n)."""
        return read_only(np.array(Configuration(self.robot, self.q).inertia))

    @property
    def bias(self) -> Vector:
        """Joint torques of gravity, Coriolis and centrifugal forces [N m], (n,)."""
        model, data, *_ = self._kinematics.pinocchio
        return np.array(rnea(model, data, self.q, self.dq, np.zeros(self.q.size)))


class Part:
    """A block of a program's rows; a cost, a task or a limit.

    A part that is made with a wrong parameter raises an `InvalidInputError` that names it.

    Attributes:
        kind: Number of the compiled form; ``CUSTOM`` for a part written with numpy.
        rows: Number of rows; none for a cost.
    """

    kind: int = CUSTOM
    rows: int = 0

    def numbers(self, robot: Robot) -> Vector:
        """Return the constants that the compiled form takes, (k,).

        Raises:
            InvalidInputError: A parameter does not fit the robot.
        """
        return np.zeros(0)

    def frame_name(self, robot: Robot) -> str:
        """Return the name of the frame that the part is about, the tip's by default."""
        name = getattr(self, "frame", None)
        return robot.tip if name is None else str(name)

    def row_count(self, robot: Robot) -> int:
        """Return the number of rows for a robot; `rows`, unless a part says otherwise."""
        return self.rows

    def extra_frames(self, robot: Robot) -> tuple[str, ...]:
        """Return the names of further frames whose placements the compiled form needs."""
        return ()

    def anchored(self: PartT, conf: Configuration) -> PartT:
        """Return the part with `conf` as the posture to come back to, where it lacks one."""
        return self

    def _set(self, **values: Any) -> None:
        """Set checked parameters of a frozen dataclass."""
        for name, value in values.items():
            object.__setattr__(self, name, value)

    def settings(self) -> dict[str, Any]:
        """Return name and parameters, as values that JSON can hold."""
        parts = fields(self) if "__dataclass_fields__" in dir(self) else ()  # type: ignore[arg-type]
        names = [field.name for field in parts if field.init]
        return {"name": type(self).__name__} | {name: getattr(self, name) for name in names}


class Cost(Part):
    """A term of the cost, 1/2 x^T P x + q^T x."""

    def quadratic(self, step: Step) -> tuple[Matrix, Vector]:
        """Return P (n, n), symmetric positive semidefinite, and q (n,), to be added to the cost.

        n counts the scheme's variables, the joints and then its slack variables, or the joints
        alone: slack variables may be left out of any part.
        """
        raise TypeError(f"{type(self).__name__} overrides neither quadratic nor kind")


class Task(Part):
    r"""Equality rows A x = b, or with a `weight` w the cost :math:`\tfrac12 w\,\|A x - b\|^2`.

    Attributes:
        tracks: Whether the task asks for a target of its frame.
        row_weight: Weight of a missing unit of its rows beside a missing 1 m/s where a policy lets
            the task yield (`iiwa_dnn.control.policies`).
        weight: None for hard rows, else the weight of the soft task.
        priority: Level of a hard task in a cascade, 1 the first; None: it has to hold
            (`iiwa_dnn.control.cascade`).
        tracking: ``"paper"``: the target of a step is that of its time, with the exact twist there.
            ``"next"``: its twist is the mean one over the coming period, so that b of a frame's
            rows may ask for the next target (`iiwa_dnn.schemes.tasks`).
    """

    tracks: bool = True
    row_weight: float = 1.0
    weight: float | None = None
    priority: int | None = None
    tracking: Tracking = "paper"

    def equations(self, step: Step) -> tuple[Matrix, Vector]:
        """Return A (rows, n) and b (rows,)."""
        raise TypeError(f"{type(self).__name__} overrides neither equations nor kind")


class Limit(Part):
    """Bounds lb <= x <= ub, inequality rows G x <= h, or both.

    The number of inequality rows, `rows`, is the same at every step: an idle row has h = inf.

    Attributes:
        moves: Whether constants of the compiled form change along a run, by `move`.
    """

    moves: bool = False

    def move(self, robot: Robot, numbers: Vector, t: float) -> None:
        """Write what has moved until a time [s] into the constants of the compiled form, (k,)."""

    def row_names(self, robot: Robot) -> list[str]:
        """Return names of the inequality rows, in words; none where their numbers will do."""
        return []

    def inequalities(self, step: Step) -> tuple[Matrix, Vector]:
        """Return G (rows, n) and h (rows,); asked where `rows` is above 0."""
        raise TypeError(f"{type(self).__name__} has rows but does not override inequalities")

    def bounds(self, step: Step) -> tuple[Vector, Vector] | None:
        """Return lb (n,) and ub (n,), or None; the bounds of all limits are intersected."""
        return None


Codes = NDArray[np.int64]
