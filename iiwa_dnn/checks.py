"""Checks of arguments: each returns the value in the form that is needed.

A value that does not fit ends in an `InvalidInputError` under the name that the caller hands over,
which is the name of the caller's own argument.
"""

import math
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from numbers import Integral, Real
from typing import Any, ClassVar, TypeGuard, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn.compiling.trigonometry import LARGEST
from iiwa_dnn.errors import InvalidInputError, NotFoundError

Array = NDArray[np.float64]
Matrix = NDArray[np.float64]
Vector3 = tuple[float, float, float]
T = TypeVar("T")
_FLOAT = np.dtype(np.float64)

Checks = Mapping[str, Callable[[str, Any], Any]]
"""Checks of parameters by their names: functions such as those of this module."""


class Checked:
    """Base of frozen dataclasses that check their parameters.

    A wrong one raises an `InvalidInputError` that names it.
    """

    _checks: ClassVar[Checks] = {}

    def __post_init__(self) -> None:
        """Check and convert the parameters; None passes for one whose default is None."""
        for kind in type(self).__mro__:
            for name, check in vars(kind).get("_checks", {}).items():
                value = getattr(self, name)
                if value is not None or getattr(type(self), name, ...) is not None:
                    self._set(**{name: check(name, value)})

    def _set(self, **values: Any) -> None:
        """Set attributes of a frozen dataclass."""
        for name, value in values.items():
            object.__setattr__(self, name, value)


def fix(owner: object, **values: Any) -> None:
    """Set attributes of an object that refuses to set them (`settable`)."""
    for name, value in values.items():
        object.__setattr__(owner, name, value)


class Whole:
    """Base of objects whose attributes cannot be deleted."""

    def __delattr__(self, name: str) -> None:
        raise InvalidInputError(name, "cannot be deleted", getattr(self, name, None))


def settable(kind: str, name: str, value: object, names: Sequence[str]) -> None:
    """Refuse to set a public attribute of an object of a kind, unless it is one of some names."""
    if not name.startswith("_") and name not in names:
        problem = f"cannot be set, as {' and '.join(names)} can; make {kind} anew"
        raise InvalidInputError(name, problem, value)


def finite(argument: str, value: object) -> float:
    """Return a finite number as a float; refuse any other value."""
    return _number(argument, value, "a finite number", lambda number: True)


def positive(argument: str, value: object) -> float:
    """Return a finite number above zero as a float; refuse any other value."""
    return _number(argument, value, "a finite number above 0", lambda number: number > 0.0)


def not_negative(argument: str, value: object) -> float:
    """Return a finite number of at least 0 as a float; refuse any other value."""
    return _number(argument, value, "a finite number >= 0", lambda number: number >= 0.0)


def fraction(argument: str, value: object) -> float:
    """Return a number from 0 to 1 as a float; refuse any other value."""
    return _number(argument, value, "a number from 0 to 1", lambda number: 0.0 <= number <= 1.0)


def _number(argument: str, value: object, kind: str, fits: Callable[[float], bool]) -> float:
    """Return a finite number that fits as a float; refuse any other value, naming the kind."""
    # A float first: the test for any kind of number costs more than all the rest of some callers.
    if (
        isinstance(value, (float, Real))
        and not isinstance(value, bool)
        and math.isfinite(value)
        and fits(float(value))
    ):
        return float(value)
    raise InvalidInputError(argument, f"must be {kind}, not {value!r}", value)


def integer(argument: str, value: object, least: int) -> int:
    """Return a whole number of at least `least` as an int; refuse any other value."""
    # An int first, as above.
    if isinstance(value, bool) or not isinstance(value, (int, Integral)) or int(value) < least:
        raise InvalidInputError(
            argument, f"must be a whole number of at least {least}, not {value!r}", value
        )
    return int(value)


def one_of(argument: str, value: T, choices: Sequence[object]) -> T:
    """Return a value that is one of the choices; refuse any other value."""
    # Its type first: an array is compared entry by entry.
    if not isinstance(value, tuple(map(type, choices))) or value not in choices:
        known = ", ".join(map(str, choices))
        raise InvalidInputError(argument, f"must be one of {known}, not {value!r:.80}", value)
    return value


def known(kind: str, given: Iterable[str], there: Collection[str]) -> None:
    """Raise a NotFoundError for the first given name of this kind that is not `there`."""
    for name in given:
        if name not in there:
            raise NotFoundError(kind, name, there)


def names(argument: str, value: str | Iterable[str]) -> list[str]:
    """Return one name, or several, as a list; refuse any other value."""
    alone = isinstance(value, str) or not isinstance(value, Iterable)
    found: list[Any] = [value] if alone else list(value)
    if not all(isinstance(each, str) for each in found):
        raise InvalidInputError(argument, f"must be one name or several, not {value!r:.80}", value)
    return found


def instance(argument: str, value: T, kind: type[Any]) -> T:
    """Return an object of a class or of a subclass; refuse any other value."""
    if not isinstance(value, kind):
        problem = f"must be an iiwa_dnn.{kind.__name__}, not {value!r:.80}"
        raise InvalidInputError(argument, problem, value)
    return value


def instances(argument: str, value: Iterable[T], kind: type[Any]) -> tuple[T, ...]:
    """Return a list of objects of a class or of subclasses; refuse any other value."""
    if not isinstance(value, Iterable):
        raise InvalidInputError(argument, f"must be a list of parts, not {value!r:.80}", value)
    return tuple(instance(argument, each, kind) for each in value)


