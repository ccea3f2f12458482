"""Robots in xacro and MJCF, on a mobile base, and with meshes."""

from __future__ import annotations

import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import mujoco
import numpy as np
import pinocchio as pin
import pytest

from iiwa_dnn import (
    Configuration,
    CrossCheck,
    DoubleIndicator,
    Line,
    compute_metrics,
    failures,
    load_robot,
    simulate,
)
from iiwa_dnn.errors import FileError, MissingDependencyError
from iiwa_dnn.robot import urdf
from iiwa_dnn.robot.mujoco_model import compile_model
from iiwa_dnn.robot.shapes import visual_shapes

XACRO = """<?xml version="1.0"?>
<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="three">
  <xacro:property name="length" value="0.3"/>
  <xacro:macro name="segment" params="n parent">
    <link name="link_${n}"/>
    <joint name="joint_${n}" type="revolute">
      <parent link="${parent}"/> <child link="link_${n}"/>
      <origin xyz="${length if n > 1 else 0} 0 0"/> <axis xyz="0 0 1"/>
      <limit lower="-2" upper="2" effort="1" velocity="1"/>
    </joint>
  </xacro:macro>
  <link name="base"/>
  <xacro:segment n="1" parent="base"/>
  <xacro:segment n="2" parent="link_1"/>
  <xacro:segment n="3" parent="link_2"/>
</robot>
"""
MJCF = """<mujoco model="arm">
  <compiler angle="degree"/>
  <default> <joint range="-120 120" limited="true"/> </default>
  <worldbody>
    <body name="base" pos="0 0 0.1"> <geom type="cylinder" size="0.05 0.1"/>
      <body name="upper" pos="0 0 0.1" euler="10 0 20">
        <joint name="yaw" axis="0 0 1"/> <joint name="pitch" axis="0 1 0" pos="0 0.02 0.1"/>
        <geom type="capsule" fromto="0 0 0 0.3 0 0.2" size="0.04"/>
        <body name="fore" pos="0.3 0 0.2">
          <joint name="elbow" axis="0 1 0.1"/>
          <geom type="box" size="0.1 0.02 0.02" pos="0.1 0 0"/>
          <body name="hand" pos="0.2 0 0" quat="0.9 0.1 0.2 0.3">
            <joint name="slide" type="slide" axis="1 0 0" range="0 0.1"/>
            <geom type="sphere" size="0.03"/>
          </body>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator> <motor joint="elbow" forcerange="-30 30"/> </actuator>
</mujoco>
"""


def written(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.write_text(text)
    return path


def test_a_xacro_file_is_expanded(tmp_path: Path) -> None:
    robot = load_robot(str(written(tmp_path, "three.xacro", XACRO)))
    assert robot.joint_names == ("joint_1", "joint_2", "joint_3")
    reached = Configuration(robot, [0.4, -0.1, 0.0]).position
    bent = 0.3 * np.array([np.cos(0.4) + np.cos(0.3), np.sin(0.4) + np.sin(0.3), 0.0])
    np.testing.assert_allclose(reached, bent, atol=1e-15)
    damaged = written(tmp_path, "damaged.xacro", XACRO.replace("${length if", "${lenght if"))
    with pytest.raises(FileError, match=r"xacro cannot expand it: .*lenght"):
        load_robot(damaged)


def test_without_xacro_the_extra_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "xacro", None)
    with pytest.raises(MissingDependencyError, match="xacro"):
        load_robot(written(tmp_path, "three.xacro", XACRO))


def test_an_mjcf_arm_is_the_one_that_mujoco_and_pinocchio_read(tmp_path: Path) -> None:
    path = written(tmp_path, "arm.xml", MJCF)
    robot = load_robot(path)
    assert (robot.tip, robot.joint_names) == ("hand", ("yaw", "pitch", "elbow", "slide"))
    np.testing.assert_allclose(robot.q_upper, [*[np.radians(120.0)] * 3, 0.1])
    assert np.isinf(robot.dq_max).all()
    assert robot.model.effortLimit.tolist() == [0.0, 0.0, 30.0, 0.0]
    model, other = mujoco.MjModel.from_xml_path(str(path)), pin.buildModelFromMJCF(str(path))
    physics = compile_model(robot, 1e-3)
    rng, data, ours = np.random.default_rng(3), mujoco.MjData(model), mujoco.MjData(physics)
    for q in rng.uniform(robot.q_lower, robot.q_upper, (5, 4)):
        conf = Configuration(robot, q)
        data.qpos[:] = ours.qpos[:] = q
        mujoco.mj_forward(model, data)
        mujoco.mj_forward(physics, ours)
        np.testing.assert_allclose(conf.position, data.body("hand").xpos, atol=1e-14)
        np.testing.assert_allclose(conf.rotation.ravel(), data.body("hand").xmat, atol=1e-14)
        np.testing.assert_allclose(ours.body("hand").xpos, conf.position, atol=1e-14)
        # The links of no length between two joints of a body weigh a milligram each.
        gravity = pin.computeGeneralizedGravity(other, other.createData(), q)
        np.testing.assert_allclose(data.qfrc_bias, gravity, atol=1e-9)
        np.testing.assert_allclose(ours.qfrc_bias, gravity, atol=1e-4)
    assert [shape.kind for shape in visual_shapes(robot)] == [
        "cylinder",
        "cylinder",
        "box",
        "sphere",
    ]


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        (
            ('type="slide" axis="1 0 0" range="0 0.1"', 'type="ball" limited="false" range="0 0"'),
            "no hinge",
        ),
        (('name="yaw"', 'name="yaw" ref="30"'), "begins at"),
        (('type="sphere"', 'type="sfere"'), "MuJoCo refuses it"),
    ],
)
def test_an_mjcf_file_that_does_not_fit_is_told(
    change: tuple[str, str], problem: str, tmp_path: Path
) -> None:
    with pytest.raises(FileError, match=problem):
        load_robot(written(tmp_path, "arm.xml", MJCF.replace(*change)))


