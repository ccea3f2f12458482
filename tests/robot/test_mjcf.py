"""MJCF files: frames, gravity and shapes are those of MuJoCo itself."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
import pytest

import iiwa_dnn
from iiwa_dnn.robot.mujoco_model import JointDynamics, compile_model
from iiwa_dnn.robot.shapes import read_shapes
from judge_limits import breaches

mujoco = pytest.importorskip("mujoco", reason="pip install 'iiwa-dnn[sim]'")

ARM = """
<mujoco model="desk_arm">
  <compiler angle="degree" autolimits="true" meshdir="assets"/>
  <default>
    <joint armature="0.1" damping="1"/>
    <position kp="400" dampratio="1"/>
    <default class="link"><geom type="capsule" size="0.04" mass="1.2"/></default>
  </default>
  <asset><mesh name="hook" file="hook.obj" scale="0.1 0.2 0.1"/></asset>
  <worldbody>
    <geom type="plane" size="1 1 0.1"/>
    <body name="base" pos="0.1 0.2 0.3" euler="10 20 30" childclass="link">
      <geom fromto="0 0 0 0 0 0.15" size="0.12"/>
      <site name="mark"/>
      <body name="upper" pos="0 0 0.2">
        <joint name="pan" axis="0 0 1" range="-160 160"/>
        <geom fromto="0 0 0 0.3 0 0"/>
        <geom type="box" size="0.02 0.03 0.04" pos="0.1 0 0.05" contype="0" conaffinity="0"/>
        <body pos="0.35 0 0" quat="0.9 0.02 0.3 0.01">
          <joint name="lift" pos="-0.05 0.01 0.02" axis="0 1 0.1" range="-150 150"
                 actuatorfrcrange="-30 20"/>
          <geom fromto="0 0 0 0 0 0.2"/>
          <geom type="mesh" mesh="hook" pos="0 0.1 0.1" euler="0 30 0" mass="0.3"/>
          <body name="tube" pos="0 0 0.3">
            <joint name="roll" axis="0 0 1"/>
            <geom type="cylinder" size="0.03 0.04"/>
            <body name="rod" pos="0 0 0.05">
              <joint name="out" type="slide" axis="0 0 1" range="0 0.2"/>
              <geom type="ellipsoid" size="0.02 0.03 0.05"/>
              <site name="grip" pos="0 0 0.1" euler="0 90 0"/>
              <body name="finger" pos="0.02 0 0.1">
                <joint name="finger" type="slide" axis="1 0 0" range="0 0.03"/>
                <geom type="sphere" size="0.01"/>
              </body>
            </body>
          </body>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator>
    <position joint="pan" forcerange="-100 100"/>
    <position joint="lift"/> <position joint="roll"/> <position joint="out" kp="1000"/>
  </actuator>
</mujoco>
"""
HOOK = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
SHAPES = 7  # that have contacts, but for the plane


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("mjcf")
    (folder / "assets").mkdir()
    (folder / "assets" / "hook.obj").write_text(HOOK, encoding="utf-8")
    (folder / "arm.xml").write_text(ARM, encoding="utf-8")
    return folder / "arm.xml"


@pytest.fixture(scope="module")
def robot(path: Path) -> iiwa_dnn.Robot:
    with (
        pytest.warns(UserWarning, match="held still.*finger at 0"),
        pytest.warns(UserWarning, match="a plane or .* state it as a HalfSpace"),
    ):
        return iiwa_dnn.load_robot(path, tip="grip")


def placed(path: Path, robot: iiwa_dnn.Robot, q: np.ndarray) -> tuple[Any, Any]:
    """MuJoCo's own model and data of a file at joint positions."""
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    for name, value in zip(robot.joint_names, q, strict=True):
        data.qpos[model.joint(name).qposadr[0]] = value
    mujoco.mj_forward(model, data)
    return model, data


def test_frames_and_gravity_are_mujocos(path: Path, robot: iiwa_dnn.Robot) -> None:
    random = np.random.default_rng(0)
    for _ in range(10):
        q = random.uniform(np.maximum(robot.q_lower, -3.0), np.minimum(robot.q_upper, 3.0))
        model, data = placed(path, robot, q)
        conf = iiwa_dnn.Configuration(robot, q)
        for name in ("base", "upper", "tube", "rod", "finger"):
            frame = conf.frame(name)
            np.testing.assert_allclose(frame.position, data.body(name).xpos, atol=1e-12)
            own = data.body(name).xmat.reshape(3, 3)
            np.testing.assert_allclose(frame.rotation, own, atol=1e-12)
        np.testing.assert_allclose(conf.position, data.site("grip").xpos, atol=1e-12)
        own = data.site("grip").xmat.reshape(3, 3)
        np.testing.assert_allclose(conf.rotation, own, atol=1e-12)
        torque = pin.computeGeneralizedGravity(robot.model, robot.model.createData(), q)
        dofs = [model.joint(name).dofadr[0] for name in robot.joint_names]
        np.testing.assert_allclose(torque, data.qfrc_bias[dofs], atol=1e-10)


