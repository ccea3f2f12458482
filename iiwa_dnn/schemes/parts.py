"""Parts of a program: costs, tasks and limits, each a block of rows.

A part names the compiled function that writes its rows, its `kernel`, and gives the constants which
that function reads; or it overrides one method, written with numpy. All kernels of a kind have one
signature:

    cost   kernel(step, constants, P, q)                adds to P (n, n) and q (n,)
    task   kernel(step, constants, target, A, b)        writes A (rows, n) and b (rows,)
    limit  kernel(step, constants, G, h, lb, ub)        writes G (rows, n) and h (rows,), and
                                                        tightens lb (n,) and ub (n,)

`step` is a `StepViews`, `target` (18,) the `Target.data` of the frame that the task tracks. The
rows come in as zeros, h as zeros, and n counts the joints and then the scheme's slack variables.
"""

from dataclasses import fields
from typing import Any, ClassVar, Literal, TypeVar

import numpy as np
from numba import types

from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.compiling import Signature
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.schemes.step import Step, StepViews

PartT = TypeVar("PartT", bound="Part")

Tracking = Literal["paper", "next"]
TRACKINGS: tuple[Tracking, ...] = ("paper", "next")

V = types.float64[::1]
M = types.float64[:, ::1]
STEP_TYPE = types.NamedTuple((types.float64, types.float64, V, V, V, M, M, M, M, M), StepViews)

COST = Signature(types.void, STEP_TYPE, V, M, V)
TASK = Signature(types.void, STEP_TYPE, V, V, M, V)
LIMIT = Signature(types.void, STEP_TYPE, V, M, V, V, V)


class Part:
    """A block of a program's rows; a cost, a task or a limit.

    A part that is made with a wrong parameter raises an `InvalidInputError` that names it.

    Attributes:
        kernel: Compiled function that writes the rows; None for a part written with numpy.
        rows: Number of rows; none for a cost.
    """

    kernel: Any = None
    rows: int = 0
    _plain: ClassVar[tuple[str, ...]] = ()  # methods that the kernel stands in for

    @property
    def is_compiled(self) -> bool:
        """Test whether the kernel writes the rows; a subclass's own numpy method goes first."""
        inherited = (_owner(type(self), name) in _KINDS for name in self._plain)
        return self.kernel is not None and all(inherited)

    def constants(self, robot: Robot) -> Vector:
        """Return the numbers that the kernel reads, (k,).

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
        """Return the names of further frames whose placements the kernel reads."""
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

    def _kernel_or_raise(self, method: str) -> Any:
        if self.kernel is None:
            raise TypeError(f"{type(self).__name__} has no kernel and does not override {method}")
        return self.kernel


class Cost(Part):
    """A term of the cost, 1/2 x^T P x + q^T x."""

    _plain = ("quadratic",)

    def quadratic(self, step: Step) -> tuple[Matrix, Vector]:
        """Return P (n, n), symmetric positive semidefinite, and q (n,), to be added to the cost.

        n counts the scheme's variables, the joints and then its slack variables, or the joints
        alone: slack variables may be left out of any part.
        """
        kernel = self._kernel_or_raise("quadratic")
        robot = step.robot
        P = np.zeros((robot.dof, robot.dof))
        q = np.zeros(robot.dof)
        kernel(step.views(self.frame_name(robot)), self.constants(robot), P, q)
        return P, q


class Task(Part):
    r"""Equality rows A x = b, or with a `weight` w the cost :math:`\tfrac12 w\,\|A x - b\|^2`.

    Attributes:
        tracks: Whether the task asks for a target of its frame.
        row_weight: Weight of a missing unit of its rows beside a missing 1 m/s where a policy lets
            the task yield (`iiwa_dnn.control.policies`); 0: they are a limit and hold.
        weight: None for hard rows, else the weight of the soft task.
        tracking: ``"paper"``: the target of a step is that of its time, with the exact twist there.
            ``"next"``: its twist is the mean one over the coming period, so that b of a frame's
            rows may ask for the next target (`iiwa_dnn.schemes.tasks`).
    """

    _plain = ("equations",)
    tracks: bool = True
    row_weight: float = 1.0
    weight: float | None = None
    tracking: Tracking = "paper"

    def equations(self, step: Step) -> tuple[Matrix, Vector]:
        """Return A (rows, n) and b (rows,)."""
        kernel = self._kernel_or_raise("equations")
        robot = step.robot
        A = np.zeros((self.row_count(robot), robot.dof))
        b = np.zeros(len(A))
        views = step.views(self.frame_name(robot))
        kernel(views, self.constants(robot), views.targets[0], A, b)
        return A, b


class Limit(Part):
    """Bounds lb <= x <= ub, inequality rows G x <= h, or both.

    The number of inequality rows, `rows`, is the same at every step: an idle row has h = inf.

    Attributes:
        moves: Whether constants of the kernel change along a run, by `move`.
        elastic: Whether a row that asks for more than all joints together can give is followed as
            far as they can; otherwise the arm stops.
    """

    _plain = ("inequalities", "bounds")
    moves: bool = False
    elastic: bool = False

    def move(self, robot: Robot, constants: Vector, t: float) -> None:
        """Bring the constants of the kernel, (k,), to a time [s]."""

    def row_names(self, robot: Robot) -> list[str]:
        """Return names of the inequality rows, in words; none where their numbers will do."""
        return []

    def inequalities(self, step: Step) -> tuple[Matrix, Vector]:
        """Return G (rows, n) and h (rows,); asked where `rows` is above 0."""
        self._kernel_or_raise("inequalities")
        G, h, _, _ = self._evaluated(step)
        return G, h

    def bounds(self, step: Step) -> tuple[Vector, Vector] | None:
        """Return lb (n,) and ub (n,), or None; the bounds of all limits are intersected."""
        if self.kernel is None:
            return None
        _, _, lb, ub = self._evaluated(step)
        return lb, ub

    def _evaluated(self, step: Step) -> tuple[Matrix, Vector, Vector, Vector]:
        robot = step.robot
        constants = self.constants(robot).copy()
        self.move(robot, constants, step.t)
        G = np.zeros((self.row_count(robot), robot.dof))
        h = np.zeros(len(G))
        lb = np.full(robot.dof, -np.inf)
        ub = np.full(robot.dof, np.inf)
        self.kernel(step.views(self.frame_name(robot)), constants, G, h, lb, ub)
        return G, h, lb, ub


_KINDS = (Cost, Task, Limit)


def _owner(cls: type, name: str) -> type:
    """Return the class that defines a method."""
    return next(base for base in cls.__mro__ if name in vars(base))
