"""Ruckig: its velocity interface, and for positions its position interface."""

import sys

sys.path.pop(0)  # this file has the library's name
import numpy as np
import ruckig

from benchmarks.hostile.serve import serve


def make(setup):
    """Return the filter."""
    lower, upper, velocity, acceleration, jerk = setup["limits"][:5]
    otg = ruckig.Ruckig(len(lower), setup["dt"])
    given, found = ruckig.InputParameter(len(lower)), ruckig.OutputParameter(len(lower))
    given.synchronization = ruckig.Synchronization.No
    given.max_velocity, given.max_acceleration, given.max_jerk = velocity, acceleration, jerk
    given.current_velocity = given.target_velocity = np.zeros(len(lower))
    kinds = ruckig.ControlInterface

    def act(state, request, dt):
        otg.delta_time = dt
        given.current_position = state["q"]
        wanted = request or {"velocity": np.zeros(len(lower))}
        if "position" in wanted:
            given.control_interface = kinds.Position
            goal = np.nan_to_num(wanted["position"])
            given.target_position = np.clip(goal, lower, upper)
            given.target_velocity = np.zeros(len(lower))
        else:
            given.control_interface = kinds.Velocity
            given.target_velocity = np.clip(np.nan_to_num(wanted["velocity"]), -velocity, velocity)
        if otg.update(given, found) in (ruckig.Result.Working, ruckig.Result.Finished):
            given.current_velocity = found.new_velocity
            given.current_acceleration = found.new_acceleration
            return (np.array(found.new_position) - state["q"]) / dt
        return np.array(given.current_velocity)

    return act


serve(make)
