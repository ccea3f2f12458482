"""mink: a posture a step ahead, its limits of configuration and velocity, and of distances."""

import sys

sys.path.pop(0)  # this file has the library's name
import mink
import mujoco
import numpy as np

from benchmarks.hostile.serve import serve, velocity_of


def words(values):
    """Write numbers side by side."""
    return " ".join(map(repr, map(float, values)))


def scene(setup):
    """Write the arm and its spheres as MJCF."""
    arm = setup["arm"]
    text = '<mujoco><compiler angle="radian"/><worldbody>'
    for k, (center, radius) in enumerate(zip(setup["spheres"], setup["radii"], strict=True)):
        text += f'<body name="s{k}" mocap="true" pos="{words(center)}">'
        text += f'<geom name="sphere{k}" type="sphere" size="{radius}"/></body>'
    for i, joint in enumerate(arm["joints"]):
        quat = np.empty(4)
        mujoco.mju_mat2Quat(quat, np.ravel(joint["turn"]))
        text += f'<body name="link{i}" pos="{words(joint["origin"])}" quat="{words(quat)}">'
        text += '<inertial pos="0 0 0" mass="1" diaginertia="0.1 0.1 0.1"/>'
        text += f'<joint name="{joint["name"]}" axis="{words(joint["axis"])}" limited="true" '
        text += f'range="{joint["lower"]!r} {joint["upper"]!r}"/>'
        for c, capsule in enumerate(arm["capsules"]):
            if capsule["joint"] == i:
                text += f'<geom name="capsule{c}" type="capsule" size="{capsule["radius"]}" '
                ends = np.array([capsule["a"], capsule["b"]])
                ends[1, 2] += 1e-4 * (np.linalg.norm(ends[1] - ends[0]) < 1e-4)
                text += f'fromto="{words(ends.ravel())}"/>'
    return text + "</body>" * len(arm["joints"]) + "</worldbody></mujoco>"


def make(setup):
    """Return the filter."""
    model = mujoco.MjModel.from_xml_string(scene(setup))
    conf = mink.Configuration(model)
    velocity = setup["limits"][2]
    names = [joint["name"] for joint in setup["arm"]["joints"]]
    limits = [mink.ConfigurationLimit(model)]
    limits.append(mink.VelocityLimit(model, dict(zip(names, velocity, strict=True))))
    if len(setup["radii"]):
        capsules = [f"capsule{c}" for c in range(len(setup["arm"]["capsules"]))]
        spheres = [f"sphere{k}" for k in range(len(setup["radii"]))]
        keep = setup["distance"]
        pairs = [(capsules, spheres)]
        limits.append(
            mink.CollisionAvoidanceLimit(
                model,
                pairs,
                minimum_distance_from_collisions=keep,
                collision_detection_distance=0.3,
            )
        )
    task = mink.PostureTask(model, cost=1.0, gain=1.0)

    def act(state, request, dt):
        dq = np.clip(np.nan_to_num(velocity_of(request, state, dt)), -velocity, velocity)
        conf.data.mocap_pos[:] = state["spheres"].reshape(-1, 3)
        conf.update(state["q"])
        task.set_target(state["q"] + dt * dq)
        try:
            return mink.solve_ik(conf, [task], dt, "daqp", limits=limits)
        except mink.MinkError:
            return np.zeros_like(state["q"])

    return act


serve(make)