def test_a_mobile_base_moves_in_the_plane() -> None:
    fixed, mobile = load_robot("iiwa7"), load_robot("iiwa7", mobile=True)
    assert mobile.joint_names == ("base_x", "base_y", "base_yaw", *fixed.joint_names)
    assert np.isinf(mobile.q_upper[:3]).all()
    assert mobile.dq_max[:3].tolist() == [1.0, 1.0, 1.0]
    q = np.array(fixed.start_posture())
    turn = pin.rpy.rpyToMatrix(0.0, 0.0, 0.7)
    moved, stood = Configuration(mobile, [0.5, -0.3, 0.7, *q]), Configuration(fixed, q)
    np.testing.assert_allclose(moved.position, turn @ stood.position + [0.5, -0.3, 0.0], atol=1e-14)
    np.testing.assert_allclose(moved.rotation, turn @ stood.rotation, atol=1e-14)
    assert compile_model(mobile, 1e-3).nq == 10
    assert len(visual_shapes(mobile)) == len(visual_shapes(fixed))


def test_base_and_arm_follow_a_path_that_the_arm_alone_does_not_reach() -> None:
    robot = load_robot("iiwa7", mobile=True)
    start = Configuration(robot, [0.0, 0.0, 0.0, *load_robot("iiwa7").start_posture()])
    line = Line(offset=(1.5, 1.0, 0.0), period=10.0).anchored(start)
    check = CrossCheck(("proxqp",))
    record = simulate(robot, DoubleIndicator(), line, start.q, dt=5e-3, duration=5.0, check=check)
    assert failures(record) == []
    assert compute_metrics(record)["max_position_error_m"] < 1e-3
    assert np.linalg.norm(record.q[-1, :2]) > 0.5


def test_moments_of_inertia_that_no_body_has_are_raised() -> None:
    text = '<robot><link><inertial><inertia ixx="1" iyy="1e-9" izz="0"/></inertial></link></robot>'
    root = ET.fromstring(text)
    urdf.mend_inertias(root)
    inertia = root.find("link/inertial/inertia")
    assert inertia is not None
    assert [float(inertia.get(k, "0")) for k in ("ixx", "iyy", "izz")] == [1.0, 0.51, 0.51]


def test_meshes_are_read_and_missing_ones_are_not_missed(tmp_path: Path) -> None:
    (tmp_path / "meshes").mkdir()
    solid = "\n".join(
        f"facet normal 0 0 0\nouter loop\n{''.join(f'vertex {v}{chr(10)}' for v in face)}"
        "endloop\nendfacet"
        for face in (
            ("0 0 0", "0 1 0", "1 0 0"), ("0 0 0", "1 0 0", "0 0 1"),
            ("0 0 0", "0 0 1", "0 1 0"), ("1 0 0", "0 1 0", "0 0 1"),
        )
    )  # fmt: skip
    written(tmp_path / "meshes", "corner.stl", f"solid corner\n{solid}\nendsolid corner\n")
    text = """<robot name="one"> <link name="base"/> <link name="link"> <visual>
      <geometry> <mesh filename="package://meshes/corner.stl" scale="0.1 0.1 0.2"/> </geometry>
      </visual> </link> <joint name="joint" type="continuous"> <parent link="base"/>
      <child link="link"/> <origin xyz="0 0 0.4"/> <axis xyz="0 0 1"/> </joint> </robot>"""
    (shape,) = visual_shapes(load_robot(written(tmp_path, "one.urdf", text)))
    assert shape.kind == "mesh"
    assert shape.mesh is not None
    corners, faces = shape.mesh
    assert faces.shape == (4, 3)
    np.testing.assert_allclose(np.ptp(corners[faces].reshape(-1, 3), axis=0), [0.1, 0.1, 0.2])
    missing = text.replace("corner.stl", "nothing.stl")
    (stick,) = visual_shapes(load_robot(written(tmp_path, "none.urdf", missing)))
    assert stick.kind == "cylinder"