def offers(argument: str, value: T, *names: str) -> T:
    """Return an object, no class, that has all of these members; refuse any other value."""
    if isinstance(value, type) or not all(hasattr(value, name) for name in names):
        problem = f"must be an object with {' and '.join(names)}, not {value!r:.80}"
        raise InvalidInputError(argument, problem, value)
    return value


def vector3(argument: str, value: Sequence[float] | Array) -> Vector3:
    """Return three finite numbers as a tuple of floats; refuse any other value."""
    x, y, z = finite_array(argument, value, (3,)).tolist()
    return x, y, z


def direction(argument: str, value: Sequence[float] | Array) -> Vector3:
    """Return a vector (3,), scaled to length 1, as a tuple; refuse zero and any other value."""
    vector = finite_array(argument, value, (3,))
    if not vector.any():
        raise InvalidInputError(argument, "must not be zero", value)
    return vector3(argument, vector / np.linalg.norm(vector))


def finite_array(argument: str, value: ArrayLike, shape: tuple[int, ...]) -> Array:
    """Return a read-only copy of finite numbers of this shape; refuse any other value.

    An entry of -1 in ``shape`` leaves that length open.
    """
    numbers = array(argument, value, shape)
    if not np.isfinite(numbers).all():
        raise InvalidInputError(argument, "must be finite", value)
    return numbers


def joint_positions(argument: str, value: ArrayLike, dof: int) -> Array:
    """Return a read-only copy of joint positions (dof,) below 2^20 rad; refuse any other value.

    Kernels take their sines to the last digits up to there.
    """
    q = array(argument, value, (dof,))
    if not q.dot(q) <= LARGEST * LARGEST:  # rarely, and at NaN; `@` would warn of an overflow
        finite_array(argument, q, (dof,))
        if np.abs(q).max() > LARGEST:
            raise InvalidInputError(argument, f"must be within ±{LARGEST:.0f} rad", value)
    return q


def is_plain(value: object, shape: tuple[int, ...]) -> TypeGuard[Array]:
    """Test whether a value is an array of float64 of this shape, without gaps."""
    # Of bytes in another order Pinocchio makes other numbers, without a word.
    if type(value) is not np.ndarray or value.dtype is not _FLOAT or value.shape != shape:
        return False
    return value.base is None or value.flags.c_contiguous  # own data have no gaps


def array(argument: str, value: ArrayLike, shape: tuple[int, ...]) -> Array:
    """Return a read-only copy of numbers of this shape, as `finite_array`; they may be NaN."""
    if type(value) is np.ndarray and value.dtype is _FLOAT and value.shape == shape:
        numbers = value.copy()
        numbers.setflags(write=False)
        return numbers
    try:
        # A list as objects: as numbers, its booleans would be 0 and 1.
        given = value if isinstance(value, np.ndarray) else np.array(value, dtype=object)
        if _has_booleans(given) or given.dtype.kind in "bc" or is_masked(value):
            raise TypeError
        numbers = np.array(given, dtype=np.float64, order="C")
    except (TypeError, ValueError, OverflowError) as error:
        raise InvalidInputError(argument, "must be numbers, real and not masked", value) from error
    lengths = zip(shape, numbers.shape, strict=False)
    if numbers.ndim != len(shape) or not all(n in (-1, m) for n, m in lengths):
        wanted = str(shape).replace("-1", "m")
        raise InvalidInputError(argument, f"must have shape {wanted}, not {numbers.shape}", value)
    numbers.setflags(write=False)
    return numbers


def _has_booleans(given: NDArray[Any]) -> bool:
    """Test whether an array of objects holds a boolean."""
    return given.dtype == object and not {bool, np.bool_}.isdisjoint(map(type, given.flat))


def is_masked(value: object) -> bool:
    """Test whether an array, or a row of a list of arrays, hides some of its numbers."""
    rows = value if isinstance(value, list | tuple) else [value]
    # Not by np.ma, whose import takes longer than that of most of this package.
    return any(isinstance(row, np.ndarray) and np.any(getattr(row, "mask", False)) for row in rows)


def rotation(argument: str, value: ArrayLike) -> Array:
    """Return the rotation matrix (3, 3) nearest to a value, read-only; refuse one that is far.

    Rounding a rotation to three digits moves the entries of R R' by up to 2e-3.
    """
    turn = finite_array(argument, value, (3, 3))
    away = np.abs(turn @ turn.T - np.eye(3)).max()
    determinant = np.linalg.det(turn)
    if away > 2e-3 or determinant < 0.0:
        found = f"R R' is off the identity by {away:.2g}, the determinant is {determinant:.2g}"
        raise InvalidInputError(argument, f"is not a rotation matrix: {found}", value)
    if away > 1e-12:
        left, _, right = np.linalg.svd(turn)
        near = left @ right
        # Off orthogonality by some roundings, which depend on the processor; a Newton step has one.
        return read_only(1.5 * near - 0.5 * near @ near.T @ near)
    return turn


def read_only(array: Array) -> Array:
    """Return a view of an array of any shape that cannot be written into."""
    view = array[...]
    view.setflags(False)  # write=False: by position it takes half the time
    return view
