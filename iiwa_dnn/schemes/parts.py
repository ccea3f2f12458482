"""Parts of a program: costs, tasks and limits.

A part names its `kernel`, a compiled function that writes its rows of the program, and returns the
constants that the kernel reads. All kernels of a kind have one signature:

    cost   kernel(step, constants, P, q)                adds to P (n, n) and q (n,)
    task   kernel(step, constants, target, A, b)        writes A (rows, n) and b (rows,)
    limit  kernel(step, constants, G, h, lb, ub)        writes G (rows, n) and h (rows,), and
                                                        tightens lb (n,) and ub (n,)

A limit has a second kernel, `rest_kernel(step, constants, motion)`, unless it holds at a step only:
whether a `Motion` to rest, from the joint positions of the step, keeps it. A command is given if
all limits agree with its motion to rest, else the next one of the motion that they agreed with.

`step` is a `StepViews`, and `target` the `TargetData` of the frame that the task tracks. A, b, G
and h are zero before the call. The n variables are the joints, then the scheme's slack variables.
A kernel writes no other array, but that a limit may write the kinds of its bounds
(`StepViews.lower_kind`).

A part of one's own may override a method in numpy instead. The method is called before each step,
and the kernel copies its arrays out of the constants. A limit in numpy then has a word on a motion
to rest, too: along it, its rows and bounds of this step hold.
"""

from dataclasses import fields
from typing import Any, ClassVar, TypeVar

import numpy as np

from iiwa_dnn.checks import Checked
from iiwa_dnn.compiling.library import compiled, entry
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.program import real_array
from iiwa_dnn.references.targets import TargetData
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.schemes.rest import SLACK, Motion, turning_velocity
from iiwa_dnn.schemes.step import Step, StepViews

PartT = TypeVar("PartT", bound="Part")


@entry
def enter_cost(address: int, step: StepViews, constants: Vector, P: Matrix, q: Vector) -> None:
    """Call a cost's kernel by its address; it adds to P (n, n) and the cost vector q (n,)."""


@entry
def enter_task(
    address: int, step: StepViews, constants: Vector, target: TargetData, A: Matrix, b: Vector
) -> None:
    """Call a task's kernel by its address; it writes A (rows, n) and b (rows,)."""


@entry
def enter_limit(
    address: int,
    step: StepViews,
    constants: Vector,
    G: Matrix,
    h: Vector,
    lb: Vector,
    ub: Vector,
) -> None:
    """Call a limit's kernel by its address; it writes G (rows, n), h (rows,), lb and ub (n,)."""


@entry
def enter_rest(address: int, step: StepViews, constants: Vector, motion: Motion) -> bool:
    """Call a limit's second kernel by its address, to test whether a motion to rest keeps it."""
    raise NotImplementedError


_IDLE = {"h": np.inf, "lb": -np.inf, "ub": np.inf}
"""Values without effect in an array of a part, by its name; 0 in the others."""

COMPILED = "has no such method in numpy; Scheme.build_qp shows the rows of a compiled part"

_ROUNDING = 1e-9
"""Asymmetry and negative curvature of P that count as rounding, in units of its largest entry."""


