"""mink's loop on MuJoCo: a frame task and a weak posture task in one cost, with limits."""

from pathlib import Path

import mink
import mujoco
from serve import Loop, Task, serve

# MuJoCo merges bodies without a joint, the tip among them, unless told not to.
_COMPILER = '<mujoco><compiler fusestatic="false" discardvisual="true"/></mujoco></robot>'


def make(task: Task, variant: str) -> Loop:
    """Make the loop; the variant names a solver of qpsolvers."""
    urdf = Path(str(task["urdf"])).read_text(encoding="utf-8")
    spec = mujoco.MjSpec.from_string(urdf.replace("</robot>", _COMPILER))
    pairs = add_scene(spec, task) if "balls" in task else None
    model = spec.compile()
    model.jnt_range[:, 0] = task["lower"]
    model.jnt_range[:, 1] = task["upper"]
    configuration = mink.Configuration(model, q=task["q0"].copy())
    dt = float(task["dt"])
    frame = mink.FrameTask(str(task["tip"]), "body", position_cost=1.0, orientation_cost=1.0)
    posture = mink.PostureTask(model, cost=1e-3)
    posture.set_target(task["q0"])
    names = [str(name) for name in task["names"]]
    velocities = dict(zip(names, task["velocity"].tolist(), strict=True))
    limits = [mink.ConfigurationLimit(model), mink.VelocityLimit(model, velocities)]
    if pairs is not None:
        near = float(task["distance"])
        avoid = mink.CollisionAvoidanceLimit(
            model,
            [pairs],
            gain=20.0 * dt,
            minimum_distance_from_collisions=near,
            collision_detection_distance=near + 0.2,
        )
        limits.append(avoid)
    tasks = [frame, posture]
    wanted = [mink.SE3.from_matrix(pose) for pose in task["poses"]]

    def step(k: int) -> None:
        frame.set_target(wanted[k + 1])
        velocity = mink.solve_ik(configuration, tasks, dt, solver=variant, limits=limits)
        configuration.integrate_inplace(velocity, dt)

    return step, lambda: configuration.q


def add_scene(spec: mujoco.MjSpec, task: Task) -> tuple[list[str], list[str]]:
    """Replace the shapes by the task's capsules and balls; returns the names of both."""
    for geom in list(spec.geoms):
        spec.delete(geom)
    capsules = zip(task["links"], task["a"], task["b"], task["radii"], strict=True)
    for link, a, b, radius in capsules:
        ends = [*a, *(b + [0, 0, 1e-6])]
        spec.body(str(link)).add_geom(
            name=f"shape_{link}",
            type=mujoco.mjtGeom.mjGEOM_CAPSULE,
            fromto=ends,
            size=[radius, 0, 0],
        )
    for k, (center, radius) in enumerate(zip(task["balls"], task["ball_radii"], strict=True)):
        size = [radius, 0, 0]
        kind = mujoco.mjtGeom.mjGEOM_SPHERE
        spec.worldbody.add_geom(name=f"ball_{k}", type=kind, pos=center, size=size)
    return [f"shape_{link}" for link in task["links"]], [f"ball_{k}" for k in range(k + 1)]


if __name__ == "__main__":
    serve(make)
