"""klimits: the range of accelerations after which all limits of a joint can be kept."""

import sys

sys.path.pop(0)  # this file has the library's name
import numpy as np
from klimits import PosVelJerkLimitation

from benchmarks.hostile.serve import serve, softly


def make(setup):
    """Return the filter: of that range, the acceleration that comes nearest to the velocity."""
    lower, upper, velocity, acceleration, jerk = setup["limits"][:5]
    step = setup["dt"]
    bounds = [[[-limit, limit] for limit in rows] for rows in (velocity, acceleration, jerk)]
    ranges = PosVelJerkLimitation(
        time_step=step,
        pos_limits=np.stack([lower, upper], axis=1).tolist(),
        vel_limits=bounds[0],
        acc_limits=bounds[1],
        jerk_limits=bounds[2],
        acceleration_after_max_vel_limit_factor=0.0001,
        normalize_acc_range=False,
        num_threads=1,
    )
    now = {"dq": np.zeros(len(lower)), "ddq": np.zeros(len(lower))}

    def act(state, request, dt):
        dq = np.clip(np.nan_to_num(softly(request, state, dt, acceleration)), -velocity, velocity)
        found, _ = ranges.calculate_valid_acceleration_range(state["q"], now["dq"], now["ddq"])
        least, most = np.array(found).T
        # The acceleration runs linearly to its new value, so the velocity changes by their mean.
        wanted = 2.0 * (dq - now["dq"]) / step - now["ddq"]
        ddq = np.clip(wanted, least, most)
        change = 0.5 * (now["ddq"] + ddq)
        way = now["dq"] * step + (now["ddq"] / 3.0 + ddq / 6.0) * step**2
        now["dq"] = now["dq"] + change * step
        now["ddq"] = ddq
        return way / step

    return act


serve(make)
