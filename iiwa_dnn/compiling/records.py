"""Records: numbers of one flat array by their names, in Python attributes and in C a struct."""

from __future__ import annotations

from typing import Any, ClassVar, TypeVar

import numpy as np

Own = TypeVar("Own", bound="Record")


def part(count: int | None = None) -> Any:
    """State that a member of a record is an array of so many numbers.

    Args:
        count: Its size; None: the one that all such parts of the record share, such as the joints,
            which follows from the size of the whole.
    """
    return count


class Record(np.ndarray[Any, np.dtype[np.float64]]):
    """Numbers of one flat array by the names that a subclass annotates.

    A member is a number, or an array where its value is a `part`. In the array all numbers come
    first, then the parts::

        class JointState(Record):
            time: float
            position: Vector = part()
            axis: Vector = part(3)

    A kernel takes one as a parameter, within a named tuple too, or views an array as one by `of`.

    Attributes:
        counts: Size of each part; None: the shared one.
        fixed: Number of all others.
    """

    __slots__ = ()
    counts: ClassVar[dict[str, int | None]]
    fixed: ClassVar[int]

    def __init_subclass__(cls) -> None:
        """Lay the members out."""
        names = [*cls.__annotations__]
        cls.counts = {name: vars(cls)[name] for name in names if name in vars(cls)}
        numbers = [name for name in names if name not in cls.counts]
        cls.fixed = len(numbers) + sum(filter(None, cls.counts.values()))
        for i, name in enumerate(numbers):
            setattr(cls, name, property(_number(i), _writer(i)))
        start = (len(numbers), 0)
        for name, count in cls.counts.items():
            size = (0, 1) if count is None else (count, 0)
            end = (start[0] + size[0], start[1] + size[1])
            setattr(cls, name, property(_slice(start, end)))
            start = end

    @classmethod
    def of(cls: type[Own], numbers: np.ndarray[Any, Any]) -> Own:
        """View an array's numbers by their names.

        Raises:
            ValueError: The array has not the size of such a record.
        """
        shared = [*cls.counts.values()].count(None)
        rest = numbers.size - cls.fixed
        if numbers.ndim != 1 or rest < 0 or (rest % shared if shared else rest):
            raise ValueError(f"an array of shape {numbers.shape} is no {cls.__name__}")
        return numbers.view(cls)

    @classmethod
    def zeros(cls: type[Own], shared: int = 0) -> Own:
        """Make a record of zeros whose parts without a size of their own have this one."""
        return cls.of(np.zeros(cls.fixed + shared * [*cls.counts.values()].count(None)))

    @property
    def numbers(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        """All numbers as a plain array, a view."""
        return self.view(np.ndarray)

    @property
    def shared(self) -> int:
        """Size of the parts without a size of their own."""
        return (self.size - self.fixed) // max(1, [*self.counts.values()].count(None))


def _number(i: int) -> Any:
    return lambda own: own.item(i)


def _writer(i: int) -> Any:
    return lambda own, value: own.__setitem__(i, value)


def _slice(start: tuple[int, int], end: tuple[int, int]) -> Any:
    """Return the property of a part; an offset is a number and a count of shared sizes."""

    def view(own: Any) -> Any:
        shared = own.shared
        return own.numbers[start[0] + start[1] * shared : end[0] + end[1] * shared]

    return view
