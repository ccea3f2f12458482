"""A clamp of the velocity, and of the next positions, to their limits."""

import numpy as np

from benchmarks.hostile.serve import serve, velocity_of


def make(setup):
    """Return the filter."""
    lower, upper, velocity = setup["limits"][:3]

    def act(state, request, dt):
        dq = np.clip(np.nan_to_num(velocity_of(request, state, dt)), -velocity, velocity)
        return (np.clip(state["q"] + dt * dq, lower, upper) - state["q"]) / dt

    return act


serve(make)
