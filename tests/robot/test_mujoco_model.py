"""The arm in MuJoCo against the arm in Pinocchio: two readers of one URDF, two dynamics."""

import dataclasses

import numpy as np
import pinocchio as pin
import pytest

from helpers_kinematics import example_urdf
from iiwa_dnn import Configuration, InvalidInputError, load_robot
from iiwa_dnn.robot.arms import ARMS
from iiwa_dnn.robot.mujoco_model import (
    TIP_SITE,
    JointDynamics,
    build_spec,
    compile_model,
    torque_limits,
)

mujoco = pytest.importorskip("mujoco", reason="pip install 'iiwa-dnn[sim]'")

DYNAMICS = JointDynamics(damping=0.3, armature=0.07)


@pytest.fixture(scope="module")
def robot():
    return load_robot("iiwa7")


def inertia(model, data) -> np.ndarray:
    """Joint-space inertia, column by column."""
    columns = np.zeros((model.nv, model.nv))
    for column, unit in zip(columns, np.eye(model.nv), strict=True):
        mujoco.mj_mulM(model, data, column, unit)
    return columns.T


def test_kinematics_and_dynamics_are_pinocchios(robot):
    model = compile_model(robot, 1e-3, DYNAMICS)
    data = mujoco.MjData(model)
    nominal = robot.model.copy()
    nominal.armature = np.full(robot.dof, DYNAMICS.armature)
    scratch = nominal.createData()
    rng = np.random.default_rng(0)
    for _ in range(200):
        q = rng.uniform(robot.q_lower, robot.q_upper)
        dq = rng.uniform(-1.0, 1.0, robot.dof) * robot.dq_max
        data.qpos[:], data.qvel[:] = q, dq
        mujoco.mj_forward(model, data)
        conf = Configuration(robot, q)
        tip = data.site(TIP_SITE)
        np.testing.assert_allclose(tip.xpos, conf.position, atol=1e-12)
        np.testing.assert_allclose(tip.xmat.reshape(3, 3), conf.rotation, atol=1e-12)
        np.testing.assert_allclose(inertia(model, data), pin.crba(nominal, scratch, q), atol=1e-12)
        bias = pin.rnea(nominal, scratch, q, dq, np.zeros(robot.dof))
        np.testing.assert_allclose(data.qfrc_bias, bias, atol=1e-10)
        np.testing.assert_allclose(data.qfrc_passive, -DYNAMICS.damping * dq, atol=1e-12)


def test_motors_and_stops_are_the_data_sheets_and_links_do_not_collide(robot):
    limit = np.array([176.0, 176.0, 110.0, 110.0, 110.0, 40.0, 40.0])
    np.testing.assert_array_equal(torque_limits(robot), limit)
    model = compile_model(robot.with_limits(lower=-1.0, upper=1.0), 1e-3, DYNAMICS)
    np.testing.assert_allclose(model.jnt_range, robot.limits[:2].T)  # whatever a controller keeps
    assert model.jnt_limited.all()
    data = mujoco.MjData(model)
    data.qpos[:] = [0.0, 2.0, 0.0, -2.0, 0.0, 1.5, 0.0]  # folded back on its own base
    for command, torque in ((1e3, limit), (-0.5 * limit, -0.5 * limit)):
        data.ctrl[:] = command
        mujoco.mj_forward(model, data)
        np.testing.assert_allclose(data.qfrc_actuator, torque)
    assert data.ncon == 0


@pytest.mark.parametrize(
    ("name", "also"),
    [
        ("iiwa7_dual", ()),
        ("tiago", ()),
        ("panda", ("panda_joint4",)),  # at -0.07, the limit nearest to zero
        ("talos_left_arm", ()),
        ("baxter_left", ()),
        ("talos_right", ()),
        ("kinova", ()),
        ("iiwa7", ("iiwa7_joint_3", "iiwa7_joint_7")),
    ],
)
def test_locked_joints_are_welded(name, also):
    if not name.startswith("iiwa7"):
        example_urdf(ARMS[name].file)
    robot = load_robot(name, locked=also)
    model = compile_model(robot, 1e-3, JointDynamics(0.0, 0.0))
    data, scratch = mujoco.MjData(model), robot.model.createData()
    assert (model.nq, model.nv, model.neq) == (robot.dof, robot.dof, 0)
    for q in np.random.default_rng(4).uniform(
        robot.q_lower.clip(-9), robot.q_upper.clip(max=9), (20, robot.dof)
    ):
        data.qpos[:] = q
        mujoco.mj_forward(model, data)
        np.testing.assert_allclose(
            data.site(TIP_SITE).xpos, Configuration(robot, q).position, atol=1e-12
        )
        mass = pin.crba(robot.model, scratch, q)
        assert np.abs(inertia(model, data) - mass).max() < 1e-9 * np.abs(mass).max()
        weight = pin.computeGeneralizedGravity(robot.model, scratch, q)
        assert np.abs(data.qfrc_bias - weight).max() < 1e-9 * np.abs(weight).max()


def test_robots_that_cannot_be_had_in_physics(robot, tmp_path):
    with pytest.raises(InvalidInputError, match="must come from a URDF file"):
        build_spec(dataclasses.replace(robot, path=None))
    (tmp_path / "light.urdf").write_text(
        '<robot name="light"><link name="a"/><link name="b"/><joint name="j" type="revolute">'
        '<parent link="a"/><child link="b"/><axis xyz="0 0 1"/>'
        '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>'
    )
    with pytest.raises(InvalidInputError, match=r"MuJoCo refuses its URDF: .*mjMINVAL"):
        compile_model(load_robot(tmp_path / "light.urdf"), 1e-3, DYNAMICS)
