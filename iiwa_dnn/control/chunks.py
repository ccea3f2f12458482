"""Chunks and streams as steps are given them, checked."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import Vector
from iiwa_dnn.step.requests import Request
from iiwa_dnn.step.samples import SHORTEST, FollowState, Mode

SAMPLES = 64
"""Largest number of samples of a chunk, where none is stated; a stream takes four."""

AHEAD = 600.0
"""Time from now on up to which a chunk may reach [s]; beyond, its times are of another clock."""

KEEPS = {"time": Mode.TIME, "path": Mode.PATH}
"""Modes of a chunk by what it keeps."""


def follow_width(n: int, samples: int) -> int:
    """Count the numbers of a `FollowState` of n joints; 0 without samples."""
    return FollowState.width(n, samples, n * samples) if samples else 0


def checked_times(times: ArrayLike, most: int) -> Vector:
    """Return the times (m,) [s] of a chunk, m at most `most`, which may be NaN.

    Raises:
        InvalidInputError: They are no list, do not rise, or are too many.
    """
    t = checks.array("times", times, (-1,))
    if not 1 <= t.size <= most:
        raise InvalidInputError("times", f"must be 1 to {most}, not {t.size}", times)
    steps = np.diff(t)
    if (steps < SHORTEST).any():
        k = int(np.argmax(steps < SHORTEST))
        problem = f"must rise: {t[k + 1]:g} s comes after {t[k]:g} s"
        raise InvalidInputError("times", problem, times)
    return t


def check_clock(times: Vector, now: float) -> None:
    """Refuse times (m,) of a chunk that are most likely on another clock, or in ms.

    Args:
        times: They, on the arm's clock [s].
        now: Present time on it [s].

    Raises:
        InvalidInputError: They reach farther than `AHEAD`.
    """
    if times[-1] - now > AHEAD:
        problem = f"reach {times[-1] - now:g} s ahead: state now= for another clock, and seconds"
        raise InvalidInputError("times", problem, times)


def stream_mode(kind: Request, lead: int | None, samples: int) -> int:
    """Return the `Mode` of a stream with a lead; None stands for 1.

    Raises:
        InvalidInputError: The request is of another kind, or the shield follows no samples.
    """
    if kind is not Request.POSITION or not samples:
        raise InvalidInputError("time, lead", "belong to a position of a shield with samples", lead)
    return Mode.STREAM + (1 if lead is None else checks.one_of("lead", lead, (0, 1, 2)))
