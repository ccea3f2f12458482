"""Parts of a program: costs, tasks and limits, each a block of rows.

A part names the compiled function that writes its rows, its `kernel`, and gives the constants which
that function reads. All kernels of a kind have one signature:

    cost   kernel(step, constants, P, q)                adds to P (n, n) and q (n,)
    task   kernel(step, constants, target, A, b)        writes A (rows, n) and b (rows,)
    limit  kernel(step, constants, G, h, lb, ub)        writes G (rows, n) and h (rows,), and
                                                        tightens lb (n,) and ub (n,)

`step` is a `StepViews`, `target` the `TargetData` of the frame that the task tracks. The
rows come in as zeros, h as zeros, and n counts the joints and then the scheme's slack variables.

A part may override a method in numpy instead. It is asked before each step, and its kernel, that
of its kind, copies the answer out of the constants.
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
from iiwa_dnn.schemes.step import Step, StepViews

PartT = TypeVar("PartT", bound="Part")


@entry
def enter_cost(address: int, step: StepViews, constants: Vector, P: Matrix, q: Vector) -> None:
    """Call a cost's kernel, with constants (k,), P (n, n) and the cost vector q (n,)."""


@entry
def enter_task(
    address: int, step: StepViews, constants: Vector, target: TargetData, A: Matrix, b: Vector
) -> None:
    """Call a task's kernel, with constants (k,), target, A (rows, n), b (rows,)."""


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
    """Call a limit's kernel, with constants (k,), G (rows, n), h (rows,), lb and ub (n,)."""


_IDLE = {"h": np.inf, "lb": -np.inf, "ub": np.inf}
"""Infinite values that an array of an answer may hold, by its name; omitted variables have them
too,
else zero."""

COMPILED = "has no such method in numpy; Scheme.build_qp shows the rows of a compiled part"

_ROUNDING = 1e-9
"""Asymmetry and negative curvature of P that are forgiven, by its largest entry."""


class Part(Checked):
    """A block of a program's rows; a cost, a task or a limit.

    Attributes:
        kernel: Compiled function that writes the rows; in a class with methods in numpy it copies
            their answers.
        rows: Number of rows; none for a cost.
        entry: Entry of the kernels of this kind.
    """

    kernel: Any = None
    rows: int = 0
    entry: ClassVar[Any]
    _copy: Any
    _methods: ClassVar[dict[str, tuple[str, str]]] = {}

    def __init_subclass__(cls, **options: Any) -> None:
        """Take the kernel that copies answers if the class has a method in numpy."""
        super().__init_subclass__(**options)
        if not cls._methods.keys().isdisjoint(vars(cls)):
            cls.kernel = staticmethod(cls._copy)

    @property
    def copies(self) -> bool:
        """Test whether methods in numpy give the rows."""
        return self.kernel is self._copy

    def constants(self, robot: Robot) -> Vector:
        """Return the numbers that the kernel reads, (k,), a `Record` for example.

        Raises:
            InvalidInputError: A parameter does not fit the robot.
        """
        return np.zeros(0)

    def refresh(self, step: Step, constants: Vector) -> None:
        """Bring the constants of the kernel, (k,), up to date before a step."""

    @property
    def refreshes(self) -> bool:
        """Test whether constants of the kernel change along a run."""
        return self.copies or type(self).refresh is not Part.refresh

    def _check(self, arrays: dict[str, Matrix]) -> None:
        """Raise InvalidInputError unless the arrays of an answer go together."""

    def frame_name(self, robot: Robot) -> str:
        """Return the name of the frame that the part is about, the tip's by default."""
        return getattr(self, "frame", None) or robot.tip

    def row_count(self, robot: Robot) -> int:
        """Return the number of rows for a robot; `rows`, unless a part says otherwise."""
        return self.rows

    def extra_frames(self, robot: Robot) -> tuple[str, ...]:
        """Return the names of further frames whose placements the kernel reads."""
        return ()

    def anchored(self: PartT, conf: Configuration) -> PartT:
        """Return the part with `conf` as the posture to come back to, where it lacks one."""
        return self

    def settings(self) -> dict[str, Any]:
        """Return name and parameters, as values that JSON can hold."""
        parameters = fields(self) if "__dataclass_fields__" in dir(self) else ()  # type: ignore[arg-type]
        names = [field.name for field in parameters if field.init]
        return {"name": type(self).__name__} | {name: getattr(self, name) for name in names}


def idle_arrays(part: Part, n: int, rows: int) -> dict[str, Matrix]:
    """Return the arrays of a part in a program of n variables by their names, without effect."""
    shapes = {"P": (n, n), "A": (rows, n), "G": (rows, n), "b": (rows,), "h": (rows,)}
    return {
        name: np.full(shapes.get(name, (n,)), _IDLE.get(name, 0.0))
        for names in part._methods.values()
        for name in names
    }