class Part(Checked):
    """Base of costs, tasks and limits.

    Attributes:
        kernel: Compiled function that writes the rows; in a class with a method in numpy, the one
            that copies its arrays.
        rest_kernel: Compiled function that tests whether a motion to rest keeps a limit; None if
            the limit holds at a step only. In a class with a method in numpy, the one that tests
            the arrays of this step.
        rows: Number of rows; 0 for a cost.
        entry: Function through which compiled code calls the kernels of this kind.
    """

    kernel: Any = None
    rest_kernel: Any = None
    rows: int = 0
    entry: ClassVar[Any]
    _copy: Any
    _copy_rest: ClassVar[Any] = None
    _methods: ClassVar[dict[str, tuple[str, str]]] = {}

    def __init_subclass__(cls, **options: Any) -> None:
        """Set the kernel to the one that copies arrays, if the class has a method in numpy."""
        super().__init_subclass__(**options)
        is_kind = Part in cls.__bases__  # Cost, Task and Limit only say what there may be
        if not is_kind and not cls._methods.keys().isdisjoint(vars(cls)):
            cls.kernel = staticmethod(cls._copy)
            cls.rest_kernel = cls._copy_rest

    @property
    def copies(self) -> bool:
        """Test whether methods in numpy return the rows."""
        return self.kernel is self._copy

    def constants(self, robot: Robot) -> Vector:
        """Return the constants that the kernel reads, (k,); they may be a `Record`.

        Raises:
            InvalidInputError: A parameter does not fit the robot.
        """
        return np.zeros(0)

    def refresh(self, step: Step, constants: Vector) -> None:
        """Update the kernel's constants (k,) in place before a step; by default do nothing."""

    @property
    def refreshes(self) -> bool:
        """Test whether the constants of the kernel change from step to step."""
        return self.copies or type(self).refresh is not Part.refresh

    def _check(self, arrays: dict[str, Matrix]) -> None:
        """Raise InvalidInputError if a part cannot have these arrays of its numpy methods.

        Their shapes are checked already. By default all are accepted; a cost needs a convex P.
        """

    def frame_name(self, robot: Robot) -> str:
        """Return the name of the part's frame: its attribute `frame`, or the robot's tip."""
        return getattr(self, "frame", None) or robot.tip

    def row_count(self, robot: Robot) -> int:
        """Return the number of rows for a robot, by default `rows`."""
        return self.rows

    def extra_frames(self, robot: Robot) -> tuple[str, ...]:
        """Return the names of the frames, beside the part's, whose placements the kernel reads."""
        return ()

    def anchored(self: PartT, conf: Configuration) -> PartT:
        """Return the part with the posture `conf` in place of one that was left None."""
        return self

    def settings(self) -> dict[str, Any]:
        """Return the class name and the parameters, as values that JSON can hold."""
        parameters = fields(self) if "__dataclass_fields__" in dir(self) else ()  # type: ignore[arg-type]
        names = [field.name for field in parameters if field.init]
        return {"name": type(self).__name__} | {name: getattr(self, name) for name in names}


def idle_arrays(part: Part, n: int, rows: int) -> dict[str, Matrix]:
    """Return arrays without effect, by name, in the shapes of a part with n variables."""
    shapes = {"P": (n, n), "A": (rows, n), "G": (rows, n), "b": (rows,), "h": (rows,)}
    return {
        name: np.full(shapes.get(name, (n,)), _IDLE.get(name, 0.0))
        for names in part._methods.values()
        for name in names
    }


def flat(arrays: dict[str, Matrix], rows: int) -> Vector:
    """Return the constants of a part in numpy: its arrays, then its number of rows, (k,)."""
    return np.concatenate([*map(np.ravel, arrays.values()), [float(rows)]])


def answer_of(part: Part, step: Step, n: int, rows: int) -> Vector:
    """Call a part's methods in numpy, check their arrays and return its constants, (k,).

    Args:
        part: The part.
        step: The instant.
        n: Number of the scheme's variables; an array may leave the slack variables out.
        rows: Number of the part's rows.

    Raises:
        InvalidInputError: A method returns no pair of arrays, or an array has a wrong shape, is not
            finite where it has to be, or is a P that is not convex.
    """
    arrays = idle_arrays(part, n, rows)
    of_joints = idle_arrays(part, step.robot.dof, rows)
    for method, names in part._methods.items():
        answer = getattr(part, method)(step)
        for name, array in _named(part, names, answer).items():
            known = of_joints if array.shape[-1] == step.robot.dof else arrays
            shape = known[name].shape
            if array.shape != shape:
                problem = f"{name} has shape {array.shape}, not {shape}"
                raise InvalidInputError(type(part).__name__, problem, array)
            if not (np.isfinite(array) | (array == _IDLE.get(name, 0.0))).all():
                kind = "NaN" if np.isnan(array).any() else "an infinite number"
                raise InvalidInputError(type(part).__name__, f"{name} holds {kind}", array)
            arrays[name][tuple(map(slice, shape))] = array
    part._check(arrays)
    return flat(arrays, rows)


