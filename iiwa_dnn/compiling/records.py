"""View the numbers of one flat array by names: attributes in Python, members of a struct in C."""

from __future__ import annotations

import math
from functools import cache
from typing import Any, ClassVar, TypeVar

import numpy as np

Own = TypeVar("Own", bound="Record")


def part(*shape: Any) -> Any:
    """Declare a member of a record: an array of one axis or two, or another record.

    Args:
        shape: Its sizes: numbers, or names of those that are stated where an array is viewed; none
            stands for ``"n"``. Or the other record.
    """
    return shape or ("n",)


class Record(np.ndarray[Any, np.dtype[np.float64]]):
    """Flat array whose numbers have the names that a subclass annotates.

    A member is one number, or an array or record declared by `part`. In the array all single
    numbers come first, then the parts::

        class JointState(Record):
            time: float
            position: Vector = part()
            axis: Vector = part(3)

    A kernel takes a record as a parameter, or in a named tuple, or views an array as a record by
    `of`. A record with sizes of several names is made by `of`, `zeros` or `make` alone. In Python
    an array of several axes holds one record along its last axis for each of the other indices.

    Attributes:
        members: Shape of each member by its name, in the order of the array; of a number ``()``.
        names: Names of the sizes that differ from record to record.
    """

    members: ClassVar[dict[str, tuple[Any, ...]]]
    names: ClassVar[tuple[str, ...]]
    _sizes: tuple[int, ...] = ()

    def __init_subclass__(cls) -> None:
        """Give each annotated member its place in the array and a property."""
        own = {name: vars(cls).get(name, ()) for name in cls.__annotations__}
        cls.members = dict(sorted(own.items(), key=lambda item: len(item[1]) > 0))
        sizes = [size for shape in own.values() for size in shape]
        cls.names = tuple(dict.fromkeys(size for size in sizes if isinstance(size, str)))
        for i, (name, shape) in enumerate(cls.members.items()):
            kind = _KINDS.get(cls.__annotations__[name], float)
            made = _part(name, shape) if shape else property(_number(i, kind), _writer(i))
            setattr(cls, name, made)

    @property
    def sizes(self) -> tuple[int, ...]:
        """Sizes of the record, in the order of `names`."""
        return self._sizes or self._with_last(self.shape[-1], ())

    @classmethod
    def _with_last(cls, count: int, sizes: tuple[int, ...]) -> tuple[int, ...]:
        """Return all sizes of a record of `count` numbers; a missing last one is computed."""
        if len(sizes) != len(cls.names) - 1:
            return sizes
        fixed = cls.width(*sizes, 0)
        return (*sizes, (count - fixed) // (cls.width(*sizes, 1) - fixed))

    @classmethod
    @cache
    def columns(cls, *sizes: int) -> dict[str, slice]:
        """Return the place of each member in the array, for the sizes in the order of `names`."""
        known = dict(zip(cls.names, sizes, strict=True))
        found = {}
        start = 0
        for name, shape in cls.members.items():
            end = start + math.prod(known[own] if own in known else _size(own) for own in shape)
            found[name] = slice(start, end)
            start = end
        return found

    @classmethod
    @cache
    def width(cls, *sizes: int) -> int:
        """Count the numbers of a record from the sizes of `names`; -1 if a size is negative."""
        ends = (own.stop for own in cls.columns(*sizes).values())
        return max(ends, default=0) if min(sizes, default=0) >= 0 else -1

    @classmethod
    def of(cls: type[Own], numbers: np.ndarray[Any, Any], *sizes: int) -> Own:
        """View an array as a record; the last size, if not given, follows from the array's length.

        Raises:
            ValueError: The array's length is none of such a record.
        """
        sizes = cls._with_last(numbers.shape[-1], sizes)
        if numbers.shape[-1] != cls.width(*sizes):
            raise ValueError(f"an array of shape {numbers.shape} is no {cls.__name__}")
        own = numbers.view(cls)
        if len(sizes) > 1:
            own._sizes = sizes
        return own

    @classmethod
    def zeros(cls: type[Own], *sizes: int) -> Own:
        """Make a record of zeros, for the sizes in the order of `names`."""
        return cls.of(np.zeros(cls.width(*sizes)), *sizes)

    @classmethod
    def make(cls: type[Own], **values: Any) -> Own:
        """Make a record from the values of all members, by their names.

        Raises:
            TypeError: A member has no value, or a value no member.
            ValueError: The array for a part has another shape than declared.
        """
        if values.keys() != cls.members.keys():
            members = ", ".join(cls.members)
            raise TypeError(f"{cls.__name__} has the members {members}, not {', '.join(values)}")
        sizes = {
            name: size
            for member, shape in cls.members.items()
            for name, size in zip(shape, np.shape(values[member]), strict=True)
        }
        own = cls.zeros(*(sizes[name] for name in cls.names))
        for name, value in values.items():
            setattr(own, name, value)
        return own

    def duplicate(self: Own) -> Own:
        """Return a record with a copy of the numbers."""
        return self.of(self.numbers.copy(), *self.sizes)

    @property
    def numbers(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        """All numbers of the record as a plain array, a view."""
        return self.view(np.ndarray)


def _size(own: Any) -> int:
    """Return a size that a part states as a number, or as another record."""
    return own if isinstance(own, int) else int(own.width())


_KINDS: dict[Any, type] = {"int": int, int: int, "bool": bool, bool: bool}


def _number(i: int, kind: type) -> Any:
    return lambda own: kind(own.item(i)) if own.ndim == 1 else own.numbers[..., i].astype(kind)


def _writer(i: int) -> Any:
    def write(own: Any, value: Any) -> None:
        own[..., i] = value

    return write


def _part(name: str, shape: tuple[Any, ...]) -> Any:
    """Return the property of a part, by its name and shape."""

    def view(own: Any) -> Any:
        columns = own.columns(*own.sizes)[name]
        found = own.numbers[columns] if own.ndim == 1 else own.numbers[..., columns]
        if len(shape) == 1:
            return shape[0].of(found) if hasattr(shape[0], "of") else found
        return found.reshape(*own.shape[:-1], -1, shape[-1])

    def fill(own: Any, value: Any) -> None:
        view(own)[...] = value

    return property(view, fill)
