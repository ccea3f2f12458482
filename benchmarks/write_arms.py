"""Write the arms of benchmarks/hostile as data: ``python -m benchmarks.write_arms``."""

import json
from typing import Any

import numpy as np

import iiwa_dnn
from benchmarks.hostile.arms import FOLDER
from iiwa_dnn.robot.collision import collision_model

ARMS = {"iiwa7": 7.0, "fr3": 3.0}
"""Arms and their rated payloads [kg]."""

RATES = (10.0, 500.0)
"""Acceleration and jerk limits of an arm whose maker states none [rad/s^2, rad/s^3]."""


def describe(name: str, payload: float) -> dict[str, Any]:
    """Describe an arm: all numbers in SI units, in the frames of its joints."""
    robot = iiwa_dnn.load_robot(name)
    model = robot.model
    lower, upper, velocity, acceleration, jerk = robot.limits
    joints = []
    for i, joint in enumerate(tuple(model.names)[1:]):
        place, body = model.jointPlacements[i + 1], model.inertias[i + 1]
        axis = np.ravel(model.joints[i + 1].createData().S)[3:]
        joints.append(
            {
                "name": joint,
                "origin": place.translation.tolist(),
                "turn": place.rotation.tolist(),
                "axis": axis.tolist(),
                "lower": lower[i],
                "upper": upper[i],
                "velocity": velocity[i],
                "acceleration": acceleration[i] if np.isfinite(acceleration[i]) else RATES[0],
                "jerk": jerk[i] if np.isfinite(jerk[i]) else RATES[1],
                "torque": model.effortLimit[i],
                "mass": body.mass,
                "center": body.lever.tolist(),
                "inertia": body.inertia.tolist(),
            }
        )
    capsules = []
    for link, capsule in collision_model(robot).capsules:
        frame = model.frames[robot.frame_id(link)]
        if frame.parentJoint:
            ends = [frame.placement.act(np.array(end)).tolist() for end in (capsule.a, capsule.b)]
            capsules.append(
                {
                    "link": link,
                    "joint": frame.parentJoint - 1,
                    "a": ends[0],
                    "b": ends[1],
                    "radius": capsule.radius,
                }
            )
    tip = model.frames[robot.tip_id].placement
    reach = sum(float(np.linalg.norm(place.translation)) for place in [*model.jointPlacements, tip])
    return {
        "name": name,
        "payload": payload,
        "reach": reach,
        "start": robot.start_posture().tolist(),
        "tip": tip.translation.tolist(),
        "joints": joints,
        "capsules": capsules,
    }


if __name__ == "__main__":
    for name, payload in ARMS.items():
        text = json.dumps(describe(name, payload), indent=1)
        (FOLDER / f"{name}.json").write_text(text + "\n", encoding="utf-8")
