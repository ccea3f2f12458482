"""Soft starts: a path that begins at rest, by a change of its clock."""

import math
from dataclasses import dataclass, field

from iiwa_dnn.checks import not_negative
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.references.base import Reference

SHORTEST = 1.0
"""Least length of a soft start that is not given [s]."""


@compiled
def soft_clock(t: float, begin: float) -> tuple[float, float]:
    """Compute the time on a path's own clock [s] and its rate, see `SoftStart`."""
    if begin == 0.0:
        return t, 1.0
    if t >= begin:
        return t - 0.5 * begin, 1.0
    if t <= 0.0:
        return 0.0, 0.0
    u = t / begin
    return t * u * u * (1.0 - 0.5 * u), u * u * (3.0 - 2.0 * u)


@dataclass(frozen=True, eq=False)
class SoftStart(Reference):
    r"""A path that would begin at speed, and begins at rest by a change of its clock.

    Until t = begin the path's own time s rises with u = t / begin as

    .. math::

        s = begin\,(u^3 - u^4 / 2), \qquad \dot s = u^2 (3 - 2 u),

    then as t - begin / 2; before t = 0 the path rests. Velocity and acceleration are continuous,
    and the clock's acceleration is at most 1.5 / begin. The path is the same curve; it comes back
    to its start later by half of `begin`.

    Attributes:
        begin: Length of the soft start [s]: by default 1 s or a tenth of a round, whichever is
            longer; 0 begins at full speed.
    """

    begin: float | None = field(default=None, kw_only=True)

    @property
    def duration(self) -> float:
        """Time until the path is back at its start, at full speed [s]."""
        return self._lasting(self.period)

    def _set_begin(self, default: float | None, round_time: float) -> float:
        """Set and return the length of the soft start [s]; None takes that of this round [s]."""
        begin = default if self.begin is None else self.begin
        if begin is None:
            begin = max(SHORTEST, 0.1 * round_time)
        self._set(begin=not_negative("begin", begin))
        return float(begin)

    def _lasting(self, round_time: float) -> float:
        """Return the time of a round [s], or of as many as it takes to begin, with the start."""
        half = 0.5 * (self.begin or 0.0)
        return half + round_time * max(1, math.ceil(half / round_time))
