"""The arm in MuJoCo against the arm in Pinocchio: two readers of one URDF, two dynamics."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pinocchio as pin
import pytest

from helpers_physics import START
from iiwa_dnn import Configuration, InvalidInputError, load_robot
from iiwa_dnn.robot.mujoco_model import (
    TIP_SITE,
    JointDynamics,
    build_spec,
    compile_model,
    torque_limits,
)

mujoco = pytest.importorskip("mujoco", reason="pip install 'iiwa-dnn[sim]'")

DYNAMICS = JointDynamics(damping=0.3, armature=0.07)
PAIRS = {(0, 5), (0, 6), (0, 7)}


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


def test_motors_have_the_data_sheets_limits_and_no_more(robot):
    limit = np.array([176.0, 176.0, 110.0, 110.0, 110.0, 40.0, 40.0])
    np.testing.assert_array_equal(torque_limits(robot), limit)
    model = compile_model(robot, 1e-3)
    data = mujoco.MjData(model)
    data.ctrl[:] = 1e3
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.qfrc_actuator, limit)
    data.ctrl[:] = -0.5 * limit
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.qfrc_actuator, -0.5 * limit)


def test_the_stops_are_the_urdfs_whatever_the_controller_keeps(robot):
    model = compile_model(robot.with_limits(lower=-1.0, upper=1.0), 1e-3)
    np.testing.assert_allclose(model.jnt_range[:, 0], robot.q_lower)
    np.testing.assert_allclose(model.jnt_range[:, 1], robot.q_upper)
    assert model.jnt_limited.all()


def test_only_the_pairs_that_can_meet_collide(robot):
    spec = build_spec(robot)
    excluded = {frozenset((pair.bodyname1, pair.bodyname2)) for pair in spec.excludes}
    links = [*(f"iiwa7_link_{i}" for i in range(8)), "iiwa7_flange"]
    allowed = {frozenset((f"iiwa7_link_{i}", f"iiwa7_link_{j}")) for i, j in PAIRS}
    assert excluded == {frozenset(pair) for pair in combinations(links, 2)} - allowed
    # Folded back on its own base the arm touches it; at the paper's start nothing touches.
    model = compile_model(robot, 1e-3)
    data = mujoco.MjData(model)
    counts = []
    for q in (START, np.array([0.0, 2.0, 0.0, -2.0, 0.0, 1.5, 0.0])):
        data.qpos[:] = q
        mujoco.mj_forward(model, data)
        counts.append(data.ncon)
    assert counts[0] == 0
    assert counts[1] > 0


def test_masses_and_friction(robot):
    factors = np.linspace(0.9, 1.1, 7)
    friction = np.arange(7.0)
    plain, other = compile_model(robot, 1e-3), compile_model(robot, 1e-3, None, friction, factors)
    for i, factor in enumerate(factors, 1):
        link = f"iiwa7_link_{i}"
        for name in ("mass", "inertia"):
            before, after = getattr(plain.body(link), name), getattr(other.body(link), name)
            np.testing.assert_allclose(after, factor * before)
    np.testing.assert_array_equal(other.dof_frictionloss, friction)
    assert other.body("iiwa7_link_0").mass == plain.body("iiwa7_link_0").mass


def test_an_arm_of_meshes_moves_too():
    data_folder = pytest.importorskip("pinocchio").__file__
    from pathlib import Path

    share = Path(data_folder).parents[4] / "share/example-robot-data/robots"
    path = share / "ur_description/urdf/ur5_robot.urdf"
    if not path.exists():
        pytest.skip("no other arms: pip install 'iiwa-dnn[robots]'")
    robot = load_robot(path, tip="tool0")
    model = compile_model(robot, 1e-3)
    data = mujoco.MjData(model)
    data.qpos[:] = q = np.linspace(-1.0, 1.0, robot.dof)
    mujoco.mj_forward(model, data)
    tip = data.site(TIP_SITE)
    np.testing.assert_allclose(tip.xpos, Configuration(robot, q).position, atol=1e-12)


@pytest.mark.parametrize(("name", "value"), [("damping", -1.0), ("armature", np.nan)])
def test_wrong_dynamics(name, value):
    with pytest.raises(InvalidInputError, match=name):
        JointDynamics(**{name: value})


def test_robots_that_cannot_be_had_in_physics(robot):
    locked = load_robot("iiwa7", locked=("iiwa7_joint_3",))
    with pytest.raises(InvalidInputError, match="no locked joint"):
        build_spec(locked)
    import dataclasses

    with pytest.raises(InvalidInputError, match="must come from a URDF file"):
        build_spec(dataclasses.replace(robot, path=None))
