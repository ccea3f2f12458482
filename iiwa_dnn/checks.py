"""Checks of arguments: each returns the value in the form that is needed.

A value that does not fit ends in an `InvalidInputError` under the name that the caller hands over,
which is the name of the caller's own argument.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from numbers import Integral, Real
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn.errors import InvalidInputError

Array = NDArray[np.float64]
Matrix = NDArray[np.float64]
Vector3 = tuple[float, float, float]
T = TypeVar("T")


def finite(argument: str, value: object) -> float:
    """Return a finite number as a float; refuse any other value."""
    return _number(argument, value, "a finite number", lambda number: True)


def positive(argument: str, value: object) -> float:
    """Return a finite number above zero as a float; refuse any other value."""
    return _number(argument, value, "a finite number above 0", lambda number: number > 0.0)


def not_negative(argument: str, value: object) -> float:
    """Return a finite number of at least 0 as a float; refuse any other value."""
    return _number(argument, value, "a finite number >= 0", lambda number: number >= 0.0)


def _number(argument: str, value: object, kind: str, fits: Callable[[float], bool]) -> float:
    # A float first: the test for any kind of number costs more than all the rest of some callers.
    if (
        isinstance(value, float | Real)
        and not isinstance(value, bool)
        and math.isfinite(value)
        and fits(float(value))
    ):
        return float(value)
    raise InvalidInputError(argument, f"must be {kind}, not {value!r}", value)


def integer(argument: str, value: object, least: int) -> int:
    """Return a whole number of at least `least` as an int; refuse any other value."""
    if isinstance(value, bool) or not isinstance(value, Integral) or int(value) < least:
        raise InvalidInputError(
            argument, f"must be a whole number of at least {least}, not {value!r}", value
        )
    return int(value)


def one_of(argument: str, value: T, choices: Sequence[str]) -> T:
    """Return a value that is one of the choices; refuse any other value."""
    if value not in choices:
        raise InvalidInputError(
            argument, f"must be one of {', '.join(choices)}, not {value!r}", value
        )
    return value


def names(argument: str, value: str | Iterable[str]) -> list[str]:
    """Return one name, or several, as a list; refuse any other value."""
    several = isinstance(value, Iterable) and not isinstance(value, str)
    found = list(value) if several else [value]
    if not all(isinstance(each, str) for each in found):
        raise InvalidInputError(argument, f"must be one name or several, not {value!r:.80}", value)
    return found


def instance(argument: str, value: T, kind: type[Any]) -> T:
    """Return an object of a class or of a subclass; refuse any other value."""
    if not isinstance(value, kind):
        problem = f"must be an iiwa_dnn.{kind.__name__}, not {value!r:.80}"
        raise InvalidInputError(argument, problem, value)
    return value


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
    vector = np.array(vector3(argument, value))
    if not vector.any():
        raise InvalidInputError(argument, "must not be zero", value)
    x, y, z = (vector / np.linalg.norm(vector)).tolist()
    return x, y, z


def finite_array(argument: str, value: ArrayLike, shape: tuple[int, ...]) -> Array:
    """Return a read-only copy of finite numbers of this shape; refuse any other value.

    An entry of -1 in ``shape`` leaves that length open.
    """
    numbers = array(argument, value, shape)
    if not np.isfinite(numbers).all():
        raise InvalidInputError(argument, "must be finite", value)
    return numbers


def array(argument: str, value: ArrayLike, shape: tuple[int, ...]) -> Array:
    """Return a read-only copy of numbers of this shape, as `finite_array`; they may be NaN."""
    masked: bool = np.ma.is_masked(value)  # type: ignore[no-untyped-call]
    if masked or np.iscomplexobj(value):
        raise InvalidInputError(argument, "must be real numbers, none of them masked", value)
    try:
        numbers = np.array(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidInputError(argument, "must be numbers", value) from error
    lengths = zip(shape, numbers.shape, strict=False)
    if numbers.ndim != len(shape) or not all(n in (-1, m) for n, m in lengths):
        wanted = str(shape).replace("-1", "m")
        raise InvalidInputError(argument, f"must have shape {wanted}, not {numbers.shape}", value)
    numbers.setflags(write=False)
    return numbers


def rotation(argument: str, value: ArrayLike) -> Array:
    """Return a read-only copy of a rotation matrix (3, 3); refuse any other value."""
    turn = finite_array(argument, value, (3, 3))
    if np.abs(turn @ turn.T - np.eye(3)).max() > 1e-6 or np.linalg.det(turn) < 0.0:
        raise InvalidInputError(argument, "is not a rotation matrix", value)
    return turn


def read_only(array: Array) -> Array:
    """Return a view of an array of any shape that cannot be written into."""
    view = array[...]
    view.setflags(False)  # write=False: by position it takes half the time
    return view
