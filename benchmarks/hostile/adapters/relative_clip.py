"""LeRobot's rule, its `max_relative_target`: a goal no further from the present than a stated way.

The way is what the velocity limit admits in a period, the largest that keeps it.
"""

import numpy as np

from benchmarks.hostile.serve import serve


def make(setup):
    """Return the filter."""
    velocity = setup["limits"][2]

    def act(state, request, dt):
        if request is None:
            return np.zeros_like(velocity)
        goal = request.get("position")
        if goal is None:
            goal = state["q"] + dt * request["velocity"]
        return np.clip(goal - state["q"], -dt * velocity, dt * velocity) / dt

    return act


serve(make)
