"""Preview of a chunk: its steps, taken without an arm before it moves."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import IntVector
from iiwa_dnn.step.samples import SHORTEST, FollowState

MISSED = 1e-3
"""Distance from a sample up to which it counts as reached [rad]."""

NEAR = 1e-4
"""Time before a chunk's last sample at which its clock, which comes to rest there, is there [s]."""

PATIENCE = 10.0
"""Time after its last sample until which a preview waits for a chunk [s]."""


class Preview(NamedTuple):
    """Forecast of a chunk before the arm moves: the samples that are missed, by how much and why.

    Attributes:
        sample: Number of the first sample that is more than `MISSED` off, or of a pose that is left
            out; None: all are reached.
        active_limits: What kept the arm off until then, in words; none: they are too quick.
        late: Largest time by which a sample is reached after its own [s].
        off: Largest distance of a joint from each sample when it is due by the clock, which may be
            late [rad], (m,). It is NaN for samples that are in the past, or not come to.
    """

    sample: int | None
    active_limits: tuple[str, ...]
    late: float
    off: Vector

    def among(self, places: IntVector, left_out: dict[int, str]) -> Preview:
        """Return the preview of all poses, from that of those at some places among them."""
        off = np.full(len(places) + len(left_out), np.nan)
        off[places] = self.off
        sample = None if self.sample is None else int(places[self.sample])
        whole = self._replace(sample=sample, off=off)
        first = min(left_out, default=off.size)
        if first < (off.size if sample is None else sample):
            return whole._replace(sample=first, active_limits=(left_out[first],))
        return whole


class Rehearsal:
    """Steps of a chunk that are taken without an arm, and the `Preview` that they lead to.

    Attributes:
        goes_on: Whether a sample is still to come.
        result: What was found.
    """

    def __init__(self, times: Vector, positions: Matrix) -> None:
        """Take times (m,) [s] and positions (m, n) [rad] of the samples."""
        self.goes_on = times.size > 0
        self.result = Preview(None, (), 0.0, np.full(times.size, np.nan))
        self._times = times
        self._positions = positions
        self._words: dict[str, None] = {}

    def take(self, own: FollowState, arm: Any, after: Any, words: tuple[str, ...]) -> None:
        """Take a step: what is followed, the `ArmState` before and after it, its active limits."""
        t = self._times
        if own.count + own.waiting == 0:  # refused, or the arm brakes
            self._words = dict.fromkeys(words)
            self.goes_on = False
            self._miss(np.flatnonzero(np.isnan(self.result.off)))
            return
        if own.waiting > 0:
            return
        if np.abs(after.positions - own.reference).max() > MISSED:
            self._words.update(dict.fromkeys(words))
        end = own.clock + (after.time - arm.time) * own.rate
        if end > t[-1] - NEAR:
            end = t[-1]
        reached = (t >= own.clock - SHORTEST) & (t <= end + SHORTEST) & np.isnan(self.result.off)
        for k in np.flatnonzero(reached):
            part = min(max(t[k] - own.clock, 0.0) / max(end - own.clock, SHORTEST), 1.0)
            q = arm.positions + part * (after.positions - arm.positions)
            self.result.off[k] = np.abs(q - self._positions[k]).max()
            late = arm.time + part * (after.time - arm.time) - t[k]
            self.result = self.result._replace(late=max(self.result.late, float(late)))
            if self.result.off[k] > MISSED:
                self._miss([k])
        if after.time > t[-1] + PATIENCE:
            self._miss(np.flatnonzero(t > end))
        self.goes_on = end < t[-1] and after.time <= t[-1] + PATIENCE

    def _miss(self, samples: ArrayLike) -> None:
        """Note the first of samples that are not reached, and what kept the arm from it."""
        if self.result.sample is None:
            first = int(np.asarray(samples)[0])
            self.result = self.result._replace(sample=first, active_limits=tuple(self._words))