def test_limits_are_the_files(robot: iiwa_dnn.Robot) -> None:
    assert robot.joint_names == ("pan", "lift", "roll", "out")
    np.testing.assert_allclose(robot.q_lower, [*np.radians([-160, -150]), -np.inf, 0.0])
    np.testing.assert_allclose(robot.q_upper, [*np.radians([160, 150]), np.inf, 0.2])
    assert np.isinf(robot.dq_max).all()
    np.testing.assert_allclose(robot.model.effortLimit, [100.0, 30.0, 0.0, 0.0])


def test_shapes_are_where_mujoco_has_them(path: Path, robot: iiwa_dnn.Robot) -> None:
    q = np.array([0.5, 0.3, 1.0, 0.1])
    model, data = placed(path, robot, q)
    pinned = robot.model.createData()
    pin.framesForwardKinematics(robot.model, pinned, q)
    found = []
    for shape in read_shapes(robot, pin.GeometryType.COLLISION).geometryObjects:
        pose = pinned.oMi[shape.parentJoint] * shape.placement
        box = shape.geometry
        box.computeLocalAABB()
        found.append(pose.act(box.aabb_center))
    centers = np.array(found)
    kinds = [mujoco.mjtGeom(kind).name[7:].lower() for kind in model.geom_type]
    for number, kind in enumerate(kinds):
        if kind == "plane" or not model.geom_contype[number]:
            continue
        own = data.geom_xpos[number]
        turn = data.geom_xmat[number].reshape(3, 3)
        if kind == "mesh":
            points = model.mesh_vert @ turn.T + own  # whose box along the file's axes
            frame = turn @ pin.Quaternion(*model.mesh_quat[0]).matrix().T
            inside = points @ frame
            own = frame @ (inside.min(axis=0) + inside.max(axis=0)) / 2.0
        assert np.abs(centers - own).max(axis=1).min() < 1e-6, (number, kind)
    assert len(found) == SHAPES
    (box,) = read_shapes(robot, pin.GeometryType.VISUAL).geometryObjects
    np.testing.assert_allclose(box.geometry.halfSide, [0.02, 0.03, 0.04])


def test_the_arm_keeps_apart_and_moves_in_physics(robot: iiwa_dnn.Robot) -> None:
    bounded = robot.with_limits(velocity=1.0, acceleration=5.0)
    shield = iiwa_dnn.Shield(bounded, obstacles=[])
    assert np.isfinite(shield.step(bounded.start_posture()).margin.distance)
    model = compile_model(robot, 1e-3, JointDynamics())
    assert model.nv == 4
    own = mujoco.MjModel.from_xml_path(str(robot.path))
    masses = [each.body_mass[each.body_weldid > 0].sum() for each in (model, own)]
    assert masses[0] == pytest.approx(masses[1])


def test_a_gear_is_in_the_torque_limit(tmp_path: Path) -> None:
    body = '<body><joint name="a" range="-1 1"/><geom size="0.1"/></body>'
    motor = '<motor joint="a" gear="50" forcerange="-2 1"/>'
    file = tmp_path / "arm.xml"
    text = f"<mujoco><worldbody>{body}</worldbody><actuator>{motor}</actuator></mujoco>"
    file.write_text(text, encoding="utf-8")
    assert iiwa_dnn.load_robot(file).model.effortLimit.tolist() == [100.0]


def test_without_mujoco_the_file_is_refused(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(iiwa_dnn.MissingDependencyError, match=r"iiwa-dnn\[sim\]"):
        iiwa_dnn.load_robot(path, tip="grip")


BALL = '<joint name="wrist" type="ball"/><geom size="0.1"/>'
FOLLOWING = """
<body name="a"><joint name="one" axis="0 0 1" range="-1 1"/><geom size="0.1"/>
<body name="b" pos="0 0 1"><joint name="two" axis="0 1 0" range="-1 1"/><geom size="0.1"/>
</body></body>
"""


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (f"<worldbody><body>{BALL}</body></worldbody>", "'wrist' is a ball"),
        ("<worldbody><body><joint/></body></worldbody>", "no MJCF that MuJoCo can read: .*mass"),
        ("<worldbod/>", "no MJCF"),
        (
            f"<worldbody>{FOLLOWING}</worldbody>"
            '<equality><joint joint1="two" joint2="one"/></equality>',
            "'two' follows 'one'",
        ),
        ("<worldbody><body><freejoint/><geom size='0.1'/></body></worldbody>", "7 coordinates"),
    ],
    ids=["ball", "no mass", "no MJCF", "following", "free"],
)
def test_what_is_no_arm_is_refused_by_name(tmp_path: Path, text: str, words: str) -> None:
    file = tmp_path / "arm.xml"
    file.write_text(f"<mujoco>{text}</mujoco>", encoding="utf-8")
    with pytest.raises(iiwa_dnn.IiwaDnnError, match=words):
        iiwa_dnn.load_robot(file)


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(iiwa_dnn.FileError, match=r"arm\.xml"):
        iiwa_dnn.load_robot(tmp_path / "arm.xml")


def test_the_script_moves_the_arm_by_mujocos_own_actuators(path: Path) -> None:
    from scripts import mjcf_arm

    with pytest.warns(UserWarning, match="finger"):
        robot, found, goals = mjcf_arm.run(path, 2.0, tip="grip")
    assert breaches(goals, mjcf_arm.DT, *robot.limits, at_rest=False) == []
    assert np.abs(found - goals).max() < 0.1
    assert np.ptp(found, axis=0).max() > 0.03