def answer_of(part: Part, step: Step, n: int, rows: int) -> Vector:
    """Return the answers of a part's methods in numpy, as the kernel `copy` reads them, (k,).

    Args:
        part: The part.
        step: The instant that they are asked about.
        n: Number of the scheme's variables; an answer may leave the slack variables out.
        rows: Number of the part's rows.

    Raises:
        InvalidInputError: An answer is no pair of arrays, has a wrong shape, is not finite
            where it has to be, or is a P that is not convex.
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
    return np.concatenate([array.ravel() for array in arrays.values()])


def _named(part: Part, names: tuple[str, str], answer: Any) -> dict[str, Matrix]:
    """Return both arrays of an answer by name; raises InvalidInputError if it is no such pair."""
    try:
        named = zip(names, answer, strict=True)
        return {name: np.atleast_1d(real_array(name, array)) for name, array in named}
    except (TypeError, ValueError) as error:
        problem = f"must return two arrays, {' and '.join(names)}, not {answer!r:.80}"
        raise InvalidInputError(type(part).__name__, problem, answer) from error


@compiled
def copy_cost(step: StepViews, constants: Vector, P: Matrix, q: Vector) -> None:
    """Add P and q from the constants."""
    n = q.size
    for i in range(n):
        q[i] += constants[n * n + i]
        for k in range(n):
            P[i, k] += constants[n * i + k]


@compiled
def copy_task(step: StepViews, constants: Vector, target: TargetData, A: Matrix, b: Vector) -> None:
    """Write A and b from the constants."""
    _copy_rows(constants, A, b)


@compiled
def _copy_rows(constants: Vector, A: Matrix, b: Vector) -> None:
    """Write rows A and their right-hand sides b from the constants, which begin with them."""
    n = A.shape[1]
    for j in range(b.size):
        b[j] = constants[n * b.size + j]
        for i in range(n):
            A[j, i] = constants[n * j + i]


@compiled
def copy_limit(
    step: StepViews, constants: Vector, G: Matrix, h: Vector, lb: Vector, ub: Vector
) -> None:
    """Write G and h, and tighten lb and ub, from the constants."""
    _copy_rows(constants, G, h)
    n = lb.size
    first = h.size * (n + 1)
    for i in range(n):
        lb[i] = max(lb[i], constants[first + i])
        ub[i] = min(ub[i], constants[first + n + i])


class Cost(Part):
    """A term of the cost, 1/2 x^T P x + q^T x."""

    entry = enter_cost
    _copy = staticmethod(copy_cost)
    _methods: ClassVar[dict[str, tuple[str, str]]] = {"quadratic": ("P", "q")}

    def quadratic(self, step: Step) -> tuple[Matrix, Vector]:
        """Return P (n, n), symmetric positive semidefinite, and q (n,), to be added to the cost.

        n counts the scheme's variables, the joints and then its slack variables, or the joints
        alone: slack variables may be left out of any part.
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
    r"""Equality rows A x = b, or with a `weight` w the cost :math:`\tfrac12 w\,\|A x - b\|^2`.

    Attributes:
        tracks: Whether the task asks for a target of its frame.
        row_weight: Weight of a missing unit of its rows beside a missing 1 m/s where a policy lets
            the task yield (`iiwa_dnn.control.policies`); 0: they are a limit and hold.
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
    """Bounds lb <= x <= ub, inequality rows G x <= h, or both.

    The number of inequality rows, `rows`, is the same at every step: an idle row has h = inf.
    """

    entry = enter_limit
    _copy = staticmethod(copy_limit)
    _methods: ClassVar[dict[str, tuple[str, str]]] = {
        "inequalities": ("G", "h"),
        "bounds": ("lb", "ub"),
    }

    def row_names(self, robot: Robot) -> list[str]:
        """Return names of the inequality rows, in words; none where their numbers will do."""
        return []

    def inequalities(self, step: Step) -> tuple[Matrix, Vector]:
        """Return G (rows, n) and h (rows,), by default none."""
        if self.rows or not self.copies:
            raise NotImplementedError(f"{type(self).__name__} {COMPILED}")
        return np.zeros((0, step.q.size)), np.zeros(0)

    def bounds(self, step: Step) -> tuple[Vector, Vector]:
        """Return lb (n,) and ub (n,), infinite by default; those of all limits are intersected."""
        if not self.copies:
            raise NotImplementedError(f"{type(self).__name__} {COMPILED}")
        return np.full(step.q.size, -np.inf), np.full(step.q.size, np.inf)