def _named(part: Part, names: tuple[str, str], answer: Any) -> dict[str, Matrix]:
    """Return the two arrays of a method's answer by name; refuse any other answer."""
    try:
        named = zip(names, answer, strict=True)
        return {name: np.atleast_1d(real_array(name, array)) for name, array in named}
    except (TypeError, ValueError) as error:
        problem = f"must return two arrays, {' and '.join(names)}, not {answer!r:.80}"
        raise InvalidInputError(type(part).__name__, problem, answer) from error


@compiled
def copy_cost(step: StepViews, constants: Vector, P: Matrix, q: Vector) -> None:
    """Add P (n, n) and q (n,) from the constants; for a cost in numpy. Writes P and q."""
    n = q.size
    for i in range(n):
        q[i] += constants[n * n + i]
        for k in range(n):
            P[i, k] += constants[n * i + k]


@compiled
def copy_task(step: StepViews, constants: Vector, target: TargetData, A: Matrix, b: Vector) -> None:
    """Write A (rows, n) and b (rows,) from the constants; for a task in numpy."""
    _copy_rows(constants, A, b)


@compiled
def _copy_rows(constants: Vector, A: Matrix, b: Vector) -> None:
    """Write A (rows, n) and b (rows,) from the beginning of the constants."""
    n = A.shape[1]
    for j in range(b.size):
        b[j] = constants[n * b.size + j]
        for i in range(n):
            A[j, i] = constants[n * j + i]


@compiled
def copy_limit(
    step: StepViews, constants: Vector, G: Matrix, h: Vector, lb: Vector, ub: Vector
) -> None:
    """Write G (rows, n) and h (rows,), and tighten lb and ub (n,); for a limit in numpy.

    The constants are the four arrays one after another, and the number of rows.
    """
    _copy_rows(constants, G, h)
    n = lb.size
    bounds = constants[h.size * (n + 1) :]
    for i in range(n):
        lb[i] = max(lb[i], bounds[i])
        ub[i] = min(ub[i], bounds[n + i])


@compiled
def keeps_copied(step: StepViews, constants: Vector, motion: Motion) -> bool:
    """Test whether a motion to rest keeps the rows and bounds of this step; for a limit in numpy.

    Where the command itself or rest does not, the motion may go no further beyond them. `constants`
    are those of `copy_limit`.
    """
    rows = int(constants[constants.size - 1])
    n = (constants.size - 1 - rows) // (rows + 2)
    bounds = constants[rows * (n + 1) :]
    for i in range(motion.first.size):
        x = motion.first[i]
        b = motion.coefficient[i]
        if _goes_beyond(x, b, bounds[n + i]) or _goes_beyond(-x, -b, -bounds[i]):
            return False
    for j in range(rows):
        x = 0.0
        b = 0.0
        for i in range(motion.first.size):
            x += constants[n * j + i] * motion.first[i]
            b += constants[n * j + i] * motion.coefficient[i]
        if _goes_beyond(x, b, constants[n * rows + j]):
            return False
    return True


@compiled
def _goes_beyond(x: float, b: float, most: float) -> bool:
    """Test whether a rate that begins with x, with coefficient b, goes beyond x, 0 and `most`."""
    return turning_velocity(x, b) > max(max(most, x), 0.0) * (1.0 + SLACK)


