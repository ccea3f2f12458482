"""Checks of arguments: each returns the value as it is needed, or names the argument."""

import math
from collections.abc import Sequence
from numbers import Integral, Real
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn.errors import InvalidInputError

Array = NDArray[np.float64]
Vector3 = tuple[float, float, float]
T = TypeVar("T")


def finite(argument: str, value: object) -> float:
    """The value as a float, or an InvalidInputError unless it is a finite number."""
    if not isinstance(value, Real) or not math.isfinite(value):
        raise InvalidInputError(argument, f"must be a finite number, not {value!r}", value)
    return float(value)


def positive(argument: str, value: object) -> float:
    """The value as a float, or an InvalidInputError unless it is a finite number above zero."""
    if type(value) is float and 0.0 < value < math.inf:
        return value  # the test for any kind of number costs more than all the rest of some callers
    if not isinstance(value, Real) or not math.isfinite(value) or float(value) <= 0.0:
        raise InvalidInputError(argument, f"must be a finite number above 0, not {value!r}", value)
    return float(value)


def not_negative(argument: str, value: object) -> float:
    """The value as a float, or an InvalidInputError unless it is a finite number of at least 0."""
    if not isinstance(value, Real) or not math.isfinite(value) or float(value) < 0.0:
        raise InvalidInputError(argument, f"must be a finite number >= 0, not {value!r}", value)
    return float(value)


def integer(argument: str, value: object, least: int) -> int:
    """The value as an int, or an InvalidInputError unless it is a whole number >= `least`."""
    if isinstance(value, bool) or not isinstance(value, Integral) or int(value) < least:
        raise InvalidInputError(
            argument, f"must be a whole number of at least {least}, not {value!r}", value
        )
    return int(value)


def one_of(argument: str, value: object, choices: Sequence[str]) -> None:
    """An InvalidInputError unless the value is one of the choices."""
    if value not in choices:
        raise InvalidInputError(
            argument, f"must be one of {', '.join(choices)}, not {value!r}", value
        )


def instance(argument: str, value: T, kind: type[Any]) -> T:
    """The value, or an InvalidInputError unless it is an object of a class or of a subclass."""
    if not isinstance(value, kind):
        problem = f"must be an iiwa_dnn.{kind.__name__}, not {value!r:.80}"
        raise InvalidInputError(argument, problem, value)
    return value


def offers(argument: str, value: T, *names: str) -> T:
    """The value, or an InvalidInputError unless it is an object, no class, with these members."""
    if isinstance(value, type) or not all(hasattr(value, name) for name in names):
        problem = f"must be an object with {' and '.join(names)}, not {value!r:.80}"
        raise InvalidInputError(argument, problem, value)
    return value


def vector3(argument: str, value: Sequence[float] | Array) -> Vector3:
    """The value (3,) as a tuple of floats, or an InvalidInputError unless it is three numbers."""
    x, y, z = finite_array(argument, value, (3,)).tolist()
    return x, y, z


def direction(argument: str, value: Sequence[float] | Array) -> Vector3:
    """The value (3,) as a tuple of length one, or an InvalidInputError if that is impossible."""
    vector = np.array(vector3(argument, value))
    if not vector.any():
        raise InvalidInputError(argument, "must not be zero", value)
    vector /= np.abs(vector).max()  # its square may not underflow
    x, y, z = (vector / np.linalg.norm(vector)).tolist()
    return x, y, z


def finite_array(argument: str, value: ArrayLike, shape: tuple[int, ...]) -> Array:
    """A read-only copy of the value, or an InvalidInputError unless it is finite and of this shape.

    An entry of -1 in ``shape`` leaves that length open.
    """
    try:
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidInputError(argument, "must be numbers", value) from error
    fits = array.ndim == len(shape)
    if not fits or any(n not in (-1, m) for n, m in zip(shape, array.shape, strict=True)):
        wanted = str(shape).replace("-1", "m")
        raise InvalidInputError(argument, f"must have shape {wanted}, not {array.shape}", value)
    if not np.isfinite(array).all():
        raise InvalidInputError(argument, "must be finite", value)
    array.setflags(write=False)
    return array


def rotation(argument: str, value: ArrayLike) -> Array:
    """A read-only copy of the value (3, 3), or an InvalidInputError unless it is a rotation."""
    turn = finite_array(argument, value, (3, 3))
    if np.abs(turn @ turn.T - np.eye(3)).max() > 1e-6 or np.linalg.det(turn) < 0.0:
        raise InvalidInputError(argument, "is not a rotation matrix", value)
    return turn


def read_only(array: Array) -> Array:
    """A view of `array`, of any shape, that cannot be written into."""
    view = array[...]
    view.setflags(False)  # write=False: by position it takes half the time
    return view
