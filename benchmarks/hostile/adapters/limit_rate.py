"""``franka::limitRate`` of seven joint velocities, which pylibfranka holds inside."""

import ctypes
from pathlib import Path

import numpy as np
import pylibfranka

from benchmarks.hostile.serve import serve, softly

NAME = "_ZN6franka9limitRateERKSt5arrayIdLm7EES3_S3_S3_S3_S3_S3_"


def make(setup):
    """Return the filter; its period is 1 ms, so times are in units of dt / 1 ms."""
    limit_rate = getattr(ctypes.CDLL(str(Path(pylibfranka.__file__).parent / "libfranka.so")), NAME)
    velocity, acceleration, jerk = setup["limits"][2:5]
    unit = setup["dt"] / 1e-3
    numbers = np.zeros((8, 7))  # of the call: the command, and seven arguments
    jerk = np.minimum(jerk, acceleration / setup["dt"])  # with more it is not stable
    bounds = (velocity, -velocity, acceleration, jerk)
    for row, limit, power in zip(numbers[1:5], bounds, (1, 1, 2, 3), strict=True):
        row[:] = limit * unit**power
    pointers = [ctypes.c_void_p(row.ctypes.data) for row in numbers]

    def act(state, request, dt):
        numbers[5] = unit * np.clip(
            np.nan_to_num(softly(request, state, dt, acceleration)), -1e6, 1e6
        )
        limit_rate(*pointers)
        numbers[7] = (numbers[0] - numbers[6]) / 1e-3
        numbers[6] = numbers[0]
        return numbers[0] / unit

    return act


serve(make)
