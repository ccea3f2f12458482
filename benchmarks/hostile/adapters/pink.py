"""Pink: a posture a step ahead, with its limits of configuration, velocity and acceleration."""

import sys

sys.path.pop(0)  # this file has the library's name
import numpy as np
import pink
import pinocchio as pin
from pink.limits import AccelerationLimit, ConfigurationLimit, VelocityLimit
from pink.tasks import PostureTask

from benchmarks.hostile.serve import serve, velocity_of


def make(setup):
    """Return the filter; spheres would need Pink's barriers and meshes, and are not known to it."""
    model = pin.buildModelFromXML(setup["urdf"])
    acceleration = AccelerationLimit(model, setup["limits"][3])
    limits = [ConfigurationLimit(model), VelocityLimit(model), acceleration]
    task = PostureTask(cost=1.0, gain=1.0)
    velocity = setup["limits"][2]

    def act(state, request, dt):
        dq = np.clip(np.nan_to_num(velocity_of(request, state, dt)), -velocity, velocity)
        conf = pink.Configuration(model, model.createData(), state["q"])
        task.set_target(state["q"] + dt * dq)
        acceleration.set_last_integration(state["last"], dt)
        try:
            return pink.solve_ik(conf, [task], dt, "daqp", limits=limits)
        except pink.exceptions.PinkError:
            return np.zeros_like(state["q"])

    return act


serve(make)
