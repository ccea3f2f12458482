"""Columns of a record: shape, unit, meaning and type of each array that a run leaves behind."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn.errors import InvalidInputError


@dataclass(frozen=True)
class Column:
    """An array of a record.

    Attributes:
        meaning: Quantity that the entries are, and its unit if it has one.
        shape: Length of each axis, a number or a symbol. The first is ``"N"`` for one entry a step
            and ``"N+1"`` for one entry a sample; ``"n"`` counts joints, ``"k"`` reference solvers,
            ``"m"`` inequality rows, ``"l"`` priority levels, ``"f"`` frames beside the first.
        dtype: Type of the entries.
        fill: Entry at a step for which nothing was recorded.
    """

    meaning: str
    shape: tuple[str | int, ...]
    dtype: type[Any] = np.float64
    fill: float = 0.0

    def __str__(self) -> str:
        comma = "," if len(self.shape) == 1 else ""
        return f"{self.meaning}, ({', '.join(map(str, self.shape))}{comma})."

    @property
    def per_sample(self) -> bool:
        """True for one entry a sample, of which there is one more than steps."""
        return self.shape[0] == "N+1"

    def allocate(self, steps: int, **sizes: int) -> NDArray[Any]:
        """Make the array of a run of so many steps, with `fill` in it.

        Args:
            steps: N, the number of steps.
            **sizes: The other symbols of the shape, for example ``n=7``.
        """
        # Zeros take no memory before they are written, unlike np.full.
        array = np.zeros(self._lengths(sizes | {"N": steps, "N+1": steps + 1}), self.dtype)
        if self.fill:
            array[:] = self.fill
        return array

    def check(self, name: str, value: ArrayLike, sizes: dict[str, int]) -> NDArray[Any]:
        """Return a read-only array of this column's type, or raise InvalidInputError.

        The value is copied unless it is protected already.

        Args:
            name: Name of the column.
            value: The array, of the column's `shape`.
            sizes: Lengths by symbol; those that this array is the first to use are entered.
        """
        array = np.asarray(value)
        # NumPy takes any empty list for an array of floats.
        if array.dtype.kind not in ("fiu" if self.dtype is np.float64 else "iu") and array.size:
            raise InvalidInputError(name, f"must hold numbers, not {array.dtype}", value)
        if array.ndim != len(self.shape):
            problem = f"has {array.ndim} dimensions, expected {len(self.shape)}"
            raise InvalidInputError(name, problem, value)
        for symbol, length in zip(self.shape, array.shape, strict=True):
            if isinstance(symbol, str):
                sizes.setdefault(symbol, length)
        expected = self._lengths(sizes)
        if array.shape != expected:
            symbols = ", ".join(map(str, self.shape))
            problem = f"shape {array.shape}, expected ({symbols}) = {expected}"
            raise InvalidInputError(name, problem, value)
        if array.dtype == self.dtype and array.flags.c_contiguous and _is_protected(array):
            return array
        copy = np.array(array, dtype=self.dtype, order="C")
        copy.flags.writeable = False
        return copy

    def _lengths(self, sizes: Mapping[str, int]) -> tuple[int, ...]:
        return tuple(sizes[size] if isinstance(size, str) else size for size in self.shape)


def _is_protected(array: NDArray[Any]) -> bool:
    """Test that neither the array nor the one that it is a view of can be written into."""
    # NumPy makes the owner of the memory the base of a view of a view.
    owner: Any = array if array.base is None else array.base
    whole = isinstance(owner, np.ndarray) and owner.base is None
    return whole and not owner.flags.writeable and not array.flags.writeable
