"""A reference seen one control period ahead, for tasks that track the next target."""

from typing import Any, ClassVar

import numpy as np
from numba import njit

from iiwa_dnn.references.base import Array, Reference
from iiwa_dnn.references.rotations import rotation_log


@njit(cache=True, error_model="numpy")
def _aim(pairs: Array, dt: float, out: Array, row: int, column: int) -> None:
    """Write the first of each two targets (2 k, 18), its twist the mean one between them."""
    relative = np.empty((3, 3))
    for k in range(pairs.shape[0] // 2):
        now, then = pairs[2 * k], pairs[2 * k + 1]
        target = out[row + k, column : column + 18]
        target[:12] = now[:12]
        for i in range(3):
            target[12 + i] = (then[i] - now[i]) / dt
            for j in range(3):
                a, b = 3 + 3 * i, 3 + 3 * j
                relative[i, j] = (
                    then[a] * now[b] + then[a + 1] * now[b + 1] + then[a + 2] * now[b + 2]
                )
        rotation_log(relative, target[15:18])
        target[15:18] /= dt


class Ahead(Reference):
    """A path whose targets have, in place of their twist, the mean one over the coming period."""

    name: ClassVar[str] = "ahead"
    _seen: Reference
    _dt: float

    def __init__(self, along: Reference, dt: float) -> None:
        """Look at a path one period of dt [s] ahead."""
        self._set(_seen=along, _dt=dt, numbers=along.numbers, _base=along.base)

    @property
    def compiled(self) -> Any:
        """The compiled form, where the path has one."""
        return None if self._seen.compiled is None else self._write

    @property
    def period(self) -> float:
        """Time after which the path repeats [s]."""
        return self._seen.period

    def _write(self, times: Array, numbers: Array, out: Array, row: int, column: int) -> None:
        _aim(self._pairs(times), self._dt, out, row, column)

    def _targets(self, times: Array) -> Array:
        out = np.empty((times.size, 18))
        self._write(times, self.numbers, out, 0, 0)
        return out

    def _pairs(self, times: Array) -> Array:
        """Compute the targets of each time and of one dt later, in the order of time."""
        return self._seen._targets(np.stack([times, times + self._dt], axis=1).ravel())
