"""The surroundings of a drawn arm: floor, light, a sheet under the path, obstacles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from iiwa_dnn.results.record import Record
from iiwa_dnn.robot.mujoco_model import VISUAL_GROUP
from iiwa_dnn.robot.obstacles import HalfSpace, Obstacle, make_obstacle, outline
from iiwa_dnn.robot.robot import Robot
from iiwa_dnn.robot.shapes import visual_meshes

if TYPE_CHECKING:
    import mujoco

SCENERY_GROUP = 2
OBSTACLE_COLOR = (0.25, 0.45, 0.75)
_SCENERY = f"""
<mujoco>
  <visual>
    <headlight ambient="0.4 0.4 0.4" diffuse="0.3 0.3 0.3" specular="0.1 0.1 0.1"/>
  </visual>
  <statistic center="0 0 0.4" extent="1.2"/>
  <asset>
    <texture name="sky" type="skybox" builtin="flat" rgb1="1 1 1" rgb2="1 1 1"
      width="16" height="16"/>
    <texture name="tiles" type="2d" builtin="checker" rgb1="0.90 0.91 0.93" rgb2="0.84 0.86 0.89"
      width="256" height="256"/>
    <!-- A repeat has two tiles a side: they are 0.25 m wide. -->
    <material name="floor" texture="tiles" texuniform="true" texrepeat="2 2"/>
  </asset>
  <worldbody>
    <geom type="plane" size="1.25 1.25 0.1" material="floor" group="{SCENERY_GROUP}"
      contype="0" conaffinity="0"/>
    <light type="spot" pos="0.8 -0.6 2.6" dir="-0.25 0.2 -1" diffuse="0.55 0.55 0.55"
      cutoff="60" exponent="1"/>
  </worldbody>
</mujoco>
"""
_NO_CONTACT: dict[str, Any] = {"contype": 0, "conaffinity": 0}


def obstacles_of(record: Record) -> list[Obstacle]:
    """Return the obstacles of a record that can be drawn: no half-spaces."""
    tables = record.settings.get("collisions", {}).get("obstacles", [])
    made = map(make_obstacle, tables)
    return [obstacle for obstacle in made if not isinstance(obstacle, HalfSpace)]


def add_obstacles(mj: Any, spec: mujoco.MjSpec, record: Record) -> list[Obstacle]:
    """Add the obstacles of a record, each a mocap body that stands at its displacement."""
    obstacles = obstacles_of(record)
    for i, obstacle in enumerate(obstacles):
        vertices, faces = outline(obstacle)
        name = f"obstacle_{i}"
        spec.add_mesh(name=name, uservert=vertices.ravel(), userface=faces.ravel())
        spec.worldbody.add_body(name=name, mocap=True).add_geom(
            type=mj.mjtGeom.mjGEOM_MESH,
            meshname=name,
            rgba=[*OBSTACLE_COLOR, 1.0],
            group=SCENERY_GROUP,
            **_NO_CONTACT,
        )
    return obstacles


def add_meshes(mj: Any, spec: mujoco.MjSpec, robot: Robot) -> None:
    """Add the meshes of a robot, or sticks where it has no shapes; its primitives are there."""
    joints = {joint.name: joint.parent for joint in spec.joints}
    for i, mesh in enumerate(visual_meshes(robot)):
        spec.add_mesh(
            name=f"mesh_{i}",
            uservert=mesh.corners.ravel(),
            userface=mesh.faces.ravel(),
            inertia=mj.mjtMeshInertia.mjMESH_INERTIA_SHELL,
        )
        body = joints[robot.model.names[mesh.joint]] if mesh.joint else spec.worldbody
        body.add_geom(
            type=mj.mjtGeom.mjGEOM_MESH,
            meshname=f"mesh_{i}",
            rgba=[*mesh.color, 1.0],
            group=VISUAL_GROUP,
            **_NO_CONTACT,
        )


def make_scenery(mj: Any, record: Record) -> mujoco.MjSpec:
    """Make floor, light and, under a path in a horizontal plane, a sheet of paper."""
    spec = mj.MjSpec.from_string(_SCENERY)
    low = record.position_desired.min(axis=0)
    high = record.position_desired.max(axis=0)
    if high[2] - low[2] < 1e-3 < high[0] - low[0]:
        spec.worldbody.add_geom(  # a margin of 3 cm around the path, and 3 mm below it
            type=mj.mjtGeom.mjGEOM_BOX,
            size=[*(0.5 * (high - low)[:2] + 0.03), 1e-3],
            rgba=[1.0, 1.0, 0.97, 1.0],
            pos=[*(0.5 * (high + low)[:2]), low[2] - 3e-3],
            group=SCENERY_GROUP,
            **_NO_CONTACT,
        )
    return spec