class Cost(Part):
    """Base of costs: terms 1/2 x^T P x + q^T x of a program's objective."""

    entry = enter_cost
    _copy = staticmethod(copy_cost)
    _methods: ClassVar[dict[str, tuple[str, str]]] = {"quadratic": ("P", "q")}

    def quadratic(self, step: Step) -> tuple[Matrix, Vector]:
        """Return P (n, n), symmetric positive semidefinite, and q (n,).

        n is the number of joints, or that of the joints and the slack variables.
        """
        raise NotImplementedError(f"{type(self).__name__} {COMPILED}")

    def _check(self, arrays: dict[str, Matrix]) -> None:
        P = arrays["P"]
        forgiven = _ROUNDING * np.abs(P).max()
        if np.abs(P - P.T).max() > forgiven:
            raise InvalidInputError(type(self).__name__, "P is not symmetric", P)
        if (least := np.linalg.eigvalsh(P)[0]) < -forgiven:
            problem = f"P is not convex, its least eigenvalue is {least:.3g}"
            raise InvalidInputError(type(self).__name__, problem, P)


class Task(Part):
    r"""Base of tasks: equality rows A x = b, or soft ones.

    With a `weight` w the rows are the cost :math:`\tfrac12 w\,\|A x - b\|^2`.

    Attributes:
        tracks: Whether the task needs a target of its frame.
        row_weight: Weight of the error of a row where a policy relaxes the task
            (`iiwa_dnn.step.policies`), 1 for an error in [m/s]. With 0 they are not relaxed.
        weight: None for hard rows, else the weight of the soft task.
    """

    entry = enter_task
    _copy = staticmethod(copy_task)
    _methods: ClassVar[dict[str, tuple[str, str]]] = {"equations": ("A", "b")}
    tracks: bool = True
    row_weight: float = 1.0
    weight: float | None = None

    def equations(self, step: Step) -> tuple[Matrix, Vector]:
        """Return A (rows, n) and b (rows,)."""
        raise NotImplementedError(f"{type(self).__name__} {COMPILED}")


class Limit(Part):
    """Base of limits: bounds lb <= x <= ub, inequality rows G x <= h, or both.

    The number of inequality rows, `rows`, is the same at every step; a row that is not needed has
    h = inf.

    Attributes:
        rows_suffice: Whether the rows of a step always leave a command after which those of the
            next one do, so that by itself the limit needs no test of a motion to rest.
        slower_helps: Whether a motion to rest that takes longer may keep the limit where one from
            the same command does not.
    """

    rows_suffice: ClassVar[bool] = False
    slower_helps: ClassVar[bool] = False

    @property
    def title(self) -> str:
        """Name of the class, and in words how long the limit holds, unless that is until rest."""
        if self.copies:
            return f"{type(self).__name__} (as at this step)"
        lasts = self.rest_kernel is not None or self.rows_suffice
        return type(self).__name__ + (not lasts) * " (this step only)"

    entry = enter_limit
    _copy = staticmethod(copy_limit)
    _copy_rest = staticmethod(keeps_copied)
    _methods: ClassVar[dict[str, tuple[str, str]]] = {
        "inequalities": ("G", "h"),
        "bounds": ("lb", "ub"),
    }

    def check_start(self, robot: Robot, q: Vector) -> None:
        """Refuse joint positions q (n,) [rad] to start from; by default accept all.

        Raises:
            InvalidInputError: The limit does not hold at rest there.
        """

    def row_names(self, robot: Robot) -> list[str]:
        """Return a name in words for each inequality row; by default none: rows are numbered."""
        return []

    def inequalities(self, step: Step) -> tuple[Matrix, Vector]:
        """Return G (rows, n) and h (rows,); by default no rows."""
        if self.rows or not self.copies:
            raise NotImplementedError(f"{type(self).__name__} {COMPILED}")
        return np.zeros((0, step.q.size)), np.zeros(0)

    def bounds(self, step: Step) -> tuple[Vector, Vector]:
        """Return lb (n,) and ub (n,), by default infinite; the program has the tightest of all."""
        if not self.copies:
            raise NotImplementedError(f"{type(self).__name__} {COMPILED}")
        return np.full(step.q.size, -np.inf), np.full(step.q.size, np.inf)
